"""The records of experiments/known: what is true of each is what credence finds."""

from __future__ import annotations

import csv
import subprocess
import sys
from pathlib import Path

import pytest

import credence

SCRIPT = Path(__file__).parents[2] / "experiments" / "known" / "known.py"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path: Path = tmp_path_factory.mktemp("known")
    subprocess.run([sys.executable, str(SCRIPT), str(path)], check=True)
    return path


def test_records_are_small_and_the_same_for_everybody(folder: Path, tmp_path: Path) -> None:
    assert sum(path.stat().st_size for path in folder.iterdir()) < 700_000
    subprocess.run([sys.executable, str(SCRIPT), str(tmp_path)], check=True)
    for path in folder.iterdir():
        assert path.read_bytes() == (tmp_path / path.name).read_bytes()


@pytest.mark.filterwarnings("ignore")
def test_what_is_wrong_is_found(folder: Path) -> None:
    with open(folder / "truth.csv", newline="") as file:
        truths = list(csv.DictReader(file))
    assert len(truths) == 27
    for truth in truths:
        verdict = credence.judge(str(folder / f"{truth['record']}.h5"))
        refuted = verdict.verdict not in ("consistent", "undecided") or bool(verdict["cautions"])
        assert refuted == (truth["right"] == "no"), (truth, str(verdict))
