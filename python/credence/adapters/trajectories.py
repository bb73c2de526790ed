"""Arguments of :func:`credence.judge` from trajectories in text files."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

import numpy as np

from credence import InputError
from credence.adapters.tables import Array, Path, from_upper, match_times, normalised, path_list, read_table, stacked

_pose_columns = 8  # time, x, y, z, and the quaternion x, y, z, w
_names = {"component_names": ["x", "y", "z", "rx", "ry", "rz"], "component_units": ["m"] * 3 + ["rad"] * 3}


def _associated(estimate: Path, truth: Path, columns: Sequence[int], max_difference: float) -> tuple[Array, Array]:
    """Rows of the estimate's file, and the poses of the truth's at the same times."""
    estimated, true = read_table(estimate, *columns), read_table(truth)
    if true.shape[1] < _pose_columns:
        too_few = f"its lines have {true.shape[1]} numbers (must be at least {_pose_columns})"
        raise InputError(f"{os.fspath(truth)}: {too_few}")
    estimated, true = (rows[np.argsort(rows[:, 0], kind="stable")] for rows in (estimated, true))
    of_estimate, of_truth = match_times(estimated[:, 0], true[:, 0], max_difference)
    if not of_estimate.size:
        message = f"no time of it is within {max_difference} s of one in {os.fspath(truth)}"
        raise InputError(f"{os.fspath(estimate)}: {message}. Give the truth of this run, or a larger max_difference.")
    return estimated[of_estimate], true[of_truth, :_pose_columns]


def _poses(rows: Sequence[Array]) -> Array:
    """x, y, z and a unit quaternion, of every run."""
    return stacked([np.hstack([run[:, 1:4], normalised(run[:, 4:8])]) for run in rows])


def from_tum(
    estimate: Path | Sequence[Path],
    truth: Path | Sequence[Path],
    *,
    manifold: str = "SE3",
    chart: str = "local",
    max_difference: float = 0.01,
) -> dict[str, Any]:
    """Trajectories in TUM's format, with the covariance of each pose behind it.

    A line is ``time x y z qx qy qz qw`` (s, m), and in the estimate 36 further numbers, the covariance of
    (translation, rotation) row by row (m, rad; the order of a ROS ``PoseWithCovariance``), or 21, its upper triangle.

    Parameters
    ----------
    estimate, truth : path, or list of paths
        A file for each run. The truth may be one file for all runs; columns behind its poses are ignored.
    manifold : ``"SE3"`` or ``"R3 x SO3"``
        What the covariance is of: Log on SE(3), or the difference of positions beside the rotation vector.
    chart : ``"local"`` or ``"global"``
        Whether the error is in the body's frame or in the world's.
    max_difference : float
        How far the times of a pose and of its truth may be apart (s). Poses without a truth are left out.

    Returns
    -------
    dict
        `truth` and `estimate` [trial, step, 7], `covariance` [trial, step, 6, 6], `steps` [trial], `time` [trial, step]
        (s), and what these are: `manifold`, `chart`, `quaternion`, names and units.

    Raises
    ------
    InputError
        If a line has another number of columns, or no pose has a truth.
    """
    estimates, truths = path_list(estimate), path_list(truth)
    truths = truths * len(estimates) if len(truths) == 1 else truths
    pairs = [_associated(e, t, (44, 29), max_difference) for e, t in zip(estimates, truths, strict=True)]
    behind = [run[:, _pose_columns:] for run, _ in pairs]
    covariances = [rest.reshape(-1, 6, 6) if rest.shape[1] == 36 else from_upper(rest, 6) for rest in behind]
    return {
        "truth": _poses([run for _, run in pairs]),
        "estimate": _poses([run for run, _ in pairs]),
        "covariance": stacked(covariances),
        "steps": np.array([len(run) for run, _ in pairs]),
        "time": stacked([run[:, 0] for run, _ in pairs]),
        "manifold": manifold,
        "chart": chart,
        "quaternion": "xyzw",
        **_names,
    }


def from_openvins(
    estimate: Path | Sequence[Path],
    truth: Path | Sequence[Path],
    deviation: Path | Sequence[Path] | None = None,
    *,
    max_difference: float = 0.02,
) -> dict[str, Any]:
    """Text files of OpenVINS, as its ``ov_eval`` reads them.

    Of a simulation: ``state_estimate.txt``, ``state_groundtruth.txt`` and ``state_deviation.txt``, of which
    orientation, position, velocity and the biases of gyroscope and accelerometer are used, with their standard
    deviations. Without `deviation`: trajectories with the covariances of orientation and position behind each pose (20
    numbers a line). Orientations are OpenVINS' (JPL) quaternions, and their error is that of its NEES, in the body's
    frame; positions are differences in the world's.

    Parameters
    ----------
    estimate, truth, deviation : path, or list of paths
        A file for each run. The truth may be one file for all runs.
    max_difference : float
        How far the times of a pose and of its truth may be apart (s), as in ``ov_eval``. Files of a simulation have one
        line for each time.

    Returns
    -------
    dict
        Of a simulation `truth` and `estimate` [trial, step, 16] on ``SO3 x R12`` and variances `covariance`
        [trial, step, 15]; of trajectories [trial, step, 7] on ``R3 x SO3`` and `group_covariance`. With `groups`,
        `steps` and `time`. Correlations are in neither, so that the verdict is never `consistent`.

    Raises
    ------
    InputError
        If a line has another number of columns, no pose has a truth, or files of a simulation differ in their times.
    """
    estimates, truths = path_list(estimate), path_list(truth)
    truths = truths * len(estimates) if len(truths) == 1 else truths
    if deviation is not None:
        runs = [_simulated(*files) for files in zip(estimates, truths, path_list(deviation), strict=True)]
        return _of_simulations(runs)
    pairs = [_associated(e, t, (20,), max_difference) for e, t in zip(estimates, truths, strict=True)]
    return {
        "truth": _poses([run for _, run in pairs]),
        "estimate": _poses([run for run, _ in pairs]),
        "group_covariance": {
            "orientation": stacked([from_upper(run[:, 8:14], 3) for run, _ in pairs]),
            "position": stacked([from_upper(run[:, 14:20], 3) for run, _ in pairs]),
        },
        "groups": {"orientation": [3, 4, 5], "position": [0, 1, 2]},
        "steps": np.array([len(run) for run, _ in pairs]),
        "time": stacked([run[:, 0] for run, _ in pairs]),
        "manifold": "R3 x SO3",
        "chart": "local",
        "quaternion": "xyzw",
        **_names,
    }


def _simulated(estimate: Path, truth: Path, deviation: Path) -> tuple[Array, Array, Array]:
    """Rows of (time, quaternion, position, velocity, biases) of estimate and truth, and of (time, sigmas)."""
    tables = read_table(estimate), read_table(truth), read_table(deviation)
    for path, table, least in zip((estimate, truth, deviation), tables, (17, 17, 16)):
        if table.shape[1] < least:
            raise InputError(f"{os.fspath(path)}: its lines have {table.shape[1]} numbers (must be at least {least})")
        if not np.array_equal(table[:, 0], tables[0][:, 0]):
            raise InputError(f"{os.fspath(path)}: its times are not those of {os.fspath(estimate)}")
    return tables[0][:, :17], tables[1][:, :17], tables[2][:, :16]


def _of_simulations(runs: Sequence[tuple[Array, Array, Array]]) -> dict[str, Any]:
    parts = ("orientation", "position", "velocity", "gyro_bias", "accel_bias")
    letters, units = ("r", "p", "v", "bg", "ba"), ("rad", "m", "m/s", "rad/s", "m/s^2")
    states = [[np.hstack([normalised(run[i][:, 1:5]), run[i][:, 5:]]) for run in runs] for i in (0, 1)]
    return {
        "estimate": stacked(states[0]),
        "truth": stacked(states[1]),
        "covariance": stacked([sigma[:, 1:] ** 2 for _, _, sigma in runs]),
        "groups": {part: list(range(3 * i, 3 * i + 3)) for i, part in enumerate(parts)},
        "steps": np.array([len(run[0]) for run in runs]),
        "time": stacked([run[0][:, 0] for run in runs]),
        "manifold": "SO3 x R12",
        "chart": "local",
        "quaternion": "xyzw",
        "component_names": [letter + axis for letter in letters for axis in "xyz"],
        "component_units": [unit for unit in units for _ in range(3)],
    }
