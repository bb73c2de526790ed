"""Pictures of the verdict: by component group over all steps, and of one arm by group and step. All numbers are those
of the program's report."""

from __future__ import annotations

import collections
import itertools
from typing import Any

import numpy as np

from .._file import FloatArray
from ..arm import Arm, Scenario
from ..study import Study
from . import program, style
from .steps import Arms, source
from .style import Picture

GAPS_UP_TO = 30  # steps with a white gap between them; of more, the gaps would be all that is seen
REACH = np.log2(1.25), 2.0  # the least and the largest log2 of the ratio with the darkest colour: factors of 1.25 and 4
TICKS = (1, 2, 0.5, 4, 0.25, 1.4, 0.7, 1.2, 0.85, 1.1, 0.9, 1.25, 0.8)  # the sooner, the rather it is labelled


def _report(scenario: Scenario, arms: Arms, credence: str | None) -> dict[str, dict[str, Any]]:
    study = Study(scenario.group.file)
    found = program.report(study.path, credence, study.records)
    return {name: found[scenario.name, name] for name in arms}


def _verdicts(parts: dict[str, dict[str, Any]]) -> str:
    """`fixed.ekf mixed, greedy.ekf consistent`; of more than three, the number of each verdict."""
    said = {name: part["verdict"] for name, part in parts.items()}
    if len(said) <= 3:
        return ", ".join(f"{name} {verdict}" for name, verdict in said.items())
    counts = collections.Counter(said.values()).most_common()
    if len(counts) == 1:
        return f"All {len(said)} arms are {counts[0][0]}"
    return f"Of {len(said)} arms " + ", ".join(f"{count} {verdict}" for verdict, count in counts)


def verdicts(scenario: Scenario, arms: Arms, width: float, *, credence: str | None = None) -> Picture:
    """NEES / dimension of every component group over all steps, with its 95 % interval, beside the margin."""
    parts = _report(scenario, arms, credence)
    groups = [group["group"] for group in next(iter(parts.values()))["groups"]]
    picture, axis = style.one_panel(width, min(220, 36 + len(groups) * max(6, 1.8 * len(parts))))
    margin, drawn = next(iter(parts.values()))["margin"], []
    axis.axvspan(1 - margin, 1 + margin, color=style.BAND, linewidth=0)
    axis.axvline(1, color=style.GREY, linewidth=0.6)
    entries = []
    for index, (name, part) in enumerate(parts.items()):
        mean = np.array([group["nees_ratio"] for group in part["groups"]], dtype=float)
        ends = np.array([group["ci95"] for group in part["groups"]], dtype=float).T
        bar = axis.errorbar(mean, np.arange(len(groups)) + style.aside(index, len(parts)), linestyle="none",
                            xerr=np.nan_to_num(np.abs(ends - mean)), elinewidth=1.1, **style.arm_mark(arms[name][0]))
        entries.append((bar, f"{name}: {part['verdict']}"))
        drawn.append(ends)
    for row in range(1, len(groups)):
        axis.axhline(row - 0.5, color=style.BAND, linewidth=0.5, zorder=0)
    style.spread_out(axis.xaxis, drawn)
    axis.set_yticks(range(len(groups)), groups)
    axis.set(ylim=(len(groups) - 0.5, -0.5), ylabel="component group" if len(groups) > 1 else "group",
             xlabel="NEES / dimension, mean over trials and steps")
    style.key(axis, [*entries, style.band_entry(f"within the margin of {100 * margin:g} %")], width)
    picture.title(_verdicts(parts), f"{source(scenario)}; bars: 95 % intervals")
    return picture


def ratio_map(scenario: Scenario, arms: Arms, width: float, *, arm: str | None = None,
              credence: str | None = None) -> Picture:
    """NEES / dimension of one arm by component group and step: blue is pessimistic, red and hatched optimistic."""
    name = arm or next(iter(arms))
    part = _report(scenario, {name: arms[name]}, credence)[name]
    groups = [group["group"] for group in part["groups"]]
    ratios = np.array([group["anees"]["ratio"] for group in part["groups"]], dtype=float)
    logs = np.log2(np.where(ratios > 0, ratios, np.nan))
    picture, axis = style.one_panel(width, 40 + 6.5 * len(groups))
    reach = float(np.clip(np.nanmax(np.abs(logs)), *REACH))
    _cells(picture, axis, _thinned_columns(logs), arms[name][1], reach)
    axis.set_yticks(range(len(groups)), groups)
    axis.set(ylim=(len(groups) - 0.5, -0.5), ylabel="component group" if len(groups) > 1 else "group")
    row, column = np.unravel_index(np.nanargmax(np.abs(logs)), logs.shape)
    picture.title(f"{name} is {part['verdict']}: NEES / dimension is farthest from 1 with {ratios[row, column]:.2f}, "
                  f"of {groups[row]} at step {int(arms[name][1]['step'][column])}", source(scenario))
    return picture


def _ticks(reach: float, height: float) -> list[float]:
    """The labelled levels of a colour bar of so many millimetres: those that have room for their text."""
    kept: list[float] = []
    for tick in TICKS:
        level = np.log2(tick)
        if abs(level) <= 1.001 * reach and all(abs(level - np.log2(other)) > 8 * reach / height for other in kept):
            kept.append(tick)
    return sorted(kept)


def _thinned_columns(logs: FloatArray) -> FloatArray:
    """At most some thousand columns: of each stretch of steps the value farthest from 0."""
    steps = logs.shape[1]
    if steps <= style.MOST_POINTS:
        return logs
    edges = np.linspace(0, steps, style.MOST_POINTS + 1).astype(int)
    stretches = [logs[:, low:high] for low, high in itertools.pairwise(edges)]
    return np.stack([np.take_along_axis(one, np.abs(np.nan_to_num(one)).argmax(1)[:, None], 1)[:, 0]
                     for one in stretches], axis=1)


def _cells(picture: Picture, axis: Any, logs: FloatArray, arm: Arm, reach: float) -> None:
    """The map with its bar of labelled levels."""
    steps, rows = arm["step"], logs.shape[0]
    edges = np.linspace(steps[0] - 0.5, steps[-1] + 0.5, logs.shape[1] + 1)
    gaps: dict[str, Any] = {"rasterized": True}
    if logs.shape[1] <= GAPS_UP_TO:
        gaps = {"edgecolors": "white", "linewidth": 0.3}
    image = axis.pcolormesh(edges, np.arange(rows + 1) - 0.5, logs, cmap="RdBu_r", vmin=-reach, vmax=reach, **gaps)
    optimistic = np.ma.masked_where(~(logs > np.log2(1.05)), logs)  # hatched, because red and blue print alike in grey
    axis.pcolor(edges, np.arange(rows + 1) - 0.5, optimistic, alpha=0, hatch="/////", rasterized=True)
    style.step_axis(axis, steps)
    ticks = _ticks(reach, 12 + 6.5 * rows)
    bar = picture.colorbar(image, ax=axis, ticks=np.log2(ticks), extend="both", aspect=18, pad=0.02)
    bar.ax.set_yticklabels([f"{tick:g}" for tick in ticks])
    bar.ax.minorticks_off()
    bar.set_label("NEES / dimension\n(red, hatched: optimistic)")
