"""The picture of a tune: the score over each parameter, and of two parameters where the search was, from what it
evaluated."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.ticker import MaxNLocator

from .._file import FloatArray
from . import style
from .style import Picture


@dataclass(frozen=True)
class Parameter:
    """What is drawn of a parameter: where it began and ended, and the curve of the rise of the score to second order
    (values and rises [point], empty where there is none)."""

    name: str
    start: float
    found: Any  # an Estimate of credence.tuning
    is_log: bool
    curve: tuple[FloatArray, FloatArray]
    tried: FloatArray  # [point], its values where the search was


def picture(parameters: Sequence[Parameter], rises: FloatArray, message: str, source: str) -> Picture:
    """One panel a parameter, and one more for where the search of two was; `rises` [point] are those of the score."""
    panels = len(parameters) + (len(parameters) == 2)
    columns = min(panels, 3)
    rows = -(-panels // columns)
    drawn = Picture(style.PAGE, 12 + 58 * rows)
    axes = [drawn.add_subplot(rows, columns, i + 1) for i in range(panels)]
    for i, (axis, parameter) in enumerate(zip(axes, parameters)):
        _profile(axis, parameter, rises)
        if i % columns == 0:
            axis.set_ylabel("rise of the score")
    where = ""
    if len(parameters) == 2:
        _map(axes[-1], parameters[0], parameters[1], rises)
        where = "; right: where the search was, from the start (x) to the best (+)"
    drawn.title(message, f"{source}; dots: what the search evaluated; lines: to second order; grey: 95 %{where}")
    drawn.fit_labels()
    return drawn


def _scale(axis: Axes, x: str, parameter: Parameter, values: FloatArray) -> None:
    """A logarithmic axis of a parameter that is searched by its logarithm, if it spans more than a factor of three."""
    getattr(axis, f"set_{x}label")(parameter.name)
    getattr(axis, f"{x}axis").set_major_locator(MaxNLocator(4))
    if parameter.is_log and values.max() > 3 * values.min():
        style.logarithmic(getattr(axis, f"{x}axis"), values.min(), values.max())


def _profile(axis: Axes, of: Parameter, rises: FloatArray) -> None:
    values, scores = of.curve
    ends = np.clip(of.found.interval, of.tried.min(), of.tried.max())
    if np.isfinite(ends).all():
        axis.axvspan(*ends, color=style.BAND, zorder=0)
    if len(values):
        axis.plot(values, scores, **style.arm_style(0))
        axis.set(xlim=(values.min(), values.max()), ylim=(0, 1.3 * scores.max()))
    axis.plot(of.tried, rises, linestyle="none", marker=".", color=style.BLUE)
    axis.axvline(of.found.value, color=style.GREY, linewidth=0.6)
    _scale(axis, "x", of, values if len(values) else of.tried)
    axis.ticklabel_format(axis="y", useOffset=False)


def _map(axis: Axes, first: Parameter, second: Parameter, rises: FloatArray) -> None:
    """Where the search was, from the start to the best, and what the score was there."""
    least = float(np.nanmax(rises)) * 1e-6
    order = np.argsort(-rises)  # the best on top of the others
    x, y = first.tried[order], second.tried[order]
    drawn = axis.scatter(x, y, c=np.maximum(rises[order], least), s=9, norm=LogNorm(), cmap="viridis", linewidths=0)
    axis.figure.colorbar(drawn, ax=axis, label="rise of the score")
    axis.plot(first.start, second.start, marker="x", color=style.VERMILION, markersize=6)
    axis.plot(first.found.value, second.found.value, marker="+", color=style.VERMILION, markersize=8)
    _scale(axis, "x", first, x)
    _scale(axis, "y", second, y)
