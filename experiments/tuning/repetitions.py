"""Does a tune know how well it knows? Tunes on 200 trials, each with another seed, of filters that are right: the share
whose truth is within two standard errors, and the standard errors over the spread of the repetitions.

    python repetitions.py [--repetitions 100] [--gallery PROGRAM] [--results FILE.csv] [NAME...]

A NAME is tracker, attitude or turn. Repetitions that are in the file are not run again. PROGRAM is that of
experiments/worlds.
"""

from __future__ import annotations

import argparse
import csv
import pathlib
from typing import Any

import filters
import numpy as np

import credence

ATTITUDE = ("[scenario]\nworld = attitude\nposes = 51\n[sensor]\ngyro = 0.05\nwalk = 0.005\n[start]\nattitude = 0.1\n",
            {"filter.gyro": 1, "filter.walk": 1, "filter.direction": 1}, "local")  # fmt: skip
# Its starts and noise are such that linearisation does not matter.
TURN = ("[scenario]\nworld = coordinated_turn\nposes = 41\n[sensor]\nbearing = 0.005\n[noise]\nacceleration = 1\n"
        "[start]\nsigma_place = 20\nsigma_speed = 5\nsigma_rate = 0.005\n",
        {"filter.acceleration": 1, "filter.rate": 1, "filter.range": 1, "filter.bearing": 1}, "ekf")  # fmt: skip
WORLD = {"attitude": ATTITUDE, "turn": TURN}


def tuned(name: str, seed: int, gallery: str) -> list[tuple[Any, ...]]:
    """The rows of one repetition."""
    if name == "tracker":
        truth, options = filters.TRACKER, {"batch": 200}
        found = credence.tune(filters.tracker, free={"q": (0.02, 2), "r": (0.2, 20)}, start={"q": 1, "r": 1}, seed=seed,
                              held_out=20, **options)  # fmt: skip
    else:
        scenario, truth, arm = WORLD[name]
        found = credence.tune(scenario, free={key: (0.1, 10) for key in truth}, start=dict.fromkeys(truth, 2.0),
                              arm=arm, program=gallery, seed=seed, held_out=20)  # fmt: skip
    return [(name, seed, key, truth[key], one.value, one.se) for key, one in found.parameters.items()]


def print_table(rows: list[list[str]]) -> None:
    print("| model | parameter | repetitions | truth within 2 standard errors | standard error over spread | value |")
    print("|---|---|---|---|---|---|")
    for model, key in dict.fromkeys((row[0], row[2]) for row in rows):
        truth, value, se = np.array([row[3:] for row in rows if (row[0], row[2]) == (model, key)], float).T
        inside, ratio = np.sum(np.abs(value - truth) < 2 * se), np.nanmedian(se) / np.std(value, ddof=1)
        mean = f"{value.mean():.4f} ± {2 * value.std(ddof=1) / len(value) ** 0.5:.4f}"
        print(f"| {model} | {key} (truth {truth[0]:g}) | {len(value)} | {inside} | {ratio:.2f} | {mean} |")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repetitions", type=int, default=100)
    parser.add_argument("--gallery", default="build/worlds/gallery")
    parser.add_argument("--results", type=pathlib.Path, default=pathlib.Path("results/tuning/repetitions.csv"))
    parser.add_argument("names", nargs="*", metavar="NAME", default=["tracker", *WORLD])
    given = parser.parse_args()
    given.results.parent.mkdir(parents=True, exist_ok=True)
    rows = list(csv.reader(given.results.open())) if given.results.exists() else []
    done = {(row[0], row[1]) for row in rows}
    for seed in range(1, given.repetitions + 1):
        for name in given.names:
            if (name, str(seed)) not in done:
                found = tuned(name, seed, given.gallery)
                rows += [list(map(str, row)) for row in found]
                with given.results.open("a") as file:
                    csv.writer(file).writerows(found)
    print_table(rows)


if __name__ == "__main__":
    main()
