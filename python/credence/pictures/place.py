#!/usr/bin/env python3
"""The document's Figures 1 to 4, each from a single trial of a study, beside its place among all trials of that study.

    python3 analysis/figures.py seed.h5 traces docs/figures

seed.h5 holds the four scenarios of FIGURES; traces/SCENARIO-ARM.h5 is what `credence replay` wrote of one trial of each
arm. analysis/figures.sh makes all of it. Writes figure-1.png to figure-4.png.
"""
import pathlib
import sys

import numpy as np

import credence_results as results
from pictures import study, style, trajectory

FIGURES = ["kf-straight-constant", "kf-straight-ranged", "kf-circle-constant", "kf-circle-ranged"]
DISTRIBUTIONS = (("trace_P", "trace(P) at the last pose"), ("unseen", "features unseen, summed over the poses"))


def open_traces(folder, scenario):
    """{arm: its group} of the trajectory files of a scenario, fixed path first."""
    files = [results.open_file(folder / f"{scenario}-{arm}.h5", (results.TRAJECTORIES,))
             for arm in ("fixed.kf", "greedy.kf")]
    return {arm: group for file in files for _, arm, group in results.arms(file)}


def axes_for(paths, wide):
    """A figure with axes for the paths, for their legend and for two distributions: a straight path takes the whole
    width, a circle half of it."""
    rows, across = (paths, 1) if wide else (1, paths)
    figure = style.plt.figure(figsize=(style.PAGE / 25.4, (96 + 22 * paths if wide else 172) / 25.4))
    grid = figure.add_gridspec(rows + 2, 2, height_ratios=[21 if wide else 84] * rows + [26, 48])
    drawn = [figure.add_subplot(grid[row, :] if across == 1 else grid[row, column])
             for row in range(rows) for column in range(across)]
    key = figure.add_subplot(grid[rows, :])
    key.set_axis_off()
    return figure, drawn, key, [figure.add_subplot(grid[rows + 1, column]) for column in (0, 1)]


def grouped(traces):
    """Arms that took the same path together: [(their names, one of their groups)]."""
    taken = []
    for arm, group in traces.items():
        for names, other in taken:
            if all(np.array_equal(group[name][:], other[name][:]) for name in ("truth", "mean")):
                names.append(arm)
                break
        else:
            taken.append(([arm], group))
    return taken


def share_limits(axes):
    """Gives all of them the same limits."""
    boxes = np.array([[*axis.get_xlim(), *axis.get_ylim()] for axis in axes])
    low, high = boxes.min(axis=0), boxes.max(axis=0)
    for axis in axes:
        axis.set(xlim=(low[0], high[1]), ylim=(low[2], high[3]))


def draw(number, scenario, traces):
    """One figure: the trial's path under each arm, and where it and the published run stand among all trials."""
    wide = results.setting(scenario, "features", "path") == "straight"
    paths = grouped(traces)
    figure, axes, key, places = axes_for(len(paths), wide)
    for axis, (arms, group) in zip(axes, paths):
        trajectory.draw_path(axis, group)
        unit = results.units(group, "trace_P").replace("^2", "²")
        axis.set_title(f"{' and '.join(arms)}: trace(P) {group.attrs['trace_P']:.4g} {unit}, "
                       f"{int(group.attrs['unseen'])} unseen")
    share_limits(axes)
    key.legend(*axes[0].get_legend_handles_labels(), loc="upper center", ncols=5, borderaxespad=0).set_in_layout(False)
    for axis, (name, label) in zip(places, DISTRIBUTIONS):
        study.draw_distribution(axis, scenario, name, label, {arm: float(g.attrs[name]) for arm, g in traces.items()})
        style.legend_above(axis, fontsize=7, handlelength=1.6, handletextpad=0.5).set_in_layout(False)
    source = results.text(next(iter(traces.values())), "source")
    figure.suptitle(f"Figure {number}: {results.text(scenario, 'title')}.\nAbove a single run ({source}), "
                    f"below its place among {study.caption(scenario).split(', ', 1)[1]} (in brackets: trials below)",
                    x=0.01, ha="left", fontsize=8)
    return figure


def main(study_file, traces, output):
    with results.open_file(study_file, (results.STUDY,)) as file:
        for number, name in enumerate(FIGURES, 1):
            figure = draw(number, file[name], open_traces(pathlib.Path(traces), name))
            style.save_png(figure, output, f"figure-{number}", dots_per_inch=160, colours=128)


if __name__ == "__main__":
    if len(sys.argv) != 4:
        print("usage: figures.py STUDY.h5 TRACES OUTPUT", file=sys.stderr)
        sys.exit(2)
    main(*sys.argv[1:])
