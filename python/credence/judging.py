"""Verdicts on a filter from its errors and covariances."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from credence import InputError, _core
from credence import _doors as doors
from credence._calls import errors_of_arguments, framed, progress_bar, said_of_arrays

if TYPE_CHECKING:
    Groups = str | Mapping[str, int | Sequence[int]] | Sequence[str]


NOT_REFUTED = ("consistent", "undecided")
REFUTED = ("optimistic", "pessimistic", "mixed")


def tune_hint(run: str = "run", free: str = "{...}", start: str = "") -> str:
    """The last line of what is said of a filter that is refuted: the call that says what to change."""
    return f"hint: what to change in it: credence.tune({run}, free={free}{', start={' + start + '}' if start else ''})"


class _Printed(NamedTuple):
    """What a judgement says, without what it was computed from."""

    text: str
    json: str
    html: str


class Verdict:
    """The verdict on a filter, with everything that it rests on.

    ``str(verdict)`` is the text that ``credence judge`` prints, and below it, if the filter is refuted, the call that
    says what to change; a notebook shows its page. ``verdict[name]`` is an entry of `json`, such as
    ``verdict["groups"]``.

    Attributes
    ----------
    verdict : str
        ``consistent``, ``optimistic``, ``pessimistic``, ``mixed``, ``undecided`` or ``failed``.
    json : list of dict
        What ``credence judge --format json`` prints, the same bits; it has one entry, that of the record.
    """

    def __init__(self, judgement: _core.Judgement | _Printed) -> None:
        self._judgement = judgement
        self.json: list[dict[str, Any]] = json.loads(judgement.json)
        self.verdict: str = self["verdict"]

    def __reduce__(self) -> tuple[Any, ...]:
        return Verdict, (_Printed(self._judgement.text, self._judgement.json, self._judgement.html),)

    def __getitem__(self, name: str) -> Any:
        return self.json[0][name]

    def __str__(self) -> str:
        return self._judgement.text + (f"{tune_hint()}\n" if self.verdict in REFUTED else "")

    def __repr__(self) -> str:
        return f"<credence.Verdict {self.verdict}>"

    def _repr_html_(self) -> str:
        return framed(self.html)

    @property
    def html(self) -> str:
        """The page that ``credence judge --format html`` writes; it loads nothing and runs no script."""
        return self._judgement.html

    @property
    def is_consistent(self) -> bool:
        """Whether the verdict is ``consistent``."""
        return self.verdict == "consistent"

    @property
    def findings(self) -> list[dict[str, Any]]:
        """What speaks against the filter, each with what it is ``about``, ``where``, ``value`` and ``interval``."""
        return list(self["findings"])

    @property
    def reached(self) -> dict[str, float | None]:
        """The smallest margins that the runs show at 95 %, whatever was asked for: ``nees`` and ``direction`` as
        shares of 1, ``bias`` in sigmas; None where nothing is shown."""
        return dict(self["reached"])

    @property
    def log_score(self) -> dict[str, Any]:
        """The negative log-likelihood of the truth under the belief in nats a step, lower is better: ``mean``, ``se``,
        ``ci95``, ``median``, ``sd`` over the runs, each the mean over its steps. A proper score [Gneiting and Raftery
        2007]."""
        return dict(self["log_score"])


def _refuse_what_is_not_used(given: Mapping[str, object]) -> None:
    """Refuse what says nothing without another argument, so that it is not ignored."""
    for names, other in ((("row_groups",), "innovation"), (("manifold", "chart", "quaternion"), "estimate")):
        for name in names:
            if name in given and other not in given:
                raise InputError(f"{name}: says nothing without {other}. Give both, or leave it out.")


def _judged(name: str, value: Any) -> Any:
    """Refuse what has verdicts of its own."""
    remedies = {
        "Study": "credence.report(study)",
        "Simulation": "its verdicts",
        "SimulatedArm": "its verdict",
        "Verdict": "it as it is",
        "Run": "credence.simulate, which runs a function many times",
    }
    kind = type(value).__name__
    if kind in remedies and type(value).__module__.startswith("credence."):
        raise InputError(f"invalid {name} (a {kind} is no array of errors). Take {remedies[kind]}.")
    return doors.path(name, value) if isinstance(value, (str, os.PathLike)) else value


@doors.door(
    error=_judged, covariance=_judged, group_covariance=doors.mapping('{"pose": P}'), name=doors.title,
    group_nees=doors.mapping('{"pose": nees}'), columns=doors.mapping('{"rmse": rmse}'), progress=doors.flag,
    **dict.fromkeys(
        ("margin", "margin_direction", "bias", "failed", "segments", "groups", "component_names", "component_units"),
        doors.plain,
    ),
)  # fmt: skip
def judge(
    error: object = None,
    covariance: object = None,
    *,
    innovation: object = None,
    innovation_covariance: object = None,
    groups: Groups | None = None,
    row_groups: Groups | None = None,
    margin: float | str = 0.05,
    margin_direction: float | str | None = None,
    bias: float = 0.1,
    failed: float | str = 0.01,
    segments: int | str = "auto",
    component_names: str | Sequence[str] | None = None,
    component_units: str | Sequence[str] | None = None,
    steps: object = None,
    time: object = None,
    runs: object = None,
    truth: object = None,
    estimate: object = None,
    manifold: str | None = None,
    chart: str | None = None,
    quaternion: str | None = None,
    group_covariance: Mapping[str, object] | None = None,
    nees: object = None,
    group_nees: Mapping[str, object] | None = None,
    dimension: int | Mapping[str, int] | None = None,
    columns: Mapping[str, object] | None = None,
    name: str = "record",
    progress: bool | None = None,
) -> Verdict:
    """Say whether a filter's covariance can be believed, by its errors in many independent runs.

    `error` and `covariance` are enough for most filters; the other forms are those of a record [docs/judge.md]. Arrays
    are anything that NumPy takes (xarray, pandas, lists); docs/theory/python.md says what becomes of masks, units and
    dimensions. Doubles and singles of any strides are read in place, a part at a time; other types are converted first.
    A single run may leave out the first dimension, and a list may hold runs of different lengths.

    Parameters
    ----------
    error : array [trial, step, n], or path
        Estimate - truth, in the chart of the covariance; NaN where a component is not in the state. Or the path of a
        record in a file, and then none of the other arrays.
    covariance : array [trial, step, n, n] or [trial, step, n]
        Joint covariances, or variances alone, in the square of the units of `error`.
    innovation, innovation_covariance : arrays [trial, step, m] and [trial, step, m, m]
        Both or neither; NaN in rows that were not observed.
    groups : dict, str or list of str
        Parts of the state that are judged by themselves: ``{"pose": [0, 1, 2]}`` or ``"pose 0:3"``.
    row_groups : dict, str or list of str
        The same of the rows of the innovation.
    margin, margin_direction : float or str
        NEES/n within 1 -+ `margin` is consistent, ``0.05`` or ``"5%"``; so is the squared error of every combination of
        the components, over what the covariance says, within 1 -+ `margin_direction` (twice the margin).
    bias : float
        A mean error of a component within this many of its sigmas is consistent.
    failed : float or str
        The verdict is ``failed`` where more than this share of the runs failed.
    segments : int or str
        Fewer than 20 runs are counted by segments, which take the place of runs: ``"auto"`` makes them ten times as
        long as errors take to decorrelate [docs/statistics.md, One log], a number says their steps, ``"off"``: none.
    component_names, component_units : list of str
        One for each component.
    steps : array [trial]
        How many steps each run has, where they differ.
    time : array [step] or [trial, step]
        Times of the steps (s), which must increase.
    runs : array [row], or name of a column
        Which run each row is of, where runs lie below each other in flat tables: all arrays are then [row, ...], each
        run's steps in their order. A name is that of a column of the tables, or of a level of their index.
    truth, estimate : arrays [trial, step, q]
        In place of `error`: states on a `manifold`, such as ``"SE3 x R6"``, whose error is taken in the `chart`
        ``"local"`` or ``"global"``; `quaternion` is ``"wxyz"`` or ``"xyzw"``.
    group_covariance : dict of arrays [trial, step, d, d]
        Covariances of groups, by their names.
    nees, group_nees : array [trial, step], dict of such arrays
        The NEES of the whole state, or of groups, and nothing else.
    dimension : int, or dict of int
        The dimension of `nees`; or of the group of each name, ``"all"`` for the whole state.
    columns : dict of arrays [trial]
        Further numbers of each run, such as ``{"rmse": rmse}``, which are reported beside those of every record.
    name : str
        What the report calls the record.
    progress : bool
        Whether a bar of tqdm is drawn; by default on a terminal and in a notebook.

    Returns
    -------
    Verdict

    Raises
    ------
    InputError
        A ValueError: arrays do not fit each other, a covariance is not symmetric, an option is out of its range.
    """
    options = {
        "margin": margin,
        "bias": bias,
        "failed": failed,
        "margin-direction": margin_direction,
        "segments": segments,
    }
    given_options = {key: str(value) for key, value in options.items() if value is not None}
    own = {"covariance": group_covariance or {}, "nees": group_nees or {}}
    arrays = {
        "error": error,
        "covariance": covariance,
        "innovation": innovation,
        "innovation_covariance": innovation_covariance,
        "steps": steps,
        "time": time,
        "truth": truth,
        "estimate": estimate,
        "nees": nees,
        **{f"group/{group}/{what}": array for what, each in own.items() for group, array in each.items()},
    }
    texts = {
        "groups": groups,
        "row_groups": row_groups,
        "component_names": component_names,
        "component_units": component_units,
        "manifold": manifold,
        "chart": chart,
        "quaternion": quaternion,
    }
    given_arrays = {path: array for path, array in arrays.items() if array is not None}
    given_texts = {key: text for key, text in texts.items() if text is not None}
    if isinstance(error, (str, os.PathLike)):
        if len(given_arrays) > 1 or given_texts or columns or runs is not None:
            raise TypeError("a record in a file has its own arrays, groups and names. Give the path alone.")
        with errors_of_arguments(), progress_bar(progress) as bar:
            return Verdict(_core.judge_file(os.fsencode(error), given_options, bar))
    from credence import _arrays, _names

    _refuse_what_is_not_used({**given_arrays, **given_texts})
    plain, lists = _names.texts_and_lists(given_texts)
    dimensions = _names.dimensions(dimension, groups, nees is not None, own["nees"])
    arrays_and_columns = _arrays.prepared(given_arrays, runs) | _arrays.columns(columns or {})
    taken = {path: _arrays.described(array) for path, array in arrays_and_columns.items()}
    with errors_of_arguments(said_of_arrays), progress_bar(progress) as bar:
        return Verdict(_core.judge(taken, plain, lists, dimensions, given_options, os.fsencode(name), bar))


@doors.door(strict=doors.flag)
def assert_consistent(
    *arguments: Any, within: float | str | None = None, strict: bool = False, **named: Any
) -> Verdict:
    """Raise AssertionError with the text of the report if the filter is refuted; else return the verdict, whose
    `reached` says what was shown.

    It takes the arguments of `judge`.

    Parameters
    ----------
    within : float or str
        The margin within which the filter must be shown to be ``consistent``, which takes some hundreds of runs. By
        default ``undecided`` passes: fifty runs that speak against nothing are no proof.
    strict : bool
        Notes of the report, such as innovations that are correlated, count as findings.
    """
    __tracebackhide__ = True  # pytest then shows the line that asserts
    if within is not None:
        named["margin"] = within
    with errors_of_arguments(lambda said: said if within is None else said.replace("margin=", "within=", 1)):
        verdict = judge(*arguments, **named)
    if verdict.verdict not in NOT_REFUTED:
        raise AssertionError(f"the filter is not consistent\n\n{verdict}")
    if within is not None and not verdict.is_consistent:
        raise AssertionError(f"the filter is not shown to be consistent within {within}\n\n{verdict}")
    if strict and verdict["cautions"]:
        raise AssertionError(f"the report has notes\n\n{verdict}")
    return verdict
