"""The files of simulated trials: the trials as they come, and the records that are made of them.

Trials are appended to one file, a frame for each chunk, in whatever order they end. A record is made of it in the order
of the trials, so that it has the same bytes whoever computed them and when.
"""

from __future__ import annotations

import contextlib
import fcntl
import json
import os
import time
import warnings
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from credence import InputError
from credence._names import printable
from credence._trials import START, Arms, Array, Failure, Frame, frame_at, frame_size, framed, metric

FORMAT = "credence trials 1"


def _description(seed: int, arms: Arms, batch: int) -> dict[str, Any]:
    """What decides the trials, apart from the function. Of an option that is no plain number or text, its type."""
    told = json.dumps(arms, default=lambda option: f"<{type(option).__name__}>")
    return {"format": FORMAT, "seed": seed, "arms": json.loads(told), "batch": batch}


class Trials:
    """The append-only file of the trials of a study: a frame that describes it, and a frame for each chunk.

    Attributes
    ----------
    done : set of int
        The trials that are there, under every arm.
    """

    def __init__(self, path: Path, seed: int, arms: Arms, batch: int) -> None:
        self.path, self.done = path, set[int]()
        self._places: list[tuple[int, int]] = []  # where each chunk's frame begins, and its length
        is_new = not path.exists()
        self._file = open(path, "x+b" if is_new else "r+b", buffering=0)  # noqa: SIM115
        self._synced = time.monotonic()
        description = _description(seed, arms, batch)
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
        if size == 0:  # it was created and nothing else
            self._write(framed(description, []))
            return
        at = 0
        while at < size:
            length = self._length_at(at, size)
            if length == 0:
                break
            header = self._header(at)
            if at == 0:
                self._refuse_another(header, description)
            else:
                self._places.append((at, length))
                self.done.update(header["numbers"])
            at += length
        if at == 0:
            raise InputError(f"{self.path}: is no file of simulated trials. Remove it, or choose another output.")
        if at < size:
            warnings.warn(
                f"{self.path}: its last {size - at} bytes are no whole chunk; its trials run again.", stacklevel=6
            )
            self._file.truncate(at)
        self._file.seek(at)

    def _length_at(self, at: int, size: int) -> int:
        self._file.seek(at)
        start = self._file.read(START)
        if len(start) < START or at + frame_size(start) > size:
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

    def _write(self, frame: bytes) -> None:
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
        for at, length in self._places:
            self._file.seek(at)
            yield Frame(self._file.read(length))

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


def _pieces(rows: Array) -> Iterator[tuple[slice, slice]]:
    """Stretches of consecutive rows: where they are in the array, and in the file."""
    cuts = np.flatnonzero(np.diff(rows) != 1) + 1
    for start, end in zip([0, *cuts], [*cuts, len(rows)]):
        if end > start:
            yield slice(start, end), slice(int(rows[start]), int(rows[end - 1]) + 1)


class _Record:
    """A record that is being written: of one arm, in the order of the trials, NaN where a trial has no result."""

    def __init__(self, path: Path, layout: dict[str, Any], steps: int, trials: Array, seed: int, arm: str) -> None:
        import h5py

        self.file, self.trials = h5py.File(path, "w"), trials
        attributes = self.file.attrs
        attributes["record_version"] = 2
        attributes["seed"] = np.uint64(seed)
        attributes["arm"] = arm
        texts = layout["texts"]
        for name in sorted(texts["texts"]):
            attributes[name] = texts["texts"][name]
        for name in sorted(texts["lists"]):
            attributes[name] = ", ".join(" ".join(entry) for entry in texts["lists"][name])
        self.file.create_dataset("trial", data=trials, track_times=False)
        for name, dtype, shape in layout["form"]:
            whole = (len(trials), *([steps] if shape else []), *shape[1:])
            fill, kind = (steps, "i8") if name == "steps" else (np.nan, dtype)
            self.file.create_dataset(name, whole, kind, fillvalue=fill, track_times=False)
        for place, dimension in texts["dimensions"].items():
            self.file[place].attrs["dimension"] = dimension

    def add(self, segment: dict[str, Any], arrays: Mapping[str, Array]) -> None:
        kept = np.isin(segment["trials"], self.trials)
        rows = np.searchsorted(self.trials, np.array(segment["trials"])[kept])
        for name, array in arrays.items():
            dataset, chosen = self.file[name], array[kept]
            for here, there in _pieces(rows):
                if array.ndim == 1:
                    dataset[there] = chosen[here]
                else:
                    dataset[there, : array.shape[1]] = chosen[here]

    def finish(self, failures: Mapping[int, Failure]) -> None:
        import h5py

        if failures:
            said = [failures[trial].reason if trial in failures else "" for trial in self.trials.tolist()]
            self.file.create_dataset("failure", data=said, dtype=h5py.string_dtype(), track_times=False)
        self.file.close()


def write_records(
    trials: Trials, paths: Mapping[str, Path], numbers: Array, seed: int, lost: list[Failure]
) -> list[Failure]:
    """Write the record of each arm, and return the trials that failed.

    Parameters
    ----------
    trials : Trials
    paths : dict of Path
        The file of each arm. One that is there is replaced at once.
    numbers : array [trial]
        The trials that the records have, in increasing order.
    seed : int
    lost : list of Failure
        Trials that no worker could finish.
    """
    layouts: dict[str, dict[str, Any]] = {}
    segments: dict[str, list[dict[str, Any]]] = {arm: [] for arm in paths}
    wanted = set(numbers.tolist())
    for header in trials.headers():
        for segment in header["segments"]:
            if wanted.isdisjoint(segment["trials"]):
                continue
            arm = segment["arm"]
            segments[arm].append(segment)
            if arm not in layouts or segment["trials"][0] < layouts[arm]["trials"][0]:
                layouts[arm] = segment
    failures = {(one.arm, one.trial): one for one in [*trials.failures(), *lost] if one.trial in wanted}
    steps, misfits = {}, set()
    for arm, layout in layouts.items():
        lengths = [0]
        for segment in segments[arm]:
            why = _difference(layout, segment)
            if why:
                misfits.add((arm, segment["trials"][0]))
                for trial in wanted.intersection(segment["trials"]):
                    failures[arm, trial] = Failure(arm, trial, f"it is of another form than the first run: {why}")
            else:
                lengths += [shape[0] for _, _, shape in segment["form"] if shape]
        steps[arm] = max(lengths)
    temporary = {arm: path.with_name(f".{path.name}.part") for arm, path in paths.items()}
    try:
        records = {
            arm: _Record(temporary[arm], layout, steps[arm], numbers, seed, arm) for arm, layout in layouts.items()
        }
        for frame in trials.frames():
            for segment, arrays in frame.segments():
                if (segment["arm"], segment["trials"][0]) not in misfits and segment["arm"] in records:
                    records[segment["arm"]].add(segment, arrays)
        for arm, record in records.items():
            record.finish({trial: one for (of, trial), one in failures.items() if of == arm})
            os.replace(temporary[arm], paths[arm])
    finally:
        for path in temporary.values():
            with contextlib.suppress(FileNotFoundError):
                path.unlink()
    return sorted(failures.values(), key=lambda one: (one.trial, one.arm))
