"""Verdicts on a filter from its errors and covariances."""

from __future__ import annotations

import functools
import inspect
import os
import re
from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Any, ParamSpec

from credence import InputError, _core
from credence import _doors as doors
from credence._calls import progress_bar
from credence._errors import invalid, wrong
from credence._names import truth_text
from credence._record import Record
from credence._results import Printed

Given = ParamSpec("Given")

NOT_REFUTED = ("consistent", "undecided")
REFUTED = ("optimistic", "pessimistic", "mixed")


def tune_hint(run: str = "run", free: str = "{...}", start: str = "") -> str:
    """The last line of what is said of a filter that is refuted: the call that says what to change."""
    return f"hint: what to change in it: credence.tune({run}, free={free}{', start={' + start + '}' if start else ''})"


class Verdict(Printed):
    """The verdict on a filter, with everything that it rests on.

    ``str(verdict)`` is the text that ``credence judge`` prints, and below it, if the filter is refuted by more than
    what was written of it, the call that says what to change; a notebook shows its page. ``verdict[name]`` is an entry
    of `json`, such as ``verdict["groups"]``.

    Attributes
    ----------
    verdict : str
        ``consistent``, ``optimistic``, ``pessimistic``, ``mixed``, ``undecided`` or ``failed``.
    json : list of dict
        What ``credence judge --format json`` prints, the same bits; it has one entry, that of the record.
    """

    def __init__(self, said: _core.Said | dict[str, str]) -> None:
        super().__init__(said)
        self.verdict: str = self["verdict"]

    def __getitem__(self, name: str) -> Any:
        return self.json[0][name]

    def __str__(self) -> str:
        return super().__str__() + (f"{tune_hint()}\n" if self.is_of_the_filter else "")

    def __repr__(self) -> str:
        return f"<credence.Verdict {self.verdict}>"

    @property
    def is_consistent(self) -> bool:
        """Whether the verdict is ``consistent``."""
        return self.verdict == "consistent"

    @property
    def is_of_the_filter(self) -> bool:
        """Whether the filter is refuted, and not by what was written of it, such as degrees beside rad."""
        return self.verdict in REFUTED and not self["mix_up"]

    @property
    def findings(self) -> list[Finding]:
        """What speaks against the filter."""
        return [Finding(**one) for one in self["findings"]]

    @property
    def turning_points(self) -> list[dict[str, Any]]:
        """For an optimistic verdict on a log, by unit: the standard deviation of the truth's errors from which on
        nothing is found too large in ``where`` (``vanishes``), and at which P would be ``right``."""
        return list(self.json[0].get("turning_points", []))

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


@dataclass(frozen=True)
class Finding:
    """What speaks against a filter.

    Attributes
    ----------
    what, about : str
        ``optimistic``, ``pessimistic`` or what else is wrong, and of what: ``size``, ``bias``, ``calibration``, ...
    where, when : str
        Of which group or component, and when; empty where it is all of them.
    measure : str
        What `value` is.
    value : float
    interval : list of float
        Both ends of that of `value`.
    text : str
        The sentence of the report.
    """

    what: str
    about: str
    where: str
    when: str
    measure: str
    value: float
    interval: list[float]
    text: str


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
        raise wrong(name, f"a {kind} is no array of errors", f"Take {remedies[kind]}")
    return doors.path(name, value) if isinstance(value, (str, os.PathLike)) else value


@dataclass(eq=False, repr=False, slots=True, kw_only=True)
class _Asked(Record):
    """The arguments of `judge`: a record, and what is asked of it."""

    runs: object = None
    margin: float | str = 0.05
    margin_direction: float | str | None = None
    bias: float = 0.1
    failed: float | str = 0.01
    segments: int | str = "auto"
    name: str = "record"
    progress: bool | None = None


def _takes(made: Callable[Given, _Asked]) -> Callable[[Callable[[_Asked], Verdict]], Callable[Given, Verdict]]:
    """Make the fields of a dataclass the arguments of a function, with their names, types and documentation."""

    def taking(function: Callable[[_Asked], Verdict]) -> Callable[Given, Verdict]:
        @functools.wraps(function)
        def entered(*arguments: Given.args, **named: Given.kwargs) -> Verdict:
            return function(made(*arguments, **named))

        entered.__signature__ = inspect.signature(made).replace(return_annotation="Verdict")  # type: ignore[attr-defined]
        made.__init__.__qualname__ = function.__name__  # as Python's own errors say it
        shown = (Record.__doc__ or "").partition("----------\n")[2].rstrip()
        entered.__doc__ = re.sub(r"    RECORD\n(?s:.+?)\n(?=    runs)", lambda _: f"{shown}\n", function.__doc__ or "")
        return entered

    return taking


@doors.door(
    error=_judged, covariance=_judged, group_covariance=doors.mapping('{"pose": P}'), name=doors.title,
    group_nees=doors.mapping('{"pose": nees}'), columns=doors.mapping('{"rmse": rmse}'), progress=doors.flag,
    **dict.fromkeys(
        ("margin", "margin_direction", "bias", "failed", "segments", "groups", "component_names", "component_units"),
        doors.plain,
    ),
)  # fmt: skip
@_takes(_Asked)
def judge(asked: _Asked) -> Verdict:
    """Say whether a filter's covariance can be believed, by its errors in many independent runs.

    Takes the fields of a `Record` as arguments, of which `error` and `covariance` are enough for most filters; or, in
    place of `error`, a Record or the path of one in a file [docs/judge.md], and then none of the other fields; a path
    may have `truth_sigma` and `truth_dependent` beside it.

    Parameters
    ----------
    RECORD
        The fields of `Record`.
    runs : array [row], or name of a column
        Which run each row is of, where runs lie below each other in flat tables: all arrays are then [row, ...], each
        run's steps in their order. A name is that of a column of the tables, or of a level of their index.
    margin, margin_direction : float or str
        NEES/n within 1 -+ `margin` is consistent, ``0.05`` or ``"5%"``; so is the squared error of every combination of
        the components, over what the covariance says, within 1 -+ `margin_direction` (twice the margin).
    bias : float
        A mean error of a component within this many of its sigmas is consistent.
    failed : float or str
        The verdict is ``failed`` where more than this share of the runs failed.
    segments : int or str
        Up to 200 runs are counted by segments, which take the place of runs: ``"auto"`` makes them ten times as
        long as errors take to decorrelate [docs/statistics.md, One log], a number says their steps, ``"off"``: none.
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
    options = {name: getattr(asked, name) for name in ("margin", "margin_direction", "bias", "failed", "segments")}
    of_truth = {"truth_sigma", "truth_dependent"} if isinstance(asked.error, (str, os.PathLike)) else set()
    data = asked.given().keys() & {"runs", *(field.name for field in fields(Record))} - of_truth
    if isinstance(asked.error, (str, os.PathLike, Record)) and data != {"error"}:
        raise TypeError("a Record, or one in a file, has its own arrays, groups and names. Give it alone.")
    if isinstance(asked.error, (str, os.PathLike)):
        if asked.truth_sigma is not None:
            options["truth_sigma"] = truth_text(asked.truth_sigma)
        options["truth_dependent"] = asked.truth_dependent
        with progress_bar(asked.progress) as bar:
            return Verdict(_core.judge_file(os.fsencode(asked.error), options, bar))
    from credence import _arrays

    record = asked.error if isinstance(asked.error, Record) else asked
    for names, other in ((("row_groups",), "innovation"), (("manifold", "chart", "quaternion"), "estimate")):
        for name in names:
            if getattr(record, name) is not None and getattr(record, other) is None:
                raise InputError(f"{name}: says nothing without {other}. Give both, or leave it out.")
    named = record.named()
    taken = {place: _arrays.described(array) for place, array in _arrays.prepared(record, asked.runs).items()}
    with progress_bar(asked.progress) as bar:
        return Verdict(_core.judge(taken, *named, options, os.fsencode(asked.name), bar))


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
    try:
        verdict = judge(*arguments, **named)
    except InputError as error:
        if within is None or error.subject != "margin":
            raise
        raise invalid("within", error.value, error.reason, error.remedy) from None
    if verdict.verdict not in NOT_REFUTED:
        raise AssertionError(f"the filter is not consistent\n\n{verdict}")
    if within is not None and not verdict.is_consistent:
        raise AssertionError(f"the filter is not shown to be consistent within {within}\n\n{verdict}")
    if strict and verdict["cautions"]:
        raise AssertionError(f"the report has notes\n\n{verdict}")
    return verdict
