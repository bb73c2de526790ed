"""A single trial under every arm, beside its place among all trials of its study."""

from __future__ import annotations

import os
import tempfile

import numpy as np
from matplotlib.axes import Axes

from ..study import Scenario
from ..trajectory import Trajectory, open_trajectories
from . import program, style, trajectory
from .steps import Arms, source
from .style import Picture
from .trials import draw_distribution, percentile

COLUMNS = ("trace_P", "unseen")
KEYS = 36.0  # millimetres between paths and distributions, for the legends of both


def _grouped(trials: dict[str, Trajectory]) -> list[tuple[list[str], Trajectory]]:
    """Arms that took the same path together."""
    taken: list[tuple[list[str], Trajectory]] = []
    for arm, trial in trials.items():
        for names, other in taken:
            if all(np.array_equal(trial[name], other[name]) for name in ("truth", "mean")):
                names.append(arm)
                break
        else:
            taken.append(([arm], trial))
    return taken


def place(scenario: Scenario, arms: Arms, width: float, *, trial: int = 0, credence: str | None = None) -> Picture:
    """The path of a trial under each arm (above), and where it is among all trials of the study (below)."""
    with tempfile.TemporaryDirectory(prefix="credence-") as folder:
        trials = {}
        for name in arms:
            file = os.path.join(folder, f"{name}.h5")
            program.replay(scenario.group.file.filename, scenario.name, name, trial, file, credence)
            (trials[name],) = open_trajectories(file)
        return _draw(scenario, arms, width, trials)


def _draw(scenario: Scenario, arms: Arms, width: float, trials: dict[str, Trajectory]) -> Picture:
    paths = _grouped(trials)
    wide = scenario.setting("features.path") == "straight"
    rows, across = (len(paths), 1) if wide else (1, len(paths))
    heights = [30.0 if wide else 0.95 * width / across] * rows + [KEYS, 52.0]
    picture = Picture(width, 0)
    grid = picture.add_gridspec(rows + 2, 2, height_ratios=heights)
    axes = [picture.add_subplot(grid[row, :] if across == 1 else grid[row, column])
            for row in range(rows) for column in range(across)]
    for axis, (names, one) in zip(axes, paths, strict=True):
        trajectory.draw_path(axis, one)
        axis.set_title(" and ".join(names))
    _share_limits(axes)
    keys = picture.add_subplot(grid[rows, :])
    keys.set_axis_off()
    keys.legend(*axes[0].get_legend_handles_labels(), loc="upper center", ncols=5, borderaxespad=0).set_in_layout(False)
    runs = {column: {name: one.columns[column] for name, one in trials.items()} for column in COLUMNS}
    for place, column in enumerate(COLUMNS):
        axis = picture.add_subplot(grid[rows + 1, place])
        draw_distribution(axis, scenario, arms, column, width / 2, runs[column])
        if legend := axis.get_legend():
            legend.set_in_layout(False)
    picture.set_figheight((20 + sum(heights)) / 25.4)
    unit = style.pretty(next(iter(arms.values()))[1].describe("trace_P").units)
    said = {name: f"{value:.3g} {unit} ({percentile(arms[name][1]['trace_P'], value):.0f} % of the trials have less)"
            for name, value in runs["trace_P"].items()}
    picture.title("trace(P) at the last pose: " + ", ".join(f"{name} {words}" for name, words in said.items()),
                  f"Above trial {next(iter(trials.values())).trial}, below its place among {source(scenario)}")
    return picture


def _share_limits(axes: list[Axes]) -> None:
    """Gives all of them the same limits."""
    boxes = np.array([[*axis.get_xlim(), *axis.get_ylim()] for axis in axes])
    low, high = boxes.min(axis=0), boxes.max(axis=0)
    for axis in axes:
        axis.set(xlim=(low[0], high[1]), ylim=(low[2], high[3]))
