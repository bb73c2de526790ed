"""Numbers in text files, and arrays of runs of different lengths."""

from __future__ import annotations

import codecs
import contextlib
import math
import os
import warnings
from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from credence._calls import note as note
from credence._doors import needed as needed
from credence._errors import InputError, argument

Array = NDArray[np.float64]
Path = str | os.PathLike[str]
same_time = 1e-6  # s; what doubles and the formats of files make of one time
shortest = 1e-6  # s; between two times of a log


# Units of columns: what each is a unit of, and how many of it are the unit in which that is judged (rad, m, s).
UNITS = {
    "rad": ("angle", 1.0),
    "deg": ("angle", 180 / math.pi),
    "mgon": ("angle", 200e3 / math.pi),
    "arcsec": ("angle", 648e3 / math.pi),
    "m": ("length", 1.0),
    "mm": ("length", 1e3),
    "cm": ("length", 1e2),
    "km": ("length", 1e-3),
    "latitude": ("place", 1.0),  # degrees, of which errors are in m
    "longitude": ("place", 1.0),
    "s": ("time", 1.0),
    "ms": ("time", 1e3),
    "us": ("time", 1e6),
    "ns": ("time", 1e9),
}


def units_given(units: Mapping[str, str] | None, kinds: Mapping[str, Sequence[str]]) -> dict[str, str]:
    """The units that are asked for by their names, of which `kinds` says what each may be a unit of."""
    given = dict(units or {})
    for name, unit in given.items():
        if name not in kinds:
            some = ", ".join(kinds)
            raise InputError(f"{argument('units')}: {name} is nothing that has one here. Give some of {some}.")
        known = [one for one, (kind, _) in UNITS.items() if kind in kinds[name]]
        if unit not in known:
            raise InputError(f"{argument('units')}: {name} cannot be in {unit}. Give one of {', '.join(known)}.")
    return given


def seconds(source: str, times: Array, unit: str, name: str = "", *, noted: bool = True) -> Array:
    """Times in seconds, and a note of their unit where they lie unusually; `name` is what `units` calls them, if it
    does."""
    scale = UNITS[unit][1]
    rising = np.unique(times[np.isfinite(times)])
    if len(rising) > 1:
        apart = float(np.median(np.diff(rising))) / scale
        usual = [one for one, (kind, of) in UNITS.items() if kind == "time" and 1e-3 <= apart * scale / of <= 1]
        say = f"Say their unit, such as {argument('units')} {name}={(usual or ['ms'])[0]}" if name else "Give them in s"
        taken = f"its times are taken for {unit}, in which they are {apart:.3g} s apart"
        if apart < shortest:
            raise InputError(f"{source}: {taken} (must be at least 1e-06 s). {say}.")
        if noted and not 9e-4 <= apart <= 10:
            note(f"{source}: {taken}. {say}, if that is not right.")
    return times / scale


def encoding_of(path: Path) -> str:
    """The encoding of a text file: UTF-8, or UTF-16 where it begins with its mark."""
    try:
        with open(existing(path), "rb") as file:
            start = file.read(4096)
    except OSError as error:
        raise InputError(f"{os.fspath(path)}: it cannot be read ({error.strerror}). Check the path.") from None
    if start[:2] in (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE):
        return "utf-16"
    if b"\0" in start:
        raise InputError(f"{os.fspath(path)}: it is no text: it has zeros in it. Save it as UTF-8, or check the path.")
    return "utf-8-sig"


@contextlib.contextmanager
def text_of(path: Path) -> Iterator[str]:
    """The encoding of a text file. What is not in it, or cannot be read, is refused."""
    try:
        yield encoding_of(path)
    except UnicodeError as error:
        raise InputError(f"{os.fspath(path)}: it is no text in UTF-8 or UTF-16 ({error}). Save it as UTF-8.") from None


def read_table(path: Path, *columns: int, delimiter: str | None = None) -> Array:
    """The numbers of a text file, a row a line, without comments; it must have one of these numbers of columns."""
    try:
        with warnings.catch_warnings(), text_of(path) as encoding:
            warnings.simplefilter("ignore")  # of a file without numbers, which is refused below
            table: Array = np.loadtxt(path, comments="#", delimiter=delimiter, ndmin=2, dtype=float, encoding=encoding)
    except InputError:
        raise
    except ValueError as error:
        raise InputError(f"{os.fspath(path)}: {one_line(error)}. Give lines of numbers.") from None
    if not table.size:
        raise InputError(f"{os.fspath(path)}: there are no numbers in it. Check the path.")
    if columns:
        require_width(path, table, *columns)
    return table


def require_width(path: Path, table: Array, *columns: int, least: int = 0) -> None:
    """Refuse lines with another number of columns, or with fewer than `least`."""
    if table.shape[1] not in columns and not 0 < least <= table.shape[1]:
        wanted = f"at least {least}" if least else " or ".join(map(str, columns))
        has = f"its lines have {table.shape[1]} numbers (must be {wanted})"
        raise InputError(f"{os.fspath(path)}: {has}. Check what kind of file it is.")


def neighbours(
    of: Array, times: Array, max_gap: float
) -> tuple[NDArray[np.intp], NDArray[np.intp], NDArray[np.intp], Array]:
    """Between which entries of the rising `of` times lie: indices of the times that have neighbours at most `max_gap`
    (s) apart, or are an entry themselves, the indices of these neighbours, and where between them (0 to 1) they are."""
    after = np.clip(np.searchsorted(of, times), 1, max(len(of) - 1, 1))
    before, after = after - 1, np.minimum(after, len(of) - 1)
    gap = np.maximum(of[after] - of[before], same_time)
    share, near = (times - of[before]) / gap, same_time / gap
    share = np.where(np.abs(share) <= near, 0, np.where(np.abs(share - 1) <= near, 1, share))
    found = np.flatnonzero((share == 0) | (share == 1) | ((share > 0) & (share < 1) & (gap <= max_gap)))
    return found, before[found], after[found], share[found]


def say_matched(source: str, times: Array, found: NDArray[np.intp], truth: str, of: Array, max_gap: float) -> None:
    """Refuse a log none of whose times has a truth, and note how many have none."""
    if not len(found):
        span, of_truth = (f"{each.min():.10g} to {each.max():.10g} s" for each in (times, of))
        raise InputError(
            f"{source}: no pose has a truth within a gap of {max_gap:g} s (its times are {span}, those of {truth} "
            f"{of_truth}). Give the truth of this run, or a larger {argument('max_gap')}."
        )
    if len(found) < len(times):
        left = f"{len(times) - len(found)} of {len(times)} poses have no truth within a gap of {max_gap:g} s"
        note(f"{source}: {left}, and are left out")


def one_line(error: Exception) -> str:
    """What a library said, fit for a message."""
    return " ".join(str(error).split()).rstrip(".") or type(error).__name__


def existing(path: Path) -> str:
    """The path of a file that is there."""
    if not os.path.exists(path):
        raise InputError(f"{os.fspath(path)}: the file: cannot be found. Check the path.")
    return os.fspath(path)


def require_unit(source: str, quaternions: Array) -> None:
    """Refuse quaternions that are no rotations; of length 1 they need not be exactly."""
    lengths = np.linalg.norm(quaternions, axis=-1)
    wrong = np.flatnonzero(~(np.abs(lengths - 1) < 0.1))
    if len(wrong):
        has = f"pose {wrong[0] + 1} of {len(lengths)} has a quaternion of length {lengths[wrong[0]]:.3g} (must be 1)"
        raise InputError(f"{source}: {has}. Check the order of its columns, and leave out lines without a pose.")


def require_positive(source: str, what: str, values: Array) -> None:
    """Refuse standard deviations below 0, whose squares do not show it."""
    rows = np.flatnonzero((values < 0).reshape(len(values), -1).any(axis=1))
    if len(rows):
        has = f"{what} is below 0 at row {rows[0] + 1} ({values[rows[0]].min():.3g}), and at {len(rows)} in all"
        raise InputError(f"{source}: {has}. Give standard deviations; variances are named variance.")


def match_times(times: Array, of: Array, max_difference: float) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Indices of `times` and of the nearest entries of the rising `of`, where both are at most max_difference apart."""
    after = np.minimum(np.searchsorted(of, times), len(of) - 1)
    before = np.maximum(after - 1, 0)
    nearest = np.where(np.abs(times - of[before]) <= np.abs(times - of[after]), before, after)
    matched = np.flatnonzero(np.abs(times - of[nearest]) <= max_difference)
    return matched, nearest[matched]


def normalised(quaternions: Array) -> Array:
    unit: Array = quaternions / np.linalg.norm(quaternions, axis=-1, keepdims=True)
    return unit


def from_upper(upper: Array, dimension: int) -> Array:
    """Matrices from their upper triangles, row by row."""
    matrices = np.zeros((*upper.shape[:-1], dimension, dimension))
    rows, columns = np.triu_indices(dimension)
    matrices[..., rows, columns] = upper
    matrices[..., columns, rows] = upper
    return matrices


def stacked(arrays: Sequence[Array]) -> Array:
    """One array of all runs, padded with NaN behind the shorter ones."""
    if len(arrays) == 1:
        return arrays[0][None]
    joint = np.full((len(arrays), max(map(len, arrays)), *arrays[0].shape[1:]), np.nan)
    for run, array in zip(joint, arrays):
        run[: len(array)] = array
    return joint


def paired(estimate: Path | Sequence[Path], truth: Path | Sequence[Path]) -> list[tuple[Path, Path]]:
    """A pair of files, which are there, for each run; one truth is that of all runs."""
    estimates, truths = ([each] if isinstance(each, (str, os.PathLike)) else list(each) for each in (estimate, truth))
    truths = truths * len(estimates) if len(truths) == 1 else truths
    if len(truths) != len(estimates):
        raise InputError(
            f"there are {len(estimates)} runs and {len(truths)} truths. Give one truth, or one for each run."
        )
    for path in (*estimates, *truths):
        existing(path)
    return list(zip(estimates, truths))
