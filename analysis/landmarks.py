#!/usr/bin/env python3
"""Tables and picture of docs/estimators.md, "Landmarks on a loop", from a file of experiments/estimators/landmarks.ini.

    python3 analysis/landmarks.py study.h5 [-o landmarks.png] [--sweep sigma=FILE.h5 ...]

Exit codes: 0 done, 2 bad input (nothing written).
"""
import argparse
import pathlib
import sys

import numpy as np

import credence_results as results
from pictures import style


def estimator(arm):
    """`ekf` of `fixed.ekf`."""
    return arm.split(".")[1]


def with_error(value, error):
    """`2.31 ± 0.03`: one digit of the error, two where it begins with 1."""
    digits = max(0, -int(np.floor(np.log10(error / 1.95)))) if error > 0 else 3
    return f"{value:.{digits}f} ± {error:.{digits}f}"


def row(cells):
    print("| " + " | ".join(cells) + " |")


def heading(*cells):
    print()
    row(cells)
    row(["---"] * len(cells))


def tenths(group):
    """Indices of the steps that end each tenth of the run: the loops, where there are ten."""
    steps = group["step"].size
    return [steps * part // 10 - 1 for part in range(1, 11)]


def ratio(means, k):
    """A mean over its dimension."""
    return with_error(means.mean[k] / means.dimension, means.standard_error[k] / means.dimension)


def ratios(scenario, figure, title):
    """NEES over its dimension at ten steps, by arm."""
    first = next(iter(scenario.values()))
    heading(title, *(str(first["step"][k]) for k in tenths(first)))
    for arm, group in scenario.items():
        means = results.per_step(group, figure)
        row([estimator(arm), *(ratio(means, k) for k in tenths(group))])


def root(mean, error):
    """A root mean square with the error of the mean."""
    return with_error(np.sqrt(mean), error / (2 * np.sqrt(mean)))


def summary(scenario):
    """What is asked of the whole state, of accuracy, and of what the filter believes."""
    first = next(iter(scenario.values()))
    k = [tenths(first)[place] for place in (0, 4, 9)]
    at = ", ".join(str(first["step"][i]) for i in k)
    last = first["step"][k[-1]]
    heading("", f"NEES/n at {at}", f"in the invariant chart at {last}", f"heading RMSE at {at}", "heading RMSE, all steps", "position RMSE, all steps",
            f"predicted heading σ at {last}", "unsettled updates a run")
    for arm, group in scenario.items():
        nees, squares = results.per_step(group, "nees"), results.per_step(group, "squared_error_heading")
        invariant = results.per_step(group, "nees_invariant")
        whole = [results.over_steps(group, f"squared_error_{part}") for part in ("heading", "position")]
        variance = results.per_step(group, "variance_heading").mean[k[-1]]
        unsettled = results.total(group, "unsettled_updates_total").sum() / int(group.attrs["counted_trials"])
        row([estimator(arm), "; ".join(ratio(nees, i) for i in k), ratio(invariant, k[-1]),
             "; ".join(root(squares.mean[i], squares.standard_error[i]) for i in k),
             *(root(means.mean, means.standard_error) for means in whole), f"{np.sqrt(variance):.4f}",
             f"{unsettled:.3f}"])


def sweep(files):
    """Heading NEES at the last step under other heading noises. `files` [(sigma, path)]."""
    heading("σ_head", "trials", "estimator", "heading NEES at the last step")
    for sigma, path in files:
        with results.open_file(path, (results.STUDY,)) as file:
            for _, arm, group in results.arms(file):
                means = results.per_step(group, "nees_heading")
                row([sigma, f"{int(group.attrs['counted_trials']):,}", estimator(arm),
                     with_error(means.mean[-1], means.standard_error[-1])])


def picture(scenario, path):
    """Heading NEES by step; and the heading's RMSE beside what the filter believes."""
    figure, (left, right) = style.panels(2, 72, style.PAGE)
    for index, (arm, group) in enumerate(scenario.items()):
        colour, step = style.arm_style(index)["color"], group["step"][:]
        means = results.per_step(group, "nees_heading")
        left.plot(step, means.mean, label=estimator(arm), color=colour, linewidth=0.6)
        if estimator(arm) in ("ekf", "riekf"):
            squares, variance = results.per_step(group, "squared_error_heading"), results.per_step(group, "variance_heading")
            right.plot(step, np.sqrt(squares.mean), color=colour, linewidth=0.6, label=f"{estimator(arm)}: RMSE")
            right.plot(step, np.sqrt(variance.mean), color=colour, linewidth=1.4, linestyle=":", zorder=3,
                       label=f"{estimator(arm)}: predicted σ")
    left.axhline(1, color=style.GREY, linewidth=0.6, zorder=0.5)
    left.set_ylabel("heading NEES")
    right.set_ylabel("heading [rad]")
    right.set_ylim(bottom=0)
    for axis in (left, right):
        axis.set_xlabel("step")
        axis.set_xlim(0, step[-1])
        style.legend_above(axis, columns=3 if axis is left else 2)
    trials = next(iter(scenario.values()))["trial"].size
    style.headline(figure, f"Landmarks on a loop, {trials:,} trials")
    style.save_png(figure, path.parent, path.stem, dots_per_inch=160, colours=128)


def main(arguments=None):
    parser = argparse.ArgumentParser(description="Tables and picture of landmarks on a loop.")
    parser.add_argument("file", metavar="FILE.h5")
    parser.add_argument("-o", "--output", metavar="PICTURE.png", help="draw it there, a PNG")
    parser.add_argument("--sweep", metavar="SIGMA=FILE.h5", nargs="*", default=[], help="other heading noises")
    options = parser.parse_args(arguments)
    files = [tuple(one.split("=", 1)) for one in options.sweep]
    try:
        if any(len(pair) != 2 for pair in files):
            raise ValueError("invalid --sweep (must be SIGMA=FILE.h5). Write it so.")
        with results.open_file(options.file, (results.STUDY,)) as file:
            _, scenario = results.scenarios(file)[0]
            if results.setting(scenario, "scenario", "world") != "landmarks":
                raise ValueError(f"{options.file} holds no landmarks. Give a file of experiments/estimators/landmarks.ini.")
            ratios(scenario, "nees_pose", "pose NEES/3")
            ratios(scenario, "nees_heading", "heading NEES")
            summary(scenario)
            if options.output:
                picture(scenario, pathlib.Path(options.output))
        if files:
            sweep(files)
    except ValueError as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
