"""Causes that are applied to a record (experiments/verdict/causes.py): named rightly, and nothing of a filter that is
right."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from typing import Any

import pytest

import credence

SCRIPT = Path(__file__).parents[2] / "experiments" / "verdict" / "causes.py"


def script() -> Any:
    found = importlib.util.spec_from_file_location("causes", SCRIPT)
    assert found is not None
    assert found.loader is not None
    module = importlib.util.module_from_spec(found)
    sys.modules["causes"] = module
    found.loader.exec_module(module)
    return module


CAUSES = script()
NAMED = ["errors in deg", "one of the errors in deg", "heading's P in deg²", "sigma for variance", "variance squared",
         "cross-covariance dropped", "position and velocity exchanged", "x, y and heading exchanged", "outliers, 1 %",
         "R / 4", "Q x 4", "P x 2", "P / 2"]  # fmt: skip


@pytest.mark.parametrize("name", [*NAMED, "nothing", "nothing, a pose"])
def test_a_fault_in_one_log_is_named_rightly_and_none_of_a_right_filter(name: str) -> None:
    said = CAUSES.hints(name, 1, 3000, seed=1)[0]
    assert CAUSES.grade(said, CAUSES.FAULTS[name].accepted) == ("right" if name in NAMED else "none"), said


def test_tune_is_offered_where_parameters_may_be_the_cause_and_not_after_a_mix_up() -> None:
    def judged(name: str) -> credence.Verdict:
        fault = CAUSES.FAULTS[name]
        log = fault.world(CAUSES.np.random.default_rng(1), 100, 40, fault.filter)
        return credence.judge(**fault.written(log), progress=False)

    noise, mixed_up = judged("R / 4"), judged("position and velocity exchanged")
    assert noise.is_of_the_filter
    assert "credence.tune(" in str(noise)
    assert not mixed_up.is_of_the_filter
    assert "credence.tune(" not in str(mixed_up)
    assert "are they exchanged?" in str(mixed_up)
