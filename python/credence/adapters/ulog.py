"""Arguments of :func:`credence.judge` from logs of PX4, read by `pyulog`."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

import numpy as np

from credence import InputError
from credence.adapters.frames import Poses
from credence.adapters.geodesy import fixes
from credence.adapters.poses import in_order, interpolated, pose_arguments, without_gaps
from credence.adapters.tables import Array, Path, existing, from_upper, needed, note, one_line, paired

_innovations, _variances, _both = "estimator_innovations", "estimator_innovation_variances", "ekf2_innovations"
_time = "timestamp"


def _log(path: Path) -> tuple[Any, str]:
    pyulog = needed("pyulog", "pyulog", "read .ulg")
    source = existing(path)
    try:
        return pyulog.ULog(source), source
    except Exception as error:  # pyulog raises what its parser runs into
        raise InputError(f"{source}: it cannot be read as a log of PX4 ({one_line(error)}). Check the path.") from None


def _series(log: Any, source: str, instance: int) -> tuple[dict[str, Array], dict[str, Array]]:
    """The innovations and variances by the names of their fields, a row each time [s in ``timestamp``]."""
    data = {one.name: one.data for one in log.data_list if one.multi_id == instance}
    if _innovations in data and _variances in data:
        parts = data[_innovations], data[_variances]
        key = "timestamp_sample" if "timestamp_sample" in parts[0] else _time
        common, one, other = np.intersect1d(parts[0][key], parts[1][key], return_indices=True)
        if len(common) < len(parts[0][key]):
            note(f"{source}: {len(parts[0][key]) - len(common)} innovations have no variance, and are left out")
        names = [name for name in parts[0] if name in parts[1] and not name.startswith(_time)]
        rows = [{name: part[name][at].astype(float) for name in names} for part, at in zip(parts, (one, other))]
        return {**rows[0], _time: common * 1e-6}, rows[1]
    if _both not in data:
        there = ", ".join(sorted({f"{one.name} {one.multi_id}" for one in log.data_list if "innov" in one.name}))
        wanted = f"{_innovations} with {_variances}, or {_both}"
        raise InputError(f"{source}: it has no {wanted}, of instance {instance} (it has {there or 'no innovations'}).")
    fields, innovation = data[_both], re.compile(r"_innov(?=\[|$)")
    names = [name for name in fields if innovation.search(name) and innovation.sub("_innov_var", name) in fields]
    return (
        {innovation.sub("", name): fields[name].astype(float) for name in names} | {_time: fields[_time] * 1e-6},
        {innovation.sub("", name): fields[innovation.sub("_innov_var", name)].astype(float) for name in names},
    )


def from_ulog(path: Path, rows: Sequence[str] | None = None, *, instance: int = 0) -> dict[str, Any]:
    """Innovations and their variances in a log of PX4's EKF2 (``.ulg``), which needs no truth.

    Needs `pyulog`. Takes ``estimator_innovations`` with ``estimator_innovation_variances``, or ``ekf2_innovations`` of
    older logs. The innovation takes the place of the error, and its variance that of the covariance, so that NEES is
    NIS; what is said of the state is then said of the innovations. Whether they are white is not looked at. A row is
    observed where its value or variance is another one than at the time before, and neither is zero, because the log
    repeats what was not measured again. Steps are the times at which all rows are observed.

    Parameters
    ----------
    path
        The log.
    rows : list of str
        Names of fields, such as ``gps_hpos`` (all of its elements) or ``baro_vpos``; by default all that were observed
        at least twice.
    instance : int
        Of the estimator, where several run.

    Returns
    -------
    dict
        `error` [1, step, m] and variances `covariance` [1, step, m] in the units of the log, `time` [1, step] (s),
        `groups`, one for each field, and `component_names`. Correlations are not in the log, so that the verdict is
        never `consistent`.

    Raises
    ------
    InputError
        If the log has no innovations, none of these rows, or no time at which all of them were observed.
    """
    log, source = _log(path)
    innovations, variances = _series(log, source, instance)
    chosen = {}
    for name, variance in variances.items():
        pair = np.stack([innovations[name], variance])
        new = np.r_[True, (np.diff(pair, axis=1) != 0).any(axis=0)] & (pair != 0).all(axis=0) & (variance > 0)
        new &= np.isfinite(pair).all(axis=0)
        if (rows is None or name in rows or _field(name) in rows) and new.sum() > 1:
            chosen[name] = new
    if not chosen:
        raise InputError(f"{source}: no row was observed. Give some of {', '.join(variances)}.")
    all_new, any_new = np.all(list(chosen.values()), axis=0), np.any(list(chosen.values()), axis=0)
    steps = np.flatnonzero(all_new)
    if all_new.sum() < any_new.sum():
        counts = ", ".join(f"{name} {new.sum()}" for name, new in chosen.items())
        told = f"all rows were observed at {all_new.sum()} of {any_new.sum()} times ({counts})"
        if not len(steps):
            raise InputError(f"{source}: {told}. Give the rows of one sensor.")
        note(f"{source}: {told}, and the others are left out. The rows of one sensor have more.")
    fields, times = [_field(name) for name in chosen], innovations[_time][steps]
    return {
        "error": np.stack([innovations[name][steps] for name in chosen], axis=-1)[None],
        "covariance": np.stack([variances[name][steps] for name in chosen], axis=-1)[None],
        "time": times[None] if (np.diff(times) > 0).all() else None,  # some logs have zeros
        "groups": {field: [i for i, of in enumerate(fields) if of == field] for field in dict.fromkeys(fields)},
        "component_names": [name.replace("[", "_").replace("]", "") for name in chosen],
    }


def from_px4(path: Path | Sequence[Path], *, max_gap: float = 0.2, **options: Any) -> dict[str, Any]:
    """Poses of PX4's estimator in logs of simulations (``.ulg``), against the truth that the simulator publishes.

    Needs `pyulog`. Takes ``vehicle_odometry`` or else ``estimator_states``: positions north, east and down, and
    orientations with their variances, of turns about the axes of the body or, in the states, of the Earth; of logs
    before 1.14 the covariances of the odometry, and of the states the variances of the quaternion. The truth is
    ``vehicle_local_position_groundtruth`` and ``vehicle_attitude_groundtruth``, moved to the estimator's origin where
    both are in the log (pymap3d).

    Parameters
    ----------
    path : path, or list of paths
        A log for each run.
    max_gap, **options
        As of :func:`from_tum`.

    Returns
    -------
    dict
        As of :func:`from_tum`, on ``R3 x SO3``; variances `covariance` [trial, step, 6] where the log has no others, so
        that the verdict is never `consistent`.

    Raises
    ------
    InputError
        If a log has no estimate with variances, or no truth; or as of :func:`from_tum`.
    """
    pairs, kinds = [], set()
    for one, _ in paired(path, path):
        log, source = _log(one)
        data = {topic.name: topic.data for topic in reversed(log.data_list)}
        places, turns = (data.get(f"vehicle_{what}_groundtruth") for what in ("local_position", "attitude"))
        odometry = data.get("vehicle_odometry", data.get("estimator_states"))
        if odometry is None or places is None or turns is None:
            wanted = "vehicle_local_position_groundtruth, vehicle_attitude_groundtruth, and vehicle_odometry"
            raise InputError(f"{source}: it has not all of {wanted} or estimator_states. Give the log of a simulation.")
        estimate, *kind = _estimated(source, odometry)
        kinds.add(tuple(kind))
        first = int(np.argmax(np.isfinite(estimate.pose).all(axis=1)))
        if first:
            note(f"{source}: {first} messages before the first pose are left out")
            estimate = estimate.at(np.arange(first, len(estimate.time)))
        origin = _origin(source, places, data.get("vehicle_local_position"))
        truth = fixes(f"{source} groundtruth", _seconds(places), _columns(places, *"xyz") + origin, None, "")
        found, at = interpolated(in_order(without_gaps(truth)), _seconds(turns), max_gap)
        pairs.append((estimate, at._replace(pose=np.hstack([at.pose[:, :3], _columns(turns, "q", 1, 2, 3, 0)[found]]))))
    (chart, alone), *others = kinds
    if others:
        raise InputError("logs have covariances of several kinds. Give those of one version of PX4 together.")
    arguments = pose_arguments(pairs, **{"manifold": "R3 x SO3", "chart": chart, "max_gap": max_gap, **options})
    if alone:
        arguments["covariance"] = np.diagonal(arguments["covariance"], axis1=-2, axis2=-1)
    return arguments


def _estimated(source: str, data: dict[str, Array]) -> tuple[Poses, str, bool]:
    """The poses of a topic, the chart of their covariances, and whether these are variances alone."""
    chart, q = "global", _columns(data, "q", 1, 2, 3, 0) if "q[0]" in data else _columns(data, "states", 1, 2, 3, 0)
    if "states[0]" in data:
        place = _columns(data, "states", 7, 8, 9)
        numbers = [sum(name.startswith(of) for name in data) for of in ("states", "covariances")]
        of_turns = (7, 8, 9, 1, 2, 3, 0) if numbers[0] == numbers[1] else (6, 7, 8, 0, 1, 2)
        variances = _columns(data, "covariances", *of_turns)
    elif "position_variance[0]" in data:
        chart, place = "local", _columns(data, "position", 0, 1, 2)
        variances = np.hstack([_columns(data, f"{of}_variance", 0, 1, 2) for of in ("position", "orientation")])
    else:
        place, P = _columns(data, *"xyz"), from_upper(_columns(data, "pose_covariance", *range(21)), 6)
        return Poses(source, _seconds(data), np.hstack([place, q]), P), chart, False
    P = variances[:, :, None] * np.eye(variances.shape[1])
    return Poses(source, _seconds(data), np.hstack([place, q]), P), chart, True


def _columns(data: dict[str, Array], *names: Any) -> Array:
    """Some fields; of one name and numbers those elements of it."""
    fields = [f"{names[0]}[{i}]" for i in names[1:]] if isinstance(names[-1], int) else names
    return np.stack([data[field].astype(float) for field in fields], axis=-1)


def _seconds(data: dict[str, Array]) -> Array:
    sampled = data.get("timestamp_sample", data[_time])
    return np.asarray(sampled if (sampled > 0).all() else data[_time]) * 1e-6


def _origin(source: str, truth: dict[str, Array], estimate: dict[str, Array] | None) -> Array:
    """What is added to north, east and down from the origin of the truth for those from that of the estimate (m)."""
    names = ("ref_lat", "ref_lon", "ref_alt")
    if estimate is None or any(name not in data for data in (truth, estimate) for name in names):
        return np.zeros(3)
    theirs, ours = (_columns(data, *names)[-1] for data in (truth, estimate))
    if theirs[2] == 0 or ours[2] == 0:  # simulators may leave it out
        theirs[2] = ours[2]
    if not np.isfinite([theirs, ours]).all() or (theirs == ours).all() or not (theirs[:2].any() and ours[:2].any()):
        return np.zeros(3)
    away = np.ravel(needed("pymap3d", "pymap3d", "move the truth to the origin").geodetic2ned(*theirs, *ours))
    note(f"{source}: the origin of its truth is moved by {np.linalg.norm(away):.3g} m, to that of the estimate")
    return away


def _field(name: str) -> str:
    return name.partition("[")[0]
