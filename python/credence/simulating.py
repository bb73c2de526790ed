"""Many trials of a filter in Python, on any executor, to verdicts.

    def run(rng, *, q=0.2):                                 # one run of a filter
        ...
        return credence.Run(error, covariance)

    study = credence.simulate(run, trials=2000, arms={"right": {}, "calm": {"q": 0.04}}, executor=8)
    study.verdicts                                          # {"right": <Verdict consistent>, "calm": <Verdict ...>}

docs/python.md says where random numbers come from, what is kept, and what becomes of trials that fail.
"""

from __future__ import annotations

import contextlib
import functools
import inspect
import math
import os
import re
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from credence import _core, _errors
from credence import _doors as doors
from credence._calls import framed, note, progress_bar
from credence._errors import InputError, invalid, printable, wrong
from credence._outputs import check_output, goes_with
from credence._record import Run
from credence._results import Results, Sources, cached
from credence._trial_files import Trials, get_text, write_records
from credence._trials import BATCH, Arms, Array, Failure, Frame, Work, generator, is_frame, run_chunk, same
from credence._workers import TRIES, Workers
from credence.judging import Verdict, judge, tune_hint
from credence.program import SEED, Interrupted, report

if TYPE_CHECKING:
    from credence.arm import Arm
    from credence.means import Means
    from credence.study import Study

    File = str | os.PathLike[str]
    Goals = str | Sequence[str] | Mapping[str, object]
    Payload = tuple[list[int], list[int], bool]  # numbers, those of them that are kept, whether twice

__all__ = ["Run", "SimulatedArm", "Simulation", "simulate"]

FIRST_ANALYSIS = 256  # trials
ALPHA = 0.05
HOPELESS = 20  # an arm whose first trials all fail or are all the same, this many, stops the study
LEADING = ("error", "estimate", "nees", "innovation")
CHUNK_SECONDS, CHUNK_BYTES, CHUNK_TRIALS = 0.25, 2**25, 1024
ONLY_ARM = "run"


class Goal(NamedTuple):
    """A mean that is to be known to a half-width: of a number, or of its differences between two arms."""

    metric: str
    arms: tuple[str, str] | None
    width: float
    is_relative: bool

    def __str__(self) -> str:
        pair = f"[{self.arms[0]}-{self.arms[1]}]" if self.arms else ""
        return f"{self.metric}{pair}=" + (f"{100 * self.width:g}%" if self.is_relative else f"{self.width:g}")

    def is_met(self, values: Array, alpha: float) -> bool:
        """Whether Student's interval of this level is narrow enough."""
        from scipy import stats

        values = values[~np.isnan(values)]
        if values.size < 2:
            return False
        half = stats.t.ppf(1 - alpha / 2, values.size - 1) * values.std(ddof=1) / math.sqrt(values.size)
        return bool(half <= self.width * (abs(values.mean()) if self.is_relative else 1))


def _goal(name: str, width: object, arms: Arms) -> Goal:
    refused = functools.partial(invalid, "until", f"{name}={width}" if name else str(width))
    parts = re.fullmatch(r"([^\[\]=]+)(?:\[(.+)\])?", name.strip())
    number = str(width).strip()
    try:
        size = float(number.removesuffix("%"))
    except ValueError:
        size = math.nan
    if parts is None or not (size > 0 and math.isfinite(size)):
        raise refused("no half-width above 0", 'Give one, such as {"nees_ratio": "1%"}')
    pair = None
    if parts[2] is not None:
        pairs = [(a, b) for a in arms for b in arms if a != b and f"{a}-{b}" == parts[2]]
        if not pairs:
            raise refused("there are no two such arms", f"Write NUMBER[A-B] with two of {', '.join(arms)}")
        pair = pairs[0]
    is_relative = number.endswith("%")
    return Goal(parts[1].strip(), pair, size / 100 if is_relative else size, is_relative)


def _goals(until: Goals | None, arms: Arms) -> list[Goal]:
    if until is None:
        return []
    if isinstance(until, Mapping):
        return [_goal(name, width, arms) for name, width in until.items()]
    texts = [until] if isinstance(until, str) else list(until)
    return [_goal(name, width, arms) for name, _, width in (text.rpartition("=") for text in texts)]


def _arms(given: Mapping[str, Mapping[str, Any]] | None) -> Arms:
    if given is None:
        return {ONLY_ARM: {}}
    arms = {}
    for name, options in doors.mapping("{'kf': {'q': 0.2}}")("arms", given).items():
        if not isinstance(name, str) or not re.fullmatch(r"\w[\w.+-]*", name):
            why = f"{printable(name)} is no name of letters, digits and . + -"
            raise wrong("arms", why, "Give one that can be a part of a file's name")
        if not isinstance(options, Mapping):
            raise wrong("arms", f"{name} has no dict of options", "Give one, such as {'kf': {'q': 0.2}}")
        arms[name] = dict(options)
    if not arms:
        raise wrong("arms", "there is none", "Name one, or leave arms out")
    return arms


class _Files:
    """The files of a study: its record, which has a group for each arm if there are arms, and its trials.

    Temporary ones are removed with this object, which whoever reads them has.
    """

    def __init__(self, output: File | None, arms: Mapping[str, Any] | None, resume: bool) -> None:
        self.arms = None if arms is None else list(arms)
        folder = tempfile.mkdtemp(prefix="credence-") if output is None else None
        self.record = Path(folder, f"{ONLY_ARM}.h5") if folder else self._checked(output, resume)
        self.trials = self._trials_of(self.record)
        self._remove = goes_with(self, folder) if folder else None

    @staticmethod
    def _trials_of(record: Path) -> Path:
        return record.with_name(f"{record.name}.trials")

    def _checked(self, output: Any, resume: bool) -> Path:
        """Where the record goes. What is there is replaced only by a study that resumes from the trials beside it."""
        trials = self._trials_of(Path(os.path.realpath(output)))
        is_kept = trials.exists()
        if resume and not is_kept and os.path.lexists(output):
            why = f"cannot resume {os.fspath(output)} (its trials are not beside it, in {trials.name})"
            raise InputError(f"{why}. Name another output.")
        remedy = "Name another, or say resume=True to resume from the trials beside it" if is_kept else "Name another"
        if is_kept:
            check_output(trials, resume, remedy)
        return check_output(output, resume, remedy)

    def refuse_another_study(self, study: str) -> None:
        """Refuse to replace a file that is no record of the trials that are kept."""
        import h5py

        if not self.record.exists():
            return
        found = ""
        with contextlib.suppress(OSError, KeyError), h5py.File(self.record, "r") as file:
            found = get_text(file.attrs, "study")
        if found != study:
            why = f"cannot write {self.record} (it is no record of the trials in {self.trials.name})"
            raise InputError(f"{why}. Move it away, or name another output.")

    def remove_temporary(self) -> None:
        if self._remove is not None:
            self._remove()


def _entries(name: str, text: str) -> Any:
    """An attribute of a record: groups as a dict of their members, names as a list, the others as they are."""
    if name in ("manifold", "chart", "quaternion"):
        return text
    entries = [entry.split() for entry in text.split(",")]
    if not name.endswith("groups"):
        return [" ".join(entry) for entry in entries]
    groups: dict[str, list[int]] = {}
    for group, *members in entries:
        ends = [[int(end) for end in member.split(":")] for member in members]
        groups[group] = [one for end in ends for one in (range(*end) if len(end) == 2 else end)]
    return groups


class SimulatedArm(Results):
    """One arm of a simulation: its record, and what is said of it. What an `Arm` of a study has, it has too:
    ``arm["trace_P"]`` [trial], ``arm.per_step("trace_P")``, ``arm.mean("rmse", minus=other)``.

    Attributes
    ----------
    name : str
    path : str
        The record [docs/judge.md] as ``credence judge`` takes it: the file, or ``FILE:ARM`` of a file with arms.
    failures : list of Failure
        Its trials without a result. Those whose numbers are not finite are counted by the verdict.
    """

    def __init__(self, name: str, files: _Files, failures: list[Failure], limit: float | str) -> None:
        self.name, self.failures, self.limit, self._files = name, failures, limit, files
        self.path = str(files.record) if files.arms is None else f"{files.record}:{name}"
        self._verdict: Verdict | None = None

    def judge(self, **options: Any) -> Verdict:
        """The verdict with other options of `credence.judge`, such as `margin`."""
        return judge(self.path, **{"failed": self.limit, "progress": False, **options})

    @property
    def verdict(self) -> Verdict:
        """The verdict with the options of the simulation."""
        if self._verdict is None:
            self._verdict = self.judge()
        return self._verdict

    @contextlib.contextmanager
    def _opened(self) -> Iterator[Any]:
        """The HDF5 group of the record."""
        import h5py

        with h5py.File(self._files.record, "r") as file:
            yield file if self._files.arms is None else file[self.name]

    @cached
    def study(self) -> Study:
        """Its columns and series, as those of a study of one arm that `credence.run` gives."""
        from credence.study import of_records

        return of_records([self.path])

    def sources(self) -> Sources:
        return Sources(records={self.name: self.path})

    @cached
    def results(self) -> Arm:
        """Its columns and series, as those of an arm of a study."""
        return self.study.arms[0]

    def mean(self, name: str, minus: SimulatedArm | None = None) -> Means:
        """The mean of a column, or of its differences trial by trial to another arm, as of `Arm.mean`."""
        return self.results.mean(name, None if minus is None else minus.results)

    def __getitem__(self, name: str) -> Array:
        return self.results[name]

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        return getattr(self.results, name)

    def read(self, name: str) -> Array:
        """An array of the record, such as ``"error"`` [trial, step, n] or ``"trial"`` [trial]."""
        import h5py

        with self._opened() as file:
            if name not in file:
                found: list[str] = []
                file.visititems(lambda place, what: found.append(place) if isinstance(what, h5py.Dataset) else None)
                raise KeyError(f"{self.name} has no {name}. It has {', '.join(found)}")
            return np.asarray(file[name][()])

    @property
    def columns(self) -> dict[str, Array]:
        """{column: its values [trial]}, NaN for trials without a result."""
        with self._opened() as file:
            return {name: np.asarray(column[()]) for name, column in file.get("column", {}).items()}

    def record(self) -> dict[str, Any]:
        """The arguments of `credence.judge`, so that they can be judged again after a change. Groups are dicts."""
        import h5py

        named = ("manifold", "chart", "quaternion", "groups", "row_groups", "component_names", "component_units")
        arguments: dict[str, Any] = {"columns": self.columns} if self.columns else {}
        with self._opened() as file:
            for name, dataset in file.items():
                if isinstance(dataset, h5py.Dataset) and name not in ("trial", "failure"):
                    arguments[name] = np.asarray(dataset[()])
            for name, group in file.get("group", {}).items():
                for what, dataset in group.items():
                    arguments.setdefault(f"group_{what}", {})[name] = np.asarray(dataset[()])
            sized = {"all": file.get("nees"), **{name: one.get("nees") for name, one in file.get("group", {}).items()}}
            sizes = {
                name: int(one.attrs["dimension"]) for name, one in sized.items() if one and "dimension" in one.attrs
            }
            for name in named:
                if name in file.attrs:
                    arguments[name] = _entries(name, get_text(file.attrs, name))
        return arguments | ({"dimension": sizes} if sizes else {})

    def __repr__(self) -> str:
        return f"<credence.SimulatedArm {self.name}: {self.path}>"


class Simulation(Results):
    """Trials of a filter under one arm or several. ``str()`` is what ``credence judge`` says of them.

    Attributes
    ----------
    trials : int
        Trials of each arm, failed ones too.
    seed : int
    failures : list of Failure
        Trials without a result, each with ``arm``, ``trial``, ``reason`` and ``traceback``.
    is_repeatable : bool
        Whether trial 0 gave the same numbers twice.
    """

    def __init__(
        self, files: _Files, work: Work, trials: int, failures: list[Failure], limit: float | str, is_repeatable: bool
    ) -> None:
        self.trials, self.seed, self.failures, self.is_repeatable = trials, work.seed, failures, is_repeatable
        self._work, self.limit, self._path = work, limit, str(files.record)
        self._arms = {
            name: SimulatedArm(name, files, [one for one in failures if one.arm == name], limit) for name in work.arms
        }

    def arm(self, name: str) -> SimulatedArm:
        """One arm; KeyError where there is none of this name."""
        if name not in self._arms:
            raise KeyError(f"the simulation has no arm {name}. It has {', '.join(self._arms)}")
        return self._arms[name]

    def __getitem__(self, name: str) -> SimulatedArm:
        return self.arm(name)

    @cached
    def study(self) -> Study:
        """The columns and series of all arms, as those of a study that `credence.run` gives."""
        from credence.study import of_records

        return of_records([arm.path for arm in self._arms.values()])

    @property
    def arms(self) -> list[str]:
        """The names of the arms, in their order."""
        return list(self._arms)

    @property
    def verdicts(self) -> dict[str, Verdict]:
        """{arm: its verdict}."""
        return {name: arm.verdict for name, arm in self._arms.items()}

    @property
    def columns(self) -> dict[str, dict[str, Array]]:
        """{arm: {column: its values [trial]}}, NaN for trials without a result."""
        return {name: arm.columns for name, arm in self._arms.items()}

    def generator(self, trial: int) -> np.random.Generator:
        """The generator that a trial got, so that the trial can be run again by itself."""
        return generator(self.seed, trial)

    @property
    def records(self) -> dict[str, str]:
        """{arm: the path of its record}."""
        return {name: arm.path for name, arm in self._arms.items()}

    def sources(self) -> Sources:
        return Sources(records=self.records)

    def __str__(self) -> str:
        lines = [str(report(self)).rstrip("\n")]
        if self.failures:
            first = self.failures[0]
            where = f"the first: trial {first.trial} of {first.arm}"
            lines.append(f"\n{len(self.failures)} without a result, {where}: {first.reason}")
            lines += [first.traceback.rstrip("\n")] if first.traceback else []
        refuted = [name for name, verdict in self.verdicts.items() if verdict.is_of_the_filter]
        if refuted:
            lines.append(_tune_hint(self._work.run, self._work.arms, refuted[0]))
        return "\n".join(lines) + "\n"

    def _repr_html_(self) -> str:
        return framed(report(self).html)

    def __repr__(self) -> str:
        said = ", ".join(f"{name} {verdict.verdict}" for name, verdict in self.verdicts.items())
        return f"<credence.Simulation of {self.trials:,} trials, {len(self.failures)} without a result: {said}>"


class _Bar:
    """Progress: trials that are done, their rate, the time left, and NEES/n so far."""

    def __init__(self, bar: Any, total: int) -> None:
        self._bar, self._total = bar, total
        self._sums: dict[str, tuple[int, float]] = {}

    @property
    def is_shown(self) -> bool:
        return self._bar is not None

    def show(self, done: int, frame: Frame | None = None) -> None:
        if self._bar is None:
            return
        for segment in frame.header["segments"] if frame else ():
            values = [value for value in segment["values"].get("nees_ratio", []) if math.isfinite(value)]
            count, total = self._sums.get(segment["arm"], (0, 0.0))
            self._sums[segment["arm"]] = (count + len(values), total + sum(values))
        said = ", ".join(f"{arm} {total / count:.3f}" for arm, (count, total) in self._sums.items() if count)
        self._bar(done, self._total, f"NEES/n {said}" if said else "")


class _Engine:
    """Runs the trials of a study that its file does not have."""

    def __init__(self, work: Work, trials: Trials, ceiling: int, goals: list[Goal], bar: _Bar) -> None:
        self.work, self.trials, self.ceiling, self.goals, self.bar = work, trials, ceiling, goals, bar
        self.lost: list[Failure] = []
        self.is_repeatable = True
        self._seconds = 0.0  # of one trial; 0 before any is done
        self._bytes = 1
        self._checked = False
        self._unmet: Goal | None = None  # a mean that is not yet as precise as asked
        self._failed_first: dict[str, set[int]] = {arm: set() for arm in work.arms}
        self._errors_first: dict[str, dict[int, bytes]] = {arm: {} for arm in work.arms}
        self._count_failures(trials.failures())

    def run(self, workers: Workers[Payload]) -> int:
        """Run what is missing; return how many trials the study has."""
        if self.trials.done:
            self._compare_with_what_is_kept(workers)
        if not self.goals:
            self._run_to(workers, self.ceiling)
            return self.ceiling
        analysis, count = 1, min(FIRST_ANALYSIS, self.ceiling)
        while True:
            self._run_to(workers, count)
            is_met = self._are_met(count, ALPHA / 2**analysis)
            if count == self.ceiling and not is_met:
                note(f"not as precise as asked at the ceiling of {count} trials ({self._unmet}). "
                     "Give more trials, or a wider half-width.")  # fmt: skip
            if count == self.ceiling or is_met:
                return count
            analysis, count = analysis + 1, min(2 * count, self.ceiling)

    def _numbers(self, count: int) -> Iterator[list[int]]:
        """Trials that are missing: one by one, or by batches."""
        size = self.work.batch or 1
        for first in range(0, count, size):
            batch = [one for one in range(first, min(first + size, count)) if one not in self.trials.done]
            if batch:
                yield batch

    def _run_to(self, workers: Workers[Payload], count: int) -> None:
        given = {one.trial for one in self.lost}
        missing = [batch for batch in self._numbers(count) if given.isdisjoint(batch)]
        missing.reverse()

        def take() -> Payload | None:
            if not missing:
                return None
            first = missing.pop()
            if self.work.batch:
                start = first[0] - first[0] % self.work.batch
                return list(range(start, start + self.work.batch)), first, 0 in first
            size = 1 if 0 in first else self._chunk_size(workers.count, len(missing))
            numbers = first + [missing.pop()[0] for _ in range(min(size - 1, len(missing)))]
            return numbers, numbers, 0 in first

        def parts(payload: Payload) -> list[Payload]:
            return [payload] if self.work.batch else [([one], [one], payload[2] and one == 0) for one in payload[0]]

        for (_, keep, _), data in workers.results(take, lambda payload: payload, parts):
            if data is None:
                causes = "it crashed, was killed, had no memory left, or what it sent was damaged"
                reason = f"its worker was lost {TRIES} times ({causes})"
                found = [Failure(arm, one, reason) for one in keep for arm in self.work.arms]
                self.lost += found
                self._count_failures(found)
            else:
                self._add(Frame(data))

    def _chunk_size(self, workers: int, left: int) -> int:
        """So many trials that a chunk takes a quarter of a second, and that the last ones are shared by all workers."""
        if self._seconds == 0:
            return 1
        by_time = int(CHUNK_SECONDS / self._seconds)
        return max(
            1, min(by_time, CHUNK_BYTES // self._bytes, CHUNK_TRIALS, left // (4 * workers) if workers > 1 else left)
        )

    def _add(self, frame: Frame) -> None:
        header = frame.header
        if 0 in header["numbers"] and not self._checked:
            self._check_first(frame)
        self._refuse_unused_generator(frame)
        self.trials.append(frame)
        count = len(header["numbers"])
        self._seconds = max(header["seconds"] / count, 1e-7)
        self._bytes = len(frame.data) // count + 1
        self.bar.show(len(self.trials.done), frame)
        self._count_failures(frame.failures())

    def _check_first(self, frame: Frame) -> None:
        """Refuse what cannot be judged as soon as trial 0 is there, and note where it does not repeat itself."""
        self._checked = True
        for arm, said in frame.header.get("refused", {}).items():
            raise InputError(f"trial 0 of {arm}: {said}")
        for segment, arrays in frame.segments():
            if segment["trials"][0] != 0:
                continue
            for goal in self.goals:
                has_nees = "error" in arrays and "covariance" in arrays
                if f"column/{goal.metric}" not in arrays and not (goal.metric == "nees_ratio" and has_nees):
                    known = [name[7:] for name in arrays if name.startswith("column/")] + ["nees_ratio"] * has_nees
                    why = f"until: the trials have no number {printable(goal.metric)}"
                    raise InputError(f"{why}. Take one of {', '.join(known) or 'columns that Run is given'}.")
        for arm, is_same in frame.header["repeats"].items():
            if not is_same:
                self.is_repeatable = False
                why = f"trial 0 of {arm} gives other numbers from the same generator a second time"
                remedy = "Draw every random number from rng, and keep nothing from trial to trial"
                note(f"{why} (a global generator, the time, or a state that is kept). {remedy}.")

    def _refuse_unused_generator(self, frame: Frame) -> None:
        """Refuse an arm whose first trials have the same errors, to the last bit; one number may be so by chance."""
        needed = min(HOPELESS, self.ceiling)
        if min(frame.header["numbers"]) >= needed:
            return
        for segment, arrays in frame.segments():
            first = self._errors_first[segment["arm"]]
            leading = [array for name, array in arrays.items() if name.split("/")[-1] in LEADING]
            for i, trial in enumerate(segment["trials"]):
                if trial < needed and sum(array[i].size for array in leading) > 1:
                    first[trial] = b"".join(array[i].tobytes() for array in leading)
            if len(first) == needed > 1 and len(set(first.values())) == 1:
                why = f"the first {needed} trials of {segment['arm']} have the same errors, to the last bit"
                raise InputError(f"{why}: the function does not use rng. Draw every random number from rng.")

    def _compare_with_what_is_kept(self, workers: Workers[Payload]) -> None:
        """Run a trial once more, and refuse to add to trials that another function or another library made.

        It is the first that has a result under every arm, if any has: failures say less of the function.
        """
        done = self.trials.done
        number = min(done - {one.trial for one in self.trials.failures()}, default=min(done))
        kept = next(frame for frame in self.trials.frames() if number in frame.header["numbers"])
        if number == 0:
            self._check_first(kept)
        first = number - number % (self.work.batch or 1)
        payloads: list[Payload] = [(list(range(first, first + (self.work.batch or 1))), [number], False)]
        for _, data in workers.results(lambda: payloads.pop() if payloads else None, lambda payload: payload):
            for arm in self.work.arms:
                if data is not None and not same(kept.data, data, arm, [number]):
                    why = f"trial {number} of {arm} gives other numbers than those that are kept"
                    remedy = "Take the function and the libraries that made them, or another output"
                    raise InputError(f"{self.trials.path}: {why}. {remedy}.")

    def _count_failures(self, failures: list[Failure]) -> None:
        """Stop where every one of the first trials of an arm failed."""
        needed = min(HOPELESS, self.ceiling)
        for one in failures:
            if one.trial < needed:
                self._failed_first[one.arm].add(one.trial)
                if len(self._failed_first[one.arm]) == needed:
                    said = f"the first {needed} trials of {one.arm} all failed; this is trial {one.trial}: {one.reason}"
                    raise _errors.Failure(f"{said}\n{one.traceback}".rstrip("\n"))

    def _are_met(self, count: int, alpha: float) -> bool:
        values: dict[tuple[str, str], tuple[Array, Array]] = {}

        def of(metric: str, arm: str) -> tuple[Array, Array]:
            if (metric, arm) not in values:
                trials, numbers = self.trials.values(metric, arm)
                values[metric, arm] = (trials[trials < count], numbers[trials < count])
            return values[metric, arm]

        for goal in self.goals:
            if goal.arms is None:
                samples = [of(goal.metric, arm)[1] for arm in self.work.arms]
            else:
                (trials_a, a), (trials_b, b) = (of(goal.metric, arm) for arm in goal.arms)
                _, in_a, in_b = np.intersect1d(trials_a, trials_b, return_indices=True)
                samples = [a[in_a] - b[in_b]]
            if not all(goal.is_met(sample, alpha) for sample in samples):
                self._unmet = goal
                return False
        return True


def _tune_hint(run: Callable[..., Any], arms: Arms, refuted: str) -> str:
    """The call of `tune` from an arm that is refuted, each number within a factor of ten: of the options that arms set,
    else of those that the function has.
    """
    with contextlib.suppress(TypeError, ValueError):
        defaults = {name: one.default for name, one in inspect.signature(run).parameters.items()}
        set_by_arms = {name for options in arms.values() for name in options}
        numbers = {
            name: value
            for name, value in (defaults | arms[refuted]).items()
            if name in (set_by_arms or defaults) and isinstance(value, (int, float)) and value is not True and value > 0
        }
        free = ", ".join(f'"{name}": ({value / 10:g}, {value * 10:g})' for name, value in numbers.items())
        start = ", ".join(f'"{name}": {numbers[name]:g}' for name in arms[refuted] if name in numbers)
        known = getattr(run, "__name__", "run")
        hint = tune_hint(known if known.isidentifier() else "run", f"{{{free or '...'}}}", start)
        return hint if set_by_arms or len(numbers) < 2 else f"{hint}, leaving out what the truth depends on"
    return tune_hint()


def _refuse_bad_limit(failed: float | str) -> None:
    """Refuse a share that `judge` would refuse in the end."""
    one = (np.ones((1, 1)), float(np.finfo(float).eps))
    _core.judge({"error": one, "covariance": one}, {}, {}, {}, {"segments": "off", "failed": failed}, b"", None)


def batch_size(name: str, value: Any) -> int:
    """How many generators a function takes at once; 0 where it takes one."""
    return int(value) * BATCH if isinstance(value, bool) else doors.whole(1, 2**20)(name, value)


@doors.door(
    trials=doors.whole(1), seed=SEED, batch=batch_size, output=doors.output, resume=doors.flag, until=doors.goals,
    timeout=doors.above_zero, failed=doors.plain, executor=doors.executor, progress=doors.flag,
)  # fmt: skip
def simulate(
    run: Callable[..., Any],
    trials: int,
    *,
    seed: int = 1,
    arms: Mapping[str, Mapping[str, Any]] | None = None,
    executor: Any = None,
    batch: bool | int = False,
    output: File | None = None,
    resume: bool = False,
    until: Goals | None = None,
    timeout: float | None = None,
    failed: float | str = 0.01,
    progress: bool | None = None,
) -> Simulation:
    """Run a filter many times, each time with random numbers of its own, and judge it.

    The results are a function of `run`, `arms`, `seed` and `trials` and of nothing else: not of the executor, the
    number of workers, or interruptions.

    Parameters
    ----------
    run : function
        ``run(rng, **options)`` simulates one run of the filter with random numbers of `rng` alone, a
        numpy.random.Generator, and returns a `Run`. That of a trial is the same under every arm: its key
        is NumPy's hash of seed and trial [docs/python.md].
    trials : int
        Runs of each arm; with `until` the most.
    seed : int
        From 0 to 2^64 - 1.
    arms : dict of dict
        The options of `run` under each arm, such as ``{"right": {}, "calm": {"q": 0.04}}``.
    executor : int or executor
        Where the trials run: by default in this process; in so many forked worker processes; or on an
        executor that has the ``submit`` of concurrent.futures, such as a ProcessPoolExecutor, ``get_executor()`` of a
        client of Dask, or mpi4py's MPIPoolExecutor. Such workers must be able to import `run`.
    batch : bool or int
        Whether `run` takes a list of generators, 256 or as many as are given here, and returns a `Run` of arrays with a
        leading dimension of runs. It always gets a whole batch, whose first trial is a multiple of its size.
    output : path
        The record, ``mine.h5``; with arms, a record of each in a group of its name. The trials are kept beside it, in
        ``mine.h5.trials``. Without it all files are temporary and go with the simulation.
    resume : bool
        Whether trials that are kept beside `output` are taken; what is missing of `trials` is run. Their record is
        replaced; no other file is.
    until : dict, str or list of str
        Stop as soon as means are known to these half-widths under every arm: ``{"nees_ratio": "1%"}``, a column of
        `Run`, or the difference of two arms, ``{"rmse[calm-right]": 0.01}``. Needs SciPy.
    timeout : float
        The time that a trial may take, a batch with `batch` (s).
    failed : float or str
        The verdict is ``failed`` where more than this share of the trials failed.
    progress : bool
        Whether a bar of tqdm is drawn; by default on a terminal and in a notebook.

    Returns
    -------
    Simulation

    Raises
    ------
    InputError
        A ValueError: an argument cannot be used, what trial 0 returned cannot be judged, or the first twenty trials of
        an arm have the same errors.
    Failure
        The first twenty trials of an arm all failed; or an executor broke that cannot be made again.
    Interrupted
        A KeyboardInterrupt: Ctrl-C was pressed. What was done is kept beside `output`.
    """
    if not callable(run):
        raise wrong("run", f"a {type(run).__name__} cannot be called", "Give a function of a generator")
    plan = _arms(arms)
    goals = _goals(until, plan)
    _refuse_bad_limit(failed)
    doors.needed("h5py", "h5py", "keep trials in a file of HDF5")
    if goals:
        doors.needed("scipy.stats", "scipy", "stop at a precision")
    if output is None and resume:
        raise InputError("cannot resume (there is no output). Name the output of the study that is resumed.")
    files = _Files(output, arms, resume)
    try:
        return _simulated(Work(run, plan, seed, int(batch), timeout), executor, trials, goals, failed, progress, files)
    except BaseException as error:
        if getattr(error, "study", None) is None:
            files.remove_temporary()
        if isinstance(error, KeyboardInterrupt) and not isinstance(error, Interrupted):
            kept = "" if output is None else f"; {files.trials} has the trials that were done"
            raise Interrupted(f"the simulation was stopped{kept}", None) from None
        raise


def _simulated(
    work: Work,
    executor: Any,
    ceiling: int,
    goals: list[Goal],
    failed: float | str,
    progress: bool | None,
    files: _Files,
) -> Simulation:
    """Run the trials, write the records, and return them; of an interrupted study those that are done."""

    def written(numbers: Array, lost: list[Failure]) -> Simulation:
        failures = write_records(file, files.record, files.arms, numbers, work.seed, lost)
        return Simulation(files, work, len(numbers), failures, failed, engine.is_repeatable)

    with (
        contextlib.closing(Trials(files.trials, work.seed, work.arms, work.batch)) as file,
        progress_bar(progress) as drawn,
    ):
        bar = _Bar(drawn, ceiling)
        metrics = {goal.metric for goal in goals} | ({"nees_ratio"} if bar.is_shown else set())
        work = replace(work, metrics=tuple(sorted(metrics)), ends_hung_process=isinstance(executor, int))
        engine = _Engine(work, file, ceiling, goals, bar)
        files.refuse_another_study(file.study)
        bar.show(len(file.done))
        if not goals and len(file.done) > ceiling:
            note(f"{files.trials} has {len(file.done)} trials; what is written has the first {ceiling}.")
        workers: Workers[Payload] = Workers(executor, run_chunk, work, is_frame)
        try:
            count = engine.run(workers)
        except KeyboardInterrupt:
            workers.close()
            done = np.array(sorted(one for one in file.done if one < ceiling), dtype=np.int64)
            said = f"the simulation was stopped with {len(done)} of {ceiling} trials done; {files.trials} has them"
            raise Interrupted(said, written(done, []) if len(done) else None) from None
        finally:
            workers.close()
        return written(np.arange(count), engine.lost)
