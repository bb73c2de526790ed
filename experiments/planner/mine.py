"""A planner of one's own in Python, beside the built-in ones in the rooms of experiments/explore [docs/planner.md].

    python3 experiments/planner/mine.py [TRIALS]
"""

import sys
from pathlib import Path

import numpy as np

import credence

ROOMS = Path(__file__).parents[1] / "explore" / "rooms.ini"


def wander(now):
    """Of the controls that no wall forbids, the one after which P is least; one step in five, any of them."""
    allowed = now.prospects.allowed
    least = np.where(allowed, now.prospects.trace, np.inf).argmin(axis=1)
    random = now.rng.random(2)
    any_one = np.where(allowed, np.arange(allowed.shape[1]) + random[:, :1] * allowed.shape[1], -1) % allowed.shape[1]
    return np.where(random[:, 1] < 0.2, np.where(allowed, any_one, -1).argmax(axis=1), least)


if __name__ == "__main__":
    trials = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    study = credence.run(ROOMS, set={"arms.controllers": "fixed, greedy"}, planners={"wander": wander}, trials=trials)
    print(credence.compare(study, arms=("wander.ekf", "greedy.ekf")))
