"""The components of an error or innovation in a table: their names and units, and whether angles can be in rad."""

from __future__ import annotations

import re
import shlex
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from credence._errors import InputError, argument
from credence._names import joined
from credence.adapters.named_columns import NamedColumns
from credence.adapters.tables import UNITS, Array, needed, note

_turn = 2 * np.pi
_like_degrees = re.compile(r"(^|[^a-z])(lat|lon|lng|latitude|longitude)([^a-z]|$)", re.IGNORECASE)


class Components:
    """The columns of an `error`, `estimate` or `innovation`, what they are called, and their units."""

    def __init__(
        self, columns: list[str], labels: list[str], angles: Sequence[str], units: Mapping[str, str],
        spread: Sequence[str], truth: Sequence[str] = (),
    ) -> None:  # fmt: skip
        for what, names in (("column", columns), ("name", labels)):
            for name in names:
                if names.count(name) > 1:
                    raise InputError(f"{name} is named as two components. Give each {what} once.")
        if len(labels) != len(columns):
            has = f"components has {len(labels)} names (must be {len(columns)}, as there are columns)"
            raise InputError(f"{has}. Give one for each.")
        self.columns, self.names = columns, labels
        both = list(zip(columns, labels))
        given = [units.get(label, units.get(column)) for column, label in both]
        taken = [unit or ("rad" if {*names} & {*angles} else "") for unit, names in zip(given, both)]
        kinds = [UNITS[unit][0] if unit else "" for unit in taken]
        self.scale = np.array([UNITS[unit][1] if unit else 1.0 for unit in taken])
        self.spread, self.truth = list(spread), list(truth) if len(truth) == len(columns) else columns
        own = [units.get(column) for column in spread] if len(spread) == len(columns) else [None] * len(columns)
        of_truth = [units.get(column) for column in self.truth]
        self.spread_scale, self.truth_scale = (
            np.array([UNITS[unit][1] if unit else scale for unit, scale in zip(each, self.scale)])
            for each in (own, of_truth)
        )
        self.turns = [i for i, kind in enumerate(kinds) if kind == "angle"]
        self.is_said = [bool(unit) for unit in given]
        self.doubtful = [i for i in self.turns if not given[i]]
        self.says_spread, self.says_truth = [bool(unit) for unit in own], [bool(unit) for unit in of_truth]
        self.places = {unit: taken.index(unit) for unit in ("latitude", "longitude") if unit in taken}
        self.known = {"component_units": ["rad" if kind == "angle" else "m" for kind in kinds]}
        if not any(given) or "" in kinds:
            self.known = {}

    def wrapped(self, differences: Array) -> Array:
        differences[:, self.turns] = np.remainder(differences[:, self.turns] + np.pi, _turn) - np.pi
        return differences

    def apart(self, source: str, values: Array, truth: Array) -> Array:
        """Estimates less truths; of latitudes and longitudes in m [geodesy]."""
        error = values - truth
        looks = [i for i, name in enumerate(self.columns) if _like_degrees.search(str(name))]
        if len(looks) == 2 and not self.places and not any(self.is_said[i] for i in looks):
            lat, lon = sorted(looks, key=lambda i: "lo" in (name := str(self.columns[i]).lower()) or "lng" in name)
            if np.nanmax(np.abs(truth[:, lat])) <= 90 and np.nanmax(np.abs(truth[:, lon])) <= 180:
                both = [self.names[lat], self.names[lon]]
                say = [f"{joined([name])}={unit}" for name, unit in zip(both, ("latitude", "longitude"))]
                has = f"{both[0]} and {both[1]} are called as degrees on the Earth, whose sigmas are in m"
                no = shlex.quote(f"{joined(both[:1])}=m")
                raise InputError(
                    f"{source}: {has}. Say {argument('units')} {shlex.quote(','.join(say))}, or {no} if not."
                )
        if self.places:
            i, j = (self.places.get(unit, -1) for unit in ("latitude", "longitude"))
            if min(i, j) < 0:
                raise InputError(f"{argument('units')}: there is one of latitude and longitude. Give both.")
            earth = needed("pymap3d", "pymap3d", "place positions on the Earth")
            zero = np.zeros(len(values))
            east, north, _ = earth.geodetic2enu(values[:, i], values[:, j], zero, truth[:, i], truth[:, j], zero)
            error[:, i], error[:, j] = north, east
        return error

    def ask_about_scales(self, source: str, errors: Array, covariance: Array, kind: str) -> None:
        """Note sigmas, or variances, that are a power of ten of the errors' throughout, as of m beside mm; or the
        squares or roots of their sizes, as of the other kind."""
        if covariance.ndim > 2 or len(errors) < 20 or len(self.spread) != len(self.names):
            return
        sizes = 1.4826 * np.nanmedian(np.abs(errors), axis=0)
        usual = np.sqrt(np.maximum(np.nanmedian(covariance, axis=0), 0))
        plain = [i for i in range(len(sizes)) if i not in self.turns and sizes[i] > 0 and usual[i] > 0]
        for ratio, unit, of_spread in ((1e3, "mm", "m"), (100.0, "cm", "m"), (1e-3, "m", "mm"), (0.01, "m", "cm")):
            if plain and all(abs(sizes[i] / usual[i] / ratio - 1) < 0.15 and not self.is_said[i] for i in plain):
                say = [f"{joined([self.names[i]])}={unit},{joined([self.spread[i]])}={of_spread}" for i in plain]
                what = f"are {1 / ratio:.4g} times its errors. Are they in {of_spread}, and the errors in {unit}"
                note(f"{source}: its {kind}s {what}? If so, say {argument('units')} {shlex.quote(','.join(say))}.")
        other, power = ("variance", 0.5) if kind == "sigma" else ("sigma", 2)
        is_other = all(0.85 < usual[i] ** power / sizes[i] < 1.15 for i in plain)
        if len(plain) > 1 and is_other and not all(0.7 < usual[i] / sizes[i] < 1.4 for i in plain):
            note(f"{source}: its {kind}s are as large as {other}s of its errors. If they are, name them {other}.")

    def scaled(self, covariances: Array) -> Array:
        """Variances [row, n] or covariances [row, n, n] in rad² and m²."""
        covariances /= self.spread_scale if covariances.ndim == 2 else self.spread_scale[:, None]
        covariances /= self.spread_scale
        return covariances

    def refuse_degrees(self, source: str, values: Array, of_truth: bool = False) -> None:
        """Refuse angles that were not said to be in rad and are wrapped at 360."""
        for i in (i for i in self.doubtful if not (of_truth and self.says_truth[i])):
            known = values[np.isfinite(values[:, i]), i]
            if len(known) > 1 and 300 < np.ptp(known) < 361 and np.abs(np.diff(known)).max() > 180:
                spans = f"goes from {known.min():.4g} to {known.max():.4g} and jumps, as if it were wrapped at 360"
                raise self._in_degrees(source, i, spans, self.truth[i] if of_truth else None)

    def refuse_sigmas(self, source: str, errors: Array, covariance: Array) -> None:
        """Refuse sigmas that are not those of an angle in rad, and ask about those that seem to be in degrees beside
        errors in rad, or in rad beside errors that were said to be in degrees (and are in rad here)."""
        variances = covariance if covariance.ndim == 2 else np.diagonal(covariance, axis1=1, axis2=2)
        for i in self.turns:
            known = variances[variances[:, i] > 0, i]
            usual = float(np.sqrt(np.median(known))) if len(known) else 0.0
            sizes = np.abs(errors[np.isfinite(errors[:, i]), i])
            size = 1.4826 * float(np.median(sizes)) if len(sizes) >= 20 else 0.0
            in_rad = i in self.doubtful or self.scale[i] == 1
            is_mixed = size > 0 and 0.4 < (np.radians(usual) if in_rad else usual) / size < 2.5
            of_sigmas = self.spread[i] if is_mixed and len(self.spread) == len(self.names) else None
            if self.says_spread[i]:
                continue
            if i in self.doubtful and np.pi < usual < 360:  # beyond it a placeholder
                why = f"has sigmas of {usual:.3g}, and those of an angle are below pi rad"
                raise self._in_degrees(source, i, why, of_sigmas)
            if is_mixed:
                unit = "deg" if in_rad else "rad"
                asked = "in degrees, and the errors in rad" if in_rad else "in rad, and the errors not"
                times = f"its sigmas, about {usual:.3g}, are {usual / (self.scale[i] * size):.3g} times its errors"
                say = f" If so, say {self._say(of_sigmas, unit)}." if of_sigmas else ""
                note(f"{source}: {self.names[i]}: {times}. Are they {asked}?{say}")

    def refuse_folded(
        self, source: str, differences: Array, largest: Array, most: float = 2 * _turn, is_error: bool = True
    ) -> None:
        """Refuse angles that cannot be in rad: numbers beyond `most`, the largest of which are given [n], unless
        differences beyond half a turn, which are folded, are about whole turns; note others of that size. Differences
        of a truth's rows (`is_error` is false) may be small whatever the numbers are.
        """
        for i in self.doubtful:
            folded = differences[np.abs(differences[:, i]) > np.pi, i]
            if len(folded) and np.cos(folded).mean() > 0.5:
                continue
            what = f"{len(folded)} of {len(differences)} differences are beyond half a turn and no whole turns"
            if largest[i] > most and (len(folded) or is_error):
                has = f"has numbers up to {largest[i]:.4g}"
                raise self._in_degrees(source, i, f"{has}, and {what}" if len(folded) else has)
            if len(folded):
                say = f"If it is in degrees, say {self._say(self.names[i])}"
                note(f"{source}: {self.names[i]}: {what}. They are folded. {say}.")

    def ask_about_turns(self, source: str, values: Array, errors: Array) -> None:
        """Note numbers that were not said to be angles, and have errors of about a turn, which is their range."""
        for i in (i for i in range(len(self.names)) if i not in self.turns and values.shape[0]):
            known, sizes = values[np.isfinite(values[:, i]), i], np.abs(errors[:, i])
            for unit, turn in (("deg", 360.0), ("rad", _turn)):
                whole = np.abs(sizes - turn) < 0.05 * turn
                if whole.any() and 0.9 * turn < np.ptp(known) <= turn and np.nanmedian(sizes) < 0.05 * turn:
                    turns = f"{whole.sum()} of its errors are about {turn:.4g}, which is the range of its numbers"
                    say = f"If it is an angle, say {self._say(self.names[i], unit)}"
                    note(f"{source}: {self.names[i]}: {turns}. {say}.")

    def _say(self, name: str, unit: str = "deg") -> str:
        return f"{argument('units')} {shlex.quote(f'{joined([name])}={unit}')}"

    def _in_degrees(self, source: str, i: int, why: str, name: str | None = None) -> InputError:
        name = name or self.names[i]
        return InputError(
            f"{source}: {self.names[i]}, an angle, {why}: in degrees? Say {self._say(name)}, or "
            f"{shlex.quote(f'{joined([name])}=rad')} if not."
        )


def largest_of(columns: Array) -> Array:
    """[n] of columns [row, n]"""
    sizes: Array = np.abs(np.where(np.isfinite(columns), columns, 0)).max(axis=0, initial=0)
    return sizes


def interpolated(
    table: NamedColumns, names: Sequence[str], times: Array, components: Components
) -> tuple[Array, Array, Array, NDArray[np.intp]]:
    """The times of the truth, in order, its values there, angles without jumps, how large these were, and its rows."""
    values = table.array(names)
    there = np.isfinite(np.c_[times, values]).all(axis=1)
    if not there.all():
        if not there.any():
            raise InputError(f"{table.source}: none of its rows has a truth. Give the truth of this run.")
        note(f"{table.source}: {(~there).sum()} of {len(there)} rows have no truth, and are left out")
    order = np.flatnonzero(there)[np.argsort(times[there], kind="stable")]
    times, values = times[order], values[order]
    components.refuse_degrees(table.source, values, of_truth=True)
    values /= components.truth_scale
    largest = largest_of(values)
    components.refuse_folded(table.source, np.diff(values, axis=0), largest, is_error=False)
    for i in components.turns:
        values[:, i] = np.unwrap(values[:, i])
    return times, values, largest, order
