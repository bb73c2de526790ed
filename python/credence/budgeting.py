"""Why an error is what it is: by its sources, each drawn anew with all others held [docs/budget.md].

    def run(rng):                                           # one run of a filter
        z = x + r * rng["measurement", k].normal()          # draws by the name of their source
        ...
    print(credence.budget(run, trials=2000))
"""

from __future__ import annotations

import contextlib
import csv
import functools
import io
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from credence import _doors as doors
from credence._calls import note
from credence._errors import InputError, invalid, printable, wrong
from credence._record import Run
from credence._streams import REST, Streams
from credence._trials import Array, seed_sequence
from credence.program import SEED
from credence.simulating import SimulatedArm, Simulation, simulate

if TYPE_CHECKING:
    from credence.pictures.style import Picture

__all__ = ["Budget", "Contribution", "budget"]

AT = ("last", "mean")
LOOKED_AT = 20  # trials whose sources are the sources
LARGEST_Z = 3.0  # of the check that the contributions meet the error


class _Worlds:
    """A function of a generator, called with some of its sources drawn anew."""

    def __init__(self, run: Callable[..., Any], sources: Sequence[str]) -> None:
        self.run, self.sources = run, tuple(sources)

    def __call__(self, rng: Streams, other: Sequence[str]) -> Run:
        """The run, with how often each source was drawn by its name alone as a column."""
        streams = rng.other(other)
        result = self.run(streams)
        if not isinstance(result, Run):
            raise TypeError(f"the function returned {type(result).__name__}, not a credence.Run")
        drawn = streams.drawn()
        if unknown := sorted(drawn.keys() - set(self.sources)):
            why = f"draws from {printable(unknown[0])}, which none of the first {LOOKED_AT} trials does"
            raise InputError(f"the function {why}. Draw every source in every run.")
        counts = {f"draws_{i}": drawn.get(name, {}).get((), 0) for i, name in enumerate(self.sources)}
        return Run(**{**result.given(), "columns": {**(result.columns or {}), **counts}})


@dataclass(frozen=True)
class Contribution:
    """What one source contributes to the error.

    Attributes
    ----------
    source : str
    alone : float
        Root of the first-order part V of the mean square error, in the unit of the error; NaN where V is not above 0.
    alone_ci : tuple of float
        Its interval at 95 %, from 0 on.
    share : float
        V over the variance of the error.
    with_others : float
        Root of the total part T, with all interactions.
    """

    source: str
    alone: float
    alone_ci: tuple[float, float]
    share: float
    with_others: float

    @property
    def json(self) -> dict[str, Any]:
        return {
            "source": self.source,
            "alone": None if math.isnan(self.alone) else self.alone,
            "alone_ci": list(self.alone_ci),
            "share": self.share,
            "with_others": self.with_others,
        }


def _root(square: float) -> float:
    return math.sqrt(square) if square > 0 else math.nan


class _Errors:
    """Signed errors [trial, step, component] of each of the runs at the steps that are asked about, and A's P."""

    def __init__(self, simulation: Simulation, sources: Sequence[str], at: str) -> None:
        self.sources = sources
        arms = [simulation[name] for name in simulation.arms]
        counted = np.all([arm["status"] == 0 for arm in arms], axis=0)  # with a result, and not diverged
        self.left_out = int((~counted).sum())
        if counted.sum() < 2:
            why = f"{int(counted.sum())} of {simulation.trials} trials have a result in every one of {len(arms)} runs"
            raise InputError(f"trials: {why}. Give more trials, or see what becomes of one with credence.simulate.")
        self.trials = int(counted.sum())
        first = arms[0].record()
        self.names = list(first.get("component_names") or [])
        self.units = list(first.get("component_units") or [])
        self.groups: dict[str, list[int]] = first.get("groups") or {}
        self._steps, self._at = first.get("steps"), at
        self.of = {arm.name: self._taken(self._error(arm))[counted] for arm in arms}
        self.counts = {arm.name: [arm[f"draws_{i}"][counted] for i in range(len(sources))] for arm in arms}
        count = self.of["a"].shape[-1]
        self.names = self.names or [f"e{j}" for j in range(count)]
        self.units = self.units or [""] * count
        covariance = first.get("covariance")
        self.variance = None if covariance is None else self._taken(self._variances(covariance, count))
        if self.variance is not None and len(self.variance) > 1:
            self.variance = self.variance[counted[: len(self.variance)]]

    @staticmethod
    def _error(arm: SimulatedArm) -> Array:
        try:
            return arm.read("error")
        except KeyError:
            raise InputError(
                "run: has no error [step, n], whose sign a budget needs. Give error in place of what has none."
            ) from None

    @staticmethod
    def _variances(covariance: Array, count: int) -> Array:
        """[trial, step, n], with a dimension of 1 for what is the same in all trials."""
        is_matrix = covariance.ndim >= 3 and covariance.shape[-2] == covariance.shape[-1] == count
        variances = np.diagonal(covariance, axis1=-2, axis2=-1) if is_matrix else covariance
        return variances if variances.ndim == 3 else variances[None]

    def _taken(self, values: Array) -> Array:
        """[trial, step, component] at the steps that are asked about; what is not in the state counts as 0."""
        if self._at == "last":
            last = np.full(len(values), values.shape[1]) if self._steps is None else self._steps.astype(int)
            values = values[np.arange(len(values)), last[: len(values)] - 1][:, None]
        return np.nan_to_num(values)


def _estimate(values: Array) -> tuple[float, float]:
    """Mean over the trials of squares of centred numbers [trial], and its standard error."""
    count = len(values)
    return float(values.sum() / (count - 1)), float(values.std(ddof=1) / math.sqrt(count))


class Part:
    """The budget of a component, or of a group of one unit.

    Attributes
    ----------
    name, unit : str
    contributions : list of Contribution
        By size.
    mean : float
        Root of the squared mean error, in the unit of the error.
    interactions : float
        Root of half the sum of T - V over the sources: an upper bound where no three sources interact.
    rss, rmse : float
        Root of what the contributions and the mean add up to; root mean square error of A and B.
    closes : bool
        Whether these two agree within three standard errors.
    p_says : float
        Root of the mean variance in the filter's own P of A; NaN where the runs have none.
    ratio : float
        Mean square error over that of P.
    """

    def __init__(self, name: str, unit: str, errors: _Errors, members: Sequence[int]) -> None:
        from scipy import stats

        self.name, self.unit = name, unit

        def centred(arm: str) -> Array:
            values: Array = errors.of[arm][:, :, members]
            return np.asarray(values - values.mean(axis=0))

        def squares(values: Array) -> Array:
            """[trial] summed over the components, averaged over the steps."""
            return np.asarray(values.sum(axis=2).mean(axis=1))

        a, b = centred("a"), centred("b")
        own = (squares(a * a) + squares(b * b)) / 2
        variance, _ = _estimate(own)
        half = float(stats.t.ppf(0.975, errors.trials - 1))
        self.contributions: list[Contribution] = []
        met, interactions = np.zeros(errors.trials), 0.0
        for i, source in enumerate(errors.sources):
            x, y = a - centred(f"c{i}"), centred(f"d{i}") - b
            alone, total = squares(x * y) / 2, squares(x * x + y * y) / 4
            met += (alone + total) / 2
            v, error = _estimate(alone)
            t, _ = _estimate(total)
            interactions += (t - v) / 2
            ends = (math.sqrt(max(0.0, v - half * error)), math.sqrt(max(0.0, v + half * error)))
            share = v / variance if variance > 0 else math.nan
            self.contributions.append(Contribution(source, _root(v), ends, share, math.sqrt(t)))
        self.contributions.sort(key=lambda one: -one.with_others)
        mean = np.concatenate([errors.of["a"], errors.of["b"]])[:, :, members].mean(axis=0)
        square = max(0.0, float((mean**2).sum(axis=1).mean()) - variance / (2 * errors.trials))
        self.mean, self.interactions = math.sqrt(square), math.sqrt(max(0.0, interactions))
        difference, error = _estimate(met - own)
        self.rss, self.rmse = math.sqrt(max(0.0, _estimate(met)[0]) + square), math.sqrt(variance + square)
        self.closes = abs(difference) <= LARGEST_Z * error or abs(difference) <= 1e-9 * variance
        self.p_says = self.ratio = math.nan
        if errors.variance is not None:
            says = float(errors.variance[:, :, members].sum(axis=2).mean())
            self.p_says = math.sqrt(says)
            self.ratio = self.rmse**2 / says if says > 0 else math.nan

    @property
    def json(self) -> dict[str, Any]:
        numbers = ("mean", "interactions", "rss", "rmse", "p_says", "ratio")
        found = {name: None if math.isnan(value := getattr(self, name)) else value for name in numbers}
        rows = [one.json for one in self.contributions]
        return {"of": self.name, "unit": self.unit, "sources": rows, **found, "closes": self.closes}

    def __str__(self) -> str:
        width = max(10, *(len(one.source) for one in self.contributions))
        lines = [f"  {'source':<{width}}     alone  95 %                  share  with others"]
        for one in self.contributions:
            low, high = one.alone_ci
            alone = f"{one.alone:9.4g}" if one.alone == one.alone else f"{f'< {high:.3g}':>9}"
            said = f"{100 * one.share:6.1f} %" if one.share == one.share else f"{'-':>8}"
            interval = f"{low:.4g} to {high:.4g}"
            lines.append(f"  {one.source:<{width}} {alone}  {interval:<20} {said}  {one.with_others:.4g}")
        lines.append(f"  {'mean error':<{width}} {self.mean:9.4g}")
        doubt = "" if self.closes else ": they do not meet, as three sources or more interact"
        sums = f"together {self.rss:.4g}, RMSE {self.rmse:.4g}{doubt}"
        lines.append(f"  interactions at most {self.interactions:.4g}; {sums}")
        if self.p_says == self.p_says:
            lines.append(f"  P says {self.p_says:.4g}: the squared error is {100 * self.ratio:.0f} % of it")
        return "\n".join(lines)


class Budget:
    """The error of a filter by its sources. ``str()`` is a table.

    Attributes
    ----------
    trials : int
        Those that count: with a result, not diverged, in all of the 2S + 2 runs.
    left_out : int
        The others.
    sources : list of str
    parts : list of str
        The names of the components and groups that there is a budget of: ``budget["position"]`` is a Part.
    of : str
        The one that ``table``, ``str()`` and ``plot()`` show.
    simulation : Simulation
        The runs: ``"a"`` is the study itself, ``"b"`` an independent world, ``"c0"`` is A with the first source of B,
        ``"d0"`` B with the first source of A, and so on.
    """

    def __init__(self, simulation: Simulation, sources: Sequence[str], of: str | None, at: str) -> None:
        errors = _Errors(simulation, sources, at)
        self.simulation, self.sources, self.at = simulation, list(sources), at
        self.trials, self.left_out, self.seed = errors.trials, errors.left_out, simulation.seed
        whole = {"all": list(range(len(errors.names)))}
        members = whole | errors.groups | {name: [j] for j, name in enumerate(errors.names)}
        self._parts = {
            name: Part(name, errors.units[indices[0]], errors, indices)
            for name, indices in members.items()
            if len({errors.units[j] for j in indices}) == 1
        }
        self.of = next(iter(self._parts)) if of is None else of
        if self.of not in self._parts:
            if self.of in members:
                raise invalid("of", self.of, "its components have several units", f"Take {', '.join(self._parts)}")
            raise invalid("of", self.of, "there is no such component or group", f"Take {', '.join(self._parts)}")
        self._warn_of_shifts(errors)

    def _warn_of_shifts(self, errors: _Errors) -> None:
        for j, held in enumerate(self.sources):
            for i, source in enumerate(self.sources):
                if i != j and not np.array_equal(errors.counts[f"c{i}"][j], errors.counts["a"][j]):
                    stream = "the generator itself" if held == REST else f"rng[{held!r}]"
                    note(f"what is drawn from {stream} changes in number with {source}, so that it is not held. "
                         f"Draw it by its number, too: rng[{held!r}, k].")  # fmt: skip
                    break

    @property
    def parts(self) -> list[str]:
        return list(self._parts)

    def __getitem__(self, name: str) -> Part:
        if name not in self._parts:
            raise KeyError(f"the budget has no {name}. It has {', '.join(self._parts)}")
        return self._parts[name]

    @property
    def table(self) -> list[dict[str, Any]]:
        """A row for each source: its name, `alone`, `alone_ci`, `share` and `with_others`."""
        return [one.json for one in self[self.of].contributions]

    @property
    def json(self) -> dict[str, Any]:
        said = {name: getattr(self, name) for name in ("trials", "left_out", "seed", "at")}
        return {**said, "parts": [part.json for part in self._parts.values()]}

    @property
    def csv(self) -> str:
        """A row for each part and source."""
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(["of", "unit", "source", "alone", "alone_low", "alone_high", "share", "with_others"])
        for part in self._parts.values():
            for one in part.contributions:
                numbers = [one.alone, *one.alone_ci, one.share, one.with_others]
                writer.writerow([part.name, part.unit, one.source, *map(repr, numbers)])
        return text.getvalue()

    def plot(self) -> Picture:
        """Bars of what each source contributes, alone and with others, beside the whole error and P's."""
        from credence.pictures.budget import picture

        return picture(self)

    def __str__(self) -> str:
        part = self[self.of]
        when = "at the last step" if self.at == "last" else "on average over the steps"
        unit = f" [{part.unit}]" if part.unit not in ("", "1") else ""
        left = f"; {self.left_out} more that failed or diverged in a run are left out" if self.left_out else ""
        return f"error of {self.of}{unit} {when}, by its sources: {self.trials} trials{left}\n{part}\n"

    def __repr__(self) -> str:
        return f"<credence.Budget of {', '.join(self.sources)}: {self.trials} trials>"


def _at(name: str, value: Any) -> str:
    if value not in AT:
        raise invalid(name, value, "no such place", "Take last or mean")
    return str(value)


def _sources_of(run: Callable[..., Any], seed: int, trials: int) -> list[str]:
    """The names that the first trials draw from, in the order of their first use; one that fails may draw less."""
    found: dict[str, None] = {}
    for trial in range(min(LOOKED_AT, trials)):
        streams = Streams(seed_sequence(seed, trial))
        with contextlib.suppress(Exception):
            run(streams)
        found |= dict.fromkeys(streams.drawn())
    if not found:
        raise wrong("run", "it draws nothing from rng", 'Draw every random number from rng["source", k]')
    return list(found)


@doors.door(trials=doors.whole(2), seed=SEED, at=_at, executor=doors.executor, progress=doors.flag)
def budget(
    run: Callable[..., Any],
    trials: int,
    *,
    seed: int = 1,
    of: str | None = None,
    at: str = "last",
    executor: Any = None,
    progress: bool | None = None,
    options: Mapping[str, Any] | None = None,
) -> Budget:
    """Tell the error of a filter by its sources: each is drawn anew with all others held.

    With A and B two independent worlds, C_s is A with source s of B, and D_s is B with source s of A. Of signed errors
    about their mean, x = A - C_s and y = D_s - B: alone V = E[xy]/2, with others T = E[x^2 + y^2]/4, and T - V is its
    interactions [Sobol 1993; Janon, Klein, Lagnoux, Nodet, Prieur 2014].

    Parameters
    ----------
    run : function
        As of `credence.simulate`. It draws by the names of the sources, ``rng["measurement", k].normal()`` at step k;
        what it draws from ``rng`` itself is the source ``"rest"``. Its `Run` has ``error``.
    trials : int
        Of each of the 2S + 2 runs, S the number of sources.
    seed : int
        From 0 to 2^64 - 1. A is what `simulate` gives with it, bit for bit.
    of : str
        The component, or group of one unit, that is shown; by default the whole state or else the first group.
    at : str
        ``"last"`` step of each run, or the ``"mean"`` over its steps.
    executor, progress
        As of `credence.simulate`.
    options : dict
        Further arguments of `run`.

    Returns
    -------
    Budget

    Raises
    ------
    InputError
        A ValueError: `run` draws nothing, has no error, or `of` is no component or group of one unit.
    """
    if not callable(run):
        raise wrong("run", f"a {type(run).__name__} cannot be called", "Give a function of a generator")
    doors.needed("scipy.stats", "scipy", "give intervals")
    function = functools.partial(run, **(options or {}))
    sources = _sources_of(function, seed, trials)
    arms: dict[str, dict[str, Any]] = {"a": {"other": ()}, "b": {"other": tuple(sources)}}
    for i, source in enumerate(sources):
        arms[f"c{i}"] = {"other": (source,)}
        arms[f"d{i}"] = {"other": tuple(one for one in sources if one != source)}
    worlds = _Worlds(function, sources)
    simulation = simulate(worlds, trials, seed=seed, arms=arms, executor=executor, progress=progress)
    return Budget(simulation, sources, of, at)
