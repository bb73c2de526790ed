"""Runs the studies, prints their table, and fails where a verdict, a NEES or a wrong filter is not as it must be.

    python run.py [--short] [--page] [--reports FOLDER] [--keep FOLDER] [NAME…]   NAME: a part of a library's or study's
"""

from __future__ import annotations

import argparse
import importlib
import itertools
import os
import pathlib
import re
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from common import Filter, Record, Study, nees
from studies import STUDIES

import credence

SEED = 2026
TOLERANCE = 1e-9  # of the mean NEES of a step, relative
LIMITS: dict[str, Any] = {"margin": 0.10, "bias": 0.2}
LIMITS_SHORT: dict[str, Any] = {"margin": 0.25, "margin_direction": 0.5, "bias": 0.5}
HEAD = ("library", "study", "filter", "trials", "steps", "n", "verdict", "NEES/n", "worst direction: error²/P")


@dataclass(frozen=True)
class Row:
    """A filter that was judged."""

    study: Study
    filter: Filter
    verdict: str
    text: str
    cells: tuple[str, ...]
    apart: float  # between credence's NEES and the library's, relative; NaN where there is no other
    seconds: float

    @property
    def name(self) -> str:
        return f"{self.study.library}, {self.study.name}: {self.filter.name}"

    def complaints(self, short: bool) -> Iterator[str]:
        """What is not as it must be."""
        expected = self.filter.expected_short if short and self.filter.expected_short else self.filter.expected
        if self.verdict != expected:
            yield f"the verdict is {self.verdict} (expected: {expected})"
        if self.apart > TOLERANCE:
            yield f"NEES differs by {self.apart:.1e} from the library's (at most {TOLERANCE:.0e})"
        says = self.filter.says_short if short and self.filter.says_short else self.filter.says
        if says not in " ".join(self.text.split()):
            yield f'the report does not say "{says}"'


def whole_state(verdict: credence.Verdict) -> dict[str, Any]:
    found: dict[str, Any] = next(group for group in verdict["groups"] if group["group"] == "all")
    return found


def rounded(number: float, digits: int) -> str:
    return f"{number:#.{digits}g}".rstrip(".")


def worst_direction(verdict: credence.Verdict) -> str:
    """The direction of the whole state whose squared error is furthest from P, and by which factor."""
    directions = verdict["directions"]
    found = [one for end in ("largest", "smallest") for one in directions.get(end, []) if one["group"] == "all"]
    if not found:
        return "-"
    worst = max(found, key=lambda one: abs(float(np.log(one["ratio"]))))
    strongest = sorted(worst["loadings"].values(), key=abs)[-4:]  # of many components the four that weigh most
    terms = [f"{weight:+.2f} {name}" for name, weight in worst["loadings"].items() if weight in strongest]
    shown = " ".join(terms).replace("+", "+ ").replace(" -", " - ").removeprefix("+ ")
    return f"{rounded(worst['ratio'], 2)} along {shown}{' …' if len(worst['loadings']) > 4 else ''}"


def cells(study: Study, chosen: Filter, trials: int, verdict: credence.Verdict) -> tuple[str, ...]:
    """The row of the table, as in HEAD."""
    whole = whole_state(verdict)
    low, high = whole["ci95"]
    ratio = f"{rounded(whole['nees_ratio'], 3)} ± {rounded((high - low) / 2, 2)}"
    size = (str(trials), str(len(whole["anees"]["ratio"])), str(whole["dimension"]))
    return (study.library, study.name, chosen.name, *size, verdict.verdict, ratio, worst_direction(verdict))


def other_nees(chosen: Filter, module: Any, record: Record) -> np.ndarray | None:
    """NEES by trial and step without credence: the library's own where it has one, else NumPy's."""
    if chosen.fault is None and hasattr(module, "own_nees"):
        own: np.ndarray = module.own_nees(record)
        return own
    return nees(record["error"], record["covariance"]) if "error" in record else None


def judge_filter(study: Study, chosen: Filter, module: Any, record: Record, short: bool) -> Row:
    begun = time.perf_counter()
    if chosen.fault is not None:
        record = chosen.fault(record)
    verdict = credence.judge(**record, **(LIMITS_SHORT if short else LIMITS))
    other, apart = other_nees(chosen, module, record), float("nan")
    if other is not None:
        ours = np.array(whole_state(verdict)["anees"]["ratio"]) * whole_state(verdict)["dimension"]
        apart = float(np.max(np.abs(ours / other.mean(axis=0) - 1)))
    shown = cells(study, chosen, len(record["covariance"]), verdict)
    return Row(study, chosen, verdict.verdict, str(verdict), shown, apart, time.perf_counter() - begun)


def judge_study(study: Study, short: bool, kept: pathlib.Path | None) -> Iterator[Row]:
    """The rows of a study. Filters of the same options share their trials, which a folder keeps if it is given."""
    module = importlib.import_module(study.module)
    if sys.stderr.isatty():
        print(f"{study.library}, {study.name}", file=sys.stderr)
    for options, alike in itertools.groupby(study.filters, key=lambda chosen: chosen.options):
        filters, begun = list(alike), time.perf_counter()
        name = re.sub(r"[^a-z0-9]+", "-", f"{study.name} {' '.join(map(str, options.values()))}".lower()).strip("-")
        simulated = credence.simulate(
            module.run,
            trials=study.trials_short if short else filters[0].trials or study.trials,
            seed=SEED,
            arms={"filter": options},
            executor=None if study.batch else os.cpu_count(),
            batch=study.batch,
            output=kept and kept / f"{study.module}-{name}.h5",
            resume=kept is not None,
        )
        record, seconds = simulated.arm("filter").record(), time.perf_counter() - begun
        rows = [judge_filter(study, chosen, module, record, short) for chosen in filters]
        yield replace(rows[0], seconds=seconds + rows[0].seconds)
        yield from rows[1:]


def print_table(rows: list[Row], page: bool) -> None:
    """Markdown; without what differs from run to run where it is for a page."""
    head = HEAD if page else (*HEAD, "NEES apart", "s")
    print("|", " | ".join(head), "|")
    print("|" + "---|" * len(head))
    for row in rows:
        apart = "-" if np.isnan(row.apart) else f"{row.apart:.1e}"
        shown = row.cells if page else (*row.cells, apart, f"{row.seconds:.1f}")
        print("|", " | ".join(shown), "|")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--short", action="store_true", help="fewer trials and wider margins, two minutes in all")
    parser.add_argument("--page", action="store_true", help="print the table as docs/theory/in-the-wild.md has it")
    parser.add_argument("--reports", type=pathlib.Path, help="write the text reports to this folder")
    parser.add_argument("--keep", type=pathlib.Path, help="keep the trials in this folder, and resume from those there")
    parser.add_argument("names", nargs="*", metavar="NAME", help="a part of a study's library or name")
    given = parser.parse_args()
    wanted = [
        study
        for study in STUDIES
        if not given.names or any(name.lower() in f"{study.library} {study.name}".lower() for name in given.names)
    ]
    if not wanted:
        parser.error(f"unknown study {', '.join(given.names)}. Give a part of a library's or study's name.")
    if given.keep:
        given.keep.mkdir(parents=True, exist_ok=True)
    rows = [row for study in wanted for row in judge_study(study, given.short, given.keep)]
    print_table(rows, given.page)
    if given.reports:
        given.reports.mkdir(parents=True, exist_ok=True)
        for row in rows:
            (given.reports / (re.sub(r"[^a-z0-9]+", "-", row.name.lower()) + ".txt")).write_text(row.text)
    complaints = [f"{row.name}: {complaint}." for row in rows for complaint in row.complaints(given.short)]
    for complaint in complaints:
        print(complaint, file=sys.stderr)
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
