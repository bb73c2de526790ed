"""The world `explore` in a second program, written from docs/explore.md and docs/model.md with dense matrices:

    python3 explore_oracle.py CREDENCE [SCENARIOS [SEED]]

Every column of every trial of random scenarios (walls, views, detection, maps, controllers, criteria, estimators) is
that of the program to 1e-9; and so are the costs of the planners' candidates in a trial of each.
"""

import configparser
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np
from draws_oracle import pair, uniform

HEADING, POSITION, MEASUREMENT, DETECTION, PRIOR, CONTROL, PLACEMENT, OUTLIER = 0, 1, 4, 6, 7, 8, 9, 11
J = np.array([[0.0, -1.0], [1.0, 0.0]])
PASSES = 8


def R(theta):
    c, s = math.cos(theta), math.sin(theta)
    return np.array([[c, -s], [s, c]])


def points(text):
    return [np.array(pair.split(), float) for pair in text.split(",")] if text != "none" else []


class Settings:
    """A scenario as `credence show` prints it."""

    def __init__(self, text):
        self.ini = configparser.ConfigParser(inline_comment_prefixes=("#",))
        self.ini.read_string(text)
        real = lambda key: float(self.get(key))  # noqa: E731
        self.K = int(self.get("scenario.poses"))
        self.places = points(self.get("features.positions"))
        self.placement = self.get("features.placement")
        self.M = len(self.places) if self.placement == "given" else int(self.get("features.count"))
        self.extent, self.inner, self.outer = map(
            real, ("features.extent", "features.radius_min", "features.radius_max"))
        self.walls = [ends.reshape(2, 2) for ends in points(self.get("walls.segments"))]
        self.radius, self.step = real("robot.radius"), real("robot.step")
        self.map, self.prior = self.get("landmarks.map"), real("landmarks.prior")
        self.near, self.far, self.view = real("sensor.range_min"), real("sensor.range_max"), real("sensor.view")
        self.detection, self.every = real("sensor.detection"), int(self.get("sensor.every"))
        self.heading, self.odometry = real("noise.heading"), real("noise.odometry")
        self.start_heading, self.start_position = real("noise.initial_heading"), real("noise.initial_position")
        self.on_report = self.get("noise.of") == "report"
        truncate = self.get("noise.truncate")
        self.limit = math.inf if truncate == "none" else float(truncate)
        self.tails = self.get("noise.measurement_tails")
        self.nu, self.share, self.scale = map(
            real, ("noise.degrees_of_freedom", "noise.outlier_share", "noise.outlier_scale"))
        self.Q = np.diag([(real("filter.heading") * self.heading) ** 2]
                         + 2 * [(real("filter.odometry") * self.odometry) ** 2])
        self.believed, self.reported = real("filter.measurement"), real("filter.covariance")
        gate = real("filter.gate")
        self.gate = math.inf if gate == 1 else -2 * math.log(1 - gate)
        self.criterion, self.weight = self.get("planner.criterion"), real("planner.heading_weight")
        speeds = int(self.get("planner.speeds"))
        self.candidates = [(turn, i / 5 * self.step * np.array([math.cos(turn), math.sin(turn)]))
                           for turn in map(float, self.get("planner.turns").split(","))
                           for i in range(-speeds, speeds + 1)]
        self.reach = max(np.linalg.norm(move) for _, move in self.candidates)
        self.worth, self.horizon = real("planner.coverage"), int(self.get("planner.horizon"))
        low, high = points(self.get("map.box"))
        self.cell = real("map.cell")
        self.columns, self.rows = (math.ceil(side / self.cell - 1e-9) for side in high - low)
        self.low = low
        self.centres = np.array([low + self.cell * (np.array([c, r]) + 0.5)
                                 for r in range(self.rows) for c in range(self.columns)])
        self.waypoints = points(self.get("control.waypoints"))
        self.controllers = self.get("arms.controllers").split(", ")
        self.estimators = self.get("arms.estimators").split(", ")

    def get(self, key):
        return self.ini.get(*key.split(".", 1))

    def sigma(self, q):
        if self.get("sensor.noise") == "constant":
            return float(self.get("sensor.sigma"))
        near, far = float(self.get("sensor.sigma_near")), float(self.get("sensor.sigma_far"))
        return near + (far - near) * max(0, q - self.near) / (self.far - self.near)


def blocked(walls, eye, point):
    """Whether a wall crosses the line from the eye to the point before its end."""
    for a, b in walls:
        matrix = np.array([point - eye, a - b]).T
        if np.linalg.det(matrix) == 0:
            continue
        t, u = np.linalg.solve(matrix, a - eye)
        if 0 <= t <= 1 - 1e-9 and 0 <= u <= 1:
            return True
    return False


def clearance(wall, place):
    a, b = wall
    t = np.clip((place - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)
    return np.linalg.norm(place - a - t * (b - a))


def free(walls, radius, place, move):
    """The share of the move after which the clearance of some wall falls below the radius: the first root of the
    distance from its line and from its ends, of those at which the robot comes nearer."""
    share = 1.0
    for a, b in walls:
        length = np.linalg.norm(b - a)
        along = (b - a) / length
        normal = J @ along
        side, speed = normal @ (place - a), normal @ move
        if side * speed < 0:
            t = max(0, (abs(side) - radius) / abs(speed))
            if 0 <= along @ (place + t * move - a) <= length:
                share = min(share, t)
        for end in (a, b):
            away = place - end
            half, rest = away @ move, away @ away - radius**2
            if half < 0 and half**2 >= (move @ move) * rest:
                share = min(share, max(0, (-half - math.sqrt(half**2 - (move @ move) * rest)) / (move @ move)))
    return share


class World:
    """The truth of one trial and what a robot in it sees."""

    def __init__(self, s, seed, trial):
        self.s, self.key = s, (seed, trial)
        self.theta = s.start_heading * self.draw(HEADING, 0)[0]
        self.r = s.start_position * self.draw(POSITION, 0)
        self.f = np.array([self.place(j) for j in range(s.M)])
        self.path = self.collisions = 0

    def draw(self, source, k, j=0):
        value = pair(*self.key, k, source, j)
        for attempt in range(1, 4096):
            if (abs(value) <= self.s.limit).all():
                break
            value = np.where(abs(value) > self.s.limit, pair(*self.key, k, source, j, attempt), value)
        return value

    def number(self, source, k, j=0):
        return uniform(*self.key, k, source, j)

    def place(self, j):
        s = self.s
        if s.placement == "given":
            return s.places[j]
        u, v = self.number(PLACEMENT, 0, 2 * j), self.number(PLACEMENT, 0, 2 * j + 1)
        if s.placement == "box":
            return s.places[0] + s.extent * np.array([u - 0.5, v - 0.5])
        radius = math.sqrt(s.inner**2 + u * (s.outer**2 - s.inner**2))
        return s.places[0] + radius * np.array([math.cos(2 * math.pi * v), math.sin(2 * math.pi * v)])

    def noise(self, k, j):
        s, normal = self.s, self.draw(MEASUREMENT, k, j)
        if s.tails == "student":
            length = np.linalg.norm(normal)
            return normal / length * math.sqrt(s.nu * math.expm1(length**2 / s.nu) * (s.nu - 2) / s.nu)
        if s.tails == "contaminated" and self.number(OUTLIER, k, j) < s.share:
            return s.scale * normal
        return normal

    def move(self, turn, move, k):
        """Returns what the filter is told."""
        s, before = self.s, self.r
        heading, position = s.heading * self.draw(HEADING, k)[0], s.odometry * self.draw(POSITION, k)
        noisy = not s.on_report
        way = R(self.theta) @ move + noisy * position
        share = free(s.walls, s.radius, before, way)
        self.stopped = share < 1
        self.collisions += self.stopped
        self.r = before + share * way
        self.theta += turn + noisy * heading
        self.path += np.linalg.norm(self.r - before)
        for wall in s.walls:
            assert not blocked([wall], before, self.r), "the truth crossed a wall"
            assert clearance(wall, self.r) > min(clearance(wall, before), s.radius) - 1e-9, "the truth is too near"
        return (turn, move) if noisy else (turn - heading, move - position)

    def sigma_and_z(self, k, j):
        d = self.f[j] - self.r
        sigma = self.s.sigma(np.linalg.norm(d))
        return sigma, R(self.theta).T @ d + sigma * self.noise(k, j)

    def seen(self, k):
        s = self.s
        return [j for j in range(s.M) if k % s.every == 0 and in_range(s, self.r, self.f[j])
                and in_view(s, self.r, self.theta, self.f[j])
                and (s.detection == 1 or self.number(DETECTION, k, j) < s.detection)]


def in_range(s, eye, point):
    return s.near <= np.linalg.norm(point - eye) <= s.far


def in_view(s, eye, theta, point):
    d = point - eye
    bearing = math.remainder(math.atan2(d[1], d[0]) - theta, 2 * math.pi) if d.any() else 0
    return abs(bearing) <= s.view / 2 and not blocked(s.walls, eye, point)


def new_cells(s, eye, theta, viewed):
    return [i for i in np.flatnonzero(~viewed)
            if np.linalg.norm(s.centres[i] - eye) <= s.far and in_view(s, eye, theta, s.centres[i])]


def at(j):
    return slice(3 + 2 * j, 5 + 2 * j)


class Filter:
    """The belief of one trial; `there`: landmarks in the state, `mapped`: those that a sighting has placed."""

    def __init__(self, world, estimator):
        s, self.world, self.estimator = world.s, world, estimator
        self.s, self.n = s, 3 + 2 * s.M
        self.x, self.P = np.zeros(self.n), np.zeros((self.n, self.n))
        self.P[:3, :3] = np.diag([s.start_heading**2] + 2 * [s.start_position**2])
        self.there, self.mapped = set(), set()
        for j in range(s.M):
            if s.map == "none":
                continue
            sigma = s.prior
            if s.map == "known":
                sigma = s.sigma(np.linalg.norm(world.f[j] - world.r))
                self.x[at(j)] = world.f[j] + sigma * world.noise(0, j)
                self.mapped.add(j)
                sigma *= s.believed
            else:
                self.x[at(j)] = world.f[j] + sigma * world.draw(PRIOR, 0, j)
            self.P[at(j), at(j)] = sigma**2 * np.eye(2)
            self.there.add(j)
        self.first = self.x[3:].reshape(-1, 2).copy()  # first estimates
        self.prior_position, self.true_position = self.x[1:3].copy(), world.r
        self.nis = self.rows = 0
        if s.map != "known":
            self.initialise(world.seen(0), 0)

    def index(self):
        return np.array([0, 1, 2] + [3 + 2 * j + axis for j in sorted(self.there) for axis in (0, 1)])

    def predict(self, turn, move):
        moved = R(self.x[0]) @ move
        after = self.x[1:3] + moved
        levers = {"ideal": self.world.r - self.true_position, "fej": after - self.prior_position}
        lever = levers.get(self.estimator, moved)
        F = np.eye(self.n)
        F[1:3, 0] = J @ lever
        self.P = F @ self.P @ F.T
        self.P[:3, :3] += self.s.Q
        self.x = np.concatenate([[self.x[0] + turn], after, self.x[3:]])
        self.prior_position, self.true_position = after.copy(), self.world.r

    def row(self, x, j):
        """Rows of the sighting of landmark j and the expected sighting, linearised as the estimator does."""
        H = np.zeros((2, self.n))
        theta, d = x[0], x[at(j)] - x[1:3]
        expected = R(theta).T @ d
        if self.estimator == "ideal":
            theta, d = self.world.theta, self.world.f[j] - self.world.r
        if self.estimator == "fej":
            d = self.first[j] - x[1:3]
        H[:, 0], H[:, 1:3], H[:, at(j)] = -R(theta).T @ J @ d, -R(theta).T, R(theta).T
        return H, expected

    def measured(self, k, seen):
        """Of the known landmarks in `seen`, after the gate: their numbers, sigmas and measurements."""
        kept = []
        for j in seen:
            if j not in self.mapped:
                continue
            sigma, z = self.world.sigma_and_z(k, j)
            H, expected = self.row(self.x, j)
            S = H @ self.P @ H.T + (self.s.believed * sigma) ** 2 * np.eye(2)
            if (z - expected) @ np.linalg.solve(S, z - expected) <= self.s.gate:
                kept.append((j, sigma, z))
        return kept

    def update(self, kept):
        x, P, delta = self.x, self.P, np.zeros(self.n)
        self.nis, self.rows = 0, 2 * len(kept)
        if kept:
            N = np.diag(np.repeat([(self.s.believed * sigma) ** 2 for _, sigma, _ in kept], 2))
            for done in range(PASSES if self.estimator == "iekf" else 1):
                stacked = [self.row(x + delta, j) for j, _, _ in kept]
                H = np.vstack([rows for rows, _ in stacked])
                nu = np.concatenate([z - e for (_, _, z), (_, e) in zip(kept, stacked)]) + H @ delta
                S = H @ P @ H.T + N
                K = np.linalg.solve(S, H @ P).T
                if done == 0:
                    self.nis = nu @ np.linalg.solve(S, nu)
                delta = K @ nu
            self.P = P - K @ S @ K.T
        if self.estimator == "riekf" and delta[0] != 0:
            a = delta[0]
            V = np.array([[math.sin(a), math.cos(a) - 1], [1 - math.cos(a), math.sin(a)]]) / a
            delta[1:] = (delta[1:].reshape(-1, 2) @ V.T).ravel()
            A = np.eye(self.n)
            A[1:, 0] = (delta[1:].reshape(-1, 2) @ J.T).ravel()
            self.P = A @ self.P @ A.T
        self.x = x + delta

    def initialise(self, seen, k):
        for j in seen:
            if j in self.mapped:
                continue
            sigma, z = self.world.sigma_and_z(k, j)
            place = self.x[1:3] + R(self.x[0]) @ z
            self.x[at(j)] = self.first[j] = place
            lever = place - self.x[1:3]
            if self.estimator == "ideal":
                lever = self.world.f[j] - self.world.r
            if self.estimator == "fej":
                lever = place - self.prior_position
            G = np.hstack([(J @ lever)[:, None], np.eye(2)])
            rows = G @ self.P[:3]
            self.P[at(j)], self.P[:, at(j)] = rows, rows.T
            self.P[at(j), at(j)] = G @ self.P[:3, :3] @ G.T + (self.s.believed * sigma) ** 2 * np.eye(2)
            self.there.add(j)
            self.mapped.add(j)

    def error(self):
        e = self.x - np.concatenate([[self.world.theta], self.world.r, self.world.f.ravel()])
        e[0] = math.remainder(e[0], 2 * math.pi)
        return e

    def cost(self, P):
        s, here = self.s, self.index()
        P = P[np.ix_(here, here)]
        weights = np.concatenate([[s.weight], np.ones(len(here) - 1)])
        part = {"pose_trace": np.arange(len(here)) < 3, "features_trace": np.arange(len(here)) >= 3}
        if s.criterion == "log_det":
            return np.linalg.slogdet(P)[1]
        if s.criterion == "pose_log_det":
            return np.linalg.slogdet(P[:3, :3])[1]
        if s.criterion == "max_eigenvalue":
            return np.linalg.eigvalsh(np.sqrt(np.outer(weights, weights)) * P)[-1]
        return (weights * np.diag(P) * part.get(s.criterion, True)).sum()

    def costs(self, viewed, informed):
        x = self.x.copy()
        if informed:
            x = np.concatenate([[self.world.theta], self.world.r, self.world.f.ravel()])
        return self.costs_from(x, self.P, viewed, 1)

    def costs_from(self, x, before, viewed, steps):
        """The candidates' costs, None where a wall forbids one; over several steps the least sum with each as the
        first, None where a wall ends every sequence."""
        s, costs = self.s, []
        for turn, move in s.candidates:
            moved = R(x[0]) @ move
            if free(s.walls, s.radius, x[1:3], moved) < 1:
                costs.append(None)
                continue
            F = np.eye(self.n)
            F[1:3, 0] = J @ moved
            P = F @ before @ F.T
            P[:3, :3] += s.Q
            y = np.concatenate([[x[0] + turn], x[1:3] + moved, x[3:]])
            for j in sorted(self.there):
                d = y[at(j)] - y[1:3]
                if not (in_range(s, y[1:3], y[at(j)]) and in_view(s, y[1:3], y[0], y[at(j)])):
                    continue
                H = np.zeros((2, self.n))
                H[:, 0], H[:, 1:3], H[:, at(j)] = -J @ d, -np.eye(2), np.eye(2)
                S = H @ P @ H.T + (s.believed * s.sigma(np.linalg.norm(d))) ** 2 * np.eye(2)
                K = np.linalg.solve(S, H @ P).T
                P = P - K @ S @ K.T
            cells = new_cells(s, y[1:3], y[0], viewed) if s.worth else []
            costs.append(self.cost(P) - s.worth * len(cells))
            if steps > 1:
                then = viewed.copy()
                then[cells] = True
                rest = [cost for cost in self.costs_from(y, P, then, steps - 1) if cost is not None]
                costs[-1] = costs[-1] + min(rest) if rest else None
        return costs


def towards(s, x, place):
    way = place - x[1:3]
    length = np.linalg.norm(way)
    if length <= 1e-9 * s.reach:
        return 0.0, np.zeros(2)
    move = R(x[0]).T @ (way * min(1, s.reach / length))
    return math.atan2(move[1], move[0]), move


def ways(s):
    """The neighbours of each cell that a robot can reach: east, north, west, south."""
    clear = [all(clearance(wall, c) >= s.radius for wall in s.walls) for c in s.centres]
    found = []
    for i in range(len(s.centres)):
        row, column = divmod(i, s.columns)
        found.append([])
        for r, c in ((row, column + 1), (row + 1, column), (row, column - 1), (row - 1, column)):
            j = r * s.columns + c
            if 0 <= r < s.rows and 0 <= c < s.columns and clear[i] and clear[j] and \
                    free(s.walls, s.radius, s.centres[i], s.centres[j] - s.centres[i]) == 1:
                found[-1].append(j)
    return found


def frontier(s, x, viewed, neighbours):
    column, row = (int(np.clip(math.floor(v), 0, n - 1)) for v, n in
                   zip((x[1:3] - s.low) / s.cell, (s.columns, s.rows)))
    start = row * s.columns + column
    paths = {start: []}
    queue = [start]
    for cell in queue:
        if cell != start and not viewed[cell]:
            target = s.centres[paths[cell][0]]
            if free(s.walls, s.radius, x[1:3], target - x[1:3]) < 1:
                target = s.centres[start]
            return towards(s, x, target)
        for other in neighbours[cell]:
            if other not in paths:
                paths[other] = paths[cell] + [other]
                queue.append(other)
    return 0.0, np.zeros(2)


def along(s):
    """The controls of the fixed path, from pose k - 1 to k for k = 1 ... K - 1."""
    if s.get("control.path") != "waypoints":
        turn = float(s.get("robot.turn")) if s.get("control.path") == "circle" else 0.0
        return [(turn, s.step * np.array([math.cos(turn), math.sin(turn)]))] * (s.K - 1)
    def place(length):
        here = np.zeros(2)
        for there in s.waypoints:
            leg = np.linalg.norm(there - here)
            if length < leg:
                return here + length / leg * (there - here)
            length, here = length - leg, there
        return here
    theta, controls = 0.0, []
    for k in range(s.K - 1):
        way = place((k + 1) * s.step) - place(k * s.step)
        if np.linalg.norm(way) <= 1e-9 * s.step:
            controls.append((0.0, np.zeros(2)))
            continue
        move = R(theta).T @ way
        controls.append((math.atan2(move[1], move[0]), move))
        theta += controls[-1][0]
    return controls


def trial(s, seed, number, controller, estimator, tables):
    """The columns, and the candidates' costs by step."""
    world = World(s, seed, number)
    belief = Filter(world, estimator)
    viewed = np.zeros(len(s.centres), bool)
    viewed[new_cells(s, world.r, world.theta, viewed)] = True
    steps = s.K - 1
    pose_error = (belief.error()[:3] ** 2).sum()
    unseen = nis = rows = ratio = score = traces = 0
    all_costs = []
    for k in range(1, s.K):
        if controller == "fixed":
            turn, move = tables["along"][k - 1]
        elif controller == "random":
            turn, move = s.candidates[int(world.number(CONTROL, k) * len(s.candidates))]
        elif controller == "frontier":
            turn, move = frontier(s, belief.x, viewed, tables["ways"])
        else:
            ahead = min(s.horizon, s.K - k)
            costs = (belief.costs_from(belief.x, belief.P, viewed, ahead) if controller == "horizon" else
                     belief.costs(viewed, controller == "informed"))
            all_costs.append(costs)
            best, turn, move = math.inf, 0.0, np.zeros(2)
            logarithm = s.worth > 0 or s.criterion.endswith("log_det")
            for cost, candidate in zip(costs, s.candidates):
                if cost is not None and cost <= (best + 1e-11 if logarithm else best * (1 + 1e-12)):
                    turn, move = candidate
                if cost is not None:
                    best = min(best, cost)
        told = world.move(turn, move, k)
        belief.predict(*told)
        seen = world.seen(k)
        viewed[new_cells(s, world.r, world.theta, viewed)] = True
        kept = belief.measured(k, seen)
        unseen += s.M - len(kept) - len(set(seen) - belief.mapped)
        belief.update(kept)
        belief.initialise(seen, k)
        e, here = belief.error(), belief.index()
        pose_error += (e[:3] ** 2).sum()
        P = s.reported * belief.P[np.ix_(here, here)]
        nees = e[here] @ np.linalg.solve(P, e[here])
        ratio += nees / len(here) / steps
        score += (len(here) * math.log(2 * math.pi) + np.linalg.slogdet(P)[1] + nees) / 2 / steps
        traces += np.trace(P) / steps
        nis, rows = nis + belief.nis, rows + belief.rows
    return {"trace_P": np.trace(P), "unseen": unseen, "pose_error": pose_error, "nees_ratio": ratio,
            "nis_ratio": nis / rows if rows else math.nan, "mean_trace_P": traces, "log_score": score,
            "path_length": world.path, "discovered": len(belief.mapped), "coverage": viewed.mean(),
            "collisions": world.collisions}, all_costs


def random_scenario(rng):
    """Lines of a scenario, small enough for this program."""
    pick = lambda *values: values[rng.integers(len(values))]  # noqa: E731
    walls = []
    for _ in range(rng.integers(0, 5)):
        start, length, angle = rng.uniform(-4, 4, 2), rng.uniform(1, 4), rng.uniform(0, 7)
        wall = np.array([start, start + length * np.array([math.cos(angle), math.sin(angle)])])
        if clearance(wall, np.zeros(2)) > 0.4:
            walls.append(" ".join(f"{value:.3f}" for value in wall.ravel()))
    placement = pick("given", "box", "ring")
    lines = {"scenario": {"world": "explore", "name": "random", "poses": int(rng.integers(8, 20))},
             "walls": {"segments": ", ".join(walls) or "none"},
             "robot": {"radius": pick(0.1, 0.3), "step": pick(0.5, 1), "turn": pick(0.3, -0.6)},
             "features": {"placement": placement, "extent": 8, "radius_min": 1, "radius_max": 4},
             "landmarks": {"map": pick("none", "none", "prior", "known"), "prior": pick(1, 5)},
             "sensor": {"range_max": pick(2, 4), "range_min": pick(0, 0.3), "view": pick(1.5, 4, 6.3),
                        "noise": pick("constant", "ranged"), "detection": pick(1, 0.7), "every": pick(1, 1, 2)},
             "noise": {"heading": pick(0.005, 0.05), "odometry": pick(0.02, 0.1), "of": pick("motion", "report"),
                       "initial_heading": pick(0, 0.1), "initial_position": pick(0, 0.05), "truncate": pick("none", 2),
                       "measurement_tails": pick("normal", "normal", "student", "contaminated")},
             "map": {"box": "-4 -3, 4 4", "cell": pick(0.8, 1)},
             "filter": {"heading": pick(1, 1.2), "measurement": pick(1, 0.9), "covariance": pick(1, 1.5),
                        "gate": pick(1, 1, 0.99)},
             "control": {"waypoints": "2 0, 2 2, -2 2", "path": pick("waypoints", "waypoints", "circle", "straight")},
             "planner": {"criterion": pick("trace", "trace", "pose_trace", "features_trace", "log_det", "pose_log_det",
                                           "max_eigenvalue"),
                         "heading_weight": pick(1, 3), "speeds": pick(1, 2), "turns": pick("0", "-0.8, 0, 0.9"),
                         "coverage": pick(0, 0, 0.1)},
             "arms": {"controllers": pick("fixed, random, frontier, greedy, informed", "horizon, greedy"),
                      "estimators": ", ".join(rng.choice(["ekf", "riekf", "fej", "iekf", "ideal"], 2, False))}}
    if placement == "given":
        lines["features"]["positions"] = ", ".join(
            " ".join(f"{value:.3f}" for value in rng.uniform(-4, 4, 2)) for _ in range(rng.integers(1, 8)))
    else:
        lines["features"].update(count=int(rng.integers(1, 8)), positions="0.5 0.2")
    return "".join(f"[{section}]\n" + "".join(f"{key} = {value}\n" for key, value in keys.items())
                   for section, keys in lines.items())


def check(credence, text, seed, trials, folder):
    """Returns the number of trials, and of planned steps."""
    scenario, study, replayed = folder / "random.ini", folder / "study.h5", folder / "trial.h5"
    scenario.write_text(text)
    shown = subprocess.run([credence, "show", scenario], check=True, stdout=subprocess.PIPE, text=True).stdout
    subprocess.run([credence, "run", scenario, "--trials", str(trials), "--seed", str(seed), "--quiet", "--overwrite",
                    "-o", study], check=True, stdout=subprocess.DEVNULL)
    s = Settings(shown)
    tables, planned = {"along": along(s), "ways": ways(s)}, 0
    arms = [(controller, estimator) for controller in s.controllers for estimator in s.estimators]
    with h5py.File(study) as file:
        for controller, estimator in arms:
            group = file[f"random/{controller}.{estimator}"]
            for number in range(trials):
                if group["status"][number] > 1:
                    continue
                columns, costs = trial(s, seed, number, controller, estimator, tables)
                for name, value in columns.items():
                    ours, scale = group[name][number], max(abs(value), 1e-3)
                    assert abs(ours - value) <= 1e-9 * scale or (math.isnan(ours) and math.isnan(value)), \
                        f"{controller}.{estimator} trial {number} {name}: {ours} and {value}\n{text}"
                planned += len(costs)
                if number or not costs:
                    continue
                subprocess.run([credence, "replay", study, "--scenario", "random", "--arm", f"{controller}.{estimator}",
                                "--trial", "0", "--overwrite", "-o", replayed], check=True, stdout=subprocess.DEVNULL)
                with h5py.File(replayed) as one:
                    own = one[f"random/{controller}.{estimator}/candidate_cost"][1:]
                wanted = np.array([[math.nan if cost is None else cost for cost in step] for step in costs])
                # What is not in the state has a variance of 2^-200 there.
                assert np.allclose(own, wanted, rtol=1e-8, atol=1e-8 if s.worth or "log" in s.criterion else 1e-50,
                                   equal_nan=True), f"{controller}.{estimator}: costs\n{text}"
    return len(arms) * trials, planned


def main(credence, scenarios=12, seed=1):
    rng = np.random.default_rng(int(seed))
    total = np.zeros(2, int)
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(int(scenarios)):
            total += check(credence, random_scenario(rng), int(rng.integers(2**63)), 3, Path(folder))
    print(f"{total[0]} trials of {scenarios} scenarios, {total[1]} planned steps: every column to 1e-9")


if __name__ == "__main__":
    main(*sys.argv[1:])
