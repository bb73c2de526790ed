"""Which parameters of a filter make it right: found on trials, with standard errors, and judged on other trials.

    best = credence.tune(run, free={"q": (0.01, 10), "r": (0.1, 10)}, trials=200)
    best.parameters                                         # {"q": 0.1992 ± 0.0041, "r": 1.998 ± 0.019}
    best.verdict                                            # on other seeds: <Verdict consistent>
    print(best)                                             # before, after, and what cannot be told

docs/tuning.md says what is minimised, and when that finds the truth.
"""

from __future__ import annotations

import contextlib
import inspect
import math
import os
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from credence import Failure, InputError
from credence import _doors as doors
from credence._calls import note
from credence._errors import invalid, printable, wrong
from credence._scores import OBJECTIVES, judged_score
from credence._trials import Array, Work
from credence._tune_known import Known, known
from credence._tune_search import FAILED, Objective, Space, search
from credence._tune_sources import FEW_SEGMENTS, FunctionSource, LogSource, ScenarioSource, Source, held_out_seed
from credence.judging import NOT_REFUTED, Verdict
from credence.program import SEED
from credence.simulating import batch_size

if TYPE_CHECKING:
    from credence.pictures.style import Picture

    Free = Mapping[str, tuple[float, float]] | Iterable[str]

__all__ = ["Estimate", "Tuned", "tune"]

HELD_OUT = 2000  # trials at least
FIRST_BOUNDS = 100.0  # of a scenario's key without bounds: from its value over this to its value times this
CUSTOM = (
    "objective='nees' ends wherever the mean NEES/n first is 1: many parameters have that, most of them wrong ones. "
    "Take the log score, objective='errors'."
)
NAMES = {
    "errors": "the log score of the errors (nats a step)",
    "innovations": "the log score of the innovations (nats a step)",
    "nees": "the squared logarithm of NEES/n",
}


def _shown(value: float, error: float) -> str:
    """A number with as many digits as two of its error need; without an error four."""
    return f"{_rounded(value, error)} ± {_rounded(error, error)}" if 0 < error < math.inf else f"{value:.4g}"


def _rounded(value: float, error: float) -> str:
    return f"{value:.{max(0, 1 - math.floor(math.log10(error)))}f}"


def _ends(low: float, high: float) -> str:
    half = (high - low) / 2
    return f"{_rounded(low, half)} to {_rounded(high, half)}" if 0 < half < math.inf else "-"


class _Pair(NamedTuple):
    value: float
    se: float


class Estimate(_Pair):
    """A parameter and its standard error: infinite where the score does not see it, NaN where there is none.

    Attributes
    ----------
    interval : pair of float
        Where it is at 95 %, by Student's t of the trials or segments: infinite where a bound is not excluded, NaN at a
        bound beyond which the best may lie, and where the score jumps about its best.
    """

    interval: tuple[float, float]

    def __new__(cls, value: float, se: float, interval: tuple[float, float] = (math.nan, math.nan)) -> Estimate:
        made = super().__new__(cls, value, se)
        made.interval = interval
        return made

    def __str__(self) -> str:
        low, high = self.interval
        if math.isinf(low) != math.isinf(high):
            return f"below {high:.3g}" if math.isinf(low) else f"above {low:.3g}"
        return _shown(self.value, self.se)


class _Side(NamedTuple):
    """Before, or after."""

    values: dict[str, float]
    score: float  # of the objective, on held-out trials; NaN where the filter has no result
    verdict: Verdict | None


class Tuned:
    """Parameters that were tuned. ``str()`` says what they are, what they buy, and what cannot be told.

    Attributes
    ----------
    parameters : dict of Estimate
        {name: (value, se)}, each with an ``interval``. The standard error is that of the parameter itself, by the
        sandwich of per-trial scores.
    start : dict of float
        The parameters before.
    score_before, score_after : float
        What was minimised, on trials with other seeds; of a log, on its second half.
    verdict, verdict_before : Verdict
        On these; None before where the filter has no result at the start.
    gains : dict of float
        {name: by how much the score rises if this parameter alone is put back}.
    unidentified : list of dict
        Directions that the score does not see, {name: weight}: of a parameter whose bounds are both positive the weight
        is that of its logarithm, of others that of its share of the range between them.
    at_bounds : dict of str
        {name: ``lower`` or ``upper``} of parameters that ended at a bound.
    evaluations : int
        How many times all trials were run.
    name, tuned_on, held_out : str
        What was tuned, on what, and on what it was judged.
    """

    def __init__(
        self,
        names: tuple[str, str, str],
        objective: Objective,
        w: Array,
        facts: Known,
        before: _Side,
        after: tuple[float, Verdict],
        gains: dict[str, float],
    ) -> None:
        space = objective.space
        values, errors = space.values(w), facts.error * space.slope(w)
        ends = np.array([list(space.values(end).values()) for end in facts.interval.T]).T
        ends = np.where(np.isinf(facts.interval), facts.interval, ends)
        self.parameters = {name: Estimate(values[name], float(error), (float(low), float(high)))
                           for name, error, (low, high) in zip(space.names, errors, ends)}  # fmt: skip
        self.start, self.score_before, self.verdict_before = before
        self.score_after, self.verdict = after
        self.gains, self.at_bounds, self.evaluations = gains, facts.bounds, objective.evaluations
        self._failing = objective.failing
        self.unidentified = [dict(zip(space.names, map(float, v))) for v in facts.flat]
        self.name, self.tuned_on, self.held_out = names
        self._objective, self._w, self._facts = objective, w, facts

    def profile(self, name: str, points: int = 9, reach: float = 4) -> tuple[Array, Array]:
        """The score over a parameter, with all others at their best to second order: one evaluation a point.

        Parameters
        ----------
        name : str
        points : int
        reach : float
            To how many standard errors on either side; the bounds where there is none.

        Returns
        -------
        arrays [point]
            Values of the parameter, and the score on the trials that were tuned on: NaN where there is none.
        """
        space = self._objective.space
        j, path, along, _ = self._along(name, points, reach)
        places = self._w + (along - self._w[j])[:, None] * path
        places[:, j] = along
        places = np.clip(places, 0, space.range)
        scores = self._values(places)
        return np.array([space.values(place)[name] for place in places]), scores

    def grid(self, points: int = 12) -> tuple[Array, Array, Array]:
        """The score over two parameters, from beyond the start to beyond the best, closer at the best.

        Returns
        -------
        arrays [x], [y] and [x, y]
            Values of both parameters, and the score on the trials that were tuned on.
        """
        space = self._objective.space
        if len(self._w) != 2:
            raise InputError(f"cannot make a grid of {len(self._w)} parameters (it is of two). Take profile.")
        begin, error = space.coordinates(self.start), np.nan_to_num(self._facts.error, nan=0.0, posinf=0.0)
        low, high = np.minimum(begin, self._w - 4 * error), np.maximum(begin, self._w + 4 * error)
        margin = np.maximum(0.15 * (high - low), 0.01 * space.range)
        ends = np.maximum(low - margin, 0), np.minimum(high + margin, space.range)
        half = points // 2 + 1  # of them on either side, so that the best is one, where the score changes most
        below, above = np.linspace(1, 0, half) ** 2, np.linspace(0, 1, half)[1:] ** 2
        axes = np.array([[*best - (best - lower) * below, *best + (upper - best) * above]
                         for lower, best, upper in zip(ends[0], self._w, ends[1])])  # fmt: skip
        places = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 2)
        x, y = (np.array([space.values(place)[name] for place in axes.T]) for name in space.names)
        return x, y, self._values(places).reshape(len(x), len(y))

    def is_log(self, name: str) -> bool:
        """Whether a parameter was searched by its logarithm."""
        return bool(self._objective.space.is_log[self._objective.space.names.index(name)])

    def searched(self) -> tuple[dict[str, Array], Array]:
        """What the search evaluated, without evaluating anything again.

        Returns
        -------
        dict of arrays [point], and array [point]
            Values of each parameter; and by how much the score is above the lowest of those on the same trials, NaN
            where there is no result.
        """
        space = self._objective.space
        places, rises = self._objective.searched()
        values = [space.values(np.clip(place, 0, space.range)) for place in places]
        return {name: np.array([one[name] for one in values]) for name in space.names}, rises

    def parabola(self, name: str, points: int = 61, reach: float = 4) -> tuple[Array, Array]:
        """The rise of the score over a parameter to second order, with all others at their best: as `profile`, from
        what is known at the best point. Empty where the score does not see the parameter, or it is at a bound."""
        j, path, along, is_known = self._along(name, points, reach)
        if not is_known:
            return np.empty(0), np.empty(0)
        curvature = float(path @ self._facts.hessian @ path)
        values = [self._objective.space.values(self._w + (one - self._w[j]) * path)[name] for one in along]
        return np.array(values), curvature * (along - self._w[j]) ** 2 / 2

    def _along(self, name: str, points: int, reach: float) -> tuple[int, Array, Array, bool]:
        """The place of a parameter, how w moves with its coordinate where all others stay at their best, coordinates to
        so many standard errors on either side [point], and whether there is one: else they are between the bounds."""
        names = self._objective.space.names
        if name not in names:
            raise KeyError(f"{name} was not tuned. Those are {', '.join(names)}")
        j = names.index(name)
        others = [i for i in range(len(self._w)) if i != j and math.isfinite(self._facts.error[i])]
        H = self._facts.hessian
        path = np.zeros(len(self._w))
        path[j] = 1
        path[others] = -np.linalg.solve(H[np.ix_(others, others)], H[others, j])
        error, low, high = self._facts.error[j], 0.0, float(self._objective.space.range[j])
        is_known = bool(math.isfinite(error) and error > 0)
        if is_known:
            low, high = max(low, self._w[j] - reach * error), min(high, self._w[j] + reach * error)
        return j, path, np.linspace(low, high, points), is_known

    def _values(self, places: Array) -> Array:
        try:
            with self._objective.shown(None):
                return np.array([self._objective.value(place) for place in places])
        finally:
            self._objective.source.close()

    def plot(self) -> Picture:
        """The score over each parameter, and of two parameters where the search was. It shows what was evaluated, and
        evaluates nothing again. Needs matplotlib."""
        from credence.pictures.tuning import Parameter, picture

        tried, rises = self.searched()
        drawn = [
            Parameter(name, self.start[name], found, self.is_log(name), self.parabola(name), tried[name])
            for name, found in self.parameters.items()
        ]
        said = ", ".join(f"{name} {found}" for name, found in self.parameters.items())
        message = f"The score is best at {said}; with it the filter is {self.verdict.verdict}"
        return picture(drawn, rises, message, f"{self.name}, {self.tuned_on}")

    def __str__(self) -> str:
        return "\n".join(_said(self)) + "\n"

    def __repr__(self) -> str:
        said = ", ".join(f"{name} {estimate}" for name, estimate in self.parameters.items())
        return f"<credence.Tuned {said}: {self.verdict.verdict}>"


def _table(rows: list[list[str]]) -> list[str]:
    """Rows whose cells stand below each other."""
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    return ["  " + "  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in rows]


def _with_interval(column: Mapping[str, Any]) -> str:
    """A mean and half of its 95 % interval."""
    if column["mean"] is None:
        return "-"
    low, high = (math.nan if end is None else end for end in column["ci95"])
    return _shown(column["mean"], (high - low) / 2)


def _side_cells(verdict: Verdict) -> tuple[list[str], list[str]]:
    """Names and cells of a verdict: log score, RMSE of the first group of one unit, NEES/n, and the word."""
    score, ratio = verdict["log_score"], verdict["nees_ratio"]
    names, cells = ["log score ± 95 %"], [_with_interval(score)]
    sized = [group for group in verdict["groups"] if group.get("accuracy")]
    for group in [one for one in sized if "+" not in one["accuracy"]["unit_of_square"]][:1] or sized[:1]:
        unit = group["accuracy"]["unit_of_square"]
        root = unit.removesuffix("^2") if "+" not in unit and unit.endswith("^2") else f"√({unit})"
        of = "" if group["group"] == "all" else f" {group['group']}"
        names.append(f"RMSE{of}" if unit in ("1", "unit of error squared") else f"RMSE{of} [{root}]")
        cells.append(f"{group['accuracy']['rmse']:.4g}")
    names += ["NEES/n ± 95 %", "verdict"]
    return names, [*cells, _with_interval(ratio), verdict.verdict]


def _direction(space: Space, v: Mapping[str, float]) -> str:
    """What moves together in a direction, beginning with what moves most: `q * 1.1 with r * 0.905`."""
    largest = max(map(abs, v.values()))
    parts = []
    for name, is_log in zip(space.names, space.is_log):
        share = v[name] / largest
        if abs(share) > 0.05:
            span = space.high[space.names.index(name)] - space.low[space.names.index(name)]
            parts.append(f"{name} * {math.exp(0.1 * share):.3g}" if is_log else f"{name} {0.1 * share * span:+.3g}")
    return " with ".join(parts)


def _said(tuned: Tuned) -> list[str]:
    source, count = tuned._objective.source, len(tuned.parameters)
    lines = [
        f"{tuned.name}: {count} parameter{'s' * (count > 1)} by {NAMES[source.objective]}, lower is better;",
        f"{tuned.evaluations} evaluations of {tuned.tuned_on}",
        "",
    ]
    rows = [["parameter", "start", "tuned ± standard error", "95 %", "put back, the score rises by"]]
    for name, found in tuned.parameters.items():
        rows.append([name, f"{tuned.start[name]:.4g}", str(found), _ends(*found.interval), f"{tuned.gains[name]:.3g}"])
    lines += [*_table(rows), "", f"On {tuned.held_out}:"]
    heads, after = _side_cells(tuned.verdict)
    was = tuned.verdict_before
    before = ["no result", *[""] * (len(heads) - 1)] if was is None else _side_cells(was)[1]
    lines += _table([["", *heads], ["before", *before], ["after", *after]])
    if source.objective == "innovations":
        scores = {"innovations": [tuned.score_before, tuned.score_after]}
        if source.has_truth:
            sides = (tuned.verdict_before, tuned.verdict)
            scores["errors"] = [math.nan if one is None else judged_score("errors", one) for one in sides]
        for of, (first, last) in scores.items():
            lines.append(f"  log score of the {of}: {first:.4g} before, {last:.4g} after")
    notes = _notes(tuned)
    return lines + (["", *notes] if notes else [])


def _notes(tuned: Tuned) -> list[str]:
    """What cannot be told, and what else a reader must know."""
    objective, space, source = tuned._objective, tuned._objective.space, tuned._objective.source
    notes = [f"{name} is at its {end} bound: the best may lie beyond it." for name, end in tuned.at_bounds.items()
             if math.isnan(tuned.parameters[name].interval[0])]  # fmt: skip
    for j, place in tuned._facts.instead.items():
        found = space.values(place)
        moved = np.abs(place - tuned._w) > np.where(space.is_log, 0.1, 0.01)
        instead = [f"{name} {found[name]:.4g}" for i, name in enumerate(space.names) if moved[i] and i != j]
        told = f"{space.names[j]} may be at its bound, {found[space.names[j]]:.4g}"
        notes.append(f"{told}{', with ' if instead else ''}{' and '.join(instead)}.")
    for j in tuned._facts.jumping:
        notes.append(f"The score jumps along {space.names[j]}, or is no parabola about its best: no standard error.")
    for v in tuned.unidentified:
        told = _direction(space, v)
        both = f"The score does not tell {told} from what was tuned: fix one of these"
        notes.append(f"{both}, or measure more." if " with " in told else f"The score does not see {told.split()[0]}.")
    if isinstance(source, LogSource) and source.segments < FEW_SEGMENTS:
        notes.append(_few_segments(source.segments, tuned._facts.critical))
    if tuned._failing:
        first = (source.trouble or "its numbers are not finite").splitlines()[0]
        notes.append(f"{tuned._failing} points that were tried had no result, the first: {first}")
    scores = objective.scores(tuned._w)
    distinct = len(np.unique(scores))
    if len(scores) - distinct > max(1, FAILED * len(scores)):  # those that failed have the score of the worst
        told = f"Only {distinct} of the {len(scores)} trials are distinct: their scores agree to the last bit."
        notes.append(f"{told} Copies are not independent, and the errors are too small: draw every number from rng.")
    if tuned.score_after > tuned.score_before:
        notes.append("On what was held out the score is no better than before: tune on more, or keep the start.")
    if tuned.verdict.verdict not in NOT_REFUTED:
        if source.objective != "nees":
            cause = "what is left has another cause, such as linearisation, a missing state or a bias"
            notes.append(f"The best of these parameters do not make the filter right: {cause}.")
        notes += [f"left: {finding.text}" for finding in tuned.verdict.findings[:4]]
    return notes


def _few_segments(count: int, critical: float) -> str:
    told = f"Only {count} segments, fewer than {FEW_SEGMENTS}: 95 % are {critical:.2g} standard errors"
    return f"{told}, which are themselves not known well. Tune on a longer log."


def _refuse_old_scipy() -> None:
    scipy = doors.needed("scipy", "scipy", "tune")
    if tuple(map(int, scipy.__version__.split(".")[:2])) < (1, 14):
        raise InputError(f"SciPy {scipy.__version__} has no COBYQA. Install it anew: pip install 'scipy>=1.14'.")


def _number(name: str, given: object) -> float:
    try:
        value = float(given)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        value = math.nan
    if not math.isfinite(value):
        raise InputError(f"invalid {printable(name)}={printable(given)} (must be a finite number). Give one.")
    return value


def _box(free: Any, start: Mapping[str, float], defaults: Mapping[str, Any], is_scenario: bool) -> tuple[Space, Any]:
    """The bounds and the start of each parameter; what is not given is the default, or the middle of the bounds."""
    given = dict(free) if isinstance(free, Mapping) else dict.fromkeys(free)
    for name in start:
        if name not in given:
            raise wrong("start", f"{printable(name)} is not free", f"Free are {', '.join(map(str, given))}")
    lows, highs, begins = [], [], {}
    for name, bounds in given.items():
        known_value = start.get(name, defaults.get(name))
        if bounds is None:
            value = _number(name, known_value)
            if not is_scenario or value <= 0:
                raise wrong("free", f"{printable(name)} has no bounds", "Give a low and a high")
            bounds = (value / FIRST_BOUNDS, value * FIRST_BOUNDS)
        try:
            low, high = (_number(f"free[{name}]", end) for end in bounds)
        except (TypeError, ValueError) as error:
            if isinstance(error, InputError):
                raise
            raise wrong("free", f"{printable(name)} has no pair of bounds", "Give low and high") from None
        if not low < high:
            raise wrong("free", f"{printable(name)} is from {low:g} to {high:g}", "Give a low and a high")
        middle = math.sqrt(low * high) if low > 0 else (low + high) / 2
        value = middle if known_value is None else _number(name, known_value)
        if not low <= value <= high:
            why = f"{printable(name)} starts at {value:g}, outside {low:g} to {high:g}"
            raise wrong("start", why, "Give other bounds, or a start within them")
        lows.append(low)
        highs.append(high)
        begins[name] = value
    return Space(tuple(given), np.array(lows), np.array(highs)), begins


def _options_of(run: Callable[..., Any], free: Any) -> tuple[dict[str, Any], bool]:
    """The numbers that a function's options have by themselves, and whether it takes a generator."""
    try:
        parameters = inspect.signature(run).parameters
    except (TypeError, ValueError):
        return {}, True
    takes_any = any(one.kind is one.VAR_KEYWORD for one in parameters.values())
    for name in free if isinstance(free, Iterable) and not isinstance(free, str) else ():
        if name not in parameters and not takes_any:
            there = ", ".join(parameters) or "none"
            raise wrong("free", f"{printable(name)} is no option of the function", f"It has {there}")
    defaults = {
        name: one.default
        for name, one in parameters.items()
        if isinstance(one.default, (int, float)) and not isinstance(one.default, bool)
    }
    first = next(iter(parameters.values()), None)
    is_rng = first is not None and first.name not in free and first.kind in (
        first.POSITIONAL_ONLY, first.POSITIONAL_OR_KEYWORD, first.VAR_POSITIONAL
    ) and first.default is first.empty  # fmt: skip
    return defaults, is_rng


def _named(name: str, value: Any) -> Any:
    """Parameters as a dict of their bounds, or as a list of their names."""
    if isinstance(value, (str, bytes)) or not isinstance(value, Iterable):
        raise invalid(name, value, "must be a dict of bounds", "Give one: {'q': (0.01, 10)}")
    given = value if isinstance(value, Mapping) else list(value)
    if not given:
        raise wrong("free", "it has no parameter", "Name one with its bounds: {'q': (0.01, 10)}")
    return doors.mapping("{'q': (0.01, 10)}")(name, given) if isinstance(given, Mapping) else doors.texts(name, given)


@doors.door(
    free=_named, trials=doors.whole(2, 2**40), seed=SEED, objective=doors.text, start=doors.mapping('{"q": 1}'),
    executor=doors.executor, batch=batch_size, held_out=doors.whole(0, 2**40), arm=doors.text, program=doors.path,
    progress=doors.flag,
)  # fmt: skip
def tune(
    what: Any,
    free: Free,
    *,
    trials: int = 200,
    seed: int = 1,
    objective: str = "errors",
    start: Mapping[str, float] | None = None,
    executor: Any = None,
    batch: bool | int = False,
    held_out: int | None = None,
    arm: str | None = None,
    program: str | os.PathLike[str] | None = None,
    progress: bool | None = None,
) -> Tuned:
    """Find the parameters under which a filter's own covariance fits its errors best, and judge it on other trials.

    The mean log score of the errors is minimised, ``(n log 2 pi + log det P + NEES) / 2`` a step, a proper score: no
    other parameters are better on average than those of the truth, where the filter is right with them [Gneiting and
    Raftery 2007]. Every evaluation has the same random numbers, so that it is a smooth function; SciPy's COBYQA
    searches from the start and from the best points of a Sobol set, over logarithms of parameters whose bounds are
    positive. The results are the same bits for any executor.

    Parameters
    ----------
    what : function, path, or str
        ``run(rng, **options)`` as of `simulate`. Or a scenario, as a path or a text of several lines. Or, for one log,
        a function of the parameters alone that runs the filter on its data and returns a `Run`: its first half is tuned
        on, in segments that take the place of trials, and the rest is held out.
    free : dict of pairs, or list of str
        The bounds of each parameter: ``{"q": (0.01, 10)}``. Of a scenario these are keys, such as
        ``filter.measurement``, whose bounds may be left out: a hundredth and a hundred times of their values.
    trials : int
        How many are tuned on.
    seed : int
        Of these; the next seed is that of those that are held out.
    objective : str
        ``errors``; ``innovations``, which needs no truth; or ``nees``, the squared logarithm of NEES/n, the custom of
        the field, which has many minima.
    start : dict of float
        Parameters before (the defaults of the function, the scenario's values, or the middle of the bounds).
    executor, batch
        As of `simulate`; with a scenario as of `run`.
    held_out : int
        Trials that are judged (`trials`, at least 2,000); of a log its last steps (half of them), or 0: what it was
        tuned on is judged, and nothing shows whether too little was tuned on.
    arm : str
        That of the scenario which is tuned (its first).
    program : path
        The program of a world of one's own [docs/own-filter.md], with a scenario.
    progress : bool
        Whether a bar of tqdm is drawn; by default on a terminal and in a notebook.

    Returns
    -------
    Tuned

    Raises
    ------
    InputError
        A ValueError: an argument cannot be used; nothing was run.
    Failure
        The filter has no result at any point that was tried.
    """
    if objective not in OBJECTIVES:
        raise invalid("objective", objective, f"must be {', '.join(OBJECTIVES)}", "Take one")
    is_scenario = isinstance(what, (str, os.PathLike))
    if not is_scenario and not callable(what):
        raise wrong("what", f"a {type(what).__name__} cannot be called", "Give a function, or a scenario")
    count, root = trials, seed
    others = max(count, HELD_OUT) if held_out is None else held_out
    if not is_scenario and (arm is not None or program is not None):
        raise InputError("arm and program: say nothing of a function. Leave them out.")
    if is_scenario and batch:
        raise InputError("batch: says nothing of a scenario. Leave it out.")
    _refuse_old_scipy()
    begins = {name: _number(f"start[{name}]", value) for name, value in (start or {}).items()}
    if is_scenario:
        world = ScenarioSource(what, objective, root, executor, arm, None if program is None else str(program))
        source: Source = world
        space, first = _scenario_box(world, free, begins)
        name = "scenario" if isinstance(what, str) and "\n" in what else Path(what).name
    else:
        defaults, takes_generator = _options_of(what, free)
        space, first = _box(free, begins, defaults, False)
        name = getattr(what, "__qualname__", type(what).__name__)
        source = (
            FunctionSource(Work(what, {}, root, int(batch), None), objective, executor)
            if takes_generator
            else LogSource(what, objective, first, None if held_out is None else others)
        )
    if objective == "nees":
        note(CUSTOM)
    if others == 0 and not isinstance(source, LogSource):
        raise invalid("held_out", 0, "only a log can be judged on what it was tuned on", "Give some trials")
    if isinstance(source, LogSource):
        count = source.segments
        whole = source.rest.start == 0
        part = "the log" if whole else f"the first {source.first:,} steps of the log"
        said = (f"{count} segments of {part}", "the same log" if whole else "the rest of it")
    else:
        said = (f"{count:,} trials (seed {root})", f"{others:,} other trials (seed {held_out_seed(root)})")
    try:
        return _tuned((name, *said), source, space, first, count, others, progress)
    finally:
        source.close()


def _scenario_box(source: ScenarioSource, free: Any, begins: dict[str, float]) -> tuple[Space, dict[str, float]]:
    """The bounds of a scenario's keys; what its world refuses is refused here."""
    values = source.shown({})
    for key in free if isinstance(free, Iterable) and not isinstance(free, str) else ():
        if key not in values:
            raise wrong("free", f"{printable(key)} is no key of the scenario", "credence show lists them")
        try:
            float(values[key])
        except ValueError:
            why = f"{key} is {printable(values[key])}, not a number"
            raise wrong("free", why, "Take a key that is one") from None
    space, first = _box(free, begins, {key: value for key, value in values.items() if key in free}, True)
    for side in (space.low, space.high, np.array(list(first.values()))):
        source.shown(dict(zip(space.names, map(float, side))))
    return space, first


def _tuned(
    names: tuple[str, str, str],
    source: Source,
    space: Space,
    first: dict[str, float],
    count: int,
    others: int,
    progress: bool | None,
) -> Tuned:
    objective = Objective(source, space, count)
    begin = space.coordinates(first)
    with objective.shown(progress):
        w = search(objective, begin)
        facts = known(objective, w)
        if isinstance(source, LogSource) and source.segments < FEW_SEGMENTS:
            note(_few_segments(source.segments, facts.critical))
        gains = {}
        for j, each in enumerate(space.names):
            back = w.copy()
            back[j] = begin[j]
            gains[each] = objective.value(back) - objective.value(w)
    source.progress = progress
    after, score_after = source.judged(space.values(w), others)
    before, score_before = None, math.nan
    with contextlib.suppress(Failure):  # the start may be where the filter fails
        before, score_before = source.judged(first, others)
    if source.objective == "nees":
        score_before, score_after = (math.log(score) ** 2 for score in (score_before, score_after))
    return Tuned(names, objective, w, facts, _Side(first, score_before, before), (score_after, after), gains)
