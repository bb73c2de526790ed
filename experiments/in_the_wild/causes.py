"""Changes the cause that docs/theory/in-the-wild.md gives for a verdict, and prints NEES/n before and after."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any
from unittest import mock

import ahrs_attitude
import gtsam
import gtsam_imu
import gtsam_isam2
import numpy as np
from ahrs.filters import EKF
from common import nees

import credence

SEED, TRIALS = 2027, 400


class ExactlyIntegrated(EKF):  # type: ignore[misc]
    """The filter with the quaternion of a constant angular velocity in place of I + Omega dt/2."""

    def f(self, q: np.ndarray, omega: np.ndarray, dt: float) -> np.ndarray:
        half = np.linalg.norm(omega) * dt / 2
        moved: np.ndarray = np.cos(half) * q + np.sin(half) / half * dt / 2 * self.Omega(omega) @ q
        return moved


def attitude(filter_class: type[EKF]) -> float:
    arms = {"simulated": {"variances": "simulated"}}
    with mock.patch.object(ahrs_attitude, "EKF", filter_class):
        study = credence.simulate(ahrs_attitude.run, trials=TRIALS, seed=SEED, arms=arms)
    return float(np.mean(ahrs_attitude.own_nees(study.arm("simulated").record()))) / 3


def derivative_at(rotation_vector: np.ndarray) -> np.ndarray:
    """How a small change of the rotation vector turns the body, by central differences."""
    columns = []
    for change in 1e-6 * np.eye(3):
        before, after = gtsam.Rot3.Expmap(rotation_vector - change), gtsam.Rot3.Expmap(rotation_vector + change)
        columns.append(gtsam.Rot3.Logmap(before.between(after)) / 2e-6)
    return np.array(columns).T


def preintegration() -> tuple[float, float]:
    """Of predict() against the prediction without noise: with P as it is, and with P mapped to its tangent space."""
    exact = gtsam_imu.integrate(np.zeros((1200, 6)), 11)
    as_it_is: list[float] = []
    mapped: list[float] = []
    for i in range(TRIALS):
        told = gtsam_imu.integrate(np.random.default_rng([SEED, i]).standard_normal((1200, 6)), 11)
        for (increment, state, P), (_, without_noise, _) in zip(told, exact):
            error, to = -state.localCoordinates(without_noise), np.zeros((9, 9))
            to[:3, :3] = derivative_at(increment[:3])
            to[3:6, 3:6] = to[6:, 6:] = state.attitude().matrix().T
            for values, covariance in ((as_it_is, P), (mapped, to @ P @ to.T)):
                values.append(nees(error[None, None], covariance[None, None])[0, 0] / 9)
    return float(np.mean(as_it_is)), float(np.mean(mapped))


def factors_in_isam2(only_new_factors: bool) -> int:
    made: list[Any] = []

    def keep(*arguments: Any, kind: Any = gtsam.ISAM2) -> Any:
        made.append(kind(*arguments))
        return made[0]

    with mock.patch.object(gtsam, "ISAM2", keep):
        gtsam_isam2.run(np.random.default_rng([SEED, 0]), only_new_factors=only_new_factors)
    return int(made[0].getFactorsUnsafe().size())


def rows() -> Iterator[tuple[str, str, str, str]]:
    before, after = str(factors_in_isam2(False)), str(factors_in_isam2(True))
    yield "iSAM2: only new factors are given to update()", "factors in iSAM2 at the end", before, after
    before, after = (f"{value:.2f}" for value in preintegration())
    yield "IMU: P is mapped to the tangent space of the predicted state", "NEES/n over 11 s", before, after
    before, after = (f"{attitude(each):.2f}" for each in (EKF, ExactlyIntegrated))
    yield "attitude: the quaternion is integrated exactly", "NEES/n", before, after


if __name__ == "__main__":
    print("| what is changed | what is looked at | before | after |\n|---|---|---|---|")
    for row in rows():
        print("|", " | ".join(row), "|")
