"""Planners that are functions of Python [docs/planner.md]: what they are told, and what becomes of their answers."""

from __future__ import annotations

import hashlib
import inspect
import re
import traceback
from collections.abc import Callable, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from credence._calls import note
from credence._errors import invalid

if TYPE_CHECKING:
    from credence._core import Told

Floats = npt.NDArray[np.float64]
ALL = slice(None)


class Prospects(NamedTuple):
    """What would follow from each candidate, [B, C], by the filter's own prediction and update.

    trace : of W P after the update, W of ``planner.criterion`` and ``planner.heading_weight``
    log_det : of P after the update
    new_cells : cells that would come into view for the first time
    allowed : bool, whether no wall ends the motion
    """

    trace: Floats
    log_det: Floats
    new_cells: npt.NDArray[np.int64]
    allowed: npt.NDArray[np.bool_]


class Draws:
    """Numbers that depend on seed, trial and step alone, so that a study repeats itself and arms share them."""

    def __init__(self, told: Told, places: slice) -> None:
        self._told, self._places = told, places

    def random(self, count: int = 1) -> Floats:
        """Numbers in [0, 1), [B, count]; the same ones in each call of a step."""
        return self._told.uniform(count)[self._places]


class Now:
    """What a planner is told of B trials before their robots move to pose `step`; arrays are copies of its own.

    n components, M features, C candidates. Lengths are those of the scenario, angles in rad; components are ordered
    heading (not in the translation model), x, y, then x and y of each feature. What is not in the state yet is NaN.

    Attributes
    ----------
    step : int
        The pose that the control leads to, from 1 on.
    trial : ndarray [B]
        The numbers of the trials.
    mean, covariance : ndarray [B, n], [B, n, n]
        What the filter believes.
    known : ndarray of bool [B, M]
        Whether the feature is in the state.
    cells : ndarray of bool [B, rows, columns]
        Whether the cell of the grid has been in view; rows from below; [B, 0, 0] in a world without a grid.
    candidates : ndarray [C, 3]
        The controls that the built-in planners choose from: turn, and the move in x and y of the robot's frame (of the
        world's, in the translation model).
    reach : float
        Length of the longest candidate: no control may move farther.
    rng : Draws
    """

    def __init__(self, told: Told, places: slice = ALL) -> None:
        self._told, self._places = told, places
        self.step: int = told.step
        self.reach: float = told.reach
        self.rng = Draws(told, places)

    @cached_property
    def trial(self) -> npt.NDArray[np.int64]:
        return self._told.trial()[self._places]

    @cached_property
    def mean(self) -> Floats:
        return self._told.mean()[self._places]

    @cached_property
    def covariance(self) -> Floats:
        return self._told.covariance()[self._places]

    @cached_property
    def known(self) -> npt.NDArray[np.bool_]:
        return self._told.known()[self._places].astype(bool)

    @cached_property
    def cells(self) -> npt.NDArray[np.bool_]:
        return self._told.cells()[self._places].astype(bool)

    @cached_property
    def candidates(self) -> Floats:
        return self._told.candidates()

    @cached_property
    def prospects(self) -> Prospects:
        trace, log_det, cells, allowed = (one[self._places] for one in self._told.prospects())
        return Prospects(trace, log_det, cells.astype(np.int64), allowed.astype(bool))


class _Mistake(Exception):
    """The answer is of no use for any trial."""


class Asked:
    """A planner as the library calls it. What goes wrong in single trials is kept in `failures`, by trial."""

    def __init__(self, name: str, choose: Callable[[Now], Any]) -> None:
        self.name, self.choose = name, choose
        self.failures: dict[int, str] = {}

    def __call__(self, told: Told) -> Floats | str:
        """The controls [B, 3], NaN for trials that have failed; or what ends the study."""
        try:
            return self._controls(told)
        except _Mistake as mistake:
            return f"planner {self.name}: {mistake}"

    def _controls(self, told: Told) -> Floats:
        now = Now(told)
        try:
            return self._checked(now)
        except _Mistake:
            raise
        except Exception:
            trials, lines = now.trial, traceback.format_exc()
        controls = np.full((len(trials), 3), np.nan)
        failed = 0
        for place, trial in enumerate(trials):  # one of them may be to blame
            try:
                controls[place] = self._checked(Now(told, slice(place, place + 1)))[0]
            except _Mistake:
                raise
            except Exception:
                failed += 1
                self.failures.setdefault(int(trial), f"step {now.step}:\n{traceback.format_exc()}")
        if failed == len(trials) > 1:
            raise _Mistake(f"it fails in all of {failed} trials at step {now.step}.\n{lines.rstrip()}")
        return controls

    def _checked(self, now: Now) -> Floats:
        count, candidates = len(now.trial), now.candidates
        answer = np.asarray(self.choose(now))
        is_index = answer.shape == (count,) and answer.dtype.kind in "iu"
        if not is_index and (answer.shape != (count, 3) or answer.dtype.kind not in "iuf"):
            raise _Mistake(
                f"it returns {answer.dtype} of the shape {answer.shape} for {count} trials. Return the places of "
                f"candidates, whole numbers [{count}], or controls [{count}, 3]: turn, x, y."
            )
        if is_index:
            wrong_ones = (answer < 0) | (answer >= len(candidates))
            controls = np.array(candidates[np.where(wrong_ones, 0, answer)])
            what = f"is no place of {len(candidates)} candidates"
        else:
            controls = np.array(answer, dtype=float)
            far = ~(np.hypot(controls[:, 1], controls[:, 2]) <= now.reach * (1 + 1e-9))
            wrong_ones = far | ~np.isfinite(controls).all(axis=1)
            what = f"is not finite, or moves farther than the longest candidate, {now.reach:g}"
        for place in np.flatnonzero(wrong_ones):
            self.failures.setdefault(int(now.trial[place]), f"step {now.step}: {answer[place]} {what}")
        controls[wrong_ones] = np.nan
        return controls


def version_of(choose: Callable[..., object]) -> str:
    """A digest of a function's source, or of that of a callable's class, and of the numbers and texts that it holds."""
    of = choose if inspect.isroutine(choose) else type(choose)
    try:
        source = inspect.getsource(of)
    except (OSError, TypeError):  # such as in a console
        source = repr(getattr(getattr(of, "__code__", None), "co_code", of))
    held = {**getattr(choose, "__dict__", {}), **(getattr(choose, "__kwdefaults__", None) or {})}
    if inspect.isfunction(choose):
        held |= inspect.getclosurevars(choose).nonlocals
        held |= dict(enumerate(choose.__defaults__ or ()))
    plain = {name: value for name, value in held.items() if isinstance(value, (int, float, str))}
    return hashlib.sha256(f"{source}{plain}".encode()).hexdigest()[:12]


def asked(planners: Mapping[str, Callable[[Now], Any]] | None) -> dict[str, tuple[str, Asked]]:
    """Planners as the library takes them: by name their version and what it calls."""
    if planners is None:
        return {}
    if not isinstance(planners, Mapping):
        raise invalid("planners", planners, "it is no dict", 'Give {"mine": function}')
    for name, choose in planners.items():
        if not isinstance(name, str) or not re.fullmatch(r"[A-Za-z0-9_-]{1,100}", name):
            raise invalid("planners", name, "only letters, digits, _ and - are allowed", "Give another name")
        if not callable(choose):
            raise invalid("planners", choose, "it cannot be called", "Give a function of what is known now")
    return {name: (version_of(choose), Asked(name, choose)) for name, choose in planners.items()}


def setting_of(planners: Mapping[str, tuple[str, Asked]]) -> dict[str, str]:
    """The key that gives a scenario its arms."""
    return {"arms.planners": ", ".join(f"{name}:{version}" for name, (version, _) in planners.items())}


def note_failures(planners: Mapping[str, tuple[str, Asked]]) -> None:
    for name, (_, one) in planners.items():
        if one.failures:
            first = min(one.failures)
            count = len(one.failures)
            note(f"planner {name} failed in {count} trials; the first is trial {first}, at {one.failures[first]}")
