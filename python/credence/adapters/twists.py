"""Arguments of :func:`credence.judge` from velocities at times and the true ones at other times."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from credence._errors import InputError
from credence.adapters.frames import Poses
from credence.adapters.missing import none_throughout
from credence.adapters.poses import (
    added,
    in_order,
    interpolated,
    require_poses,
    say_independent,
    without_gaps,
)
from credence.adapters.tables import note, say_matched, stacked

_names, _units = ["vx", "vy", "vz", "wx", "wy", "wz"], ["m/s"] * 3 + ["rad/s"] * 3


def twist_arguments(
    pairs: Sequence[tuple[Poses, Poses]], *, max_gap: float = 0.2, time_offset: float = 0.0, pair: bool = False
) -> dict[str, Any]:
    """The arguments of judge from velocities in the place of poses, [step, 3] or, with turn rates, [step, 6], and their
    truth, which is interpolated on straight lines. Components that are not estimated are left out, and named."""
    runs = []
    for estimate, truth in pairs:
        for each in (estimate, truth) if pair else (estimate,):
            if each.covariance is None:
                raise InputError(f"{each.source}: its velocities have no covariances. Give a log that has them.")
        if estimate.pose.shape[1] != truth.pose.shape[1]:
            raise InputError(f"{truth.source}: it has no velocities. Give a truth that has them.")
        estimate, truth = in_order(require_poses(estimate)), in_order(without_gaps(truth))
        if estimate.frame and truth.frame and estimate.frame != truth.frame:
            note(f"{estimate.source}: its velocities are of {estimate.frame}, those of the truth of {truth.frame}")
        times = estimate.time + time_offset
        found, at = interpolated(truth, times, max_gap)
        say_matched(estimate.source, times, found, truth.source, truth.time, max_gap)
        error = estimate.at(found)
        if pair:
            error = added(error, at)
            say_independent(estimate.source, truth.source)
        runs.append(error._replace(pose=error.pose - at.pose))
    covariances = [run.covariance for run in runs if run.covariance is not None]
    still = np.all([np.ptp(estimate.pose, axis=0) == 0 for estimate, _ in pairs], axis=0)
    none = none_throughout(covariances) | still
    if none.all():
        raise InputError(
            f"{runs[0].source}: all variances of its velocities are placeholders. Give a log that has them."
        )
    if none.any():
        note(f"{runs[0].source}: {', '.join(np.array(_names[: len(none)])[none])}: not estimated, and left out")
    kept = np.flatnonzero(~none)
    return {
        "error": stacked([run.pose[:, kept] for run in runs]),
        "covariance": stacked([each[:, kept][..., kept] for each in covariances]),
        "component_names": [_names[i] for i in kept],
        "component_units": [_units[i] for i in kept],
        "steps": np.array([len(run.time) for run in runs]),
        "time": stacked([run.time for run in runs]),
    }
