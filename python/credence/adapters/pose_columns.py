"""Poses in tables: columns of a position and a quaternion, or of a quaternion alone."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from credence._arrays import runs_of
from credence._errors import InputError, argument
from credence.adapters.frames import Poses
from credence.adapters.named_columns import NamedColumns
from credence.adapters.poses import pose_arguments
from credence.adapters.quaternions import quaternion_at
from credence.adapters.tables import note, units_given

NEEDS_TIME = "cannot use a table of the truth (it needs time, and one run a table). Give the column of time."


def has_poses(rows: NamedColumns, names: Sequence[str]) -> bool:
    """Whether columns of estimates are those of a pose or of an orientation. A quaternion among others is refused."""
    at = quaternion_at(rows.array(names)) if len(names) > 3 else None
    if at is not None and (at, len(names)) not in ((3, 7), (0, 4)):
        has = f"{', '.join(names[at : at + 4])} are a quaternion, which has no differences"
        say = "Name x, y, z and a quaternion, or a quaternion alone, and judge the rest apart"
        raise InputError(f"{rows.source}: {has}. {say}.")
    return at is not None


def table_of_poses(
    rows: NamedColumns, truth: NamedColumns | None, given: Mapping[str, Any], kind: str, options: Mapping[str, Any]
) -> dict[str, Any]:
    """The arguments of judge from columns of poses, by what they are `declared` to be; `kind` is that of P."""
    units = units_given(given["units"], {name: ["time"] for name in ("time", "truth_time", *given.get("time", []))})
    unit, pair = units.get("time", next(iter(units.values()), "s")), options.get("pair", False)
    if truth is None and (pair or "truth" not in given):
        raise InputError("a pair has two tables, and poses have a truth. Give the other table as the truth.")
    names = [given["estimate"], given.get("truth", given["estimate"])]
    if truth is not None and ("time" not in given or "runs" in given):
        raise InputError(NEEDS_TIME)
    estimated = _poses(rows, names[0], given, kind, unit)
    true = _poses(truth or rows, names[1], given, kind if pair else "", units.get("truth_time", unit))
    run = runs_of(np.asanyarray(rows.values(given["runs"][0])).tolist()) if "runs" in given else 0 * estimated.time
    parts = [np.flatnonzero(run == k) for k in np.unique(run)]
    pairs = [(estimated.at(part), true if truth is not None else true.at(part)) for part in parts]
    arguments = pose_arguments(pairs, **{"manifold": "R3 x SO3", **options})
    if not kind.endswith("covariance"):
        arguments["covariance"] = np.diagonal(arguments["covariance"], axis1=-2, axis2=-1)
    return arguments


def _poses(rows: NamedColumns, names: Sequence[str], given: Mapping[str, Any], kind: str, unit: str) -> Poses:
    """Poses of columns; those of a quaternion alone stand at the origin, with a variance of 0 there."""
    words, own = given.get("order", []), rows.array(names)
    count, places = len(names), len(names) - 4
    both = [given.get(of, names) for of in ("estimate", "truth")]
    first, last = (any(str(of[i]).lower().endswith("w") for of in both) for i in (places, -1))
    first = first or "qw first" in words
    if not first and not last:
        say = f"Say {argument('order')} 'qw first' if it is the first"
        note(f"{rows.source}: {names[-1]} is taken for the w of a quaternion. {say}.")
    numbers = [*range(places), *([places + 1, places + 2, places + 3, places] if first else range(places, count))]
    pose = np.hstack([np.zeros((len(own), 3 - places)), own[:, numbers]])
    is_timed = "time" in given
    times = rows.times(given["time"], unit, "time", False) if is_timed else np.arange(float(len(own)))
    P = None
    if kind:  # of the numbers, or of the errors
        is_whole = kind == "covariance" and len(given[kind]) in (count * count, count * (count + 1) // 2)
        size = count if is_whole else count - 1
        P = rows.spread(kind, given[kind], size, words, (3, 4, 5) if size == 6 else ())
        P = P if P.ndim == 3 else P[:, :, None] * np.eye(size)
        P = P[:, numbers][:, :, numbers] if is_whole else P
        P = np.pad(P, [(0, 0), *[(3 - places, 0)] * 2])
    return Poses(rows.source, times, pose, P, counted=not is_timed)
