"""The verdict by block of the state, from `credence report --format json`: the program's figures, not this script's."""
import json
import pathlib
import shutil
import subprocess

import numpy as np

from . import study, style


MOST_GAPS = 30  # steps with a white gap between them; of more, the gaps would be all that is seen
MOST_ACROSS = 5  # arms side by side
SIGNS = {"optimistic": "▲", "pessimistic": "▼", "mixed": "◆"}


class NoReport(Exception):
    """The program is not there, or cannot read the file."""


def find_credence(asked=None):
    """The program: the one asked for, that of this checkout's build, that which this folder was installed with, or that on
    the PATH; None where there is none."""
    if asked:
        return asked
    above = pathlib.Path(__file__).resolve().parents
    built = [path for path in (above[2] / "build" / "credence", above[4] / "bin" / "credence") if path.is_file()]
    return str(built[0]) if built else shutil.which("credence")


def read_report(credence, path):
    """{(scenario, arm): its part of the report}."""
    try:
        done = subprocess.run([credence, "report", str(path), "--format", "json"], capture_output=True, text=True)
    except OSError as error:
        raise NoReport(str(error)) from None
    if done.returncode != 0:
        raise NoReport(done.stderr.strip())
    return {(part["scenario"], part["arm"]): part for part in json.loads(done.stdout)}


def _called(part, block):
    """What the findings call a block, over all steps or at some: optimistic, pessimistic, mixed or nothing."""
    called = {finding["what"] for finding in part["findings"] if finding["where"] == block}
    called &= {"optimistic", "pessimistic"}
    return "mixed" if len(called) > 1 else next(iter(called), "")


def _draw_overall(axis, parts):
    """NEES/dim over all steps by block, with its 95 % interval, beside the margin."""
    margin = parts[0]["margin"]
    axis.axvspan(1 - margin, 1 + margin, color=style.BAND, linewidth=0,
                 label=f"within the margin of {100 * margin:g} %")
    axis.axvline(1, color=style.GREY, linewidth=0.6)
    for index, part in enumerate(parts):
        blocks = part["blocks"]
        mean = np.array([block["nees_ratio"] for block in blocks], dtype=float)
        bounds = np.array([block["ci95"] for block in blocks], dtype=float).T
        axis.errorbar(mean, np.arange(len(blocks)) + style.aside(index, len(parts)),
                      xerr=np.nan_to_num(np.abs(bounds - mean)), linestyle="none", elinewidth=1.1,
                      label=f"{part['arm']}: {part['verdict']}", **style.arm_mark(index))
    axis.set_xlabel("NEES / dimension,\nall steps, with 95 % interval")


def _ratios(part):
    return np.array([block["anees"]["ratio"] for block in part["blocks"]], dtype=float)


def _draw_steps(axis, part, reach):
    """NEES/dim by block and step: blue below 1 (pessimistic), red above it (optimistic)."""
    ratios = _ratios(part)
    gaps = {"edgecolors": "white", "linewidth": 0.3} if ratios.shape[1] <= MOST_GAPS else {"rasterized": True}
    image = axis.pcolormesh(np.arange(ratios.shape[1] + 1) + 0.5, np.arange(ratios.shape[0] + 1) - 0.5, np.log2(ratios),
                            cmap="RdBu_r", vmin=-reach, vmax=reach, **gaps)
    style.step_axis(axis, np.arange(1, ratios.shape[1] + 1))
    axis.xaxis.get_major_locator().set_params(nbins=3)
    axis.set_title(part["arm"])
    for row, block in enumerate(part["blocks"]):
        if called := _called(part, block["block"]):
            axis.text(1.03, row, SIGNS[called], transform=axis.get_yaxis_transform(), va="center", fontsize=7)
    return image


def _colour_bar(figure, image, axes, reach):
    ticks = [tick for tick in (0.125, 0.25, 0.5, 0.7, 1, 1.4, 2, 4, 8) if abs(np.log2(tick)) <= reach]
    bar = figure.colorbar(image, ax=axes, orientation="horizontal", ticks=np.log2(ticks), aspect=50, shrink=0.8)
    bar.ax.set_xticklabels([f"{tick:g}" for tick in ticks])
    bar.ax.minorticks_off()
    bar.set_label("NEES / dimension: blue is pessimistic, red optimistic")


def _panels(arms, blocks):
    """The figure, its panel over all steps, and one by step for each arm, in rows; every row names the blocks."""
    across = min(arms, MOST_ACROSS)
    rows = -(-arms // across)
    height = max(8, 1.5 * arms) if blocks <= 10 else max(4, min(8, 1.5 * arms))  # of a block
    first = 14 + height * max(4, blocks)
    heights = [first] + [14 + min(height, 5) * max(4, blocks)] * (rows - 1)
    figure = style.plt.figure(figsize=(style.PAGE / 25.4, (22 + sum(heights)) / 25.4))
    grid = figure.add_gridspec(rows, 1 + across, height_ratios=heights, width_ratios=[1.6] + [1] * across)
    overall = figure.add_subplot(grid[0, 0])
    by_step = []
    for arm in range(arms):
        row, column = divmod(arm, across)
        axis = figure.add_subplot(grid[row, 1 + column], sharey=overall)
        axis.tick_params(labelleft=row > 0 and column == 0)
        by_step.append(axis)
    return figure, overall, by_step


def blocks(scenario, report):
    """Verdicts by block of the state, over all steps and at each; as wide as a page."""
    parts = [report[scenario.name[1:], arm] for arm in scenario]
    names = [block["block"] for block in parts[0]["blocks"]]
    figure, overall, by_step = _panels(len(parts), len(names))
    _draw_overall(overall, parts)
    reach = max([0.25] + [np.abs(np.log2(ratios[ratios > 0])).max(initial=0) for ratios in map(_ratios, parts)])
    reach = min(reach, 2)  # a factor of 4 is the darkest
    for axis, part in zip(by_step, parts):
        image = _draw_steps(axis, part, reach)
    _colour_bar(figure, image, by_step, reach)
    overall.set_yticks(range(len(names)), names)
    overall.set_ylim(len(names) - 0.5, -0.5)
    style.legend_below(figure, *overall.get_legend_handles_labels())
    study.title(figure, scenario, "; ▼ found pessimistic, ▲ optimistic, ◆ both")
    return figure
