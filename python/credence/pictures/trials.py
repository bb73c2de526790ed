"""Pictures of a scenario by trial: the distribution of a column, and of its paired differences."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from .. import means
from .._file import FloatArray
from ..arm import Scenario
from ..study import Study
from . import style
from .steps import Arms, source
from .style import Picture

NAMES = {"trace_P": "trace(P) at the last pose", "unseen": "features unseen, summed over the poses",
         "pose_error": "squared pose error, summed over the poses", "nees_ratio": "NEES / n, mean over the steps",
         "squared_error": "squared error, summed over the steps"}
STAR_POINTS = (5, 4, 6, 3)  # of the star of an arm's published run


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
                      runs: Mapping[str, float] | None = None) -> tuple[dict[str, float], list[tuple[Any, str]]]:
    """The share of trials at or below each value. Single runs, `runs` {arm: value} and the published ones, are marked
    at their place on the curve. Returns {arm: median} and the key."""
    medians, ends, entries = {}, [], []
    for name, (place, arm) in arms.items():
        values = style.finite(arm[column])
        line, marks = style.arm_style(place, len(arms)), style.arm_mark(place)
        hollow = {"color": line["color"], "markerfacecolor": "none", "markersize": 6, "markeredgewidth": 1.1}
        said, published = name, []
        star = (STAR_POINTS[place % len(STAR_POINTS)], 1)
        for given, mark in ((runs or {}, marks["marker"]), (scenario.published(column), star)):
            if name not in given or values.size == 0:
                continue
            share = percentile(values, given[name])
            words = f"{given[name]:.4g} ({share:.1f} % below)"
            drawn = hollow | {"marker": mark, "linestyle": "none"}
            axis.plot(given[name], share, clip_on=False, zorder=3, **drawn)
            if mark != star:
                said, marks = f"{name}, this run {words}", hollow | {"marker": mark}
            else:
                published.append((Line2D([], [], **drawn), f"{name}, published {words}"))
        entries += [(Line2D([], [], **line | marks), said), *published]
        if values.size == 0:
            continue
        shown = style.thinned(values)
        axis.plot(np.r_[values[0], values[shown]], 100 * np.r_[0, shown + 1] / values.size, drawstyle="steps-post",
                  **line)
        medians[name] = float(np.median(values))
        ends.append(np.quantile(values, [0.0005, 0.9995]))
    axis.set(xlabel=name_of(column, scenario), ylabel="trials at or below [%]", ylim=(0, 100))
    counted = next(iter(scenario.arms.values())).describe(column).units == "1"
    if ends and not counted and 0 < 4 * np.min(ends) < np.max(ends):
        style.logarithmic(axis.xaxis, np.min(ends) / 1.1, np.max(ends) * 1.1)
    return medians, entries


def distribution(scenario: Scenario, arms: Arms, width: float, *, column: str = "trace_P") -> Picture:
    """The distribution of a column over the trials, with the published single run at its place where there is one."""
    picture, axis = style.one_panel(width)
    medians, entries = draw_distribution(axis, scenario, arms, column)
    style.key(axis, entries, width)
    unit = style.pretty(next(iter(scenario.arms.values())).describe(column).units)
    picture.title(f"Median of {NAMES.get(column, column)}: " + style.ranked(medians, lambda value: f"{value:.4g}")
                  + f" {unit}", source(scenario))
    return picture


BASELINES = ("fixed", "waypoints", "follow", "nearest", "random")  # controllers that do not plan

NO_PAIR = "no arm has that of a simpler controller and the same estimator beside it"


def pairs(
    names: Sequence[str], wanted: Sequence[str] | None = None, of_records: bool = False
) -> list[tuple[str, str]]:
    """(A, B) of the differences A - B, as `credence compare` chooses them: the two arms that are wanted; else each arm
    with the arm of a simpler controller and the same estimator, of records each with the first."""
    if wanted is not None and len(wanted) == 2:
        return [(wanted[0], wanted[1])]
    if of_records:
        return [(name, names[0]) for name in names[1:]]
    found: list[tuple[str, str]] = []
    for arm in names:
        controller = arm.partition(".")[0]
        simpler = {"greedy": BASELINES, "horizon": ("greedy", *BASELINES)}.get(controller, BASELINES[:1])
        others = [other + arm.removeprefix(controller) for other in simpler if other != controller]
        found += [(arm, other) for other in others if other in names][:1]
    return found


def need_pairs(
    names: Sequence[str], wanted: Sequence[str] | None, option: str, of_records: bool = False
) -> list[tuple[str, str]]:
    """The same, which refuses where there are none."""
    if found := pairs(names, wanted, of_records):
        return found
    raise ValueError(f"invalid {option} ({NO_PAIR}). Choose two: arms=[A, B] of {', '.join(names)}.")


def paired(scenario: Scenario, arms: Arms, width: float, *, column: str = "trace_P",
           wanted: Sequence[str] | None = None) -> Picture:
    """Differences A - B of a column, trial by trial: the curve crosses 0 at the share of trials in which A has less."""
    found = need_pairs(list(arms), wanted, "kind=paired", bool(Study(scenario.group.file).records))
    picture, axis = style.one_panel(width)
    unit, less, reach, scale, entries = "", {}, 0.0, 0.0, []
    for index, (a, b) in enumerate(found):
        difference = arms[a][1][column].astype(float) - arms[b][1][column]
        values, of = style.finite(difference), means.of_values(difference, "1")
        if values.size < 2:
            continue
        shown, line = style.thinned(values), style.arm_style(arms[a][0], len(found))
        low, high = (float(end) for end in of.interval())
        axis.plot(values[shown], 100 * (shown + 1) / values.size, drawstyle="steps-post", **line)
        axis.errorbar(float(of.mean), 4 + 5 * index, xerr=(high - low) / 2, elinewidth=1.6,
                      **style.arm_mark(arms[a][0]))
        name, unit = f"{a} \N{MINUS SIGN} {b}", arms[a][1].describe(column).units
        entries.append((Line2D([], [], **line | style.arm_mark(arms[a][0])),
                        f"{name}: {style.with_half_width(float(of.mean), (high - low) / 2)}"))
        less[f"{a} than {b}"] = 100 * float(np.mean(values < 0))
        reach = max(reach, float(np.quantile(np.abs(values), 0.999)))
        scale = max(scale, float(np.median(np.abs(values))))
    axis.axvline(0, color="black", linewidth=0.6)
    if scale > 0 and reach > 4 * scale:
        style.root_axis(axis, scale, reach)
    axis.set(xlabel=f"difference of {name_of(column, scenario)}", ylabel="trials at or below [%]", ylim=(0, 100))
    style.key(axis, entries, width)
    picture.title(f"Trials with less {NAMES.get(column, column)}: "
                  + style.ranked(less, lambda share: "in > 99 %" if 99.5 <= share < 100 else f"in {share:.0f} %"),
                  f"{source(scenario)}; marks with bars: means with 95 % intervals{style.in_brackets(unit)}")
    return picture
