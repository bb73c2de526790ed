"""Arguments of :func:`credence.judge` from two filters without a truth."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from credence import Record
from credence._arrays import numbers
from credence._errors import InputError, wrong
from credence.adapters.frames import wrapped
from credence.adapters.poses import say_independent
from credence.adapters.rosbag import from_rosbag, is_bag
from credence.adapters.tables import Path, match_times, note, same_time
from credence.adapters.trajectories import from_files

_of_both = ("manifold", "chart", "quaternion", "component_names", "component_units", "groups", "steps", "runs")


def from_pair(
    first: Path | Sequence[Path] | Mapping[str, Any] | Record,
    second: Path | Sequence[Path] | Mapping[str, Any] | Record | None = None,
    **options: Any,
) -> dict[str, Any]:
    """Two filters that estimate the same and have no truth: the difference of their estimates against P1 + P2.

    Where both are right and their errors are independent, the difference has the covariance P1 + P2. What is found says
    that both together cannot be right, and not which is wrong. Errors that both share (a sensor, a prior, the noise of
    the process) are not in the difference: it is then smaller than P1 + P2 says, so that *pessimistic* says nothing,
    and *optimistic* holds all the more.

    Parameters
    ----------
    first, second : path, list of paths, dict, or Record
        Two logs of poses with covariances (bags, text files); of a bag, whose topics are then `topic` and
        `truth_topic`, the second may be left out. Or the arguments of `judge` of each filter, with `estimate`
        [trial, step, q] or [step, q], its `covariance` and, as for `judge`, a `manifold` where there are angles. If
        both have `time`, those of one run need not be the same: steps at times that both have are judged. `error`
        may stand in the place of `estimate`, as of two tables with one truth.
    **options
        As of :func:`from_rosbag` or :func:`from_tum`, of paths alone.

    Returns
    -------
    dict
        Of paths as :func:`from_tum`, with the second filter in the place of the truth; of arrays `error`, or on a
        manifold `truth` and `estimate`, with the sum of the covariances.

    Raises
    ------
    InputError
        If one of both has no covariances, both do not estimate the same at the same steps, or a log cannot be read.
    """
    if isinstance(first, (Mapping, Record)) != isinstance(second, (Mapping, Record)):
        raise wrong("second", "the first filter is given in another way", "Give two logs, or the arrays of both")
    if isinstance(first, (Mapping, Record)) and isinstance(second, (Mapping, Record)):
        return _of_arrays([first, second])
    one: Any = first if isinstance(first, (str, bytes)) or not isinstance(first, Sequence) else first[0]
    if is_bag(one):
        return from_rosbag(first, second, pair=True, **options)  # type: ignore[arg-type]
    if second is None:
        raise InputError(f"{one}: a pair has two logs. Give that of the second filter.")
    return from_files(first, second, pair=True, **options)  # type: ignore[arg-type]


def _of_arrays(filters: Sequence[Mapping[str, Any] | Record]) -> dict[str, Any]:
    fields = [one.given() if isinstance(one, Record) else one for one in filters]
    given = [{name: value for name, value in one.items() if value is not None} for one in fields]
    state = "estimate" if "estimate" in given[0] else "error"
    for name in (state, "covariance"):
        if not all(name in one for one in given):
            raise InputError(f"one of both filters has no {name}. Give it as judge takes it.")
    for name in _of_both:
        if all(name in one for one in given) and not np.array_equal(given[0][name], given[1][name]):
            raise wrong(name, "both filters have another one", "Give filters that estimate the same in the same runs")
    arguments = {name: value for one in reversed(given) for name, value in one.items() if name in (*_of_both, "time")}
    states, spreads = ([numbers(name, one[name]).astype(float) for one in given] for name in (state, "covariance"))
    if spreads[0].ndim + spreads[1].ndim == 2 * states[0].ndim + 1:  # variances of one of them
        spreads = [each if each.ndim == states[0].ndim else np.diagonal(each, axis1=-2, axis2=-1) for each in spreads]
    times = [np.ravel(numbers("time", one["time"])).astype(float) for one in given if "time" in one]
    if len(times) == 2 and not np.array_equal(times[0], times[1]):
        rows = match_times(times[0], times[1], same_time)
        if [each.size for each in times] != [each[..., 0].size for each in states] or not rows[0].size:
            raise wrong("time", "that of the second filter is another one", "Give one run a filter, with common times")
        have = f"{rows[0].size} of {len(times[0])} and {len(times[1])} steps"
        note(f"{have} are at the same times, and the others are left out")
        tail = states[0].ndim - 1
        for both in (states, spreads):
            both[:] = [each.reshape(-1, *each.shape[tail:])[row][None] for each, row in zip(both, rows)]
        arguments["time"] = times[0][rows[0]]
    if states[0].shape != states[1].shape or spreads[0].shape != spreads[1].shape:
        why = f"the filters have {state}s of shapes {states[0].shape} and {states[1].shape}"
        raise InputError(f"{why}, and covariances {spreads[0].shape} and {spreads[1].shape}. Give the same of both.")
    say_independent("the first filter", "the second")
    arguments["covariance"] = spreads[0] + spreads[1]
    if "manifold" in arguments and state == "estimate":
        return arguments | {"estimate": states[0], "truth": states[1]}
    units = arguments.get("component_units", ())
    turns = [i for i, unit in enumerate(units.split(",") if isinstance(units, str) else units) if unit.strip() == "rad"]
    difference = states[0] - states[1]
    difference[..., turns] = wrapped(difference[..., turns])
    return {name: value for name, value in arguments.items() if name not in _of_both[:3]} | {"error": difference}
