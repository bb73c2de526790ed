"""Does a tune say more than it knows? How often each statement is made, and is wrong, where a parameter's truth is 0,
where only a sum of squares counts, where the score jumps, and where a log is short.

    python statements.py [--repetitions 100] [--output FILE.csv] [CASE...]
"""

from __future__ import annotations

import argparse
import csv
import sys
import warnings
from collections import Counter
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

import credence

STEPS, TRIALS = 30, 50


def walk(rngs: Sequence[np.random.Generator], q: float, r2: float, truth: tuple[float, float] = (0.5, 1.0),
         steps: int = STEPS) -> credence.Run:  # fmt: skip
    """A level that walks with the sigma truth[0] a step and is measured with the sigma truth[1]; its Kalman filter
    believes the sigma q and the variance r2. Many runs at once."""
    drawn = np.array([rng.standard_normal((steps + 1, 2)) for rng in rngs])
    x, m, P = drawn[:, 0, 0], np.zeros(len(rngs)), 1.0
    error, covariance, innovation, spread = [], [], [], []
    for k in range(1, steps + 1):
        x = x + truth[0] * drawn[:, k, 0]
        P += q**2
        S, nu = P + r2, x + truth[1] * drawn[:, k, 1] - m
        m, P = m + P / S * nu, P - P**2 / S
        for told, one in ((error, m - x), (innovation, nu)):
            told.append(one)
        covariance.append(P)
        spread.append(S)
    shape = len(rngs), steps, 1, 1
    variances = [np.broadcast_to(np.reshape(one, (1, -1, 1, 1)), shape) for one in (covariance, spread)]
    return credence.Run(np.transpose(error)[..., None], variances[0], innovation=np.transpose(innovation)[..., None],
                        innovation_covariance=variances[1])  # fmt: skip


def noise(rngs, r=1.0):
    """A second noise of the sensor beside one of 1, which it does not have."""
    return walk(rngs, 0.5, 1 + r**2)


def motion(rngs, q=1.0, r=2.0):
    """A level that does not walk."""
    return walk(rngs, q, r**2, (0.0, 1.0))


def squares(rngs, a=0.3, b=0.3):
    """Two noises of the sensor, each of 1."""
    return walk(rngs, 0.5, a**2 + b**2, (0.5, 2**0.5))


def whole(rngs, r=2.0):
    """The filter rounds r to fifths."""
    return walk(rngs, 0.5, (round(5 * r) / 5) ** 2)


def jumps(rngs, r=2.0):
    """The filter's r is a twentieth larger in every second twentieth."""
    return walk(rngs, 0.5, (r * (1 + 0.05 * (int(20 * r) % 2))) ** 2)


def both(rngs, q=1.0, r=2.0):
    """Nothing special: all that is free is seen."""
    return walk(rngs, q, r**2)


def log(seed: int, q: float, steps: int) -> Callable[..., credence.Run]:
    """One log of a level that walks with the sigma q; the first half of its steps have few segments."""

    def replay(q=2 * q, r=2.0):
        many = walk([np.random.default_rng(seed)], q, r**2, (truth, 1.0), steps)
        return credence.Run(many.arrays["error"][0], many.arrays["covariance"][0])

    truth = q
    return replay


LOG, LINE = (1e-3, 10.0), (0.0, 10.0)
CASES: dict[str, tuple[Any, dict[str, tuple[float, float]], dict[str, float]]] = {
    "a noise of 0": (noise, {"r": LOG}, {"r": 0.0}),
    "a noise of 0, bounds from 0": (noise, {"r": LINE}, {"r": 0.0}),
    "a motion of 0": (motion, {"q": LOG, "r": (0.1, 10)}, {"q": 0.0, "r": 1.0}),
    "a^2 + b^2": (squares, {"a": (0.01, 10), "b": (0.01, 10)}, {"a": 1.0, "b": 1.0}),
    "rounded": (whole, {"r": (0.3, 10)}, {"r": 1.0}),
    "jumps": (jumps, {"r": (0.3, 10)}, {"r": 1.0}),
    "a log of 150 steps": (150, {"q": (0.03, 6), "r": (0.1, 10)}, {"q": 0.3, "r": 1.0}),
    "a slow log of 400 steps": (400, {"q": (0.005, 1), "r": (0.1, 10)}, {"q": 0.05, "r": 1.0}),
    "both seen": (both, {"q": (0.01, 10), "r": (0.1, 10)}, {"q": 0.5, "r": 1.0}),
}


def statement(estimate: credence.Estimate, truth: float) -> str:
    """What is said of a parameter, and whether that is wrong: an interval that misses the truth."""
    said, (low, high) = str(estimate).split(), estimate.interval
    form = "±" if "±" in said else "not seen" if np.isinf(estimate.se) else "no ±"
    return (said[0] if said[0] in ("below", "above") else form) + (", wrong" if high < truth or low > truth else "")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repetitions", type=int, default=100)
    parser.add_argument("--output", type=argparse.FileType("w"), default=sys.stdout)
    parser.add_argument("cases", nargs="*", metavar="CASE", default=list(CASES))
    given = parser.parse_args()
    table = csv.writer(given.output, lineterminator="\n")
    forms = [form + end for form in ("±", "below", "above", "no ±", "not seen") for end in ("", ", wrong")]
    table.writerow(["case", "parameter", "truth", *forms, "evaluations"])
    for case in given.cases:
        run, free, truths = CASES[case]
        said: dict[str, Counter[str]] = {name: Counter() for name in truths}
        evaluations = []
        for seed in range(1, given.repetitions + 1):
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                if callable(run):
                    found = credence.tune(run, free=free, trials=TRIALS, seed=seed, batch=TRIALS, held_out=20)
                else:
                    found = credence.tune(log(seed, truths["q"], run), free=free)
            evaluations.append(found.evaluations)
            for name, truth in truths.items():
                said[name][statement(found.parameters[name], truth)] += 1
        for name, truth in truths.items():
            table.writerow([case, name, truth, *(said[name][form] for form in forms), round(np.mean(evaluations))])
            given.output.flush()


if __name__ == "__main__":
    main()
