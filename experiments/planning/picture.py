"""Draws the picture of docs/planning.md from the reports that criteria.sh has written.

    PYTHONPATH=python python3 experiments/planning/picture.py results/planning docs/figures/criteria.png
"""

import csv
import sys
from pathlib import Path

from credence.pictures.style import ARM_COLOURS, ARM_MARKERS, BAND, GREY, PAGE, Picture, PRINT
from matplotlib import rc_context

WORLDS = {"document": "σ_head = 0.001", "0.01": "σ_head = 0.01", "0.1": "σ_head = 0.1", "landmarks": "landmark loop"}
BASELINES = ["fixed", "random", "nearest", "follow"]
CRITERIA = ["trace", "log_det", "max_eigenvalue", "pose_trace", "pose_log_det", "features_trace"]


def interval(report: Path, arm: str, column: str) -> tuple[float, float]:
    """Mean and half-width of its 95 % interval."""
    with open(report) as file:
        for row in csv.reader(file):
            if row[1] == arm and row[4] == column:
                return float(row[6]), (float(row[9]) - float(row[8])) / 2
    raise SystemExit(f"{report} has no {column} of {arm}")


def main(folder: Path, output: Path) -> None:
    picture = Picture(PAGE, 78)
    axes = picture.subplots(1, len(WORLDS), sharex=True, sharey=True)
    for panel, (stem, title) in zip(axes, WORLDS.items()):
        points = [(name, folder / f"criteria-{stem}-baselines.csv", f"{name}.ekf") for name in BASELINES]
        points += [(name, folder / f"criteria-{stem}-{name}.csv", "greedy.ekf") for name in CRITERIA]
        for i, (name, report, arm) in enumerate(points):
            planned = i >= len(BASELINES)
            place = i - len(BASELINES) if planned else i
            colour = ARM_COLOURS[place] if planned else GREY
            (x, x_half), (y, y_half) = interval(report, arm, "trace_P"), interval(report, arm, "pose_error")
            panel.errorbar(x, y, y_half, x_half, color=colour, marker=ARM_MARKERS[place],
                           markersize=5, linestyle="", elinewidth=0.8, markerfacecolor=colour if planned else "none",
                           label=f"greedy, {name}" if planned else name)
        panel.set(xscale="log", yscale="log", title=title, xlabel="trace(P)")
        panel.grid(color=BAND, linewidth=0.5)
    axes[0].set_ylabel("squared pose error")
    handles, labels = axes[0].get_legend_handles_labels()
    picture.legend(handles, labels, loc="outside right center")
    picture.title("Planning by trace(P) buys trace(P), which following the features does nearly as well; planning for "
                  "the pose buys the pose's accuracy and gives up the features",
                  "dm² + rad²; heading model, ranged noise: bash experiments/planning/criteria.sh; means with 95 % "
                  "intervals")
    picture.save(output)


if __name__ == "__main__":
    with rc_context(PRINT):
        main(Path(sys.argv[1]), Path(sys.argv[2]))
