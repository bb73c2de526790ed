"""Trajectories, and what lies between the frames of an estimate and of its truth: a motion of the world, an offset of
the body, a shift of the times."""

from __future__ import annotations

import math
import warnings
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from credence._errors import argument, invalid
from credence.adapters.tables import Array, needed, normalised, note, require_unit

ALIGNMENTS = ("none", "first", "se3", "yaw", "first-yaw")
_longest_offset = 1.0  # s; that is looked for


class Poses(NamedTuple):
    """A trajectory: times (s), poses (x, y, z, and the quaternion x, y, z, w), and, if it has them, the covariances of
    (translation, rotation) [step, 6, 6], of x, y and z alone [step, 3, 3], or of all seven numbers [step, 7, 7]."""

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

    def moved(self, turn: Any, pivot: Array, at: Array, turned: Sequence[int] = ()) -> Poses:
        """The poses in a frame that is turned about `pivot`, which comes to lie at `at`; of the covariances the blocks
        of three that begin at the indices `turned` are turned, too."""
        covariance = self.covariance
        if covariance is not None and len(turned):
            J = np.eye(covariance.shape[-1])
            for i in (i for i in turned if i < len(J)):
                J[i : i + 3, i : i + 3] = turn.as_matrix()
            covariance = J @ covariance @ J.T
        places, turns = at + turn.apply(self.pose[:, :3] - pivot), turn * rotation(self.pose[:, 3:])
        return self._replace(pose=np.hstack([places, turns.as_quat()]), covariance=covariance)


def _rotations() -> Any:
    return needed("scipy.spatial.transform", "scipy", "turn poses").Rotation


def rotation(quaternions: Array) -> Any:
    """Rotations of SciPy."""
    return _rotations().from_quat(quaternions)


def from_vectors(vectors: Array) -> Any:
    return _rotations().from_rotvec(vectors)


def quaternions(matrices: Array) -> Array:
    """Quaternions (x, y, z, w) of the nearest rotations."""
    turned: Array = _rotations().from_matrix(matrices).as_quat()
    return turned


def yaw_of(poses: Array) -> Any:
    x, y, z, w = np.moveaxis(poses[..., 3:], -1, 0)
    return np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))


def aligned(estimate: Poses, truth: Poses, align: str, turned: Sequence[int] = ()) -> Poses:
    """The truth, moved as a rigid body to the estimate: by their first poses, or so that the squared differences of the
    positions are smallest [Umeyama 1991, without a scale]; or turned about the vertical alone, by the rotation nearest
    to that of either [Zhang and Scaramuzza 2018, III.C]."""
    if align == "none":
        return truth
    e, t = estimate.pose, truth.pose
    if align.startswith("first"):
        pivot, at = t[0, :3], e[0, :3]
        turn = rotation(e[0, 3:]) * rotation(t[0, 3:]).inv()
        matrix = turn.as_matrix()
    else:
        pivot, at = t[:, :3].mean(axis=0), e[:, :3].mean(axis=0)
        matrix = (e[:, :3] - at).T @ (t[:, :3] - pivot)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of positions on a line, about which any turn will do
            turn = _rotations().align_vectors(e[:, :3] - at, t[:, :3] - pivot)[0]
    if align.endswith("yaw"):
        turn = from_vectors(np.array([0, 0, np.arctan2(matrix[1, 0] - matrix[0, 1], matrix[0, 0] + matrix[1, 1])]))
    return truth.moved(turn, pivot, at, turned)


def body_offset(body: Any) -> Array | None:
    """The pose of the estimate's body in that of the truth: seven numbers, or the three of its position."""
    if body is None:
        return None
    try:
        offset = np.asarray(body, dtype=float).ravel()
        offset = np.concatenate([offset, [0.0, 0, 0, 1]]) if offset.size == 3 else offset
    except (TypeError, ValueError):
        offset = np.array([np.nan])
    if offset.size != 7 or not np.isfinite(offset).all():
        raise invalid("body", body, "must be 7 finite numbers, or 3", "Give x,y,z,qx,qy,qz,qw, or x,y,z")
    require_unit(argument("body"), offset[None, 3:])
    return offset


def with_body(truth: Poses, offset: Array | None) -> Poses:
    """The true poses of the body that is estimated."""
    if offset is None:
        return truth
    turns = rotation(truth.pose[:, 3:])
    places = truth.pose[:, :3] + turns.apply(offset[:3])
    return truth._replace(pose=np.hstack([places, (turns * rotation(offset[3:])).as_quat()]))


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


def away(estimate: Poses, truth: Poses, kept: Sequence[int]) -> tuple[float, str]:
    """How many sigmas, and how far, the first pose is from its truth."""
    assert estimate.covariance is not None
    places = [i for i in kept if i < 3]
    distance = float(np.linalg.norm((estimate.pose[0] - truth.pose[0])[places]))
    sigmas = _sigmas(distance, estimate.covariance[0][np.ix_(places, places)]) if places else 0.0
    far = f"{distance:.3g} m"
    turns = [i for i in kept if i >= 3]
    if turns:
        half = float(normalised(estimate.pose[0, 3:]) @ normalised(truth.pose[0, 3:]))
        angle = 2 * math.acos(min(abs(half), 1.0))
        if len(turns) == 1:
            angle = abs(float(wrapped(yaw_of(estimate.pose[0]) - yaw_of(truth.pose[0]))))
        if (of_angle := _sigmas(angle, estimate.covariance[0][np.ix_(turns, turns)])) > sigmas:
            sigmas, far = of_angle, f"{angle:.3g} rad"
    return sigmas, far


def check_frames(runs: Sequence[tuple[Poses, Poses]], kept: Sequence[int]) -> None:
    """Notes frames of other names, and first poses that are far from the truth: of all logs those of the farthest."""
    sigmas, far, at = max((*away(estimate, truth, kept), -i) for i, (estimate, truth) in enumerate(runs))
    estimate, truth = runs[-at]
    if estimate.frame and truth.frame and estimate.frame != truth.frame:
        note(f"{estimate.source}: its poses are in the frame {estimate.frame}, those of the truth in {truth.frame}")
    if sigmas > 5:
        of = f", the farthest of {len(runs)} logs" if len(runs) > 1 else ""
        say = f"{argument('align')} first-yaw of a filter that feels gravity, or first"
        note(
            f"{estimate.source}: its first pose is {far} from the truth, {sigmas:.3g} sigmas{of}. Are both in one "
            f"frame? Nothing is aligned unless you ask for it ({say})."
        )


def log_of(turns: Any, places: Array) -> Array:
    """[step, 6]: Log of poses on SE(3), translation and rotation vector [Barfoot 2017, 7.1.3]."""
    w = turns.as_rotvec()
    angle = np.maximum(np.linalg.norm(w, axis=1), 1e-7)[:, None]
    across = np.cross(w, places)
    share = 1 / angle**2 - (1 + np.cos(angle)) / (2 * angle * np.sin(angle))
    return np.hstack([places - across / 2 + share * np.cross(w, across), w])


def errors_of(estimate: Array, truth: Array, manifold: str, chart: str) -> Array:
    """[step, 6]: errors of poses [step, 7]."""
    E, T, apart = rotation(estimate[:, 3:]), rotation(truth[:, 3:]), estimate[:, :3] - truth[:, :3]
    turn = T.inv() * E if chart == "local" else E * T.inv()
    if manifold != "SE3":
        return np.hstack([apart, turn.as_rotvec()])
    return log_of(turn, T.inv().apply(apart) if chart == "local" else estimate[:, :3] - turn.apply(truth[:, :3]))


def wrapped(angle: Any) -> Any:
    return np.remainder(angle + np.pi, 2 * np.pi) - np.pi
