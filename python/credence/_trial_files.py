"""The files of simulated trials: the trials as they come, and the records that are made of them.

Trials are appended to one file, a frame for each chunk, in whatever order they end. A record is made of it in the order
of the trials, so that it has the same bytes whoever computed them and when.
"""

from __future__ import annotations

import fcntl
import hashlib
import json
import math
import mmap
import os
import time
import zlib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from credence import InputError
from credence._calls import note
from credence._errors import printable, wrong
from credence._names import Named
from credence._outputs import whole
from credence._trials import LARGE, MAGIC, START, Arms, Array, Failure, Frame, frame_at, frame_size, framed, metric

FORMAT = "credence trials 2"
BLOCK = 2**20  # bytes that are searched at once
CHUNK = 2**17  # numbers of a dataset that are stored together, at most
BLOCK_OF_TRIALS = 2**25  # bytes of a dataset that are written at once
LEVEL = 1  # of compression: others take longer, and save little


def _sum(data: bytes) -> str:
    return hashlib.blake2b(data, digest_size=8).hexdigest()


def _told(value: Any) -> Any:
    """A value of an option in JSON, so that two are the same where their values are: of arrays their bytes' checksum.

    Of an object it is what its class and its attributes say, or else how it is written.
    """
    if isinstance(value, np.generic):
        value = value.item()
    if value is None or isinstance(value, (bool, int, str)) or (isinstance(value, float) and math.isfinite(value)):
        return value
    if isinstance(value, Mapping):
        return [[_told(key), _told(one)] for key, one in value.items()]
    if isinstance(value, (list, tuple)):
        return [_told(one) for one in value]
    if isinstance(value, (set, frozenset)):
        return sorted(json.dumps(_told(one)) for one in value)
    kind = f"{type(value).__module__}.{type(value).__qualname__}"
    if hasattr(value, "__array__"):
        array = np.asarray(value)
        what = _told(array.ravel().tolist()) if array.dtype.hasobject else _sum(array.tobytes())
        return [kind, array.dtype.str, list(array.shape), what]
    if not isinstance(value, type) and getattr(value, "__dict__", None):
        return [kind, _told(vars(value))]
    said = getattr(value, "__qualname__", None) or repr(value)
    return [kind] if " at 0x" in said else [kind, said]


def _description(seed: int, arms: Arms, batch: int) -> dict[str, Any]:
    """What decides the trials, apart from the function."""
    try:
        told = {arm: {name: _told(value) for name, value in options.items()} for arm, options in arms.items()}
    except RecursionError:
        raise wrong("arms", "an option contains itself", "Give plain values, or arrays") from None
    return {"format": FORMAT, "seed": seed, "arms": told, "batch": batch}


class Trials:
    """The append-only file of the trials of a study: a frame that describes it, and a frame for each chunk.

    Attributes
    ----------
    done : set of int
        The trials that are there, under every arm.
    study : str
        A checksum of seed and arms, which the record has as well: it is the same for any `batch`.
    """

    def __init__(self, path: Path, seed: int, arms: Arms, batch: int) -> None:
        description = _description(seed, arms, batch)
        self.path, self.done, self.study = path, set[int](), _sum(json.dumps([seed, description["arms"]]).encode())
        self._places: list[tuple[int, int]] = []  # where each chunk's frame begins, and its length
        is_new = not path.exists()
        self._file = open(path, "x+b" if is_new else "r+b", buffering=0)  # noqa: SIM115
        self._synced = time.monotonic()
        try:
            self._lock()
            if is_new:
                self._write(framed(description, []))
            else:
                self._read(description)
        except BaseException:
            self._file.close()
            raise

    def _lock(self) -> None:
        try:
            fcntl.lockf(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except (BlockingIOError, PermissionError):
            raise InputError(f"{self.path}: another process adds trials to it. Wait for its end.") from None
        except OSError:  # a file system without locks
            pass

    def _read(self, description: dict[str, Any]) -> None:
        """Find the frames that are there, and cut off one that was not written to its end."""
        size = os.fstat(self._file.fileno()).st_size
        first = framed(description, [])
        if size < len(first) and first.startswith(self._file.read()):  # it was created and nothing else
            self._file.seek(0)
            self._write(first)
            return
        if self._length_at(0, size) == 0:
            why = "is no file of simulated trials, or its beginning is damaged"
            raise InputError(f"{self.path}: {why}. Remove it, or choose another output.")
        self._refuse_another(self._header(0), description)
        at = end = self._length_at(0, size)
        while at < size:
            length = self._length_at(at, size)
            if length:
                if at > end:
                    self._warn_of(f"{at - end} bytes in the middle of it are damaged")
                self._places.append((at, length))
                self.done.update(self._header(at)["numbers"])
                end = at + length
            at = at + length if length else self._next_frame(at + 1, size)
        if end < size:
            self._warn_of(f"its last {size - end} bytes are no whole chunk")
            self._file.truncate(end)

    def _warn_of(self, what: str) -> None:
        note(f"{self.path}: {what}; the trials that were there run again.")

    def _next_frame(self, at: int, size: int) -> int:
        """Where the next frame may begin; the end of the file where none does."""
        while at < size:
            self._file.seek(at)
            found = self._file.read(BLOCK).find(MAGIC)
            if found >= 0:
                return at + found
            at += BLOCK - len(MAGIC) + 1
        return size

    def _length_at(self, at: int, size: int) -> int:
        """The length of the whole frame that begins there; 0 where none does."""
        self._file.seek(at)
        start = self._file.read(START)
        if not start.startswith(MAGIC) or len(start) < START or at + frame_size(start) > size:
            return 0
        return frame_at(memoryview(start + self._file.read(frame_size(start) - START)))

    def _header(self, at: int) -> dict[str, Any]:
        self._file.seek(at + 8)
        length = int.from_bytes(self._file.read(8), "little")
        self._file.seek(at + START)
        header: dict[str, Any] = json.loads(self._file.read(length))
        return header

    def _refuse_another(self, header: dict[str, Any], description: dict[str, Any]) -> None:
        for name, wanted in description.items():
            if header.get(name) != wanted:
                was, now = printable(json.dumps(header.get(name))), printable(json.dumps(wanted))
                why = f"its trials have {name}={was}, not {now}"
                raise InputError(f"{self.path}: {why}. Give the same, or choose another output.")

    def _write(self, frame: bytes | memoryview) -> None:
        left = memoryview(frame)
        try:
            while left:
                left = left[self._file.write(left) :]
        except OSError as error:
            error.filename = str(self.path)
            raise

    def append(self, frame: Frame) -> None:
        """Add a chunk. It is safe from the end of the process at once, and from that of the machine within a second."""
        at = self._file.seek(0, os.SEEK_END)
        try:
            self._write(frame.data)
        except BaseException:
            self._file.truncate(at)
            raise
        self._places.append((at, len(frame.data)))
        self.done.update(frame.header["numbers"])
        if time.monotonic() - self._synced > 1:
            os.fsync(self._file.fileno())
            self._synced = time.monotonic()

    def headers(self) -> Iterator[dict[str, Any]]:
        return (self._header(at) for at, _ in self._places)

    def frames(self) -> Iterator[Frame]:
        """Every chunk; its arrays are read from the file when they are used."""
        if self._places:
            data = memoryview(mmap.mmap(self._file.fileno(), 0, access=mmap.ACCESS_READ))
            yield from (Frame(data[at : at + length]) for at, length in self._places)

    def failures(self) -> list[Failure]:
        """The trials that failed, by trial and arm."""
        found = [Failure(*one) for header in self.headers() for one in header["failures"]]
        return sorted(found, key=lambda one: (one.trial, one.arm))

    def values(self, name: str, arm: str) -> tuple[Array, Array]:
        """A metric of an arm: the trials that have a result [trial], and its values [trial]."""
        trials: list[int] = []
        values: list[float] = []
        for frame in self.frames():
            for segment, arrays in frame.segments():
                if segment["arm"] == arm:
                    trials += segment["trials"]
                    there = segment["values"].get(name)
                    values += metric(name, arrays).tolist() if there is None else there
        order = np.argsort(trials, kind="stable")
        return np.array(trials, dtype=np.int64)[order], np.array(values, dtype=np.float64)[order]

    def close(self) -> None:
        if not self._file.closed:
            os.fsync(self._file.fileno())
            self._file.close()


def _difference(layout: dict[str, Any], segment: dict[str, Any]) -> str:
    """Why runs are not of the same form; empty where they are."""
    mine, other = ({name: (dtype, shape) for name, dtype, shape in one["form"]} for one in (segment, layout))
    first = layout["trials"][0]
    if mine.keys() != other.keys():
        name = min(mine.keys() ^ other.keys())
        return (
            f"{printable(name)} is in {'this' if name in mine else 'that'} run, and not in both (that is trial {first})"
        )
    for name, (dtype, shape) in mine.items():
        if shape[1:] != other[name][1][1:] or dtype != other[name][0]:
            shapes = (f"{np.dtype(one[0]).name} {one[1]}" for one in (mine[name], other[name]))
            return f"{printable(name)} is {' here, and '.join(shapes)} in trial {first}"
        if shape[:1] != other[name][1][:1] and "steps" not in mine:
            remedy = f"Run(..., steps={shape[0]}) says that a run ends there for a reason of its own"
            return f"it has {shape[0]} steps, and trial {first} has {other[name][1][0]}; {remedy}"
    return "" if segment["texts"] == layout["texts"] else f"its groups or names are not those of trial {first}"


def _chunk(shape: tuple[int, ...], trials: int) -> tuple[int, ...]:
    """The chunk of a dataset: of so many trials and at most CHUNK numbers, in parts that are about equally long."""
    room, parts = max(1, CHUNK // trials), []
    for size in shape[:0:-1]:
        parts.append(-(-size // -(-size // min(size, room))))
        room = max(1, room // parts[-1])
    return (trials, *parts[::-1])


def _is_compressible(array: Array) -> bool:
    """Whether compression halves these numbers: those that are missing, and those that are the same in all trials.

    It takes as long as a short trial, so that arrays which are small in each trial are left as they are.
    """
    if array.nbytes < LARGE * len(array):
        return False
    planes = np.ascontiguousarray(array).view(np.uint8).reshape(-1, array.itemsize).T.tobytes()
    return 2 * len(zlib.compress(planes, LEVEL)) < len(planes)


def _set_text(attributes: Any, name: str, text: str) -> None:
    """Texts have a fixed length, because HDF5 keeps others where there are no checksums."""
    import h5py

    data = text.encode() or b" "
    attributes.create(name, data, dtype=h5py.string_dtype("utf-8", len(data)))


def get_text(attributes: Any, name: str) -> str:
    value = attributes[name]
    return value.decode().strip() if isinstance(value, bytes) else str(value)


class _Record:
    """The record of one arm, in the order of the trials, NaN where a trial has no result.

    Every dataset has the checksums of HDF5, and the format of HDF5 1.10 has them for everything else in the file.
    """

    def __init__(self, group: Any, layout: dict[str, Any], steps: int, trials: Array) -> None:
        self.group, self.trials = group, trials
        texts = layout["texts"]
        for name, text in Named(**texts).attributes().items():
            _set_text(group.attrs, name, text)
        self._dimensions = texts["dimensions"]
        self._forms = [
            (name, np.dtype(dtype), ((steps, *shape[1:]) if shape else ()), steps if name == "steps" else np.nan)
            for name, dtype, shape in layout["form"]
        ]
        largest = max(dtype.itemsize * math.prod(shape) for _, dtype, shape, _ in self._forms)
        self._block = max(1, min(len(trials), CHUNK, BLOCK_OF_TRIALS // max(1, largest)))
        self._block = -(-len(trials) // -(-len(trials) // self._block))  # in parts that are about equally long

    def write(self, segments: list[tuple[dict[str, Any], dict[str, Array]]]) -> None:
        """Write what the segments of its arm have, a block of trials at a time."""
        self._create("trial", self.trials)
        places = [np.searchsorted(self.trials, segment["trials"]) for segment, _ in segments]
        for start in range(0, len(self.trials), self._block):
            end = min(start + self._block, len(self.trials))
            there = [
                (rows[inside] - start, arrays, inside)
                for rows, (_, arrays) in zip(places, segments)
                if rows[0] < end and rows[-1] >= start
                for inside in [np.flatnonzero((rows >= start) & (rows < end))]
            ]
            for name, dtype, shape, fill in self._forms:
                block = np.full((end - start, *shape), fill, np.int64 if name == "steps" else dtype)
                for rows, arrays, inside in there:
                    array = arrays[name]
                    block[(rows, *(slice(size) for size in array.shape[1:]))] = array[inside]
                if start == 0:
                    self._create(name, block)
                else:
                    self.group[name].resize(end, axis=0)
                    self.group[name][start:end] = block
        for place, dimension in self._dimensions.items():
            self.group[place].attrs["dimension"] = dimension

    def _create(self, name: str, first: Array) -> None:
        """Make a dataset, which grows, of its first block."""
        chunk = _chunk(first.shape, min(len(first), self._block))
        packed = {"compression": "gzip", "compression_opts": LEVEL, "shuffle": True} if _is_compressible(first) else {}
        self.group.create_dataset(
            name, data=first, chunks=chunk, maxshape=(len(self.trials), *first.shape[1:]), fletcher32=True,
            track_times=False, **packed,
        )  # fmt: skip

    def write_failures(self, failures: Mapping[int, Failure]) -> None:
        import h5py

        if failures:
            said = [failures[trial].reason.encode() if trial in failures else b"" for trial in self.trials.tolist()]
            kind = h5py.string_dtype("utf-8", max(map(len, said)))
            self._create("failure", np.array(said, dtype=kind))


def write_records(
    trials: Trials, path: Path, arms: Sequence[str] | None, numbers: Array, seed: int, lost: list[Failure]
) -> list[Failure]:
    """Write the record of each arm, and return the trials that failed.

    Parameters
    ----------
    trials : Trials
    path : path
        The file, which is replaced at once where it is there.
    arms : list of str
        The arms, each of which gets a group; None if there is one without a name, whose record is the file itself.
    numbers : array [trial]
        The trials that the records have, in increasing order.
    seed : int
    lost : list of Failure
        Trials that no worker could finish.
    """
    import h5py

    layouts: dict[str, dict[str, Any]] = {}
    segments: dict[str, list[tuple[dict[str, Any], dict[str, Array]]]] = {}
    wanted = set(numbers.tolist())
    for frame in trials.frames():
        for segment, arrays in frame.segments():
            kept = np.array([trial in wanted for trial in segment["trials"]])
            if not kept.any():
                continue
            if not kept.all():
                segment = {**segment, "trials": np.array(segment["trials"])[kept].tolist()}
                arrays = {name: array[kept] for name, array in arrays.items()}
            arm = segment["arm"]
            segments.setdefault(arm, []).append((segment, arrays))
            if arm not in layouts or segment["trials"][0] < layouts[arm]["trials"][0]:
                layouts[arm] = segment
    failures = {(one.arm, one.trial): one for one in [*trials.failures(), *lost] if one.trial in wanted}
    fitting: dict[str, list[tuple[dict[str, Any], dict[str, Array]]]] = {}
    for arm, layout in layouts.items():
        for segment, arrays in segments[arm]:
            why = _difference(layout, segment)
            for trial in segment["trials"] if why else ():
                failures[arm, trial] = Failure(arm, trial, f"it is of another form than the first run: {why}")
            if not why:
                fitting.setdefault(arm, []).append((segment, arrays))
    in_order = sorted(failures.values(), key=lambda one: (one.trial, one.arm))
    if not layouts:
        return in_order
    with whole(path) as part, h5py.File(part, "w", libver=("v110", "v110")) as file:
        file.attrs["record_version"] = 2
        file.attrs["seed"] = np.uint64(seed)  # and of each arm, which is a record by itself
        _set_text(file.attrs, "study", trials.study)
        if arms is not None:
            _set_text(file.attrs, "arms", ", ".join(arm for arm in arms if arm in layouts))
        for arm, layout in layouts.items():
            lengths = [shape[0] for segment, _ in fitting[arm] for _, _, shape in segment["form"] if shape]
            group = file if arms is None else file.create_group(arm)
            group.attrs["seed"] = np.uint64(seed)
            _set_text(group.attrs, "arm", arm)
            record = _Record(group, layout, max(lengths, default=0), numbers)
            record.write(fitting[arm])
            record.write_failures({trial: one for (of, trial), one in failures.items() if of == arm})
    return in_order
