"""Arguments of :func:`credence.judge` from two filters without a truth."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from credence import Record
from credence._arrays import numbers
from credence._errors import InputError, wrong
from credence.adapters.poses import say_independent
from credence.adapters.rosbag import from_rosbag, is_bag
from credence.adapters.tables import Array, Path, match_times, note, same_time
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
        return _of_arrays(_given(first), _given(second))
    one: Any = first if isinstance(first, (str, bytes)) or not isinstance(first, Sequence) else first[0]
    if is_bag(one):
        return from_rosbag(first, second, pair=True, **options)  # type: ignore[arg-type]
    if second is None:
        raise InputError(f"{one}: a pair has two logs. Give that of the second filter.")
    return from_files(first, second, pair=True, **options)  # type: ignore[arg-type]


def _given(filter_: Mapping[str, Any] | Record) -> dict[str, Any]:
    given = filter_.given() if isinstance(filter_, Record) else dict(filter_)
    return {name: value for name, value in given.items() if value is not None}


def _array(given: Mapping[str, Any], which: str, *names: str) -> Array:
    for name in names:
        if name in given:
            return numbers(name, given[name]).astype(float)
    raise InputError(f"the {which} filter has no {names[0]}. Give it as judge takes it.")


def _of_arrays(first: dict[str, Any], second: dict[str, Any]) -> dict[str, Any]:
    state = "estimate" if "estimate" in first else "error"
    states = [_array(one, which, state) for one, which in ((first, "first"), (second, "second"))]
    spreads = [_array(one, which, "covariance") for one, which in ((first, "first"), (second, "second"))]
    if any(spread.ndim == of.ndim for spread, of in zip(spreads, states)):  # variances of one of them
        spreads = [
            spread if spread.ndim == of.ndim else np.diagonal(spread, axis1=-2, axis2=-1)
            for spread, of in zip(spreads, states)
        ]
    for name in _of_both:
        if name in first and name in second and not np.array_equal(first[name], second[name]):
            raise wrong(name, "both filters have another one", "Give filters that estimate the same in the same runs")
    arguments = {name: value for name, value in {**second, **first}.items() if name in _of_both}
    times = [np.ravel(_array(one, "", "time")) for one in (first, second) if "time" in one]
    if len(times) == 2 and not np.array_equal(times[0], times[1]):
        rows = match_times(times[0], times[1], same_time)
        if any(of.size != len(at) * of.shape[-1] for of, at in zip(states, times)) or not rows[0].size:
            raise wrong("time", "that of the second filter is another one", "Give one run a filter, with common times")
        have = f"{rows[0].size} of {len(times[0])} and {len(times[1])} steps"
        note(f"{have} are at the same times, and the others are left out")
        states, spreads = (
            [each.reshape(-1, *each.shape[states[0].ndim - 1 :])[row][None] for each, row in zip(both, rows)]
            for both in (states, spreads)
        )
        arguments |= {"time": times[0][rows[0]]}
    elif times:
        arguments |= {"time": first.get("time", second.get("time"))}
    if states[0].shape != states[1].shape or spreads[0].shape != spreads[1].shape:
        why = f"the filters have {state}s of shapes {states[0].shape} and {states[1].shape}"
        raise InputError(f"{why}, and covariances {spreads[0].shape} and {spreads[1].shape}. Give the same of both.")
    say_independent("the first filter", "the second")
    arguments |= {"covariance": spreads[0] + spreads[1]}
    if "manifold" in arguments and state == "estimate":
        return arguments | {"estimate": states[0], "truth": states[1]}
    difference = states[0] - states[1]
    units = arguments.get("component_units", ())
    units = units.split(",") if isinstance(units, str) else units
    turns = [i for i, unit in enumerate(units) if unit.strip() == "rad"]
    difference[..., turns] = np.remainder(difference[..., turns] + np.pi, 2 * np.pi) - np.pi
    return {name: value for name, value in arguments.items() if name not in _of_both[:3]} | {"error": difference}
