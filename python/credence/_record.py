"""What is judged: a record, which `judge` takes of many runs and `simulate` of one [docs/judge.md, The record]."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import KW_ONLY, dataclass, fields
from typing import Any

from credence._errors import InputError
from credence._names import Named, dimensions, texts_and_lists

Groups = str | Mapping[str, int | Sequence[int]] | Sequence[str]

_arrays = (
    "error", "covariance", "innovation", "innovation_covariance", "truth", "estimate", "nees", "time",
    "truth_covariance",
)  # fmt: skip
_texts = (
    "groups", "row_groups", "component_names", "component_units", "manifold", "chart", "quaternion", "truth_sigma",
    "truth_dependent", "dimension",
)  # fmt: skip


@dataclass(eq=False, repr=False, slots=True)
class Record:
    """Errors and covariances of a filter in many independent runs.

    `error` and `covariance` are enough for most filters. Arrays are anything that NumPy takes (xarray, pandas, lists);
    python/tests/odd_inputs.csv says what becomes of masks, units and names. Doubles and singles of any strides
    are read in place, a part at a time; other types are converted first. A single run may leave out the first
    dimension, and a list may hold runs of different lengths.

    Parameters
    ----------
    error : array [trial, step, n]
        Estimate - truth, in the chart of the covariance; NaN where a component is not in the state.
    covariance : array [trial, step, n, n] or [trial, step, n]
        Joint covariances, or variances alone, in the square of the units of `error`; [step, n, n] is that of every
        run, and [n, n] that of every step.
    innovation, innovation_covariance : arrays [trial, step, m] and [trial, step, m, m]
        Both or neither; NaN in rows that were not observed.
    groups : dict, str or list of str
        Parts of the state that are judged by themselves: ``{"pose": [0, 1, 2]}`` or ``"pose 0:3"``.
    row_groups : dict, str or list of str
        The same of the rows of the innovation.
    component_names, component_units : list of str
        One for each component.
    steps : array [trial]
        How many steps each run has, where they differ.
    time : array [step] or [trial, step]
        Times of the steps (s), which must increase.
    truth, estimate : arrays [trial, step, q]
        In place of `error`: states on a `manifold`, such as ``"SE3 x R6"``, whose error is taken in the `chart`
        ``"local"`` or ``"global"``; `quaternion` is ``"wxyz"`` or ``"xyzw"``.
    truth_covariance : array [n], [n, n], [step, n, n] or [trial, step, n, n]
        Of the truth's own errors, in the chart and units of `error`: variances, or matrices that are the same at all
        steps, in all runs, or of each; an upper bound [docs/statistics.md, Uncertain truth].
    truth_sigma : float, str or dict
        In its place, their standard deviation: ``0.005`` for every component in its unit, or of groups and
        components, ``{"position": 0.005, "heading": "0.1deg"}``; the others are exact.
    truth_dependent : bool
        Whether the truth was made of data that the filter used, as by a smoother.
    group_covariance : dict of arrays [trial, step, d, d]
        Covariances of groups, by their names.
    nees, group_nees : array [trial, step], dict of such arrays
        The NEES of the whole state, or of groups, and nothing else.
    dimension : int, or dict of int
        The dimension of `nees`; or of the group of each name, ``"all"`` for the whole state.
    columns : dict of arrays [trial]
        Further numbers of each run, such as ``{"rmse": rmse}``, which are reported beside those of every record.
    """

    error: object = None
    covariance: object = None
    _: KW_ONLY
    innovation: object = None
    innovation_covariance: object = None
    groups: Groups | None = None
    row_groups: Groups | None = None
    component_names: str | Sequence[str] | None = None
    component_units: str | Sequence[str] | None = None
    steps: object = None
    time: object = None
    truth: object = None
    estimate: object = None
    truth_covariance: object = None
    truth_sigma: float | str | Mapping[str, float | str] | None = None
    truth_dependent: bool | None = None
    manifold: str | None = None
    chart: str | None = None
    quaternion: str | None = None
    group_covariance: Mapping[str, object] | None = None
    nees: object = None
    group_nees: Mapping[str, object] | None = None
    dimension: int | Mapping[str, int] | None = None
    columns: Mapping[str, object] | None = None

    def given(self) -> dict[str, Any]:
        """{field: its value} of those that are not None."""
        return {one.name: value for one in fields(self) if (value := getattr(self, one.name)) is not None}

    @property
    def arrays(self) -> dict[str, Any]:
        """{place in a record's file: array}, without `steps` and `columns`."""
        found = {name: getattr(self, name) for name in _arrays}
        for what, groups in (("covariance", self.group_covariance), ("nees", self.group_nees)):
            found |= {f"group/{name}/{what}": array for name, array in (groups or {}).items()}
        return {name: array for name, array in found.items() if array is not None}

    @property
    def texts(self) -> dict[str, Any]:
        """Names, groups and `dimension`, those that are given."""
        return {name: value for name in _texts if (value := getattr(self, name)) is not None}

    def named(self) -> Named:
        """The same as a record's file has them; InputError where one cannot be told."""
        texts = {name: value for name, value in self.texts.items() if name != "dimension"}
        sizes = dimensions(self.dimension, self.groups, self.nees is not None, self.group_nees or {})
        return Named(*texts_and_lists(texts), sizes)

    def __repr__(self) -> str:
        return f"<credence.{type(self).__name__} of {', '.join(self.given())}>"


class Run(Record):
    """One run of a filter, as `simulate` takes it from the function that makes it.

    It has the fields of `Record` without the dimension of trials: `error` [step, n], `covariance` [step, n, n] or
    [step, n], and so on; `columns` are numbers, such as ``{"rmse": 0.2}``, and so is `steps`, where runs end at
    different steps for a reason of their own. A run that has another number of steps than the first one and does not
    say so has failed. Groups, names and dimensions are the same in every run. With ``batch=True`` all arrays, `steps`
    and `columns` have a leading dimension, that of the generators that were given.
    """

    __slots__ = ()

    @classmethod
    def of_record(cls, arguments: Mapping[str, Any]) -> Run:
        """The only run of a record: of arguments of `judge` with one trial, as `credence.adapters` makes them."""

        def one(name: str, value: Any) -> Any:
            if isinstance(value, Mapping) and name in ("group_covariance", "group_nees"):
                return {group: one("", array) for group, array in value.items()}
            if getattr(value, "ndim", 0) == 0 or (name == "time" and value.ndim == 1):
                return value
            if len(value) != 1:
                raise InputError(f"{name}: has {len(value)} trials. Give one, as a Run is one.")
            return value[0]

        return cls(**{name: one(name, value) for name, value in arguments.items() if name != "steps"})
