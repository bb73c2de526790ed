"""What the scores say of parameters at their best: standard errors, intervals, and what cannot be told.

Where the score is a parabola about the best and the bounds are far, curvatures and the spread of gradients say it all.
Elsewhere the profile does: the least score where one parameter is fixed, at a few places from the best to its bounds.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from credence._trials import Array
from credence._tune_search import Objective, local

STEP = 0.03  # of w in differences, where it is a logarithm; of others this share of their natural scale
AT_BOUND = 1e-3  # of the range: so near to a bound is at it
FLAT = 1e-6  # a curvature is nothing if it is less than this share of the largest
DOUBTFUL = 0.05  # share of the largest curvature below which one is measured along its own direction
MOVED = 0.05  # share of a direction from which on it moves a parameter
FEW_TRIALS = 20  # the spread of fewer curvatures says nothing
AGREE = 0.2  # so much the curvatures by a step and by twice the step may differ
NEAR = 3.0  # half intervals: a bound that is nearer than that is looked at by the profile
ROUNDING = 1e-12  # share of the score below which a difference is nothing
RADIUS, END = 0.03, 3e-3  # of the range, in a search along a profile
NARROW = 0.1  # of a logarithm, or of the distance to a bound: what a profile is halved to
HALVINGS = 14  # at most


@dataclass
class Known:
    """What the scores say of the parameters at the best point.

    Attributes
    ----------
    error : array [p]
        Standard errors of w: infinite where a direction that the score does not see moves the parameter, NaN where
        there is none: at a bound, where a bound is not excluded, or where the score jumps.
    hessian : array [p, p]
        Of the number that is minimised; 0 for parameters at a bound.
    critical : float
        Student's t of the trials, two-sided at 5 %.
    interval : array [p, 2]
        Where w is at 95 %: infinite where a bound is not excluded, NaN where nothing is known.
    flat : list of arrays [p]
        Directions of w that the score does not see.
    bounds : dict of str
        {parameter at a bound: ``lower`` or ``upper``}.
    jumping : list of int
        Parameters that the score sees, and about whose best it is no parabola.
    instead : dict of arrays [p]
        {parameter: the best point where it is at the bound that is not excluded}.
    """

    error: Array
    hessian: Array
    critical: float
    interval: Array
    flat: list[Array] = field(default_factory=list)
    bounds: dict[str, str] = field(default_factory=dict)
    jumping: list[int] = field(default_factory=list)
    instead: dict[int, Array] = field(default_factory=dict)


def _differences(objective: Objective, w: Array, h: Array, free: list[int]) -> tuple[Array, Array]:
    """Gradient [trial, p] and Hessian [trial, p, p] of each trial's score; with NEES of log(mean NEES/n)^2, whose
    Hessian is the same for all trials."""

    def at(*moves: tuple[int, int]) -> Array:
        moved = w.copy()
        for j, sign in moves:
            moved[j] += sign * h[j]
        return objective.scores(moved)

    here, p = at(), len(free)
    plus, minus = [at((j, 1)) for j in free], [at((j, -1)) for j in free]
    steps = h[free]
    if objective.source.objective == "nees":
        slopes = np.array([np.log(np.mean(a) / np.mean(b)) for a, b in zip(plus, minus)]) / (2 * steps)
        gradient = 2 * slopes * (here / np.mean(here) - 1)[:, None]
        return gradient, np.broadcast_to(2 * np.outer(slopes, slopes), (len(here), p, p))
    gradient = np.stack([(a - b) / (2 * step) for a, b, step in zip(plus, minus, steps)], axis=1)
    hessian = np.empty((len(here), p, p))
    for a in range(p):
        hessian[:, a, a] = (plus[a] + minus[a] - 2 * here) / steps[a] ** 2
        for b in range(a):
            both = at((free[a], 1), (free[b], 1)) + at((free[a], -1), (free[b], -1))
            mixed = (both - plus[a] - minus[a] - plus[b] - minus[b] + 2 * here) / (2 * steps[a] * steps[b])
            hessian[:, a, b] = hessian[:, b, a] = mixed
    return gradient, hessian


def _steps(objective: Objective, w: Array, free: list[int]) -> Array:
    """The step of each parameter's differences."""
    space = objective.space
    h = np.where(space.is_log, STEP, 0.01)
    for j in free:
        if not space.is_log[j] and objective.source.objective != "nees":
            move = np.zeros(len(w))
            move[j] = min(h[j], w[j], 1 - w[j])
            second = objective.value(w + move) + objective.value(w - move) - 2 * objective.value(w)
            if second > 0:
                h[j] = float(np.clip(STEP * move[j] / math.sqrt(second), 1e-4, 0.05))
    room = np.minimum(w, space.range - w) / 2  # for twice the step
    return np.where(room > 0, np.minimum(h, room), h)


def _is_flat(objective: Objective, w: Array, v: Array, found: Array, largest: float) -> bool:
    """Whether the score does not see a direction: its curvature is below twice its standard error, or nothing."""
    if objective.source.objective != "nees":
        here = objective.scores(w)
        found = (objective.scores(w + STEP * v) + objective.scores(w - STEP * v) - 2 * here) / STEP**2
    mean, spread = float(np.mean(found)), float(np.std(found, ddof=1)) if len(found) >= FEW_TRIALS else 0.0
    return not mean > max(2 * spread / math.sqrt(len(found)), FLAT * largest)


def _curvature(objective: Objective, w: Array, result: Known, free: list[int]) -> list[Array]:
    """Standard errors by the sandwich H^-1 J H^-1 / N of per-trial scores [Huber 1967; White 1982], in the directions
    that have a curvature; the others are returned."""
    p = len(w)
    doubtful_ones = []
    h = _steps(objective, w, free)
    gradient, hessian = _differences(objective, w, h, free)
    mean, count = hessian.mean(axis=0), len(gradient)
    if not np.isfinite(mean).all() or count < 2:
        return []
    result.hessian[np.ix_(free, free)] = mean
    curvatures, vectors = np.linalg.eigh(mean)
    largest, seen = curvatures[-1], np.ones(len(free), dtype=bool)
    spread = np.cov(gradient, rowvar=False).reshape(len(free), len(free)) / count
    for i, curvature in enumerate(curvatures):
        v = np.zeros(p)
        v[free] = vectors[:, i]
        along = np.einsum("tij,i,j->t", hessian, vectors[:, i], vectors[:, i])
        doubtful = curvature < DOUBTFUL * largest or not curvature > 0
        seen[i] = not (doubtful and _is_flat(objective, w, v, along, max(largest, 0)))
        if seen[i]:  # a standard error says nothing either of what may be anywhere between the bounds
            error = math.sqrt(vectors[:, i] @ spread @ vectors[:, i]) / curvature if curvature > 0 else math.inf
            with np.errstate(divide="ignore"):
                seen[i] = error < 0.5 * np.min(objective.space.range[free] / np.abs(vectors[:, i]))
        if not seen[i]:
            doubtful_ones.append(v)
    inverse = vectors[:, seen] @ np.diag(1 / curvatures[seen]) @ vectors[:, seen].T
    result.error[free] = np.sqrt(np.maximum(np.diag(inverse @ spread @ inverse), 0))
    for v in doubtful_ones:
        result.error[np.abs(v) > MOVED] = np.nan
    for j in np.flatnonzero(np.isfinite(result.error)):
        move = np.where(np.arange(p) == j, h, 0)
        ends = [[objective.value(w + sign * k * move) for sign in (-1, 1)] for k in (1, 2)]
        once, twice = (np.array([sum(each) for each in ends]) - 2 * objective.value(w)) / np.array([1, 4])
        if not abs(once - twice) <= AGREE * max(abs(once), abs(twice)):
            result.jumping.append(int(j))
            result.error[j] = np.nan
    return doubtful_ones


def _slope(objective: Objective, near: Array, far: Array, count: int) -> float:
    """By how many standard errors the score is higher at `far`, from trial to trial; infinite where it has none there.

    Between two points of a profile it is the score test of the place between them [Rao 1948].
    """
    rise = objective.terms(objective.scores(far, count)) - objective.terms(objective.scores(near, count))
    mean = float(np.mean(rise))
    if abs(mean) <= ROUNDING * abs(objective.value(near, count)):
        return 0.0
    with np.errstate(divide="ignore"):
        return float(mean / (np.std(rise, ddof=1) / math.sqrt(len(rise)))) if math.isfinite(mean) else math.inf


def _is_level(objective: Objective, w: Array, v: Array, critical: float) -> bool:
    """Whether the score nowhere rises along a direction, from bound to bound."""
    with np.errstate(divide="ignore", invalid="ignore"):
        ends = np.concatenate([-w / v, (objective.space.range - w) / v])
    for end in (np.min(ends[ends >= 0]), np.max(ends[ends <= 0])):
        if any(_slope(objective, w, w + share * end * v, objective.trials) > critical for share in (0.5, 1)):
            return False
    return True


class _Profile:
    """The least score of some trials where one parameter is fixed."""

    def __init__(self, objective: Objective, count: int, w: Array, j: int, critical: float) -> None:
        self.objective, self.count, self.w, self.j, self.critical = objective, count, w, j, critical

    def at(self, place: float, near: Array) -> Array:
        """The best point where the parameter is at a place, searched from a point near to it."""
        begin = near.copy()
        begin[self.j] = place
        return begin if len(begin) == 1 else local(self.objective, begin, self.count, RADIUS, END, self.j)

    def to(self, end: float) -> list[Array]:
        """Points from the best half way to an end of the range, and to it unless the profile rises before."""
        points = [self.w, self.at((self.w[self.j] + end) / 2, self.w)]
        return points if self.rises(points) else [*points, self.at(end, points[1])]

    def slope(self, near: Array, far: Array) -> float:
        return _slope(self.objective, near, far, self.count)

    def rises(self, points: list[Array]) -> bool:
        """Whether the last point is excluded: by the slope that leads to it, or by all of the rise."""
        return any(self.slope(near, points[-1]) > self.critical for near in (points[-2], points[0]))

    def limit(self, points: list[Array], other_end: float) -> float:
        """How far from the best the profile's slope may be below t standard errors, the last point being excluded."""
        j, is_log = self.j, self.objective.space.is_log[self.j]
        for _ in range(HALVINGS):
            is_steep = [self.slope(near, far) > self.critical for near, far in pairwise(points)]
            k = len(is_steep) - [*is_steep[::-1], False].index(False)  # all steps from here on are steep
            if k == len(is_steep):
                return float(points[-1][j])
            places = np.array([point[j] for point in points])
            gaps = np.abs(np.diff(places)) / (1 if is_log else np.abs(places[1:] - other_end))
            widest = k - 1 if k > 0 and gaps[k - 1] > gaps[k] else k
            if gaps[widest] < NARROW:
                break
            middle = (points[widest] + points[widest + 1]) / 2
            points.insert(widest + 1, self.at(middle[j], middle))
        return float(points[k + 1][j])


def _look(objective: Objective, count: int, w: Array, result: Known, j: int) -> bool:
    """What the profile of a parameter says of its bounds: whether both are excluded."""
    size, bound = objective.space.range[j], result.bounds.get(objective.space.names[j])
    profile, ends = _Profile(objective, count, w, j, result.critical), (0.0, float(size))
    if bound is not None:  # the best may lie beyond it
        inwards = (STEP if objective.space.is_log[j] else AT_BOUND) * (1 if bound == "lower" else -1)
        if profile.rises([w, profile.at(w[j] + inwards, w)]):
            return False
    sides = [profile.to(end) for end in ends]
    is_open = [not profile.rises(side) for side in sides]
    if count < objective.trials:
        return not any(is_open)
    if all(is_open):
        result.flat.append(np.where(np.arange(len(w)) == j, 1.0, 0))
    elif any(is_open):
        end = is_open.index(True)
        result.error[j], result.instead[j] = np.nan, sides[end][-1]
        result.interval[j] = (-np.inf, np.inf)
        result.interval[j, 1 - end] = profile.limit(sides[1 - end], ends[end])
    elif not math.isfinite(result.error[j]):
        result.jumping.append(j)
        result.interval[j] = [profile.limit(side, other) for side, other in zip(sides, ends[::-1])]
    return not any(is_open)


def known(objective: Objective, w: Array) -> Known:
    """Standard errors and intervals of the parameters, and what the score does not tell."""
    from scipy.stats import t

    space, p = objective.space, len(w)
    near = AT_BOUND * space.range
    bounds = {name: "lower" if w[j] <= near[j] else "upper" for j, name in enumerate(space.names)
              if w[j] <= near[j] or w[j] >= space.range[j] - near[j]}  # fmt: skip
    free = [j for j, name in enumerate(space.names) if name not in bounds]
    critical = float(t.ppf(0.975, max(1, len(objective.scores(w)) - 1)))
    result = Known(np.full(p, np.nan), np.zeros((p, p)), critical, np.full((p, 2), np.nan), bounds=bounds)
    doubtful = _curvature(objective, w, result, free) if free else []
    result.flat = [v for v in doubtful if _is_level(objective, w, v, critical)]
    level = np.array([any(abs(v[j]) > MOVED for v in result.flat) for j in range(p)])
    room = np.stack([w, space.range - w])
    room = np.where(space.is_log, 1 - np.exp(-room), room).min(axis=0)  # by the parameter or its inverse
    looked_at = [j for j in range(p) if not level[j] and j not in result.jumping]
    is_far = NEAR * critical * result.error < room
    if not is_far[looked_at].all():
        for j in looked_at:  # some trials are enough for what is not in doubt
            if not (is_far[j] and _look(objective, objective.coarse, w, result, j)):
                _look(objective, objective.trials, w, result, j)
    for v in result.flat:
        result.error[np.abs(v) > MOVED] = np.inf
    is_known = ~np.isnan(result.error)
    result.interval[is_known] = (w[:, None] + critical * result.error[:, None] * np.array([-1, 1]))[is_known]
    return result
