"""Arguments of :func:`credence.judge` from tables: CSV files, and frames of pandas."""

from __future__ import annotations

import csv
import os
import warnings
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from credence._arrays import numbers
from credence._errors import InputError, argument
from credence.adapters.tables import (
    UNITS,
    Array,
    Path,
    from_upper,
    needed,
    neighbours,
    note,
    one_line,
    require_positive,
    say_matched,
    seconds,
    text_of,
    units_given,
)


def _read_csv(path: Path) -> tuple[list[str], Any]:
    """The names in a file's first line, parted by commas, semicolons or tabs, and the frame below them."""
    pandas = needed("pandas", "pandas", "read tables")
    source = os.fspath(path)
    with text_of(path) as encoding:
        with open(path, newline="", encoding=encoding) as file:
            head = file.readline().lstrip("#")
        delimiter = max(",;\t", key=head.count)
        names = [name.strip() for name in next(csv.reader([head], delimiter=delimiter), [])]
        how = {"sep": delimiter, "encoding": encoding, "skipinitialspace": True, "float_precision": "round_trip"}
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", DeprecationWarning)  # of float_precision, the default from pandas 3 on
                frame = pandas.read_csv(path, **how, skiprows=1, header=None, low_memory=False)
        except pandas.errors.EmptyDataError:
            raise InputError(f"{source}: there are no rows in it. Check the path.") from None
        except pandas.errors.ParserError as error:
            _refuse_uneven(path, encoding, delimiter, len(names))
            raise InputError(f"{source}: it cannot be read as a table ({one_line(error)}). Check the path.") from None
        if frame.shape[1] != len(names) or frame.iloc[:, -1].isna().any():  # as a row that ends early has it
            _refuse_uneven(path, encoding, delimiter, len(names))
    return names, frame


def _refuse_uneven(path: Path, encoding: str, delimiter: str, cells: int) -> None:
    with open(path, newline="", encoding=encoding) as file:
        file.readline()
        for number, row in enumerate(filter(None, csv.reader(file, delimiter=delimiter))):
            if len(row) != cells:
                raise InputError(
                    f"{os.fspath(path)}: row {number + 1} below the names has {len(row)} cells (must be {cells}, "
                    "one for each name). Write a cell, which may be empty, for each."
                )


class _Table:
    """Columns of a file, a frame, or anything that gives them by name."""

    def __init__(self, table: Any) -> None:
        if isinstance(table, (str, os.PathLike)):
            self.source = os.fspath(table)
            self.names, frame = _read_csv(table)
            self.columns: Any = {name: frame[i] for i, name in enumerate(self.names)}
        else:
            fields = getattr(getattr(table, "dtype", None), "names", None)  # of NumPy
            self.source, self.columns = "the table", table
            self.names = list(fields or getattr(table, "columns", table))

    def values(self, name: str) -> Any:
        """A column as it is."""
        if self.names.count(name) > 1:
            raise InputError(f"{self.source}: {self.names.count(name)} columns are called {name}. Rename one of them.")
        try:
            return self.columns[name]
        except (KeyError, ValueError, IndexError):
            there = ", ".join(map(str, self.names))
            remedy = "Give the name of one that is there"
            raise InputError(f"{self.source}: there is no column {name} in it (it has {there}). {remedy}.") from None

    def column(self, name: str) -> Array:
        values = self.values(name)
        try:
            if not isinstance(values, list):
                return numbers(f"column {name}", values).astype(float)
            values = [value if isinstance(value, (int, float)) or value.strip() else "nan" for value in values]
            return np.asarray(values, dtype=float)
        except (TypeError, InputError) as error:
            raise InputError(f"{self.source}: {error}") from None
        except ValueError as error:
            raise InputError(f"{self.source}: column {name}: {error}. Give columns of numbers.") from None

    def array(self, names: Sequence[str]) -> Array:
        """[row, n]"""
        return np.stack([self.column(name) for name in names], axis=-1)


class _Components:
    """The components of the error, by the columns of `error` or `estimate`, and their units."""

    def __init__(self, names: list[str], angles: Sequence[str], units: Mapping[str, str]) -> None:
        for name in names:
            if names.count(name) > 1:
                raise InputError(f"{name} is named as two components. Give each column once.")
        for name in angles:
            if name not in names:
                raise InputError(
                    f"angles: {name} is no column of the errors or estimates. Give some of {', '.join(names)}."
                )
        self.names = names
        self.units = dict.fromkeys(angles, "rad") | {name: unit for name, unit in units.items() if name in names}
        self.scale = np.array([UNITS[self.units[name]][1] if name in self.units else 1.0 for name in names])
        kinds = [UNITS[self.units[name]][0] if name in self.units else "" for name in names]
        self.turns = [i for i, kind in enumerate(kinds) if kind == "angle"]
        self.doubtful = [i for i in self.turns if names[i] not in units]
        self.known = {"component_units": ["rad" if kind == "angle" else "m" for kind in kinds]}
        if not units or "" in kinds:
            self.known = {}

    def wrapped(self, differences: Array) -> Array:
        differences[:, self.turns] = np.remainder(differences[:, self.turns] + np.pi, 2 * np.pi) - np.pi
        return differences

    def refuse_degrees(self, source: str, values: Array) -> None:
        """Refuse angles that were not said to be in rad and are wrapped at 360."""
        for i in self.doubtful:
            known = values[np.isfinite(values[:, i]), i]
            if len(known) > 1 and 300 < np.ptp(known) < 361 and np.abs(np.diff(known)).max() > 180:
                spans = f"goes from {known.min():.4g} to {known.max():.4g} and jumps, as if it were wrapped at 360"
                raise self._in_degrees(source, i, spans)

    def refuse_sigmas(self, source: str, covariance: Array) -> None:
        """Refuse sigmas that are not those of an angle in rad."""
        variances = covariance if covariance.ndim == 2 else np.diagonal(covariance, axis1=1, axis2=2)
        for i in self.doubtful:
            known = variances[variances[:, i] > 0, i]
            usual = float(np.sqrt(np.median(known))) if len(known) else 0.0
            if np.pi < usual < 360:  # beyond it a placeholder
                raise self._in_degrees(source, i, f"has sigmas of {usual:.3g}, and those of an angle are below pi rad")

    def refuse_folded(self, source: str, differences: Array, largest: Array, most: float = 4 * np.pi) -> None:
        """Refuse angles whose differences beyond half a turn, which are folded, are not about whole turns, as they are
        in rad; note them where the largest numbers of the columns [n] are at most `most`."""
        for i in self.doubtful:
            folded = differences[np.abs(differences[:, i]) > np.pi, i]
            if not len(folded) or np.cos(folded).mean() > 0.5:
                continue
            what = f"{len(folded)} of {len(differences)} differences are beyond half a turn and no whole turns"
            if largest[i] > most:
                raise self._in_degrees(source, i, f"has numbers up to {largest[i]:.4g}, and {what}")
            note(f"{source}: {self.names[i]}: {what}. They are folded. If it is in degrees, say {self._units(i)}.")

    def _units(self, i: int) -> str:
        return f"{argument('units')} {self.names[i]}=deg"

    def _in_degrees(self, source: str, i: int, why: str) -> InputError:
        name = self.names[i]
        return InputError(f"{source}: {name}, an angle, {why}: in degrees? Say {self._units(i)}, or {name}=rad if not.")


def _largest(*columns: Array) -> Array:
    """[n] of columns [row, n]"""
    sizes: Array = np.max([np.abs(np.where(np.isfinite(each), each, 0)).max(axis=0) for each in columns], axis=0)
    return sizes


def _interpolated(
    table: _Table, names: Sequence[str], times: Array, components: _Components
) -> tuple[Array, Array, Array]:
    """The times of the truth, in order, its values there, angles without jumps, and how large these were."""
    order = np.argsort(times, kind="stable")
    values = table.array(names)[order]
    largest = _largest(values)
    components.refuse_degrees(table.source, values)
    components.refuse_folded(table.source, np.diff(values, axis=0), largest)
    values /= components.scale
    for i in components.turns:
        values[:, i] = np.unwrap(values[:, i])
    return times[order], values, largest


def _list(names: str | Sequence[str]) -> list[str]:
    return [names] if isinstance(names, str) else list(names)


def from_table(
    table: Any,
    truth_table: Any = None,
    *,
    error: str | Sequence[str] | None = None,
    estimate: str | Sequence[str] | None = None,
    truth: str | Sequence[str] | None = None,
    sigma: str | Sequence[str] | None = None,
    variance: str | Sequence[str] | None = None,
    covariance: str | Sequence[str] | None = None,
    angles: str | Sequence[str] = (),
    time: str | None = None,
    runs: str | None = None,
    units: Mapping[str, str] | None = None,
    max_gap: float = 0.2,
) -> dict[str, Any]:
    """Columns of a CSV file or a frame, by their names.

    Needs pandas for a file.

    Parameters
    ----------
    table : path, pandas.DataFrame, or anything that has columns by name
        A row for each step. A file has the names in its first line; empty cells are NaN.
    truth_table : the same
        Where the truth stands in a table of its own: it is interpolated at the times of `table` (`time`, in both).
    error : list of str
        Columns of estimate - truth; or else
    estimate, truth : lists of str
        columns of both, one for each component.
    sigma, variance, covariance : list of str
        One of them: standard deviations, variances, or the covariance row by row, whole or its upper triangle.
    angles : list of str
        Which of the columns of `error` or `estimate` are angles: their differences are wrapped. They are in rad, unless
        `units` says otherwise; what cannot be is refused.
    time : str
        The column of times (s); they must increase.
    runs : str
        The column that tells runs apart.
    units : dict
        Of columns of `error` or `estimate` ``"rad"``, ``"deg"``, ``"mgon"`` or ``"arcsec"``, which make it an angle, or
        ``"m"``, ``"mm"``, ``"cm"`` or ``"km"``. Its truth, sigma, variances and covariances are then in the same unit,
        and what is returned is in rad and m. Of `time`, and of `truth_time` where that of `truth_table` is another one,
        ``"s"``, ``"ms"``, ``"us"`` or ``"ns"``.
    max_gap : float
        As of :func:`from_tum`.

    Returns
    -------
    dict
        `error` and `covariance` [row, …], with `runs`; or [1, step, …]. With `time` and `component_names`, and with
        `component_units` where `units` says those of all that are no angles.

    Raises
    ------
    InputError
        If a column is not there or not of numbers, columns do not fit each other, a standard deviation is negative, or
        a unit cannot be right.
    """
    rows, names = _Table(table), _list(error or estimate or ())
    spreads = {"sigma": sigma, "variance": variance, "covariance": covariance}
    given = {name: _list(columns) for name, columns in spreads.items() if columns}
    if len(given) != 1 or not names or (error is None) == (estimate is None or truth is None):
        raise InputError(
            "cannot judge this table (it takes error, or estimate and truth, and one of sigma, variance and "
            "covariance). Give the names of these columns."
        )
    kinds = {name: ["time"] for name in ("time", "truth_time", time) if name is not None}
    units = units_given(units, kinds | {name: ["angle", "length"] for name in names})
    components = _Components(names, _list(angles), units)
    unit = units.get(time or "time", units.get("time", "s"))
    times = None
    if time is not None:
        times = seconds(rows.source, rows.column(time), unit, "time", noted=truth_table is not None and not units)
    kept: Any = slice(None)
    most = 4 * np.pi
    own = rows.array(names)
    largest = _largest(own)
    components.refuse_degrees(rows.source, own)
    if error is None:
        true = _list(truth or ())
        if len(true) != len(names):
            raise InputError(f"truth has {len(true)} columns (must be {len(names)}, as estimate). Give one for each.")
        if truth_table is None:
            at = rows.array(true)
            components.refuse_degrees(rows.source, at)
            largest = np.maximum(largest, _largest(at))
            own = own / components.scale - at / components.scale
        elif times is None or time is None or runs is not None:
            raise InputError(
                "cannot use a table of the truth (it needs time, and one run a table). Give the column of time."
            )
        else:
            other = _Table(truth_table)
            of_truth = units.get("truth_time", unit)
            stamps = seconds(other.source, other.column(time), of_truth, "truth_time", noted=not units)
            of, values, largest_truth = _interpolated(other, true, stamps, components)
            kept, before, after, share = neighbours(of, times, max_gap)
            say_matched(rows.source, times, kept, other.source, of, max_gap)
            largest = np.maximum(largest, largest_truth)
            own = own[kept] / components.scale - (values[before] + share[:, None] * (values[after] - values[before]))
    else:
        own = own / components.scale
        most = 2 * np.pi  # two angles in a turn are at most a turn apart
    covariances = _covariances(given, rows, len(names))[kept]
    components.refuse_sigmas(rows.source, covariances)
    components.refuse_folded(rows.source, own, largest, most)
    covariances /= components.scale if covariances.ndim == 2 else components.scale[:, None]
    covariances /= components.scale
    arguments: dict[str, Any] = {"error": components.wrapped(own), "covariance": covariances}
    if times is not None:
        arguments["time"] = times[kept]
    if runs is not None:
        arguments["runs"] = np.asanyarray(rows.values(runs))
    else:
        arguments = {name: array[None] for name, array in arguments.items()}
    component_names = ["_".join(name.split()).replace(",", "_") for name in names]
    return arguments | {"component_names": component_names} | components.known


def _covariances(given: Mapping[str, Sequence[str]], rows: _Table, n: int) -> Array:
    """Variances [row, n], or covariances [row, n, n]."""
    ((kind, columns),) = given.items()
    values = rows.array(columns)
    if kind == "covariance" and len(columns) in (n * n, n * (n + 1) // 2):
        return values.reshape(-1, n, n) if len(columns) == n * n else from_upper(values, n)
    if kind == "covariance" or len(columns) != n:
        wanted = f"{n * n} or {n * (n + 1) // 2}" if kind == "covariance" else f"{n}, one for each component"
        raise InputError(f"{kind} has {len(columns)} columns (must be {wanted}). Give one for each entry.")
    if kind != "sigma":
        return values
    require_positive(rows.source, f"sigma ({', '.join(columns)})", values)
    return values**2
