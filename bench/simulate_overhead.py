"""What `credence.simulate` costs beside a plain loop and joblib: a table of times by trial.

    python bench/simulate_overhead.py [--trials N] [--repeats R]

Each number is the smallest of some repeats; in brackets is the processor time of all processes that ended meanwhile,
which other programs on the machine change less. A trial has 50 steps and 4 states, and a fixed amount of work. The
plain loop makes a generator, calls the function and keeps its arrays, in one process; the verdict is in none of the
times. Needs joblib.
"""

from __future__ import annotations

import argparse
import os
import time

import numpy as np
from joblib import Parallel, delayed

import credence

STEPS, N = 50, 4
ERROR, COVARIANCE = np.ones((STEPS, N)), np.broadcast_to(np.eye(N), (STEPS, N, N)).copy()
WORKS = (0.0, 1e-3, 1e-2)  # s


def work(rounds):
    total = 0.0
    for i in range(rounds):
        total += i * 0.5
    return total


def rounds_of(seconds):
    """How many rounds take so long on this processor when nothing else runs: the fastest of many measurements."""
    if seconds == 0:
        return 0
    rounds, best = 10_000, np.inf
    for _ in range(200):
        begun = time.perf_counter()
        work(rounds)
        best = min(best, time.perf_counter() - begun)
    return int(rounds * seconds / best)


def run(rng, rounds=0):
    work(rounds)
    return credence.Run(ERROR + rng.standard_normal((STEPS, N)), COVARIANCE)


def plain_trial(trial, rounds):
    result = run(np.random.default_rng([1, trial]), rounds)
    return np.array(result.arrays["error"]), np.array(result.arrays["covariance"])


def plain(trials, rounds, _):
    return list(map(np.array, zip(*[plain_trial(trial, rounds) for trial in range(trials)])))


def with_joblib(trials, rounds, workers):
    kept = Parallel(workers)(delayed(plain_trial)(trial, rounds) for trial in range(trials))
    return list(map(np.array, zip(*kept)))


def simulated(trials, rounds, workers):
    return credence.simulate(run, trials=trials, arms={"kf": {"rounds": rounds}}, executor=workers, progress=False)


WAYS = [
    ("plain loop", plain, None),
    ("simulate", simulated, None),
    ("simulate, 1 process", simulated, 1),
    ("simulate, 2 processes", simulated, 2),
    ("joblib, 1 process", with_joblib, 1),
    ("joblib, 2 processes", with_joblib, 2),
]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--trials", type=int, default=2000, help="of 1 ms; more shorter ones, fewer longer ones")
    parser.add_argument("--repeats", type=int, default=5)
    given = parser.parse_args()
    head = [f"{seconds * 1e3:g} ms" for seconds in WORKS]
    print("| µs a trial whose work takes |", " | ".join(head), "|\n|---|" + "---|" * len(WORKS))
    best, processor = {}, {}
    sizes = {seconds: max(20, int(given.trials * 1e-3 / max(seconds, 2.5e-4))) for seconds in WORKS}
    rounds = {seconds: rounds_of(seconds) for seconds in WORKS}
    for _ in range(given.repeats):  # in turn, so that what else the machine does falls on all of them
        for seconds in WORKS:
            for name, way, workers in WAYS:
                begun, at_work = time.perf_counter(), sum(os.times()[:4])
                way(sizes[seconds], rounds[seconds], workers)
                spent = (time.perf_counter() - begun) / sizes[seconds] * 1e6
                best[name, seconds] = min(best.get((name, seconds), np.inf), spent)
                spent = (sum(os.times()[:4]) - at_work) / sizes[seconds] * 1e6
                processor[name, seconds] = min(processor.get((name, seconds), np.inf), spent)
    for name, _, _ in WAYS:
        cells = [f"{best[name, one]:.0f}" for one in WORKS]
        if "joblib" not in name:  # its processes do not end
            cells = [f"{cell} ({processor[name, one]:.0f})" for cell, one in zip(cells, WORKS)]
        print(f"| {name} |", " | ".join(cells), "|")
    added = processor["simulate", 0.0] - processor["plain loop", 0.0]
    print(f"\nsimulate adds {added:.0f} µs of processor time to a trial.")
    for seconds in WORKS[1:]:
        ratio = best["simulate, 1 process", seconds] / best["simulate, 2 processes", seconds]
        print(f"2 processes are {ratio:.2f} times 1 at {seconds * 1e3:g} ms a trial.")


if __name__ == "__main__":
    main()
