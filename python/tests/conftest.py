"""What the tests of the package share."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

SCENARIO = """[scenario]
poses = 12
[arms]
controllers = fixed, greedy
"""


def program_words():
    """The program: that of the environment's CREDENCE, else the package's own."""
    return [os.environ["CREDENCE"]] if "CREDENCE" in os.environ else [sys.executable, "-m", "credence"]


@pytest.fixture
def program():
    """Run the program with these words; returns its exit code and what it printed on both streams."""

    def call(*words):
        done = subprocess.run([*program_words(), *map(str, words)], capture_output=True, text=True, check=False)
        return done.returncode, done.stdout, done.stderr

    return call


@pytest.fixture
def scenario(tmp_path):
    path = tmp_path / "small.ini"
    path.write_text(SCENARIO)
    return path
