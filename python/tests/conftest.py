"""What the tests of the package share."""

from __future__ import annotations

import contextlib
import os
import pathlib
import re
import subprocess
import sys
import textwrap
import time

import pytest

import credence

HERE = pathlib.Path(__file__).parent
PATIENCE = 120  # s, after which a process that should have ended is hung
SCENARIO = """[scenario]
poses = 12
[arms]
controllers = fixed, greedy
"""


def refusal(call, *given, raises=credence.InputError, **named):
    """The message with which a call is refused, which is one line."""
    with pytest.raises(raises) as raised:
        call(*given, **named)
    said = str(raised.value)
    assert "\n" not in said
    return said


def refused(expression, call, *given, **named):
    """A call is refused with a message in which an expression is found."""
    said = refusal(call, *given, **named)
    assert re.search(expression, said), said


def environment(*folders):
    """That of a process which finds the modules of the tests, and those in further folders."""
    paths = [*map(str, folders), str(HERE), *filter(None, [os.environ.get("PYTHONPATH")])]
    return {**os.environ, "PYTHONPATH": os.pathsep.join(paths)}


def python(*words, **options):
    """Run Python with these words, or a script as ``-c``; as subprocess.run of it with its streams."""
    told = [sys.executable, *(textwrap.dedent(str(word)) for word in words)]
    given = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True, "timeout": PATIENCE}
    return subprocess.run(told, check=False, **{**given, "env": environment(), **options})


@contextlib.contextmanager
def started(*words, wait_for, least=1, **options):
    """A process of Python as soon as it has written so many bytes of a file; it is killed in the end."""
    told = [sys.executable, *(textwrap.dedent(str(word)) for word in words)]
    path, end = pathlib.Path(wait_for), time.monotonic() + PATIENCE
    with subprocess.Popen(told, **{"text": True, "env": environment(), **options}) as process:
        try:
            while not (path.exists() and path.stat().st_size >= least):
                assert process.poll() is None, process.communicate()
                assert time.monotonic() < end
                time.sleep(0.005)
            yield process
        finally:
            process.kill()


@pytest.fixture(autouse=True)
def _in_a_folder_of_its_own(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def program():
    """Run the program of the environment's CREDENCE, else the package's own, with these words; returns its exit code
    and what it printed on both streams."""

    def call(*words):
        told = [os.environ["CREDENCE"]] if "CREDENCE" in os.environ else [sys.executable, "-m", "credence"]
        done = subprocess.run([*told, *map(str, words)], capture_output=True, text=True, check=False)
        return done.returncode, done.stdout, done.stderr

    return call


@pytest.fixture
def scenario(tmp_path):
    path = tmp_path / "small.ini"
    path.write_text(SCENARIO)
    return path
