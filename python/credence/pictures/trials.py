"""Pictures of a scenario by trial: the distribution of a column, and of its paired differences."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from .. import means
from .._file import FloatArray
from ..study import Scenario
from . import style
from .steps import Arms, places, source
from .style import Picture

NAMES = {"trace_P": "trace(P) at the last pose", "unseen": "features unseen, summed over the poses",
         "pose_error": "squared pose error, summed over the poses", "nees_ratio": "NEES / n, mean over the steps",
         "squared_error": "squared error, summed over the steps"}


def name_of(column: str, scenario: Scenario) -> str:
    """A column in words, with its unit."""
    first = next(iter(scenario.arms.values()))
    described = first.describe(column)
    return NAMES.get(column, described.meaning) + style.in_brackets(described.units)


def percentile(values: FloatArray, value: float) -> float:
    """The share of values below, ties half, in percent: the mid-rank of docs/statistics.md."""
    values = style.finite(values)
    return float(100 * (np.mean(values < value) + np.mean(values == value) / 2))


def draw_distribution(axis: Axes, scenario: Scenario, arms: Arms, column: str,
                      width: float, runs: Mapping[str, float] | None = None) -> dict[str, float]:
    """The share of trials at or below each value. Single runs, `runs` {arm: value} and the published ones, are marked
    at their place on the curve. Returns {arm: median}."""
    medians, ends, entries = {}, [], style.arm_entries(places(arms))
    marks = (("this run", "v", runs or {}), ("published run", "D", scenario.published(column)))
    for name, (place, arm) in arms.items():
        values = style.finite(arm[column])
        if values.size == 0:
            continue
        shown = style.thinned(values)
        axis.plot(np.r_[values[0], values[shown]], 100 * np.r_[0, shown + 1] / values.size, drawstyle="steps-post",
                  **style.arm_style(place, len(arms)))
        for what, marker, given in marks:
            if name in given:
                share = percentile(values, given[name])
                (mark,) = axis.plot(given[name], share, marker=marker, linestyle="none", markersize=5.5,
                                    markerfacecolor="white", markeredgewidth=1.2, clip_on=False, zorder=3,
                                    color=style.arm_style(place)["color"])
                entries.append((mark, f"{what} {given[name]:.4g} ({share:.1f} % below)"))
        medians[name] = float(np.median(values))
        ends.append(np.quantile(values, [0.0005, 0.9995]))
    axis.set(xlabel=name_of(column, scenario), ylabel="trials at or below [%]", ylim=(0, 100))
    counted = next(iter(scenario.arms.values())).describe(column).units == "1"
    if ends and not counted and 0 < 4 * np.min(ends) < np.max(ends):
        style.logarithmic(axis.xaxis, np.min(ends) / 1.1, np.max(ends) * 1.1)
    style.key(axis, entries, width)
    return medians


def distribution(scenario: Scenario, arms: Arms, width: float, *, column: str = "trace_P") -> Picture:
    """The distribution of a column over the trials, with the published single run at its place where there is one."""
    picture, axis = style.one_panel(width)
    medians = draw_distribution(axis, scenario, arms, column, width)
    unit = style.pretty(next(iter(scenario.arms.values())).describe(column).units)
    picture.title(f"Median of {NAMES.get(column, column)}: " + style.ranked(medians, lambda value: f"{value:.4g}")
                  + f" {unit}", source(scenario))
    return picture


def pairs(names: Any) -> list[tuple[str, str]]:
    """(planned, fixed) arms of the same estimator."""
    named = [(arm, "fixed." + arm.partition(".")[2]) for arm in names]
    return [(arm, fixed) for arm, fixed in named if arm != fixed and fixed in names]


def paired(scenario: Scenario, arms: Arms, width: float, *, column: str = "trace_P") -> Picture:
    """Differences planned - fixed of a column, trial by trial: the curve crosses 0 at the share of trials in which the
    planned path has less."""
    found = pairs(arms)
    if not found:
        raise ValueError("invalid kind=paired (there is no arm with a fixed one of its estimator). Take another kind.")
    picture, axis = style.one_panel(width)
    unit, less, reach, scale, entries = "", {}, 0.0, 0.0, []
    for index, (planned, fixed) in enumerate(found):
        difference = arms[planned][1][column].astype(float) - arms[fixed][1][column]
        values, of = style.finite(difference), means.of_values(difference, "1")
        if values.size < 2:
            continue
        shown, line = style.thinned(values), style.arm_style(arms[planned][0], len(found))
        low, high = (float(end) for end in of.interval())
        axis.plot(values[shown], 100 * (shown + 1) / values.size, drawstyle="steps-post", **line)
        axis.errorbar(float(of.mean), 4 + 5 * index, xerr=(high - low) / 2, elinewidth=1.6,
                      **style.arm_mark(arms[planned][0]))
        name, unit = f"{planned} \N{MINUS SIGN} {fixed}", arms[planned][1].describe(column).units
        entries.append((Line2D([], [], **line | style.arm_mark(arms[planned][0])),
                        f"{name}: {style.with_half_width(float(of.mean), (high - low) / 2)}"))
        less[planned] = 100 * float(np.mean(values < 0))
        reach = max(reach, float(np.quantile(np.abs(values), 0.999)))
        scale = max(scale, float(np.median(np.abs(values))))
    axis.axvline(0, color="black", linewidth=0.6)
    if scale > 0 and reach > 4 * scale:
        style.root_axis(axis, scale, reach)
    axis.set(xlabel=f"difference of {name_of(column, scenario)}", ylabel="trials at or below [%]", ylim=(0, 100))
    style.key(axis, entries, width)
    picture.title(f"Less {NAMES.get(column, column)} than on the fixed path: "
                  + style.ranked(less, lambda share: f"in {share:.0f} %") + " of the trials",
                  f"{source(scenario)}; marks with bars: means with 95 % intervals{style.in_brackets(unit)}")
    return picture
