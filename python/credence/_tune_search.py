"""The search for the best parameters, and what is known of them: SciPy's optimiser, and the sandwich of their errors.

Parameters are searched in coordinates w: the logarithm of one whose bounds are positive, else its share of the range
between its bounds.
"""

from __future__ import annotations

import contextlib
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np

from credence import Failure
from credence._calls import progress_bar
from credence._trials import Array
from credence._tune_sources import Source

COARSE = 4  # the search over the whole box takes one trial of so many
LEAST_COARSE = 20  # but at least so many trials
BEST_POINTS = 2  # of the Sobol set, from which a search begins
STEP = 0.03  # of w in differences, where it is a logarithm; of others this share of their natural scale
AT_BOUND = 1e-3  # of the range: so near to a bound is at it
FLAT = 1e-6  # a curvature is nothing if it is less than this share of the largest
DOUBTFUL = 0.05  # share of the largest curvature below which one is measured along its own direction
FEW_TRIALS = 20  # the spread of fewer curvatures says nothing
FAILED = 0.01  # share of trials without a result beyond which a point has none


@dataclass(frozen=True)
class Space:
    """The box that is searched."""

    names: tuple[str, ...]
    low: Array
    high: Array

    @property
    def is_log(self) -> Array:
        return np.asarray(self.low > 0)

    @property
    def range(self) -> Array:
        """Of w."""
        with np.errstate(all="ignore"):
            return np.where(self.is_log, np.log(self.high / np.where(self.is_log, self.low, 1)), 1.0)

    def values(self, w: Array) -> dict[str, float]:
        """The parameters at w, within their bounds but for the steps of differences."""
        logs = np.exp(np.where(self.is_log, w, 0)) * np.where(self.is_log, self.low, 0)
        lines = self.low + w * (self.high - self.low)
        return {name: float(one) for name, one in zip(self.names, np.where(self.is_log, logs, lines))}

    def coordinates(self, values: dict[str, float]) -> Array:
        x = np.array([values[name] for name in self.names])
        with np.errstate(all="ignore"):
            return np.where(self.is_log, np.log(x / np.where(self.is_log, self.low, 1)),
                            (x - self.low) / (self.high - self.low))  # fmt: skip

    def slope(self, w: Array) -> Array:
        """dx/dw, by which a standard error of w becomes one of x."""
        x = np.array(list(self.values(w).values()))
        return np.where(self.is_log, x, self.high - self.low)


class Objective:
    """The number that is minimised, with the scores of all points that were asked for."""

    def __init__(self, source: Source, space: Space, trials: int) -> None:
        self.source, self.space, self.trials = source, space, trials
        self._draw: Callable[..., object] | None = None
        self.evaluations = 0  # points, those on fewer trials counted by their share
        self.failing = 0  # points without a result
        self._known: dict[tuple[bytes, int], Array] = {}
        self._searched: list[tuple[Array, int]] = []  # points, and their trials
        self._runs = 0

    @contextlib.contextmanager
    def shown(self, progress: bool | None) -> Iterator[None]:
        """Show the progress of evaluations."""
        with progress_bar(progress) as self._draw:
            yield
        self._draw = None

    def scores(self, w: Array, count: int | None = None) -> Array:
        """The score of each trial at w; that of one without a result is the worst of the others. NaN throughout where
        more than 1 % have none."""
        count = count or self.trials
        key = (np.asarray(w, dtype=float).tobytes(), count)
        if key not in self._known:
            scores = self.source.scores(self.space.values(w), count)
            self._runs += len(scores)
            self.evaluations = round(self._runs / max(self.trials, 1))
            self._searched.append((np.array(w, dtype=float), count))
            there = np.isfinite(scores)
            is_failing = np.mean(~there) > FAILED
            self.failing += int(is_failing)
            self._known[key] = np.full(len(scores), np.nan) if is_failing else np.where(
                there, scores, np.max(scores[there])
            )  # fmt: skip
            if self._draw is not None:
                self._draw(self._runs, 0, f"{self.evaluations} evaluations, score {self.of(self._known[key]):.5g}")
        return self._known[key]

    def of(self, scores: Array) -> float:
        """The number of these scores: their mean, or with NEES the squared logarithm of the mean NEES/n."""
        mean = float(np.mean(scores))
        return math.log(mean) ** 2 if self.source.objective == "nees" and mean > 0 else mean

    def value(self, w: Array, count: int | None = None) -> float:
        return self.of(self.scores(w, count))

    def searched(self) -> tuple[Array, Array]:
        """All points that were asked for [point, p], and by how much their score is above the lowest of all points on
        the same trials [point]: NaN for those without a result."""
        places = np.array([w for w, _ in self._searched])
        counts = np.array([count for _, count in self._searched])
        rises = np.array([self.value(w, count) for w, count in self._searched])
        for count in np.unique(counts):
            of = counts == count
            if np.isfinite(rises[of]).any():
                rises[of] -= np.nanmin(rises[of])
        return places, rises


def _local(objective: Objective, w: Array, count: int, radius: float, end: float) -> Array:
    """SciPy's COBYQA from w within the box: a quadratic model in a trust region [Ragonneau 2022].

    A point without a result is worse than every other one by as much as those differ.
    """
    from scipy.optimize import Bounds, minimize

    size, seen = objective.space.range, []

    def value(u: Array) -> float:
        found = objective.value(np.clip(u, 0, 1) * size, count)
        if math.isfinite(found):
            seen.append(found)
            return found
        return 2 * max(seen) - min(seen) + 1 if seen else 1e6

    options = {"initial_tr_radius": radius, "final_tr_radius": end, "maxfev": 200 * len(size)}
    found = minimize(value, w / size, method="COBYQA", bounds=Bounds(0 * size, 1 + 0 * size), options=options)
    best: Array = np.clip(found.x, 0, 1) * size
    return best if objective.value(best, count) <= objective.value(w, count) or not seen else w


def search(objective: Objective, start: Array) -> Array:
    """The best point: searches from the start and the best points of a Sobol set on some of the trials, and from the
    best of their ends on all of them.

    Raises
    ------
    Failure
        No point has a result.
    """
    from scipy.stats import qmc

    size, trials = objective.space.range, objective.trials
    coarse = min(trials, max(trials // COARSE, LEAST_COARSE))
    count = 2 ** math.ceil(math.log2(4 * len(size)))
    points = qmc.Sobol(len(size), scramble=False).random(count)[1:] * size  # the first is a corner of the box

    def at(w: Array, count: int = coarse) -> float:
        found = objective.value(w, count)
        return found if math.isfinite(found) else math.inf

    ranked = sorted(points, key=at)[:BEST_POINTS]
    begins = [w for w in [start, *ranked] if at(w) < math.inf]
    if not begins:
        raise Failure(f"no point has a result, neither the start nor {len(points)} others: {objective.source.trouble}")
    ends = [_local(objective, w, coarse, 0.1, 0.003) for w in begins]
    best = min(ends, key=at)
    if not math.isfinite(objective.value(best)):  # only on all trials has it no result
        best = min([start, *ends, *ranked], key=lambda w: at(w, trials))
    return _local(objective, best, trials, 0.02, 1e-5)


@dataclass
class Known:
    """What the scores say of the parameters at the best point.

    Attributes
    ----------
    error : array [p]
        Standard errors of w: NaN at a bound or where differences have no result, infinite where a direction that the
        score does not see moves the parameter.
    flat : list of arrays [p]
        Directions of w that the score does not see.
    hessian : array [p, p]
        Of the number that is minimised; 0 for parameters at a bound.
    bounds : dict of str
        {parameter at a bound: ``lower`` or ``upper``}.
    """

    error: Array
    hessian: Array
    flat: list[Array] = field(default_factory=list)
    bounds: dict[str, str] = field(default_factory=dict)


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
    room = np.minimum(w, space.range - w)
    return np.where(room > 0, np.minimum(h, room), h)


def _is_flat(objective: Objective, w: Array, v: Array, found: Array, largest: float) -> bool:
    """Whether the score does not see a direction: its curvature is below twice its standard error, or nothing."""
    if objective.source.objective != "nees":
        here = objective.scores(w)
        found = (objective.scores(w + STEP * v) + objective.scores(w - STEP * v) - 2 * here) / STEP**2
    mean, spread = float(np.mean(found)), float(np.std(found, ddof=1)) if len(found) >= FEW_TRIALS else 0.0
    return not mean > max(2 * spread / math.sqrt(len(found)), FLAT * largest)


def known(objective: Objective, w: Array) -> Known:
    """Standard errors by the sandwich H^-1 J H^-1 / N of per-trial scores [Huber 1967; White 1982], in the directions
    that the score sees."""
    space, p = objective.space, len(w)
    near = AT_BOUND * space.range
    bounds = {name: "lower" if w[j] <= near[j] else "upper" for j, name in enumerate(space.names)
              if w[j] <= near[j] or w[j] >= space.range[j] - near[j]}  # fmt: skip
    free = [j for j, name in enumerate(space.names) if name not in bounds]
    result = Known(np.full(p, np.nan), np.zeros((p, p)), bounds=bounds)
    if not free:
        return result
    gradient, hessian = _differences(objective, w, _steps(objective, w, free), free)
    mean, count = hessian.mean(axis=0), len(gradient)
    if not np.isfinite(mean).all() or count < 2:
        return result
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
        if seen[i]:  # nothing is known either of what may be anywhere between the bounds
            error = math.sqrt(vectors[:, i] @ spread @ vectors[:, i]) / curvature if curvature > 0 else math.inf
            with np.errstate(divide="ignore"):
                seen[i] = error < 0.5 * np.min(space.range[free] / np.abs(vectors[:, i]))
        if not seen[i]:
            result.flat.append(v)
    inverse = vectors[:, seen] @ np.diag(1 / curvatures[seen]) @ vectors[:, seen].T
    error = np.sqrt(np.maximum(np.diag(inverse @ spread @ inverse), 0))
    for v in result.flat:
        error[np.abs(v[free]) > 0.05] = np.inf
    result.error[free] = error
    return result
