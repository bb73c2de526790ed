"""Thousands of calls that no one would write on purpose: each ends with a verdict or with an exception."""

from __future__ import annotations

import codecs
import contextlib
import re

import numpy as np
import pytest
import records

import credence
from credence import adapters
from credence._judge_command import main as judge_command

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


def _table_text():
    rng = np.random.default_rng(30)
    return "# x,\N{GREEK SMALL LETTER THETA},s\n" + "".join(
        f"{e:.17g},{f:.17g},1\n" for e, f in rng.normal(size=(60, 2))
    )


def _poses_text(covariance):
    rng = np.random.default_rng(31)
    rows = [[k / 10, *rng.normal(size=3), 0, 0, 0, 1, *covariance] for k in range(60)]
    return "# time x y z °\n" + "".join(" ".join(f"{one:.17g}" for one in row) + "\n" for row in rows)


@pytest.mark.parametrize(
    ("encoding", "mark"),
    [("utf-8-sig", b""), ("utf-16-le", codecs.BOM_UTF16_LE), ("utf-16-be", codecs.BOM_UTF16_BE)],
)
def test_texts_in_every_encoding(tmp_path, encoding, mark):
    texts = {"a.csv": _table_text(), "e.txt": _poses_text(np.eye(6).ravel()), "t.txt": _poses_text(())}
    for name, text in texts.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
        (tmp_path / f"other-{name}").write_bytes(mark + text.encode(encoding))

    def read(prefix):
        table = adapters.from_table(tmp_path / f"{prefix}a.csv", error=["x", "θ"], sigma=["s", "s"])
        poses = adapters.from_tum(tmp_path / f"{prefix}e.txt", tmp_path / f"{prefix}t.txt", planar=False)
        return [table["error"], poses["truth"], poses["estimate"]]

    for plain, other in zip(read(""), read("other-")):
        np.testing.assert_array_equal(other, plain)


@pytest.mark.parametrize(
    ("start", "message"),
    [
        (b"", "it is no text in UTF-8 or UTF-16 .*Save it as UTF-8"),
        (b"\0", "it is no text: it has zeros in it. Save it as UTF-8, or check the path"),
        (codecs.BOM_UTF16_LE, "no text in UTF-8 or UTF-16"),
    ],
)
def test_what_is_no_text_is_refused(tmp_path, start, message, capfd):
    path = {name: tmp_path / name for name in ("a.csv", "a.txt", "truth.txt")}
    for one in path.values():
        one.write_bytes(start + b"x,\xb0,s\n1,2,1\n" + (b"\xd8" if start else b"") * 3)
    path["truth.txt"].write_text(_poses_text(()))
    for words in ([path["a.csv"], "--names", "error=x", "sigma=s"], [path["a.txt"], "--truth", path["truth.txt"]]):
        assert judge_command(list(map(str, words))) == 2
        said = capfd.readouterr().err
        assert re.search(f"credence judge: {re.escape(str(words[0]))}: .*{message}", said)
        assert len(said.splitlines()) == 1


def _damages(whole):
    """Ways in which a file of arrays is damaged."""
    middle = len(whole) // 2
    yield from (whole[:length] for length in (0, 1, 4, 30, 100, middle, len(whole) - 30, len(whole) - 1))
    yield from (
        whole[:place] + b"\xff\0\xff\0" + whole[place + 4 :] for place in (0, 26, 45, 100, middle, len(whole) - 20)
    )


@pytest.mark.parametrize("save", [np.savez, np.savez_compressed])
def test_damaged_arrays_are_refused(tmp_path, save, capfd):
    error = np.random.default_rng(32).normal(size=(40, 3, 2))
    path = tmp_path / "a.npz"
    save(path, error=error, covariance=np.broadcast_to(np.eye(2), (40, 3, 2, 2)))
    whole, refused = path.read_bytes(), 0
    for damaged in _damages(whole):
        path.write_bytes(damaged)
        if judge_command([str(path)]) == 0:  # the damage is where nobody looks
            arguments = adapters.from_npz(path)
            np.testing.assert_array_equal(arguments["error"], error)
            capfd.readouterr()
            continue
        said = capfd.readouterr().err
        refused += 1
        assert re.match(
            rf"credence judge: {re.escape(str(path))}: it(s array \w+)? cannot be read (as an \.npz file )?\(", said
        )
        assert said.endswith(("). Check the path.\n", "). Give arrays of numbers.\n"))
        assert len(said.splitlines()) == 1
    assert refused > 10


def test_folders_and_what_cannot_be_read_are_refused(tmp_path, capfd):
    truth = tmp_path / "truth.txt"
    truth.write_text(_poses_text(()))
    for suffix, more in ((".csv", ["--names", "error=x", "sigma=s"]), (".txt", ["--truth", str(truth)]), (".npz", [])):
        folder = tmp_path / f"a{suffix}"
        folder.mkdir()
        assert judge_command([str(folder), *more]) == 2
        said = capfd.readouterr().err
        assert said.startswith(f"credence judge: {folder}: it cannot be read")
        assert len(said.splitlines()) == 1
