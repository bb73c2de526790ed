"""Shards of a study as tasks on an executor."""

from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any

from credence import Failure, _core
from credence._calls import progress_bar
from credence._planners import note_failures
from credence._workers import TRIES, Workers

Scenarios = list[tuple[str, str]]  # the name and the text of each file


def run_shard(shared: tuple[Scenarios, dict[str, object], dict[str, Any]], shard: int, shards: int) -> bytes:
    """Run a shard in a folder of its own, and return its results file: workers need not share a disk."""
    scenarios, options, planners = shared
    with tempfile.TemporaryDirectory(prefix="credence-") as folder:
        paths = []
        for i, (name, text) in enumerate(scenarios):
            path = Path(folder, str(i), name)
            path.parent.mkdir()
            path.write_text(text, encoding="utf-8")
            paths.append(str(path))
        part = os.path.join(folder, "part.h5")
        of_shard = {**options, "shard": f"{shard}/{shards}", "output": part, "quiet": True}
        code, _, said = _core.command("run", paths, of_shard, None, planners)
        note_failures(planners)
        if code != 0:
            raise Failure(f"shard {shard} of {shards}: it was stopped ({said.strip()}). Run it again.")
        return Path(part).read_bytes()


@contextlib.contextmanager
def shards_of(
    paths: Sequence[str], options: Mapping[str, object], executor: Any, shards: int | None, progress: bool | None,
    planners: Mapping[str, Any] = MappingProxyType({}),
) -> Iterator[list[str]]:  # fmt: skip
    """Run all shards of a study, and yield the paths of their results files for as long as they are needed.

    Parameters
    ----------
    paths : list of str
        Scenario files.
    options : dict
        Options of ``credence run``.
    executor : int or executor
    shards : int
        How many; by default as many as the executor has workers.
    progress : bool
        Whether a bar counts the shards.
    planners : dict
        As `_core.command` takes them; what fails in single trials is said by the worker's process.
    """
    _core.command("show", paths[:1], {}, None)  # a file that cannot be read is refused here
    scenarios = [(os.path.basename(path), Path(path).read_text(encoding="utf-8")) for path in paths]
    workers: Workers[int] = Workers(executor, run_shard, (scenarios, dict(options), dict(planners)))
    try:
        count = shards or workers.count
        left = list(reversed(range(count)))
        with tempfile.TemporaryDirectory(prefix="credence-") as folder, progress_bar(progress) as draw:
            parts = [os.path.join(folder, f"part-{shard}.h5") for shard in range(count)]
            results = workers.results(lambda: left.pop() if left else None, lambda shard: (shard, count))
            for done, (shard, data) in enumerate(results, start=1):
                if data is None:
                    raise Failure(f"shard {shard} of {count}: its worker was lost {TRIES} times. Look for its memory.")
                Path(parts[shard]).write_bytes(data)
                if draw is not None:
                    draw(done, count, "shards")
            yield parts
    finally:
        workers.close()
