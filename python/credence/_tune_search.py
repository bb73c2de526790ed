"""The search for the best parameters by SciPy's optimiser.

Parameters are searched in coordinates w: the logarithm of one whose bounds are positive, else its share of the range
between its bounds.
"""

from __future__ import annotations

import contextlib
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from credence import Failure
from credence._calls import progress_bar
from credence._trials import Array
from credence._tune_sources import Source

COARSE = 4  # the search over the whole box takes one trial of so many
LEAST_COARSE = 20  # but at least so many trials
BEST_POINTS = 2  # of the Sobol set, from which a search begins
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

    @property
    def coarse(self) -> int:
        """Some of the trials."""
        return min(self.trials, max(self.trials // COARSE, LEAST_COARSE))

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
        return float(np.mean(self.terms(scores)))

    def terms(self, scores: Array) -> Array:
        """What each trial adds to the number, to first order: its score, of which the number is the mean."""
        mean = float(np.mean(scores))
        if self.source.objective != "nees" or not mean > 0:
            return scores
        size = math.log(mean)
        return size**2 + 2 * size * (scores / mean - 1)

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


def local(objective: Objective, w: Array, count: int, radius: float, end: float, fixed: int | None = None) -> Array:
    """SciPy's COBYQA from w within the box, where one parameter may be fixed: a quadratic model in a trust region
    [Ragonneau 2022].

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
    is_fixed = np.arange(len(w)) == fixed
    box = Bounds(np.where(is_fixed, w / size, 0), np.where(is_fixed, w / size, 1))
    found = minimize(value, w / size, method="COBYQA", bounds=box, options=options)
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
    coarse = objective.coarse
    count = 2 ** math.ceil(math.log2(4 * len(size)))
    points = qmc.Sobol(len(size), scramble=False).random(count)[1:] * size  # the first is a corner of the box

    def at(w: Array, count: int = coarse) -> float:
        found = objective.value(w, count)
        return found if math.isfinite(found) else math.inf

    ranked = sorted(points, key=at)[:BEST_POINTS]
    begins = [w for w in [start, *ranked] if at(w) < math.inf]
    if not begins:
        raise Failure(f"no point has a result, neither the start nor {len(points)} others: {objective.source.trouble}")
    ends = [local(objective, w, coarse, 0.1, 0.003) for w in begins]
    best = min(ends, key=at)
    if not math.isfinite(objective.value(best)):  # only on all trials has it no result
        best = min([start, *ends, *ranked], key=lambda w: at(w, trials))
    return local(objective, best, trials, 0.02, 1e-5)
