"""How often the interval of a contribution holds its true value: python3 experiments/budget/coverage.py [studies]
prints the table of docs/budget.md. The error is u + v/2 + w/10 and an interaction of u and v, 13 % of its square, of
three sources drawn directly."""

import json
import sys

import numpy as np

from credence.budgeting import estimated

SCALES = np.array([1, 0.5, 0.1])
DRAWS = {
    "normal": lambda rng, size: rng.normal(size=size),
    "Student's t₅": lambda rng, size: rng.standard_t(5, size=size) / np.sqrt(5 / 3),
    "1 % of draws x 5": lambda rng, size: rng.normal(size=size) * np.where(rng.random(size) < 0.01, 5, 1) / 1.24**0.5,
}


def error_of(draws):
    return (draws * SCALES).sum(axis=1) + 0.433 * draws[:, 0] * draws[:, 1]


def coverage(draw, trials, studies):
    """[source] share of the studies whose interval holds the contribution."""
    rng, held = np.random.default_rng(5), np.zeros(3)
    for _ in range(studies):
        a, b = draw(rng, (2, trials, 3))
        runs = [a, b]
        for i in range(3):
            swapped = np.arange(3) == i
            runs += [np.where(swapped, b, a), np.where(swapped, a, b)]
        errors = [error_of(one)[:, None, None] for one in runs]
        said = json.loads(estimated(errors, ["0", "1", "2"], [("x", "")]).in_format("json"))
        for one in said[0]["parts"][0]["sources"]:
            held[int(one["source"])] += one["alone_ci"][0] <= SCALES[int(one["source"])] <= one["alone_ci"][1]
    return held / studies


def main(studies):
    print("| draws | trials | largest source | half of it | a tenth |")
    print("|---|---|---|---|---|")
    for name, draw in DRAWS.items():
        for trials in (1000, 10_000):
            found = " | ".join(f"{100 * one:.1f} %" for one in coverage(draw, trials, studies))
            print(f"| {name} | {trials:,} | {found} |", flush=True)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 1000)
