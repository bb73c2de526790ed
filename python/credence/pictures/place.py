"""A single trial under every arm, beside its place among all trials of its study."""

from __future__ import annotations

import math
import os
import tempfile
import textwrap

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from ..arm import Scenario
from ..study import Study
from ..trajectory import Trajectory, open_trajectories
from . import program, style, trajectory
from .steps import Arms, source
from .style import Picture
from .trials import draw_distribution, percentile

COLUMNS = ("trace_P", "unseen")
LINE = 4.0  # millimetres of a line of a legend
DISTRIBUTION = 46.0  # millimetres of its panel's height
LABELS = 13.0  # millimetres of the ticks and the label of a panel


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
    if Study(scenario.group.file).records:
        raise ValueError("invalid kind=place (it runs a trial again, which no record can). Choose another.")
    with tempfile.TemporaryDirectory(prefix="credence-") as folder:
        trials = {}
        for name in arms:
            file = os.path.join(folder, f"{name}.h5")
            program.replay(scenario.group.file.filename, scenario.name, name, trial, file, credence)
            (trials[name],) = open_trajectories(file)
        return _draw(scenario, arms, width, trials)


def _draw(scenario: Scenario, arms: Arms, width: float, trials: dict[str, Trajectory]) -> Picture:
    picture, page = Picture(width, 0), width >= style.PAGE
    paths = _grouped(trials)
    boxes = np.array([trajectory.extent(one, trajectory.ELLIPSES["95"][0]) for _, one in paths])
    box = np.stack([boxes.min(axis=0), boxes.max(axis=0)])[[0, 1, 0, 1], range(4)]
    across = _across(len(paths), page, trajectory.shape(box))
    rows, keys = -(-len(paths) // across), 2 if page else 4
    titles = [textwrap.wrap(" and ".join(names), int(width / across / 1.7)) for names, _ in paths]
    heights = [rows * (LABELS + LINE * max(map(len, titles)) + (width / across - LABELS) / trajectory.shape(box)),
               keys * LINE,
               (1 if page else 2) * (LABELS + DISTRIBUTION + LINE * (len(arms) + len(scenario.published("trace_P"))))]
    above, between, below = picture.subfigures(3, 1, squeeze=False, height_ratios=heights)[:, 0]
    axes = above.subplots(rows, across, squeeze=False).ravel()
    for axis, (_, one), title in zip(axes, paths, titles, strict=False):
        trajectory.draw_path(axis, one)
        trajectory.show(axis, one, box)
        axis.set_title("\n".join(title))
        axis.xaxis.set_major_locator(MaxNLocator(nbins=max(4, int(width / across / 12))))
    for axis in axes[len(paths):]:
        axis.remove()
    drawn, labels = axes[0].get_legend_handles_labels()
    grey = Line2D([], [], color=style.GREY, linestyle="--", marker="+")  # each path has the colour of its arm
    handles = [grey if label == "estimated path" else one for one, label in zip(drawn, labels, strict=True)]
    legend = between.subplots()
    legend.set_axis_off()
    legend.legend(handles, labels, loc="center", ncols=-(-len(labels) // keys), borderaxespad=0).set_in_layout(False)
    runs = {column: {name: one.columns[column] for name, one in trials.items()} for column in COLUMNS}
    for column, axis in zip(COLUMNS, below.subplots(*((1, 2) if page else (2, 1))), strict=True):
        _, entries = draw_distribution(axis, scenario, arms, column, runs[column])
        axis.legend(*zip(*entries, strict=True), loc="lower left", bbox_to_anchor=(-0.01, 1.0), borderaxespad=0.2)
    unit = style.pretty(next(iter(arms.values()))[1].describe("trace_P").units)
    found = {name: (value, percentile(arms[name][1]["trace_P"], value)) for name, value in runs["trace_P"].items()}
    picture.title("trace(P) at the last pose: "
                  + style.ranked(found, lambda of: f"{of[0]:.3g} {unit} ({of[1]:.0f} % of the trials have less)"),
                  f"Above trial {next(iter(trials.values())).trial}, below its place among {source(scenario)}")
    lines = sum(text.get_text().count("\n") + 1 for text in picture.texts)
    picture.set_figheight((8 + LINE * lines + sum(heights)) / 25.4)
    return picture


def _across(count: int, page: bool, ratio: float) -> int:
    """How many paths are beside one another: those that are wide as roads lie below each other."""
    if ratio > 1.6:
        return 1
    return min(count, 3 if count == 3 else math.ceil(math.sqrt(count))) if page and count > 2 else min(count, 2)
