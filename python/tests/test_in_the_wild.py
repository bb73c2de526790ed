"""The machinery of experiments/in_the_wild: its checks fail where they must, and its studies are as short as they say.

The studies themselves are run by experiments/in_the_wild/run.sh, which needs the libraries.
"""

from __future__ import annotations

import ast
import importlib
import io
import sys
import tokenize
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

import credence

FOLDER = Path(__file__).parents[2] / "experiments" / "in_the_wild"
STUDIES = sorted(path for path in FOLDER.glob("*_*.py"))
NOT_CODE = {tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT, tokenize.ENDMARKER}


@pytest.fixture
def in_the_wild(monkeypatch: pytest.MonkeyPatch) -> dict[str, ModuleType]:
    monkeypatch.syspath_prepend(str(FOLDER))
    names = ("common", "studies", "run")
    for name in names:
        monkeypatch.delitem(sys.modules, name, raising=False)
    return {name: importlib.import_module(name) for name in names}


def lines_of_code(source: str) -> int:
    """Lines that are neither blank, comment, docstring nor import."""
    not_counted: set[int] = set()
    for node in ast.walk(ast.parse(source)):
        text = isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)
        if text or isinstance(node, (ast.Import, ast.ImportFrom)):
            assert isinstance(node, ast.stmt)
            not_counted |= set(range(node.lineno, (node.end_lineno or 0) + 1))
    tokens = tokenize.generate_tokens(io.StringIO(source).readline)
    code = {line for one in tokens if one.type not in NOT_CODE for line in range(one.start[0], one.end[0] + 1)}
    return len(code - not_counted)


def test_lines_of_code() -> None:
    assert lines_of_code('"""Of a\nmodule."""\n\nimport os  # no\n\n# no\nx = [\n    1,\n]\ny = "yes"\n') == 4


@pytest.mark.parametrize("path", STUDIES, ids=lambda path: path.stem)
def test_a_study_is_at_most_40_lines(path: Path) -> None:
    assert 10 < lines_of_code(path.read_text()) <= 40


def test_every_study_has_a_wrong_filter_and_its_file(in_the_wild: dict[str, ModuleType]) -> None:
    studies = in_the_wild["studies"].STUDIES
    assert {study.module for study in studies} == {path.stem for path in STUDIES}
    assert len({study.library for study in studies}) >= 4
    for study in studies:
        wrong = [each for each in study.filters if each.name.startswith("wrong: ")]
        assert wrong, study.name
        assert all(each.expected not in ("consistent", "undecided") and each.says for each in wrong), study.name


class Simulated(ModuleType):
    """A study of independent standard normal errors, whose filter says `variance`."""

    def __init__(self, variance: float, nees_factor: float = 1) -> None:
        super().__init__("simulated")
        self.variance, self.nees_factor = variance, nees_factor

    def run(self, rng: np.random.Generator) -> credence.Run:
        return credence.Run(rng.standard_normal((5, 2)), np.broadcast_to(self.variance * np.eye(2), (5, 2, 2)))

    def own_nees(self, record: dict[str, Any]) -> np.ndarray:
        nees: np.ndarray = self.nees_factor * np.sum(np.square(record["error"]), axis=-1) / self.variance
        return nees


def complaints(in_the_wild: dict[str, ModuleType], module: ModuleType, **of_filter: Any) -> list[str]:
    common, run = in_the_wild["common"], in_the_wild["run"]
    study = common.Study("library", "name", "module", 600, 600, (common.Filter("filter", **of_filter),))
    record = credence.simulate(module.run, trials=600).arm("run").record()
    return list(run.judge_filter(study, study.filters[0], module, record, short=True).complaints(short=True))


HALVED = {"expected": "optimistic", "fault": "halved", "says": "optimistic (NEES/dim): all 2"}
UNNAMED = {"expected": "optimistic", "says": "pessimistic (NEES/dim)"}


@pytest.mark.parametrize(
    ("variance", "nees_factor", "of_filter", "said"),
    [
        (1, 1, {"expected": "consistent"}, []),
        (1, 1, HALVED, []),
        (0.5, 1, {"expected": "consistent"}, ["the verdict is optimistic (expected: consistent)"]),
        (1, 1 + 3e-9, {"expected": "consistent"}, ["NEES differs by 3.0e-09 from the library's"]),
        (0.5, 1, UNNAMED, ['the report does not say "pessimistic (NEES/dim)"']),
    ],
)
def test_what_is_complained_of(
    in_the_wild: dict[str, ModuleType], variance: float, nees_factor: float, of_filter: dict[str, Any], said: list[str]
) -> None:
    if "fault" in of_filter:
        of_filter = of_filter | {"fault": getattr(in_the_wild["common"], of_filter["fault"])}
    found = complaints(in_the_wild, Simulated(variance, nees_factor), **of_filter)
    assert [one[: len(start)] for one, start in zip(found, said, strict=True)] == said


def test_faults(in_the_wild: dict[str, ModuleType]) -> None:
    common = in_the_wild["common"]
    record = {"error": np.zeros((1, 1, 3)), "covariance": np.ones((1, 1, 3, 3)), "groups": {"a": [0, 2], "b": [1]}}
    assert common.without_correlations(record)["covariance"][0, 0].tolist() == [[1, 0, 1], [0, 1, 0], [1, 0, 1]]
    del record["groups"]
    assert common.without_correlations(record)["covariance"][0, 0].tolist() == np.eye(3).tolist()
    assert common.halved(record)["covariance"].max() == 0.5
    names = {"component_names": ["x", "y", "angle"], "component_units": ["m", "m", "rad"]}
    poses = {"truth": np.array([[[0, 0, 3.0]]]), "estimate": np.array([[[1, 2, -3.0]]]), "covariance": 1, **names}
    assert common.in_world_frame(poses)["error"] == pytest.approx(np.array([[[1, 2, 2 * np.pi - 6]]]))
