#!/usr/bin/env python3
"""Small records of filters about which the truth is known, so that any tool can be tried on them.

    python3 known.py FOLDER        # writes FOLDER/NAME.h5, and FOLDER/truth.csv with what is true of each

Each has 200 runs: of a tracker of (position, velocity) whose acceleration is noise and whose position is measured, or
of a robot's poses. Everything is a function of one seed. docs/judge.md has the format.
"""

from __future__ import annotations

import csv
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

SEED, RUNS, STEPS, POSES = 1, 200, 10, 6
F, H, B = np.array([[1.0, 1.0], [0.0, 1.0]]), np.array([[1.0, 0.0]]), np.array([0.5, 1.0])
Q, R, P0 = (
    0.2,
    1.0,
    np.diag([4.0, 0.25]),
)  # sigma of the acceleration (m/s^2) and of the measurement (m), P of the start
Array = np.ndarray[Any, Any]
Record = dict[str, Any]  # the arguments of credence.judge
Draw = Callable[..., Array]  # numbers with mean 0 and variance 1


class Run(NamedTuple):
    """All runs of the tracker: truth and estimate [run, step, 2], P [step, 2, 2] before and after the update."""

    truth: Array
    estimate: Array
    prior: Array
    posterior: Array
    innovation: Array
    innovation_covariance: Array

    def record(self, **changed: Array) -> Record:
        error, P = self.estimate - self.truth, np.broadcast_to(self.posterior, (RUNS, STEPS, 2, 2))
        return {"error": error, "covariance": P, "component_names": ["x", "v"]} | changed


def tracker(
    draw: Draw, *, q: float = Q, r: float = R, start: float = 1.0, updates: int = 1, bias: Array | float = 0.0
) -> Run:
    """A Kalman filter that assumes q and r, and P0 times `start`; `bias` [run, step] is that of the measurements."""
    x, m, P = draw(RUNS, 2) * np.sqrt(np.diag(P0)), np.zeros((RUNS, 2)), start * P0
    offsets = np.broadcast_to(bias, (RUNS, STEPS))
    kept: list[list[Array]] = [[] for _ in Run._fields]
    for k in range(STEPS):
        x = x @ F.T + Q * draw(RUNS, 1) * B
        z = x @ H.T + R * draw(RUNS, 1) + offsets[:, k, None]
        m, P = m @ F.T, F @ P @ F.T + q**2 * np.outer(B, B)
        prior, nu, S = P, z - m @ H.T, H @ P @ H.T + r**2
        for _ in range(updates):
            gain = P @ H.T / (H @ P @ H.T + r**2)
            m, P = m + (z - m @ H.T) @ gain.T, P - gain @ H @ P
        for values, value in zip(kept, (x, m, prior, (P + P.T) / 2, nu, S)):
            values.append(value)
    return Run(*(np.stack(values, axis=1 if values[0].shape[0] == RUNS else 0) for values in kept))


def heavy(rng: np.random.Generator) -> Draw:
    """Student's t with 5 degrees of freedom, scaled to the variance 1."""
    return lambda *shape: rng.standard_t(5, shape) / np.sqrt(5 / 3)


def scaled(P: Array, by: Array) -> Array:
    """P with the sigmas of its components multiplied, and the same correlations."""
    return P * np.asarray(by)[..., :, None] * np.asarray(by)[..., None, :]


def sigmas(P: Array) -> Array:
    return np.sqrt(np.diagonal(P, axis1=-2, axis2=-1))


ALONG = np.array([[0.09, -0.03, 0.0], [-0.03, 0.25, 0.01], [0.0, 0.01, 0.01]])  # of (x, y, heading): m^2, m rad, rad^2


def exponential(error: Array) -> tuple[Array, Array]:
    """Rotation angle and translation of Exp on SE(2)."""
    angle = error[..., 2]
    s, c = np.sinc(angle / np.pi), (1 - np.cos(angle)) / angle
    x, y = error[..., 0], error[..., 1]
    return angle, np.stack([s * x - c * y, c * x + s * y], axis=-1)


def turned(angle: Array, points: Array) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    x, y = points[..., 0], points[..., 1]
    return np.stack([c * x - s * y, s * x + c * y], axis=-1)


def poses(rng: np.random.Generator, form: str, manifold: str, chart: str = "local", P: Array = ALONG) -> Record:
    """Poses whose errors are drawn from ALONG in the world beside the heading (`apart`), or on SE(2) as `local` or
    `global`; the record says `manifold` and `chart`, and that P is the covariance."""
    truth = np.concatenate([10 * rng.normal(size=(RUNS, POSES, 2)), rng.uniform(-3, 3, (RUNS, POSES, 1))], axis=-1)
    error = rng.multivariate_normal(np.zeros(3), ALONG, (RUNS, POSES))
    angle, moved = exponential(error)
    heading = truth[..., 2] + angle
    place = {
        "apart": truth[..., :2] + error[..., :2],
        "local": truth[..., :2] + turned(truth[..., 2], moved),
        "global": turned(angle, truth[..., :2]) + moved,
    }[form]
    return {
        "truth": truth,
        "estimate": np.concatenate([place, heading[..., None]], axis=-1),
        "covariance": np.broadcast_to(P, (RUNS, POSES, 3, 3)),
        "manifold": manifold,
        "chart": chart,
    }


def late(run: Run) -> Record:
    after = {name: values[:, 1:] for name, values in with_innovations(run, 1).items() if name != "component_names"}
    return run.record(**after | {"error": run.estimate[:, 1:] - run.truth[:, :-1]})


def doubled(run: Run) -> Record:
    half = run.record()
    return half | {name: np.repeat(half[name][: RUNS // 2], 2, axis=0) for name in ("error", "covariance")}


def diverged(run: Run) -> Record:
    factor = np.where(np.arange(RUNS) % 50 == 7, 10.0, 1.0)
    return run.record(error=(run.estimate - run.truth) * factor[:, None, None])


def unwrapped(record: Record, rng: np.random.Generator) -> Record:
    error = record["estimate"] - record["truth"]
    error[..., 2] += 2 * np.pi * (rng.random((RUNS, POSES)) < 0.03)
    units = {"component_names": ["x", "y", "heading"], "component_units": ["m", "m", "rad"]}
    return {"error": error, "covariance": record["covariance"]} | units


def by_run(run: Run, rng: np.random.Generator) -> Record:
    factor = np.where(rng.random(RUNS) < 0.5, 3.0, 0.6)  # the mean of NEES stays n
    return run.record(covariance=run.record()["covariance"] * factor[:, None, None, None])


def without_correlations(P: Array) -> Array:
    return P * np.eye(P.shape[-1])


def with_innovations(run: Run, factor: float) -> Record:
    S = np.broadcast_to(factor * run.innovation_covariance, (RUNS, STEPS, 1, 1))
    return run.record(innovation=run.innovation, innovation_covariance=S)


def normal(rng: np.random.Generator) -> Draw:
    return lambda *shape: rng.standard_normal(shape)


def of_tracker(change: Callable[[Run], Record] = Run.record, **options: Any) -> Callable[[np.random.Generator], Record]:
    return lambda rng: change(tracker(normal(rng), **options))


def of_covariance(change: Callable[[Array], Array]) -> Callable[[np.random.Generator], Record]:
    """The exact filter, whose covariance is then written wrongly."""
    return of_tracker(lambda run: run.record(covariance=change(run.record()["covariance"])))


def drifting(rng: np.random.Generator) -> Record:
    return tracker(normal(rng), bias=0.2 * rng.normal(size=(RUNS, 1)) * np.arange(STEPS)).record()


def outliers(rng: np.random.Generator) -> Record:
    return tracker(normal(rng), bias=8 * rng.choice([-1, 0, 1], (RUNS, STEPS), p=[0.02, 0.96, 0.02])).record()


DEGREES = scaled(ALONG, np.array([1, 1, 180 / np.pi]))
# What is true of each record: whether the filter is right, and what is wrong with it; and how it is made.
KNOWN: dict[str, tuple[bool, str, Callable[[np.random.Generator], Record]]] = {
    "exact": (True, "nothing", of_tracker()),
    "heavy_tails": (True, "nothing; errors of Student's t with 5 degrees of freedom",
                    lambda rng: tracker(heavy(rng)).record()),
    "innovations": (True, "nothing; with innovations", of_tracker(lambda run: with_innovations(run, 1))),
    "pose": (True, "nothing; position in the world, heading", lambda rng: poses(rng, "apart", "R2 x SO2")),
    "pose_local": (True, "nothing; Log in the body's frame", lambda rng: poses(rng, "local", "SE2")),
    "sigma": (False, "sigma in the place of variance", of_covariance(lambda P: scaled(P, sigmas(P) ** -0.5))),
    "squared": (False, "variances squared", of_covariance(lambda P: scaled(P, sigmas(P)))),
    "information": (False, "the information matrix", of_covariance(np.linalg.inv)),
    "no_correlation": (False, "correlations dropped", of_covariance(without_correlations)),
    "swapped": (False, "components in another order than P", of_covariance(lambda P: P[..., ::-1, ::-1])),
    "prediction": (False, "P before the update", of_tracker(lambda run: with_innovations(run, 1) | {
        "covariance": np.broadcast_to(run.prior, (RUNS, STEPS, 2, 2))})),
    "late": (False, "the truth of one step before", of_tracker(late)),
    "twice": (False, "each measurement counted twice", of_tracker(updates=2)),
    "start": (False, "P0 a quarter of what it is", of_tracker(start=0.25)),
    "calm": (False, "q a quarter of what it is", of_tracker(q=Q / 4)),
    "timid": (False, "r twice what it is", of_tracker(r=2 * R)),
    "offset": (False, "an offset of 0.3 m in the position, as of a map", of_tracker(
        lambda run: run.record(error=run.estimate - run.truth + np.array([0.3, 0])))),
    "drift": (False, "a bias of the sensor that drifts", drifting),
    "outliers": (False, "4 % of measurements off by 8 sigma", outliers),
    "diverged": (False, "2 % of the runs diverged", of_tracker(diverged)),
    "by_run": (False, "P three times too large in half of the runs", lambda rng: by_run(tracker(normal(rng)), rng)),
    "repeated": (False, "every run is there twice", of_tracker(doubled)),
    "S": (False, "S of the innovations 0.6 of what it is", of_tracker(lambda run: with_innovations(run, 0.6))),
    "degrees": (False, "variance of the heading in degrees", lambda rng: poses(rng, "apart", "R2 x SO2", P=DEGREES)),
    "frame": (False, "P is of the world's frame, not the body's", lambda rng: poses(rng, "global", "SE2")),
    "apart": (False, "P is of position and heading apart, not of SE(2)", lambda rng: poses(rng, "apart", "SE2")),
    "unwrapped": (False, "3 % of the angles off by a turn", lambda rng: unwrapped(poses(rng, "apart", ""), rng)),
}  # fmt: skip


def made(name: str, seed: int = SEED) -> Record:
    """The arguments of credence.judge; each record has draws of its own."""
    return KNOWN[name][2](np.random.default_rng([seed, list(KNOWN).index(name)]))


def write(folder: Path) -> None:
    import h5py

    folder.mkdir(parents=True, exist_ok=True)
    for name in KNOWN:
        with h5py.File(folder / f"{name}.h5", "w", libver=("v110", "v110")) as file:
            file.attrs["record_version"] = 2
            for key, value in made(name).items():
                if isinstance(value, np.ndarray):
                    packed = {"chunks": value.shape, "compression": "gzip", "shuffle": True, "track_times": False}
                    file.create_dataset(key, data=value.astype(np.float32), **packed)
                else:
                    file.attrs[key] = value if isinstance(value, str) else ", ".join(value)
    with open(folder / "truth.csv", "w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(["record", "right", "what is wrong"])
        rows.writerows([name, "yes" if right else "no", wrong] for name, (right, wrong, _) in KNOWN.items())


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: known.py FOLDER")
    write(Path(sys.argv[1]))
