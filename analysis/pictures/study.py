"""Pictures of one scenario of a results file. Each takes the scenario's group and draws all arms in it."""
import numpy as np
from scipy import stats

import credence_results as results

from . import style


def caption(scenario):
    """What every picture says of where its figures come from."""
    root = scenario.file
    trials = max(results.trials(group) for group in scenario.values())
    unfinished = "" if root.attrs["complete"] else ", part of a study"
    return f"{scenario.name[1:]}, {trials:,} trials, seed {results.text(root, 'root_seed_text')}{unfinished}"


def title(figure, scenario, what=""):
    style.headline(figure, caption(scenario) + what)


def _per_step(axis, scenario, figure, label):
    """A ratio that is 1 for a consistent filter, with its interval (shade of the arm's colour) and classical band."""
    for index, (arm, group) in enumerate(scenario.items()):
        degrees = results.degrees(group, figure)
        measured, line = degrees > 0, style.arm_style(index)
        step, means = group["step"][:][measured], results.per_step(group, figure)
        scale = int(group.attrs["counted_trials"]) / degrees[measured]  # from a mean over trials to one over degrees
        axis.fill_between(step, *results.chi_square_band(degrees[measured]), color=style.BAND, linewidth=0, zorder=0,
                          label=None if index else "95 % band of a consistent filter")
        axis.fill_between(step, means.low[measured] * scale, means.high[measured] * scale, color=line["color"],
                          alpha=0.25, linewidth=0)
        axis.plot(step, means.mean[measured] * scale, label=arm, marker=style.ARM_MARKERS[index % 6], **line)
    axis.axhline(1, color=style.GREY, linewidth=0.6, zorder=0.5)
    style.step_axis(axis, group["step"][:])
    axis.set_ylabel(label)


def consistency(scenario, width=style.PAGE):
    """NEES and NIS per step with their bands."""
    figure, (left, right) = style.panels(2, 68, width)
    _per_step(left, scenario, "nees", "NEES / state dimension")
    _per_step(right, scenario, "nis", "NIS / measurement rows")
    arms, labels = left.get_legend_handles_labels()
    style.legend_above(left, handles=arms[1:], labels=labels[1:])
    style.legend_above(right, handles=arms[:1], labels=labels[:1])
    title(figure, scenario, "; shades: 95 % intervals of the means")
    return figure


def percentile(values, value):
    """The share of values below, ties half, in percent: the mid-rank of docs/statistics.md."""
    values = values[~np.isnan(values)]
    return 100 * (np.mean(values < value) + np.mean(values == value) / 2)


def draw_distribution(axis, scenario, name, label, runs=None):
    """The share of trials at or below each value of a column, under each arm. Single runs stand at their place on the
    curve, and the legend gives the share of trials below: the published ones, and `runs` {arm: value}."""
    lowest, highest = np.inf, -np.inf
    marks = (("this run", "v", runs or {}), ("published", "D", results.published(scenario, name)))
    for index, (arm, group) in enumerate(scenario.items()):
        values = np.sort(results.column(group, name))
        values = values[~np.isnan(values)]
        if values.size == 0:
            continue
        axis.plot(np.r_[values[0], values], 100 * np.arange(values.size + 1) / values.size, drawstyle="steps-post",
                  label=arm, rasterized=values.size > 20000, **style.arm_style(index))
        for what, marker, given in marks:
            if arm in given:
                place = percentile(values, given[arm])
                axis.plot(given[arm], place, marker=marker, linestyle="none", markersize=5.5, markerfacecolor="white",
                          markeredgewidth=1.2, color=style.arm_style(index)["color"], zorder=3, clip_on=False,
                          label=f"{what} {given[arm]:.4g} ({place:.1f} %)")
        lowest, highest = min(lowest, np.quantile(values, 0.0005)), max(highest, np.quantile(values, 0.9995))
    axis.set_xlabel(label + style.unit_text(results.units(next(iter(scenario.values())), name)))
    axis.set_ylabel("trials at or below [%]")
    axis.set_ylim(0, 100)
    if name == "trace_P" and 0 < lowest < highest:
        style.logarithmic(axis.xaxis, lowest / 1.1, highest * 1.1)


def distributions(scenario, width=style.PAGE):
    """Distributions of trace(P) and unseen per arm, with the published single run marked."""
    figure, (left, right) = style.panels(2, 84, width)
    draw_distribution(left, scenario, "trace_P", "trace(P) at the last pose")
    draw_distribution(right, scenario, "unseen", "features unseen, summed over the poses")
    for axis in (left, right):
        style.legend_above(axis, columns=1)
    title(figure, scenario, "; in brackets the share of trials below" if results.published(scenario, "trace_P") else "")
    return figure


def pairs(scenario):
    """(planned, fixed) arms of the same estimator."""
    return [(arm, "fixed." + arm.split(".", 1)[1]) for arm in scenario
            if not arm.startswith("fixed.") and "fixed." + arm.split(".", 1)[1] in scenario]


def _draw_difference(axis, scenario, name, label):
    """The share of trials at or below each difference of planned and fixed, and the mean with its interval. The curve
    crosses 0 at the share of trials in which the planned path has less."""
    reach = scale = 0.0
    for index, (planned, fixed) in enumerate(pairs(scenario)):
        difference = results.column(scenario[planned], name) - results.column(scenario[fixed], name)
        difference = np.sort(difference[~np.isnan(difference)])
        if difference.size < 2:
            continue
        line, mean = style.arm_style(index + 2) | {"linestyle": "-"}, difference.mean()
        half = stats.t.ppf(0.975, difference.size - 1) * difference.std(ddof=1) / np.sqrt(difference.size)
        axis.plot(difference, 100 * np.arange(1, difference.size + 1) / difference.size, drawstyle="steps-post", **line,
                  label=f"{planned} \N{MINUS SIGN} {fixed}" if len(pairs(scenario)) > 1 else None)
        axis.axvspan(mean - half, mean + half, color=line["color"], alpha=0.3, linewidth=0)
        axis.axvline(mean, color=line["color"], linewidth=0.8, label=style.with_half_width("mean", mean, half))
        axis.plot([], [], " ", label=f"below 0 in {100 * np.mean(difference < 0):.0f} %")
        reach = max(reach, np.quantile(np.abs(difference), 0.999))
        scale = max(scale, np.median(np.abs(difference)))
    axis.axvline(0, color="black", linewidth=0.6)
    if name != "unseen" and scale > 0:
        style.root_axis(axis, scale, reach)
    unit = results.units(next(iter(scenario.values())), name)
    axis.set(xlabel=label + style.unit_text(unit), ylabel="trials at or below [%]", ylim=(0, 100))


def paired(scenario, width=style.PAGE):
    """Paired differences planned - fixed of trace(P), unseen and pose error; None where no arms pair."""
    if not pairs(scenario):
        return None
    figure, axes = style.panels(3, 74, width)
    for axis, name, label in zip(axes, ("trace_P", "unseen", "pose_error"),
                                 ("difference of trace(P)", "difference of unseen", "difference of pose error")):
        _draw_difference(axis, scenario, name, label)
        style.legend_above(axis, columns=1)
    names = ", ".join(f"{planned} \N{MINUS SIGN} {fixed}" for planned, fixed in pairs(scenario))
    title(figure, scenario, f"; {names}, trial by trial")
    return figure


def _draw_coverage(axis, scenario):
    """Shares of trials whose NEES lies below a quantile of chi-square, per step, beside what they should be. All of the
    trials, or none, are drawn at the edge: the axis ends before 0 and 1."""
    least = 0.5
    for index, (arm, group) in enumerate(scenario.items()):
        shares = np.clip(group["nees_covered"][:] / int(group.attrs["counted_trials"]), 0.001, 0.9995)
        least = min(least, shares.min())
        for column in range(shares.shape[1]):
            axis.plot(group["step"][:], shares[:, column], label=None if column else arm, **style.arm_style(index))
    for level in group["level"][:]:
        axis.axhline(level, color=style.GREY, linewidth=0.8, zorder=0)
    ticks = np.array([0.001, 0.01, 0.1, 0.25, 0.5, 0.75, 0.9, 0.95, 0.99, 0.999])
    axis.set_yscale("logit")
    axis.set_yticks(ticks, [f"{100 * tick:g}" for tick in ticks])
    axis.minorticks_off()
    style.step_axis(axis, group["step"][:])
    axis.set(ylabel="NEES below a quantile of χ² [% of trials]", ylim=(0.85 * least, 0.9996))


def _draw_blocks_coverage(axis, scenario, level=0.95):
    """The same at one level for each block of the state, over all steps."""
    figures = results.figures(next(iter(scenario.values())), "nees")
    for index, (arm, group) in enumerate(scenario.items()):
        at = int(np.argmin(np.abs(group["level"][:] - level)))
        shares = [100 * group[f"{f}_covered"][:, at].mean() / int(group.attrs["counted_trials"]) for f in figures]
        axis.plot(shares, np.arange(len(figures)) + style.aside(index, len(scenario)), linestyle="none",
                  marker=style.ARM_MARKERS[index % 6], markersize=4.5, color=style.arm_style(index)["color"])
    axis.axvline(100 * level, color=style.GREY, linewidth=0.8, zorder=0)
    axis.set_yticks(range(len(figures)), [results.text(group[f"{f}_total"], "part_of") for f in figures])
    axis.set_ylim(len(figures) - 0.5, -0.5)
    axis.set_xlabel(f"NEES below its {100 * level:g} % quantile\n[% of trials and steps]")


def _draw_shape(axis, scenario, bins=32):
    """How the NEES of the whole state lie in chi-square: level at 1 where the filter is consistent."""
    for index, group in enumerate(scenario.values()):
        if "nees_cells" in group:
            counts = group["nees_cells"][:].sum(axis=0).reshape(bins, -1).sum(axis=1)
            axis.stairs(counts * bins / counts.sum(), np.linspace(0, 1, bins + 1), **style.arm_style(index))
    axis.axhline(1, color=style.GREY, linewidth=0.6, zorder=0)
    axis.set(xlabel="share of χ² below NEES\n(all steps)", ylabel="density", xlim=(0, 1), ylim=(0, None))


def coverage(scenario, width=style.PAGE):
    """Coverage of NEES by step and by block, and the shape of its distribution."""
    blocks = len(results.figures(next(iter(scenario.values())), "nees"))
    figure, axes = style.panels(3, max(74, 34 + 3.6 * blocks), width)
    _draw_coverage(axes[0], scenario)
    _draw_blocks_coverage(axes[1], scenario)
    _draw_shape(axes[2], scenario)
    style.legend_above(axes[0])
    title(figure, scenario, "; grey: a consistent filter")
    return figure
