#!/usr/bin/python3
"""What the verdict says of one log: how often it finds something in a filter that is right, and how often in one whose
covariance is 0.8 or 0.25 times what it should be. Prints a table of docs/theory/statistics.md; three quarters of an hour
of processor time, shared by all cores.

    /usr/bin/python3 experiments/verdict/logs.py [LOGS]      LOGS of each kind, 100 by default

Errors of four components are autoregressions with P = 1, of innovations drawn from `DRAWS`, with the autocorrelation
`time`; in logs that stop and go, errors and sigma are a fifth as large in every second hundred of steps."""

import json
import os
import subprocess
import sys
import tempfile
from multiprocessing import Pool
from pathlib import Path

import h5py
import numpy as np
from scipy.signal import lfilter

CREDENCE = os.environ.get("CREDENCE", "build/credence")
COMPONENTS = 4
LENGTHS = [(2, 1000), (5, 3000), (20, 2500), (20, 10000), (100, 30000)]  # autocorrelation time of the errors, steps


def outliers(rng, shape):
    """One step in a hundred at five sigma."""
    return rng.normal(size=shape) * np.where(rng.random(shape[0]) < 0.01, 5, 1)[:, None] / np.sqrt(1.24)


DRAWS = {
    "normal": lambda rng, shape: rng.normal(size=shape),
    "Laplace": lambda rng, shape: rng.laplace(size=shape) / np.sqrt(2),
    "t₅": lambda rng, shape: rng.standard_t(5, size=shape) / np.sqrt(5 / 3),
    "1 % of steps at 5 σ": outliers,
    "normal, stop and go": lambda rng, shape: rng.normal(size=shape),
}


def judged(task):
    kind, time, steps, factor, number = task
    rng = np.random.default_rng([list(DRAWS).index(kind), steps, number])
    correlation = (time - 0.5) / (time + 0.5)
    start = 20 * time
    errors = lfilter([np.sqrt(1 - correlation**2)], [1, -correlation],
                     DRAWS[kind](rng, (start + steps, COMPONENTS)), axis=0)[start:]
    sigma = np.where(np.arange(steps) // 100 % 2 == 1, 0.2, 1) if kind.endswith("go") else np.ones(steps)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "log.h5"
        with h5py.File(path, "w") as file:
            file.attrs["record_version"] = 2
            file["error"] = errors * sigma[:, None]
            file["covariance"] = factor * (sigma**2)[:, None, None] * np.eye(COMPONENTS)
        done = subprocess.run([CREDENCE, "judge", path, "--format", "json", "--quiet"], check=True, capture_output=True)
    report = json.loads(done.stdout)[0]
    return report.get("segments", {}).get("count", 0), bool(report["findings"])


def main():
    logs = int(sys.argv[1]) if len(sys.argv) > 1 else 100
    print("| errors | autocorrelation time | steps | segments, median | a right P is refuted | P times 0.8 is found | "
          "P times 0.25 is found |")
    print("|---|---|---|---|---|---|---|")
    with Pool() as pool:
        for kind in DRAWS:
            for time, steps in LENGTHS:
                all_of = [pool.map(judged, [(kind, time, steps, factor, number) for number in range(logs)], 1)
                          for factor in (1, 0.8, 0.25)]
                shares = [f"{100 * sum(found for _, found in some) / logs:.0f} %" for some in all_of]
                segments = np.median([count for count, _ in all_of[0]])
                print(f"| {kind} | {time} | {steps:,} | {segments:.0f} | {' | '.join(shares)} |", flush=True)


if __name__ == "__main__":
    main()
