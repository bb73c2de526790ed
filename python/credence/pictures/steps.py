"""Pictures of a scenario by step: NEES, NIS, coverage, accuracy; and how NEES lies in its chi-square."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.lines import Line2D
from scipy import stats

from .._file import FloatArray
from ..arm import Arm, Scenario
from ..study import Study
from . import style
from .style import Picture

Arms = Mapping[str, tuple[int, Arm]]  # the arms that are drawn, each with its place in the scenario


def source(scenario: Scenario) -> str:
    """What every picture says of where its numbers come from."""
    study = Study(scenario.group.file)
    trials = max(arm.trials for arm in scenario.arms.values())
    seed = "" if study.seed is None else f", seed {study.seed}"
    unfinished = "" if study.complete else ", part of a study"
    return f"{scenario.name}, {trials:,} trials{seed}{unfinished}"


def places(arms: Arms) -> dict[str, int]:
    return {name: place for name, (place, _) in arms.items()}


def band(degrees: FloatArray, level: float = 0.95) -> tuple[FloatArray, FloatArray]:
    """Bounds of a chi-square over its degrees of freedom: the classical band of ANEES and NIS/m."""
    low, high = (stats.chi2.ppf(tail, degrees) / degrees for tail in ((1 - level) / 2, (1 + level) / 2))
    return low, high


def _ratio(scenario: Scenario, arms: Arms, series: Mapping[str, str], label: str, width: float) -> Picture:
    """A ratio that is 1 for a consistent filter, with its 95 % interval and the classical band."""
    picture, axis = style.one_panel(width)
    found, drawn, widest = {}, [], 0.0
    for name, (place, arm) in arms.items():
        degrees = arm.degrees(series[name])
        measured = degrees > 0
        step, means = arm["step"][measured], arm.per_step(series[name])
        ratio = means.over(np.where(measured, degrees / max(arm.counted_trials, 1), np.nan))
        mean, *ends = (values[measured] for values in (ratio.mean, *ratio.interval()))
        bounds = band(degrees[measured])
        if step.size:
            found[name] = float(np.average(mean, weights=degrees[measured])), float(mean.min()), float(mean.max())
        style.curve(axis, step, mean, ends, place, len(arms))
        drawn.append(mean)
        if step.size and (reach := float(np.max(bounds[1] - bounds[0]))) > widest:  # where arms have other bands
            widest, of_widest = reach, (step, *bounds)
    if widest:
        axis.fill_between(*of_widest, color=style.BAND, linewidth=0, zorder=0)
    axis.axhline(1, color=style.GREY, linewidth=0.6, zorder=0.5)
    style.step_axis(axis, arm["step"])
    style.spread_out(axis.yaxis, drawn)
    axis.set_ylabel(label)
    style.key(axis, [*style.arm_entries(places(arms)), style.band_entry("95 % if consistent")], width)
    picture.title(f"{label} over all steps (by step): "
                  + style.ranked(found, lambda of: f"{of[0]:.2f} ({of[1]:.2f} to {of[2]:.2f})"),
                  f"{source(scenario)}; shades or bars: 95 % intervals of the means; a consistent filter is outside "
                  "the grey band at 1 step of 20")
    return picture


def _of(arms: Arms, role: str, group: str) -> dict[str, str]:
    """{arm: its series of a role and component group}."""
    found = {name: arm.series_of(role) for name, (_, arm) in arms.items()}
    for name, groups in found.items():
        if group not in groups:
            raise ValueError(f"invalid group={group} ({name} has no such {role}). It has {', '.join(groups)}.")
    return {name: groups[group] for name, groups in found.items()}


def nees(scenario: Scenario, arms: Arms, width: float, *, group: str = "all") -> Picture:
    """NEES over the dimension of a component group at each step."""
    what = "NEES / dimension" if group == "all" else f"NEES of {group} / dimension"
    return _ratio(scenario, arms, _of(arms, "nees", group), what, width)


def nis(scenario: Scenario, arms: Arms, width: float) -> Picture:
    """NIS over the rows measured at each step."""
    return _ratio(scenario, arms, {name: "nis" for name in arms}, "NIS / measured rows", width)


def trace(scenario: Scenario, arms: Arms, width: float, *, group: str = "all") -> Picture:
    """The mean trace of a component group's covariance at each step."""
    picture, axis = style.one_panel(width)
    found, drawn, unit, series = {}, [], "", _of(arms, "variance", group)
    for name, (place, arm) in arms.items():
        means = arm.per_step(series[name])
        style.curve(axis, arm["step"], means.mean, means.interval(), place, len(arms))
        drawn.append(means.mean)
        found[name], unit = (float(means.mean[-1]), float(np.mean(means.mean))), means.units
    style.step_axis(axis, arm["step"])
    axis.set_ylim(0, None)
    style.spread_out(axis.yaxis, drawn)
    what = "trace(P)" if group == "all" else f"trace(P) of {group}"
    axis.set_ylabel(what + style.in_brackets(unit))
    style.key(axis, style.arm_entries(places(arms)), width)
    picture.title(f"{what} at the last step (mean over the steps): "
                  + style.ranked(found, lambda of: f"{of[0]:.3g} ({of[1]:.3g})") + f" {style.pretty(unit)}",
                  f"{source(scenario)}; shades or bars: 95 % intervals of the means")
    return picture


def coverage(scenario: Scenario, arms: Arms, width: float, *, group: str = "all", level: float = 0.95) -> Picture:
    """The share of trials whose truth is inside the region of P of that level (0.5, 0.9, 0.95 or 0.99) at each step."""
    picture, axis = style.one_panel(width)
    found, series = {}, _of(arms, "nees", group)
    for name, (place, arm) in arms.items():
        at = int(np.argmin(np.abs(arm["level"] - level)))
        shares = 100 * arm.read(f"{series[name]}_covered", (slice(None), at)) / max(arm.counted_trials, 1)
        shown = style.thinned(shares)
        axis.plot(arm["step"][shown], shares[shown], **style.arm_line(place, len(arms), shown.size))
        found[name], level = float(shares.mean()), float(arm["level"][at])
    low, high = (100 * float(stats.binom.ppf(tail, arm.counted_trials, level)) / max(arm.counted_trials, 1)
                 for tail in (0.025, 0.975))
    axis.axhspan(low, high, color=style.BAND, linewidth=0, zorder=0)
    axis.axhline(100 * level, color=style.GREY, linewidth=0.6, zorder=0.5)
    style.step_axis(axis, arm["step"])
    what = "the truth" if group == "all" else group
    axis.set_ylabel(f"inside the {100 * level:g} % region [% of trials]")
    style.key(axis, [*style.arm_entries(places(arms)), style.band_entry("95 % if consistent")], width)
    picture.title(f"The {100 * level:g} % region of P holds {what}: "
                  + style.ranked(found, lambda share: f"in {share:.1f} %") + " of the trials", source(scenario))
    return picture


def chi_square(scenario: Scenario, arms: Arms, width: float, *, bins: int = 32) -> Picture:
    """How the NEES of the whole state lies in its chi-square, over all steps: level at 1 if it is consistent."""
    picture, axis = style.one_panel(width)
    tails = {}
    for name, (place, arm) in arms.items():
        if "nees_cells" in arm:
            counts = arm["nees_cells"].sum(axis=0).reshape(bins, -1).sum(axis=1)
        else:  # of a record: the first trials have their NEES
            nees = arm["detailed_nees"]
            counts = np.histogram(stats.chi2.cdf(nees[~np.isnan(nees)], arm.dimension("nees")), bins, (0, 1))[0]
        axis.stairs(counts * bins / max(counts.sum(), 1), np.linspace(0, 1, bins + 1),
                    **style.arm_style(place, len(arms)))
        tails[name] = 100 - 100 * float(arm.read("nees_covered", (slice(None), 2)).mean()) / max(arm.counted_trials, 1)
    axis.axhline(1, color=style.GREY, linewidth=0.6, zorder=0)
    for level in (0.5, 0.9, 0.95):
        axis.axvline(level, color=style.GREY, linewidth=0.5, linestyle=":", zorder=0)
        axis.text(level, 0.98, f"{100 * level:g} %", transform=axis.get_xaxis_transform(), ha="right", va="top",
                  fontsize=7, color=style.GREY, rotation=90)
    axis.set(xlabel="probability of χ² below the NEES (all steps)", ylabel="density; a consistent filter has 1",
             xlim=(0, 1), ylim=(0, None))
    style.key(axis, style.arm_entries(places(arms)), width)
    picture.title("NEES exceeds the 95 % quantile of χ²: " + style.ranked(tails, lambda share: f"in {share:.1f} %")
                  + " of trials and steps; if consistent, in 5 %",
                  f"{source(scenario)}; {bins} bins of equal probability")
    return picture


def accuracy(scenario: Scenario, arms: Arms, width: float, *, group: str = "all") -> Picture:
    """The root mean squared error of a component group at each step (line), and what P says of it (dots)."""
    measured: dict[str, Any] = {"linestyle": "-"}
    believed: dict[str, Any] = {"linestyle": ":", "linewidth": 1.4, "markerfacecolor": "white"}
    picture, axis = style.one_panel(width)
    errors, variances = _of(arms, "squared_error", group), _of(arms, "variance", group)
    found, unit = {}, ""
    for name, (place, arm) in arms.items():
        error, said = (np.sqrt(arm.per_step(series[name]).mean) for series in (errors, variances))
        low, high = (np.sqrt(np.maximum(end, 0)) for end in arm.per_step(errors[name]).interval())
        shown, step = style.thinned(error, said), arm["step"]
        line = style.arm_line(place, len(arms), shown.size)
        style.interval(axis, step[shown], error[shown], low[shown], high[shown], line, len(arms))
        axis.plot(step[shown], error[shown], **line | measured)
        axis.plot(step[shown], said[shown], **line | believed)
        found[name], unit = float(np.sqrt(np.mean(error**2) / np.mean(said**2))), arm.describe(errors[name]).units
    style.step_axis(axis, arm["step"])
    what = "the state" if group == "all" else group
    axis.set(ylabel=f"error of {what} [{style.root_of(unit)}]", ylim=(0, None))
    grey: dict[str, Any] = {"color": style.GREY, "marker": "o"}
    lines = [(Line2D([], [], **grey | measured), "root mean square"),
             (Line2D([], [], **grey | believed), "what P says")]
    style.key(axis, [*style.arm_entries(places(arms), **measured), *lines], width)
    picture.title(f"Error of {what} over what P says: " + style.ranked(found, lambda ratio: f"{ratio:.2f}"),
                  f"{source(scenario)}; shades or bars: 95 % intervals; dots, hollow marks: root of the mean variance")
    return picture
