"""The filters that experiments/tuning tunes, as functions of `credence.simulate`."""

from __future__ import annotations

import pathlib
import sys

import numpy as np

import credence

F, B = np.array([[1.0, 1.0], [0.0, 1.0]]), np.array([0.5, 1.0])  # of one axis, a second a step
TRACKER = {"q": 0.2, "r": 2.0}  # the truth: acceleration (m/s^2), position (m)
RADAR = {"q": 1.0, "distance": 20.0, "bearing": 0.003}  # acceleration (m/s^2), range (m), bearing (rad)
BOTH = {"groups": {"position": [0, 2], "velocity": [1, 3]}, "component_names": ["x", "vx", "y", "vy"],
        "component_units": ["m", "m/s", "m", "m/s"]}  # fmt: skip

# The annual flow of the Nile at Aswan, 1871 to 1970 (10^8 m^3) [Cobb 1978].
NILE = """1120 1160 963 1210 1160 1160 813 1230 1370 1140 995 935 1110 994 1020 960 1180 799 958 1140 1100 1210 1150
1250 1260 1220 1030 1100 774 840 874 694 940 833 701 916 692 1020 1050 969 831 726 456 824 702 1120 1100 832 764 821
768 845 864 862 698 845 744 796 1040 759 781 865 845 944 984 897 822 1010 771 676 649 846 812 742 801 1040 860 874 848
890 744 749 838 1050 918 986 797 923 975 815 1020 906 901 1170 912 746 919 718 714 740"""


def tracker(rngs, q=1.0, r=1.0, scale=1.0, steps=40):
    """A target in the plane with nearly constant velocity, its position measured: many runs at once.

    The axes are independent and alike, so that both have the same P. `scale` multiplies q and r.
    """
    drawn = np.array([rng.standard_normal((steps + 1, 2, 2)) for rng in rngs])  # [run, step, axis, (motion, sensor)]
    P, Q, R = np.diag([100.0, 25.0]), (scale * q) ** 2 * np.outer(B, B), (scale * r) ** 2
    x, m = drawn[:, 0] * np.sqrt(np.diag(P)), np.zeros((len(rngs), 2, 2))  # [run, axis, (position, velocity)]
    error, covariance, innovation, spread = [], [], [], []
    for k in range(1, steps + 1):
        x = x @ F.T + TRACKER["q"] * drawn[:, k, :, :1] * B
        z = x[..., 0] + TRACKER["r"] * drawn[:, k, :, 1]
        m, P = m @ F.T, F @ P @ F.T + Q
        S, nu = P[0, 0] + R, z - m[..., 0]
        K = P[:, 0] / S
        m, P = m + nu[..., None] * K, P - S * np.outer(K, K)
        error.append((m - x).reshape(len(rngs), 4))
        covariance.append(np.kron(np.eye(2), P))
        innovation.append(nu)
        spread.append(S * np.eye(2))
    alike = [np.broadcast_to(one, (len(rngs), *np.shape(one))) for one in (covariance, spread)]
    return credence.Run(np.swapaxes(error, 0, 1), alike[0], innovation=np.swapaxes(innovation, 0, 1),
                        innovation_covariance=alike[1], **BOTH)  # fmt: skip


def tracker_one_by_one(rng, q=1.0, r=1.0):
    """The tracker as most people have theirs, one run of 50 steps at a time."""
    A, G, H = np.kron(np.eye(2), F), np.kron(np.eye(2), B[:, None]), np.eye(4)[::2]
    P = np.diag([100.0, 25.0, 100.0, 25.0])
    x, m = np.sqrt(np.diag(P)) * rng.standard_normal(4), np.zeros(4)
    error, covariance = [], []
    for _ in range(50):
        x = A @ x + G @ (TRACKER["q"] * rng.standard_normal(2))
        z = H @ x + TRACKER["r"] * rng.standard_normal(2)
        m, P = A @ m, A @ P @ A.T + q**2 * G @ G.T
        S = H @ P @ H.T + r**2 * np.eye(2)
        K = P @ H.T @ np.linalg.inv(S)
        m, P = m + K @ (z - H @ m), P - K @ S @ K.T
        error.append(m - x)
        covariance.append((P + P.T) / 2)
    return credence.Run(error, covariance, **BOTH)


def radar(rng, q=0.3, distance=50.0, bearing=0.01):
    """An extended Kalman filter of an aircraft of which a radar measures range and bearing."""
    A, G = np.kron(np.eye(2), F), np.kron(np.eye(2), B[:, None])
    P, sigma = np.diag([1e4, 100.0, 1e4, 100.0]), np.array([RADAR["distance"], RADAR["bearing"]])
    m = np.array([20000.0, -100.0, 15000.0, 50.0])
    x, R = m + np.sqrt(np.diag(P)) * rng.standard_normal(4), np.diag([distance**2, bearing**2])
    error, covariance, innovation, spread = [], [], [], []
    for _ in range(40):
        x = A @ x + G @ (RADAR["q"] * rng.standard_normal(2))
        z = np.array([np.hypot(x[0], x[2]), np.arctan2(x[2], x[0])]) + sigma * rng.standard_normal(2)
        m, P = A @ m, A @ P @ A.T + q**2 * G @ G.T
        far = np.hypot(m[0], m[2])
        H = np.array([[m[0] / far, 0, m[2] / far, 0], [-m[2] / far**2, 0, m[0] / far**2, 0]])
        S, nu = H @ P @ H.T + R, z - [far, np.arctan2(m[2], m[0])]
        K = np.linalg.solve(S, H @ P).T
        m, P = m + K @ nu, P - K @ S @ K.T
        for told, one in ((error, m - x), (covariance, (P + P.T) / 2), (innovation, nu), (spread, (S + S.T) / 2)):
            told.append(one)
    return credence.Run(error, covariance, innovation=innovation, innovation_covariance=spread, **BOTH)


def attitude(rng, gyro=0.3, accelerometer=0.5, magnetometer=0.8):
    """The attitude filter of ahrs with its example's motion, its three standard deviations free."""
    sys.path.append(str(pathlib.Path(__file__).parents[1] / "in_the_wild"))
    import ahrs_attitude

    return ahrs_attitude.run(rng, np.square([gyro, accelerometer, magnetometer]))


def nile(level, noise):
    """A level that walks, measured each year: its Kalman filter from the first year on, on fixed data."""
    years = np.array(NILE.split(), float)
    mean, P, innovation, spread = years[0], noise, [], []
    for y in years[1:]:
        P += level
        S, nu = P + noise, y - mean
        mean, P = mean + P / S * nu, P - P**2 / S
        innovation.append([nu])
        spread.append([[S]])
    return credence.Run(innovation=innovation, innovation_covariance=spread)
