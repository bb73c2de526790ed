"""Thousands of calls that no one would write on purpose: each ends with a verdict or with an exception."""

from __future__ import annotations

import contextlib

import numpy as np
import pytest
import records

import credence

pytestmark = pytest.mark.filterwarnings("ignore")  # of NumPy, about what is cast
ROUNDS = 250


def _first(value):
    """Of three trials."""
    if isinstance(value, dict):
        return {key: _first(each) for key, each in value.items()}
    return value[:3] if isinstance(value, np.ndarray) and value.shape[0] == records.TRIALS else value


CORPUS = {name: _first(record) for name, record in records.corpus().items()}
ARRAYS = ["error", "covariance", "innovation", "innovation_covariance", "steps", "time", "truth", "estimate", "nees"]
TEXTS = ["groups", "row_groups", "component_names", "component_units", "manifold", "chart", "quaternion", "name"]
OPTIONS = ["margin", "margin_direction", "bias", "failed", "dimension", "group_covariance", "group_nees", "runs"]
# fmt: off
THINGS = [
    None, "", "\0", "é", "\ud800", "a\nb", ",", "pose 0:3", "pose 0:99999999999", "all 0", "a -1", "a 0 0", "a 0, a 1",
    "SE3 x R2", "x", "R1001", "wxyz", "local", "5%", "nan", b"pose", 0, -1, 3, 2.5, 2**40, 2**70, True, np.nan, np.inf,
    [], [[]], [[1.0], [2.0, 3.0]], {}, {"pose": [0, 1]}, {"pose": -1}, {"pose": [2**70]}, {1: 2}, {"": []},
    {"a b": [0]}, {"all": 4, "pose": 3}, {"pose": np.eye(3)}, {"pose/x": np.ones((3, 6))}, object(), range(3),
]
# fmt: on
TYPES = ["f4", "f2", "g", ">f8", ">f4", "i8", "u1", "?", "c16", "O", "S4", "U4", "M8[s]", [("a", "f8"), ("b", "u1")]]
NUMBERS = [np.nan, np.inf, -np.inf, 0.0, -1.0, 1e308, -1e200, 1e-308, 5e-324]


def _other_numbers(rng, array):
    array = np.array(array)
    if array.size and array.dtype.kind == "f":
        array.flat[rng.integers(array.size, size=rng.integers(1, 4))] = NUMBERS[rng.integers(len(NUMBERS))]
    return array


def _other_layout(rng, array):
    """As it is, with other strides: backwards, transposed, with gaps, one row again and again, or overlapping."""
    axis = int(rng.integers(array.ndim)) if array.ndim else None
    ways = [
        lambda: np.flip(array, axis),
        lambda: array.T,
        lambda: np.asfortranarray(array),
        lambda: np.repeat(array, 2, axis)[tuple(slice(None, None, 2 if i == axis else 1) for i in range(array.ndim))],
        lambda: np.broadcast_to(array[:1], array.shape),
        lambda: np.lib.stride_tricks.as_strided(array, array.shape, (array.itemsize,) * array.ndim),
        lambda: np.frombuffer(b"\1" + array.tobytes(), dtype=array.dtype, offset=1).reshape(array.shape),
    ]
    return ways[rng.integers(len(ways))]()


def _other_shape(rng, array):
    axis = int(rng.integers(array.ndim)) if array.ndim else 0
    ways = [
        lambda: array[..., None],
        lambda: array[None],
        lambda: array.take(0, axis),
        lambda: array.take([], axis),
        lambda: array.take(range(array.shape[axis] - 1), axis),
        lambda: array.ravel(),
        lambda: array.ravel()[0],
        lambda: array.reshape((1,) * 20 + array.shape),
        lambda: np.broadcast_to(array, (2**40, *array.shape[1:])) if array.shape[0] == 1 else array[:1],
    ]
    return ways[rng.integers(len(ways))]()


def _other_type(rng, array):
    return array.astype(TYPES[rng.integers(len(TYPES))])


def _changed(rng, record):
    """A record with one to three changes."""
    record = {key: dict(value) if isinstance(value, dict) else value for key, value in record.items()}
    for _ in range(rng.integers(1, 4)):
        holders = [record, *(value for value in record.values() if isinstance(value, dict))]
        arrays = [(holder, key) for holder in holders for key, value in holder.items() if isinstance(value, np.ndarray)]
        way = [None, _other_numbers, _other_layout, _other_shape, _other_type][rng.integers(5)]
        if way is None or not arrays:
            record[str(rng.choice(ARRAYS + 2 * TEXTS + OPTIONS))] = THINGS[rng.integers(len(THINGS))]
            continue
        holder, key = arrays[rng.integers(len(arrays))]
        with contextlib.suppress(Exception):  # where NumPy cannot make it
            holder[key] = way(rng, holder[key])
    return record


REFUSALS = (TypeError, ValueError, OverflowError, MemoryError, FileNotFoundError, AttributeError)


def _outcome(call, record):
    """What a call returns or raises."""
    try:
        return call(**record)
    except (*REFUSALS, AssertionError) as error:
        return error


@pytest.mark.parametrize("name", CORPUS)
def test_a_malformed_call_ends_with_a_verdict_or_an_exception(name):
    rng = np.random.default_rng([26, *name.encode()])
    refused = 0
    for _ in range(ROUNDS):
        outcome = _outcome(credence.judge, _changed(rng, CORPUS[name]))
        if isinstance(outcome, credence.Verdict):
            assert str(outcome)
            assert outcome.html
            continue
        refused += 1
        assert isinstance(outcome, REFUSALS)
        assert str(outcome).isprintable() or not isinstance(outcome, credence.InputError)
    assert ROUNDS / 20 < refused < ROUNDS * 19 / 20


def test_as_many_trials_as_no_memory_holds_are_an_exception():
    error, covariance = np.zeros((1, 2, 2)), np.eye(2)
    for trials in (2**40, 2**58):
        with pytest.raises((MemoryError, ValueError)):
            credence.judge(np.broadcast_to(error, (trials, 2, 2)), np.broadcast_to(covariance, (trials, 2, 2, 2)))


def test_a_manifold_of_more_dimensions_than_an_integer_counts_is_refused():
    states = np.zeros((1, 1, 4))  # 4 is what 32 bits keep of 4294967 * 1000 + 300
    with pytest.raises(credence.InputError, match="more than 1000 dimensions"):
        credence.judge(truth=states, estimate=states, manifold="R1000 x " * 4_294_967 + "R300", chart="local")


def test_assert_consistent_refuses_what_judge_refuses():
    rng = np.random.default_rng(27)
    for _ in range(ROUNDS):
        record = _changed(rng, CORPUS["joint"])
        outcome, asserted = _outcome(credence.judge, record), _outcome(credence.assert_consistent, record)
        if not isinstance(outcome, credence.Verdict):
            assert type(asserted) is type(outcome)
        elif outcome.verdict in ("consistent", "undecided"):
            assert asserted.verdict == outcome.verdict
        else:
            assert type(asserted) is AssertionError
