"""The picture of a tune: the score over each parameter, and of two parameters where the search was, from what it
evaluated."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.ticker import MaxNLocator

from ..tuning import Tuned
from . import style
from .style import Picture


def picture(tuned: Tuned) -> Picture:
    """One panel a parameter, and one more for where the search of two was."""
    names = list(tuned.parameters)
    panels = len(names) + (len(names) == 2)
    columns = min(panels, 3)
    rows = -(-panels // columns)
    drawn = Picture(style.PAGE, 12 + 58 * rows)
    axes = [drawn.add_subplot(rows, columns, i + 1) for i in range(panels)]
    for i, (axis, name) in enumerate(zip(axes, names)):
        _profile(axis, tuned, name)
        if i % columns == 0:
            axis.set_ylabel("rise of the score")
    where = ""
    if len(names) == 2:
        _map(axes[-1], tuned)
        where = "; right: where the search was, from the start (x) to the best (+)"
    said = ", ".join(f"{name} {estimate}" for name, estimate in tuned.parameters.items())
    drawn.title(f"The score is best at {said}; with it the filter is {tuned.verdict.verdict}",
                f"{tuned.name}, {tuned.tuned_on}; dots: what the search evaluated; lines: to second order; "
                f"grey: two standard errors{where}")
    drawn.fit_labels()
    return drawn


def _scale(axis: Axes, x: str, tuned: Tuned, name: str, values: np.ndarray) -> None:
    """A logarithmic axis of a parameter that is searched by its logarithm, if it spans more than a factor of three."""
    getattr(axis, f"set_{x}label")(name)
    getattr(axis, f"{x}axis").set_major_locator(MaxNLocator(4))
    if tuned.is_log(name) and values.max() > 3 * values.min():
        style.logarithmic(getattr(axis, f"{x}axis"), values.min(), values.max())


def _profile(axis: Axes, tuned: Tuned, name: str) -> None:
    (values, scores), (points, rises) = tuned.parabola(name), tuned.searched()
    estimate = tuned.parameters[name]
    if len(values):
        axis.axvspan(estimate.value - 2 * estimate.se, estimate.value + 2 * estimate.se, color=style.BAND, zorder=0)
        axis.plot(values, scores, **style.arm_style(0))
        axis.set(xlim=(values.min(), values.max()), ylim=(0, 1.3 * scores.max()))
    axis.plot(points[name], rises, linestyle="none", marker=".", color=style.BLUE)
    axis.axvline(estimate.value, color=style.GREY, linewidth=0.6)
    _scale(axis, "x", tuned, name, values if len(values) else points[name])
    axis.ticklabel_format(axis="y", useOffset=False)


def _map(axis: Axes, tuned: Tuned) -> None:
    """Where the search was, from the start to the best, and what the score was there."""
    names = list(tuned.parameters)
    points, rises = tuned.searched()
    least = float(np.nanmax(rises)) * 1e-6
    order = np.argsort(-rises)  # the best on top of the others
    x, y = (points[name][order] for name in names)
    drawn = axis.scatter(x, y, c=np.maximum(rises[order], least), s=9, norm=LogNorm(), cmap="viridis", linewidths=0)
    axis.figure.colorbar(drawn, ax=axis, label="rise of the score")
    axis.plot(*(tuned.start[name] for name in names), marker="x", color=style.VERMILION, markersize=6)
    axis.plot(*(tuned.parameters[name].value for name in names), marker="+", color=style.VERMILION, markersize=8)
    for across, name, values in (("x", names[0], x), ("y", names[1], y)):
        _scale(axis, across, tuned, name, values)
