"""The trial of the reference study (docs/model.md, heading model, three features), for numpy and jax.numpy alike.

Trials are in the last axis of every array, candidates in the one before, components in the leading ones: so a line is a
loop over trials, as processors and compilers like them best. The equations are the page's; they are rearranged as
someone would who writes them with care for speed, and no further:
- Rows of measurements are eliminated one after another (Cholesky without roots), which gives S^-1, NIS, gain and
  covariance at once. A row that is not seen has the weight 0.
- Edges come first, as M - 1 contrasts: no control changes them, so the planner's candidates share them.
- A candidate's cost is tr P^- less the squared length of L^-1 H P^-, without a covariance of its own. As F is applied
  to H first, H F P is the same for all candidates.
"""

import math

K, M, D, TURN = 20, 3, 2.0, math.pi / 10
N, ROWS = 3 + 2 * M, 2 * M
FIRST = ((0.5, 0.5), (0.9, 0.8), (0.3, 0.4))
NEAR, FAR, SIGMA, SIGMA_NEAR, SIGMA_FAR = 0.1, 2.0, 0.05, 0.01, 0.09
HEADING, ODOMETRY, WALK, DEFORMATION = 0.001, 0.02, 0.3, 0.2
CONTRASTS, CONTRAST_VARIANCES = ((1, -0.5, -0.5), (0, 1, -1)), (DEFORMATION**2 / 2, DEFORMATION**2 / 1.5)
NORMALS = 3 + 3 * ROWS  # of a pose: heading, x, y; each feature's walk to this pose, deformation, measurement
COLUMNS = ("trace_P", "unseen", "pose_error", "nees_ratio", "nis_ratio")


def translations(path):
    """How the features move from pose k - 1 to k, for k = 1 ... K - 1: [K - 1, 2]"""
    angles = [TURN / 2 + k * TURN if path == "circle" else 0.0 for k in range(K - 1)]
    return [(D * math.cos(angle), D * math.sin(angle)) for angle in angles]


def controls(path, controller):
    """Groups of candidates, each a list of (turn, x, y) in the body frame; the fixed path's control is the only one."""
    if controller == "fixed":
        turn = TURN if path == "circle" else 0.0
        return [[(turn, D * math.cos(turn), D * math.sin(turn))]]
    turns = [-math.pi / 4 + m * math.pi / 10 for m in range(6)] if path == "circle" else [0.0]
    speeds = [i * D / 10 * 2 for i in range(-10, 11)]
    return [[(turn, s * math.cos(turn), s * math.sin(turn)) for s in speeds] for turn in turns]


def rotated(xp, angle, v):
    c, s = xp.cos(angle), xp.sin(angle)
    return xp.stack([c * v[0] - s * v[1], s * v[0] + c * v[1]])


def lessened(rows, row, inverse):
    """`rows`, those below `row`, less their shares of it."""
    return [other - (row[k] * inverse) * row[k:] for k, other in enumerate(rows, 1)]


def eliminated(rows, weights, apart):
    """Rows of S from the diagonal on, each followed by further columns, are eliminated in place; weights / diagonal."""
    inverses = []
    for i, row in enumerate(rows):
        inverses.append(weights[i] / row[0])
        if i + 1 < len(rows):
            rows[i + 1 :] = apart(lessened, rows[i + 1 :], row, inverses[i])
    return inverses


def conditioned(P, rows, inverses):
    """[Update] P, the correction of the mean, and NIS, from eliminated rows that end with H P and the innovation."""
    correction = nis = 0
    for row, inverse in zip(rows, inverses):
        HP, scaled = row[-1 - N : -1], row[-1] * inverse
        P = P - (HP * inverse)[:, None] * HP
        correction = correction + HP * scaled
        nis = nis + row[-1] * scaled
    return P, correction, nis


class Trial:
    """`xp` is numpy or jax.numpy; over(f, groups) maps f over the leading axis; apart(f, ...) is f(...). A state is
    (heading, robot, centres, mean, P, sums of columns)."""

    def __init__(self, xp, over, apart, path, noise, controller):
        self.xp, self.ranged, self.controller = xp, noise == "ranged", controller
        self.over, self.apart = over, apart
        self.candidates = xp.moveaxis(xp.array(controls(path, controller)), 2, 1)[..., None]  # [groups, 3, each, 1]
        self.translations = xp.array(translations(path))
        variances = xp.array([HEADING**2] + 2 * [ODOMETRY**2] + ROWS * [0.0])
        self.robot_noise = xp.diag(variances)[..., None]
        self.feature_noise = xp.diag(xp.array(3 * [0.0] + ROWS * [WALK**2 + DEFORMATION**2]))[..., None]

    def sigma(self, q):
        if not self.ranged:
            return self.xp.full_like(q, SIGMA)
        return SIGMA_NEAR + (SIGMA_FAR - SIGMA_NEAR) / (FAR - NEAR) * self.xp.maximum(0, q - NEAR)

    def looked(self, offset):
        """Of offsets [M, 2, ...]: whether each is in range, and sigma, [M, ...]"""
        q = self.xp.sqrt(offset[:, 0] ** 2 + offset[:, 1] ** 2)
        return (q >= NEAR) & (q <= FAR), self.sigma(q)

    def started(self, normals):
        xp, trials = self.xp, normals.shape[-1]
        _, _, deformation, measurement = self.parted(normals)
        centre = xp.zeros((M, 2, trials)) + xp.array(FIRST)[..., None]
        feature = centre + DEFORMATION * deformation
        _, sigma = self.looked(feature)
        mean = xp.concatenate([xp.zeros((3, trials)), (feature + sigma[:, None] * measurement).reshape(ROWS, trials)])
        variances = xp.concatenate([xp.zeros((3, trials)), xp.repeat(sigma**2, 2, 0)])
        P = xp.eye(N)[..., None] * variances
        return xp.zeros(trials), xp.zeros((2, trials)), centre, mean, P, xp.zeros((5, trials))

    def parted(self, normals):
        features = normals[3:].reshape(3, M, 2, -1)
        return normals[:3], features[0], features[1], features[2]

    def updated(self, P, rows, weights):
        return self.apart(conditioned, P, rows, eliminated(rows, weights, self.apart))

    def edge_rows(self, P, innovation):
        """Of the contrasts of all edges, innovation [M, 2, T]"""
        xp, rows = self.xp, []
        block, nu = P[3:].reshape(M, 2, N, -1), []
        HP = [sum(c * block[j, axis] for j, c in enumerate(contrast) if c) for contrast in CONTRASTS for axis in (0, 1)]
        for r, row in enumerate(HP):
            nu = sum(c * innovation[j, r % 2] for j, c in enumerate(CONTRASTS[r // 2]) if c)
            S = [sum(c * row[3 + 2 * j + s % 2] for j, c in enumerate(CONTRASTS[s // 2]) if c)
                 for s in range(r, len(HP))]
            S[0] = S[0] + CONTRAST_VARIANCES[r // 2]
            rows.append(xp.concatenate([xp.stack(S), row, nu[None]]))
        return rows

    def sighting_rows(self, HFP, lever, a, variance):
        """S from the diagonal on and H P^-, of HFP [2M, N, T], H's column of the heading [2M, ...], a [2, ...]"""
        xp = self.xp
        heading = HFP[:, 0] + HEADING**2 * lever
        robot = HFP[:, 1:3] + HFP[:, :1] * a
        robot = robot - ODOMETRY**2 * xp.tile(xp.eye(2), (M, 1)).reshape(ROWS, 2, *(lever.ndim - 1) * (1,))
        features = xp.broadcast_to(HFP[:, 3:], (ROWS, *lever.shape))
        rows = []
        for r in range(ROWS):
            S = lever[r:] * heading[r] + features[r, r:]
            S = S - xp.concatenate([robot[r]] * M)[r:]
            rows.append(xp.concatenate([S[:1] + variance[r // 2], S[1:], heading[r][None], robot[r], features[r]]))
        return rows

    def plan(self, P, HFP, theta, d0):
        """The least trace; the later of equals [Controllers]."""
        xp = self.xp
        HFP, d0 = HFP[:, :, None], d0[:, :, None]

        def cost(group):
            u = rotated(xp, theta, group[1:])
            a = xp.stack([-u[1], u[0]])
            d = d0 - u
            seen, sigma = self.looked(d)
            lever = xp.stack([d[:, 1], -d[:, 0]], 1).reshape(ROWS, *u.shape[1:])
            rows = self.sighting_rows(HFP, lever, a, sigma**2)
            inverses = eliminated(rows, xp.repeat(seen, 2, 0), self.apart)
            gain = sum((row[-N:] ** 2).sum(0) * inverse for row, inverse in zip(rows, inverses))
            return 2 * (a[0] * P[0, 1] + a[1] * P[0, 2]) + (u**2).sum(0) * P[0, 0] - gain

        prior = sum(P[i, i] for i in range(N)) + HEADING**2 + 2 * ODOMETRY**2
        costs = self.over(cost, self.candidates).reshape(-1, len(prior)) + prior
        last = (costs <= costs.min(0) * (1 + 1e-12))[::-1].argmax(0)
        return xp.concatenate(list(self.candidates), 1)[:, len(costs) - 1 - last, 0]

    def step(self, state, normals, translation):
        xp = self.xp
        theta, robot, centre, mean, P, sums = state
        odometry, walk, deformation, measurement = self.parted(normals)
        t = translation[:, None]
        centre = centre + t + WALK * walk
        feature = centre + DEFORMATION * deformation
        expected = mean[3:].reshape(M, 2, -1) + t
        P, correction, nis = self.updated(
            P + self.feature_noise, self.edge_rows(P + self.feature_noise, feature - expected), [1] * 4)

        d0 = expected - mean[1:3]
        block = P[3:].reshape(M, 2, N, -1)
        J_d0 = xp.stack([-d0[:, 1], d0[:, 0]], 1)
        HFP = (block - P[1:3] - J_d0[:, :, None] * P[0]).reshape(ROWS, N, -1)
        control = self.candidates[0, :, 0] if self.controller == "fixed" else self.plan(P, HFP, mean[0], d0)

        u = rotated(xp, mean[0], control[1:])
        a = xp.stack([-u[1], u[0]])
        robot = robot + rotated(xp, theta, control[1:]) + ODOMETRY * odometry[1:]
        theta = theta + control[0] + HEADING * odometry[0]
        predicted = xp.concatenate([mean[:1] + control[0], mean[1:3] + u, expected.reshape(ROWS, -1)])
        P = xp.concatenate([P[:1], P[1:3] + a[:, None] * P[0], P[3:]])
        P = xp.concatenate([P[:, :1], P[:, 1:3] + P[:, :1] * a, P[:, 3:]], 1) + self.robot_noise
        correction = xp.concatenate([correction[:1], correction[1:3] + a * correction[0], correction[3:]])

        offset = feature - robot
        seen, sigma = self.looked(offset)
        d = d0 - u
        turned = rotated(xp, predicted[0] - theta, xp.moveaxis(offset, 1, 0))
        drawn = rotated(xp, predicted[0], xp.moveaxis(measurement, 1, 0))
        innovation = xp.moveaxis(turned + sigma * drawn, 0, 1) - d
        lever = xp.stack([d[:, 1], -d[:, 0]], 1)
        moved = lever * correction[0] - correction[1:3] + correction[3:].reshape(M, 2, -1)
        innovation, lever = (innovation - moved).reshape(ROWS, -1), lever.reshape(ROWS, -1)
        rows = self.sighting_rows(HFP, lever, a, sigma**2)
        rows = [xp.concatenate([row, nu[None]]) for row, nu in zip(rows, innovation)]
        P, further, nis_seen = self.updated(P, rows, xp.repeat(seen, 2, 0))
        mean = predicted + correction + further

        error = mean - xp.concatenate([theta[None], robot, feature.reshape(ROWS, -1)])
        heading = error[:1] - 2 * math.pi * xp.round(error[:1] / (2 * math.pi))
        error = xp.concatenate([heading, error[1:]])
        rows = [xp.concatenate([P[i, i:], error[i : i + 1]]) for i in range(N)]
        nees = sum(row[-1] ** 2 * inverse for row, inverse in zip(rows, eliminated(rows, [1] * N, self.apart)))
        count = seen.sum(0)
        sums = sums + xp.stack([M - count, (error[:3] ** 2).sum(0), nees, nis + nis_seen, 2 * count + M * (M - 1)])
        return theta, robot, centre, mean, P, sums

    def columns(self, state):
        P, (unseen, pose_error, nees, nis, rows) = state[4], state[5]
        trace = sum(P[i, i] for i in range(N))
        return self.xp.stack([trace, unseen, pose_error, nees / ((K - 1) * N), nis / rows])
