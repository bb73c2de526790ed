"""Arguments of :func:`credence.judge` from poses at times and the true poses at other times."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from credence._errors import InputError, argument, invalid, wrong
from credence.adapters.fits import ask_what_fits
from credence.adapters.frames import (
    ALIGNMENTS,
    Poses,
    aligned,
    body_offset,
    check_frames,
    errors_of,
    found_offset,
    from_vectors,
    rotation,
    with_body,
    yaw_of,
)
from credence.adapters.missing import none_throughout
from credence.adapters.quaternions import tangent
from credence.adapters.tables import Array, neighbours, normalised, note, require_unit, say_matched, stacked

COMPONENTS = ["x", "y", "z", "roll", "pitch", "yaw"]
_units = ["m"] * 3 + ["rad"] * 3
_planar = [0, 1, 5]
BENDS = 0.2  # share of P's sigma from which on an error of the truth shows


def _require_times(estimate: Poses, truth: Poses) -> None:
    """Refuse poses whose times are counted where their truth has others."""
    if estimate.counted != truth.counted:
        without = (estimate if estimate.counted else truth).source
        has = "it has no times, and the poses of the other file have"
        raise InputError(f"{without}: {has}. Give their times ({argument('times')}).")
    if estimate.counted and len(estimate.time) != len(truth.time):
        has = f"it has {len(truth.time)} poses, and {estimate.source} {len(estimate.time)}"
        raise InputError(f"{truth.source}: {has}. Give the true pose of each line, or files with times.")


def _finite(poses: Poses) -> NDArray[np.bool_]:
    there: NDArray[np.bool_] = np.isfinite(poses.pose).all(axis=1) & np.isfinite(poses.time)
    return there


def _require_turns(poses: Poses) -> Poses:
    if poses.pose.shape[1] == 7:
        require_unit(poses.source, poses.pose[:, 3:])
    return poses


def require_poses(poses: Poses) -> Poses:
    there = _finite(poses)
    if not there.all():
        has = f"pose {np.argmin(there) + 1} of {len(there)}, the first of {(~there).sum()}, is not finite"
        raise InputError(f"{poses.source}: {has}. Leave out what was written before the filter had a pose.")
    return _require_turns(poses)


def without_gaps(truth: Poses) -> Poses:
    """The truth where there is one."""
    there = _finite(truth)
    if not there.any():
        raise InputError(f"{truth.source}: none of its poses is finite. Give the truth of this run.")
    if not there.all():
        note(f"{truth.source}: {(~there).sum()} of {len(there)} true poses are not finite, and are left out")
    return _require_turns(truth.at(np.flatnonzero(there)))


def in_order(poses: Poses) -> Poses:
    """In the order of time; of several poses at one time the last."""
    back = poses.time[::-1]
    _, last = np.unique(back, return_index=True)
    if len(last) < len(back):
        note(f"{poses.source}: of {len(back) - len(last)} poses another one has the same time, and the last counts")
    return poses.at(len(back) - 1 - last)


def interpolated(truth: Poses, times: Array, max_gap: float) -> tuple[NDArray[np.intp], Poses]:
    """Indices of the times that have a truth, and the poses there: positions on straight lines between two true poses
    that are at most `max_gap` (s) apart, orientations on geodesics of SO(3) [Shoemake 1985], and covariances between
    those of the two; velocities, which have no orientations, on straight lines."""
    found, before, after, place = neighbours(truth.time, times, max_gap)
    share, one, other = place[:, None], truth.pose[before], truth.pose[after]
    poses, covariance = (1 - share) * one + share * other, truth.covariance
    if poses.shape[1] == 7 and ((share > 0) & (share < 1)).any():
        first = rotation(one[:, 3:])
        turn = (first.inv() * rotation(other[:, 3:])).as_rotvec()
        poses[:, 3:] = (first * from_vectors(share * turn)).as_quat()
    if covariance is not None:
        covariance = covariance[before] + share[..., None] * (covariance[after] - covariance[before])
    return found, truth._replace(time=times[found], pose=poses, covariance=covariance)


def _say_bends(estimate: Poses, truth: Poses, times: Array, max_gap: float, places: Sequence[int]) -> None:
    """Note where straight lines between true positions miss more of them than a fifth of P's sigma: the second
    derivative times s (1 - s) / 2 of the gap squared, where s is the place within it."""
    if len(truth.time) < 3 or not places:
        return
    _, before, after, share = neighbours(truth.time, times, max_gap)
    position, gap = truth.pose[:, places], truth.time[after] - truth.time[before]
    slopes = np.diff(position, axis=0) / np.diff(truth.time)[:, None]
    bends = 2 * np.diff(slopes, axis=0) / (truth.time[2:] - truth.time[:-2])[:, None]
    bends = np.pad(bends, ((1, 1), (0, 0)), mode="edge")
    off = (share * (1 - share) * gap**2 / 2)[:, None] * (bends[before] + bends[after]) / 2
    assert estimate.covariance is not None
    variance = np.diagonal(estimate.covariance, axis1=1, axis2=2)[:, places].sum(axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        share_of_P = float(np.median(np.linalg.norm(off, axis=1) / np.sqrt(variance)))
    if share_of_P > BENDS:
        note(
            f"{truth.source}: its positions, {np.median(gap):.2g} s apart, are interpolated, and straight lines miss "
            f"{share_of_P:.2g} sigma of P by their bends (median): the errors have this in them. Give a denser truth"
        )


def _associated(estimate: Poses, truth: Poses, max_gap: float, time_offset: float) -> tuple[Poses, Poses]:
    times = estimate.time + time_offset
    found, at = interpolated(truth, times, max_gap)
    say_matched(estimate.source, times, found, truth.source, truth.time, max_gap)
    return estimate.at(found), at


def estimated_components(runs: Sequence[Poses]) -> list[int]:
    """Indices of (x, y, z, roll, pitch, yaw) that a log estimates.

    A component is not estimated where its variance is a placeholder throughout (zero, negative, NaN, from 10^6 on, or
    one and the same number from 10^4 on); nor are z, roll and pitch where twenty poses or more do not change them.
    """
    poses = np.concatenate([run.pose for run in runs])
    none = none_throughout(_covariances(runs))
    if len(poses) >= 20:  # of fewer poses none may have left the plane yet
        x, y, z, w = poses[:, 3:].T
        up = np.stack([2 * (x * z + w * y), 2 * (y * z - w * x)])  # the body's z axis: where roll and pitch show
        none[2] |= bool(np.ptp(poses[:, 2]) == 0)
        none[3:5] |= bool((np.ptp(up, axis=1) < 1e-12).all() and np.abs(up).max() < 1e-12)
    return [int(i) for i in np.flatnonzero(~none)]


def _kept_components(runs: Sequence[Poses], planar: bool | None) -> list[int]:
    if all(each.shape[-1] == 3 for each in _covariances(runs)):
        return [0, 1] if planar else [0, 1, 2]
    if planar is not None:
        return _planar if planar else list(range(6))
    kept = estimated_components(runs)
    if not kept:
        why = "all its variances are placeholders, such as 0 or 10^6"
        raise InputError(f"{runs[0].source}: its poses have no covariances ({why}). Give a log that has them.")
    if len(kept) < 6:
        missing = [name for i, name in enumerate(COMPONENTS) if i not in kept]
        judged = [COMPONENTS[i] for i in kept]
        note(
            f"{runs[0].source}: {', '.join(missing)}: not estimated (constant, or with a placeholder for a "
            f"variance); judged: {', '.join(judged)}"
        )
    return kept


def _of_components(
    kept: list[int], truth: Array, estimate: Array, covariance: Array, manifold: str, chart: str
) -> dict[str, Any]:
    """The arguments with the components that are kept."""
    names = {"component_names": [COMPONENTS[i] for i in kept], "component_units": [_units[i] for i in kept]}
    covariance = covariance if len(kept) == 6 else covariance[..., kept, :][..., kept]
    arguments: dict[str, Any] = names | {"covariance": covariance}
    states: dict[str, Any] = {"chart": chart}
    if kept == list(range(6)):
        names["component_names"][3:] = ["rx", "ry", "rz"]
        arguments |= {"groups": {"position": [0, 1, 2], "rotation": [3, 4, 5]}}
        states |= {"truth": truth, "estimate": estimate, "manifold": manifold, "quaternion": "xyzw"}
    elif kept == _planar or max(kept) < 3:
        angles = [yaw_of(each)[..., None] for each in (truth, estimate)] if kept == _planar else [truth[..., :0]] * 2
        places = [i for i in kept if i < 3]
        states["truth"], states["estimate"] = (
            np.concatenate([each[..., places], angle], axis=-1) for each, angle in zip((truth, estimate), angles)
        )
        planar = "SE2" if manifold == "SE3" else "R2 x SO2"
        states["manifold"] = planar if kept == _planar else f"R{len(kept)}"
    elif manifold == "SE3":
        raise InputError("cannot judge a part of SE3 (its components are not apart). Give manifold='R3 x SO3'.")
    else:
        there = ~np.isnan(truth[..., 0])
        error = np.full((*truth.shape[:-1], 6), np.nan)
        error[there] = errors_of(estimate[there], truth[there], manifold, chart)
        states = {"error": error[..., kept]}
    return arguments | states


def _covariances(runs: Iterable[Poses]) -> list[Array]:
    return [run.covariance for run in runs if run.covariance is not None]


def _states(runs: Iterable[Poses]) -> Array:
    return stacked([np.hstack([run.pose[:, :3], normalised(run.pose[:, 3:])]) for run in runs])


def _require_options(align: str, manifold: str, chart: str, pair: bool, body: Any) -> None:
    if align not in ALIGNMENTS:
        raise invalid("align", align, f"must be one of {', '.join(ALIGNMENTS)}", "Give one of them")
    if manifold not in ("SE3", "R3 x SO3"):
        raise invalid("manifold", manifold, "must be SE3 or R3 x SO3", "Give one of them")
    if pair and (body is not None or (align != "none" and (manifold, chart) == ("SE3", "global"))):
        why = "moves the second filter's poses, and not what its covariance is of"
        raise InputError(f"cannot judge this pair ({argument('align' if body is None else 'body')} {why}). Move them.")


def _one_gauge(estimate: Poses, truth: Poses, align: str, turned: Sequence[int]) -> tuple[Poses, Poses]:
    """The estimate and the truth that was moved to it, without the pose by which it was: that one has no error."""
    truth = aligned(estimate, truth, align, turned)
    if not align.startswith("first"):
        return estimate, truth
    if len(estimate.time) < 2:
        raise InputError(f"{estimate.source}: it has no pose behind the first, by which it is aligned. Give more.")
    rest = np.arange(1, len(estimate.time))
    return estimate.at(rest), truth.at(rest)


def _of_turns(poses: Poses, manifold: str, chart: str) -> Poses:
    """Poses whose covariances are of three rotations, where they are of the four numbers of a quaternion."""
    if poses.covariance is None or poses.covariance.shape[-1] != 7:
        return poses
    return poses._replace(covariance=tangent(poses.pose, poses.covariance, manifold, chart))


def added(estimate: Poses, truth: Poses) -> Poses:
    """The estimate with the covariance of its difference from that of another filter."""
    assert estimate.covariance is not None
    assert truth.covariance is not None
    if estimate.covariance.shape != truth.covariance.shape:
        raise InputError(f"{truth.source}: its covariances are not of what those of {estimate.source} are. Give these.")
    return estimate._replace(covariance=estimate.covariance + truth.covariance)


def say_independent(first: str, second: str) -> None:
    note(
        f"{first} and {second} are taken for independent: their difference is judged against the sum of both "
        "covariances. What both share makes it smaller, and it says whether both can be right, not which is wrong"
    )


def pose_arguments(
    pairs: Sequence[tuple[Poses, Poses]],
    *,
    manifold: str = "SE3",
    chart: str = "local",
    max_gap: float = 0.2,
    align: str = "none",
    time_offset: float = 0.0,
    planar: bool | None = None,
    body: Any = None,
    pair: bool = False,
) -> dict[str, Any]:
    """The arguments of judge from a pair of estimate and truth for each run; :func:`from_tum` says what each option
    does, and :func:`from_pair` what `pair`."""
    _require_options(align, manifold, chart, pair, body)
    offset = body_offset(body)
    for estimate, truth in pairs:
        for each in (estimate, truth) if pair else (estimate,):
            if each.covariance is None:
                raise InputError(f"{each.source}: its poses have no covariances. Give a log that has them.")
            if each.covariance.shape[-1] == 3 and body is not None:
                raise wrong("body", f"{each.source} has no orientations that turn it", "Leave it out")
        _require_times(estimate, truth)
    ordered = [
        (
            _of_turns(in_order(require_poses(estimate)), manifold, chart),
            with_body(_of_turns(in_order(without_gaps(truth)), manifold, chart), offset),
        )
        for estimate, truth in pairs
    ]
    runs = [_associated(estimate, truth, max_gap, time_offset) for estimate, truth in ordered]
    turned = () if manifold == "SE3" else (0,) if chart == "local" else (0, 3)
    runs = [_one_gauge(*run, align, turned if pair else ()) for run in runs]
    if pair:
        runs = [(added(*run), run[1]) for run in runs]
        say_independent(runs[0][0].source, runs[0][1].source)
    kept, shifted = _kept_components([estimate for estimate, _ in runs], planar), False
    for (estimate, truth), (_, whole) in zip(runs, ordered):
        _say_bends(estimate, whole, estimate.time + time_offset, max_gap, [i for i in kept if i < 3])
        at, gain = found_offset(estimate, whole if align == "none" else truth)
        if gain >= 0.5 and not time_offset:
            shifted = True  # which moves the first pose, too
            note(
                f"{estimate.source}: with {at:+.3g} s added to its times the squared errors of its positions "
                f"would be {gain:.0%} smaller. Nothing is shifted unless you ask for it ({argument('time_offset')})."
            )
    if align == "none" and not shifted and (
        len(kept) < 6 or pair or not ask_what_fits(runs, manifold, chart, body is not None)
    ):
        check_frames(runs, kept)
    true, estimated = (_states(each) for each in ([truth for _, truth in runs], [estimate for estimate, _ in runs]))
    return {
        **_of_components(kept, true, estimated, stacked(_covariances(run for run, _ in runs)), manifold, chart),
        "steps": np.array([len(estimate.time) for estimate, _ in runs]),
        "time": stacked([estimate.time for estimate, _ in runs]),
    }
