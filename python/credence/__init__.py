"""Can a filter's covariance be believed? Verdicts on errors and covariances, and Monte Carlo studies of filters.

>>> import credence
>>> verdict = credence.judge(errors, covariances, groups={"pose": [0, 1, 2]})  # doctest: +SKIP
>>> study = credence.run("scenario.ini", trials=10_000, sweep={"noise.heading": [0.01, 0.02]})  # doctest: +SKIP

Nothing is imported before it is used: neither the compiled module nor NumPy.
"""

from __future__ import annotations

import importlib
import os
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from credence._errors import Failure, InputError
    from credence._planners import Now, Prospects
    from credence._record import Record, Run
    from credence.arm import Arm, Scenario
    from credence.budgeting import Budget, budget
    from credence.judging import Verdict, assert_consistent, judge
    from credence.pictures import animate, plot
    from credence.program import Comparison, Interrupted, Report, compare, merge, replay, report, resume, run, show
    from credence.simulating import Simulation, simulate
    from credence.study import Study, open
    from credence.trajectory import Trajectory, open_trajectories
    from credence.tuning import Tuned, tune

_modules = {  # each with what it has for users
    "_errors": ("Failure", "InputError"),
    "_planners": ("Now", "Prospects"),
    "_record": ("Record", "Run"),
    "arm": ("Arm", "Scenario"),
    "budgeting": ("Budget", "budget"),
    "judging": ("Verdict", "assert_consistent", "judge"),
    "pictures": ("animate", "plot"),
    "program": ("Comparison", "Interrupted", "Report", "compare", "merge", "replay", "report", "resume", "run", "show"),
    "simulating": ("Simulation", "simulate"),
    "study": ("Study", "open"),
    "trajectory": ("Trajectory", "open_trajectories"),
    "tuning": ("Tuned", "tune"),
}
_places = {name: module for module, names in _modules.items() for name in names}

__all__ = [
    "Arm",
    "Budget",
    "Comparison",
    "Failure",
    "InputError",
    "Interrupted",
    "Now",
    "Prospects",
    "Record",
    "Report",
    "Run",
    "Scenario",
    "Simulation",
    "Study",
    "Trajectory",
    "Tuned",
    "Verdict",
    "animate",
    "assert_consistent",
    "budget",
    "compare",
    "judge",
    "merge",
    "open",
    "open_trajectories",
    "plot",
    "replay",
    "report",
    "resume",
    "run",
    "show",
    "simulate",
    "tune",
]


def _warn_of_another() -> None:
    """Warns if the registry's distribution ``credence``, another project's, has its files in this folder, too."""
    beside = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    for name in os.listdir(beside):
        if name.startswith("credence-") and name[9:10].isdigit() and name.endswith(".dist-info"):
            import warnings

            warnings.warn(
                f"The distribution {name[:-10]}, another project's, is installed in the folder of credence-filters, "
                "and each replaces files of the other. Run pip uninstall credence credence-filters, then install "
                "credence-filters again.", stacklevel=3)


_warn_of_another()


def __getattr__(name: str) -> object:
    if name not in _places:
        raise AttributeError(f"module 'credence' has no attribute {name!r}")
    value = getattr(importlib.import_module(f"credence.{_places[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted([*globals(), *_places])
