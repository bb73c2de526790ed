"""One trial of somebody's filter: what it returns, where its random numbers come from, and chunks of trials as bytes.

This is what a worker needs. A chunk of trials goes from a worker to the study, and into the file that keeps it, as one
frame of bytes with a checksum.
"""

from __future__ import annotations

import contextlib
import faulthandler
import hashlib
import json
import math
import os
import signal
import struct
import threading
import time
import traceback
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from credence import InputError, _arrays, _core
from credence._errors import printable
from credence._names import Named
from credence._record import Run
from credence._streams import Streams

Array = npt.NDArray[Any]
Arms = dict[str, dict[str, Any]]

LARGE = 2**16  # bytes of a trial, from which on it is worth while to store an array in less room
BATCH = 256  # trials that a function of many generators gets at once
MAGIC = b"crtrial1"
_SUM = 16  # bytes of a frame's checksum
START = len(MAGIC) + 16  # bytes of a frame before its parts: its mark, and two lengths


def seed_sequence(seed: int, trial: int) -> np.random.SeedSequence:
    """NumPy's hash of a seed and a trial: what ``SeedSequence(seed).spawn(n)[trial]`` is."""
    return np.random.SeedSequence(seed, spawn_key=(trial,))


def generator(seed: int, trial: int) -> Streams:
    """The generator of a trial, a pure function of seed and trial, with named streams.

    It is ``Generator(Philox(key=key))`` with the two words ``key = SeedSequence(seed, spawn_key=(trial,))
    .generate_state(2, numpy.uint64)``. ``rng.spawn`` gives generators that are functions of seed and trial, too.
    """
    return Streams(seed_sequence(seed, trial))


class TimeReached(BaseException):
    """A trial took longer than it may; no ``except Exception`` of the trial itself hides it."""


class Failure(NamedTuple):
    """A trial that has no result.

    Attributes
    ----------
    arm : str
    trial : int
    reason : str
        One sentence, such as ``ValueError: x is singular``.
    traceback : str
        That of the exception, from the function on; empty where there is none.
    """

    arm: str
    trial: int
    reason: str
    traceback: str = ""


@dataclass(frozen=True)
class Work:
    """What a worker must know to run trials."""

    run: Callable[..., Any]
    arms: Arms
    seed: int
    batch: int  # generators that the function gets at once; 0: one generator by itself
    timeout: float | None  # of a trial (s)
    metrics: tuple[str, ...] = ()  # numbers that the study follows while it runs
    ends_hung_process: bool = False  # whether the process is the study's own, and may be ended


@contextlib.contextmanager
def _raised_in_this_thread(seconds: float) -> Iterator[None]:
    """Raise TimeReached in a thread that gets no signals, as those of Dask; a call of C code is not interrupted."""
    import ctypes

    running, lock, thread = [True], threading.Lock(), threading.get_ident()

    def end() -> None:
        with lock:
            if running:
                ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(thread), ctypes.py_object(TimeReached))

    timer = threading.Timer(seconds, end)
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        with lock:
            running.clear()
        timer.cancel()


@contextlib.contextmanager
def limited(seconds: float | None, ends_process: bool) -> Iterator[None]:
    """Raise TimeReached in what is done within, where it takes longer.

    Where that does not help, as in a loop of C code, a process that may be ended is ended after twice the time.
    """
    if seconds is None:
        yield
        return
    if threading.current_thread() is not threading.main_thread():
        with _raised_in_this_thread(seconds):
            yield
        return

    def reached(*_: object) -> None:
        raise TimeReached

    before = signal.signal(signal.SIGALRM, reached)
    if ends_process:
        with open(os.devnull, "w") as nowhere:
            faulthandler.dump_traceback_later(2 * seconds + 1, exit=True, file=nowhere)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
        if ends_process:
            faulthandler.cancel_dump_traceback_later()


def _kept(array: Array, as_double: bool) -> Array:
    """A copy, because the function may use its array again: doubles, singles and halves as they are, else doubles."""
    is_kept = array.dtype.kind == "f" and array.dtype.itemsize <= 8 and not as_double
    return np.array(array, dtype=array.dtype.newbyteorder("=") if is_kept else np.float64)


def _shape(array: Array) -> str:
    return str(list(array.shape))


class KnownNames:
    """Names, groups and dimensions of runs; they are the same in most, and worked out once."""

    def __init__(self) -> None:
        self._given: Any = None
        self._taken = Named({}, {}, {})

    def of(self, run: Run) -> dict[str, Any]:
        given = run.texts, run.nees is None, [*(run.group_nees or ())]
        with contextlib.suppress(ValueError):  # of arrays, which have no single answer
            if given == self._given:
                return self._taken._asdict()
        self._given, self._taken = given, run.named()
        return self._taken._asdict()


class Taken(NamedTuple):
    """One run or many as plain arrays, with what must be the same in all runs of an arm."""

    arrays: dict[str, Array]  # [step, ...], those of columns and of steps []
    texts: dict[str, Any]


def _checked_steps(arrays: Mapping[str, Array], behind: int) -> int:
    """How many steps the arrays have; InputError where they do not fit each other."""
    first = next(iter(arrays))
    steps, sizes = (*arrays[first].shape, 0)[behind], {"error": 0, "innovation": 0}
    for name, array in arrays.items():
        last = name.rsplit("/", 1)[-1]
        ranks = [1 + behind_it for behind_it in _arrays.behind_steps(name)]
        if array.ndim - behind not in ranks:
            expected = " or ".join(map(str, ranks))
            why = f"is {_shape(array)}, and has {array.ndim - behind} dimensions in place of {expected}"
            raise InputError(f"{printable(name)}: {why}. Give an array whose first dimension is that of the steps.")
        if array.shape[behind] != steps:
            why = f"is {_shape(array)}, and {printable(first)} is {_shape(arrays[first])}"
            raise InputError(f"{printable(name)}: {why}. Give the same steps of both.")
        kind = "innovation" if last.startswith("innovation") else "error"
        if "/" not in name and last in ("error", "covariance", "innovation", "innovation_covariance"):
            size = sizes[kind] = sizes[kind] or array.shape[-1]
            if {size} != set(array.shape[behind + 1 :]):
                shapes = f"is {_shape(array)}, and {kind} has {size} components"
                raise InputError(f"{printable(name)}: {shapes}. Give arrays that fit each other.")
    return int(steps)


def take(result: object, known: KnownNames, batch: int = 0) -> Taken:
    """The arrays of what the function returned; InputError or TypeError where it cannot be used."""
    if not isinstance(result, Run):
        raise TypeError(f"the function returned {type(result).__name__}, not a credence.Run")
    behind, of_steps = 1 if batch else 0, result.arrays
    columns = {f"column/{name}": value for name, value in (result.columns or {}).items()}
    given = {**of_steps, **columns, **({} if result.steps is None else {"steps": result.steps})}
    if batch:
        arrays = _arrays.of_many_runs(given)
    else:
        arrays = {name: _arrays.of_one_run(name, array) for name, array in given.items()}
    arrays = {name: _kept(array, name in columns or name == "steps") for name, array in arrays.items()}
    of_steps = {name: array for name, array in arrays.items() if name in of_steps}
    judged = {"error", "estimate", "nees", "innovation"}
    if not of_steps.keys() & judged and not any(name.startswith("group/") for name in of_steps):
        raise InputError("a Run has neither error, nor truth and estimate, nor nees, nor innovation. Give one of them.")
    steps = _checked_steps(of_steps, behind)
    if steps == 0:
        raise InputError("a Run has no steps. Give one at least.")
    for name in arrays.keys() - of_steps.keys():
        if arrays[name].ndim != behind or "/" in name[7:]:
            raise InputError(f"{printable(name)}: is no number of a trial, or its name has a slash. Give a number.")
    if batch and {len(array) for array in arrays.values()} != {batch}:
        found = ", ".join(f"{printable(name)} {_shape(array)}" for name, array in arrays.items())
        raise InputError(f"the function got {batch} generators and returned {found}. Give each a leading dimension.")
    if "steps" in arrays and not np.all(
        (arrays["steps"] >= 1) & (arrays["steps"] <= steps) & (arrays["steps"] % 1 == 0)
    ):
        raise InputError(f"steps: is not a whole number from 1 to {steps}. Give how many of its steps the run has.")
    return Taken(arrays, known.of(result))


def _sentence(error: BaseException) -> str:
    """The exception in one line."""
    said = " ".join(str(error).split())
    return f"{type(error).__name__}: {said}"[:500] if said else type(error).__name__


def _traceback(error: BaseException) -> str:
    """The traceback from the function on, without the frames of this module."""
    frames = error.__traceback__
    while frames is not None and frames.tb_frame.f_globals.get("__name__") == __name__:
        frames = frames.tb_next
    return "".join(traceback.format_exception(type(error), error, frames))


def _refusals(arrays: Mapping[str, Array], texts: Mapping[str, Any]) -> dict[int, str]:
    """What `judge` would refuse of single trials: {place in the arrays: its message}."""
    def refusal(part: slice) -> str:
        try:
            described = {name: _arrays.described(array[part]) for name, array in arrays.items()}
            _core.check(described, texts["texts"], texts["lists"], texts["dimensions"])
        except InputError as error:
            return str(error).replace("trial 0, step", "step").replace("(both counted from 0)", "(counted from 0)")
        return ""

    if not refusal(slice(None)):
        return {}
    found = {i: refusal(slice(i, i + 1)) for i in range(len(next(iter(arrays.values()))))}
    return {i: said for i, said in found.items() if said}


def _is_constant(array: Array) -> bool:
    """Whether it is the same in all of several trials, bit for bit, and large: then a frame has it once."""
    if len(array) < 2 or array.nbytes < LARGE * len(array):
        return False
    rows = array.reshape(len(array), -1).view(np.uint8)
    return all(np.array_equal(row, rows[0]) for row in rows[1:])


class Chunk:
    """Collects trials: those of the same form become one segment, whose arrays have a dimension of trials.

    Attributes
    ----------
    segments : list of dict
    failures : list of Failure
    refused : dict of str
        {arm: why `judge` would refuse its trial 0}.
    """

    def __init__(self) -> None:
        self.segments: list[dict[str, Any]] = []
        self.failures: list[Failure] = []
        self.refused: dict[str, str] = {}

    def add(self, arm: str, trial: int, run: Taken) -> None:
        form = [[name, array.dtype.str, list(array.shape)] for name, array in run.arrays.items()]
        last = next((one for one in reversed(self.segments) if one["arm"] == arm), None)
        if last is None or last["form"] != form or last["texts"] != run.texts:
            last = {"arm": arm, "form": form, "texts": run.texts, "trials": [], "parts": []}
            self.segments.append(last)
        last["trials"].append(trial)
        last["parts"].append(list(run.arrays.values()))

    def finish(self) -> None:
        """Make arrays of the segments. A trial that `judge` would refuse has failed."""
        for segment in self.segments:
            trials, parts = segment["trials"], zip(*segment.pop("parts"))
            arrays = {name: np.array(each) for (name, _, _), each in zip(segment["form"], parts)}
            refusals = _refusals(arrays, segment["texts"])
            for i, said in refusals.items():
                self.failures.append(Failure(segment["arm"], trials[i], f"InputError: {said}"[:500]))
                if trials[i] == 0:
                    self.refused[segment["arm"]] = said
            kept = [i for i in range(len(trials)) if i not in refusals]
            segment["trials"] = [trials[i] for i in kept]
            segment["arrays"] = {name: array[kept] for name, array in arrays.items()} if refusals else arrays
        self.segments = [segment for segment in self.segments if segment["trials"]]

    def frame(
        self, numbers: Sequence[int], seconds: float, metrics: Sequence[str], repeats: Mapping[str, bool]
    ) -> bytes:
        header: dict[str, Any] = {
            "numbers": list(numbers),
            "seconds": seconds,
            "repeats": dict(repeats),
            "refused": self.refused,
            "segments": [],
        }
        body: list[bytes] = []
        for segment in self.segments:
            arrays = segment["arrays"]
            once = [name for name, array in arrays.items() if _is_constant(array)]
            body += [(array[0] if name in once else array).tobytes() for name, array in arrays.items()]
            values = {name: metric(name, arrays).tolist() for name in metrics}
            kept = {key: segment[key] for key in ("arm", "form", "texts", "trials")}
            header["segments"].append({**kept, "once": once, "values": values})
        header["failures"] = [list(one) for one in self.failures]
        return framed(header, body)


def collected(work: Work, numbers: Sequence[int], keep: Sequence[int]) -> Chunk:
    """Run trials under every arm. With batches `numbers` is one whole batch, of which those in `keep` are kept."""
    chunk, texts = Chunk(), {arm: KnownNames() for arm in work.arms}
    for group in [numbers] if work.batch else [[number] for number in numbers]:
        for arm, options in work.arms.items():
            generators = [generator(work.seed, number) for number in group]
            try:
                with limited(work.timeout, work.ends_hung_process):
                    result = work.run(generators if work.batch else generators[0], **options)
                taken = take(result, texts[arm], len(group) if work.batch else 0)
            except (Exception, SystemExit, TimeReached) as error:
                is_late = isinstance(error, TimeReached)
                reason = f"it took longer than timeout={work.timeout:g} s" if is_late else _sentence(error)
                told = _traceback(error)
                chunk.failures += [Failure(arm, number, reason, told) for number in group if number in keep]
                continue
            for i, number in enumerate(group):
                if not work.batch:
                    chunk.add(arm, number, taken)
                elif number in keep:
                    chunk.add(arm, number, Taken({name: array[i] for name, array in taken.arrays.items()}, taken.texts))
    chunk.finish()
    return chunk


def run_chunk(work: Work, numbers: Sequence[int], keep: Sequence[int], twice: bool = False) -> bytes:
    """Run a chunk of trials, and return it as a frame; with `twice` it says whether a second time gives the same."""
    begun = time.perf_counter()
    chunk = collected(work, numbers, keep)
    seconds = time.perf_counter() - begun
    repeats = {}
    if twice:
        again = collected(work, numbers, keep)
        repeats = {arm: same(chunk.frame([], 0, (), {}), again.frame([], 0, (), {}), arm) for arm in work.arms}
    return chunk.frame(keep, seconds, work.metrics, repeats)


def framed(header: Mapping[str, Any], body: Sequence[bytes]) -> bytes:
    """A frame: its mark, the lengths of both parts, both parts, and the BLAKE2b checksum of all of that."""
    text = json.dumps(header).encode()
    parts = [MAGIC, struct.pack("<QQ", len(text), sum(map(len, body))), text, *body]
    total = hashlib.blake2b(digest_size=_SUM)
    for part in parts:
        total.update(part)
    return b"".join([*parts, total.digest()])


def frame_size(start: bytes) -> int:
    """The length of the frame that begins with these START bytes, whether it is whole or not."""
    head, body = struct.unpack_from("<QQ", start, len(MAGIC))
    return START + int(head) + int(body) + _SUM


class Frame:
    """A frame that was read: its header, and its arrays when they are asked for."""

    def __init__(self, data: bytes | memoryview) -> None:
        self.data = data
        length, self._body = struct.unpack_from("<Q", data, len(MAGIC))[0], START
        self.header: dict[str, Any] = json.loads(bytes(data[self._body : self._body + length]))
        self._body += length

    def segments(self) -> Iterator[tuple[dict[str, Any], dict[str, Array]]]:
        """Each segment with its arrays [trial, ...]."""
        at = self._body
        for segment in self.header["segments"]:
            arrays = {}
            for name, dtype, shape in segment["form"]:
                whole = (len(segment["trials"]), *shape)
                stored = (1, *shape) if name in segment["once"] else whole
                array = np.frombuffer(self.data, dtype, math.prod(stored), at).reshape(stored)
                arrays[name] = np.broadcast_to(array, whole)
                at += array.nbytes
            yield segment, arrays

    def failures(self) -> list[Failure]:
        return [Failure(*one) for one in self.header["failures"]]


def frame_at(data: memoryview) -> int:
    """The length of the whole frame with which the bytes begin; 0 where there is none."""
    if len(data) < START + _SUM or bytes(data[: len(MAGIC)]) != MAGIC:
        return 0
    size = frame_size(bytes(data[:START]))
    if len(data) < size:
        return 0
    end = size - _SUM
    is_whole = hashlib.blake2b(data[:end], digest_size=_SUM).digest() == bytes(data[end:size])
    return size if is_whole else 0


def is_frame(data: object) -> bool:
    """Whether this is a whole frame and nothing else: what came from a worker as it was sent."""
    return isinstance(data, bytes) and len(data) > 0 and frame_at(memoryview(data)) == len(data)


def same(first: bytes | memoryview, second: bytes | memoryview, arm: str, trials: Sequence[int] | None = None) -> bool:
    """Whether two frames say the same of an arm's trials, bit for bit; of failures only that they are failures."""

    def told(data: bytes | memoryview) -> dict[int, Any]:
        frame = Frame(data)
        found: dict[int, Any] = {one.trial: "failed" for one in frame.failures() if one.arm == arm}
        for segment, arrays in frame.segments():
            for i, trial in enumerate(segment["trials"] if segment["arm"] == arm else ()):
                found[trial] = [segment["form"], segment["texts"], [array[i].tobytes() for array in arrays.values()]]
        return {trial: one for trial, one in found.items() if trials is None or trial in trials}

    return told(first) == told(second)


def metric(name: str, arrays: Mapping[str, Array]) -> Array:
    """A number a trial [trial]: ``nees_ratio``, the NEES of all steps over their dimensions, or a column.

    NaN where a covariance is singular, and everywhere if the arrays do not have it.
    """
    if name != "nees_ratio":
        column = arrays.get(f"column/{name}")
        return np.full(len(next(iter(arrays.values()))), np.nan) if column is None else column
    if "error" not in arrays or "covariance" not in arrays:
        return np.full(len(next(iter(arrays.values()))), np.nan)
    error, covariance = (arrays[name].astype(np.float64, copy=False) for name in ("error", "covariance"))
    there = ~np.isnan(error)
    if "steps" in arrays:
        there &= (np.arange(error.shape[1]) < arrays["steps"][:, None])[..., None]
    if covariance.ndim == 3:
        terms = np.where(there, error**2 / np.where(there, covariance, 1), 0)
    else:
        if not there.all():  # a component that is not there is one of its own, with an error of 0
            both = there[..., :, None] & there[..., None, :]
            covariance, error = np.where(both, covariance, np.eye(error.shape[-1])), np.where(there, error, 0)
        terms = error * _solved(covariance, error)
    sizes = there.sum(axis=(1, 2))
    with np.errstate(all="ignore"):
        return np.where(sizes > 0, terms.reshape(len(terms), -1).sum(axis=1) / sizes, np.nan)


def _solved(covariance: Array, error: Array) -> Array:
    """P^-1 e of each trial and step [trial, step, n]; NaN in a trial with a singular P."""
    try:
        return np.asarray(np.linalg.solve(covariance, error[..., None])[..., 0])
    except np.linalg.LinAlgError:
        if len(error) == 1:
            return np.full_like(error, np.nan)
        return np.concatenate([_solved(covariance[i : i + 1], error[i : i + 1]) for i in range(len(error))])
