"""What all pictures share: sizes of print, arms that are told apart up to twelve, titles that say a message, units,
thinned curves, and files that come out the same each time."""

from __future__ import annotations

import io
import itertools
import os
import re
import textwrap
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import matplotlib
import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, MaxNLocator, NullFormatter, NullLocator
from PIL import Image

from .. import _doors as doors
from .._file import FloatArray
from .._outputs import whole

COLUMN, PAGE = 85.0, 175.0  # widths in millimetres: one column of a paper, and the whole page
BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY = "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"
GREY, BAND = "#6E6E6E", "#DDDDDD"
ARM_COLOURS = [BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY]  # [Okabe and Ito 2008]
ARM_LINES: list[Any] = ["-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (1, 1))]
ARM_MARKERS = ["o", "s", "^", "D", "v", "P"]
POWERS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
NO_BREAK = "\N{NO-BREAK SPACE}"
COLOURS = 128  # of a .png
MOST_POINTS = 2000  # of a curve; more are not seen in print, and make files large
PRINT: dict[Any, Any] = {
    "font.family": "DejaVu Sans", "font.size": 8, "axes.labelsize": 8, "axes.titlesize": 8, "legend.fontsize": 7.5,
    "xtick.labelsize": 7.5, "ytick.labelsize": 7.5, "axes.titlelocation": "left", "axes.linewidth": 0.6,
    "lines.linewidth": 1.1, "lines.markersize": 3.2, "axes.spines.top": False, "axes.spines.right": False,
    "xtick.major.width": 0.6, "ytick.major.width": 0.6, "legend.frameon": False, "legend.handlelength": 2.6,
    "pdf.fonttype": 42, "svg.hashsalt": "credence", "axes.axisbelow": True, "savefig.dpi": 160, "figure.dpi": 100,
}


class Picture(Figure):
    """A matplotlib figure with one message as its title. A notebook shows it as it is; `save` writes it."""

    def __init__(self, width: float, height: float) -> None:
        super().__init__(figsize=(width / 25.4, max(height, 1) / 25.4), layout="constrained")
        FigureCanvasAgg(self)

    def title(self, message: str, source: str) -> None:
        """The message in bold, and below the picture what it is drawn from."""
        letters = self.get_figwidth() * 25.4
        together = re.sub(r"\([^()]{,16}\)", lambda short: short[0].replace(" ", NO_BREAK), message)
        # Neither between a number and its unit, nor before the last word.
        together = re.sub(r"(?<=\d) (?=[^\s\d(]{1,4}(?:[\s,;)]|$))| (?=\S+$)", NO_BREAK, together)
        lines = textwrap.fill(together, int(letters / 1.85)).replace(NO_BREAK, " ")
        self.suptitle(lines, x=0.01, ha="left", fontsize=8.5, fontweight="bold")
        self.supxlabel(textwrap.fill(source, int(letters / 1.5)), x=0.01, ha="left", fontsize=7, color=GREY)

    def leave_title_out(self) -> None:
        """Removes the message and the line below the picture, for a page that says both in its caption."""
        for text in list(self.texts):
            text.remove()
        self._suptitle = self._supxlabel = None

    def fit_labels(self) -> None:
        """Breaks the labels that are longer than their panel."""
        self.draw_without_rendering()
        for axes in self.axes:
            for label, room, across in ((axes.xaxis.label, axes.bbox.width, True),
                                        (axes.yaxis.label, axes.bbox.height, False)):
                extent, text = label.get_window_extent(), label.get_text()
                length = extent.width if across else extent.height
                if length > room and "\n" not in text:
                    label.set_text(textwrap.fill(text, int(len(text) * room / length)))

    def draw(self, renderer: Any) -> None:
        with matplotlib.rc_context(PRINT):
            super().draw(renderer)

    @doors.door(path=doors.output)
    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes a .pdf, .svg or .png, the same bytes each time; a .png with 128 colours, which make it small."""
        ending = os.path.splitext(path)[1].lower()
        with whole(path) as part:
            if ending == ".png":
                with Image.open(io.BytesIO(self._repr_png_())) as picture:
                    small = picture.convert("RGB").quantize(COLOURS, Image.Quantize.FASTOCTREE)
                    small.save(part, optimize=True, dpi=picture.info["dpi"])
                return
            date = {".pdf": {"CreationDate": None}, ".svg": {"Date": None}}.get(ending)
            with matplotlib.rc_context(PRINT):
                self.savefig(part, metadata=date)

    def _repr_png_(self) -> bytes:
        picture = io.BytesIO()
        with matplotlib.rc_context(PRINT):
            self.savefig(picture, format="png", metadata={"Software": None})
        return picture.getvalue()


def one_panel(width: float, height: float = 82) -> tuple[Picture, Axes]:
    """A picture with one panel, of millimetres."""
    picture = Picture(width, height)
    return picture, picture.add_subplot()


def thinned(*curves: npt.ArrayLike, most: int = MOST_POINTS) -> npt.NDArray[np.intp]:
    """Which points of long curves to draw, rising: the first, the last, and of each of many equal stretches the lowest
    and the highest of each curve. So at most `most` points are drawn and no extreme is lost."""
    values = [np.asarray(curve, np.float64) for curve in curves]
    size = values[0].size
    if size <= most:
        return np.arange(size)
    edges = np.linspace(0, size, max(1, (most - 2) // (2 * len(values))) + 1).astype(int)
    kept = {0, size - 1}
    for low, high in itertools.pairwise(edges):
        for curve in values:
            stretch = curve[low:high]
            if not np.isnan(stretch).all():
                kept |= {low + int(np.nanargmin(stretch)), low + int(np.nanargmax(stretch))}
    return np.array(sorted(kept), dtype=np.intp)


def _shifted(index: int) -> int:
    """The place of an arm's dashes and mark: the second six arms have the colours of the first with others."""
    return (index + 3 * (index // len(ARM_COLOURS))) % len(ARM_COLOURS)


def arm_style(index: int, count: int = 1) -> dict[str, Any]:
    """How the line of the arm of that place among `count` is drawn in every picture. Twelve differ. Later ones are
    thinner, so that lines which coincide are all seen."""
    thicker = min(0.4, 1.2 / count) * (count - 1 - index) if count > 2 else 0
    return {"color": ARM_COLOURS[index % len(ARM_COLOURS)], "linestyle": ARM_LINES[_shifted(index)],
            "linewidth": PRINT["lines.linewidth"] + max(0, thicker)}


def arm_mark(index: int) -> dict[str, Any]:
    """How the marks of that arm are drawn in every picture: hollow those of the second six."""
    colour = ARM_COLOURS[index % len(ARM_COLOURS)]
    hollow = index // len(ARM_COLOURS) % 2 == 1
    return {"marker": ARM_MARKERS[_shifted(index)], "color": colour, "markerfacecolor": "white" if hollow else colour}


def arm_line(index: int, count: int, points: int) -> dict[str, Any]:
    """A line with about fifteen marks, each arm's at points of its own where there are more than two arms."""
    every = max(count if count > 2 else 1, points // 15)
    thin = {"linewidth": 0.8} if points > 200 else {}
    at = index * every // max(count, 1) % every
    return arm_style(index, count) | arm_mark(index) | thin | {"markevery": (at, every)}


def interval(axis: Axes, x: FloatArray, mean: FloatArray, low: FloatArray, high: FloatArray, line: dict[str, Any],
             count: int) -> None:
    """The interval of one of so many arms: a shade, or of many arms, whose shades would hide one another, bars at the
    arm's marks."""
    if count <= 4:
        axis.fill_between(x, low, high, color=line["color"], alpha=0.25, linewidth=0)
        return
    first, every = line["markevery"]
    at = slice(first, None, every)
    axis.errorbar(x[at], mean[at], yerr=np.abs([mean[at] - low[at], high[at] - mean[at]]), linestyle="none",
                  ecolor=line["color"], elinewidth=0.8)


def curve(axis: Axes, x: FloatArray, mean: FloatArray, ends: Sequence[FloatArray], place: int,
          count: int) -> dict[str, Any]:
    """The line of the arm of a place among `count`, and its interval; how the line is drawn."""
    low, high = ends
    shown = thinned(mean, low, high)
    line = arm_line(place, count, shown.size)
    interval(axis, x[shown], mean[shown], low[shown], high[shown], line, count)
    axis.plot(x[shown], mean[shown], **line)
    return line


def ranked(values: Mapping[str, Any], say: Callable[[Any], str]) -> str:
    """The part of a message that names the arms: all of them up to three, else the lowest and the highest."""
    if len(values) <= 3:
        return ", ".join(f"{name} {say(value)}" for name, value in values.items())
    names = sorted(values, key=lambda name: values[name])
    return f"from {names[0]} {say(values[names[0]])} to {names[-1]} {say(values[names[-1]])}"


def pretty(unit: str) -> str:
    """A unit as people write it: dm^2 + rad^2 becomes dm² + rad²; nothing for `1`."""
    return "" if unit == "1" else unit.replace("^2", "²")


def in_brackets(unit: str) -> str:
    """`` [dm²]``; nothing for `1`."""
    return f" [{pretty(unit)}]" if pretty(unit) else ""


def root_of(unit: str) -> str:
    """The unit of a root: dm of dm^2."""
    return unit.removesuffix("^2") if unit.count("^2") == 1 and unit.endswith("^2") else f"√({pretty(unit)})"


def with_half_width(mean: float, half: float) -> str:
    """`0.263 ± 0.023`: as many digits as two of the half-width need; small ones as `(2.63 ± 0.23)·10⁻⁴`."""
    power = int(np.floor(np.log10(max(abs(mean), half)))) if half > 0 else 0
    scale = power if power < -2 else 0
    digits = max(0, 1 - int(np.floor(np.log10(half))) + scale) if half > 0 else 4
    value = f"{mean / 10.0**scale:.{digits}f} ± {half / 10.0**scale:.{digits}f}".replace("-", "\N{MINUS SIGN}")
    return f"({value})·10{str(scale).translate(POWERS)}" if scale else value


def step_axis(axis: Axes, steps: npt.ArrayLike, label: str = "step") -> None:
    """Whole numbers from the first to the last step."""
    first, last = np.asarray(steps)[[0, -1]]
    axis.set(xlabel=label, xlim=(first - 0.5, last + 0.5))
    axis.xaxis.set_major_locator(MaxNLocator(integer=True, nbins=10))


def logarithmic(axis: Any, low: float, high: float) -> None:
    """Makes an x or y axis logarithmic, with numbers as people write them: 0.1, 0.2, 0.5, 1."""
    getattr(axis.axes, f"set_{axis.axis_name}scale")("log")
    axis.axes.set(**{f"{axis.axis_name}lim": (low, high)})
    axis.set_major_locator(LogLocator(subs=(1, 2, 5) if high < 200 * low else (1,)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def spread_out(axis: Any, values: Sequence[npt.ArrayLike]) -> None:
    """A logarithmic axis where the lowest of these could not be told from 0 on another."""
    found = np.concatenate([np.ravel(np.asarray(one, np.float64)) for one in values])
    found = found[np.isfinite(found)]
    if found.size and 0 < 20 * found.min() < found.max():
        logarithmic(axis, found.min() / 1.1, found.max() * 1.1)


def root_axis(axis: Axes, scale: float, reach: float) -> None:
    """Makes an x axis linear about 0, up to `scale`, and logarithmic beyond: for differences with heavy tails."""
    axis.set_xscale("symlog", linthresh=scale, linscale=0.6)
    axis.set_xlim(-1.3 * reach, 1.3 * reach)
    powers = 10.0 ** np.arange(np.ceil(np.log10(scale)), np.floor(np.log10(1.3 * reach)) + 1)
    powers = powers[::max(1, int(np.ceil(len(powers) / 3)))]
    axis.xaxis.set_major_locator(FixedLocator([*-powers[::-1], 0, *powers]))
    axis.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}".replace("-", "\N{MINUS SIGN}")))
    axis.xaxis.set_minor_locator(NullLocator())


def aside(index: int, count: int) -> float:
    """How far beside its place an arm is drawn, so that arms do not hide one another."""
    return (index - (count - 1) / 2) * (0.25 if count <= 2 else 0.8 / count)


def key(axis: Axes, entries: Sequence[tuple[Any, str]], width: float, beside_panel: bool = True) -> None:
    """A legend where it hides nothing: above the panel, by which the picture grows; on a page beside it where there are
    many short entries."""
    if not entries:
        return
    handles, labels = zip(*entries, strict=True)
    longest = 9 + 1.4 * max(map(len, labels))
    if beside_panel and len(labels) > 4 and longest < 45 and width >= PAGE:
        beside(axis, entries)
        return
    columns = max(1, min(len(labels), int((width - 12) / longest)))
    rows = -(-len(labels) // columns)
    picture = axis.figure
    assert isinstance(picture, Figure)
    picture.set_figheight(picture.get_figheight() + 4 * (rows - 1) / 25.4)
    axis.legend(handles, labels, loc="lower left", bbox_to_anchor=(-0.01, 1.0), ncols=columns, borderaxespad=0.2,
                columnspacing=1.4)


def beside(axis: Axes, entries: Sequence[tuple[Any, str]]) -> None:
    """A legend on the right of the panel."""
    handles, labels = zip(*entries, strict=True)
    axis.legend(handles, labels, loc="center left", bbox_to_anchor=(1.01, 0.5), borderaxespad=0)


def arm_entries(places: Mapping[str, int], **drawn: Any) -> list[tuple[Any, str]]:
    """Line and mark of each arm, of that place in its scenario; `drawn` is what the picture draws otherwise."""
    return [(Line2D([], [], **arm_style(place, len(places)) | arm_mark(place) | drawn), arm)
            for arm, place in places.items()]


def band_entry(label: str) -> tuple[Any, str]:
    """The grey band."""
    return matplotlib.patches.Patch(color=BAND), label


def finite(values: npt.ArrayLike) -> FloatArray:
    """Those that are not NaN, rising."""
    found: FloatArray = np.sort(np.asarray(values, np.float64))
    return found[~np.isnan(found)]
