"""Tables by the names of their columns: CSV files, frames, and anything that gives columns by name."""

from __future__ import annotations

import csv
import os
import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np

from credence._arrays import numbers
from credence._errors import InputError, printable
from credence.adapters.orders import matrices_of
from credence.adapters.tables import UNITS, Array, Path, needed, one_line, require_positive, seconds, text_of

_week = 604_800.0  # s
_week_and_seconds = r"\s*(\d{1,4})\s+(\d{1,6}(?:\.\d*)?)\s*"


def _parted_head(line: str) -> tuple[list[str], str]:
    """The names in a line and what parts them: the one of commas, semicolons and tabs that is there most often."""
    delimiter = max(",;\t", key=line.count)
    return [name.strip() for name in next(csv.reader([line], delimiter=delimiter), [])], delimiter


def names_of(path: Path) -> list[str]:
    """The names of a table's columns, in its first line; none where that has a number or is a comment."""
    with text_of(path) as encoding, open(path, newline="", encoding=encoding) as file:
        line = file.readline()
    names, _ = _parted_head(line)
    is_named = len(names) > 1 and not line.startswith("#") and not any(map(_is_number, names))
    return names if is_named else []


def _is_number(value: Any) -> bool:
    try:
        float(value)
    except (TypeError, ValueError):
        return False
    return True


def _read_csv(path: Path) -> tuple[list[str], Any]:
    """The names in a file's first line, parted by commas, semicolons or tabs, and the frame below them."""
    pandas = needed("pandas", "pandas", "read tables")
    source = os.fspath(path)
    with text_of(path) as encoding:
        with open(path, newline="", encoding=encoding) as file:
            names, delimiter = _parted_head(file.readline().lstrip("#%"))
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


def _first_text(values: Any) -> str | None:
    """Where the first cell that is no number stands, in a column that begins with numbers."""
    for row, value in enumerate(values):
        if not _is_number(value):
            what = f"row {row + 1} has {printable(str(value))}, which is no number. Leave a cell without one empty."
            return what if row else None
    return None


class NamedColumns:
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
        if isinstance(name, str) and name not in self.names:
            name = name.lstrip("#%").strip()  # as it stands in a file's first line
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
            stray = _first_text(values) if isinstance(error, TypeError) else None
            raise InputError(f"{self.source}: {f'column {name}: {stray}' if stray else error}") from None
        except ValueError as error:
            raise InputError(f"{self.source}: column {name}: {error}. Give columns of numbers.") from None

    def array(self, names: Sequence[str]) -> Array:
        """[row, n]"""
        return np.stack([self.column(name) for name in names], axis=-1)

    def spread(self, kind: str, names: Sequence[str], n: int, order: Sequence[str], turns: Sequence[int]) -> Array:
        """Variances [row, n], or covariances [row, n, n], of columns that are sigmas, variances or covariances."""
        values, is_joint = self.array(names), kind.endswith("covariance")
        if is_joint and len(names) in (n * n, n * (n + 1) // 2):
            return matrices_of(self.source, values, n, order, turns)
        if is_joint or len(names) != n:
            wanted = f"{n * n} or {n * (n + 1) // 2}" if is_joint else f"{n}, one for each component"
            raise InputError(f"{kind} has {len(names)} columns (must be {wanted}). Give one for each entry.")
        if not kind.endswith("sigma"):
            return values
        require_positive(self.source, f"{kind} ({', '.join(names)})", values)
        return values**2

    def times(self, names: Sequence[str], unit: str, name: str, noted: bool) -> Array:
        """Times (s) of a column of numbers in a unit, or of texts; two columns are week and seconds of GPS, or a date
        and a time of day."""
        try:
            columns = [self.column(each) for each in names]
        except InputError:
            if np.asarray(self.values(names[0])).dtype.kind in "fiu":  # with units, for one
                raise
            return seconds(self.source, self._of_texts(names), "s", noted=False)
        if len(names) == 1:
            return seconds(self.source, columns[0], unit, name, noted=noted)
        if len(names) > 2 or np.nanmax(columns[0], initial=0) > 9999:
            raise InputError(f"time: {', '.join(names)} are no week and seconds of GPS. Give one column of times.")
        return seconds(self.source, _week * columns[0] + columns[1] / UNITS[unit][1], "s", noted=False)

    def _of_texts(self, names: Sequence[str]) -> Array:
        pandas = needed("pandas", "pandas", "read times that are texts")
        parts = [pandas.Series(np.asarray(self.values(name))) for name in names]
        texts = parts[0] if len(parts) == 1 else parts[0].astype(str).str.cat(parts[1:], sep=" ")
        if texts.dtype.kind != "M":
            texts = texts.astype("string").str.strip().str.replace(",", ".")
            weeks = texts.str.extract(f"^{_week_and_seconds}$")
            if weeks[0].notna().any() and (weeks[0].notna() | texts.isna()).all():
                return np.asarray(_week * weeks[0].astype(float) + weeks[1].astype(float), dtype=float)
        form = None if texts.dtype.kind == "M" else "ISO8601"
        at = pandas.to_datetime(texts, utc=True, format=form, errors="coerce")
        is_none = texts.notna() & at.isna()
        if is_none.any():
            row = int(np.argmax(is_none & pandas.to_numeric(texts, errors="coerce").isna()))
            what = f"column {', '.join(map(str, names))} has {printable(str(texts[row]))} at row {row + 1}"
            forms = "2024-05-06T07:08:09.5, 2024/05/06 07:08:09.5, or week and seconds of GPS"
            raise InputError(f"{self.source}: {what} (neither a number nor a date). Give seconds, {forms}.")
        return np.asarray((at - pandas.Timestamp(0, tz="UTC")).dt.total_seconds(), dtype=float)
