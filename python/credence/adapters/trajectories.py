"""Arguments of :func:`credence.judge` from trajectories in text files."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from credence import InputError
from credence.adapters.frames import Poses, quaternions
from credence.adapters.orders import matrices_of, words_of
from credence.adapters.poses import pose_arguments
from credence.adapters.square import square_options, square_order
from credence.adapters.tables import (
    Array,
    Path,
    from_upper,
    match_times,
    normalised,
    note,
    paired,
    read_table,
    require_positive,
    require_unit,
    require_width,
    seconds,
    stacked,
    text_of,
    units_given,
)

_pose_columns = 8  # time, x, y, z, and the quaternion x, y, z, w
_like_matrices = {wide + behind: wide for wide in (12, 16) for behind in (0, 21, 36)}  # numbers of a line of KITTI
_w_last = [0, 1, 2, 4, 5, 6, 3]  # of the numbers of a pose in EuRoC's files
_covariance_numbers = {36: 6, 21: 6, 49: 7, 28: 7}  # behind a pose; of seven, those of its quaternion
_names: dict[str, Any] = {
    "component_names": ["x", "y", "z", "rx", "ry", "rz"],
    "component_units": ["m"] * 3 + ["rad"] * 3,
}


def _nearest(estimate: Path, truth: Path, columns: Sequence[int], max_difference: float) -> tuple[Array, Array]:
    """Rows of the estimate's file, and the poses of the truth's at the same times."""
    estimated, true = read_table(estimate, *columns), read_table(truth)
    require_width(truth, true, least=_pose_columns)
    for path, table in ((estimate, estimated), (truth, true)):
        seconds(os.fspath(path), table[:, 0], "s")
        require_unit(os.fspath(path), table[:, 4:8])
    estimated, true = (rows[np.argsort(rows[:, 0], kind="stable")] for rows in (estimated, true))
    of_estimate, of_truth = match_times(estimated[:, 0], true[:, 0], max_difference)
    if not of_estimate.size:
        message = f"no time of it is within {max_difference} s of one in {os.fspath(truth)}"
        raise InputError(f"{os.fspath(estimate)}: {message}. Give the truth of this run, or a larger max_difference.")
    return estimated[of_estimate], true[of_truth, :_pose_columns]


def _poses(rows: Sequence[Array]) -> Array:
    """x, y, z and a unit quaternion, of every run."""
    return stacked([np.hstack([run[:, 1:4], normalised(run[:, 4:8])]) for run in rows])


def read_poses(
    path: Path, times: Path | None = None, units: Mapping[str, str] | None = None, name: str = "truth_time",
    order: str | Sequence[str] | None = None,
) -> Poses:  # fmt: skip
    """Poses of a text file in the format of TUM, EuRoC or KITTI, which its separators and columns tell; `units` may say
    the unit of its times by this name, and `order` that of its covariances."""
    source, asked = os.fspath(path), (units or {}).get(name)
    with text_of(path) as encoding, open(path, encoding=encoding) as file:
        euroc = "," in next((line for line in file if line.strip() and not line.startswith("#")), "")
    table = read_table(path, delimiter="," if euroc else None)
    require_width(path, table, least=_pose_columns)
    if wide := 0 if euroc else _matrix_numbers(table):
        return _of_matrices(path, table, wide, times, asked, name, order)
    words = words_of(order, "qw first")
    pose = table[:, 1:8][:, _w_last if euroc or "qw first" in words else slice(None)]
    behind = table.shape[1] - _pose_columns
    if not euroc and table.shape[1] in _like_matrices:
        has = f"its lines have {table.shape[1]} numbers"
        if not (np.abs(np.linalg.norm(pose[:, 3:], axis=1) - 1) < 0.1).all():
            either = "begin neither with a rotation beside a position (KITTI) nor with a time and a pose (TUM)"
            raise InputError(f"{source}: {has} and {either}. Check what kind of file it is.")
        note(f"{source}: {has} and are no matrices of KITTI: the first 8 are taken for TUM's time and pose")
    stamps = seconds(source, table[:, 0], asked or ("ns" if euroc else "s"), name, noted=not asked)
    covariance = _behind(path, table, _pose_columns, behind if behind in _covariance_numbers else 0, order)
    if euroc and covariance is not None and behind in (49, 28):
        covariance = covariance[:, _w_last][..., _w_last]
    return Poses(source, stamps, pose, covariance)


def _matrix_numbers(table: Array) -> int:
    """How many numbers each line begins with that are a pose's matrix, 12 or, with its last row, 16; 0: none."""
    wide = _like_matrices.get(table.shape[1], 0)
    there = np.isfinite(table[:, :wide]).all(axis=1)
    if not wide or not there.any():
        return 0
    matrices = table[there, :wide].reshape(-1, wide // 4, 4)
    R, last = matrices[:, :3, :3], matrices[:, 3:]
    turns = np.abs(R @ R.swapaxes(1, 2) - np.eye(3)).max() < 0.01 and (np.linalg.det(R) > 0).all()
    return wide if turns and (last == [0, 0, 0, 1]).all() else 0


def _of_matrices(
    path: Path, table: Array, wide: int, times: Path | None, asked: str | None, name: str,
    order: str | Sequence[str] | None,
) -> Poses:  # fmt: skip
    source = os.fspath(path)
    matrices, there = table[:, :12].reshape(-1, 3, 4), np.isfinite(table[:, :12]).all(axis=1)
    pose = np.hstack([matrices[:, :, 3], np.full((len(table), 4), np.nan)])
    pose[there, 3:] = quaternions(matrices[there, :, :3])
    covariance = _behind(path, table, wide, table.shape[1] - wide, order)
    if times is None:
        return Poses(source, np.arange(float(len(table))), pose, covariance, counted=True)
    stamps = seconds(os.fspath(times), read_table(times, 1)[:, 0], asked or "s", name, noted=not asked)
    if len(stamps) != len(table):
        has = f"it has {len(stamps)} times, and {source} {len(table)} poses"
        raise InputError(f"{os.fspath(times)}: {has}. Give the time of each pose.")
    return Poses(source, stamps, pose, covariance)


def _behind(path: Path, table: Array, first: int, count: int, order: str | Sequence[str] | None) -> Array | None:
    """The covariances in `count` numbers behind the poses."""
    if not count:
        return None
    words = words_of(order, "qw first") or (square_order(path) if count == 21 else [])
    turns = (3, 4, 5) if _covariance_numbers[count] == 6 else ()
    return matrices_of(os.fspath(path), table[:, first : first + count], _covariance_numbers[count], words, turns)


def from_files(
    estimate: Path | Sequence[Path], truth: Path | Sequence[Path], times: Path | None = None,
    units: Mapping[str, str] | None = None, order: str | Sequence[str] | None = None, **options: Any,
) -> dict[str, Any]:  # fmt: skip
    """Of files in any of the three formats, with the options of from_tum."""
    units = units_given(units, {"time": ["time"], "truth_time": ["time"]})
    files = paired(estimate, truth)
    options = square_options(files, options)
    pairs = [
        (read_poses(e, times, units, "time", order), read_poses(t, times, units, "time" if times else "truth_time"))
        for e, t in files
    ]
    return pose_arguments(pairs, **options)


def from_tum(
    estimate: Path | Sequence[Path],
    truth: Path | Sequence[Path],
    *,
    manifold: str = "SE3",
    chart: str = "local",
    max_gap: float = 0.2,
    align: str = "none",
    time_offset: float = 0.0,
    planar: bool | None = None,
    body: Any = None,
    units: Mapping[str, str] | None = None,
    order: str | Sequence[str] | None = None,
) -> dict[str, Any]:
    """Trajectories in TUM's format, with the covariance of each pose behind it.

    A line is ``time x y z qx qy qz qw`` (s, m), and in the estimate 36 further numbers, the covariance of
    (translation, rotation) row by row (m, rad; the order of a ROS ``PoseWithCovariance``), or 21, a triangle;
    49 or 28 are that of the seven numbers of the pose as they stand in the line, which is on ``"R3 x SO3"``.

    What is found and not used (frames that seem to differ, a time offset, poses without a truth, components that are
    not estimated) is noted as a Python warning.

    Parameters
    ----------
    estimate, truth : path, or list of paths
        A file for each run. The truth may be one file for all runs, in the format of TUM, EuRoC or KITTI; columns
        behind its poses are ignored.
    manifold : ``"SE3"`` or ``"R3 x SO3"``
        What the covariance is of: Log on SE(3), or the difference of positions beside the rotation vector.
    chart : ``"local"`` or ``"global"``
        Whether the error is in the body's frame or in the world's; of ``"R3 x SO3"`` the rotation's alone.
    max_gap : float
        The truth is interpolated between two poses that are at most so far apart (s). Poses without a truth are left
        out.
    align : ``"none"``, ``"first"``, ``"se3"``, ``"first-yaw"`` or ``"yaw"``
        What moves the truth to the estimate: nothing, the first pose, which is then not judged, or the rigid motion
        that makes the squared differences of positions smallest (in ``evo``: ``--align``); or of both the turn about
        the vertical alone, beside the translation, for filters that know it. It makes errors smaller than they are.
    time_offset : float
        What is added to the times of the estimate (s).
    planar : bool
        Whether x, y and yaw alone are judged, on ``SE2`` or, of ``"R3 x SO3"``, on ``R2 x SO2``. By default what the
        log estimates is judged: without components whose variance is a placeholder (zero, negative, 10^6), and without
        z, roll and pitch that never change.
    body : array [7] or [3]
        The pose (x, y, z and the quaternion x, y, z, w; m) of the body whose poses are estimated in the body whose
        poses the truth has, such as a camera's in that of a prism.
    units : dict
        Of `time` and `truth_time`, ``"s"``, ``"ms"``, ``"us"`` or ``"ns"``, where a file has another unit than its
        format: ``{"time": "ms"}``. Times that would be less than 1 µs apart are refused.
    order : str, or list of str
        Of the numbers of the estimate's covariance, as of :func:`from_table`; and ``"qw first"``, of its quaternion.

    Returns
    -------
    dict
        `truth` and `estimate` [trial, step, 7], `covariance` [trial, step, 6, 6], `steps` [trial], `time` [trial, step]
        (s), and what these are: `manifold`, `chart`, `quaternion`, names and units. Where fewer components are judged,
        the states and covariances of these, or `error`.

    Raises
    ------
    InputError
        If a line has another number of columns or no pose, the estimate has no covariances, no pose has a truth, or the
        unit of the times cannot be right.
    """
    return from_files(
        estimate, truth, units=units, order=order,
        manifold=manifold, chart=chart, max_gap=max_gap, align=align, time_offset=time_offset, planar=planar, body=body,
    )  # fmt: skip


def from_euroc(estimate: Path | Sequence[Path], truth: Path | Sequence[Path], **options: Any) -> dict[str, Any]:
    """Trajectories in the format of EuRoC's ground truth (ASL), with the covariance of each pose behind it.

    A line is ``time,x,y,z,qw,qx,qy,qz`` (ns, m), and in the estimate 36 or 21 further numbers, as of :func:`from_tum`.
    The truth may be a file of EuRoC (``state_groundtruth_estimate0/data.csv``) or TUM. Options, what is returned and
    what is raised are those of :func:`from_tum`.
    """
    return from_files(estimate, truth, **options)


def from_square(estimate: Path | Sequence[Path], truth: Path | Sequence[Path], **options: Any) -> dict[str, Any]:
    """SQUARE files of smfeval, whose lines are of TUM's format with the lower triangle of the covariance behind.

    Their headers say whether the error is in the body's frame or in the world's, and the gauge: ``fixed``, ``se3`` and
    ``gravity_yaw`` are `align` ``"none"``, ``"se3"`` and ``"yaw"``, unless it is given. The body is noted. The
    truth may be a file of TUM, EuRoC or KITTI. Options, what is returned and what is raised are those of
    :func:`from_tum`, which reads lines without a header.
    """
    return from_files(estimate, truth, **options)


def from_kitti(
    estimate: Path | Sequence[Path], truth: Path | Sequence[Path], times: Path | None = None, **options: Any
) -> dict[str, Any]:
    """Trajectories in KITTI's format, with the covariance of each pose behind it.

    A line has the 12 numbers of the upper rows of the pose's matrix [R t], row by row (m), or the 16 of all rows, and
    in the estimate 36 or 21 further numbers, as of :func:`from_tum`. `times` is the file of their times (s); without it
    the lines of both files belong to each other, and must be as many. Options, what is returned and what is raised are
    those of :func:`from_tum`.
    """
    return from_files(estimate, truth, times, **options)


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
    files = paired(estimate, truth)
    if deviation is not None:
        runs = [_simulated(*pair, sigmas) for pair, (_, sigmas) in zip(files, paired(estimate, deviation))]
        return _of_simulations(runs)
    pairs = [_nearest(e, t, (20,), max_difference) for e, t in files]
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
        require_width(path, table, least=least)
        if not np.array_equal(table[:, 0], tables[0][:, 0]):
            other = f"its times are not those of {os.fspath(estimate)}"
            raise InputError(f"{os.fspath(path)}: {other}. Give files of one simulation.")
    for path, table in zip((estimate, truth), tables):
        require_unit(os.fspath(path), table[:, 1:5])
    require_positive(os.fspath(deviation), "a standard deviation", tables[2][:, 1:16])
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
