"""Draws the picture of docs/planning.md from the reports that criteria.sh has written.

    PYTHONPATH=python python3 experiments/planning/picture.py results/planning docs/figures/criteria.png
"""

import csv
import sys
from pathlib import Path

from credence.pictures.style import BAND, BLUE, PAGE, PRINT, VERMILION, Picture, logarithmic
from matplotlib import rc_context
from matplotlib.ticker import LogLocator

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


def draw(folder: Path) -> Picture:
    """A row for each controller, so that no mark hides another, and in it both measures on one scale."""
    rows = [(name, "{}-baselines.csv", f"{name}.ekf") for name in BASELINES]
    rows += [(f"greedy, {name}", f"{{}}-{name}.csv", "greedy.ekf") for name in CRITERIA]
    picture = Picture(PAGE, 96)
    grid = picture.add_gridspec(2, len(WORLDS), height_ratios=[1, 14])
    key = picture.add_subplot(grid[0, :])
    key.set_axis_off()
    axes = [picture.add_subplot(grid[1, place]) for place in range(len(WORLDS))]
    for panel, (stem, title) in zip(axes, WORLDS.items()):
        ends = []
        for column, label, mark, colour, aside in (("trace_P", "trace(P)", "o", BLUE, -0.18),
                                                   ("pose_error", "squared pose error", "s", VERMILION, 0.18)):
            found = [interval(folder / f"criteria-{report.format(stem)}", arm, column) for _, report, arm in rows]
            ends += [mean for mean, _ in found]
            panel.errorbar([mean for mean, _ in found], [row + aside for row in range(len(rows))],
                           xerr=[half for _, half in found], color=colour, marker=mark, markersize=4.5, linestyle="",
                           elinewidth=0.8, markerfacecolor=colour if mark == "o" else "white", label=label)
        panel.set(title=title, ylim=(len(rows) - 0.5, -0.5), yticks=range(len(rows)), yticklabels=[])
        logarithmic(panel.xaxis, min(ends) / 1.4, max(ends) * 1.4)
        panel.xaxis.set_major_locator(LogLocator(subs=(1, 3)))
        panel.grid(color=BAND, linewidth=0.5)
        panel.axhline(len(BASELINES) - 0.5, color="black", linewidth=0.5)
    axes[0].set_yticklabels([name for name, _, _ in rows])
    key.legend(*axes[0].get_legend_handles_labels(), loc="center", ncols=2)
    picture.title("Planning by trace(P) buys trace(P), which following the features does nearly as well; planning for "
                  "the pose buys the pose's accuracy and gives up the features",
                  "dm² + rad²; heading model, ranged noise: bash experiments/planning/criteria.sh; means with 95 % "
                  "intervals")
    return picture


if __name__ == "__main__":
    with rc_context(PRINT):
        draw(Path(sys.argv[1])).save(Path(sys.argv[2]))
