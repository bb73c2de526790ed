"""filterpy: a radar that measures the slant range to an aircraft, with the numbers of the library's own tests.

They are test_ekf in kalman/tests/test_ekf.py and test_radar in kalman/tests/test_ukf.py. The state is (down range in m,
speed in m/s, altitude in m).
"""

import numpy as np
from filterpy.examples import RadarSim
from filterpy.kalman import ExtendedKalmanFilter, JulierSigmaPoints, UnscentedKalmanFilter
from filterpy.stats import NEES

import credence

DT = 0.05  # s
F = np.eye(3) + np.array([[0, DT, 0], [0, 0, 0], [0, 0, 0]])
EXAMPLE = {"ekf": ((-10, 90, 1100), 50, np.diag([0, 0.001, 0.001])), "ukf": ((0, 90, 1100), 100, 0.01 * np.eye(3))}


def slant_range(x):
    return np.hypot(x[0], x[2])


def jacobian(x):
    return np.array([[x[0], 0, x[2]]]) / slant_range(x)


def variance(x, kind, noise):
    """Of a range: the example's, or that of what RadarSim adds, 5 % of the down range and 10 m of altitude."""
    if noise == "simulated":
        return (0.05 * x[0]) ** 2 + (10 * x[2] / slant_range(x)) ** 2
    return 0.05 * slant_range(x) if kind == "ekf" else 10


def run(rng, kind, noise="example", start="example"):
    mean, spread, Q = EXAMPLE[kind]
    if kind == "ekf":
        filter, observe = ExtendedKalmanFilter(3, 1), {"HJacobian": jacobian, "Hx": slant_range}
        filter.F = F
    else:
        points, observe = JulierSigmaPoints(3, kappa=0), {}
        filter = UnscentedKalmanFilter(3, 1, DT, lambda x: np.array([slant_range(x)]), lambda x, dt: F @ x, points)
    filter.x, filter.P = np.array(mean, float), spread * np.eye(3)
    filter.Q = np.diag([(5 * DT) ** 2, 0, 0]) if noise == "simulated" else Q
    np.random.seed(rng.integers(2**32))  # RadarSim draws from NumPy's global generator
    truth = (0, 100, 1000) if start == "example" else rng.multivariate_normal(filter.x, filter.P)
    radar, told = RadarSim(DT, *truth), []
    for k in range(400):
        if k > 0 or kind == "ukf" or start == "drawn":  # test_ekf begins with a measurement
            filter.predict()
        z = radar.get_range(0.05)
        filter.update(np.array([z]), R=variance(filter.x, kind, noise), **observe)
        told.append(([radar.pos, radar.vel, radar.alt], filter.x.copy(), filter.P.copy()))
    truth, estimate, covariance = map(np.array, zip(*told))
    return credence.Run(estimate - truth, covariance, component_names=["down_range", "speed", "altitude"])


def own_nees(record):
    return np.array([NEES(0 * error, error, P) for error, P in zip(record["error"], record["covariance"])])


if __name__ == "__main__":
    print(credence.simulate(run, trials=500, arms={"ekf": {"kind": "ekf"}}))
