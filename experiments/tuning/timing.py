"""How long two tunes take: wall time, and processor time of all processes (on a busy machine the one to compare)."""

from __future__ import annotations

import os
import time
from collections.abc import Callable

import filters

import credence

DOCUMENT = "[scenario]\nname = document\n[arms]\ncontrollers = fixed\n"


def timed(name: str, tune: Callable[[], credence.Tuned]) -> None:
    begun, before = time.perf_counter(), sum(os.times()[:4])
    found = tune()
    spent = sum(os.times()[:4]) - before
    print(f"{name}: {time.perf_counter() - begun:.1f} s, {spent:.1f} s of processors, {found.evaluations} evaluations")


if __name__ == "__main__":
    keys = {"filter.features": (0.1, 10.0), "filter.measurement": (0.1, 10.0)}
    timed("two factors of the document, 10,000 trials", lambda: credence.tune(DOCUMENT, free=keys, trials=10_000))
    free = {"q": (0.01, 10.0), "r": (0.1, 10.0)}
    timed("a tracker in Python, 200 trials of 50 steps",
          lambda: credence.tune(filters.tracker_one_by_one, free=free, executor=2))  # fmt: skip
