"""How often a planted fault is named [docs/verdicts.md]: prints the table causes.csv, of 100 runs of 40 steps and of
one log of 3,000, with the innovations and without. What is right to say of a fault stands in `FAULTS`: a hint is right
if all its words are of what is accepted, wrong if some are of another fault.

    python3 experiments/verdict/causes.py [SEEDS]      of each fault, 10 by default

A target in the plane has the state x, y and its velocities, which decay by a tenth a step; its position is measured. A
robot in the plane has a pose: its steps are known better to the side than ahead, and position and heading are measured.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

import credence

Array = NDArray[np.float64]

#: By what a hint is known, and what it says.
WORDS = {
    "degrees": "57 times P's sigma",
    "squared degrees": "1/57 of P's sigma",
    "sigma": "does P hold standard deviations",
    "squared": "does P hold squared variances",
    "inverse": "an information matrix",
    "exchange": "are they exchanged",
    "order": "is P in another order",
    "early": "is P a step early",
    "late": "is P a step late",
    "dropped": "was a covariance dropped",
    "chart": "in the chart and frame and of the step of P",
    "frame": "does the covariance belong to the error in `plain`",
    "other chart": "does the covariance belong to the error in `global`",
    "too small": "P is too small by a factor of about",
    "too large": "P is too large by a factor of about",
    "slow": "follow too slowly",
    "close": "follow too closely",
    "R": "is the measurement noise too large",
    "Q": "is the process noise too large",
    "start": "is P at the start",
    "growth": "do errors build up",
    "diverges": "the filter diverges",
    "few": "few steps carry",
    "offset": "on average at all steps",
    "unseen": "a truth or a measurement of another step or frame, a bias that is drawn once",
    "prediction": "is P that before the update",
    "gate": "did a gate remove them",
    "unknown": "next to nothing",
}


@dataclass(frozen=True)
class Filter:
    """What a Kalman filter believes, over what is true, and what happens to it."""

    q: float = 1
    r: float = 1
    p0: float = 1
    twice: bool = False
    late: bool = False
    outliers: float = 0
    bias: float = 0
    gate: float = np.inf


@dataclass
class Log:
    """Of runs [run, step, ...]; `before`: P of the prediction."""

    truth: Array
    estimate: Array
    P: Array
    before: Array
    nu: Array
    S: Array


def linear(random: np.random.Generator, runs: int, steps: int, of: Filter) -> Log:
    """The target, which differs from seed to seed."""
    q, r, p0 = np.exp(random.uniform(-1, 1, 3))
    F = np.kron([[1, 1], [0, 0.9]], np.eye(2))
    Q = 0.05 * q * np.kron([[1 / 3, 1 / 2], [1 / 2, 1]], np.eye(2))
    H, R, P0 = np.eye(2, 4), np.diag([1, 1.5 * r]), p0 * np.diag([0.3, 0.3, 0.1, 0.1])
    return kalman(random, runs, steps, of, lambda x: F, lambda x: Q, H, R, P0, np.zeros(4))


def robot(random: np.random.Generator, runs: int, steps: int, of: Filter) -> Log:
    """The robot, which goes in circles: its errors are small enough to be linear."""

    def F(x: Array) -> Array:
        ones = np.broadcast_to(np.eye(3), (len(x), 3, 3)).copy()
        ones[:, 0, 2], ones[:, 1, 2] = -np.sin(x[:, 2]), np.cos(x[:, 2])
        return ones

    def Q(x: Array) -> Array:
        turn = np.zeros((len(x), 3, 3))
        turn[:, 0, 0] = turn[:, 1, 1] = np.cos(x[:, 2])
        turn[:, 1, 0], turn[:, 0, 1], turn[:, 2, 2] = np.sin(x[:, 2]), -np.sin(x[:, 2]), 1
        return turn @ np.diag([0.1**2, 0.01**2, 0.005**2]) @ turn.transpose(0, 2, 1)

    H, R, P0 = np.eye(3), np.diag([0.2**2, 0.2**2, 0.03**2]), np.diag([0.1**2, 0.1**2, 0.02**2])
    return kalman(random, runs, steps, of, F, Q, H, R, P0, np.array([0, 0, 0.1]))


def kalman(random: np.random.Generator, runs: int, steps: int, of: Filter, F: Callable[[Array], Array],
           Q: Callable[[Array], Array], H: Array, R: Array, P0: Array, turn: Array) -> Log:
    n = len(P0)

    def normal(covariance: Array) -> Array:
        L = np.linalg.cholesky(covariance)
        return np.einsum("...ij,...j->...i", L, random.standard_normal((runs, len(L[0] if L.ndim == 3 else L))))

    def moved(x: Array) -> Array:
        if n == 3:
            return x + np.stack([np.cos(x[:, 2]), np.sin(x[:, 2]), np.full(len(x), turn[2])], 1)
        return x @ F(x).T

    x = np.tile(turn * 0.0, (runs, 1)) + (normal(P0) if n != 3 else 0)
    estimate = x + normal(P0) if n == 3 else np.zeros((runs, n))
    P = np.broadcast_to(of.p0 * P0, (runs, n, n)).copy()
    bias = of.bias * normal(R)
    last = x.copy()
    made: list[tuple[Array, ...]] = []
    for _ in range(steps):
        x, last = moved(x) + normal(Q(x)), x
        A, W = F(estimate), of.q * Q(estimate)
        estimate, P = moved(estimate), A @ P @ (A.transpose(0, 2, 1) if A.ndim == 3 else A.T) + W
        before = P
        noise = normal(R)
        noise[random.random(runs) < of.outliers] *= 10
        seen = (last if of.late else x) @ H.T + noise + bias
        for number in range(2 if of.twice else 1):
            S = H @ P @ H.T + of.r * R
            nu = seen - estimate @ H.T
            if number == 0:
                first = nu.copy(), S
            K = np.linalg.solve(S, H @ P).transpose(0, 2, 1)
            used = np.einsum("...i,...i", nu, np.linalg.solve(S, nu[..., None])[..., 0]) < of.gate
            estimate = estimate + used[:, None] * np.einsum("...ij,...j->...i", K, nu)
            joseph = np.eye(n) - used[:, None, None] * K @ H
            P = joseph @ P
            P = (P + P.transpose(0, 2, 1)) / 2
            if number == 0:
                first[0][~used] = np.nan
        made.append((x, estimate, P, before, *first))
    return Log(*(np.stack(one, 1) for one in zip(*made, strict=True)))


def diagonal(variances: Array) -> Array:
    return variances[..., None] * np.eye(variances.shape[-1])


def scaled(P: Array, factors: Array) -> Array:
    return P * factors[:, None] * factors


DEGREES = 180 / np.pi


def given(log: Log) -> dict[str, Any]:
    """What is right to write of the target."""
    return {"error": log.estimate - log.truth, "covariance": log.P}


def with_P(change: Callable[[Log], Array]) -> Callable[[Log], dict[str, Any]]:
    return lambda log: given(log) | {"covariance": change(log)}


def with_error(change: Callable[[Log], Array]) -> Callable[[Log], dict[str, Any]]:
    return lambda log: given(log) | {"error": change(log)}


def late_truth(log: Log) -> dict[str, Any]:
    part = {name: value[:, 1:] for name, value in given(log).items()}
    return part | {"error": log.estimate[:, 1:] - log.truth[:, :-1]}


def pose(log: Log, chart: str = "plain", factors: tuple[float, ...] = (1, 1, 1)) -> dict[str, Any]:
    """Of the robot, whose errors are differences, or of SE(2) in a chart."""
    more = {"manifold": "R2 x SO2", "chart": "local"} if chart == "plain" else {"manifold": "SE2", "chart": chart}
    return {"truth": log.truth, "estimate": log.estimate, "covariance": scaled(log.P, np.array(factors)), **more}


def pose_in_degrees(log: Log) -> dict[str, Any]:
    return {"error": (log.estimate - log.truth) * [1, 1, DEGREES], "covariance": log.P,
            "component_names": ["x", "y", "heading"]}


def dropped(log: Log) -> Array:
    P, half = log.P.copy(), log.P.shape[-1] // 2
    P[..., :half, half:] = P[..., half:, :half] = 0
    return P


@dataclass(frozen=True)
class Fault:
    accepted: tuple[str, ...]
    filter: Filter = Filter()
    written: Callable[[Log], dict[str, Any]] = given
    world: Callable[[np.random.Generator, int, int, Filter], Log] = linear


ALL, ONE = np.full(4, DEGREES), np.array([DEGREES, 1, 1, 1])
OFFSET = 0.5 * np.array([1, 0, 0, 0])  # sigma of the measurement
FAULTS = {
    "nothing": Fault(()),
    "Q / 4": Fault(("slow", "growth"), Filter(q=1 / 4)),
    "Q x 4": Fault(("Q",), Filter(q=4)),
    "R / 4": Fault(("close",), Filter(r=1 / 4)),
    "R x 4": Fault(("R",), Filter(r=4)),
    "P0 / 9": Fault(("start",), Filter(p0=1 / 9)),
    "P0 x 9": Fault(("start",), Filter(p0=9)),
    "truth a step late": Fault(("unseen", "growth", "chart"), written=late_truth),
    "measurement a step late": Fault(("unseen", "growth"), Filter(late=True)),
    "P of the prediction": Fault(("prediction",), written=with_P(lambda log: log.before)),
    "P in deg²": Fault(("squared degrees",), written=with_P(lambda log: scaled(log.P, ALL))),
    "errors in deg": Fault(("degrees",), written=with_error(lambda log: (log.estimate - log.truth) * DEGREES)),
    "one of the errors in deg": Fault(("degrees",), written=with_error(lambda log: (log.estimate - log.truth) * ONE)),
    "sigma for variance": Fault(
        ("sigma",), written=with_P(lambda log: diagonal(np.sqrt(np.diagonal(log.P, axis1=2, axis2=3))))),
    "variance squared": Fault(
        ("squared",), written=with_P(lambda log: diagonal(np.diagonal(log.P, axis1=2, axis2=3) ** 2))),
    "cross-covariance dropped": Fault(("dropped",), written=with_P(dropped)),
    "bias of 0.5 sigma": Fault(("offset",), written=with_error(lambda log: log.estimate - log.truth + OFFSET)),
    "bias drawn in each run": Fault(("unseen", "growth"), Filter(bias=1)),
    "outliers, 1 %": Fault(("few",), Filter(outliers=0.01)),
    "measurement used twice": Fault(("close",), Filter(twice=True)),
    "P in another frame": Fault(("frame", "chart"), written=lambda log: pose(log, "local"), world=robot),
    "gate at 95 %": Fault(("gate",), Filter(gate=5.991)),
    "P x 2": Fault(("too large",), written=with_P(lambda log: 2 * log.P)),
    "P / 2": Fault(("too small",), written=with_P(lambda log: log.P / 2)),
    "position and velocity exchanged": Fault(
        ("exchange",), written=with_P(lambda log: log.P[..., [2, 3, 0, 1], :][..., [2, 3, 0, 1]])),
    "nothing, a pose": Fault((), written=pose, world=robot),
    "heading's P in deg²": Fault(("squared degrees",), written=lambda log: pose(log, factors=(1, 1, DEGREES)),
                                 world=robot),
    "heading's error in deg": Fault(("degrees",), written=pose_in_degrees, world=robot),
    "x, y and heading exchanged": Fault(
        ("order", "exchange"), written=lambda log: pose(log) | {"covariance": log.P[..., [2, 0, 1], :][..., [2, 0, 1]]},
        world=robot),
}
KINDS = {"100 runs of 40 steps": (100, 40), "one log of 3,000 steps": (1, 3000)}


def grade(said: list[str], accepted: tuple[str, ...]) -> str:
    """`right`, `none` or `wrong`."""
    keys = {key for hint in said for key in [key for key, words in WORDS.items() if words in hint] or ["other"]}
    if keys - set(accepted):
        return "wrong"
    return "right" if keys else "none"


def hints(name: str, runs: int, steps: int, seed: int) -> list[list[str]]:
    """What is said of one record, with the innovations and without."""
    fault = FAULTS[name]
    log = fault.world(np.random.default_rng([seed, list(FAULTS).index(name), runs]), runs, steps, fault.filter)
    written = fault.written(log)
    kept = written["covariance"].shape[1]
    innovations = {"innovation": log.nu[:, -kept:], "innovation_covariance": log.S[:, -kept:]}
    return [credence.judge(**written, **more, progress=False)["hints"] for more in (innovations, {})]


def rates(name: str, kind: str, seeds: int) -> list[str]:
    """Two lines of the table."""
    said = [hints(name, *KINDS[kind], seed) for seed in range(seeds)]
    lines = []
    for number, innovations in enumerate(("yes", "no")):
        found = [grade(both[number], FAULTS[name].accepted) for both in said]
        counts = [str(found.count(one)) for one in ("right", "none", "wrong")]
        lines.append(f'"{name}","{kind}",{innovations},{seeds},{",".join(counts)}')
    return lines


def main(seeds: int = 10) -> None:
    print("fault,record,innovations,seeds,right,none,wrong")
    with ProcessPoolExecutor(int(os.environ.get("WORKERS", "2"))) as pool:
        tasks = [(name, kind, seeds) for name in FAULTS for kind in KINDS]
        for lines in pool.map(rates, *zip(*tasks, strict=True)):
            print("\n".join(lines), flush=True)


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
