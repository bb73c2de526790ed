"""What callers give as arrays, as NumPy's own: [trial, step, ...], and NaN where there is no number.

Every array that comes in goes through `numbers`: those of `judge`, of a Run, and columns of tables. Nothing that such
an object says beside its numbers is dropped without a word: a mask, units, the names of dimensions, which rows belong
to a run, and where a run ends.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from credence import InputError
from credence._calls import note
from credence._errors import printable, wrong
from credence._record import Record

Array = npt.NDArray[Any]

_trial_names = ("trial", "trials", "run", "runs", "realization", "realisation", "monte_carlo", "mc")
_step_names = ("step", "steps", "time", "times", "t", "k")
_rows_below = "Give runs, the name of the column or an array that tells the runs apart"


def invalid(name: str, why: str, remedy: str) -> InputError:
    return InputError(f"{printable(name)}: {why}. {remedy}.")


def behind_steps(name: str) -> tuple[int, ...]:
    """How many dimensions an array may have behind those of trials and steps."""
    last = name.split("/")[-1]
    return {"nees": (0,), "time": (0,), "covariance": (1, 2), "innovation_covariance": (2,),
            "truth_covariance": (2,)}.get(last, (1,))


def _in_order(name: str, array: Any, single: bool) -> Any:
    """An array of xarray with its trials first and its steps second, if its dimensions are called so."""
    trials = [dim for dim in array.dims if str(dim).lower() in _trial_names]
    steps = [dim for dim in array.dims if str(dim).lower() in _step_names]
    others = [dim for dim in array.dims if dim not in trials + steps]
    if name == "steps" or name.startswith("column") or not trials + steps:
        return array
    if len(trials) > (0 if single else 1) or len(steps) != 1 or len(others) not in behind_steps(name):
        dims = ", ".join(map(printable, array.dims))
        leading = "step" if single else "trial and step"
        why = f"its dimensions, {dims}, are not those of {'' if single else 'trials, '}steps and components"
        raise invalid(name, why, f"Call its dimensions {leading}, and put those of the components behind them")
    return array.transpose(*trials, *steps, *others)


def _has_units(given: object) -> bool:
    """Whether it is a quantity, such as those of pint, astropy and unyt, or a table of them."""
    holders = [given, *([given.dtype] if hasattr(given, "dtype") else [])]
    units = [(holder, name) for holder in holders for name in ("units", "unit") if hasattr(type(holder), name)]
    return any(getattr(holder, name) is not None for holder, name in units)


def _is_nested(given: Any) -> bool:
    return isinstance(given, (list, tuple)) and not all(isinstance(one, (int, float)) for one in given)


def numbers(name: str, given: Any, single: bool = False) -> Array:
    """An array of numbers, and NaN where there is none; `single` is that of one run, without a dimension of trials.

    Raises
    ------
    InputError
        It has units, parts of different shapes, or dimensions whose names contradict its place.
    TypeError
        It does not hold numbers.
    """
    if type(given) is np.ndarray and given.dtype.kind in "fiub":
        return given
    if _is_nested(given):
        parts = [numbers(name, one, single) for one in given]
        if len({part.shape for part in parts}) > 1:
            raise _differing(name, parts)
        return np.array(parts)
    if hasattr(given, "dims") and hasattr(given, "coords"):
        return numbers(name, _in_order(name, given, single).data)
    if _has_units(given):
        remedy = "Give its numbers alone, the covariance in the square of the units of the error"
        raise invalid(name, f"has units ({type(given).__name__})", remedy)
    if hasattr(given, "mask") and callable(getattr(given, "filled", None)) and given.dtype.kind in "fiub":
        return np.asarray((given if given.dtype.kind == "f" else given.astype(float)).filled(np.nan))
    if type(given).__name__ == "NAType":
        return np.array(np.nan)
    array = np.asanyarray(given)
    if array is not given and type(array) is not np.ndarray:  # what a file's variable gives, with a mask
        return numbers(name, array)
    if array.dtype.kind == "O" and hasattr(given, "dtypes"):  # pandas, whose missing numbers are objects of their own
        kinds = {getattr(dtype, "kind", "O") for dtype in np.ravel(np.asarray(given.dtypes, dtype=object))}
        array = given.to_numpy(dtype=float, na_value=np.nan) if kinds <= set("fiub") else array
    if array.dtype.kind not in "fiub":
        why = f"is an array of {array.dtype}, which does not hold numbers"
        raise TypeError(f"{printable(name)} {why}. Give floating-point numbers.")
    return np.asarray(array)


def _is_table(given: object) -> bool:
    return hasattr(given, "columns") and hasattr(given, "index")


def _refuse_rows_below(name: str, given: Any, remedy: str) -> None:
    """Refuse a table whose index says that runs lie below each other."""
    if _is_table(given) and (given.index.nlevels > 1 or not given.index.is_unique):
        raise invalid(name, "its index has several levels, or the same row more than once", remedy)


def _differing(name: str, parts: list[Array]) -> InputError:
    shapes = " and ".join(dict.fromkeys(str(list(part.shape)) for part in parts))
    return invalid(name, f"its parts have the shapes {shapes[:200]}", "Give runs that differ in their steps alone")


def _padded(parts: list[Array]) -> Array:
    """One array of all runs, with NaN behind the shorter ones."""
    kept = np.result_type(*parts) if all(part.dtype.kind == "f" for part in parts) else float
    joint = np.full((len(parts), max(map(len, parts)), *parts[0].shape[1:]), np.nan, dtype=kept)
    for run, part in zip(joint, parts):
        run[: len(part)] = part
    return joint


def _of_runs(name: str, given: Any) -> tuple[Array, list[int] | None]:
    """An array, and the lengths of its runs if it is a list of runs that differ in them."""
    if not _is_nested(given):
        return numbers(name, given), None
    parts = [numbers(name, one) for one in given]
    if len({part.shape for part in parts}) == 1:
        return np.array(parts), None
    if len({part.shape[1:] for part in parts}) > 1 or parts[0].ndim - 1 not in behind_steps(name):
        raise _differing(name, parts)
    return _padded(parts), [len(part) for part in parts]


def _labels(table: Any, runs: str) -> tuple[Any, Any]:
    """The column or level of the index that tells the runs of a table apart, and the table without that column."""
    if runs in table.columns:
        return table[runs], table.drop(columns=runs)
    if runs in table.index.names:
        return table.index.get_level_values(runs), table
    return None, table


def _is_gap(label: Any) -> bool:
    return label is None or type(label).__name__ == "NAType" or isinstance(label, list) or bool(label != label)


def runs_of(labels: Any) -> npt.NDArray[np.intp]:
    """The number of each row's run, in the order of their first rows, by what tells the runs apart."""
    if not isinstance(labels, list) or any(map(_is_gap, labels)):
        raise wrong("runs", "it is no array [row] without gaps", "Give the number or name of each row's run")
    first: dict[object, int] = {}
    return np.array([first.setdefault(label, len(first)) for label in labels], dtype=np.intp)


def _parted(arrays: Mapping[str, Any], runs: Any) -> tuple[dict[str, Array], Array]:
    """Flat tables as arrays [trial, step, ...], runs in the order of their first rows; and the lengths of the runs."""
    tables = dict(arrays)
    found = {}
    if isinstance(runs, str):
        for name in filter(lambda name: _is_table(arrays[name]), arrays):
            found[name], tables[name] = _labels(arrays[name], runs)
        found = {name: np.asarray(labels).tolist() for name, labels in found.items() if labels is not None}
        if not found:
            given = f"invalid runs={printable(runs)}"
            raise InputError(f"{given} (no table has such a column). Give the name of a column, or an array.")
    labels = next(iter(found.values())) if found else np.asanyarray(runs).tolist()
    for name, others in found.items():
        if others != labels:
            why = f"its column {printable(runs)} is not that of {next(iter(found))}"
            raise invalid(name, why, "Give tables with the same rows")
    parted = {name: numbers(name, table) for name, table in tables.items()}
    run = runs_of(labels)
    lengths = np.bincount(run)
    order = np.argsort(run, kind="stable")
    for name, array in parted.items():
        if array.ndim == 0 or len(array) != len(run):
            raise invalid(name, f"is {list(array.shape)}, and runs has {len(run)} rows", "Give a row for each of runs")
        parted[name] = _padded(np.split(array[order], np.cumsum(lengths)[:-1]))
    return parted, lengths


def _refuse_unknown_times(arrays: Mapping[str, Array]) -> None:
    """Refuse NaN in `time` at a step that exists."""
    time = arrays.get("time")
    if time is None or time.dtype.kind != "f" or not np.isnan(time).any():
        return
    states = arrays.get("error", arrays.get("estimate"))
    if states is not None and states.ndim < 2:
        return  # refused by its shape
    exists = ~np.isnan(arrays.get("nees", time)) if states is None else ~np.isnan(states).all(axis=-1)
    if "steps" in arrays and exists.ndim == 2 and arrays["steps"].shape == exists.shape[:1]:
        exists &= np.arange(exists.shape[1]) < arrays["steps"][:, None]
    if time.ndim and exists.shape[-time.ndim :] == time.shape and (exists & np.isnan(time)).any():
        raise invalid("time", "is NaN at a step that there is", "Give the time of each step (s), or leave time out")


def _note_what_looks_like_steps_first(error: Array) -> None:
    """Warn if neighbours among the trials are alike and neighbours among the steps are not: independent runs are not
    alike, whatever the filter.
    """
    if error.ndim != 3 or not 8 <= error.shape[0] < error.shape[1]:
        return
    sample = error[:200, :2000].astype(float)
    x = np.where(np.isfinite(sample), sample, 0)
    with np.errstate(all="ignore"):  # NaN, and then no warning, if the numbers are too large or all the same
        x = x - x.mean(axis=0)
        power = np.sum(x**2)
        of_trials, of_steps = (np.sum(x[1:] * x[:-1]) / power, np.sum(x[:, 1:] * x[:, :-1]) / power)
    if of_trials > 0.25 and abs(of_steps) < of_trials / 4:
        trials, steps, _ = error.shape
        message = (
            f"error: neighbours among its {trials} trials are alike, and neighbours among its {steps} steps are not, "
            "as if it were [step, trial, n]. If so, give error.swapaxes(0, 1), and the other arrays likewise."
        )
        note(message)


def _note_one_run(given: Mapping[str, Any], error: Array) -> None:
    """Warn if a table is one run by its shape: its errors alone can show nothing."""
    if _is_table(given.get("error")) and error.ndim == 2 and "innovation" not in given:
        taken = f"error: a table of {len(error)} rows is taken for the steps of one run"
        note(f"{taken}. If it has several runs: {_rows_below}.")


def of_one_run(name: str, given: Any) -> Array:
    """An array of a Run, without a dimension of trials, or a number of it."""
    _refuse_rows_below(name, given, "Give the steps of one run in their order")
    return numbers(name, given, single=True)


def of_many_runs(given: Mapping[str, Any]) -> dict[str, Array]:
    """Arrays by their names; `steps` is added if runs end at different steps."""
    arrays, ends = {}, {}
    for name, array in given.items():
        _refuse_rows_below(name, array, _rows_below)
        arrays[name], lengths_or_none = _of_runs(name, array)
        if lengths_or_none is not None:
            ends[name] = lengths_or_none
    for name, lengths_of_it in ends.items():
        other = next(iter(ends))
        if lengths_of_it != ends[other]:
            why = f"its runs do not end at the steps of those of {printable(other)}"
            raise invalid(name, why, "Give the same steps of both")
        if "steps" in given:
            raise invalid(name, "its runs say by themselves where they end, and so does steps", "Leave steps out")
        arrays["steps"] = np.array(lengths_of_it)
    return arrays


def _fitted(arrays: dict[str, Array]) -> dict[str, Array]:
    """Columns [..., n, 1] as vectors, and one covariance for all runs, or for all steps, as that of each."""
    for kind, states in (("covariance", ("error", "estimate", "truth")), ("innovation_covariance", ("innovation",))):
        P = arrays.get(kind, np.empty(0))
        for name in filter(arrays.__contains__, states):
            of = arrays[name]
            if of.ndim > 2 and of.shape[-1] == 1 < of.shape[-2] and P.shape == (*of.shape[:-1], of.shape[-2]):
                arrays[name] = of[..., 0]
        steps = next((arrays[name].shape for name in states if name in arrays), ())[:-1]
        n = P.shape[-1] if P.ndim > 1 else 0
        if len(steps) and P.shape in ((*steps[1:], n, n), (n, n)) and P.ndim < len(steps) + 2 and steps[-1] != n:
            arrays[kind] = np.broadcast_to(P, (*steps, n, n))
    return arrays


def prepared(record: Record, runs: object = None) -> dict[str, Array]:
    """The arrays of a record, by their places in a file; `steps` is added if runs end at different steps.

    `runs` tells the runs apart where they lie below each other.
    """
    given = record.arrays | ({} if record.steps is None else {"steps": record.steps})
    name = "truth_covariance"
    same: dict[str, Array] = {}
    if runs is not None and name in given and np.ndim(given[name]) < 3:  # one for all rows
        same = {name: numbers(name, given.pop(name))}
    if runs is None:
        arrays = of_many_runs(given)
    elif "steps" in given:
        raise wrong("steps", "runs says how long each run is", "Give runs or steps")
    else:
        arrays, lengths = _parted(given, runs)
        arrays["steps"] = lengths
    arrays = _fitted(arrays)
    if "error" in arrays:
        _note_one_run(given, arrays["error"])
        _note_what_looks_like_steps_first(arrays["error"])
    _refuse_unknown_times(arrays)
    columns = {f"column/{name}": each for name, each in (record.columns or {}).items()}
    return arrays | same | {place: np.atleast_1d(numbers(place, each)) for place, each in columns.items()}


def described(array: Array) -> tuple[Array, float]:
    """Doubles and singles as they are; anything else as doubles. With the precision of the type."""
    precision = float(max(np.finfo(array.dtype).eps, 2.0**-52)) if array.dtype.kind == "f" else 2.0**-52
    if array.dtype not in (np.dtype("f8"), np.dtype("f4")):
        array = array.astype(float)
    if not array.flags.aligned or any(stride % array.itemsize for stride in array.strides):
        array = array.copy()
    return array, precision
