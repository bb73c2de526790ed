"""Curves with bands along a swept key, of one grid of a results file."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes

from .._file import FloatArray
from ..grid import Grid, as_text, mean_and_ends
from ..study import Study
from . import style, trials
from .style import Picture

MOST_PANELS = 4  # a row of panels by the other keys; more would not be legible on a page


def _evenly_by_ratio(values: FloatArray) -> bool:
    """Whether values look evenly spaced on a logarithmic axis: their ratios vary less than their differences."""
    values = np.sort(values)
    if values.size < 3 or values[0] <= 0:
        return False
    by_difference, by_ratio = np.diff(values), np.diff(np.log(values))
    return bool(by_ratio.std() / by_ratio.mean() < by_difference.std() / by_difference.mean())


def curve_key(grid: Grid) -> str:
    """The key that curves run along: the first that has numbers, or the first."""
    numbers = [key for key, values in grid.coordinates.items() if values.dtype.kind == "f"]
    return (numbers or list(grid.coordinates))[0]


def slices(grid: Grid) -> Iterator[tuple[str, npt.NDArray[Any]]]:
    """(title, names along the curve's key) for everything that the other keys have."""
    keys = list(grid.coordinates)
    along = keys.index(curve_key(grid))
    names = np.moveaxis(grid.names, along, -1)
    others = keys[:along] + keys[along + 1:]
    for place in np.ndindex(names.shape[:-1]):
        values = [as_text(grid.coordinates[key][at]) for key, at in zip(others, place, strict=True)]
        yield ", ".join(f"{key}={value}" for key, value in zip(others, values, strict=True)), names[place]


def _draw(axis: Axes, grid: Grid, curves: dict[str, FloatArray], places: dict[str, int]) -> None:
    """`curves` {name: [value, (mean, low, high)]}: lines with bands over numbers, else marks with whiskers."""
    values = grid.coordinates[curve_key(grid)]
    numbers = values.dtype.kind == "f" and values.size > 1
    x = values if values.dtype.kind == "f" else np.arange(values.size, dtype=float)
    for index, (name, found) in enumerate(curves.items()):
        mean, low, high = found.T
        if numbers:
            shown = style.thinned(mean, low, high)
            line = style.arm_line(places[name], len(curves), x.size) | {"markevery": (0, 1)}
            style.interval(axis, x[shown], mean[shown], low[shown], high[shown], line, len(curves))
            axis.plot(x[shown], mean[shown], **line)
        else:
            axis.errorbar(x + style.aside(index, len(curves)), mean, yerr=np.abs([mean - low, high - mean]),
                          linestyle="none", elinewidth=1.1, **style.arm_mark(places[name]))
    axis.set_xlabel(curve_key(grid))
    if values.dtype.kind != "f":
        axis.set_xticks(range(values.size), [str(value)[:14] for value in values])
        axis.set_xlim(-0.5, values.size - 0.5)
    elif _evenly_by_ratio(values):
        style.logarithmic(axis.xaxis, values.min() / 1.1, values.max() * 1.1)


def sweep(grid: Grid, width: float, *, column: str = "nees_ratio", difference: bool = False,
          wanted: Sequence[str] | None = None) -> Picture:
    """A column along a swept key, with 95 % intervals, of all arms or of those wanted; or its differences A - B. A
    panel for each value of the other keys, the first four of them."""
    panels = list(slices(grid))
    shown = panels[:MOST_PANELS if width >= style.PAGE else 1]
    first = grid.points[0]
    names, all_arms = wanted or list(first), list(first)
    drawn: dict[str, tuple[str, str | None]] = {arm: (arm, None) for arm in names}
    if difference:
        drawn = {f"{a} \N{MINUS SIGN} {b}": (a, b) for a, b in trials.need_pairs(names, wanted, "difference=True")}
    places = {name: all_arms.index(arms[0]) for name, arms in drawn.items()}
    picture = Picture(width, 84)
    axes = picture.subplots(ncols=len(shown), sharey=True, squeeze=False)[0]
    found = [{name: np.array([mean_and_ends(grid.scenarios[point], arms[0], column, arms[1]) if point else [np.nan] * 3
                              for point in names]) for name, arms in drawn.items()} for _, names in shown]
    for axis, (title, _), curves in zip(axes, shown, found, strict=True):
        _draw(axis, grid, curves, places)
        if len(shown) > 1:
            axis.set_title(title)
        if difference or column.endswith("_ratio"):
            axis.axhline(0 if difference else 1, color=style.GREY, linewidth=0.6, zorder=0.5)
    if not difference:
        style.spread_out(axes[0].yaxis, [values for curves in found for values in curves.values()])
    what = ("difference of " if difference else "") + trials.name_of(column, first)
    axes[0].set_ylabel(what)
    entries = style.arm_entries(places)
    if len(shown) > 1:
        style.beside(axes[-1], entries)
    else:
        style.key(axes[0], entries, width)
    picture.title(_message(grid, found[0], shown[0][0], what.split(" [")[0]), _source(grid, len(panels) - len(shown)))
    return picture


def _message(grid: Grid, curves: dict[str, FloatArray], where: str, what: str) -> str:
    """From the first value to the last, of the curve of a panel that changes most."""
    values = grid.coordinates[curve_key(grid)]
    name = max(curves, key=lambda one: float(np.nan_to_num(np.ptp(curves[one][:, 0]))))
    first, last = curves[name][[0, -1], 0]
    return (f"{name}: {what} goes from {first:.3g} at {curve_key(grid)}={as_text(values[0])} to {last:.3g} at "
            f"{as_text(values[-1])}" + (f" ({where})" if where else ""))


def _source(grid: Grid, left_out: int) -> str:
    counts = [max(arm.trials for arm in scenario.arms.values()) for scenario in grid.points]
    seed = Study(grid.points[0].group.file).seed
    return (f"{grid.of}, {max(counts):,} trials each, seed {seed}; shades or bars: 95 % intervals of means"
            + (f"; {left_out} more panels in the file" if left_out else "")
            + (f"; {counts.count(0)} of {len(counts)} points are not run yet" if 0 in counts else ""))
