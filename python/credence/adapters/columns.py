"""Arguments of :func:`credence.judge` from tables: CSV files, and frames of pandas."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from credence._arrays import runs_of
from credence._errors import InputError, argument, wrong
from credence.adapters.components import Components, interpolated, largest_of
from credence.adapters.declared import declared, kinds_of, looks_like_innovation, record_names
from credence.adapters.missing import Rows, held, not_known, say_left_out, variances_of, without
from credence.adapters.named_columns import NamedColumns
from credence.adapters.pose_columns import NEEDS_TIME, has_poses, table_of_poses
from credence.adapters.poses import say_independent
from credence.adapters.tables import Array, neighbours, note, say_matched, units_given

Names = str | Sequence[str]


def from_table(
    table: Any,
    truth_table: Any = None,
    *,
    map: str | os.PathLike[str] | Mapping[str, Any] | None = None,
    error: Names | None = None,
    estimate: Names | None = None,
    truth: Names | None = None,
    sigma: Names | None = None,
    variance: Names | None = None,
    covariance: Names | None = None,
    innovation: Names | None = None,
    innovation_sigma: Names | None = None,
    innovation_variance: Names | None = None,
    innovation_covariance: Names | None = None,
    nees: str | None = None,
    nis: str | None = None,
    dimension: int | None = None,
    components: Names | None = None,
    angles: Names | None = None,
    time: Names | None = None,
    runs: str | None = None,
    units: Mapping[str, str] | None = None,
    order: Names | None = None,
    max_gap: float = 0.2,
    **options: Any,
) -> dict[str, Any]:
    """Columns of a CSV file or a frame, by their names.

    Needs pandas for a file, and for times that are texts.

    Parameters
    ----------
    table : path, pandas.DataFrame, or anything that has columns by name
        A row for each step. A file has the names in its first line; empty cells are NaN.
    truth_table : the same
        Where the truth stands in a table of its own: it is interpolated at the times of `table` (`time`, in both).
    map : path of a TOML file, or dict
        Any of the arguments that follow, but `max_gap`, by their names. What is given as an argument counts instead.
    error : list of str
        Columns of estimate - truth; or else
    estimate, truth : lists of str
        columns of both, one for each component; or seven, x, y, z and a quaternion, or its four alone: a pose.
    sigma, variance, covariance : list of str
        One of them: standard deviations, variances, or the covariance row by row, whole or a triangle (`order`).
    innovation, innovation_sigma, innovation_variance, innovation_covariance : lists of str
        The same of the innovations, beside errors or in their place.
    nees, nis, dimension : str, str, int
        The column of NEES or NIS, where there is nothing else, and of how many numbers each is.
    components : list of str
        What the components of the error (or of innovations alone) are called; without it, as their columns.
    angles : list of str
        Which of the components are angles: their differences are wrapped. They are in rad, unless `units` says
        otherwise; what cannot be is refused.
    time : str, or two
        The column of times, which must increase: numbers (s), dates (ISO 8601, ``YYYY/MM/DD hh:mm:ss.sss``), or week
        and seconds of GPS, which may be two columns, as a date and a time of day may be.
    runs : str
        The column that tells runs apart, each of which has its own length.
    units : dict
        Of components, or of their columns, ``"rad"``, ``"deg"``, ``"mgon"`` or ``"arcsec"``, which make it an angle, or
        ``"m"``, ``"mm"``, ``"cm"`` or ``"km"``; or ``"latitude"`` and ``"longitude"`` (deg), whose errors and sigmas
        are in m to the north and to the east, by pymap3d. The truth, sigma, variances and covariances are then in the
        same unit, unless a column of `truth`, `sigma` or `variance` has one of its own, and what is returned is in rad
        and m. Of `time`, and of `truth_time` where that of `truth_table` is another one, ``"s"``, ``"ms"``, ``"us"`` or
        ``"ns"``.
    order : str, or list of str
        Of `covariance` and `innovation_covariance`: ``"upper"``, ``"lower"`` (both row by row), ``"diagonals"`` (the
        variances, then what is beside them) or ``"full"``; ``"rotation first"`` where angles come before the rest;
        ``"signed roots"`` where each number is the signed root of a covariance. A triangle that is not said is the one
        that gives positive definite matrices.
    max_gap : float
        As of :func:`from_tum`.
    **options
        `pair`: `truth_table` is a second filter's, with the same names [from_pair]. Of poses, which are on
        ``"R3 x SO3"`` by default, those of :func:`from_tum`; `order` may have ``"qw first"``.

    Returns
    -------
    dict
        `error` and `covariance`, or `innovation` and `innovation_covariance`, or both, or `nees` and `dimension`:
        [row, …] with `runs`, or [1, step, …] with `steps`. With `time` and `component_names`, and with
        `component_units` where `units` says those of all that are no angles. Steps that cannot be judged are left out,
        and components are NaN as long as P says "not known" (docs/logs.md).

    Raises
    ------
    InputError
        If a column is not there or not of numbers, columns do not fit each other, a standard deviation is negative, a
        unit or order cannot be right, or no step can be judged.
    """
    left_out = ("table", "truth_table", "map", "max_gap", "options")
    given = declared(map, {name: value for name, value in locals().items() if name not in left_out})
    rows, other = NamedColumns(table), None if truth_table is None else NamedColumns(truth_table)
    if options.get("pair") and "estimate" not in given:
        raise wrong("pair", "two filters have estimates", "Name those")
    if options.get("pair"):
        given = {**given, "truth": given.get("truth", given.get("estimate", []))}
    kinds, (count, wanted) = kinds_of(given), (len(given.get(name, [])) for name in ("truth", "estimate"))
    if kinds[0] and count != wanted:
        raise InputError(f"truth has {count} columns (must be {wanted}, as estimate). Give one for each.")
    if "estimate" in given and has_poses(rows, given["estimate"]):
        return table_of_poses(rows, other, given, kinds[0], {"max_gap": max_gap, **options})
    for name in options.keys() - {"pair"}:
        raise wrong(name, "says nothing about a table without a quaternion", "Leave it out")
    return _Reader(rows, given, bool(options.get("pair"))).arguments(other, max_gap)


class _Reader:
    """A table, and what its columns are."""

    def __init__(self, rows: NamedColumns, given: Mapping[str, Any], pair: bool = False) -> None:
        self.rows, self.source, self.given, self.pair = rows, rows.source, given, pair
        self.spreads = kinds_of(given)
        columns = [given.get("error") or given.get("estimate", []), given.get("innovation", [])]
        spreads = [given.get(name, []) for name in self.spreads]
        labels, angles = given.get("components", []), given.get("angles", [])
        own = [*columns[0], *columns[1], *labels]
        for name in angles:
            if name not in own:
                some = ", ".join(own)
                raise InputError(f"angles: {name} is no column of the errors or estimates. Give some of {some}.")
        kinds = {name: ["time"] for name in ("time", "truth_time", *given.get("time", []))}
        truths = given.get("truth", [])
        kinds |= {name: ["angle", "length", "place"] for name in (*own, *truths, *spreads[0], *spreads[1])}
        self.units = units_given(given["units"], kinds)
        self.errors, self.innovations = (
            Components(of, labels if labels and is_named else of, angles, self.units, spread, truth)
            for of, spread, truth, is_named in zip(columns, spreads, (truths, []), (columns[0], not columns[0]))
        )
        self.left: dict[str, Rows] = {}  # why rows cannot be judged
        if like := looks_like_innovation(given.get("error", [])):
            say = f"If it is one, name it {argument('innovation')}: without a truth the verdict is on innovations"
            note(f"{self.source}: {like} is given as an error, and called like an innovation. {say}.")

    def arguments(self, truth_table: NamedColumns | None, max_gap: float) -> dict[str, Any]:
        """What `from_table` returns."""
        steps: dict[str, Array] = {}
        if "time" in self.given:
            noted = truth_table is not None and not self.units
            steps["time"] = self.rows.times(self.given["time"], self._unit_of_time(), "time", noted)
            self.left["have no time"] = np.isnan(steps["time"])
        for name in {"nees", "nis"} & self.given.keys():
            steps["nees"] = self.rows.column(self.given[name][0])
            self.left["have no number"] = np.isnan(steps["nees"])
            if name == "nis":
                self._note_places("NIS stands in the place of NEES")
        if self.innovations.names:
            steps |= self._innovations()
        labels = np.asanyarray(self.rows.values(self.given["runs"][0])) if "runs" in self.given else None
        components = self.errors if self.errors.names else self.innovations
        kept, run = list(range(len(components.names))), None if labels is None else runs_of(labels.tolist())
        if self.errors.names:
            steps = self._errors(steps, truth_table, max_gap)
        if kept:
            kept = self._without_placeholders(steps, components, run)
        rows = self._judged(steps, run)
        about = {"dimension": self.given["dimension"]} if "nees" in steps else self._names(components, kept)
        if labels is not None:
            return {name: array[rows] for name, array in steps.items()} | {"runs": labels[rows]} | about
        single = {name: array[rows][None] for name, array in steps.items()}
        return single | {"steps": np.array([rows.sum()])} | about

    def _note_places(self, what: str) -> None:
        note(f"{self.source}: {what}: what the report says of NEES is of NIS, and nothing is said of P")

    def _unit_of_time(self) -> str:
        return self.units.get(self.given["time"][0], self.units.get("time", "s"))

    def _names(self, components: Components, kept: Sequence[int]) -> dict[str, Any]:
        names = record_names(components.names)
        others = [f"{name} is {label}" for name, label in zip(names, components.names) if name != str(label)]
        if others:
            note(f"{self.source}: in the report {', '.join(others)}")
        return {"component_names": [names[i] for i in kept]} | {
            name: [units[i] for i in kept] for name, units in components.known.items()
        }

    def _spread(self, kind: str, rows: NamedColumns) -> Array:
        """Variances [row, n], or covariances [row, n, n], in the units of the columns."""
        components = self.errors if kind == self.spreads[0] else self.innovations
        order, n = self.given.get("order", ()), len(components.names)
        return rows.spread(kind, self.given[kind], n, order, components.turns)

    def _errors(self, steps: Mapping[str, Array], other: NamedColumns | None, max_gap: float) -> dict[str, Array]:
        components = self.errors
        own, kept, most, of_truth = self.rows.array(components.columns), slice(None), 4 * np.pi, 0.0
        largest = largest_of(own)
        components.refuse_degrees(self.source, own)
        error = own / components.scale
        if "error" in self.given:
            most = 2 * np.pi  # two angles in a turn are at most a turn apart
        else:
            kept, true, largest_truth, of_truth = self._truth(steps, other, max_gap)
            largest, error = np.maximum(largest, largest_truth), components.apart(self.source, error[kept], true)
            self.left = {reason: rows[kept] for reason, rows in self.left.items()}
        covariance = self._spread(self.spreads[0], self.rows)[kept] + of_truth
        none = np.asarray(np.isnan(np.hstack([own[kept], variances_of(covariance)])).all(axis=1))
        if 2 * none.sum() > len(none):  # of a filter that was not asked at each row
            self.left["have neither an estimate nor a covariance"] = none
        components.refuse_sigmas(self.source, error, covariance)
        components.ask_about_scales(self.source, error, covariance, self.spreads[0])
        components.refuse_folded(self.source, error, largest, most)
        components.ask_about_turns(self.source, own[kept], error)
        states = {"error": components.wrapped(error), "covariance": components.scaled(covariance)}
        return {name: array[kept] for name, array in steps.items()} | states

    def _truth(
        self, steps: Mapping[str, Array], other: NamedColumns | None, max_gap: float
    ) -> tuple[Any, Array, Array, Any]:
        """The rows that have a truth, their true values, how large its numbers are, and the spread of a second filter
        in its place."""
        names, components, times = self.given["truth"], self.errors, steps.get("time")
        if other is None:
            if self.pair:
                raise InputError("a pair has two tables. Give that of the second filter as the truth.")
            true = self.rows.array(names)
            missing: Rows = np.isnan(true)
            if empty := [name for name, none in zip(names, np.asarray(missing.all(axis=0))) if none]:
                raise InputError(f"{self.source}: column {empty[0]} has no number. Leave out this truth's component.")
            self.left["have no truth"] = np.asarray(missing.any(axis=1))
            components.refuse_degrees(self.source, true, of_truth=True)
            true /= components.truth_scale
            return slice(None), true, largest_of(true), 0.0
        if times is None or "runs" in self.given:
            raise InputError(NEEDS_TIME)
        unit = self.units.get("truth_time", self._unit_of_time())
        stamps = other.times(self.given["time"], unit, "truth_time", not self.units)
        of, values, largest, at = interpolated(other, names, stamps, components)
        kept, before, after, share = neighbours(of, times, max_gap)
        say_matched(self.source, times, kept, other.source, of, max_gap)
        spread: Any = 0.0
        if self.pair:
            say_independent(self.source, other.source)
            both = self._spread(self.spreads[0], other)[at]
            spread = both[before] + share.reshape(-1, *[1] * (both.ndim - 1)) * (both[after] - both[before])
        return kept, values[before] + share[:, None] * (values[after] - values[before]), largest, spread

    def _innovations(self) -> dict[str, Array]:
        """Innovations and S. Where there are no errors, and no correlations either, they stand in the errors' place, so
        that each is judged by itself."""
        components = self.innovations
        own = self.rows.array(components.columns)
        components.refuse_degrees(self.source, own)
        values, S = own / components.scale, self._spread(self.spreads[1], self.rows)
        components.refuse_sigmas(self.source, values, S)
        components.refuse_folded(self.source, values, largest_of(own), 2 * np.pi)
        values, S = components.wrapped(values), components.scaled(S)
        if not self.errors.names:
            missing: Rows = np.isnan(values)
            self.left["have no innovation"] = np.asarray(missing.all(axis=1))
            self.left["have innovations of some rows alone"] = np.asarray(missing.any(axis=1))
            if S.ndim == 2 and S.shape[1] > 1:
                self._note_places("the innovations stand in the place of errors, each by itself")
                return {"error": values, "covariance": S}
        return {"innovation": values, "innovation_covariance": S if S.ndim == 3 else S[:, :, None] * np.eye(S.shape[1])}

    def _without_placeholders(
        self, steps: dict[str, Array], components: Components, run: NDArray[np.intp] | None
    ) -> list[int]:
        """The components whose P is known somewhere; the others are taken out of the steps, and NaN before it is."""
        of, of_P = ("error", "covariance") if "error" in steps else ("innovation", "innovation_covariance")
        error, covariance = steps[of], steps[of_P]
        run = np.zeros(len(error), dtype=np.intp) if run is None else run
        logged = error * components.scale, variances_of(covariance) * components.spread_scale**2
        kept, starts, later = not_known(self.source, *logged, components.names, run)
        if later.any():
            self.left['have a variance that says "not known"'] = later
        if starts.any():
            steps[of], steps[of_P] = np.where(starts, np.nan, error), without(covariance, starts)
        if len(kept) < error.shape[1]:
            steps[of], covariance = steps[of][:, kept], steps[of_P][:, kept]
            steps[of_P] = covariance[:, :, kept] if covariance.ndim == 3 else covariance
        return kept

    def _judged(self, steps: dict[str, Array], run: NDArray[np.intp] | None) -> NDArray[np.bool_]:
        """The rows that are judged; in several runs those within a run that are not become steps that are missing, so
        that a step has its number in each."""
        left = say_left_out(self.source, len(next(iter(steps.values()))), self.left)
        if run is None or not left.any():
            return ~left
        for name in {"error", "covariance", "innovation", "innovation_covariance", "nees"} & steps.keys():
            steps[name] = np.where(left.reshape(-1, *[1] * (steps[name].ndim - 1)), np.nan, steps[name])
        return ~held(left[::-1, None], run[::-1])[::-1, 0]
