"""Arguments of :func:`credence.judge` from the objects of estimation libraries."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from credence import InputError

_rotation_last = [3, 4, 5, 0, 1, 2]


def _pose2(pose: Any) -> Sequence[float]:
    return (pose.x(), pose.y(), pose.theta())


def _pose3(pose: Any) -> Sequence[float]:
    quaternion = pose.rotation().toQuaternion()
    return (*pose.translation(), quaternion.w(), quaternion.x(), quaternion.y(), quaternion.z())


def from_gtsam_poses(
    truth: Iterable[Iterable[Any]], estimate: Iterable[Iterable[Any]], covariance: Iterable[ArrayLike]
) -> dict[str, Any]:
    """Poses of GTSAM with their marginal covariances.

    Parameters
    ----------
    truth, estimate : nested iterables [trial][step]
        ``gtsam.Pose2`` or ``gtsam.Pose3`` (m, rad).
    covariance : iterable [trial] of arrays [step, d, d]
        As ``marginalCovariance`` returns them: d = 3 in the order (x, y, angle), d = 6 in the order (rotation,
        translation); of the error in the tangent space at the estimate.

    Returns
    -------
    dict
        `truth` and `estimate` [trial, step, 3 or 7], `covariance` [trial, step, d, d] with the translation first,
        `manifold`, `chart`, `component_names`, `component_units`, and `quaternion` where poses are of SE(3).

    Raises
    ------
    InputError
        If the covariances do not have the dimension of the poses.

    Notes
    -----
    Log is the chart of ``Pose2`` and ``Pose3`` in the wheels of GTSAM 4.3. A GTSAM built without
    ``GTSAM_SLOW_BUT_CORRECT_EXPMAP`` or ``GTSAM_POSE3_EXPMAP`` has another one, which agrees to first order.
    """
    runs = [[list(run) for run in poses] for poses in (truth, estimate)]
    joint = np.array([np.asarray(run, dtype=float) for run in covariance])
    planar = hasattr(runs[0][0][0], "theta")
    coordinates, dimension = (_pose2, 3) if planar else (_pose3, 6)
    if joint.shape[-2:] != (dimension, dimension):
        raise InputError(f"invalid covariance of shape {joint.shape[-2:]} (a pose has {dimension} components)")
    true, estimated = (np.array([[coordinates(pose) for pose in run] for run in each], dtype=float) for each in runs)
    arguments = {"truth": true, "estimate": estimated, "chart": "local"}
    if planar:
        names = {"component_names": ["x", "y", "angle"], "component_units": ["m", "m", "rad"]}
        return arguments | names | {"covariance": joint, "manifold": "SE2"}
    joint = joint[..., _rotation_last, :][..., _rotation_last]
    names = {"component_names": ["x", "y", "z", "rx", "ry", "rz"], "component_units": ["m"] * 3 + ["rad"] * 3}
    return arguments | names | {"covariance": joint, "manifold": "SE3", "quaternion": "wxyz"}


def from_stonesoup(truth: Iterable[Iterable[Any]], track: Iterable[Iterable[Any]]) -> dict[str, Any]:
    """Tracks of Stone Soup beside their ground truth.

    Parameters
    ----------
    truth : nested iterable [trial][step]
        Ground-truth paths: states with `state_vector`.
    track : nested iterable [trial][step]
        Tracks: Gaussian states with `state_vector` and `covar`, at the same times.

    Returns
    -------
    dict
        `error` [trial, step, n] and `covariance` [trial, step, n, n], in the units of the state.

    Raises
    ------
    InputError
        If a track and its truth differ in length.

    Notes
    -----
    A difference of state vectors wraps the angles that Stone Soup knows as angles (``Bearing``), and no others.
    """
    error, covariance = [], []
    for path, states in zip(truth, track, strict=True):
        pairs = list(zip(path, states, strict=True))
        error.append([np.ravel(np.asarray(e.state_vector - t.state_vector, dtype=float)) for t, e in pairs])
        covariance.append([np.asarray(estimated.covar, dtype=float) for _, estimated in pairs])
    return {"error": np.array(error), "covariance": np.array(covariance)}
