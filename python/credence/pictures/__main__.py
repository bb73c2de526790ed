#!/usr/bin/env python3
"""Pictures of a file that credence wrote, each as PDF (or SVG) and PNG.

    python3 analysis/plot.py study.h5 -o pictures          # credence run -o study.h5
    python3 analysis/plot.py trial.h5 -o pictures          # credence replay ... -o trial.h5

Exit codes: 0 done, 2 bad input (nothing written).
"""
import argparse
import re
import sys

try:
    import credence_results as results
    from pictures import study, style, sweep, trajectory, verdicts
except ImportError as missing:
    print(f"cannot draw: {missing}. Install python3-h5py, python3-scipy and python3-matplotlib "
          "(pip: h5py scipy matplotlib).", file=sys.stderr)
    sys.exit(2)

STUDY_PICTURES = {"consistency": study.consistency, "distributions": study.distributions, "paired": study.paired,
                  "coverage": study.coverage}
NEED_TRIALS = ("distributions", "paired")


def parse_arguments(arguments):
    parser = argparse.ArgumentParser(description="Pictures of a results file or a trajectory file of credence.")
    parser.add_argument("file", metavar="FILE.h5")
    parser.add_argument("-o", "--output", metavar="DIR", default="pictures", help="folder for them (default: pictures)")
    parser.add_argument("--scenario", metavar="NAME", action="append", help="only this scenario; may be repeated")
    parser.add_argument("--vector", choices=("pdf", "svg"), default="pdf", help="vector format (default: pdf)")
    parser.add_argument("--width", type=int, choices=(style.COLUMN, style.PAGE), default=style.PAGE,
                        help="millimetres: a page (default) or a column, for all pictures but -blocks and -judged")
    parser.add_argument("--ellipses", choices=tuple(trajectory.ELLIPSES), default="95",
                        help="ellipses of a trajectory: 95 %% (default) or 1-sigma")
    parser.add_argument("--credence", metavar="PATH", help="the program, which says the verdicts "
                        "(default: build/credence, that installed with this script, or that on the PATH)")
    return parser.parse_args(arguments)


def chosen_scenarios(file, names):
    """The scenarios asked for. Raises ValueError for one that is not there."""
    there = dict(results.scenarios(file))
    for name in names or []:
        if name not in there:
            raise ValueError(f"invalid --scenario {name} (not in the file). It has {', '.join(there)}.")
    return [group for name, group in there.items() if not names or name in names]


def report_of(options):
    """The report, or None with the reason on the standard error."""
    program = verdicts.find_credence(options.credence)
    try:
        if program is None:
            raise verdicts.NoReport("credence is not found")
        return verdicts.read_report(program, options.file)
    except verdicts.NoReport as reason:
        print(f"no picture of the verdicts by block: {reason}. Give --credence PATH.", file=sys.stderr)
        return None


def study_figures(scenario, report, width):
    """(stem, figure) of each picture of a scenario; none where an arm has no trial to show."""
    for name, arm in scenario.items():
        if arm.attrs["counted_trials"] == 0:
            why = f"every trial of {name} failed" if results.trials(arm) else "it is not run yet"
            print(f"no pictures of {scenario.name[1:]}: {why}.", file=sys.stderr)
            return
    for name, draw in STUDY_PICTURES.items():
        if name in NEED_TRIALS and not results.keeps_trials(scenario):
            continue
        if (figure := draw(scenario, width)) is not None:
            yield f"{scenario.name[1:]}-{name}", figure
    if report:
        yield f"{scenario.name[1:]}-blocks", verdicts.blocks(scenario, report)


def grid_figures(file, width):
    """(stem, figure) of each grid of a study."""
    for grid in results.grids(file):
        keys = "-".join(key.split(".")[-1] for key in grid.coordinates)
        yield f"{grid.of}-{keys}-sweep", sweep.curves(file, grid, width)


def trajectory_figures(scenario, ellipses, width):
    for name, arm in scenario.items():
        source = re.sub("[^A-Za-z0-9]+", "-", results.text(arm, "source").removeprefix("root "))
        stem = f"{scenario.name[1:]}-{name}-{source}"
        yield f"{stem}-path", trajectory.path(arm, ellipses, width)
        yield f"{stem}-judged", trajectory.judged(arm)


def save_all(figures, options):
    for stem, figure in figures:
        for path in style.save(figure, options.output, stem, options.vector):
            print(path)


def main(arguments):
    options = parse_arguments(arguments)
    try:
        with results.open_file(options.file) as file:
            scenarios = chosen_scenarios(file, options.scenario)
            is_study = results.kind(file) == results.STUDY
            if is_study and not any(results.trials(group) for scenario in scenarios for group in scenario.values()):
                raise ValueError(f"{options.file} has no trials (an empty part of a study). Merge the parts first.")
            if is_study and not results.keeps_trials(file):
                print(f"no pictures of {' and '.join(NEED_TRIALS)} differences: {options.file} keeps aggregates. They need "
                      "the trials (credence run --keep trials).", file=sys.stderr)
            if is_study and not options.scenario:  # a grid has curves; of its points those that are named
                save_all(grid_figures(file, options.width), options)
                scenarios = [scenario for scenario in scenarios if results.place(scenario) is None]
            report = report_of(options) if is_study and scenarios else None
            for scenario in scenarios:
                save_all(study_figures(scenario, report, options.width) if is_study
                         else trajectory_figures(scenario, options.ellipses, options.width), options)
    except ValueError as problem:
        print(problem, file=sys.stderr)
        return 2
    except KeyError as missing:
        print(f"{options.file} is damaged: {missing}. Run the study again, or give an undamaged copy.", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
