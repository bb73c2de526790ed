#!/usr/bin/env python3
"""Writes the errors and covariances of your filter as a record that `credence judge` reads.

    python3 write_record.py example.h5 && credence judge example.h5

Copy `write_record` into your own script. The example below it is a constant-velocity tracker with a Kalman filter.
"""
import sys

if __name__ == "__main__" and len(sys.argv) != 2:  # said before anything that may not be installed is imported
    print("usage: write_record.py RECORD.h5", file=sys.stderr)
    sys.exit(2)

import h5py
import numpy as np


def write_record(path, error, covariance, innovation=None, innovation_covariance=None, groups=None, names=None, units=None,
                 steps=None):
    """error [trial, step, n] = estimate - truth, in the chart in which covariance [trial, step, n, n] lives (wrap angles!).
    innovation [trial, step, m] and innovation_covariance [trial, step, m, m] if you have them.
    NaN marks what is not there: an innovation's row that was not observed, error and covariance of a missing step.
    steps [trial]: how many steps each run has, where they differ. A run that ends early without it counts as failed.
    groups: components to judge by themselves, from 0, such as "position 0 2, velocity 1 3"; ranges such as 0:2 leave out
    their end. names and units of the components: lists of texts."""
    with h5py.File(path, "w") as file:
        file.attrs["record_version"] = 2
        file["error"] = np.asarray(error, dtype=float)
        file["covariance"] = np.asarray(covariance, dtype=float)
        if innovation is not None:
            file["innovation"] = np.asarray(innovation, dtype=float)
            file["innovation_covariance"] = np.asarray(innovation_covariance, dtype=float)
        if steps is not None:
            file["steps"] = np.asarray(steps, dtype=np.int32)
        for name, value in (("groups", groups), ("component_names", names), ("component_units", units)):
            if value:
                file.attrs[name] = value


def example(trials=500, steps=30, seed=1):
    """A target in the plane with random accelerations, its position measured; the filter knows the model exactly."""
    rng = np.random.default_rng(seed)
    identity, zero = np.eye(2), np.zeros((2, 2))
    F = np.block([[identity, identity], [zero, identity]])
    G = np.vstack([0.5 * identity, identity])
    H = np.hstack([identity, zero])
    Q, R = 0.1**2 * G @ G.T, 0.5**2 * identity
    record = [np.empty((trials, steps, *shape)) for shape in ((4,), (4, 4), (2,), (2, 2))]
    for trial in range(trials):
        truth, estimate, P = np.zeros(4), rng.normal(size=4), np.eye(4)
        for step in range(steps):
            truth = F @ truth + G @ rng.normal(0, 0.1, 2)
            z = H @ truth + rng.normal(0, 0.5, 2)
            estimate, P = F @ estimate, F @ P @ F.T + Q
            innovation, S = z - H @ estimate, H @ P @ H.T + R
            gain = P @ H.T @ np.linalg.inv(S)
            estimate, P = estimate + gain @ innovation, P - gain @ S @ gain.T
            for values, value in zip(record, (estimate - truth, P, innovation, S)):
                values[trial, step] = value
    return record


if __name__ == "__main__":
    write_record(sys.argv[1], *example(), groups="position 0:2, velocity 2:4", names=["x", "y", "vx", "vy"],
                 units=["m", "m", "m/s", "m/s"])
