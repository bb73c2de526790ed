"""Why an error is what it is: by its sources, each drawn anew with all others held [docs/budget.md].

    def run(rng):                                           # one run of a filter
        z = x + r * rng["measurement", k].normal()          # draws by the name of their source
        ...
    print(credence.budget(run, trials=2000))
    print(credence.budget("scenario.ini"))
"""

from __future__ import annotations

import contextlib
import dataclasses
import functools
import json
import math
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from credence import _core
from credence import _doors as doors
from credence._calls import note
from credence._errors import InputError, invalid, printable, wrong
from credence._record import Run
from credence._streams import REST, Streams
from credence._trials import Array, seed_sequence
from credence.program import SEED, SETTINGS, budget_of, settings_of
from credence.simulating import SimulatedArm, Simulation, simulate

if TYPE_CHECKING:
    from credence.pictures.style import Picture

__all__ = ["Budget", "Contribution", "budget"]

AT = ("last", "mean")
LOOKED_AT = 20  # trials whose sources are the sources
LARGEST_REST = 1e-6  # what the sources count may differ from P, relative to the standard deviations


class _Worlds:
    """A function of a generator, called with some of its sources drawn anew."""

    def __init__(self, run: Callable[..., Any], sources: Sequence[str], counted: Sequence[str], at: str) -> None:
        self.run, self.sources, self.counted, self.at = run, tuple(sources), tuple(counted), at

    def __call__(self, rng: Streams, other: Sequence[str]) -> Run:
        """The run, with how often each source was drawn by its name alone as a column, and what of P each counts."""
        streams = rng.other(other)
        result = self.run(streams)
        if not isinstance(result, Run):
            raise TypeError(f"the function returned {type(result).__name__}, not a credence.Run")
        drawn = streams.drawn()
        if unknown := sorted(drawn.keys() - set(self.sources)):
            why = f"draws from {printable(unknown[0])}, which none of the first {LOOKED_AT} trials does"
            raise InputError(f"the function {why}. Draw every source in every run.")
        counts: dict[str, float] = {f"draws_{i}": drawn.get(name, {}).get((), 0) for i, name in enumerate(self.sources)}
        if not other:
            counts |= self._counted(streams.counted, np.asarray(result.given().get("covariance", ())))
        return Run(**{**result.given(), "columns": {**(result.columns or {}), **counts}})

    def _counted(self, counted: Mapping[str, Array], P: Array) -> dict[str, float]:
        """The variances that are counted for each source, [source, n] as columns; P [step, n, n]."""
        if counted.keys() != set(self.counted):
            now, before = (printable(", ".join(names) or "no source") for names in (counted, self.counted))
            raise InputError(f"the function counts {now}, and in other trials {before}. Call rng.counts for the same "
                             "sources in every run.")  # fmt: skip
        if not counted:
            return {}
        shapes = {P.shape} | {one.shape for one in counted.values()}
        if len(shapes) > 1 or P.ndim != 3:
            raise InputError(f"rng.counts: the shapes {', '.join(map(str, shapes))} are not all that of covariance, "
                             "[step, n, n]. Give the whole of each P_s at every step.")  # fmt: skip
        sigma = np.sqrt(np.diagonal(P, axis1=1, axis2=2))
        rest = np.nanmax(np.abs(sum(counted.values()) - P) / (sigma[:, :, None] * sigma[:, None, :]))
        if not rest <= LARGEST_REST:
            raise InputError(f"rng.counts: what all sources count differs from covariance by {rest:.2g} of it. "
                             "Propagate each by (I - K H) P_s (I - K H)' + K R_s K', K the filter's own.")  # fmt: skip
        steps = slice(-1, None) if self.at == "last" else slice(None)
        variances = [np.diagonal(counted[name][steps], axis1=1, axis2=2).mean(axis=0) for name in self.counted]
        return {f"counts_{i}_{j}": value for i, own in enumerate(variances) for j, value in enumerate(own)}


@dataclass(frozen=True)
class Contribution:
    """What one source contributes to the error.

    Attributes
    ----------
    source : str
    alone : float
        Root of the first-order part V of the mean square error, in the unit of the error; NaN where V is below 0.
    alone_ci : tuple of float
        Its interval at 95 %, from 0 on.
    share : float
        V over the variance of the error.
    with_others : float
        Root of the total part T, with all interactions.
    p_counts : float
        Root of the variance that P counts for the source; NaN where it is not known.
    ratio : float
        V over that variance; NaN where P counts none.
    """

    source: str
    alone: float
    alone_ci: tuple[float, float]
    share: float
    with_others: float
    p_counts: float
    ratio: float


@dataclass(frozen=True)
class Part:
    """The budget of a component, or of a group of one unit.

    Attributes
    ----------
    of, unit : str
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
    there : float
        The share of its errors that are in the state in every run; the others are left out.
    """

    of: str
    unit: str
    contributions: list[Contribution]
    mean: float
    interactions: float
    rss: float
    rmse: float
    closes: bool
    p_says: float
    ratio: float
    there: float

    @classmethod
    def of_json(cls, part: Mapping[str, Any]) -> Part:
        """The part that the program's JSON has."""
        def known(numbers: Mapping[str, Any]) -> dict[str, Any]:
            return {name: math.nan if value is None else value for name, value in numbers.items()}

        rows = [known({**row, "alone_ci": tuple(row["alone_ci"])}) for row in part["sources"]]
        given = {name: value for name, value in part.items() if name != "sources"}
        return cls(contributions=[Contribution(**row) for row in rows], **known(given))


class _Errors:
    """Signed errors [trial, step, component] of each of the runs at the steps that are asked about, and A's P."""

    def __init__(self, simulation: Simulation, sources: Sequence[str], counted_sources: Sequence[str], at: str) -> None:
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
        self.variance: list[float] = []  # means over trials and steps, [n]
        if covariance is not None:
            variance = self._taken(self._variances(covariance, count))
            own = variance if len(variance) == 1 else variance[counted[: len(variance)]]
            self.variance = own.mean(axis=(0, 1)).tolist()
        self.counted = [(name, [float(arms[0][f"counts_{i}_{j}"][counted].mean()) for j in range(count)])
                        for i, name in enumerate(counted_sources)]  # fmt: skip

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


def estimated(
    errors: Sequence[Array], sources: Sequence[str], components: Sequence[tuple[str, str]],
    groups: Mapping[str, Sequence[int]] | None = None, variance: Sequence[float] = (), left_out: int = 0,
    seed: int = 1, at: str = "last", of: str | None = None, counted: Sequence[tuple[str, Sequence[float]]] = (),
) -> _core.Said:  # fmt: skip
    """What the program says of the errors [trial, step, n] of the runs A, B, C_0, D_0 and so on.

    Parameters
    ----------
    errors : list of array
    sources : list of str
    components : list of tuple of str
        Name and unit of each, [n].
    groups : dict
        Components by the names of groups.
    variance : list of float
        The mean of each variance in P, [n].
    left_out : int
        Trials that are not there.
    seed, at, of
        As of `budget`.
    counted : list of tuple
        A source, and the mean of what each variance in P counts for it, [n].
    """
    arrays = [np.ascontiguousarray(one, dtype=float) for one in errors]
    return _core.budget(arrays, list(sources), list(components), list((groups or {}).items()), list(variance),
                        left_out, seed, at, of or "", list(counted))  # fmt: skip


class Budget:
    """The error of a filter by its sources. ``str()`` is a table of each arm.

    Attributes
    ----------
    arms : list of str
        ``scenario/arm``; of a function, ``run`` alone. What follows is of the first of them, ``arm(name)`` of another.
    trials : int
        Those that count: with a result, not diverged, in all of the 2S + 2 runs.
    left_out : int
        The others.
    counted_trials : int
        Those over which what P counts is split; 0 where it is not known.
    sources : list of str
    parts : list of str
        The names of the components and groups that there is a budget of: ``budget["position"]`` is a Part.
    of : str
        The one that ``table``, ``str()`` and ``plot()`` show.
    json : list of dict
        What ``credence budget --format json`` prints: an entry for each arm.
    csv : str
        A row for each arm, part and source.
    simulation : Simulation or None
        The runs of a function: ``"a"`` is the study itself, ``"b"`` an independent world, ``"c0"`` is A with the first
        source of B, ``"d0"`` B with the first source of A, and so on.
    study : Study or None
        Those of a scenario: the scenario itself, then ``-B``, ``-C-heading``, ``-D-heading`` and so on.
    """

    def __init__(self, texts: Mapping[str, str], simulation: Any = None, study: Any = None, arm: int = 0) -> None:
        self._texts, self._arm, self.simulation, self.study = dict(texts), arm, simulation, study
        self.json: list[dict[str, Any]] = json.loads(texts["json"])
        self.csv = texts["csv"]
        own = self.json[arm]
        self.arms = [f"{one['scenario']}/{one['arm']}".removeprefix("/") for one in self.json]
        self.trials, self.left_out, self.counted_trials = own["trials"], own["left_out"], own["counted_trials"]
        self.seed, self.at, self.of, self.sources = own["root_seed"], own["at"], own["of"], own["sources"]
        self._parts = {part["of"]: Part.of_json(part) for part in own["parts"]}

    def arm(self, name: str) -> Budget:
        """The budget of the arm of this name, ``scenario/arm``, or ``arm`` where one scenario has it."""
        found = [i for i, one in enumerate(self.arms) if name in (one, one.rpartition("/")[2])]
        if len(found) != 1:
            raise KeyError(f"there is no one arm {name}. There is {', '.join(self.arms)}")
        return Budget(self._texts, self.simulation, self.study, found[0])

    @property
    def parts(self) -> list[str]:
        return list(self._parts)

    def __getitem__(self, name: str) -> Part:
        if name not in self._parts:
            raise KeyError(f"the budget has no {name}. It has {', '.join(self._parts)}")
        return self._parts[name]

    @property
    def table(self) -> list[dict[str, Any]]:
        """A row for each source: its name, `alone`, `alone_ci`, `share`, `with_others`, `p_counts` and `ratio`."""
        return [dataclasses.asdict(one) for one in self[self.of].contributions]

    def plot(self) -> Picture:
        """Bars of what each source contributes, alone and with others, beside what P counts, and the whole error."""
        from credence.pictures.budget import picture

        return picture(self)

    def __str__(self) -> str:
        return self._texts["text"]

    def __repr__(self) -> str:
        return f"<credence.Budget of {', '.join(self.sources)}: {self.trials} trials>"


def _texts(said: _core.Said) -> dict[str, str]:
    return {form: said.in_format(form) for form in ("text", "json", "csv")}


def _warn_of_shifts(sources: Sequence[str], errors: _Errors) -> None:
    for j, held in enumerate(sources):
        for i, source in enumerate(sources):
            if i != j and not np.array_equal(errors.counts[f"c{i}"][j], errors.counts["a"][j]):
                stream = "the generator itself" if held == REST else f"rng[{held!r}]"
                note(f"what is drawn from {stream} changes in number with {source}, so that it is not held. "
                     f"Draw it by its number, too: rng[{held!r}, k].")  # fmt: skip
                break


def _at(name: str, value: Any) -> str:
    if value not in AT:
        raise invalid(name, value, "no such place", "Take last or mean")
    return str(value)


def _sources_of(run: Callable[..., Any], seed: int, trials: int) -> tuple[list[str], list[str]]:
    """The names that the first trials draw from, and those that they count, in the order of their first use; one that
    fails may draw less."""
    found: dict[str, None] = {}
    counted: dict[str, None] = {}
    for trial in range(min(LOOKED_AT, trials)):
        streams = Streams(seed_sequence(seed, trial))
        with contextlib.suppress(Exception):
            run(streams)
        found |= dict.fromkeys(streams.drawn())
        counted |= dict.fromkeys(streams.counted)
    if not found:
        raise wrong("run", "it draws nothing from rng", 'Draw every random number from rng["source", k]')
    return list(found), list(counted)


def _of_function(
    run: Callable[..., Any], trials: int, seed: int, of: str | None, at: str, executor: Any, progress: bool | None
) -> Budget:
    sources, counted = _sources_of(run, seed, trials)
    arms: dict[str, dict[str, Any]] = {"a": {"other": ()}, "b": {"other": tuple(sources)}}
    for i, source in enumerate(sources):
        arms[f"c{i}"] = {"other": (source,)}
        arms[f"d{i}"] = {"other": tuple(one for one in sources if one != source)}
    worlds = _Worlds(run, sources, counted, at)
    simulation = simulate(worlds, trials, seed=seed, arms=arms, executor=executor, progress=progress)
    errors = _Errors(simulation, sources, counted, at)
    said = estimated(
        [errors.of[name] for name in arms], sources, list(zip(errors.names, errors.units)),
        {"all": range(len(errors.names)), **errors.groups}, errors.variance, errors.left_out, seed, at, of,
        errors.counted,
    )  # fmt: skip
    made = Budget(_texts(said), simulation)
    _warn_of_shifts(sources, errors)
    return made


def _of_scenario(
    run: Any, trials: int, seed: int, of: str | None, at: str, executor: Any, progress: bool | None,
    settings: Mapping[str, object],
) -> Budget:  # fmt: skip
    options = {"trials": trials, "seed": seed, **settings}
    said, study = budget_of(run, of, at, options, executor, progress)
    return Budget(_texts(said), study=study)


@doors.door(
    trials=doors.whole(2), seed=SEED, at=_at, executor=doors.executor, progress=doors.flag, set=SETTINGS,
    sweep=doors.sweep,
)  # fmt: skip
def budget(
    run: Callable[..., Any] | str | os.PathLike[str],
    trials: int = 10_000,
    *,
    seed: int = 1,
    of: str | None = None,
    at: str = "last",
    executor: Any = None,
    progress: bool | None = None,
    options: Mapping[str, Any] | None = None,
    set: Mapping[str, object] | None = None,
    sweep: Mapping[str, Any] | None = None,
) -> Budget:
    """Tell the error of a filter by its sources: each is drawn anew with all others held.

    With A and B two independent worlds, C_s is A with source s of B, and D_s is B with source s of A. Of signed errors
    about their mean, x = A - C_s and y = D_s - B: alone V = E[xy]/2, with others T = E[x^2 + y^2]/4, and T - V is its
    interactions [Sobol 1993; Janon, Klein, Lagnoux, Nodet, Prieur 2014].

    Parameters
    ----------
    run : function, path or str
        A function as of `credence.simulate`, which draws by the names of the sources,
        ``rng["measurement", k].normal()`` at step k; what it draws from ``rng`` itself is the source ``"rest"``. Its
        `Run` has ``error``. What of P it counts for each it may say by ``rng.counts("measurement", P_s)``, P_s
        [step, n, n]. Or a scenario file, or the text of one, as of `credence.run`.
    trials : int
        Of each of the 2S + 2 runs, S the number of sources.
    seed : int
        From 0 to 2^64 - 1. A is what `simulate` or `run` gives with it, bit for bit.
    of : str
        The component, or group of one unit, that is shown; by default the whole state or else the first group.
    at : str
        ``"last"`` step of each run, or the ``"mean"`` over its steps: of a scenario, over ten of them.
    executor, progress
        As of `credence.simulate`.
    options : dict
        Further arguments of a function.
    set, sweep : dict
        Values of keys of a scenario, as of `credence.run`.

    Returns
    -------
    Budget

    Raises
    ------
    InputError
        A ValueError: `run` draws nothing, has no error, or `of` is no component or group of one unit.
    """
    if isinstance(run, (str, os.PathLike)):
        if options:
            raise wrong("options", "a scenario has keys", "Give them as set")
        return _of_scenario(run, trials, seed, of, at, executor, progress, settings_of(set, sweep))
    if not callable(run):
        raise wrong("run", f"a {type(run).__name__} cannot be called", "Give a function of a generator, or a scenario")
    if set or sweep:
        raise wrong("set", "a function has no keys", "Give its arguments as options")
    return _of_function(functools.partial(run, **(options or {})), trials, seed, of, at, executor, progress)
