"""Draws all that a file has, each picture as PDF (or SVG) and PNG.

    python -m credence.pictures study.h5 -o pictures    # credence run -o study.h5
    python -m credence.pictures trial.h5 -o pictures    # credence replay ... -o trial.h5

Exit codes: 0 done, 2 bad input (nothing written).
"""

from __future__ import annotations

import argparse
import pathlib
import re
import sys
from collections.abc import Iterator, Sequence
from typing import Any

try:
    from credence.study import Scenario, Study
    from credence.trajectory import Trajectory

    from . import program, style
    from .drawing import OF_SCENARIO, OF_TRIAL, Picture, opened, plot
    from .trials import NAMES, pairs
except ImportError as missing:
    print(f"credence.pictures: cannot draw ({missing}). Install python3-h5py, python3-scipy and python3-matplotlib "
          "(pip: h5py scipy matplotlib).", file=sys.stderr)
    sys.exit(2)

Job = tuple[str, Any, str, dict[str, Any]]  # stem, what is drawn, kind, options
NEED_TRIALS = ("distribution", "paired", "place")


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m credence.pictures",
                                     description="Pictures of a results file or a trajectory file of credence.")
    parser.add_argument("file", metavar="FILE.h5")
    parser.add_argument("-o", "--output", metavar="DIR", default="pictures", help="folder for them (default: pictures)")
    parser.add_argument("--scenario", metavar="NAME", action="append", help="only this scenario; may be repeated")
    parser.add_argument("--kind", choices=sorted({*OF_SCENARIO, *OF_TRIAL}), action="append",
                        help="only this kind; may be repeated")
    parser.add_argument("--trial", type=int, default=0, metavar="I", help="the trial of --kind place (default: 0)")
    parser.add_argument("--vector", choices=("pdf", "svg"), default="pdf", help="vector format (default: pdf)")
    parser.add_argument("--width", type=int, choices=(int(style.COLUMN), int(style.PAGE)), default=int(style.PAGE),
                        help="millimetres: a page (default) or a column")
    parser.add_argument("--ellipses", choices=("95", "1-sigma"), default="95",
                        help="ellipses of a trajectory: 95 %% (default) or 1-sigma")
    parser.add_argument("--credence", metavar="PATH", help="the program, which says the verdicts (default: the "
                        "package's compiled module, build/credence of a checkout, or that on the PATH)")
    return parser


def _chosen(there: dict[str, Scenario], names: Sequence[str] | None) -> list[Scenario]:
    for name in names or []:
        if name not in there:
            raise ValueError(f"invalid --scenario {name} (not in the file). It has {', '.join(there)}.")
    return [scenario for name, scenario in there.items() if not names or name in names]


def _of_study(study: Study, options: argparse.Namespace) -> Iterator[Job]:
    scenarios = _chosen(study.scenarios, options.scenario)
    if not any(arm.trials for scenario in scenarios for arm in scenario.arms.values()):
        raise ValueError(f"{study.path} has no trials (an empty part of a study). Merge the parts first.")
    if not options.scenario:  # a grid has curves; of its points those that are named
        for grid in study.grids:
            first = study[next(name for name in grid.names.flat if name)]
            stem = f"{grid.of}-{'-'.join(key.split('.')[-1] for key in grid.coordinates)}-sweep"
            columns = next(iter(first.arms.values())).columns
            yield from ((f"{stem}-{column}", grid, "sweep", {"column": column})
                        for column in ("nees_ratio", "trace_P") if column in columns)
            if pairs(list(first)):
                yield f"{stem}-difference", grid, "sweep", {"column": "trace_P", "difference": True}
        scenarios = [scenario for scenario in scenarios if scenario.sweep is None]
    for scenario in scenarios:
        yield from _of_scenario(scenario, options)


def _of_scenario(scenario: Scenario, options: argparse.Namespace) -> Iterator[Job]:
    arms = scenario.arms
    for name, arm in arms.items():
        if arm.counted_trials == 0:
            why = f"every trial of {name} failed" if arm.trials else "it is not run yet"
            print(f"no pictures of {scenario.name}: {why}.", file=sys.stderr)
            return
    first = next(iter(arms.values()))
    columns = [column for column in NAMES if column in first.columns and column != "nees_ratio"]
    kinds: dict[str, list[dict[str, Any]]] = {
        "verdicts": [{"credence": options.credence}],
        "map": [{"credence": options.credence, "arm": arm} for arm in arms],
        "nees": [{}], "nis": [{}] if "nis" in first.series else [], "coverage": [{}],
        "chi_square": [{}] if "nees_cells" in first else [], "accuracy": [{}],
        "distribution": [{"column": column} for column in columns],
        "paired": [{"column": column} for column in columns if pairs(list(arms))],
        "place": [{"trial": options.trial, "credence": options.credence}] if "place" in (options.kind or []) else []}
    for kind, wanted in kinds.items():
        if (options.kind and kind not in options.kind) or (kind in NEED_TRIALS and not first.keeps_trials):
            continue
        for given in wanted:
            words = [scenario.name, kind, *(str(given[word]) for word in ("arm", "column") if word in given)]
            yield "-".join(words), scenario, kind, given


def _of_trajectories(trials: Sequence[Trajectory], options: argparse.Namespace) -> Iterator[Job]:
    wanted = _chosen({trial.scenario.name: trial.scenario for trial in trials}, options.scenario)
    for trial in trials:
        source = re.sub("[^A-Za-z0-9]+", "-", trial.source.removeprefix("root "))
        for kind in OF_TRIAL:
            if (options.kind and kind not in options.kind) or (kind == "path" and not trial.has_path):
                continue
            if trial.scenario.name in [scenario.name for scenario in wanted]:
                given = {"ellipse": options.ellipses} if kind == "path" else {}
                yield f"{trial.scenario.name}-{trial.name}-{source}-{kind}", trial, kind, given


def _save(picture: Picture, stem: pathlib.Path, vector: str) -> None:
    stem.parent.mkdir(parents=True, exist_ok=True)
    for ending in (vector, "png"):
        path = stem.with_name(f"{stem.name}.{ending}")
        picture.save(path)
        print(path)


def _jobs(options: argparse.Namespace) -> Iterator[Job]:
    study = opened(options.file)
    if not isinstance(study, Study):
        yield from _of_trajectories(study, options)
        return
    if "keep" in study.file.attrs:
        print(f"no pictures of {' and '.join(NEED_TRIALS)}: {options.file} keeps aggregates. They need the trials "
              "(credence run --keep trials).", file=sys.stderr)
    yield from _of_study(study, options)


def main(arguments: Sequence[str]) -> int:
    options = _parser().parse_args(arguments)
    said = set()
    try:
        for stem, what, kind, given in _jobs(options):
            try:
                picture = plot(what, kind, width=options.width, **given)
            except program.NoProgram as reason:
                if str(reason) not in said:
                    print(f"no picture of {kind}: {reason} Give --credence PATH.", file=sys.stderr)
                said.add(str(reason))
                continue
            _save(picture, pathlib.Path(options.output) / stem, options.vector)
    except (OSError, ValueError) as problem:
        print(f"credence.pictures: {problem}", file=sys.stderr)
        return 2
    except KeyError as missing:
        print(f"credence.pictures: {options.file} is damaged ({missing}). Run the study again, or give an undamaged "
              "copy.", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
