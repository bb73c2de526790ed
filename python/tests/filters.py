"""Filters for the tests of `simulate`, in a module of their own, so that other processes can import them."""

from __future__ import annotations

import os
import time

import numpy as np

import credence

STEPS, N = 4, 2


def drawn(rng, scale=1.0, steps=STEPS, **more):
    """Standard normal errors, of which the filter says that their variance is `scale`."""
    error = rng.standard_normal((steps, N))
    rmse = float(np.sqrt(np.mean(error**2)))
    return credence.Run(error, np.broadcast_to(scale * np.eye(N), (steps, N, N)), columns={"rmse": rmse}, **more)


def many(rngs, scale=1.0):
    """The same for many generators at once."""
    error = np.array([rng.standard_normal((STEPS, N)) for rng in rngs])
    covariance = np.broadcast_to(scale * np.eye(N), (len(rngs), STEPS, N, N))
    return credence.Run(error, covariance, columns={"rmse": np.sqrt(np.mean(error**2, axis=(1, 2)))})


def slow(rng, seconds=0.002):
    time.sleep(seconds)
    return drawn(rng)


def large(rng, steps=20, n=80, seconds=0):
    """A trial of 1 MB, which differs from all others."""
    time.sleep(seconds)
    return credence.Run(rng.standard_normal((steps, n)), rng.uniform(0.9, 1.1, (steps, 1, 1)) * (np.eye(n) + 0.1))


def first_of(rng):
    """The first number of a trial, by which the function can tell which trial it is."""
    return rng.standard_normal()


def number_of(rng, seed=1, trials=40):
    """Which of the trials a generator is of."""
    first = first_of(rng)
    return next(i for i in range(trials) if first_of(np.random.Generator(philox(seed, i))) == first)


def philox(seed, trial):
    """As docs/python.md says it."""
    key = np.random.SeedSequence(seed, spawn_key=(trial,)).generate_state(2, np.uint64)
    return np.random.Philox(key=key)


def troubled(rng, hang="sleep"):
    """Every kind of trial that goes wrong, each in its place."""
    trial = number_of(rng)
    if trial == 3:
        raise ValueError("x is\nsingular")
    if trial == 5 and hang == "sleep":
        time.sleep(60)
    if trial == 5 and hang == "loop":
        while True:
            pass
    if trial == 7:
        return credence.Run(np.full((STEPS, N), np.nan), np.full((STEPS, N, N), np.nan))
    if trial == 9:
        return credence.Run(np.zeros((STEPS, 3)), np.broadcast_to(np.eye(3), (STEPS, 3, 3)))
    if trial == 11:
        return credence.Run(np.zeros((2, N)), np.broadcast_to(np.eye(N), (2, N, N)))
    if trial == 13:
        return np.zeros((STEPS, N))
    if trial == 15:
        return credence.Run(np.zeros((STEPS, N)), np.zeros((STEPS, 3, 3)))
    error = rng.standard_normal((STEPS, N))
    return credence.Run(error, np.broadcast_to(np.eye(N), (STEPS, N, N)))


def killer(rng, marks, times):
    """Trial 6 ends its process, so many times; the marks are counted in a folder."""
    if number_of(rng) == 6 and len(os.listdir(marks)) < times:
        open(os.path.join(marks, str(os.getpid())), "w").close()
        os._exit(9)
    return drawn(rng)


def hung_in_c(rng, mark):
    """Trial 6 hangs in one call of C that no signal ends, as long as there is a file."""
    if number_of(rng) == 6 and os.path.exists(mark):
        sum(range(10**12))
    return drawn(rng)
