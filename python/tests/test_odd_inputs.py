"""What odd inputs get: odd_inputs.csv, row by row."""

from __future__ import annotations

import csv
import pathlib
import pickle
import re
import warnings

import numpy as np
import pandas
import pytest
import records
import test_array_doors as odd
import xarray
from conftest import refusal, refused

import credence

TRIALS, STEPS, N = 400, 6, 2
RNG = np.random.default_rng(41)
COVARIANCE = records.covariances(RNG, N, TRIALS, STEPS)
ERROR = records.drawn(RNG, COVARIANCE)
PLAIN = credence.judge(ERROR, COVARIANCE)
ROWS = [(trial, step) for trial in range(TRIALS) for step in range(STEPS)]
TABLE = pandas.DataFrame(ERROR.reshape(-1, N), columns=["x", "y"]).assign(run=[trial for trial, _ in ROWS])
SHUFFLED = np.random.default_rng(42).permutation(TRIALS)


def named_dimensions():
    error = xarray.DataArray(ERROR, dims=("trial", "time", "component")).transpose("time", "component", "trial")
    covariance = xarray.DataArray(COVARIANCE, dims=("run", "step", "i", "j")).transpose("step", "i", "run", "j")
    verdict = credence.judge(error, covariance, time=xarray.DataArray(np.arange(STEPS), dims="time"))
    assert verdict.json == PLAIN.json
    return verdict


def ended():
    """The record with runs that end, and how many steps they have."""
    steps = np.random.default_rng(44).integers(2, STEPS + 1, TRIALS)
    return steps, credence.judge(ERROR, COVARIANCE, steps=steps)


def runs_of_different_lengths():
    steps, verdict = ended()
    error, covariance = ([run[:end] for run, end in zip(array, steps)] for array in (ERROR, COVARIANCE))
    assert credence.judge(error, covariance).json == verdict.json
    assert credence.judge([run.tolist() for run in error], covariance).json == verdict.json
    refused("its runs do not end at the steps of", credence.judge, error, [*covariance[:-1], covariance[-1][:-1]])
    return verdict


def runs_below_each_other():
    steps, verdict = ended()
    kept = np.array([step < steps[trial] for trial, step in ROWS])
    table, covariance = TABLE[kept], COVARIANCE.reshape(-1, N, N)[kept]
    assert credence.judge(table, covariance, runs="run").json == verdict.json
    assert credence.judge(table[["x", "y"]], covariance, runs=table["run"]).json == verdict.json
    indexed = table.assign(step=np.arange(len(table))).set_index(["run", "step"])
    assert credence.judge(indexed, covariance, runs="run").json == verdict.json
    by_step = np.argsort([step for (_, step), keep in zip(ROWS, kept) if keep], kind="stable")
    assert credence.judge(table.iloc[by_step], covariance[by_step], runs="run").json == verdict.json
    return verdict


def an_index_that_repeats():
    table = TABLE[["x", "y"]].set_index(np.tile(np.arange(STEPS), TRIALS))
    return credence.judge(table, COVARIANCE.reshape(-1, N, N))


def a_table_without_runs():
    return credence.judge(TABLE[["x", "y"]], COVARIANCE.reshape(-1, N, N))


def walks(trials, steps, seed):
    """Errors of a filter with a memory of some steps [trial, step, 1]."""
    rng = np.random.default_rng(seed)
    walk = rng.normal(size=(trials, steps, 1))
    for k in range(1, steps):
        walk[:, k] += 0.9 * walk[:, k - 1]
    return walk


def steps_first():
    error = walks(200, 40, 45).swapaxes(0, 1)
    return credence.judge(error, np.full((*error.shape, 1), 5.0))


def reversed_dimensions():
    return credence.judge(ERROR.T, COVARIANCE.T)


def names_that_are_none():
    refused("`pose 0:1, x` is no name for a group", credence.judge, ERROR, COVARIANCE, groups={"pose 0:1, x": [1]})
    refused("component_names: has 1 entries, and .* has 2", credence.judge, ERROR, COVARIANCE, component_names=["x, y"])
    return credence.judge(ERROR, COVARIANCE, groups={"feature 0": [1]})


def members_that_are_none():
    for members in ([True, False], np.array([True, False]), [0.7, 1.9], [np.nan], "0 1", [[0, 1]]):
        refused("invalid groups .*is not the index of a", credence.judge, ERROR, COVARIANCE, groups={"pose": members})
    whole = credence.judge(ERROR, COVARIANCE, groups={"pose": [0]}).json
    for members in (0, [0.0], np.array([0]), np.int8(0), range(1)):
        assert credence.judge(ERROR, COVARIANCE, groups={"pose": members}).json == whole
    return credence.judge(ERROR, COVARIANCE, groups={"pose": np.array([True, False])})


def what_says_nothing():
    refused("chart: says nothing without estimate", credence.judge, ERROR, COVARIANCE, chart="local")
    return credence.judge(ERROR, COVARIANCE, row_groups={"gps": [0]})


def unknown_times():
    time = np.tile(np.arange(STEPS, dtype=float), (TRIALS, 1))
    steps, verdict = ended()
    time[np.arange(STEPS) >= steps[:, None]] = np.nan
    assert credence.judge(ERROR, COVARIANCE, steps=steps, time=time).json == verdict.json
    return credence.judge(ERROR, COVARIANCE, time=time)


def pickled():
    verdict = pickle.loads(pickle.dumps(PLAIN))
    assert (verdict.json, str(verdict), verdict.html) == (PLAIN.json, str(PLAIN), PLAIN.html)
    return verdict


def foreign_paths(tmp_path):
    named = records.write(tmp_path / "record.h5", {"error": ERROR, "covariance": COVARIANCE})
    path = pathlib.Path(named).rename(tmp_path / "\udcff.h5")
    verdict = credence.judge(path)
    assert verdict["groups"] == PLAIN["groups"]
    assert credence.judge(ERROR, COVARIANCE, name=str(path)).json == verdict.json
    assert "\udcff" not in str(verdict) + verdict.html
    refused(r"xfe.h5: the file: cannot be found", credence.judge, tmp_path / "\udcfe.h5")
    return verdict


# The input, as the table calls it, and what happens: a row of the table each. What is done is in a function, or in
# the rows of these names in the table of test_array_doors.py, which is tested there.
CASES = {
    "a masked array, or a list of them": ("masked", "list of masked", "taken"),
    "pandas with missing numbers (NA)": ("missing (NA)", "taken"),
    "numbers with units (pint, astropy, unyt)": ("units", "refused"),
    "xarray with dimensions `trial`, `step` or `time`, in any order": (named_dimensions, "taken"),
    "xarray with a dimension `trial` and none of steps": ("named, wrong", "refused"),
    "`numpy.matrix`": ("matrix", "taken"),
    "a list of runs of different lengths": (runs_of_different_lengths, "taken"),
    "a list whose parts differ in anything else": ("ragged rows", "refused"),
    "runs below each other in a flat table, with `runs`": (runs_below_each_other, "taken"),
    "a table whose index has levels or repeats, without `runs`": (an_index_that_repeats, "refused"),
    "a table of errors alone, without `runs`": (a_table_without_runs, "noted"),
    "`[step, trial, n]`": (steps_first, "noted"),
    "all dimensions in reverse, as from MATLAB": (reversed_dimensions, "refused"),
    "a name with spaces or commas": (names_that_are_none, "refused"),
    "a mask, or numbers that are not whole, as the members of a group": (members_that_are_none, "refused"),
    "`row_groups` without innovations, a `chart` without states": (what_says_nothing, "refused"),
    "NaN in `time` at a step that there is": (unknown_times, "refused"),
    "complex numbers, texts, objects": ("complex", "strings", "objects", "refused"),
    "a `Verdict` that is pickled": (pickled, "taken"),
    "a path that is not UTF-8": (foreign_paths, "taken"),
}


@pytest.mark.parametrize("row", CASES)
def test_an_odd_input_gets_what_the_table_says(row, tmp_path):
    *called, outcome = CASES[row]
    (call, *_) = called
    if isinstance(call, str):
        cells = {odd.ROWS[one]["run" if one == "matrix" else "judge"] for one in called}
        assert cells <= ({"refused"} if outcome == "refused" else {"same", "NaN"})
        return
    arguments = [tmp_path] if call is foreign_paths else []
    with warnings.catch_warnings(record=True) as noted:
        warnings.simplefilter("always")
        if outcome == "refused":
            refused(r"\. (Give|Call|Use) ", call, *arguments, raises=(credence.InputError, TypeError))
            return
        assert isinstance(call(*arguments), credence.Verdict)
    assert outcome == ("noted" if noted else "taken"), [str(note.message) for note in noted]


def test_the_table_has_these_rows():
    with pathlib.Path(__file__).with_name("odd_inputs.csv").open(encoding="utf-8", newline="") as file:
        rows = [(given, re.split(r"\W", what)[0]) for given, what in list(csv.reader(file))[1:]]
    assert rows == [(row, case[-1]) for row, case in CASES.items()]


@pytest.mark.parametrize("seed", range(40))
def test_no_true_layout_is_taken_for_one_with_its_steps_first(seed):
    rng = np.random.default_rng(seed)
    trials, steps = int(rng.integers(8, 60)), int(rng.integers(60, 300))
    scale = np.exp(walks(1, trials, seed)[0, :, 0])[:, None, None] if seed % 2 else 1  # neighbours of a like size
    error = walks(trials, steps, seed) * scale + np.linspace(0, 3, steps)[:, None]  # and a bias of all trials
    white = rng.normal(size=(trials, steps, 1)) * scale
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for each in (error, white):
            credence.judge(each, np.full((*each.shape, 1), 5.0))


@pytest.mark.parametrize("seed", range(10))
def test_runs_with_a_memory_are_noted_if_their_steps_come_first(seed):
    error = walks(100 + 10 * seed, 20 + 5 * seed, seed).swapaxes(0, 1)
    with pytest.warns(UserWarning, match=r"as if it were \[step, trial, n\].*error\.swapaxes"):
        credence.judge(error, np.full((*error.shape, 1), 5.0))


def test_units_of_a_library_are_seen():
    for library, quantity in (
        ("pint", lambda m: m.UnitRegistry().Quantity(ERROR, "cm")),
        ("astropy.units", lambda m: ERROR * m.cm),
    ):
        module = pytest.importorskip(library)
        refused("error: has units", credence.judge, quantity(module), COVARIANCE)


def test_what_is_refused_names_the_remedy_of_python():
    for arguments, remedy in (
        ({"error": ERROR.T, "covariance": COVARIANCE.T}, "Give the trials first: error.transpose() and covariance.tr"),
        ({"error": ERROR, "covariance": COVARIANCE, "groups": {"pose": [2]}}, "Give a dict of their names, each with"),
        ({"error": ERROR, "covariance": COVARIANCE, "component_names": ["x"]}, "Give a list with one for each comp"),
        ({"nees": ERROR[..., 0] ** 2}, "Give dimension, the number of components."),
        ({"nees": ERROR[..., 0] ** 2, "dimension": 1.5}, "invalid dimension (1.5 is not a whole number). Give"),
        ({"error": ERROR}, "Give it as [trial, step, n, n], or as"),
        ({}, "Give error [trial, step, n], or truth and estimate with their manifold"),
    ):
        assert remedy in refusal(credence.judge, **arguments)


def test_dimensions_of_numpy_are_whole_numbers():
    nees = np.random.default_rng(46).chisquare(3, (TRIALS, STEPS))
    plain = credence.judge(nees=nees, dimension=3).json
    assert credence.judge(nees=nees, dimension=np.int64(3)).json == plain
    refused("pose has no NEES", credence.judge, nees=nees, dimension={"all": 3, "pose": 2})


def test_a_list_is_one_value_of_a_sweep():
    shown = credence.show("[scenario]\nworld = deformable\n", sweep={"arms.estimators": [["ekf", "riekf"]]})
    assert shown == credence.show("[scenario]\nworld = deformable\n", sweep={"arms.estimators": "ekf, riekf|"})
    assert shown.count("[scenario]") == 1
    with pytest.raises(credence.InputError, match="has a bar, which parts values"):
        credence.show("[scenario]\nworld = deformable\n", sweep={"arms.estimators": ["ekf|riekf"]})
    assert "0, 0.3" in credence.show(set={"planner.turns": np.array([0, 0.3])})
