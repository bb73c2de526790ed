"""The faults of causes.py where nothing was tuned: in another target, of other sizes. Prints causes-held-out.csv.

    python3 experiments/verdict/held_out.py [SEEDS]      of each fault, 10 by default

The target has three positions and their velocities, which hardly decay, one of which is measured less well; its
process noise is smaller beside that of its measurement, and it is no unit of anything: positions are in mm.
"""

from __future__ import annotations

import sys

import causes
import numpy as np
from causes import DEGREES, Fault, Filter, Log, scaled, with_error, with_P

SCALE = 1000.0  # mm
EXCHANGED = [3, 4, 5, 0, 1, 2]


def target(random: np.random.Generator, runs: int, steps: int, of: Filter) -> Log:
    """The target, which differs from seed to seed."""
    q, r, p0 = np.exp(random.uniform(-1, 1, 3))
    F = np.kron([[1, 0.5], [0, 0.98]], np.eye(3))
    Q = SCALE**2 * 0.02 * q * np.kron([[1 / 24, 1 / 8], [1 / 8, 1 / 2]], np.eye(3))
    H, R = np.eye(3, 6), SCALE**2 * np.diag([0.5, 0.5, 2 * r])
    P0 = SCALE**2 * p0 * np.diag([0.5, 0.5, 0.5, 0.05, 0.05, 0.05])
    return causes.kalman(random, runs, steps, of, lambda x: F, lambda x: Q, H, R, P0, np.zeros(6))


OF_ONE = np.where(np.arange(6) == 2, DEGREES, 1.0)
CHANGED = {
    "nothing": Fault(()),
    "Q / 6": Fault(("slow", "growth"), Filter(q=1 / 6)),
    "Q x 6": Fault(("Q",), Filter(q=6)),
    "R / 6": Fault(("close",), Filter(r=1 / 6)),
    "R x 6": Fault(("R",), Filter(r=6)),
    "P0 / 16": Fault(("start",), Filter(p0=1 / 16)),
    "P0 x 16": Fault(("start",), Filter(p0=16)),
    "truth a step late": causes.FAULTS["truth a step late"],
    "measurement a step late": causes.FAULTS["measurement a step late"],
    "P of the prediction": causes.FAULTS["P of the prediction"],
    "P in deg²": Fault(("squared degrees",), written=with_P(lambda log: scaled(log.P, np.full(6, DEGREES)))),
    "errors in deg": causes.FAULTS["errors in deg"],
    "one of the errors in deg": Fault(
        ("degrees",), written=with_error(lambda log: (log.estimate - log.truth) * OF_ONE)),
    "sigma for variance": causes.FAULTS["sigma for variance"],
    "variance squared": causes.FAULTS["variance squared"],
    "cross-covariance dropped": causes.FAULTS["cross-covariance dropped"],
    "bias of 0.7 sigma": Fault(
        ("offset",),
        written=with_error(lambda log: log.estimate - log.truth + SCALE * np.array([0.5, 0, 0, 0, 0, 0]))),
    "bias drawn in each run": causes.FAULTS["bias drawn in each run"],
    "outliers, 2 %": Fault(("few",), Filter(outliers=0.02)),
    "measurement used twice": causes.FAULTS["measurement used twice"],
    "gate at 90 %": Fault(("gate",), Filter(gate=6.251)),
    "P x 3": Fault(("too large",), written=with_P(lambda log: 3 * log.P)),
    "P / 3": Fault(("too small",), written=with_P(lambda log: log.P / 3)),
    "position and velocity exchanged": Fault(
        ("exchange",), written=with_P(lambda log: log.P[..., EXCHANGED, :][..., EXCHANGED])),
}  # fmt: skip
causes.FAULTS = {name: Fault(fault.accepted, fault.filter, fault.written, target) for name, fault in CHANGED.items()}

if __name__ == "__main__":
    causes.main(*map(int, sys.argv[1:]))
