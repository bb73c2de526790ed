"""Every way in for arrays against every odd array: one table, and what it says happens."""

from __future__ import annotations

import types
import warnings

import numpy as np
import pandas
import pytest
import scipy.io
import scipy.sparse
import xarray

import credence
from credence import adapters
from credence._trials import Work
from credence._tune_sources import LogSource, score_chunk

# What is given (rows) to what (columns), and what happens:
#   same     its numbers are taken as they are
#   NaN      where it says that a number is missing, the number is NaN, and the step does not exist
#   ends     each run ends at its last step
#   refused  with what to do instead
#   -        there is no such thing
#
# judge: errors and covariances [trial, step, ...]. run, batch: the same of a Run, of one trial and of many. tune, log:
# the same of a function of a generator, and of a log. column: the number of a Run. group, nees, innovation, time,
# steps: these arguments of judge. npz, mat, table: from_npz, from_mat, from_table. navlie: from_navlie.
TABLE = """
                  judge   run     batch   tune    log     column  group   nees    innovation time  steps   npz     mat     table   navlie
doubles           same    same    same    same    same    same    same    same    same    same    same    same    same    same    same
fortran           same    same    same    same    same    -       same    same    same    same    -       same    same    -       same
backwards         same    same    same    same    same    -       same    same    same    same    same    same    same    same    same
every second      same    same    same    same    same    -       same    same    same    same    same    same    same    same    same
unaligned         same    same    same    same    same    -       same    same    same    same    same    same    same    same    same
big endian        same    same    same    same    same    same    same    same    same    same    same    same    same    same    same
halves            same    same    same    same    same    same    same    same    same    same    same    same    -       same    same
long doubles      same    same    same    same    same    same    same    same    same    same    same    same    -       same    same
integers          same    same    same    same    same    same    same    same    same    same    same    same    same    same    same
bool              same    same    same    same    same    same    same    same    same    -       -       same    same    same    same
lists             same    same    same    same    same    same    same    same    same    same    same    -       -       same    same
has an array      same    same    same    same    same    same    same    same    same    same    same    -       -       same    same
matrix            -       same    -       same    same    -       -       same    -       same    -       -       -       -       same
masked            NaN     NaN     NaN     NaN     NaN     NaN     NaN     NaN     NaN     refused refused -       -       NaN     NaN
list of masked    NaN     NaN     NaN     NaN     NaN     -       NaN     NaN     NaN     refused -       -       -       -       NaN
masked in a file  NaN     NaN     NaN     NaN     NaN     NaN     NaN     NaN     NaN     refused refused -       -       NaN     NaN
missing (NA)      NaN     NaN     NaN     NaN     NaN     NaN     -       NaN     NaN     refused refused -       -       NaN     NaN
named, turned     same    same    same    same    same    -       same    same    same    same    same    -       -       same    same
named, wrong      refused refused refused refused refused -       refused refused refused refused -       -       -       -       refused
units             refused refused refused refused refused refused refused refused refused refused refused -       -       refused refused
ragged runs       ends    -       ends    -       -       -       ends    ends    ends    -       -       -       -       -       -
ragged rows       refused refused refused refused refused -       refused -       refused -       -       -       -       -       refused
repeated index    -       refused -       refused refused -       -       -       -       -       -       -       -       -       -
strings           refused refused refused refused refused refused refused refused refused refused refused refused refused refused refused
objects           refused refused refused refused refused refused refused refused refused refused refused refused refused refused refused
complex           refused refused refused refused refused refused refused refused refused refused refused refused refused refused refused
sparse            -       refused -       refused refused -       -       refused -       refused -       -       -       -       refused
"""  # noqa: E501
HEAD, *LINES = TABLE.strip("\n").splitlines()
DOORS = HEAD.split()
ROWS = {line[:18].strip(): dict(zip(DOORS, line[18:].split(), strict=True)) for line in LINES}

TRIALS, STEPS, N = 12, 5, 2
RNG = np.random.default_rng(57)
ERROR = 2 * RNG.standard_normal((TRIALS, STEPS, N))
COVARIANCE = np.array([[3, 0.3], [0.3, 2]]) * (1 + np.arange(TRIALS) % 3)[:, None, None, None] * np.ones((STEPS, 1, 1))
NEES = RNG.chisquare(2, (TRIALS, STEPS)) + 0.2
TIME = 2.0 * np.arange(STEPS) + np.arange(TRIALS)[:, None]
ENDS = RNG.integers(3, STEPS + 1, TRIALS)
MISSING = 2  # the step that is not there
STACKED = ("trial", "step", "i", "j")


class Quantity:
    """As those of pint: an array beside its units."""

    units = "cm"

    def __init__(self, magnitude):
        self.magnitude = magnitude

    def __array__(self, dtype=None, copy=None):
        return self.magnitude


class HasAnArray:
    """As a variable of netCDF4, whose array has a mask, or a tensor."""

    def __init__(self, array):
        self.array = array

    def __array__(self, dtype=None, copy=None):
        return self.array


def hidden(a, dims):
    """Where the step is that is not there."""
    where = np.zeros(a.shape, dtype=bool)
    axis = 1 if dims[:2] == ("trial", "step") else 0
    where[(slice(None),) * axis + ((MISSING,) if a.ndim else ())] = True
    return where


def masked(a, dims):
    """With numbers beneath the mask that would tell another story."""
    where = hidden(a, dims)
    return np.ma.MaskedArray(np.where(where, 1e3, a), where)


def with_nan(a, dims):
    return np.where(hidden(a, dims), np.nan, a)


def missing(a, dims):
    if a.ndim == 0:
        return pandas.NA
    if dims == STACKED[:3]:
        return [missing(each, dims[1:]) for each in a]
    if a.ndim > 2:
        return with_nan(a, dims)
    table = (pandas.DataFrame if a.ndim == 2 else pandas.Series)(a).astype("Float64")
    return table.mask(hidden(a, dims), pandas.NA)


def backwards(a, dims):
    return np.ascontiguousarray(np.flip(a))[(slice(None, None, -1),) * a.ndim]


def every_second(a, dims):
    spread = np.full(tuple(2 * extent for extent in a.shape), np.nan)
    window = spread[(slice(None, None, 2),) * a.ndim]
    window[...] = a
    return window


def unaligned(a, dims):
    pairs = np.empty(a.shape, dtype=[("tag", "u1"), ("value", "f8")])
    pairs["value"] = a
    return pairs["value"]


def ragged_runs(a, dims):
    return [each[:end] for each, end in zip(a, ENDS)]


def ragged_rows(a, dims):
    if dims[0] == "trial":
        return [ragged_rows(each, dims[1:]) for each in a]
    return [row[:1] if k == 1 else row for k, row in enumerate(a.tolist())]


def matrix(a, dims):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PendingDeprecationWarning)  # NumPy's own
        return np.matrix(a) if a.ndim == 2 else a


def of_two(make):
    """Of arrays of two dimensions; others as they are."""
    return lambda a, dims: make(a) if a.ndim == 2 else a


# What each kind makes of an array of doubles with these dimensions, and doubles with the same numbers.
KINDS = {
    "doubles": (lambda a, dims: a, None),
    "fortran": (lambda a, dims: np.asfortranarray(a), None),
    "backwards": (backwards, None),
    "every second": (every_second, None),
    "unaligned": (unaligned, None),
    "big endian": (lambda a, dims: a.astype(">f8"), None),
    "halves": (lambda a, dims: a.astype("f2"), lambda a, dims: a.astype("f2").astype(float)),
    "long doubles": (lambda a, dims: a.astype("g"), None),
    "integers": (lambda a, dims: np.rint(a).astype(int), lambda a, dims: np.rint(a)),
    "bool": (lambda a, dims: a > 1, lambda a, dims: (a > 1).astype(float)),
    "lists": (lambda a, dims: a.tolist(), None),
    "has an array": (lambda a, dims: HasAnArray(a), None),
    "matrix": (matrix, None),
    "masked": (masked, with_nan),
    "list of masked": (lambda a, dims: list(masked(a, dims)), with_nan),
    "masked in a file": (lambda a, dims: HasAnArray(masked(a, dims)), with_nan),
    "missing (NA)": (missing, with_nan),
    "named, turned": (lambda a, dims: xarray.DataArray(a.T, dims=dims[::-1]), None),
    "named, wrong": (lambda a, dims: xarray.DataArray(a, dims=("trial", "a", "b", "c")[: a.ndim]), None),
    "units": (lambda a, dims: Quantity(a), None),
    "ragged runs": (ragged_runs, None),
    "ragged rows": (ragged_rows, None),
    "repeated index": (of_two(lambda a: pandas.DataFrame(a, index=np.zeros(len(a)))), None),
    "strings": (lambda a, dims: a.astype(str), None),
    "objects": (lambda a, dims: a.astype(object), None),
    "complex": (lambda a, dims: a + 1j, None),
    "sparse": (of_two(scipy.sparse.csr_array), None),
}


def said(verdict):
    """What a verdict rests on."""
    numbers = [verdict["trials"], verdict["failed_trials"], verdict["nees_ratio"]["mean"], verdict["nis_ratio"]["mean"]]
    return [*numbers, *(group["nees_ratio"] for group in verdict["groups"])]


def judge(odd, plain, **steps):
    return said(credence.judge(odd(ERROR, STACKED[:3]), odd(COVARIANCE, STACKED), **steps))


def of_a_trial(odd, trial, **more):
    return credence.Run(odd(ERROR[trial], ("step", "i")), odd(COVARIANCE[trial], ("step", "i", "j")), **more)


def every_trial(odd):
    """A function that gives one trial after the other; trial 0 runs twice."""
    trials = iter([0, *range(TRIALS)])
    return lambda rng: of_a_trial(odd, next(trials))


def run(odd, plain):
    return said(credence.simulate(every_trial(odd), trials=TRIALS).verdicts["run"])


def batch(odd, plain, **steps):
    whole = credence.Run(odd(ERROR, STACKED[:3]), odd(COVARIANCE, STACKED), **steps)
    return said(credence.simulate(lambda rngs: whole, trials=TRIALS, batch=TRIALS).verdicts["run"])


def tune(odd, plain):
    trials = iter(range(TRIALS))
    work = Work(lambda rng: of_a_trial(odd, next(trials)), {}, 1, 0, None)
    _, scores, trouble = score_chunk((work, "errors"), {}, range(TRIALS))
    if trouble:
        raise credence.Failure(trouble)
    return scores


def log(odd, plain):
    error, covariance = ERROR.reshape(-1, N), COVARIANCE.reshape(-1, N, N)

    def given():
        return credence.Run(odd(error, ("step", "i")), odd(covariance, ("step", "i", "j")))

    return LogSource(given, "errors", {}, None).scores({}, 1).tolist()


def column(odd, plain):
    numbers = iter([0, *range(TRIALS)])

    def given(rng):
        trial = next(numbers)
        return of_a_trial(plain, trial, columns={"x": odd(np.array(ERROR[trial, 0, 0]), ())})

    return credence.simulate(given, trials=TRIALS).columns["run"]["x"].tolist()


def group(odd, plain, **steps):
    own = {"pose": odd(COVARIANCE, STACKED)}
    return said(credence.judge(plain(ERROR, STACKED[:3]), groups={"pose": [0, 1]}, group_covariance=own, **steps))


def nees(odd, plain, **steps):
    return said(credence.judge(nees=odd(NEES, STACKED[:2]), dimension=2, **steps))


def innovation(odd, plain, **steps):
    both = {"innovation": odd(ERROR, STACKED[:3]), "innovation_covariance": odd(COVARIANCE, STACKED)}
    return said(credence.judge(ERROR, COVARIANCE, **both, **steps))


def time(odd, plain, **steps):
    return credence.judge(ERROR, COVARIANCE, time=odd(TIME, STACKED[:2]), **steps).html


def steps(odd, plain):
    return said(credence.judge(ERROR, COVARIANCE, steps=odd(ENDS.astype(float), ("trial",))))


def npz(odd, plain):
    np.savez("a.npz", error=odd(ERROR, STACKED[:3]), covariance=odd(COVARIANCE, STACKED))
    return said(credence.judge(**adapters.from_npz("a.npz")))


def mat(odd, plain):
    scipy.io.savemat("a.mat", {"error": odd(ERROR, STACKED[:3]), "covariance": odd(COVARIANCE, STACKED)})
    return said(credence.judge(**adapters.from_mat("a.mat")))


def table(odd, plain):
    values = np.concatenate([ERROR, np.diagonal(COVARIANCE, axis1=2, axis2=3)], axis=-1).reshape(-1, 2 * N)
    columns = {name: odd(values[:, i].copy(), ("step",)) for i, name in enumerate(("e", "f", "v", "w"))}
    return said(credence.judge(**adapters.from_table(columns, error=["e", "f"], variance=["v", "w"])))


def navlie(odd, plain):
    results = [types.SimpleNamespace(stamp=TIME[i], **of_a_trial(odd, i).arrays) for i in range(TRIALS)]
    return said(credence.judge(**adapters.from_navlie(results)))


def test_the_table_has_these_rows():
    assert list(ROWS) == list(KINDS)


@pytest.mark.parametrize(("kind", "door"), [(kind, door) for kind in ROWS for door in DOORS if ROWS[kind][door] != "-"])
def test_every_door_does_with_every_odd_array_what_the_table_says(kind, door, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    call, (odd, plain), outcome = globals()[door], KINDS[kind], ROWS[kind][door]
    plain = plain or KINDS["doubles"][0]
    if outcome == "refused":
        with pytest.raises((credence.InputError, credence.Failure, TypeError), match=r"\. (Give|Call|Write) "):
            call(odd, plain)
        return
    assert outcome == {"ragged runs": "ends"}.get(kind, "same" if KINDS[kind][1] is not with_nan else "NaN")
    ends = {"steps": ENDS} if outcome == "ends" else {}
    assert repr(call(odd, plain)) == repr(call(plain, plain, **ends))
