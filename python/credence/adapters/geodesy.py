"""Positions on the Earth (WGS 84), which pymap3d converts, and their errors in east, north and up."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from credence._errors import InputError
from credence.adapters.frames import Poses
from credence.adapters.poses import pose_arguments
from credence.adapters.tables import Array, needed

EARTH = "the Earth's"  # the frame of positions x, y, z that turns with it
_names = {"x": "east", "y": "north", "z": "up"}


def _pymap3d() -> Any:
    return needed("pymap3d", "pymap3d", "place positions on the Earth")


def positions(latitude: ArrayLike, longitude: ArrayLike, height: ArrayLike) -> Array:
    """[step, 3]: x, y, z in the Earth's frame (m) of degrees and of heights above the ellipsoid (m)."""
    return np.stack(_pymap3d().geodetic2ecef(*map(np.asarray, (latitude, longitude, height))), axis=-1)


def axes(latitude: ArrayLike, longitude: ArrayLike) -> Array:
    """[step, 3, 3]: the unit vectors to the east, to the north and up, one a row, in the Earth's frame."""
    turned = [_pymap3d().enu2uvw(*axis, np.asarray(latitude), np.asarray(longitude)) for axis in np.eye(3)]
    return np.stack([np.stack(np.broadcast_arrays(*each), axis=-1) for each in turned], axis=-2)


def fixes(source: str, time: Array, place: Array, covariance: Array | None = None, frame: str = EARTH) -> Poses:
    """Positions [step, 3] with their covariances [step, 3, 3] in the same frame, as poses that do not turn."""
    return Poses(source, time, np.hstack([place, np.tile([0.0, 0, 0, 1], (len(place), 1))]), covariance, frame)


def _about_first(estimate: Poses, truth: Poses) -> tuple[Poses, Poses]:
    """Both in east, north and up about the first position of the estimate."""
    if estimate.frame != truth.frame:
        frames = f"its positions are in the frame {estimate.frame or 'of a map'}, those of the truth in {truth.frame}"
        raise InputError(f"{estimate.source}: {frames}. Give both in one.")
    if estimate.frame != EARTH:
        return estimate, truth
    here = estimate.pose[np.isfinite(estimate.pose).all(axis=1), :3][:1].ravel()
    if not here.size:
        raise InputError(f"{estimate.source}: none of its positions is finite. Give a log with fixes.")
    A = axes(*_pymap3d().ecef2geodetic(*here)[:2])

    def local(poses: Poses) -> Poses:
        covariance = None if poses.covariance is None else A @ poses.covariance @ A.T
        return fixes(poses.source, poses.time, (poses.pose[:, :3] - here) @ A.T, covariance, "")

    return local(estimate), local(truth)


def standing(estimate: Poses, point: Any, time_offset: float = 0.0) -> Poses | None:
    """The truth of a receiver that stands still: three numbers, also as a text; None where they are a path."""
    given = point[0] if isinstance(point, (list, tuple)) and len(point) == 1 else point
    numbers = given.split(",") if isinstance(given, str) and not os.path.exists(given) else given
    try:
        place = np.array([[float(one) for one in numbers]])
    except (TypeError, ValueError):
        return None
    if place.shape != (1, 3):
        return None
    place = positions(*place.T) if estimate.frame == EARTH else place
    times = estimate.time + time_offset
    return fixes("the point", times, np.tile(place, (len(times), 1)), None, estimate.frame)


def fix_arguments(pairs: Sequence[tuple[Poses, Poses]], **options: Any) -> dict[str, Any]:
    """The arguments of judge from positions and their truth, with the options of pose_arguments."""
    pairs = [_about_first(*pair) for pair in pairs]
    arguments = pose_arguments(pairs, **{**options, "manifold": "R3 x SO3", "chart": "global"})
    return arguments | {"component_names": [_names[name] for name in arguments["component_names"]]}
