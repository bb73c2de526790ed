"""filterpy: an interacting multiple model estimator of a target that sometimes manoeuvres, as its class describes it.

Both filters have constant velocity, with little or much noise of the acceleration; the truth changes between them with
the probabilities that the estimator is given. The state is (position in m, speed in m/s).
"""

import numpy as np
from filterpy.common import Q_discrete_white_noise
from filterpy.kalman import IMMEstimator, KalmanFilter

import credence

F, H, R = np.array([[1.0, 1.0], [0.0, 1.0]]), np.array([[1.0, 0.0]]), 4.0  # steps of 1 s; R in m²
ACCELERATION, STAY = (0.05, 1.0), 0.95  # m/s² in each mode; the probability that a mode lasts another step
MEAN, P0, MODES = np.zeros(2), np.diag([25.0, 4.0]), np.array([0.5, 0.5])
CHANGE = np.array([[STAY, 1 - STAY], [1 - STAY, STAY]])


def estimator(quiet):
    filters = []
    for acceleration in ACCELERATION:
        kf = KalmanFilter(2, 1)
        kf.x, kf.P, kf.F, kf.H, kf.R = MEAN.copy(), P0.copy(), F, H, np.array([[R]])
        kf.Q = Q_discrete_white_noise(2, 1.0, (ACCELERATION[0] if quiet else acceleration) ** 2)
        filters.append(kf)
    return IMMEstimator(filters, MODES.copy(), CHANGE)


def run(rng, quiet=False):
    imm, told = estimator(quiet), []
    truth, mode = rng.multivariate_normal(MEAN, P0), int(rng.random() < MODES[1])
    for _ in range(60):
        mode = mode if rng.random() < STAY else 1 - mode
        truth = F @ truth + np.array([0.5, 1.0]) * ACCELERATION[mode] * rng.standard_normal()
        imm.predict()
        imm.update(np.array([truth[0] + R**0.5 * rng.standard_normal()]))
        told.append((imm.x - truth, imm.P.copy()))
    error, covariance = map(np.array, zip(*told))
    return credence.Run(error, covariance, component_names=["position", "speed"])


if __name__ == "__main__":
    print(credence.simulate(run, trials=1000))
