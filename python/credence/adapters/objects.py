"""Arguments of :func:`credence.judge` from the objects of estimation libraries."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from credence import InputError
from credence._arrays import numbers
from credence.adapters.tables import stacked

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
        `steps` [trial], `manifold`, `chart`, `component_names`, `component_units`, and `quaternion` where poses are of
        SE(3).

    Raises
    ------
    InputError
        If the covariances do not have the dimension of the poses, or are not as many.

    Notes
    -----
    Log is the chart of ``Pose2`` and ``Pose3`` in the wheels of GTSAM 4.3. A GTSAM built without
    ``GTSAM_SLOW_BUT_CORRECT_EXPMAP`` or ``GTSAM_POSE3_EXPMAP`` has another one, which agrees to first order.
    """
    runs = [[list(run) for run in poses] for poses in (truth, estimate)]
    steps = [len(run) for run in runs[0]]
    matrices = [numbers("covariance", run, single=True) for run in covariance]
    if not steps == [len(run) for run in runs[1]] == [len(run) for run in matrices]:
        raise InputError("truth, estimate and covariance do not have the same steps. Give one of each for every pose.")
    joint = stacked(matrices)
    planar = hasattr(runs[0][0][0], "theta")
    coordinates, dimension = (_pose2, 3) if planar else (_pose3, 6)
    if joint.shape[-2:] != (dimension, dimension):
        raise InputError(f"invalid covariance of shape {joint.shape[-2:]} (a pose has {dimension} components)")
    true, estimated = (stacked([np.array([coordinates(pose) for pose in run]) for run in each]) for each in runs)
    arguments = {"truth": true, "estimate": estimated, "chart": "local", "steps": np.array(steps)}
    if planar:
        names = {"component_names": ["x", "y", "angle"], "component_units": ["m", "m", "rad"]}
        return arguments | names | {"covariance": joint, "manifold": "SE2"}
    joint = joint[..., _rotation_last, :][..., _rotation_last]
    names = {"component_names": ["x", "y", "z", "rx", "ry", "rz"], "component_units": ["m"] * 3 + ["rad"] * 3}
    return arguments | names | {"covariance": joint, "manifold": "SE3", "quaternion": "wxyz"}


def _associated(path: Iterable[Any], states: Iterable[Any], run: int) -> list[tuple[Any, Any]]:
    """Truth and estimate at the same times; of several states of a track at one time the last, its update."""
    true, estimated = list(path), list(states)
    times = [getattr(state, "timestamp", None) for state in (*true, *estimated)]
    if all(time is None for time in times):
        if len(true) != len(estimated):
            why = f"run {run}: its track has {len(estimated)} states without times, and its truth {len(true)}"
            raise InputError(f"{why}. Give states at the same times.")
        return list(zip(true, estimated))
    if None in times:
        raise InputError(f"run {run}: some of its states have a timestamp, and some have none. Give all of them times.")
    at = {state.timestamp: state for state in true}
    last = {state.timestamp: state for state in estimated}
    pairs = [(at[time], last[time]) for time in sorted(last) if time in at]
    if not pairs:
        raise InputError(f"run {run}: no state of its track has the time of one of its truth. Give this run's truth.")
    return pairs


def from_stonesoup(truth: Iterable[Iterable[Any]], track: Iterable[Iterable[Any]]) -> dict[str, Any]:
    """Tracks of Stone Soup beside their ground truth.

    Parameters
    ----------
    truth : nested iterable [trial][step]
        Ground-truth paths: states with `state_vector`.
    track : nested iterable [trial][step]
        Tracks: Gaussian states with `state_vector` and `covar`. A state is compared with the truth of the same
        `timestamp`, and left out if there is none; of several states at one time the last counts. States without
        timestamps are compared in their order.

    Returns
    -------
    dict
        `error` [trial, step, n] and `covariance` [trial, step, n, n], in the units of the state, and `steps` [trial].

    Raises
    ------
    InputError
        If a track and its truth have no time in common, or differ in length without having times.

    Notes
    -----
    A difference of state vectors wraps the angles that Stone Soup knows as angles (``Bearing``), and no others.
    """
    runs = [_associated(*pair, run) for run, pair in enumerate(zip(truth, track, strict=True))]
    errors = [[np.ravel(np.asarray(e.state_vector - t.state_vector, dtype=float)) for t, e in pairs] for pairs in runs]
    covariances = [[np.asarray(estimated.covar, dtype=float) for _, estimated in pairs] for pairs in runs]
    return {
        "error": stacked([np.array(run) for run in errors]),
        "covariance": stacked([np.array(run) for run in covariances]),
        "steps": np.array([len(pairs) for pairs in runs]),
    }


def from_navlie(results: Any) -> dict[str, Any]:
    """Results of navlie.

    Parameters
    ----------
    results
        A ``MonteCarloResult``, one ``GaussianResultList``, or a list of them: a run each, with `error` [step, n],
        `covariance` [step, n, n] and `stamp` [step] (s).

    Returns
    -------
    dict
        `error` [trial, step, n], with the sign of estimate - truth (navlie's is the other one), `covariance`
        [trial, step, n, n], `steps` [trial] and `time` [trial, step].

    Raises
    ------
    InputError
        If there are no results.
    """
    runs = getattr(results, "trial_results", results)
    runs = [runs] if hasattr(runs, "covariance") else list(runs)
    if not runs:
        raise InputError("there are no results of navlie. Give a MonteCarloResult, or a list of GaussianResultList.")
    return {
        "error": -stacked([numbers("error", run.error, single=True) for run in runs]),
        "covariance": stacked([numbers("covariance", run.covariance, single=True) for run in runs]),
        "steps": np.array([len(run.stamp) for run in runs]),
        "time": stacked([numbers("time", run.stamp, single=True) for run in runs]),
    }
