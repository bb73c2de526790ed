#!/usr/bin/env python3
"""Tables of docs/theory/estimators.md and pictures of docs/estimators.md, "Landmarks on a loop", from a study of
landmarks.ini.

    PYTHONPATH=python python3 experiments/estimators/landmarks.py study.h5 [-o DIR] [--sweep sigma=FILE.h5 ...]

Exit codes: 0 done, 2 bad input (nothing written).
"""

from __future__ import annotations

import argparse
import pathlib
import sys

import numpy as np

import credence


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


def tenths(arm):
    """Indices of the steps that end each tenth of the run: the loops, where there are ten."""
    return [arm["step"].size * part // 10 - 1 for part in range(1, 11)]


def ratio(means, k):
    """A mean over its dimension."""
    return with_error(means.mean[k] / means.dimension, means.standard_error[k] / means.dimension)


def ratios(scenario, series, title):
    """NEES over its dimension at ten steps, by arm."""
    first = next(iter(scenario.arms.values()))
    heading(title, *(str(first["step"][k]) for k in tenths(first)))
    for name, arm in scenario.arms.items():
        means = arm.per_step(series)
        row([estimator(name), *(ratio(means, k) for k in tenths(arm))])


def root(mean, error):
    """A root mean square with the error of the mean."""
    return with_error(np.sqrt(mean), error / (2 * np.sqrt(mean)))


def summary(scenario):
    """What is asked of the whole state, of accuracy, and of what the filter believes."""
    first = next(iter(scenario.arms.values()))
    k = [tenths(first)[place] for place in (0, 4, 9)]
    at = ", ".join(str(first["step"][i]) for i in k)
    last = first["step"][k[-1]]
    heading("", f"NEES/n at {at}", f"in the invariant chart at {last}", f"heading RMSE at {at}",
            "heading RMSE, all steps", "position RMSE, all steps", f"predicted heading σ at {last}",
            "unsettled updates a run")
    for name, arm in scenario.arms.items():
        nees, squares = arm.per_step("nees"), arm.per_step("squared_error_heading")
        invariant = arm.per_step("nees_invariant")
        whole = [arm.over_steps(f"squared_error_{part}") for part in ("heading", "position")]
        row([estimator(name), "; ".join(ratio(nees, i) for i in k), ratio(invariant, k[-1]),
             "; ".join(root(squares.mean[i], squares.standard_error[i]) for i in k),
             *(root(float(means.mean), float(means.standard_error)) for means in whole),
             f"{np.sqrt(arm.variance_heading[k[-1]]):.4f}", f"{arm.unsettled_updates.sum():.3f}"])


def sweep(files):
    """Heading NEES at the last step under other heading noises. `files` [(sigma, path)]."""
    heading("σ_head", "trials", "estimator", "heading NEES at the last step")
    for sigma, path in files:
        with credence.open(path) as study:
            for arm in study.arms:
                means = arm.per_step("nees_heading")
                row([sigma, f"{arm.counted_trials:,}", estimator(arm.name),
                     with_error(means.mean[-1], means.standard_error[-1])])


def pictures(study, folder):
    """Heading NEES by step; and the heading's error beside what the filter says."""
    credence.plot(study, "nees", group="heading", path=folder / "landmarks.png")
    credence.plot(study, "accuracy", group="heading", arms=["fixed.ekf", "fixed.riekf"],
                  path=folder / "landmarks-accuracy.png")


def main(arguments=None):
    parser = argparse.ArgumentParser(description="Tables and pictures of landmarks on a loop.")
    parser.add_argument("file", metavar="FILE.h5")
    parser.add_argument("-o", "--output", metavar="DIR", help="draw landmarks.png and landmarks-accuracy.png there")
    parser.add_argument("--sweep", metavar="SIGMA=FILE.h5", nargs="*", default=[], help="other heading noises")
    options = parser.parse_args(arguments)
    files = [tuple(one.split("=", 1)) for one in options.sweep]
    try:
        if any(len(pair) != 2 for pair in files):
            raise ValueError("invalid --sweep (must be SIGMA=FILE.h5). Write it so.")
        with credence.open(options.file) as study:
            scenario = next(iter(study.scenarios.values()))
            if scenario.setting("scenario.world") != "explore":
                raise ValueError(f"{options.file} discovers no landmarks. Give a study of landmarks.ini.")
            ratios(scenario, "nees_pose", "pose NEES/3")
            ratios(scenario, "nees_heading", "heading NEES")
            summary(scenario)
            if options.output:
                pictures(study, pathlib.Path(options.output))
        if files:
            sweep(files)
    except (OSError, ValueError) as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
