"""Prints lie_groups.json: exponentials, logarithms and left Jacobians of SO(2), SE(2), SO(3), SE(3) and SE_2(3) as SciPy
computes them from matrices alone, for tests/worlds/filters_lie_long_test.cpp.

    python3 tests/reference/make_lie_groups.py > tests/reference/lie_groups.json

The exponential is expm of the tangent's matrix; the left Jacobian, the sum of ad^n / (n + 1)!, is a block of expm
([ad, I; 0, 0]), with ad from commutators; the logarithm of a rotation is that of SciPy's Rotation. Deterministic up to
rounding; made with Python 3.11, NumPy 2.4.6 and SciPy 1.17.1.
"""

import json

import numpy as np
from scipy.linalg import expm
from scipy.spatial.transform import Rotation

GROUPS = {"SO2": (2, 0), "SE2": (2, 1), "SO3": (3, 0), "SE3": (3, 1), "SE23": (3, 2)}  # size of R, vectors


def rotations(d):
    return 1 if d == 2 else 3


def hat(d, k, xi):
    """The tangent (phi, rho...) as a matrix."""
    X = np.zeros((d + k, d + k))
    X[:d, :d] = ([[0, -xi[0]], [xi[0], 0]] if d == 2 else
                 [[0, -xi[2], xi[1]], [xi[2], 0, -xi[0]], [-xi[1], xi[0], 0]])
    X[:d, d:] = np.reshape(xi[rotations(d):], (k, d)).T
    return X


def vee(d, k, X):
    phi = [X[1, 0]] if d == 2 else [X[2, 1], X[0, 2], X[1, 0]]
    return np.concatenate([phi, X[:d, d:].T.ravel()])


def left_jacobian(d, k, xi):
    n, X = len(xi), hat(d, k, xi)
    basis = [hat(d, k, row) for row in np.eye(n)]
    ad = np.column_stack([vee(d, k, X @ E - E @ X) for E in basis])
    return expm(np.block([[ad, np.eye(n)], [np.zeros((n, 2 * n))]]))[:n, n:]


def sample(random, d, k, size):
    phi = random.normal(size=rotations(d))
    phi *= size / np.linalg.norm(phi)
    xi = np.concatenate([phi, 3 * random.normal(size=d * k)])
    case = {"xi": xi.tolist(), "exp": expm(hat(d, k, xi))[:d].ravel().tolist(), "left_jacobian": left_jacobian(d, k, xi).ravel().tolist()}
    if d == 3 and k == 0:
        case["rotation"] = Rotation.from_rotvec(xi).as_matrix().ravel().tolist()
        case["log"] = Rotation.from_matrix(expm(hat(d, k, xi))).as_rotvec().tolist()
    return case


random = np.random.default_rng(1)
sizes = [0, 1e-9, 1e-4, 0.3, 0.999, 1.001, 2, 3.1, np.pi - 1e-6]
print(json.dumps({name: [sample(random, d, k, size) for size in sizes] for name, (d, k) in GROUPS.items()}))
