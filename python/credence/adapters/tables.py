"""Numbers in text files, and arrays of runs of different lengths."""

from __future__ import annotations

import importlib
import os
import sys
import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from credence import InputError

Array = NDArray[np.float64]
Path = str | os.PathLike[str]
same_time = 1e-6  # s; what doubles and the formats of files make of one time


def read_table(path: Path, *columns: int, delimiter: str | None = None) -> Array:
    """The numbers of a text file, a row a line, without comments; it must have one of these numbers of columns."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of a file without numbers, which is refused below
            table: Array = np.loadtxt(existing(path), comments="#", delimiter=delimiter, ndmin=2, dtype=float)
    except ValueError as error:
        raise InputError(f"{os.fspath(path)}: {error}") from None
    if not table.size:
        raise InputError(f"{os.fspath(path)}: there are no numbers in it. Check the path.")
    if columns and table.shape[1] not in columns:
        wanted = " or ".join(map(str, columns))
        raise InputError(f"{os.fspath(path)}: its lines have {table.shape[1]} numbers (must be {wanted})")
    return table


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
            f"{of_truth}). Give the truth of this run, or a larger max_gap."
        )
    if len(found) < len(times):
        left = f"{len(times) - len(found)} of {len(times)} poses have no truth within a gap of {max_gap:g} s"
        note(f"{source}: {left}, and are left out")


def note(message: str) -> None:
    """Say something beside the verdict, at the line that called the package."""
    level, frame = 2, sys._getframe(1)
    while frame.f_back is not None and str(frame.f_globals.get("__name__")).startswith("credence."):
        level, frame = level + 1, frame.f_back
    warnings.warn(message, stacklevel=level)


def needed(module: str, package: str, what: str) -> Any:
    """A module that only some adapters need, and which is imported when they do."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        raise InputError(f"cannot {what} ({error}). Install it: pip install {package}.") from None


def existing(path: Path) -> str:
    """The path of a file that is there."""
    if not os.path.exists(path):
        raise InputError(f"{os.fspath(path)}: the file: cannot be found. Check the path.")
    return os.fspath(path)


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
