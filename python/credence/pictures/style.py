"""What all pictures share: print sizes, colours that colour-blind readers tell apart, units, and files that come out
the same each time."""
import pathlib
import textwrap

import matplotlib
import numpy as np
from PIL import Image

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

COLUMN, PAGE = 85, 175  # widths in millimetres: one column of a paper, and the whole page
BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY = "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"
GREY, BAND = "#6E6E6E", "#D9D9D9"
ARM_COLOURS = [BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY]  # [Okabe and Ito 2008]
ARM_LINES = ["-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (1, 1))]
ARM_MARKERS = ["o", "s", "^", "D", "v", "P"]
POWERS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")

plt.rcParams.update({
    "font.family": "DejaVu Sans", "font.size": 8, "axes.labelsize": 8, "axes.titlesize": 8, "legend.fontsize": 7.5,
    "xtick.labelsize": 7.5, "ytick.labelsize": 7.5, "axes.titlelocation": "left", "axes.linewidth": 0.6,
    "lines.linewidth": 1.1, "lines.markersize": 3.2, "axes.spines.top": False, "axes.spines.right": False,
    "xtick.major.width": 0.6, "ytick.major.width": 0.6, "legend.frameon": False, "legend.handlelength": 2.2,
    "pdf.fonttype": 42, "svg.hashsalt": "credence", "figure.constrained_layout.use": True, "axes.axisbelow": True,
})


def new_figure(width, height, **subplots):
    """A figure of millimetres, with its axes."""
    return plt.subplots(figsize=(width / 25.4, height / 25.4), **subplots)


def panels(count, height, width):
    """A figure with that many panels: side by side on a page, one below the other in a column."""
    if width >= PAGE:
        return new_figure(width, height, ncols=count)
    return new_figure(width, 12 + 0.82 * height * count, nrows=count)


def headline(figure, words):
    """A line above the panels, or two where the figure is narrow."""
    letters = int(figure.get_figwidth() * 25.4 / 1.5)  # a letter of 8 points takes about 1.5 mm
    figure.suptitle(textwrap.fill(words, letters), x=0.01, ha="left", fontsize=8)


def _shifted(index):
    """The place of an arm's dashes and mark: the second six arms have the colours of the first with other dashes and
    marks."""
    return (index + 3 * (index // len(ARM_COLOURS))) % len(ARM_COLOURS)


def arm_style(index, count=1):
    """How the line of the arm of that place among `count` is drawn in every picture. Twelve arms differ. Later ones are
    thinner, so that lines which coincide are all seen."""
    thicker = min(0.4, 1.2 / count) * (count - 1 - index) if count > 2 else 0
    return {"color": ARM_COLOURS[index % len(ARM_COLOURS)], "linestyle": ARM_LINES[_shifted(index)],
            "linewidth": plt.rcParams["lines.linewidth"] + max(0, thicker)}


def arm_mark(index):
    """How the marks of the arm of that place in its scenario are drawn in every picture: hollow those of the second six."""
    colour = ARM_COLOURS[index % len(ARM_COLOURS)]
    hollow = index // len(ARM_COLOURS) % 2 == 1
    return {"marker": ARM_MARKERS[_shifted(index)], "color": colour, "markerfacecolor": "white" if hollow else colour}


def arm_line(index, count, points):
    """A line with marks: about twenty, where there are more points than that, each arm's at points of its own where there
    are more than two arms."""
    every = max(count if count > 2 else 1, points // 20)
    return arm_style(index, count) | arm_mark(index) | {"markevery": (index * every // max(count, 1) % every, every)}


def unit_text(unit):
    """A unit as people write it: dm^2 + rad^2 becomes dm² + rad²; nothing for `1`."""
    return "" if unit == "1" else f" [{unit.replace('^2', '²')}]"


def with_half_width(mean, half):
    """`0.263 ± 0.023`: as many digits as two of the half-width need; small ones as `(2.63 ± 0.23)·10⁻⁴`."""
    power = int(np.floor(np.log10(max(abs(mean), half)))) if half > 0 else 0
    scale = power if power < -2 else 0
    digits = max(0, 1 - int(np.floor(np.log10(half))) + scale) if half > 0 else 4
    value = f"{mean / 10.0**scale:.{digits}f} ± {half / 10.0**scale:.{digits}f}".replace("-", "\N{MINUS SIGN}")
    return f"({value})·10{str(scale).translate(POWERS)}" if scale else value


def step_axis(axis, steps, label="step"):
    axis.set_xlabel(label)
    axis.set_xlim(steps[0] - 0.5, steps[-1] + 0.5)
    axis.xaxis.set_major_locator(matplotlib.ticker.MaxNLocator(integer=True, nbins=8))


def logarithmic(axis, low, high):
    """Makes an x or y axis logarithmic, with numbers as people write them: 0.1, 0.2, 0.5, 1."""
    getattr(axis.axes, f"set_{axis.axis_name}scale")("log")
    axis.axes.set(**{f"{axis.axis_name}lim": (low, high)})
    axis.set_major_locator(matplotlib.ticker.LogLocator(subs=(1, 2, 5) if high < 200 * low else (1,)))
    axis.set_major_formatter(matplotlib.ticker.FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(matplotlib.ticker.NullFormatter())


def root_axis(axis, scale, reach):
    """Makes an x axis linear about 0, up to `scale`, and logarithmic beyond: for differences with heavy tails."""
    axis.set_xscale("symlog", linthresh=scale, linscale=0.6)
    axis.set_xlim(-1.3 * reach, 1.3 * reach)
    powers = 10.0 ** np.arange(np.ceil(np.log10(scale)), np.floor(np.log10(1.3 * reach)) + 1)
    powers = powers[::max(1, int(np.ceil(len(powers) / 3)))]
    axis.xaxis.set_major_locator(matplotlib.ticker.FixedLocator([*-powers[::-1], 0, *powers]))
    axis.xaxis.set_major_formatter(matplotlib.ticker.FuncFormatter(lambda value, _: f"{value:g}"))
    axis.xaxis.set_minor_locator(matplotlib.ticker.NullLocator())


def aside(index, count):
    """How far beside its place the arm is drawn, so that arms do not hide one another."""
    return (index - (count - 1) / 2) * (0.5 / 2 if count <= 2 else 0.8 / count)


def legend_above(axis, columns=2, **entries):
    """A legend above the axes, where it hides nothing; None where nothing has a label."""
    if not entries.get("handles") and not axis.get_legend_handles_labels()[0]:
        return None
    return axis.legend(loc="lower left", bbox_to_anchor=(-0.02, 1.0), ncols=columns, borderaxespad=0.2,
                       columnspacing=1.2, **entries)


def legend_below(figure, handles, labels):
    """A legend of the whole figure in a strip below its panels, by which the figure grows."""
    width, height = figure.get_size_inches() * 25.4
    columns = max(1, min(len(labels), int(width / (14 + 1.5 * max(map(len, labels))))))
    strip = 2 + 4.2 * -(-len(labels) // columns)
    figure.set_figheight((height + strip) / 25.4)
    figure.get_layout_engine().set(rect=(0, strip / (height + strip), 1, height / (height + strip)))
    figure.legend(handles, labels, loc="lower left", ncols=columns, borderaxespad=0.3, columnspacing=1.4)


def arms_below(figure, arms):
    """The legend of the arms: line and mark of each."""
    keys = [plt.Line2D([], [], **arm_style(index) | arm_mark(index)) for index in range(len(arms))]
    legend_below(figure, keys, list(arms))


def legend_right(axis):
    axis.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), borderaxespad=0.4)


def save_png(figure, folder, stem, dots_per_inch=200, colours=None):
    """Writes a PNG, the same bytes each time; with that many colours only, to make it small."""
    path = pathlib.Path(folder) / f"{stem}.png"
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=dots_per_inch, metadata={"Software": None})
    plt.close(figure)
    if colours:
        with Image.open(path) as picture:
            small = picture.convert("RGB").quantize(colours, Image.Quantize.FASTOCTREE)
        small.save(path, optimize=True)
    return path


def save(figure, folder, stem, vector="pdf"):
    """Writes the picture as vector and as PNG, without the date, and returns the paths."""
    path = pathlib.Path(folder) / f"{stem}.{vector}"
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, metadata={"pdf": {"CreationDate": None}, "svg": {"Date": None}}[vector])
    return [path, save_png(figure, folder, stem)]
