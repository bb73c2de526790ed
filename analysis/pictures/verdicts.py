"""The verdict by block of the state, from `credence report --format json`: the program's figures, not this script's."""
import json
import pathlib
import shutil
import subprocess

import numpy as np

from . import study, style


SIGNS = {"optimistic": "▲", "pessimistic": "▼", "mixed": "◆"}


class NoReport(Exception):
    """The program is not there, or cannot read the file."""


def find_credence(asked=None):
    """The program: the one asked for, that of this checkout's build, or that on the PATH; None where there is none."""
    if asked:
        return asked
    built = pathlib.Path(__file__).resolve().parents[2] / "build" / "credence"
    return str(built) if built.exists() else shutil.which("credence")


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
                      xerr=np.nan_to_num(np.abs(bounds - mean)), fmt=style.ARM_MARKERS[index % 6],
                      color=style.arm_style(index)["color"], elinewidth=1.1,
                      label=f"{part['arm']}: {part['verdict']}")
    axis.set_xlabel("NEES / dimension, all steps, with 95 % interval")


def _ratios(part):
    return np.array([block["anees"]["ratio"] for block in part["blocks"]], dtype=float)


def _draw_steps(axis, part, reach):
    """NEES/dim by block and step: blue below 1 (pessimistic), red above it (optimistic)."""
    ratios = _ratios(part)
    image = axis.pcolormesh(np.arange(ratios.shape[1] + 1) + 0.5, np.arange(ratios.shape[0] + 1) - 0.5, np.log2(ratios),
                            cmap="RdBu_r", vmin=-reach, vmax=reach, edgecolors="white", linewidth=0.3)
    style.step_axis(axis, np.arange(1, ratios.shape[1] + 1))
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


def blocks(scenario, report):
    """Verdicts by block of the state, over all steps and at each; as wide as a page."""
    parts = [report[scenario.name[1:], arm] for arm in scenario]
    names = [block["block"] for block in parts[0]["blocks"]]
    height = 36 + 8 * max(4, min(len(names), 24))
    figure, axes = style.new_figure(style.PAGE, height, ncols=1 + len(parts), sharey=True,
                                    width_ratios=[1.6] + [1] * len(parts))
    _draw_overall(axes[0], parts)
    style.legend_above(axes[0], columns=1)
    reach = max([0.25] + [np.abs(np.log2(ratios[ratios > 0])).max(initial=0) for ratios in map(_ratios, parts)])
    reach = min(reach, 2)  # a factor of 4 is the darkest
    for axis, part in zip(axes[1:], parts):
        image = _draw_steps(axis, part, reach)
    _colour_bar(figure, image, axes[1:], reach)
    axes[0].set_yticks(range(len(names)), names)
    axes[0].set_ylim(len(names) - 0.5, -0.5)
    study.title(figure, scenario, "; ▼ found pessimistic, ▲ optimistic, ◆ both")
    return figure
