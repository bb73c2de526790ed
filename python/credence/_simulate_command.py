"""``python -m credence simulate``: trials of a function in a module, for batch scripts."""

from __future__ import annotations

import argparse
import ast
import contextlib
import importlib
import os
import sys
import traceback
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from credence._calls import say
from credence._commands import command
from credence._doors import needed
from credence._errors import InputError, invalid
from credence.judging import NOT_REFUTED, Verdict
from credence.program import STOPPED, Interrupted
from credence.simulating import simulate


def function_of(name: str) -> Any:
    """The function MODULE:NAME; modules of the folder in which it is called are found."""
    module, _, attribute = name.partition(":")
    if not module or not attribute:
        raise invalid("function", name, "must be MODULE:FUNCTION", "Give one, such as my_filter:run")
    sys.path.insert(0, os.getcwd())
    try:
        found = importlib.import_module(module)
    except ModuleNotFoundError as error:
        raise InputError(f"{name}: cannot be imported ({error}). Call this in the folder of the module.") from error
    except Exception as error:
        where = traceback.extract_tb(error.__traceback__)[-1]
        said = f"{type(error).__name__}: {error}; {where.filename}, line {where.lineno}"
        raise InputError(f"{name}: cannot be imported ({said}). Mend the module.") from error
    if not hasattr(found, attribute):
        raise InputError(f"{name}: the module has no {attribute}. Name a function of {found.__file__}.")
    return getattr(found, attribute)


def _arms(given: Sequence[Sequence[str]]) -> dict[str, dict[str, Any]] | None:
    """Arms from words such as ``calm q=0.04``."""
    arms: dict[str, dict[str, Any]] = {}
    for name, *options in given:
        arms[name] = {}
        for option in options:
            key, equals, value = option.partition("=")
            if not equals:
                raise InputError(f"invalid option {option} of the arm {name} (must be NAME=VALUE). Give its value.")
            try:
                arms[name][key] = ast.literal_eval(value)
            except (ValueError, SyntaxError):
                arms[name][key] = value  # a plain text
    return arms or None


@contextlib.contextmanager
def executor_of(name: str | None) -> Iterator[Any]:
    """The executor that a word means: a number of processes, ``dask``, ``dask:ADDRESS``, ``mpi``."""
    if name is None or name.isdigit():
        yield None if name is None else int(name)
    elif name == "mpi":
        with needed("mpi4py.futures", "mpi4py", "run on MPI").MPIPoolExecutor() as executor:
            yield executor
    elif name.split(":")[0] == "dask":
        client_of = needed("distributed", "distributed", "run on Dask").Client
        address = name.partition(":")[2]
        file = os.environ.get("DASK_SCHEDULER_FILE")
        with client_of(address or None) if address or not file else client_of(scheduler_file=file) as client:
            yield client.get_executor()
    else:
        raise invalid("executor", name, "must be a number, dask, dask:ADDRESS or mpi", "Give one of them")


def with_options_of_trials(made: argparse.ArgumentParser) -> argparse.ArgumentParser:
    """A parser with what the commands that run a function take."""
    made.add_argument("--seed", type=int, default=1)
    made.add_argument("--executor", metavar="WHERE", help="a number of processes, dask, dask:ADDRESS or mpi")
    made.add_argument("--batch", type=int, nargs="?", const=True, default=False, help="the function takes many "
                      "generators")  # fmt: skip
    made.add_argument("--require", choices=["consistent", "no-finding"], help="exit code 1 where a filter is not")
    made.add_argument("--quiet", action="store_true", help="no progress")
    return made


def code_of(verdicts: Iterable[Verdict], required: str | None) -> int:
    """The exit code, 1 where a verdict is not what is required."""
    passes = {"consistent": ("consistent",), "no-finding": NOT_REFUTED}.get(required or "")
    return int(passes is not None and any(verdict.verdict not in passes for verdict in verdicts))


def parser() -> argparse.ArgumentParser:
    made = argparse.ArgumentParser(
        prog="python -m credence simulate",
        description="Run a filter in Python many times, and judge it: credence.simulate from the command line.",
        epilog="Exit codes: 0 done, 1 failed, 2 bad input, 3 stopped by a signal with everything kept (--resume).",
    )
    made.add_argument("function", metavar="MODULE:FUNCTION", help="a function of a generator that returns credence.Run")
    made.add_argument("--trials", type=float, required=True, help="runs of each arm; with --until the most")
    made.add_argument("--arm", nargs="+", action="append", default=[], metavar="WORD", help="NAME OPTION=VALUE ...")
    made.add_argument("-o", "--output", metavar="FILE.h5", help="the record, with a group for each arm")
    made.add_argument("--resume", action="store_true", help="resume from the trials that are kept beside the output")
    made.add_argument("--until", action="append", metavar="NUMBER=WIDTH", help="stop at a precision: nees_ratio=1%%")
    made.add_argument("--timeout", type=float, metavar="SECONDS", help="of a trial")
    made.add_argument("--failed", default=0.01, metavar="SHARE", help="of the trials that may fail (1%%)")
    return with_options_of_trials(made)


@command(parser, "function")
def main(given: argparse.Namespace) -> int:
    """Run the command and return its exit code. A batch system's SIGTERM stops it as Ctrl-C does."""
    try:
        function, arms = function_of(given.function), _arms(given.arm)
        with executor_of(given.executor) as executor:
            study = simulate(
                function, trials=given.trials, seed=given.seed, arms=arms, executor=executor, batch=given.batch,
                output=given.output, resume=given.resume, until=given.until, timeout=given.timeout, failed=given.failed,
                progress=False if given.quiet else None,
            )  # fmt: skip
    except Interrupted as stopped:
        print(f"credence simulate: {stopped}.{' To resume it: --resume.' * bool(given.output)}", file=sys.stderr)
        return STOPPED
    say(str(study))
    return code_of(study.verdicts.values(), given.require)
