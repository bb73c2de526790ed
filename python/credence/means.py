"""Means over trials with their standard errors, from values or from the exact totals of a results file."""

from __future__ import annotations

import dataclasses
import fractions

import numpy as np
import numpy.typing as npt

from ._file import FloatArray


@dataclasses.dataclass(frozen=True)
class Means:
    """Means over trials, of one number or of one at each step.

    Attributes
    ----------
    mean, standard_error : ndarray
        [step] of a series, [] of one number; in `units`. A standard error is NaN where it cannot be had.
    count : ndarray
        [step] or []: over how many trials.
    dimension : int
        Of the component group that the series belongs to: NEES / dimension is 1 for a consistent filter. Else 1.
    units : str
        ``1`` without a dimension.
    """

    mean: FloatArray
    standard_error: FloatArray
    count: npt.NDArray[np.int64]
    dimension: int = 1
    units: str = "1"

    def interval(self, level: float = 0.95) -> tuple[FloatArray, FloatArray]:
        """Both ends of Student's interval, each of the shape of `mean`. Needs SciPy."""
        from scipy import stats

        half = stats.t.ppf(0.5 + level / 2, np.maximum(self.count - 1, 1)) * self.standard_error
        return self.mean - half, self.mean + half

    def over(self, divisor: npt.ArrayLike) -> Means:
        """The same over a number, or one number for each step, such as the dimension."""
        by = np.asarray(divisor, dtype=np.float64)
        return dataclasses.replace(self, mean=self.mean / by, standard_error=self.standard_error / by)

    def __neg__(self) -> Means:
        return dataclasses.replace(self, mean=-self.mean)


def of_values(values: FloatArray, units: str) -> Means:
    """Of one value a trial, NaN left out."""
    values = values[~np.isnan(values)]
    mean = values.mean() if values.size else np.nan
    error = values.std(ddof=1) / np.sqrt(values.size) if values.size > 1 else np.nan
    return Means(np.asarray(mean), np.asarray(error), np.asarray(values.size), 1, units)


def of_totals(
    totals: FloatArray, square_totals: FloatArray, count: int | npt.NDArray[np.int64], dimension: int, units: str
) -> Means:
    """Of totals over `count` trials, part 0 of each; of a record the count may differ from step to step."""
    counts = np.broadcast_to(np.asarray(count, np.int64), totals.shape)
    with np.errstate(all="ignore"):
        mean = np.where(counts > 0, totals / counts, np.nan)
        spread = np.maximum(square_totals / counts - mean**2, 0)
        error = np.where(counts > 1, np.sqrt(spread / (counts - 1)), np.nan)
    return Means(mean, error, counts, dimension, units)


def of_exact_totals(parts: FloatArray, square_parts: FloatArray, count: int, units: str) -> Means:
    """Of all parts of two totals: n Q - S^2 has hardly a digit left in doubles where values vary little."""
    mean = error = float("nan")
    if count and np.isfinite(parts).all() and np.isfinite(square_parts).all():
        total, squares = (sum(map(fractions.Fraction, values.tolist()), fractions.Fraction())
                          for values in (parts, square_parts))
        mean = float(total / count)
        if count > 1:
            error = float((count * squares - total**2) / count**2 / (count - 1)) ** 0.5
    return Means(np.asarray(mean), np.asarray(error), np.asarray(count), 1, units)
