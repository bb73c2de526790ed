#!/usr/bin/env python3
"""What credence and three rules that others use say of the records of known.py, as a table in Markdown.

    python3 tools.py            # needs credence, and what python/requirements.txt names

- kalman-py: `consistency_check`. Its documentation prefers the time average of the NEES within the bounds.
- filterpy: `NEES`. Its documentation says that the mean is at most the dimension.
- The sum of NEES over all runs and steps within the 95 % interval of chi-square, as of independent steps.

The last row has the share of exact records, of as many other seeds, against which something is said.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
from filterpy.stats import NEES
from kalman_py.diagnostics import consistency_check
from known import KNOWN, Array, Record, made, turned
from scipy.stats import chi2

import credence

SEEDS = 200
FINE = "passes"


def error_of(record: Record) -> Array:
    """[run, step, n], as the record says that P is of it."""
    if "error" in record:
        return np.asarray(record["error"])
    truth, estimate = record["truth"], record["estimate"]
    angle = np.remainder(estimate[..., 2] - truth[..., 2] + np.pi, 2 * np.pi) - np.pi
    moved = estimate[..., :2] - truth[..., :2]
    if record["manifold"] == "SE2":
        half = angle / 2
        body = turned(-truth[..., 2], moved)
        a = half / np.tan(half)
        moved = np.stack([a * body[..., 0] + half * body[..., 1], a * body[..., 1] - half * body[..., 0]], axis=-1)
    return np.concatenate([moved, angle[..., None]], axis=-1)


def nees_of(record: Record) -> Array:
    """[run, step]"""
    return np.array([NEES(e, np.zeros_like(e), P) for e, P in zip(error_of(record), record["covariance"])])


def by_credence(record: Record) -> str:
    verdict = credence.judge(**record)
    if verdict.verdict not in ("consistent", "undecided"):
        return verdict.verdict
    return "noted" if verdict["cautions"] or "are the same run" in str(verdict) else FINE


def beyond(value: float, low: float, high: float) -> str:
    return FINE if low <= value <= high else "optimistic" if value > high else "pessimistic"


def by_kalman_py(nees: Array, n: int) -> str:
    check = consistency_check(nees, n)
    return beyond(float(check.average.mean()), check.lower, check.upper)


def by_filterpy(nees: Array, n: int) -> str:
    return beyond(float(nees.mean()), 0, n)


def by_sum(nees: Array, n: int) -> str:
    low, high = chi2.ppf([0.025, 0.975], n * nees.size)
    return beyond(float(nees.sum()), low, high)


RULES: dict[str, Callable[[Array, int], str]] = {
    "kalman-py": by_kalman_py,
    "filterpy": by_filterpy,
    "χ² of the sum": by_sum,
}


def said(record: Record) -> list[str]:
    nees, n = nees_of(record), record["covariance"].shape[-1]
    return [by_credence(record), *(rule(nees, n) for rule in RULES.values())]


def row(*cells: Any) -> None:
    print(f"| {' | '.join(map(str, cells))} |")


def main() -> None:
    warnings.simplefilter("ignore")  # two records are made to look odd
    row("record", "what is wrong", "credence", *RULES)
    row(*["---"] * (3 + len(RULES)))
    right = np.zeros(1 + len(RULES), dtype=int)
    for name, (is_right, wrong, _) in KNOWN.items():
        words = said(made(name))
        right += [(word == FINE) == is_right for word in words]
        row(f"`{name}`", wrong, *words)
    row("right answers", f"of {len(KNOWN)}", *right)
    alarms = np.mean([[word != FINE for word in said(made("exact", seed))] for seed in range(2, SEEDS + 2)], axis=0)
    row("false alarms", f"`exact` of {SEEDS} other seeds", *(f"{share:.1%}".replace("%", " %") for share in alarms))


if __name__ == "__main__":
    main()
