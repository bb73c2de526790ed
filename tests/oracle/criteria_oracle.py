"""A second program for the claims of docs/theory/planning.md: the deformable world of the document, its EKF and its
controllers in numpy, written from docs/model.md alone, with draws of its own.

    python3 criteria_oracle.py TRIALS [SIGMA_HEAD:CONTROLLER...]

CONTROLLER is fixed, follow or a criterion of the greedy planner. The world is that of
experiments/seed/ekf-circle-ranged.ini. Prints a line for each: the means and standard errors of trace_P, unseen,
pose_error, log_score and path_length [docs/results-format.md].
"""

import sys

import numpy as np

K, M, D, DELTA = 20, 3, 2.0, np.pi / 10
N = 3 + 2 * M
FIRST = np.array([[0.5, 0.5], [0.9, 0.8], [0.3, 0.4]])
NEAR, FAR, SIGMA_NEAR, SIGMA_FAR = 0.1, 2.0, 0.01, 0.09
ODOMETRY, WALK, DEFORMATION = 0.02, 0.3, 0.2
EDGES = [(a, b) for a in range(M) for b in range(a + 1, M)]
J = np.array([[0.0, -1.0], [1.0, 0.0]])


def rotation(theta):
    """R(theta) [..., 2, 2]"""
    c, s = np.cos(theta), np.sin(theta)
    return np.stack([np.stack([c, -s], -1), np.stack([s, c], -1)], -2)


def sigma_of(q):
    return SIGMA_NEAR + (SIGMA_FAR - SIGMA_NEAR) * np.maximum(0, q - NEAR) / (FAR - NEAR)


def in_range(q):
    return (q >= NEAR) & (q <= FAR)


def translation(k):
    phi = DELTA / 2 + k * DELTA
    return D * np.array([np.cos(phi), np.sin(phi)])


def predicted(mean, P, turn, move, k, sigma_head):
    """The belief before the update at pose k; arguments broadcast over leading axes."""
    R = rotation(mean[..., 0])
    moved = (R @ move[..., None])[..., 0]
    shape = np.broadcast_shapes(mean.shape[:-1], turn.shape)
    after = np.broadcast_to(mean, shape + (N,)).copy()
    after[..., 0] += turn
    after[..., 1:3] += moved
    after[..., 3:] += np.tile(translation(k - 1), M)
    F = np.broadcast_to(np.eye(N), shape + (N, N)).copy()
    F[..., 1:3, 0] = (R @ (J @ move[..., None]))[..., 0]
    Q = np.diag([sigma_head**2] + 2 * [ODOMETRY**2] + 2 * M * [WALK**2 + DEFORMATION**2])
    return after, F @ P @ F.swapaxes(-1, -2) + Q


def measurement(mean):
    """Expected sightings and edges [..., rows], and their Jacobian [..., rows, N]."""
    R_inverse = rotation(mean[..., 0]).swapaxes(-1, -2)
    rows = 2 * (M + len(EDGES))
    z, H = np.zeros(mean.shape[:-1] + (rows,)), np.zeros(mean.shape[:-1] + (rows, N))
    for j in range(M):
        at, f = slice(2 * j, 2 * j + 2), slice(3 + 2 * j, 5 + 2 * j)
        z[..., at] = (R_inverse @ (mean[..., f] - mean[..., 1:3])[..., None])[..., 0]
        H[..., at, 0] = -(J @ z[..., at, None])[..., 0]
        H[..., at, 1:3], H[..., at, f] = -R_inverse, R_inverse
    for e, (a, b) in enumerate(EDGES):
        at, fa, fb = (slice(first, first + 2) for first in (2 * (M + e), 3 + 2 * a, 3 + 2 * b))
        z[..., at] = mean[..., fb] - mean[..., fa]
        H[..., at, fa], H[..., at, fb] = -np.eye(2), np.eye(2)
    return z, H


def updated(P, H, seen, sigma):
    """P and the gain after a joint update. seen, sigma [..., M]; what is not seen has rows of 0."""
    used = np.concatenate([np.repeat(seen, 2, -1), np.ones(seen.shape[:-1] + (2 * len(EDGES),), bool)], -1)
    variance = np.concatenate(
        [np.repeat(sigma**2, 2, -1), np.full(seen.shape[:-1] + (2 * len(EDGES),), DEFORMATION**2)], -1)
    H = H * used[..., None]
    HP = H @ P
    S = HP @ H.swapaxes(-1, -2)
    S += np.eye(S.shape[-1]) * np.where(used, variance, 1.0)[..., None, :]
    gain = np.linalg.solve(S, HP).swapaxes(-1, -2)
    return P - gain @ HP, gain


COSTS = {
    "trace": lambda P: np.trace(P, axis1=-2, axis2=-1),
    "log_det": lambda P: np.linalg.slogdet(P)[1],
    "max_eigenvalue": lambda P: np.linalg.eigvalsh(P)[..., -1],
    "pose_trace": lambda P: np.trace(P[..., :3, :3], axis1=-2, axis2=-1),
    "pose_log_det": lambda P: np.linalg.slogdet(P[..., :3, :3])[1],
    "features_trace": lambda P: np.trace(P[..., 3:, 3:], axis1=-2, axis2=-1),
}
TURNS, SPEEDS = -np.pi / 4 + np.pi / 10 * np.arange(6), D / 5 * np.arange(-10, 11)
CANDIDATE_TURNS = np.repeat(TURNS, len(SPEEDS))
CANDIDATE_MOVES = np.tile(SPEEDS, len(TURNS))[:, None] * np.stack([np.cos(CANDIDATE_TURNS), np.sin(CANDIDATE_TURNS)], -1)


def control(controller, mean, P, k, sigma_head):
    """The turn [T] and move in the body frame [T, 2] that lead to pose k."""
    trials = len(mean)
    if controller == "fixed":
        move = D * np.array([np.cos(DELTA), np.sin(DELTA)])
        return np.full(trials, DELTA), np.tile(move, (trials, 1))
    if controller == "follow":
        centre = mean[:, 3:].reshape(trials, M, 2).mean(1) + translation(k - 1) - mean[:, 1:3]
        length = np.linalg.norm(centre, axis=-1, keepdims=True)
        centre = centre * np.minimum(1, 2 * D / length)
        move = (rotation(mean[:, 0]).swapaxes(-1, -2) @ centre[..., None])[..., 0]
        return np.arctan2(move[:, 1], move[:, 0]), move
    after, prior = predicted(mean[:, None], P[:, None], CANDIDATE_TURNS[None], CANDIDATE_MOVES[None], k, sigma_head)
    q = np.linalg.norm(after[..., 3:].reshape(after.shape[:-1] + (M, 2)) - after[..., None, 1:3], axis=-1)
    _, H = measurement(after)
    best = COSTS[controller](updated(prior, H, in_range(q), sigma_of(q))[0]).argmin(-1)
    return CANDIDATE_TURNS[best], CANDIDATE_MOVES[best]


def simulate(controller, sigma_head, trials, rng):
    normal = rng.standard_normal
    centre = np.tile(FIRST, (trials, 1, 1))
    robot, theta = np.zeros((trials, 2)), np.zeros(trials)
    features = centre + DEFORMATION * normal((trials, M, 2))
    sigma = sigma_of(np.linalg.norm(features - robot[:, None], axis=-1))
    mean, P = np.zeros((trials, N)), np.zeros((trials, N, N))
    mean[:, 3:] = (features + sigma[..., None] * normal((trials, M, 2))).reshape(trials, -1)
    P[:, np.arange(3, N), np.arange(3, N)] = np.repeat(sigma**2, 2, -1)
    unseen, pose_error, score, distance = np.zeros((4, trials))
    for k in range(1, K):
        turn, move = control(controller, mean, P, k, sigma_head)
        before = robot
        robot = robot + (rotation(theta) @ move[..., None])[..., 0] + ODOMETRY * normal((trials, 2))
        theta = theta + turn + sigma_head * normal(trials)
        distance += np.linalg.norm(robot - before, axis=-1)
        centre = centre + translation(k - 1) + WALK * normal((trials, M, 2))
        features = centre + DEFORMATION * normal((trials, M, 2))
        offset = features - robot[:, None]
        q = np.linalg.norm(offset, axis=-1)
        seen, sigma = in_range(q), sigma_of(q)
        unseen += (~seen).sum(-1)
        sighted = (rotation(theta).swapaxes(-1, -2)[:, None] @ offset[..., None])[..., 0]
        sighted += sigma[..., None] * normal((trials, M, 2))
        edges = np.stack([features[:, b] - features[:, a] for a, b in EDGES], 1)
        z = np.concatenate([sighted, edges], 1).reshape(trials, -1)
        mean, P = predicted(mean, P, turn, move, k, sigma_head)
        expected, H = measurement(mean)
        P, gain = updated(P, H, seen, sigma)
        mean = mean + (gain @ (z - expected)[..., None])[..., 0]
        error = mean - np.concatenate([theta[:, None], robot, features.reshape(trials, -1)], 1)
        pose_error += (error[:, :3] ** 2).sum(-1)
        nees = (error * np.linalg.solve(P, error[..., None])[..., 0]).sum(-1)
        score += (N * np.log(2 * np.pi) + COSTS["log_det"](P) + nees) / 2 / (K - 1)
    return {"trace_P": COSTS["trace"](P), "unseen": unseen, "pose_error": pose_error, "log_score": score,
            "path_length": distance}


def means(cell, trials, seed=1):
    """Mean and standard error by column of a cell such as "0.01:pose_trace"."""
    sigma_head, controller = cell.split(":")
    columns = simulate(controller, float(sigma_head), trials, np.random.default_rng(seed))
    return {name: (values.mean(), values.std(ddof=1) / np.sqrt(trials)) for name, values in columns.items()}


if __name__ == "__main__":
    for cell in sys.argv[2:]:
        print(cell, *(f"{name} {mean:.5g} ± {1.96 * error:.2g}" for name, (mean, error) in means(cell, int(sys.argv[1])).items()))
