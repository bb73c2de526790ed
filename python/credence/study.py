"""Reads the files that credence writes, with h5py; docs/results-format.md says what is in them.

    import credence_results as results

    with results.open_file("study.h5") as file:
        for scenario, arm, group in results.arms(file):
            trace = results.column(group, "trace_P")          # one number a trial
            nees = results.per_step(group, "nees")            # one mean a step, with its 95 % interval
            print(scenario, arm, trace.mean(), results.units(group, "trace_P"), nees.mean / nees.dimension)

Needs h5py, NumPy and SciPy. The variables stay what they are: `group["trace_P"]` is the plain h5py dataset.
"""
import configparser
import fractions
import pathlib
from typing import NamedTuple

import h5py
import numpy as np
from scipy import stats

SCHEMA_VERSIONS = 2, 3
STUDY, TRAJECTORIES = "credence results", "credence trajectories"


class Means(NamedTuple):
    """Means over the counted trials, with standard errors and two-sided intervals; dimension is that of their block."""
    mean: np.ndarray
    standard_error: np.ndarray
    low: np.ndarray
    high: np.ndarray
    dimension: int


def open_file(path, kinds=(STUDY, TRAJECTORIES)):
    """The open file. Raises ValueError where it is none of credence's, or of another schema version."""
    if not pathlib.Path(path).is_file():
        raise ValueError(f"there is no file {path}. Give one that credence wrote.")
    if not h5py.is_hdf5(path):
        raise ValueError(f"{path} is no HDF5 file. Give one that credence wrote.")
    file = h5py.File(path, "r")
    kind, version = file.attrs.get("format"), file.attrs.get("schema_version")
    kind = kind.decode() if isinstance(kind, bytes) else kind
    if kind not in kinds:
        file.close()
        raise ValueError(f"{path} is none of {', '.join(kinds)} (format={kind}). Give one.")
    if version not in SCHEMA_VERSIONS:
        file.close()
        raise ValueError(f"{path} has schema version {version}, none of {SCHEMA_VERSIONS}. "
                         "Take the analysis folder of the credence that wrote it.")
    return file


def text(thing, name):
    """A text attribute; empty text is one null character in HDF5."""
    value = thing.attrs[name]
    return (value.decode() if isinstance(value, bytes) else str(value)).rstrip("\0")


def kind(file):
    """STUDY or TRAJECTORIES."""
    return text(file, "format")


def scenarios(file):
    """(name, group) of each scenario, in the order of the study, which h5py keeps for file["/"] only."""
    return [(name, group) for name, group in file["/"].items() if name != "run"]


def arms(file):
    """(scenario, arm, group) of each arm."""
    return [(scenario, arm, group) for scenario, groups in scenarios(file) for arm, group in groups.items()]


class Grid(NamedTuple):
    """The grid that --sweep made of a scenario: `coordinates` {key: its values}, numbers where all are, along the axes of
    `names`, the scenarios at the points; an empty text where there is none."""
    of: str
    coordinates: dict
    names: np.ndarray


def place(scenario_group):
    """(of, {key: value}) of a scenario that is a point of a grid; None of another one."""
    if "sweep_of" not in scenario_group.attrs:
        return None
    values = {key: scenario_group.attrs[f"sweep.{key}"] for key in text(scenario_group, "sweep_keys").split()}
    texts = {key: text(scenario_group, f"sweep.{key}") if isinstance(value, (bytes, str)) else float(value)
             for key, value in values.items()}
    return text(scenario_group, "sweep_of"), texts


def grids(file):
    """Every Grid of a study, numbers rising and texts in the order of the study."""
    found = {}
    for name, group in scenarios(file):
        if (point := place(group)) is not None:
            found.setdefault((point[0], tuple(point[1])), {})[name] = tuple(point[1].values())
    return [_grid(of, keys, points) for (of, keys), points in found.items()]


def _grid(of, keys, points):
    axes = []
    for values in zip(*points.values()):
        numbers = not any(isinstance(value, str) for value in values)
        axes.append(sorted(set(values)) if numbers else list(dict.fromkeys(map(_as_text, values))))
    names = np.full([len(axis) for axis in axes], "", dtype=object)
    for name, values in points.items():
        names[tuple(axis.index(value if value in axis else _as_text(value)) for axis, value in zip(axes, values))] = name
    return Grid(of, {key: np.array(axis) for key, axis in zip(keys, axes)}, names)


def _as_text(value):
    return value if isinstance(value, str) else f"{value:g}"


def over_grid(file, grid, figure):
    """`figure(scenario group)`, a number or an array of them, at every point of a grid, along its axes and then its own;
    NaN where the grid has no scenario or figure(...) is None."""
    values = {name: figure(file[name]) for name in grid.names.flat if name}
    shape = next((np.shape(value) for value in values.values() if value is not None), ())
    missing = np.full(shape, np.nan)
    points = [missing if values.get(name) is None else values[name] for name in grid.names.flat]
    return np.reshape(np.array(points, dtype=float), grid.names.shape + shape)


def mean_with_interval(arm, name, minus=None):
    """[mean, low, high] of a figure of a trial, with Student's interval, or of its differences to another arm."""
    means = trial_means(arm, name, minus)
    return np.array([means.mean, means.low, means.high])


def as_dataset(file, grid, columns=("trace_P", "pose_error", "squared_error", "nees_ratio", "nis_ratio")):
    """The grid as an xarray.Dataset: COLUMN, COLUMN_low and COLUMN_high over the swept keys and the arms, of those columns
    that the world has. Needs xarray."""
    import xarray

    first = next(iter(file[next(name for name in grid.names.flat if name)].values()))
    columns = [name for name in columns if has_column(first, name)]
    arm_names = list(dict.fromkeys(arm for name in grid.names.flat if name for arm in file[name]))
    variables = {}
    for name in columns:
        values = over_grid(file, grid, lambda group, name=name: np.array(
            [mean_with_interval(group[arm], name) if arm in group else np.full(3, np.nan) for arm in arm_names]))
        for number, suffix in enumerate(("", "_low", "_high")):
            variables[name + suffix] = ([*grid.coordinates, "arm"], values[..., number])
    return xarray.Dataset(variables, coords={**grid.coordinates, "arm": arm_names}, attrs={"sweep_of": grid.of})


def setting(scenario_group, section, key):
    """A key of the scenario, as text; empty where its world has none of that name."""
    parser = configparser.ConfigParser(interpolation=None, delimiters=("=",), comment_prefixes=("#",))
    parser.optionxform = str
    parser.read_string(text(scenario_group, "scenario"))
    return parser.get(section, key, fallback="")


def published(scenario_group, column_name):
    """{arm: value} of the published single run, where the scenario names one."""
    if column_name not in ("trace_P", "unseen", "pose_error"):
        return {}
    pairs = [pair.split() for pair in setting(scenario_group, "published", column_name).split(",") if pair.strip()]
    return {arm: float(value) for arm, value in pairs}


def keeps_trials(thing):
    """Whether the file of a group has a number for each trial: not that of a study run with --keep aggregates."""
    return "keep" not in thing.file.attrs


def trials(arm):
    """Trials that are there, failed ones too."""
    return arm["trial"].size if keeps_trials(arm) else int(arm["status_count"][:].sum())


def column(arm, name):
    """A number for each trial as double; NaN where the variable has its fill value, as for failed trials. Raises
    ValueError where the file keeps no trials."""
    if not keeps_trials(arm):
        raise ValueError(f"{arm.file.filename} keeps aggregates: it has no {name} of single trials. Take trial_means, or "
                         "run the study with --keep trials.")
    values = arm[name][:].astype(float)
    if "_FillValue" in arm[name].attrs:
        values[values == arm[name].attrs["_FillValue"][0]] = np.nan
    return values


def has_column(arm, name):
    """Whether the world of an arm has that column, with a number for each trial or as a total."""
    return name in (arm if keeps_trials(arm) else text(arm["column"], "column_names").split())


def units(arm, name):
    """The units of a variable, or of a figure of a trial; `1` without a dimension."""
    if name not in arm and not keeps_trials(arm):
        return text(arm["column"], "column_units").split(", ")[_place(arm["column"], "column_names", name)]
    return text(arm[name], "units")


def flags(variable):
    """{value: meaning} of a variable that holds codes."""
    return dict(zip(variable.attrs["flag_values"].tolist(), text(variable, "flag_meanings").split()))


def figures(arm, role):
    """Figures of that role, such as `nees`: those with totals over the trials, in the file's order."""
    ends = "_run_square_total"
    return [text(v, "figure") for name, v in arm.items() if name.endswith(ends) and text(v, "role") == role]


def total(arm, name):
    """A total as double: part 0 is all of it but what rounding left."""
    variable = arm[name]
    return variable[:].astype(float) if variable.dtype.kind == "i" else variable[..., 0]


def _means(totals, square_totals, trials, dimension, level):
    mean = totals / trials
    spread = np.maximum(square_totals / trials - mean**2, 0)
    error = np.sqrt(spread / (trials - 1)) if trials > 1 else np.full_like(mean, np.nan)
    half = stats.t.ppf(0.5 + level / 2, max(trials - 1, 1)) * error
    return Means(mean, error, mean - half, mean + half, dimension)


def _place(variable, attribute, name):
    names = text(variable, attribute).split()
    if name not in names:
        raise ValueError(f"there is no {name}. There are {', '.join(names)}.")
    return names.index(name)


def _moments(count, sums, squares, level):
    """Of exact totals: n Q - S^2 has hardly a digit left in doubles where values vary little."""
    exact = [sum(map(fractions.Fraction, parts)) if np.isfinite(parts).all() else None for parts in (sums, squares)]
    if count < 2 or None in exact:
        mean = float(exact[0] / count) if count and exact[0] is not None else np.nan
        return Means(mean, np.nan, np.nan, np.nan, 1)
    mean, error = float(exact[0] / count), float((count * exact[1] - exact[0]**2) / count**2 / (count - 1)) ** 0.5
    half = stats.t.ppf(0.5 + level / 2, count - 1) * error
    return Means(mean, error, mean - half, mean + half, 1)


def trial_means(arm, name, minus=None, level=0.95):
    """The mean of a figure of a trial, such as `trace_P`, or of its differences to another arm of the scenario, `minus`,
    by trial; with Student's interval. Of files that keep trials and of those that keep aggregates."""
    if keeps_trials(arm):
        values = column(arm, name) - (column(minus, name) if minus else 0)
        values = values[~np.isnan(values)]
        error = values.std(ddof=1) / np.sqrt(values.size) if values.size > 1 else np.nan
        mean, half = values.mean() if values.size else np.nan, stats.t.ppf(0.5 + level / 2, max(values.size - 1, 1)) * error
        return Means(mean, error, mean - half, mean + half, 1)
    place = _place(arm["column"], "column_names", name)
    if minus is None:
        return _moments(int(arm["column_count"][place]), arm["column_total"][place], arm["column_square_total"][place], level)
    own, other = (group.name.rsplit("/", 1)[1] for group in (arm, minus))
    if "subtracted_arm" not in arm or other not in text(arm["subtracted_arm"], "arm_names").split():
        if own == other:
            raise ValueError("an arm less itself is 0. Name two arms.")
        mean, error, low, high, _ = trial_means(minus, name, arm, level)
        return Means(-mean, error, -high, -low, 1)
    row = _place(arm["subtracted_arm"], "arm_names", other), place
    return _moments(int(arm["difference_count"][row]), arm["difference_total"][row], arm["difference_square_total"][row],
                    level)


def per_step(arm, figure, level=0.95):
    """The mean over the counted trials of a figure at each step, with Student's interval (NaN for integer figures,
    whose squares are not kept)."""
    totals, squares = total(arm, f"{figure}_total"), f"{figure}_square_total"
    square_totals = total(arm, squares) if squares in arm else np.full_like(totals, np.nan)
    dimension = int(arm[f"{figure}_total"].attrs.get("dimension", 1))
    return _means(totals, square_totals, int(arm.attrs["counted_trials"]), dimension, level)


def over_steps(arm, figure, level=0.95):
    """The mean over trials and steps; its interval takes one number a trial, because steps are correlated."""
    totals, squares = total(arm, f"{figure}_total"), total(arm, f"{figure}_run_square_total")
    steps, dimension = arm["step"].size, int(arm[f"{figure}_total"].attrs.get("dimension", 1))
    means = _means(totals.sum(), squares, int(arm.attrs["counted_trials"]), dimension, level)
    return Means(*(value / steps for value in means[:4]), dimension)


def degrees(arm, figure):
    """Degrees of freedom of the chi-square that the figure's total follows at each step, under a consistent filter."""
    attributes, trials = arm[f"{figure}_total"].attrs, int(arm.attrs["counted_trials"])
    if "dimension" in attributes:
        return np.full(arm["step"].size, trials * int(attributes["dimension"]), dtype=float)
    rows = text(arm[f"{figure}_total"], "rows")
    more_rows = np.full(arm["step"].size, float(attributes["more_rows"]) * trials)
    return more_rows + (total(arm, f"{rows}_total") if rows else 0)


def chi_square_band(degrees_of_freedom, level=0.95):
    """Bounds of a chi-square over its degrees of freedom: the classical band of ANEES and NIS/m."""
    tails = [(1 - level) / 2, (1 + level) / 2]
    return [stats.chi2.ppf(tail, degrees_of_freedom) / degrees_of_freedom for tail in tails]
