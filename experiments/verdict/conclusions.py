#!/usr/bin/python3
"""How often `credence compare` concludes that one of two filters has the lower log score: when their means are the
same, and when one believes half the right covariance. Prints a table of docs/theory/statistics.md; some five minutes
of processor time, shared by all cores.

    /usr/bin/python3 experiments/verdict/conclusions.py [STUDIES]      STUDIES of each kind, 250 by default

Each trial of the first is one step of one component with P = 1, so that its score is a constant and e²/2: any
differences can be given to a pair. The trials of the second have ten steps of two components."""

import json
import os
import subprocess
import sys
import tempfile
from multiprocessing import Pool
from pathlib import Path

import h5py
import numpy as np

CREDENCE = os.environ.get("CREDENCE", "build/credence")
PAIRS = [10, 20, 30, 100, 300, 1000]


def rare(size, spread):
    """Values near 1, of which one of a hundred is `size` times as large."""
    return (lambda rng, n: np.maximum(1 + spread * rng.normal(size=n), 0) * np.where(rng.random(n) < 0.01, size, 1),
            1 + 0.01 * (size - 1))


# Positive values and their mean.
DRAWS = {
    "normal": (lambda rng, n: 10 + rng.normal(size=n), 10),
    "Laplace": (lambda rng, n: 50 + rng.laplace(size=n), 50),
    "t₅": (lambda rng, n: 50 + rng.standard_t(5, size=n), 50),
    "log-normal 1": (lambda rng, n: np.exp(rng.normal(size=n)), np.exp(0.5)),
    "near 1, 1 % × 10": rare(10, 0.3),
    "near 1, 1 % × 30": rare(30, 0.3),
}
HALF = "P × 0.5 of a right one"


def write(path, errors, variance=1.0):
    with h5py.File(path, "w") as file:
        file["error"] = errors
        file["covariance"] = np.broadcast_to(variance * np.eye(errors.shape[-1]), (*errors.shape, errors.shape[-1]))


def of_scores(scores):
    return np.sqrt(2 * np.maximum(scores, 0))[:, None, None]


def concludes(job):
    """Whether a conclusion is drawn, and whether plain t intervals would draw one."""
    name, pairs, seed = job
    rng = np.random.default_rng([seed, pairs, [*DRAWS, HALF].index(name)])
    with tempfile.TemporaryDirectory() as folder:
        a, b = Path(folder, "a.h5"), Path(folder, "b.h5")
        if name == HALF:
            errors = rng.normal(size=(pairs, 10, 2))
            write(a, errors, 0.5)
            write(b, errors)
        else:
            draw, mean = DRAWS[name]
            write(a, of_scores(draw(rng, pairs)))
            write(b, of_scores(np.full(pairs, mean)))
        text = subprocess.run([CREDENCE, "compare", a, b, "--format", "json"], check=True, capture_output=True).stdout
    pair = json.loads(text)[0]
    low, high = pair["log_score"]["ci95"]
    return pair["conclusion"] in ("lower", "higher"), low > 0 or high < 0


def main():
    studies = int(sys.argv[1]) if len(sys.argv) > 1 else 250
    print("| differences | " + " | ".join(f"{n} pairs" for n in PAIRS) + " |\n|---" + "|---" * len(PAIRS) + "|")
    with Pool(os.cpu_count()) as pool:
        for name in [*DRAWS, HALF]:
            cells = []
            for pairs in PAIRS:
                found = pool.map(concludes, [(name, pairs, seed) for seed in range(studies)], chunksize=20)
                cells.append("{:.1f} ({:.1f})".format(*(100 * np.mean(found, axis=0))))
            print(f"| {name} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
