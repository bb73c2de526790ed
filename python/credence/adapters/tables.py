"""Numbers in text files, and arrays of runs of different lengths."""

from __future__ import annotations

import os
import warnings
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from credence import InputError

Array = NDArray[np.float64]
Path = str | os.PathLike[str]


def read_table(path: Path, *columns: int) -> Array:
    """The numbers of a text file, a row a line, without comments; it must have one of these numbers of columns."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of a file without numbers, which is refused below
            table: Array = np.loadtxt(path, comments="#", ndmin=2, dtype=float)
    except ValueError as error:
        raise InputError(f"{os.fspath(path)}: {error}") from None
    if not table.size:
        raise InputError(f"{os.fspath(path)}: there are no numbers in it. Check the path.")
    if columns and table.shape[1] not in columns:
        wanted = " or ".join(map(str, columns))
        raise InputError(f"{os.fspath(path)}: its lines have {table.shape[1]} numbers (must be {wanted})")
    return table


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


def path_list(paths: Path | Sequence[Path]) -> list[Path]:
    return [paths] if isinstance(paths, (str, os.PathLike)) else list(paths)
