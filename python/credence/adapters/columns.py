"""Arguments of :func:`credence.judge` from tables: CSV files, and frames of pandas."""

from __future__ import annotations

import csv
import os
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from credence import InputError
from credence.adapters.tables import Array, Path, existing, from_upper, neighbours, say_matched


def _read_csv(path: Path) -> dict[str, list[str]]:
    """The columns of a file by the names in its first line, parted by commas, semicolons or tabs."""
    with open(existing(path), newline="", encoding="utf-8-sig") as file:
        head = file.readline().lstrip("#")
        delimiter = max(",;\t", key=head.count)
        names = [name.strip() for name in next(csv.reader([head], delimiter=delimiter), [])]
        rows = [row for row in csv.reader(file, delimiter=delimiter) if row]
    if not rows:
        raise InputError(f"{os.fspath(path)}: there are no rows in it. Check the path.")
    for number, row in enumerate(rows):
        if len(row) != len(names):
            raise InputError(
                f"{os.fspath(path)}: row {number + 1} below the names has {len(row)} cells (must be {len(names)}, "
                "one for each name)"
            )
    return dict(zip(names, map(list, zip(*rows))))


class _Table:
    """Columns of a file, a frame, or anything that gives them by name."""

    def __init__(self, table: Any) -> None:
        is_path = isinstance(table, (str, os.PathLike))
        self.source = os.fspath(table) if is_path else "the table"
        self.columns: Any = _read_csv(table) if is_path else table

    def column(self, name: str) -> Array:
        try:
            values = self.columns[name]
        except (KeyError, ValueError, IndexError):
            there = ", ".join(map(str, self.columns))
            raise InputError(f"{self.source}: there is no column {name} in it (it has {there})") from None
        if isinstance(values, list):
            values = [value if isinstance(value, (int, float)) or value.strip() else "nan" for value in values]
        try:
            return np.asarray(values, dtype=float)
        except ValueError as error:
            raise InputError(f"{self.source}: column {name}: {error}. Give columns of numbers.") from None

    def array(self, names: Sequence[str]) -> Array:
        """[row, n]"""
        return np.stack([self.column(name) for name in names], axis=-1)


def _wrapped(difference: Array, names: Sequence[str], angles: Sequence[str]) -> Array:
    turns = [i for i, name in enumerate(names) if name in angles]
    difference[:, turns] = np.remainder(difference[:, turns] + np.pi, 2 * np.pi) - np.pi
    return difference


def _interpolated(table: _Table, names: Sequence[str], turns: Sequence[bool], time: str) -> tuple[Array, Array]:
    """The times of the truth, in order, and its values there, angles without jumps."""
    times = table.column(time)
    order = np.argsort(times, kind="stable")
    values = table.array(names)[order]
    for i in np.flatnonzero(turns):
        values[:, i] = np.unwrap(values[:, i])
    return times[order], values


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
    max_gap: float = 0.2,
) -> dict[str, Any]:
    """Columns of a CSV file or a frame, by their names.

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
        Which of the columns of `error` or `estimate` are angles (rad): their differences are wrapped.
    time : str
        The column of times (s); they must increase.
    runs : str
        The column that tells runs apart.
    max_gap : float
        As of :func:`from_tum`.

    Returns
    -------
    dict
        `error` and `covariance` [row, …], with `runs`; or [1, step, …]. With `time` and `component_names`.

    Raises
    ------
    InputError
        If a column is not there or not of numbers, or columns do not fit each other.
    """
    rows, names = _Table(table), _list(error or estimate or ())
    angles = _list(angles)
    spreads = {"sigma": sigma, "variance": variance, "covariance": covariance}
    given = {name: _list(columns) for name, columns in spreads.items() if columns}
    if len(given) != 1 or not names or (error is None) == (estimate is None or truth is None):
        raise InputError(
            "cannot judge this table (it takes error, or estimate and truth, and one of sigma, variance and "
            "covariance). Give the names of these columns."
        )
    for name in angles:
        if name not in names:
            raise InputError(
                f"angles: {name} is no column of the errors or estimates. Give some of {', '.join(names)}."
            )
    kept: Any = slice(None)
    if error is not None:
        differences = rows.array(names)
    else:
        true = _list(truth or ())
        if len(true) != len(names):
            raise InputError(f"truth has {len(true)} columns (must be {len(names)}, as estimate). Give one for each.")
        if truth_table is None:
            differences = rows.array(names) - rows.array(true)
        elif time is None or runs is not None:
            raise InputError(
                "cannot use a table of the truth (it needs time, and one run a table). Give the column of time."
            )
        else:
            other, times = _Table(truth_table), rows.column(time)
            of, values = _interpolated(other, true, [name in angles for name in names], time)
            kept, before, after, share = neighbours(of, times, max_gap)
            say_matched(rows.source, times, kept, other.source, of, max_gap)
            at = values[before] + share[:, None] * (values[after] - values[before])
            differences = rows.array(names)[kept] - at
    arguments: dict[str, Any] = {"error": _wrapped(differences, names, angles)}
    arguments["covariance"] = _covariances(given, rows, len(names))[kept]
    if time is not None:
        arguments["time"] = rows.column(time)[kept]
    if runs is not None:
        arguments["runs"] = np.asarray(rows.columns[runs]) if runs in rows.columns else rows.column(runs)
    else:
        arguments = {name: array[None] for name, array in arguments.items()}
    return arguments | {"component_names": ["_".join(name.split()).replace(",", "_") for name in names]}


def _covariances(given: Mapping[str, Sequence[str]], rows: _Table, n: int) -> Array:
    """Variances [row, n], or covariances [row, n, n]."""
    ((kind, columns),) = given.items()
    values = rows.array(columns)
    if kind == "covariance" and len(columns) in (n * n, n * (n + 1) // 2):
        return values.reshape(-1, n, n) if len(columns) == n * n else from_upper(values, n)
    if kind == "covariance" or len(columns) != n:
        wanted = f"{n * n} or {n * (n + 1) // 2}" if kind == "covariance" else f"{n}, one for each component"
        raise InputError(f"{kind} has {len(columns)} columns (must be {wanted}). Give one for each entry.")
    return values**2 if kind == "sigma" else values
