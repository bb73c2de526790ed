"""Arguments of :func:`credence.judge` from poses at times and the true poses at other times."""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from credence._errors import InputError, argument, invalid
from credence.adapters.tables import Array, needed, neighbours, normalised, note, require_unit, say_matched, stacked

ALIGNMENTS = ("none", "first", "se3")
COMPONENTS = ["x", "y", "z", "roll", "pitch", "yaw"]
_units = ["m"] * 3 + ["rad"] * 3
_planar = [0, 1, 5]
_longest_offset = 1.0  # s; that is looked for


class Poses(NamedTuple):
    """A trajectory: times (s), poses (x, y, z, and the quaternion x, y, z, w), and the covariances of (translation,
    rotation) [step, 6, 6], if it has them."""

    source: str
    time: Array
    pose: Array
    covariance: Array | None = None
    frame: str = ""
    counted: bool = False  # its times are the numbers of its lines

    def at(self, rows: NDArray[np.intp]) -> Poses:
        if np.array_equal(rows, np.arange(len(self.time))):
            return self
        covariance = None if self.covariance is None else self.covariance[rows]
        return self._replace(time=self.time[rows], pose=self.pose[rows], covariance=covariance)


def _rotations() -> Any:
    return needed("scipy.spatial.transform", "scipy", "turn poses").Rotation


def rotation(quaternions: Array) -> Any:
    """Rotations of SciPy."""
    return _rotations().from_quat(quaternions)


def quaternions(matrices: Array) -> Array:
    """Quaternions (x, y, z, w) of the nearest rotations."""
    turned: Array = _rotations().from_matrix(matrices).as_quat()
    return turned


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


def _require_poses(poses: Poses) -> Poses:
    there = _finite(poses)
    if not there.all():
        has = f"pose {np.argmin(there) + 1} of {len(there)}, the first of {(~there).sum()}, is not finite"
        raise InputError(f"{poses.source}: {has}. Leave out what was written before the filter had a pose.")
    require_unit(poses.source, poses.pose[:, 3:])
    return poses


def _without_gaps(truth: Poses) -> Poses:
    """The truth where there is one."""
    there = _finite(truth)
    if not there.any():
        raise InputError(f"{truth.source}: none of its poses is finite. Give the truth of this run.")
    if not there.all():
        note(f"{truth.source}: {(~there).sum()} of {len(there)} true poses are not finite, and are left out")
    truth = truth.at(np.flatnonzero(there))
    require_unit(truth.source, truth.pose[:, 3:])
    return truth


def in_order(poses: Poses) -> Poses:
    """In the order of time; of several poses at one time the last."""
    back = poses.time[::-1]
    _, last = np.unique(back, return_index=True)
    if len(last) < len(back):
        note(f"{poses.source}: of {len(back) - len(last)} poses another one has the same time, and the last counts")
    return poses.at(len(back) - 1 - last)


def interpolated(truth: Poses, times: Array, max_gap: float) -> tuple[NDArray[np.intp], Array]:
    """Indices of the times that have a truth, and the poses there: positions on straight lines between two true poses
    that are at most `max_gap` (s) apart, orientations on geodesics of SO(3) [Shoemake 1985]."""
    found, before, after, place = neighbours(truth.time, times, max_gap)
    share, one, other = place[:, None], truth.pose[before], truth.pose[after]
    poses = np.where(share == 1, other, one)
    if ((share > 0) & (share < 1)).any():
        poses[:, :3] = (1 - share) * one[:, :3] + share * other[:, :3]
        first = rotation(one[:, 3:])
        turn = (first.inv() * rotation(other[:, 3:])).as_rotvec()
        poses[:, 3:] = (first * _rotations().from_rotvec(share * turn)).as_quat()
    return found, poses


def _associated(estimate: Poses, truth: Poses, max_gap: float, time_offset: float) -> tuple[Poses, Poses]:
    times = estimate.time + time_offset
    found, poses = interpolated(truth, times, max_gap)
    say_matched(estimate.source, times, found, truth.source, truth.time, max_gap)
    return estimate.at(found), truth._replace(time=times[found], pose=poses)


def aligned(estimate: Poses, truth: Poses, align: str) -> Poses:
    """The truth, moved as a rigid body to the estimate: by their first poses, or so that the squared differences of the
    positions are smallest [Umeyama 1991, without a scale]."""
    if align == "none":
        return truth
    e, t = estimate.pose, truth.pose
    if align == "first":
        turn = rotation(e[0, 3:]) * rotation(t[0, 3:]).inv()
        pivot, at = t[0, :3], e[0, :3]
    else:
        pivot, at = t[:, :3].mean(axis=0), e[:, :3].mean(axis=0)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of positions on a line, about which any turn will do
            turn = _rotations().align_vectors(e[:, :3] - at, t[:, :3] - pivot)[0]
    return truth._replace(pose=np.hstack([at + turn.apply(t[:, :3] - pivot), (turn * rotation(t[:, 3:])).as_quat()]))


def found_offset(estimate: Poses, truth: Poses) -> tuple[float, float]:
    """What added to the times of the estimate makes the squared differences of positions about their mean smallest (s),
    and by what share it does so."""
    inside = (estimate.time >= truth.time[0] + _longest_offset) & (estimate.time <= truth.time[-1] - _longest_offset)
    rows = np.flatnonzero(inside)
    rows = rows[:: max(1, len(rows) // 500)]
    if len(rows) < 20:
        return 0.0, 0.0
    offsets = np.linspace(-_longest_offset, _longest_offset, 401)
    columns = np.ascontiguousarray(truth.pose[:, :3].T)

    def spread(offset: float) -> float:
        true = [np.interp(estimate.time[rows] + offset, truth.time, column) for column in columns]
        return float(np.var(estimate.pose[rows, :3] - np.transpose(true), axis=0).sum())

    spreads = [spread(offset) for offset in offsets]
    best = int(np.argmin(spreads))
    if best in (0, len(offsets) - 1):  # it may be smaller still farther away
        return 0.0, 0.0
    left, least, right = spreads[best - 1 : best + 2]
    curvature = left - 2 * least + right
    between = (left - right) / (2 * curvature) if curvature > 0 else 0.0
    offset = float(offsets[best] + between * (offsets[1] - offsets[0]))
    return offset, 1 - spread(offset) / max(spreads[len(offsets) // 2], np.finfo(float).tiny)


def _sigmas(difference: float, block: Array) -> float:
    """How many of the largest sigmas of a covariance a difference is."""
    largest = float(np.linalg.eigvalsh(block)[-1])
    return difference / math.sqrt(largest) if largest > 0 else 0.0


def _check_frames(estimate: Poses, truth: Poses, kept: Sequence[int]) -> None:
    """Notes frames of other names, and a first pose that is far from the truth."""
    assert estimate.covariance is not None
    if estimate.frame and truth.frame and estimate.frame != truth.frame:
        note(f"{estimate.source}: its poses are in the frame {estimate.frame}, those of the truth in {truth.frame}")
    places = [i for i in kept if i < 3]
    away = float(np.linalg.norm((estimate.pose[0] - truth.pose[0])[places]))
    sigmas = _sigmas(away, estimate.covariance[0][np.ix_(places, places)]) if places else 0.0
    far = f"{away:.3g} m"
    turns = [i for i in kept if i >= 3]
    if turns:
        half = float(normalised(estimate.pose[0, 3:]) @ normalised(truth.pose[0, 3:]))
        angle = 2 * math.acos(min(abs(half), 1.0))
        if len(turns) == 1:
            angle = abs(float(_wrapped(yaw_of(estimate.pose[0]) - yaw_of(truth.pose[0]))))
        if (of_angle := _sigmas(angle, estimate.covariance[0][np.ix_(turns, turns)])) > sigmas:
            sigmas, far = of_angle, f"{angle:.3g} rad"
    if sigmas > 5:
        note(
            f"{estimate.source}: its first pose is {far} from the truth, {sigmas:.3g} sigmas. Are both in one frame? "
            f"Nothing is aligned unless you ask for it ({argument('align')})."
        )


def _wrapped(angle: Any) -> Any:
    return np.remainder(angle + np.pi, 2 * np.pi) - np.pi


def yaw_of(poses: Array) -> Any:
    x, y, z, w = np.moveaxis(poses[..., 3:], -1, 0)
    return np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))


def estimated_components(runs: Sequence[Poses]) -> list[int]:
    """Indices of (x, y, z, roll, pitch, yaw) that a log estimates.

    A component is not estimated where its variance is a placeholder throughout (zero, negative, NaN, from 10^6 on, or
    one and the same number from 10^4 on); nor are z, roll and pitch where twenty poses or more do not change them.
    """
    poses = np.concatenate([run.pose for run in runs])
    variances = np.concatenate([np.diagonal(each, axis1=1, axis2=2) for each in _covariances(runs)])
    none = ~((variances > 0) & (variances < 1e6)).any(axis=0)
    none |= (variances >= 1e4).all(axis=0) & (np.ptp(variances, axis=0) == 0)
    if len(poses) >= 20:  # of fewer poses none may have left the plane yet
        x, y, z, w = poses[:, 3:].T
        up = np.stack([2 * (x * z + w * y), 2 * (y * z - w * x)])  # the body's z axis: where roll and pitch show
        none[2] |= bool(np.ptp(poses[:, 2]) == 0)
        none[3:5] |= bool((np.ptp(up, axis=1) < 1e-12).all() and np.abs(up).max() < 1e-12)
    return [int(i) for i in np.flatnonzero(~none)]


def _kept_components(runs: Sequence[Poses], planar: bool | None) -> list[int]:
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
    arguments = names | {"covariance": covariance if len(kept) == 6 else covariance[..., kept, :][..., kept]}
    states: dict[str, Any] = {"chart": chart}
    if kept == list(range(6)):
        names["component_names"][3:] = ["rx", "ry", "rz"]
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
        T, E = rotation(truth[there][:, 3:]), rotation(estimate[there][:, 3:])
        turn = (T.inv() * E if chart == "local" else E * T.inv()).as_rotvec()
        error = np.full((*truth.shape[:-1], 6), np.nan)
        error[there] = np.hstack([(estimate - truth)[there][:, :3], turn])
        states = {"error": error[..., kept]}
    return arguments | states


def _covariances(runs: Iterable[Poses]) -> list[Array]:
    return [run.covariance for run in runs if run.covariance is not None]


def _states(runs: Iterable[Poses]) -> Array:
    return stacked([np.hstack([run.pose[:, :3], normalised(run.pose[:, 3:])]) for run in runs])


def pose_arguments(
    pairs: Sequence[tuple[Poses, Poses]],
    *,
    manifold: str = "SE3",
    chart: str = "local",
    max_gap: float = 0.2,
    align: str = "none",
    time_offset: float = 0.0,
    planar: bool | None = None,
) -> dict[str, Any]:
    """The arguments of judge from a pair of estimate and truth for each run; :func:`from_tum` says what each option
    does."""
    if align not in ALIGNMENTS:
        raise invalid("align", align, "must be none, first or se3", "Give one of them")
    if manifold not in ("SE3", "R3 x SO3"):
        raise invalid("manifold", manifold, "must be SE3 or R3 x SO3", "Give one of them")
    for estimate, _ in pairs:
        if estimate.covariance is None:
            raise InputError(f"{estimate.source}: its poses have no covariances. Give a log that has them.")
    for pair in pairs:
        _require_times(*pair)
    ordered = [(in_order(_require_poses(estimate)), in_order(_without_gaps(truth))) for estimate, truth in pairs]
    runs = [_associated(estimate, truth, max_gap, time_offset) for estimate, truth in ordered]
    kept = _kept_components([estimate for estimate, _ in runs], planar)
    truths = [aligned(*run, align) for run in runs]
    for (estimate, _), truth, (_, whole) in zip(runs, truths, ordered):
        offset, gain = found_offset(estimate, whole if align == "none" else truth)
        if time_offset or gain < 0.5:
            _check_frames(estimate, truth, kept)
        else:  # which moves the first pose, too
            note(
                f"{estimate.source}: with {offset:+.3g} s added to its times the squared errors of its positions "
                f"would be {gain:.0%} smaller. Nothing is shifted unless you ask for it ({argument('time_offset')})."
            )
    true, estimated = (_states(each) for each in (truths, [estimate for estimate, _ in runs]))
    return {
        **_of_components(kept, true, estimated, stacked(_covariances(run for run, _ in runs)), manifold, chart),
        "steps": np.array([len(estimate.time) for estimate, _ in runs]),
        "time": stacked([estimate.time for estimate, _ in runs]),
    }
