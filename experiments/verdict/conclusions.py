#!/usr/bin/python3
"""How often `credence compare` concludes that one of two filters has the lower log score when their means are the same.
Prints a table of docs/theory/statistics.md; some five minutes of processor time, shared by all cores.

    /usr/bin/python3 experiments/verdict/conclusions.py [STUDIES]      STUDIES of each kind, 400 by default

Each trial is one step of one component with P = 1, so that its score is a constant and e²/2: any differences can be
given to a pair."""

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
PAIRS = [20, 50, 100, 300, 1000]


def rare(values):
    """One of a hundred is 30 times as large; the mean of values of mean 1 becomes 1.29."""
    return lambda rng, n: values(rng, n) * np.where(rng.random(n) < 0.01, 30, 1)


# Positive values and their mean.
DRAWS = {
    "normal": (lambda rng, n: 10 + rng.normal(size=n), 10),
    "t₅": (lambda rng, n: 50 + rng.standard_t(5, size=n), 50),
    "log-normal 1": (lambda rng, n: np.exp(rng.normal(size=n)), np.exp(0.5)),
    "log-normal 1.5": (lambda rng, n: np.exp(1.5 * rng.normal(size=n)), np.exp(1.125)),
    "exponential, 1 % × 30": (rare(lambda rng, n: rng.exponential(size=n)), 1.29),
    "near 1, 1 % × 30": (rare(lambda rng, n: np.maximum(1 + 0.3 * rng.normal(size=n), 0)), 1.29),
}


def write(path, scores):
    with h5py.File(path, "w") as file:
        file["error"] = np.sqrt(2 * np.maximum(scores, 0))[:, None, None]
        file["covariance"] = np.ones((len(scores), 1, 1, 1))


def concludes(job):
    """Whether a conclusion is drawn, and whether plain t intervals would draw one."""
    name, pairs, seed = job
    draw, mean = DRAWS[name]
    rng = np.random.default_rng([seed, pairs, sorted(DRAWS).index(name)])
    with tempfile.TemporaryDirectory() as folder:
        a, b = Path(folder, "a.h5"), Path(folder, "b.h5")
        write(a, draw(rng, pairs))
        write(b, np.full(pairs, mean))
        text = subprocess.run([CREDENCE, "compare", a, b, "--format", "json"], check=True, capture_output=True).stdout
    pair = json.loads(text)[0]
    low, high = pair["log_score"]["ci95"]
    return pair["conclusion"] in ("lower", "higher"), low > 0 or high < 0


def main():
    studies = int(sys.argv[1]) if len(sys.argv) > 1 else 400
    print("| differences | " + " | ".join(f"{n} pairs" for n in PAIRS) + " |\n|---" + "|---" * len(PAIRS) + "|")
    with Pool(os.cpu_count()) as pool:
        for name in DRAWS:
            cells = []
            for pairs in PAIRS:
                found = pool.map(concludes, [(name, pairs, seed) for seed in range(studies)], chunksize=20)
                cells.append("{:.1f} ({:.1f})".format(*(100 * np.mean(found, axis=0))))
            print(f"| {name} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
