"""Where the scores of a tune come from: trials of a function, trials of a scenario, or the segments of one log.

Each source gives one score a trial as a function of the parameters, always on the same random numbers.
"""

from __future__ import annotations

import json
import os
import subprocess
import tempfile
import time
import weakref
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, Protocol

import numpy as np

from credence import Failure, InputError
from credence._errors import invalid
from credence._record import Run
from credence._scores import judged_score, run_score, step_scores
from credence._trials import Array, KnownNames, Work, collected, take
from credence._workers import Workers
from credence.judging import Verdict, judge

Values = Mapping[str, float]
CHUNK_SECONDS = 0.1
FEW_SEGMENTS = 20
COLUMNS = {"errors": "log_score", "nees": "nees_ratio"}  # of a study


class Source(Protocol):
    """What is tuned."""

    objective: str
    trouble: str  # why the first trial without a result has none; empty if there was none
    progress: bool | None  # whether a bar is drawn of what is judged
    has_truth: bool  # whether what is judged are errors, not innovations

    def scores(self, values: Values, count: int) -> Array:
        """The score of each of the first `count` trials [count], NaN of those without a result."""

    def judged(self, values: Values, count: int) -> tuple[Verdict, float]:
        """The verdict and the score on what was not tuned on; Failure where there is no result."""

    def close(self) -> None:
        """End what was started; scores start it again."""


def score_chunk(shared: tuple[Work, str], values: Values, numbers: list[int]) -> tuple[float, dict[int, float], str]:
    """Run trials with these parameters; their seconds, {trial: score}, and why the first one failed."""
    work, objective = shared
    begun, scores = time.perf_counter(), {}
    chunk = collected(replace(work, arms={"tuned": dict(values)}), numbers, numbers)
    seconds = time.perf_counter() - begun
    for segment in chunk.segments:
        for i, trial in enumerate(segment["trials"]):
            arrays = {name: array[i] for name, array in segment["arrays"].items()}
            scores[trial] = run_score(objective, arrays, segment["texts"])
    first = chunk.failures[0] if chunk.failures else None
    return seconds, scores, f"trial {first.trial}: {first.reason}\n{first.traceback}".strip() if first else ""


def held_out_seed(seed: int) -> int:
    """The seed of the trials on which what was tuned is judged."""
    return (seed + 1) % 2**64


class FunctionSource:
    """Trials of a function, those of `simulate`."""

    def __init__(self, work: Work, objective: str, executor: Any) -> None:
        self.work, self.objective, self.executor, self.trouble = work, objective, executor, ""
        self.progress: bool | None = False
        self.has_truth = True
        self._workers: Workers[list[int]] | None = None
        self._seconds = 0.0  # of one trial; 0 before any is done

    def scores(self, values: Values, count: int) -> Array:
        if self._workers is None:
            self._workers = Workers(self.executor, score_chunk, (self.work, self.objective))
        size = self.work.batch or self._chunk_size(count, self._workers.count)
        whole = -(-count // size) * size if self.work.batch else count
        left = [list(range(first, min(first + size, whole))) for first in range(0, whole, size)]
        left.reverse()
        found = np.full(count, np.nan)
        results = self._workers.results(
            lambda: left.pop() if left else None, lambda numbers: (values, numbers), self._parts
        )
        is_first = self._seconds == 0
        for numbers, result in results:
            seconds, scores, trouble = result or (0.0, {}, "a worker was lost")
            self._seconds = max(seconds / len(numbers), 1e-7)
            self.trouble = self.trouble or trouble
            for trial, score in scores.items():
                if trial < count:
                    found[trial] = score
        if is_first and count > 1 and np.ptp(found) == 0:  # not NaN
            said = f"the first {count} trials have the same score, to the last bit: the function does not use rng"
            raise InputError(f"{said}. Draw every random number from rng.")
        return found

    def _parts(self, numbers: list[int]) -> list[list[int]]:
        return [numbers] if self.work.batch else [[one] for one in numbers]

    def _chunk_size(self, count: int, workers: int) -> int:
        """Whole trials whose bits do not depend on it: a tenth of a second, and enough chunks for all workers."""
        if self._seconds == 0:
            return 1 if workers == 1 else max(1, count // (4 * workers))
        return max(1, min(int(CHUNK_SECONDS / self._seconds), count if workers == 1 else count // (2 * workers)))

    def judged(self, values: Values, count: int) -> tuple[Verdict, float]:
        from credence.simulating import simulate

        study = simulate(
            self.work.run, trials=count, seed=held_out_seed(self.work.seed), arms={"tuned": dict(values)},
            executor=self.executor, batch=self.work.batch or False, progress=self.progress,
        )  # fmt: skip
        verdict = study.arm("tuned").verdict
        if self.objective != "innovations":
            return verdict, judged_score(self.objective, verdict)
        record = study.arm("tuned").record()
        parts = (record[name] for name in ("innovation", "innovation_covariance"))
        each = [run_score("innovations", {"innovation": nu, "innovation_covariance": S}, {}) for nu, S in zip(*parts)]
        return verdict, float(np.nanmean(each))

    def close(self) -> None:
        if self._workers is not None:
            self._workers.close()
        self._workers = None


class ScenarioSource:
    """Trials of a scenario's world: the column log_score of one of its arms."""

    def __init__(
        self, scenario: Any, objective: str, seed: int, executor: Any, arm: str | None, program: str | None
    ) -> None:
        if objective not in COLUMNS:
            why = "a study has no likelihood of its innovations"
            raise invalid("objective", objective, why, "Take errors, or nees")
        if program is not None and executor is not None:
            raise InputError("cannot run a program of your own on an executor (it has threads). Leave executor out.")
        self.scenario, self.objective, self.seed, self.trouble = scenario, objective, seed, ""
        self.progress: bool | None = False
        self.executor, self.arm, self.own_program, self.has_truth = executor, arm, program, True

    def shown(self, values: Values) -> dict[str, str]:
        """{key: its text} of the scenario as resolved; InputError where a value is refused."""
        from credence.arm import settings_in
        from credence.program import show

        text = show(self.scenario, set=values) if self.own_program is None else self._own("show", [], values)
        return settings_in(text)

    def _own(self, command: str, words: list[str], values: Values) -> str:
        from credence.program import scenario_files, settings_of

        assert self.own_program is not None
        with scenario_files(self.scenario) as paths:
            told = [self.own_program, command, *paths, *words, *(f"--set={one}" for one in settings_of(values)["set"])]
            try:
                done = subprocess.run(told, capture_output=True, text=True, check=False)
            except OSError as error:
                raise InputError(f"{self.own_program}: cannot be run ({error}). Name a program.") from None
        if done.returncode != 0:
            kind = InputError if done.returncode == 2 else Failure
            raise kind(" ".join(done.stderr.split()).removeprefix("credence ") or f"exit code {done.returncode}")
        return done.stdout

    def _study(self, values: Values, count: int, seed: int, progress: bool | None = False) -> Any:
        """A study that was run, which goes with its object."""
        from credence.program import run
        from credence.study import open as open_study

        if self.own_program is None:
            return run(self.scenario, trials=count, seed=seed, set=values, executor=self.executor, progress=progress)
        folder = tempfile.TemporaryDirectory(prefix="credence-")
        path = os.path.join(folder.name, "study.h5")
        self._own("run", [f"--trials={count}", f"--seed={seed}", f"--output={path}", "--quiet"], values)
        study = open_study(path)
        weakref.finalize(study, folder.cleanup)
        return study

    def _arm_of(self, study: Any) -> Any:
        arms = {arm.name: arm for arm in study.arms}
        if len(study.scenarios) != 1 or (self.arm is not None and self.arm not in arms):
            why = f"there are {', '.join(arms)}"
            raise invalid("arm", self.arm, why, "Name one of a scenario")
        self.arm = self.arm or next(iter(arms))
        return arms[self.arm]

    def scores(self, values: Values, count: int) -> Array:
        try:
            study = self._study(values, count, self.seed)
        except (InputError, Failure) as error:
            self.trouble = self.trouble or str(error)
            return np.full(count, np.nan)
        scores = np.asarray(self._arm_of(study)[COLUMNS[self.objective]], dtype=float)
        study.close()
        return scores

    def judged(self, values: Values, count: int) -> tuple[Verdict, float]:
        from credence.program import report

        study = self._study(values, count, held_out_seed(self.seed), self.progress)
        said = report(study)
        entry = [one for one in said.json if one["arm"] == self.arm]
        verdict = Verdict({"text": str(said), "json": json.dumps(entry), "html": said.html})
        return verdict, judged_score(self.objective, verdict)

    def close(self) -> None:
        """Nothing is kept running."""


class LogSource:
    """One log: a function of the parameters on fixed data, whose first steps are tuned on in segments that are trials.

    Attributes
    ----------
    first : int
        Steps that are tuned on; all others are held out.
    segments : int
    """

    def __init__(self, run: Callable[..., Any], objective: str, start: Values, held_out: int | None) -> None:
        self.run, self.objective, self.trouble = run, objective, ""
        self.progress: bool | None = False
        arrays, texts = self._arrays(start)
        steps = len(step_scores(objective, arrays))
        self.has_truth = bool({"error", "estimate"} & arrays.keys())
        self.first = steps // 2 if held_out is None else steps - held_out
        if self.first < 2:
            raise invalid("held_out", held_out, f"the log has {steps} steps", "Leave some to tune on")
        self.rest = slice(self.first % steps, None)  # where nothing is held out, all of it
        said = self._judged(arrays, texts, slice(None))
        each = (said.json[0].get("segments") or {}).get("steps") or self.first // FEW_SEGMENTS
        self.segments = max(2, self.first // max(1, int(each)))

    def _arrays(self, values: Values) -> tuple[dict[str, Array], dict[str, Any]]:
        try:
            run = self.run(**values)
        except InputError:
            raise
        except Exception as error:
            told = ", ".join(f"{name}={value:g}" for name, value in values.items())
            said = f"the function failed with {told} ({type(error).__name__}: {error})"
            raise Failure(f"{said}. Mend it, or give another start.") from error
        if not isinstance(run, Run):
            raise InputError(f"the function returned {type(run).__name__}, not a credence.Run. Return one.")
        return take(run, KnownNames()).arrays, run.texts

    def _judged(self, arrays: Mapping[str, Array], texts: Mapping[str, Any], steps: slice) -> Verdict:
        """The verdict on steps of the log; on its innovations, as if they were errors, where it has no errors."""
        part: dict[str, Any] = {
            name: array[steps][None] for name, array in arrays.items() if np.ndim(array) > 0 and "/" not in name
        }
        if not self.has_truth:
            return judge(part["innovation"], part["innovation_covariance"], progress=False)
        return judge(**part, **texts, progress=False)

    def _step_scores(self, values: Values) -> Array:
        return step_scores(self.objective, self._arrays(values)[0])

    def scores(self, values: Values, count: int) -> Array:
        try:
            each = self._step_scores(values)[: self.first]
        except InputError:
            raise
        except Exception as error:
            self.trouble = self.trouble or str(error)
            return np.full(self.segments, np.nan)
        there = ~np.isnan(each)
        if not there.any() or not np.isfinite(each[there]).all():
            return np.full(self.segments, np.nan)
        sums = [np.nansum(part) for part in np.array_split(each, self.segments)]
        scores: Array = np.array(sums) * self.segments / there.sum()
        return scores

    def judged(self, values: Values, count: int) -> tuple[Verdict, float]:
        arrays, texts = self._arrays(values)
        each = step_scores(self.objective, arrays)[self.rest]
        return self._judged(arrays, texts, self.rest), float(np.nanmean(each))

    def close(self) -> None:
        """Nothing is kept running."""
