"""Arguments of :func:`credence.judge` from the solutions of RTKLIB."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

import numpy as np

from credence._errors import InputError, argument
from credence.adapters.frames import Poses
from credence.adapters.geodesy import axes, fix_arguments, fixes, positions, standing
from credence.adapters.tables import Array, Path, needed, note, one_line, paired, text_of

_places = {"latitude(deg)": "enu", "latitude(d'\")": "enu", "x-ecef(m)": "xyz", "e-baseline(m)": "enu"}
_base = "of the base station"  # of baselines


def _read(path: Path) -> tuple[Any, str, list[str], str]:
    """The rows, the system of the times, and the names of the columns behind them, the first of which is the last."""
    pandas = needed("pandas", "pandas", "read .pos")
    source = os.fspath(path)
    with text_of(path) as encoding, open(path, encoding=encoding) as file:
        head = next((line for line in file if line[0] == "%" and any(name in line for name in _places)), None)
        if head is None:
            raise InputError(f"{source}: no line of it names its columns, as RTKLIB does. Write it with its header.")
        kind = next(name for name in _places if name in head)
        separator = head.partition(kind)[2][:1]
        system, *names = head.strip("%\n \r").split(None if separator == " " else separator)
        try:
            how = {"sep": r"\s+" if separator == " " else separator, "comment": "%", "encoding": encoding}
            rows = pandas.read_csv(path, **how, header=None, skipinitialspace=True, dtype=str)
        except (pandas.errors.ParserError, pandas.errors.EmptyDataError) as error:
            raise InputError(f"{source}: it cannot be read ({one_line(error)}). Check the path.") from None
    return rows, system.strip(), [name.strip() for name in names], kind


def _times(rows: Any, system: str) -> tuple[Array, int]:
    """Seconds of GPS, or of UTC where the system is this, and how many columns they take."""
    pandas = needed("pandas", "pandas", "read .pos")
    first = rows.iloc[0, 0]
    if "/" not in first:
        return 604800.0 * rows[0].astype(float).to_numpy() + rows[1].astype(float).to_numpy(), 2
    taken = 1 if ":" in first else 2
    stamps = pandas.to_datetime(rows[0] if taken == 1 else rows[0] + " " + rows[1])
    start = pandas.Timestamp("1980-01-06") + pandas.Timedelta(hours=9 if system == "JST" else 0)
    return ((stamps - start) / pandas.Timedelta(seconds=1)).to_numpy(dtype=float), taken


def read_pos(path: Path) -> tuple[Poses, str]:
    """The positions of a file, and the system of its times: GPST or UTC."""
    source = os.fspath(path)
    rows, system, names, kind = _read(path)
    try:
        times, taken = _times(rows, system)
        values = rows.iloc[:, taken:].astype(float).to_numpy()
    except (ValueError, KeyError, TypeError) as error:
        raise InputError(f"{source}: {one_line(error)}. Give the file as RTKLIB writes it.") from None
    if "'" in kind:  # degrees, minutes and seconds, of which the first has the sign
        sexagesimal = values[:, :6].reshape(-1, 2, 3)
        degrees = np.copysign(np.abs(sexagesimal) @ [1, 1 / 60, 1 / 3600], sexagesimal[:, :, 0])
        values = np.hstack([degrees, values[:, 6:]])
    column = {name.partition("(")[0]: values[:, i] for i, name in enumerate(names) if i < values.shape[1]}
    P, along = np.full((len(values), 3, 3), np.nan), _places[kind]
    for name, sigma in column.items():
        if name[:2] == "sd" and name[2:] and {*name[2:]} <= {*along}:
            i, j = along.index(name[2]), along.index(name[-1])
            P[:, i, j] = P[:, j, i] = sigma * np.abs(sigma)  # the signed root of a covariance
    covariance = P if np.isfinite(P).any(axis=0).all() else None
    if covariance is None and np.isfinite(P).any():
        note(f"{source}: its standard deviations have no covariances beside them, and are not used")
    if "base" in kind or along == "xyz":
        return fixes(source, times, values[:, :3], covariance, *([_base] if "base" in kind else [])), system
    A = axes(values[:, 0], values[:, 1])
    covariance = None if covariance is None else np.swapaxes(A, 1, 2) @ covariance @ A
    return fixes(source, times, positions(*values[:, :3].T), covariance), system


def from_rtklib(
    estimate: Path | Sequence[Path], truth: Path | Sequence[Path] | Sequence[float], **options: Any
) -> dict[str, Any]:
    """Solutions of RTKLIB (``.pos``), whose standard deviations are signed roots of variances and covariances.

    Needs pandas and pymap3d. Latitude, longitude and height, x, y and z of the Earth, or baselines to the east, to the
    north and up. Times are of GPS, UTC or JST, in calendar dates or weeks and seconds.

    Parameters
    ----------
    estimate : path, or list of paths
        A file for each run.
    truth : path, list of paths, or three numbers
        Other such files, which are interpolated; or a point that stands still: latitude and longitude (deg) and height
        (m), of baselines east, north and up (m). As a text: ``"35.1, 139.6, 70"``.
    **options
        `max_gap`, `align`, `time_offset`, `planar` and `pair`, as of :func:`from_tum` and :func:`from_pair`.

    Returns
    -------
    dict
        `truth` and `estimate` [trial, step, 3] on ``R3``: east, north and up about the first position (m), and
        `covariance` [trial, step, 3, 3] in these axes. With `steps` and `time` (s since 1980-01-06).

    Raises
    ------
    InputError
        If a file has no header or no covariances, the truth is in another frame or in another system of times, or as of
        :func:`from_tum`.
    """
    read = [read_pos(one) for one, _ in paired(estimate, estimate)]
    still = [standing(each, truth, options.get("time_offset", 0.0)) for each, _ in read]
    pairs = [(each, point) for (each, _), point in zip(read, still) if point is not None]
    for (each, system), (_, other) in zip(read, [] if pairs else paired(estimate, truth)):  # type: ignore[arg-type]
        true, of_truth = read_pos(other)
        if (system == "GPST") != (of_truth == "GPST") and not options.get("time_offset"):
            has = f"its times are {system}, those of {true.source} {of_truth}"
            raise InputError(f"{each.source}: {has}. Give {argument('time_offset')}, the leap seconds between them.")
        pairs.append((each, true))
    return fix_arguments(pairs, **options)
