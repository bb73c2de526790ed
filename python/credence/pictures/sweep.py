"""Curves with bands along a swept key, of one grid of a results file."""
import numpy as np

import credence_results as results

from . import style, study

MOST_PANELS = 4  # a row of panels by the other keys; more would not be legible on a page


def _evenly_by_ratio(values):
    """Whether values look evenly spaced on a logarithmic axis: their ratios vary less than their differences."""
    values = np.sort(values)
    if values.size < 3 or values[0] <= 0:
        return False
    by_difference, by_ratio = np.diff(values), np.diff(np.log(values))
    return by_ratio.std() / by_ratio.mean() < by_difference.std() / by_difference.mean()


def curve_key(grid):
    """The key that curves run along: the first that has numbers, or the first."""
    for key, values in grid.coordinates.items():
        if values.dtype.kind == "f":
            return key
    return next(iter(grid.coordinates))


def slices(grid):
    """(title, names along the curve's key) for everything that the other keys have."""
    keys = list(grid.coordinates)
    along = keys.index(curve_key(grid))
    names = np.moveaxis(grid.names, along, -1)
    others = keys[:along] + keys[along + 1:]
    for place in np.ndindex(names.shape[:-1]):
        texts = [f"{key}={_short(grid.coordinates[key][at])}" for key, at in zip(others, place)]
        yield ", ".join(texts), names[place]


def _short(value):
    return value if isinstance(value, str) else f"{value:g}"


def _draw(axis, x, curves, numbers):
    """`curves` {name: [mean, low, high] along x}: lines with bands over numbers, else marks with whiskers."""
    for index, (name, values) in enumerate(curves.items()):
        line, marker = style.arm_line(index, len(curves), x.size), style.arm_mark(index)
        mean, low, high = values.T
        if numbers and x.size > 1:
            axis.fill_between(x, low, high, color=line["color"], alpha=0.25, linewidth=0)
            axis.plot(x, mean, label=name, **line)
        else:
            axis.errorbar(x + style.aside(index, len(curves)) * (not numbers), mean, yerr=np.abs([mean - low, high - mean]),
                          linestyle="none", elinewidth=1.1, label=name, **marker)


def _x_axis(axis, grid):
    key = curve_key(grid)
    values = grid.coordinates[key]
    axis.set_xlabel(key)
    if values.dtype.kind != "f":
        axis.set_xticks(range(values.size), [str(value)[:14] for value in values])
        axis.set_xlim(-0.5, values.size - 0.5)
    elif _evenly_by_ratio(values):
        style.logarithmic(axis.xaxis, values.min() / 1.1, values.max() * 1.1)


def _spread_out(axis, values):
    """A logarithmic scale where the smallest of these could not be told from 0 on another."""
    low, high = np.nanmin(values), np.nanmax(values)
    if low > 0 and high > 20 * low:
        style.logarithmic(axis.yaxis, low / 1.1, high * 1.1)


def _rows(scenario):
    """What is drawn: (label, reference, {curve: figure of a scenario}) from the top down."""
    arms = list(scenario)
    unit = style.unit_text(results.units(scenario[arms[0]], "trace_P"))

    def of_arm(name):
        return {arm: lambda group, arm=arm: _mean(group, name, arm) for arm in arms}

    def of_pair(planned, fixed):
        return lambda group: _mean(group, "trace_P", planned, fixed)

    rows = [("NEES / state dimension", 1, of_arm("nees_ratio")), ("trace(P), last pose" + unit, None, of_arm("trace_P"))]
    if pairs := study.pairs(scenario):
        rows.append(("difference of trace(P)" + unit, 0, {f"{planned} \N{MINUS SIGN} {fixed}": of_pair(planned, fixed)
                                                          for planned, fixed in pairs}))
    return rows


def _mean(group, name, *arms):
    """[mean, low, high] of an arm's figure, or of its differences to a second arm; None where one of them is not there."""
    there = all(arm in group for arm in arms)
    return results.mean_with_interval(group[arms[0]], name, *(group[arm] for arm in arms[1:])) if there else None


def curves(file, grid, width=style.PAGE):
    """NEES, trace(P) and planned - fixed along a swept key, with 95 % intervals; a column of panels for what the other
    keys have, the first of them where there are many."""
    key = curve_key(grid)
    numbers = grid.coordinates[key].dtype.kind == "f"
    x = grid.coordinates[key] if numbers else np.arange(grid.coordinates[key].size, dtype=float)
    columns = list(slices(grid))[:MOST_PANELS if width >= style.PAGE else 1]
    first = file[next(name for name in grid.names.flat if name)]
    rows = _rows(first)
    figure, axes = style.new_figure(width, 14 + 52 * len(rows), nrows=len(rows), ncols=len(columns), sharey="row",
                                    squeeze=False)
    for row, (label, reference, drawn) in zip(axes, rows):
        panels = [{name: _along(file, names, figure_of) for name, figure_of in drawn.items()} for _, names in columns]
        for axis, values in zip(row, panels):
            _draw(axis, x, values, numbers)
            if reference is not None:
                axis.axhline(reference, color=style.GREY, linewidth=0.6, zorder=0.5)
            _x_axis(axis, grid)
        if reference is None:
            _spread_out(row[0], np.concatenate([values for panel in panels for values in panel.values()]))
        row[0].set_ylabel(label)
    for axis, (title, _) in zip(axes[0], columns):
        axis.set_title(title, pad=4 + 12 * ((len(rows[0][2]) + 1) // 2))  # above the legend, which has two columns
    for row in axes[[0, -1]] if len(rows) > 2 else axes[:1]:
        style.legend_above(row[0])
    trials = max(results.trials(group) for group in first.values())
    not_run = sum(not results.trials(next(iter(file[name].values()))) for name in grid.names.flat if name)
    left_out = grid.names.size // grid.coordinates[key].size - len(columns)
    style.headline(figure, f"{grid.of} over {', '.join(grid.coordinates)}, {trials:,} trials each, seed "
                           f"{results.text(file, 'root_seed_text')}; shades: 95 % intervals of the means"
                           + (f"; {left_out} more in the file" if left_out else "")
                           + (f"; {not_run} of {grid.names.size} points are not run yet" if not_run else ""))
    return figure


def _along(file, names, figure_of):
    values = [figure_of(file[name]) if name else None for name in names]
    return np.array([np.full(3, np.nan) if value is None else value for value in values])
