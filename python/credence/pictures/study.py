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
    for index, group in enumerate(scenario.values()):
        degrees = results.degrees(group, figure)
        measured, line = degrees > 0, style.arm_line(index, len(scenario), int((degrees > 0).sum()))
        step, means = group["step"][:][measured], results.per_step(group, figure)
        scale = int(group.attrs["counted_trials"]) / degrees[measured]  # from a mean over trials to one over degrees
        axis.fill_between(step, *results.chi_square_band(degrees[measured]), color=style.BAND, linewidth=0, zorder=0,
                          label=None if index else "95 % band of a consistent filter")
        axis.fill_between(step, means.low[measured] * scale, means.high[measured] * scale, color=line["color"],
                          alpha=0.25, linewidth=0)
        axis.plot(step, means.mean[measured] * scale, **line)
    axis.axhline(1, color=style.GREY, linewidth=0.6, zorder=0.5)
    style.step_axis(axis, group["step"][:])
    axis.set_ylabel(label)


def consistency(scenario, width=style.PAGE):
    """NEES and, of filters that have innovations, NIS per step with their bands."""
    first = next(iter(scenario.values()))
    ratios = [("nees", "NEES / state dimension"), ("nis", "NIS / measurement rows")]
    ratios = [(figure, label) for figure, label in ratios if figure in results.figures(first, figure)]
    figure, axes = style.panels(len(ratios), 68, width)
    for axis, (name, label) in zip(np.atleast_1d(axes), ratios):
        _per_step(axis, scenario, name, label)
    style.legend_above(np.atleast_1d(axes)[0])
    style.arms_below(figure, scenario)
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
                  label=arm, rasterized=values.size > 20000, **style.arm_style(index, len(scenario)))
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
    if name in ("trace_P", "squared_error") and 0 < lowest < highest:
        style.logarithmic(axis.xaxis, lowest / 1.1, highest * 1.1)


# What is drawn of trials, with its name in words: what the scenario's world has of it.
TRIAL_FIGURES = {"trace_P": "trace(P) at the last pose", "unseen": "features unseen, summed over the poses",
                 "squared_error": "squared error, summed over the steps"}
DIFFERENCES = {"trace_P": "trace(P)", "unseen": "unseen", "pose_error": "pose error", "squared_error": "squared error"}


def _of_world(scenario, words):
    """Those columns that the arms of a scenario have."""
    first = next(iter(scenario.values()))
    return {name: label for name, label in words.items() if results.has_column(first, name)}


def distributions(scenario, width=style.PAGE):
    """Distributions of trace(P) and of what else the world counts, with the published single run marked."""
    drawn = _of_world(scenario, TRIAL_FIGURES)
    figure, axes = style.panels(len(drawn), 74, width)
    for axis, (name, label) in zip(axes, drawn.items()):
        draw_distribution(axis, scenario, name, label)
        runs = [(handle, text) for handle, text in zip(*axis.get_legend_handles_labels()) if text not in scenario]
        if runs:
            style.legend_above(axis, columns=1, handles=[handle for handle, _ in runs], labels=[text for _, text in runs])
    handles, labels = axes[0].get_legend_handles_labels()
    style.legend_below(figure, *zip(*[(handle, text) for handle, text in zip(handles, labels) if text in scenario]))
    title(figure, scenario, "; in brackets the share of trials below" if results.published(scenario, "trace_P") else "")
    return figure


def pairs(scenario):
    """(planned, fixed) arms of the same estimator."""
    named = [(arm, "fixed." + arm.partition(".")[2]) for arm in scenario]
    return [(arm, fixed) for arm, fixed in named if arm != fixed and fixed in scenario]


def _draw_difference(axis, scenario, name, label):
    """The share of trials at or below each difference of planned and fixed, and the mean with its interval. The curve
    crosses 0 at the share of trials in which the planned path has less."""
    reach = scale = 0.0
    paired = pairs(scenario)
    for index, (planned, fixed) in enumerate(paired):
        difference = results.column(scenario[planned], name) - results.column(scenario[fixed], name)
        difference = np.sort(difference[~np.isnan(difference)])
        if difference.size < 2:
            continue
        line, mean = _pair_style(index, len(paired)), difference.mean()
        half = stats.t.ppf(0.975, difference.size - 1) * difference.std(ddof=1) / np.sqrt(difference.size)
        axis.plot(difference, 100 * np.arange(1, difference.size + 1) / difference.size, drawstyle="steps-post", **line,
                  label=f"{style.with_half_width(mean, half)}; {100 * np.mean(difference < 0):.0f} % < 0")
        axis.axvspan(mean - half, mean + half, color=line["color"], alpha=0.3, linewidth=0)
        axis.axvline(mean, color=line["color"], linewidth=0.8)
        reach = max(reach, np.quantile(np.abs(difference), 0.999))
        scale = max(scale, np.median(np.abs(difference)))
    axis.axvline(0, color="black", linewidth=0.6)
    if name != "unseen" and scale > 0:
        style.root_axis(axis, scale, reach)
    unit = style.unit_text(results.units(next(iter(scenario.values())), name)).replace(" ", "\n", 1)
    axis.set(xlabel=f"difference of {label}{unit}", ylabel="trials at or below [%]", ylim=(0, 100))


def _pair_style(index, count):
    """Pairs have other colours than the first two arms, and the only one a line without dashes."""
    return style.arm_style(index + 2, count + 2) | ({"linestyle": "-"} if count == 1 else {})


def paired(scenario, width=style.PAGE):
    """Paired differences planned - fixed of what the world counts by trial; None where no arms pair."""
    if not (names := [f"{planned} \N{MINUS SIGN} {fixed}" for planned, fixed in pairs(scenario)]):
        return None
    drawn = _of_world(scenario, DIFFERENCES)
    figure, axes = style.panels(len(drawn), 66 + 4 * len(names), width)
    for axis, (name, label) in zip(axes, drawn.items()):
        _draw_difference(axis, scenario, name, label)
        style.legend_above(axis, columns=1, fontsize=7, handlelength=1.4, handletextpad=0.5)
    if len(names) > 1:
        keys = [style.plt.Line2D([], [], **_pair_style(index, len(names))) for index in range(len(names))]
        style.legend_below(figure, keys, names)
    what = names[0] if len(names) == 1 else "planned \N{MINUS SIGN} fixed"
    title(figure, scenario, f"; {what}, trial by trial; above: means, and trials below 0")
    return figure


def _draw_coverage(axis, scenario, column):
    """The share of trials whose NEES lies below one quantile of chi-square, per step, beside what it should be."""
    for index, group in enumerate(scenario.values()):
        shares = 100 * group["nees_covered"][:, column] / int(group.attrs["counted_trials"])
        axis.plot(group["step"][:], shares, **style.arm_line(index, len(scenario), shares.size))
    level = 100 * group["level"][column]
    axis.axhline(level, color=style.GREY, linewidth=0.8, zorder=0)
    style.step_axis(axis, group["step"][:])
    axis.xaxis.get_major_locator().set_params(nbins=4)
    axis.set_title(f"{level:g} % quantile")


def _draw_blocks_coverage(axis, scenario, level=0.95):
    """The same at one level for each block of the state, over all steps."""
    figures = results.figures(next(iter(scenario.values())), "nees")
    for index, (arm, group) in enumerate(scenario.items()):
        at = int(np.argmin(np.abs(group["level"][:] - level)))
        shares = [100 * group[f"{f}_covered"][:, at].mean() / int(group.attrs["counted_trials"]) for f in figures]
        axis.plot(shares, np.arange(len(figures)) + style.aside(index, len(scenario)), linestyle="none",
                  markersize=4, **style.arm_mark(index))
    axis.axvline(100 * level, color=style.GREY, linewidth=0.8, zorder=0)
    axis.set_yticks(range(len(figures)), [results.text(group[f"{f}_total"], "part_of") for f in figures])
    axis.set_ylim(len(figures) - 0.5, -0.5)
    axis.set_xlabel(f"NEES below its {100 * level:g} % quantile\n[% of trials and steps]")


def _draw_shape(axis, scenario, bins=32):
    """How the NEES of the whole state lie in chi-square: level at 1 where the filter is consistent."""
    for index, group in enumerate(scenario.values()):
        if "nees_cells" in group:
            counts = group["nees_cells"][:].sum(axis=0).reshape(bins, -1).sum(axis=1)
            axis.stairs(counts * bins / counts.sum(), np.linspace(0, 1, bins + 1),
                        **style.arm_style(index, len(scenario)))
    axis.axhline(1, color=style.GREY, linewidth=0.6, zorder=0)
    axis.set(xlabel="share of χ² below NEES\n(all steps)", ylabel="density", xlim=(0, 1), ylim=(0, None))


def coverage(scenario, width=style.PAGE):
    """Coverage of NEES by step, a panel for each quantile; coverage by block; and the shape of its distribution."""
    first = next(iter(scenario.values()))
    levels, blocks = first["level"].size, len(results.figures(first, "nees"))
    across = levels if width >= style.PAGE else 2
    rows = -(-levels // across)  # of levels; below them block and shape, side by side or one below the other
    below = min(200, max(62, 26 + max(3.6, 1.2 * len(scenario)) * blocks))
    heights = [54] * rows + [below] * (1 if width >= style.PAGE else 2)
    figure = style.plt.figure(figsize=(width / 25.4, (8 + sum(heights)) / 25.4))
    grid = figure.add_gridspec(len(heights), across, height_ratios=heights)
    by_level = [figure.add_subplot(grid[level // across, level % across]) for level in range(levels)]
    for level, axis in enumerate(by_level):
        _draw_coverage(axis, scenario, level)
    by_level[0].set_ylabel("NEES below a quantile of χ²\n[% of trials]")
    half = across // 2 if len(heights) == rows + 1 else across
    _draw_blocks_coverage(figure.add_subplot(grid[rows, :half]), scenario)
    _draw_shape(figure.add_subplot(grid[-1, across - half:]), scenario)
    style.arms_below(figure, scenario)
    title(figure, scenario, "; grey: a consistent filter")
    return figure
