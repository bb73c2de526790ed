"""``python -m credence tune``: the parameters of a function in a module, or the keys of a scenario."""

from __future__ import annotations

import argparse
from collections.abc import Sequence

from credence._calls import say
from credence._commands import command
from credence._doors import needed
from credence._errors import invalid
from credence._outputs import check_output
from credence._simulate_command import code_of, executor_of, function_of, with_options_of_trials
from credence.tuning import tune


def _free(words: Sequence[str]) -> dict[str, tuple[float, float] | None]:
    """Bounds from words such as ``q=0.01:10``; None for a key without."""
    free: dict[str, tuple[float, float] | None] = {}
    for word in words:
        name, equals, bounds = word.partition("=")
        try:
            low, high = map(float, bounds.split(":")) if equals else (0.0, 0.0)
        except ValueError:
            raise invalid("free", word, "must be NAME=LOW:HIGH", "Give two numbers") from None
        free[name] = (low, high) if equals else None
    return free


def _start(words: Sequence[str]) -> dict[str, float]:
    start = {}
    for word in words:
        name, _, value = word.partition("=")
        try:
            start[name] = float(value)
        except ValueError:
            raise invalid("start", word, "must be NAME=NUMBER", "Give a number") from None
    return start


def parser() -> argparse.ArgumentParser:
    made = argparse.ArgumentParser(
        prog="python -m credence tune",
        description="Find the parameters of a filter: credence.tune from the command line.",
        epilog="Exit codes: 0 done, 1 failed, 2 bad input, 130 interrupted.",
    )
    made.add_argument("what", metavar="MODULE:FUNCTION|SCENARIO.ini", help="a function as of simulate, or a scenario")
    made.add_argument(
        "--free", nargs="+", action="extend", required=True, metavar="NAME=LOW:HIGH",
        help="a parameter and its bounds, which a scenario's key need not have",
    )  # fmt: skip
    made.add_argument("--start", nargs="+", action="extend", default=[], metavar="NAME=NUMBER")
    made.add_argument("--trials", type=float, default=200, help="that are tuned on (200)")
    made.add_argument("--held-out", type=float, help="that are judged (at least 2000)")
    made.add_argument("--objective", default="errors", metavar="NAME", help="errors, innovations or nees")
    made.add_argument("--arm", help="that of the scenario which is tuned (its first)")
    made.add_argument("--program", metavar="PATH", help="the program of a world of your own")
    made.add_argument("--picture", metavar="FILE", help="draw the score over the parameters: .png, .pdf or .svg")
    made.add_argument("--overwrite", action="store_true", help="replace the file of --picture where it exists")
    return with_options_of_trials(made)


@command(parser, "what")
def main(given: argparse.Namespace) -> int:
    """Run the command and return its exit code. A batch system's SIGTERM stops it as Ctrl-C does."""
    if given.picture is not None:
        if not given.picture.lower().endswith((".png", ".pdf", ".svg")):
            raise invalid("picture", given.picture, "must be a .png, .pdf or .svg", "Name one")
        check_output(given.picture, given.overwrite, inputs=[given.what])
        needed("matplotlib", "matplotlib", "draw a picture")
    is_function = ":" in given.what and not given.what.endswith(".ini")
    with executor_of(given.executor) as executor:
        tuned = tune(
            function_of(given.what) if is_function else given.what, free=_free(given.free), trials=given.trials,
            seed=given.seed, objective=given.objective, start=_start(given.start), executor=executor,
            batch=given.batch, held_out=given.held_out, arm=given.arm, program=given.program,
            progress=False if given.quiet else None,
        )  # fmt: skip
    say(str(tuned))
    if given.picture is not None:
        tuned.plot().save(given.picture)
    return code_of([tuned.verdict], given.require)
