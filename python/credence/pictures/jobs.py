"""Which pictures the command draws of a file, and why others are left out."""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterator, Sequence
from typing import Any

from ..arm import Scenario
from ..grid import Grid
from ..study import Study
from ..trajectory import Trajectory
from .drawing import OF_SCENARIO, OF_TRIAL, arm_meant, opened
from .trials import NAMES, NO_PAIR, pairs

Job = tuple[str, Any, str, dict[str, Any]]  # stem, what is drawn, kind, options
NOT_DRAWN = ("nees_ratio", "nis_ratio", "mean_trace_P", "log_score", "path_length")  # unless they are asked for
NEED_TRIALS = ("distribution", "paired", "place")
FILM = "animation"  # a kind of the command alone
KINDS = sorted({*OF_SCENARIO, *OF_TRIAL, "sweep", FILM})


def jobs_of(options: argparse.Namespace) -> tuple[list[Job], list[str]]:
    """What is to be drawn, and a sentence for each thing that is not."""
    found, left_out = opened(options.file), list[str]()
    if isinstance(found, Study):
        jobs = list(_of_study(found, options, left_out))
        if "keep" in found.file.attrs:
            left_out.append(f"no pictures of {' and '.join(NEED_TRIALS)}: {options.file} keeps aggregates. They need "
                            "the trials (credence run --keep trials).")
    else:
        jobs = list(_of_trajectories(found, options))
    if not left_out:
        drawn = {kind for _, _, kind, _ in jobs}
        left_out = [_why_not(kind, found, options) for kind in options.kind or [] if kind not in drawn]
    return jobs, left_out


def _why_not(kind: str, found: Study | list[Trajectory], options: argparse.Namespace) -> str:
    if not isinstance(found, Study):
        why = ("it is of a study", "Give what credence run -o wrote")
        if kind in OF_TRIAL or kind == FILM:
            why = ("the trial has no robot in the plane", "Take errors or nees")
    elif kind == "sweep":
        why = ("it is of a grid", "Give a study of credence run --sweep, without --scenario")
    elif kind in OF_TRIAL and kind not in OF_SCENARIO:
        why = ("it is of a trial", "Give what credence replay -o wrote")
    elif found.grids and not options.scenario:
        why = ("it is of single scenarios", "Name points of the grid by --scenario")
    elif kind == "paired":
        why = (NO_PAIR, "Choose two by --arms A,B")
    else:
        why = ("the study does not have what it shows", "Take another kind")
    return f"no picture of {kind} ({why[0]}). {why[1]}."


def _chosen(there: dict[str, Scenario], names: Sequence[str] | None) -> list[Scenario]:
    for name in names or []:
        if name not in there:
            raise ValueError(f"invalid --scenario {name} (not in the file). It has {', '.join(there)}.")
    return [scenario for name, scenario in there.items() if not names or name in names]


def _arms(scenario: Scenario, options: argparse.Namespace) -> list[str] | None:
    """The arms that are asked for; None for all."""
    return [arm_meant(scenario, name) for name in options.arms] if options.arms else None


def _of_study(study: Study, options: argparse.Namespace, left_out: list[str]) -> Iterator[Job]:
    scenarios = _chosen(study.scenarios, options.scenario)
    if not any(arm.trials for scenario in scenarios for arm in scenario.arms.values()):
        raise ValueError(f"{study.path} has no trials (an empty part of a study). Merge the parts first.")
    if not options.scenario:  # a grid has curves; of its points those that are named
        for grid in study.grids:
            yield from _of_grid(grid, options)
        scenarios = [scenario for scenario in scenarios if scenario.sweep is None]
    for scenario in scenarios:
        try:
            arms = _arms(scenario, options)
        except ValueError as reason:
            left_out.append(f"no picture of {scenario.name}: {reason}")
            continue
        drawn = [scenario[name] for name in arms or scenario]
        if failed := next((arm for arm in drawn if arm.counted_trials == 0), None):
            why = f"every trial of {failed.name} failed" if failed.trials else "it is not run yet"
            left_out.append(f"no pictures of {scenario.name}: {why}.")
        else:
            yield from _of_scenario(scenario, arms, options)


def _of_grid(grid: Grid, options: argparse.Namespace) -> Iterator[Job]:
    if options.kind and "sweep" not in options.kind:
        return
    first = grid.points[0]
    arms = _arms(first, options)
    stem = f"{grid.of}-{'-'.join(key.split('.')[-1] for key in grid.coordinates)}-sweep"
    for column in ("nees_ratio", "trace_P"):
        if column in next(iter(first.arms.values())).columns:
            yield f"{stem}-{column}", grid, "sweep", {"column": column, "arms": arms}
    if pairs(list(first), arms):
        yield f"{stem}-difference", grid, "sweep", {"column": "trace_P", "difference": True, "arms": arms}


def _of_scenario(scenario: Scenario, arms: list[str] | None, options: argparse.Namespace) -> Iterator[Job]:
    names, asked = arms or list(scenario), options.kind or []
    first, of_records = scenario[names[0]], bool(Study(scenario.group.file).records)
    columns = [column for column in [*NAMES, *first.columns] if column in first.columns and column not in NOT_DRAWN]
    columns = list(dict.fromkeys(columns))
    says, replays = {"credence": options.credence}, {"credence": options.credence, "trial": options.trial}
    kinds: dict[str, list[dict[str, Any]]] = {
        "verdicts": [says], "map": [says | {"arm": arm} for arm in names],
        "nees": [{}], "nis": [{}] if "nis" in first.series else [], "coverage": [{}],
        "chi_square": [{}] if "nees_cells" in first or of_records else [], "trace_P": [{}],
        "accuracy": [{}],
        "distribution": [{"column": column} for column in columns],
        "paired": [{"column": column} for column in columns if pairs(names, arms, of_records)],
        "place": [replays] if "place" in asked else [],
        FILM: [replays | {"arm": arm, "scenario": scenario.name} for arm in names if FILM in asked]}
    for kind, wanted in kinds.items():
        if (asked and kind not in asked) or (kind in NEED_TRIALS and not first.keeps_trials):
            continue
        for given in wanted:
            words = [scenario.name, kind, *(str(given[word]) for word in ("arm", "column") if word in given)]
            if kind == FILM:
                yield "-".join(words), Study(scenario.group.file), kind, given
            else:
                yield "-".join(words), scenario, kind, given | {"arms": arms}


def _of_trajectories(trials: Sequence[Trajectory], options: argparse.Namespace) -> Iterator[Job]:
    wanted = _chosen({trial.scenario.name: trial.scenario for trial in trials}, options.scenario)
    names = [scenario.name for scenario in wanted]
    for trial in trials:
        if trial.scenario.name not in names or trial.name not in (_arms(trial.scenario, options) or [trial.name]):
            continue
        source = re.sub("[^A-Za-z0-9]+", "-", trial.source.removeprefix("root "))
        for kind in options.kind or OF_TRIAL:
            needs_path = kind in ("path", FILM)
            if kind in (*OF_TRIAL, FILM) and (trial.has_path or not needs_path):
                given = {"ellipse": options.ellipses} if needs_path else {}
                yield f"{trial.scenario.name}-{trial.name}-{source}-{kind}", trial, kind, given
