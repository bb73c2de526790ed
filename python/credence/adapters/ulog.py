"""Arguments of :func:`credence.judge` from logs of PX4, read by `pyulog`."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

import numpy as np

from credence import InputError
from credence.adapters.tables import Array, Path, existing, needed, note, one_line

_innovations, _variances, _both = "estimator_innovations", "estimator_innovation_variances", "ekf2_innovations"
_time = "timestamp"


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
    pyulog = needed("pyulog", "pyulog", "read .ulg")
    source = existing(path)
    try:
        log = pyulog.ULog(source)
    except Exception as error:  # pyulog raises what its parser runs into
        raise InputError(f"{source}: it cannot be read as a log of PX4 ({one_line(error)}). Check the path.") from None
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


def _field(name: str) -> str:
    return name.partition("[")[0]
