"""What the program says of a file: through the compiled module, or where that is missing through the program itself."""

from __future__ import annotations

import functools
import json
import os
import pathlib
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from typing import Any

from .._file import parted


class NoProgram(RuntimeError):
    """Neither the compiled module nor the program is there, or it refused the file."""


def find(asked: str | None = None) -> str | None:
    """The program: the one asked for, that of a checkout's build, that which this was installed with, or that on the
    PATH; None where there is none."""
    if asked:
        return asked
    above = pathlib.Path(__file__).resolve().parents
    built = [path for path in (above[3] / "build" / "credence", above[5] / "bin" / "credence") if path.is_file()]
    return str(built[0]) if built else shutil.which("credence")


def said(command: str, arguments: Sequence[str], options: Mapping[str, object], program: str | None = None) -> Any:
    """What a command prints as JSON."""
    options = {**options, "format": "json"}
    if not program:
        try:
            from credence import _core
        except ImportError:
            pass
        else:
            return json.loads(_core.command(command, arguments, options, None)[1])
    if (found := find(program)) is None:
        raise NoProgram("the program credence is not found. Install the package with its compiled module, or name the "
                        "program.")
    words = [f"--{name}" if value is True else f"--{name}={value}" for name, value in options.items()]
    try:
        done = subprocess.run([found, command, *arguments, *words], capture_output=True, text=True)
    except OSError as problem:
        raise NoProgram(f"{problem}.") from None
    if done.returncode != 0:
        raise NoProgram(done.stderr.strip())
    return json.loads(done.stdout)


def report(
    path: str, program: str | None = None, records: Sequence[str] = ()
) -> dict[tuple[str, str], dict[str, Any]]:
    """{(scenario, arm): its part of the report}; of records what is judged of them."""
    words = ("judge", *records) if records else ("report", path)
    return _report(words, tuple(os.stat(parted(one)[0]).st_mtime_ns for one in records or [path]), program)


@functools.lru_cache(maxsize=2)
def _report(
    words: tuple[str, ...], _: tuple[int, ...], program: str | None
) -> dict[tuple[str, str], dict[str, Any]]:
    parts = said(words[0], words[1:], {"quiet": True} if words[0] == "judge" else {}, program)
    return {(part["scenario"], part["arm"]): part for part in parts}


def replay(path: str, scenario: str, arm: str, trial: int, output: str, program: str | None = None) -> None:
    """Writes the trajectory of one trial."""
    said("replay", [path], {"scenario": scenario, "arm": arm, "trial": trial, "output": output}, program)
