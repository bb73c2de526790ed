"""The picture of a tune: the profile of the score over each parameter, and of two parameters its contours."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from ..tuning import Tuned
from . import style
from .style import Picture

LEVELS = 7  # contours, each of three times the rise of the one within


def picture(tuned: Tuned) -> Picture:
    """One panel a parameter, and one more for the contours of two."""
    names = list(tuned.parameters)
    panels = len(names) + (len(names) == 2)
    columns = min(panels, 3)
    rows = -(-panels // columns)
    drawn = Picture(style.PAGE, 12 + 58 * rows)
    axes = [drawn.add_subplot(rows, columns, i + 1) for i in range(panels)]
    for i, (axis, name) in enumerate(zip(axes, names)):
        _profile(axis, tuned, name)
        if i % columns == 0:
            axis.set_ylabel("score (lower is better)")
    contours = ""
    if len(names) == 2:
        _contours(axes[-1], tuned)
        contours = "; contours: rises of the score, each three times the one within, from the start (cross)"
    said = ", ".join(f"{name} {estimate}" for name, estimate in tuned.parameters.items())
    drawn.title(f"The score is best at {said}; with it the filter is {tuned.verdict.verdict}",
                f"{tuned.name}, {tuned.tuned_on}; lines: the score on these; grey: two standard errors{contours}")
    drawn.fit_labels()
    return drawn


def _scale(axis: Axes, x: str, tuned: Tuned, name: str, values: np.ndarray) -> None:
    """A logarithmic axis of a parameter that is searched by its logarithm, if it spans more than a factor of three."""
    getattr(axis, f"set_{x}label")(name)
    getattr(axis, f"{x}axis").set_major_locator(MaxNLocator(4))
    if tuned.is_log(name) and values.max() > 3 * values.min():
        style.logarithmic(getattr(axis, f"{x}axis"), values.min(), values.max())


def _profile(axis: Axes, tuned: Tuned, name: str) -> None:
    values, scores = tuned.profile(name)
    estimate = tuned.parameters[name]
    if math.isfinite(estimate.se):
        axis.axvspan(estimate.value - 2 * estimate.se, estimate.value + 2 * estimate.se, color=style.BAND, zorder=0)
    axis.plot(values, scores, **style.arm_style(0), marker=".")
    axis.axvline(estimate.value, color=style.GREY, linewidth=0.6)
    _scale(axis, "x", tuned, name, values)
    axis.ticklabel_format(axis="y", useOffset=False)


def _contours(axis: Axes, tuned: Tuned) -> None:
    """Of the rise of the score above its best, in powers of three."""
    names = list(tuned.parameters)
    x, y, scores = tuned.grid()
    rise = scores - np.nanmin(scores)
    largest = float(np.nanmax(rise))
    levels = largest / 3.0 ** np.arange(LEVELS, 0, -1)
    axis.contour(x, y, rise.T, levels=levels, colors=style.BLUE, linewidths=0.7)
    start = [tuned.start[name] for name in names]
    best = [tuned.parameters[name].value for name in names]
    axis.plot(*start, marker="x", color=style.VERMILION, markersize=6)
    axis.plot(*best, marker="o", color=style.BLUE)
    for across, name, values in (("x", names[0], x), ("y", names[1], y)):
        _scale(axis, across, tuned, name, values)
