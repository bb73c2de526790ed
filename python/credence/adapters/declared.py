"""What the columns of a table are: by a map (a TOML file or a dictionary), by arguments, or by both."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from credence._errors import InputError, argument, invalid, printable
from credence.adapters.orders import words_of
from credence.adapters.tables import needed, text_of

SPREADS = ("sigma", "variance", "covariance")
SPREADS_OF_INNOVATIONS = ("innovation_sigma", "innovation_variance", "innovation_covariance")
COLUMNS = (
    "error", "estimate", "truth", *SPREADS, "innovation", *SPREADS_OF_INNOVATIONS, "nees", "nis",
    "components", "angles", "time", "runs",
)  # fmt: skip
KEYS = (*COLUMNS, "dimension", "order", "units")
_single = ("nees", "nis", "runs")
_like_innovations = re.compile(r"innov|resid|(^|[^a-z])nu([^a-z]|$)", re.IGNORECASE)


def read_map(path: str | os.PathLike[str]) -> dict[str, Any]:
    """The keys of a map in a file, as they stand there."""
    tomllib = needed("tomllib" if sys.version_info >= (3, 11) else "tomli", "tomli", "read a map")
    source = os.fspath(path)
    with text_of(path) as encoding, open(path, encoding=encoding) as file:
        try:
            found: dict[str, Any] = tomllib.loads(file.read())
        except tomllib.TOMLDecodeError as error:
            example = 'estimate = ["East (m)", "North (m)"]'
            raise InputError(f"{source}: it is no TOML ({error}). Write lines such as {example}.") from None
    return found


def declared(table_map: Any, given: Mapping[str, Any]) -> dict[str, Any]:
    """{key: columns [list of str]}, `units` {name: unit}, `order` [list of words] and `dimension`; what is given takes
    the place of the same key of the map, and units stand beside those of the map."""
    is_file = isinstance(table_map, (str, os.PathLike))
    source = os.fspath(table_map) if is_file else argument("map")
    if not is_file and not isinstance(table_map or {}, Mapping):
        raise invalid("map", table_map, "must be a path or a dict", "Give one")
    mapped = read_map(table_map) if is_file else dict(table_map or {})
    for key in mapped:
        if key not in KEYS:
            raise InputError(f"{source}: unknown key {printable(key)}. Give some of {', '.join(KEYS)}.")
    said = {key: value for key, value in given.items() if value is not None and key != "units"}
    units = [each for each in (mapped.pop("units", None), given.get("units")) if each is not None]
    places = dict.fromkeys(mapped, f"{source}: ") | dict.fromkeys(said, "")
    found = {key: _value(places[key], key, value) for key, value in {**mapped, **said}.items()}
    for each in units:
        if not isinstance(each, Mapping) or not all(isinstance(unit, str) for unit in each.values()):
            raise InputError(f'{source}: units is no table of names. Give one, such as units = {{ heading = "deg" }}.')
    return {key: value for key, value in found.items() if value not in ([], None)} | {
        "units": {name: unit for each in units for name, unit in each.items()}
    }


def _value(place: str, key: str, value: Any) -> Any:
    if key == "dimension":
        whole = "".join(value) if isinstance(value, list) else str(value)  # the words of an option, or a number
        if not re.fullmatch(r"[1-9]\d{0,5}", whole):
            raise InputError(f"{place}invalid dimension={printable(whole)} (must be a whole number above 0). Give it.")
        return int(whole)
    if key == "order":
        return words_of(value, "qw first")
    names = list(value) if isinstance(value, Iterable) and not isinstance(value, (str, Mapping)) else [value]
    wrong = [name for name in names if isinstance(name, (list, tuple, dict)) or name == ""]
    if wrong or (key in _single and len(names) > 1):
        wanted = "one name" if key in _single else "names"
        raise InputError(f"{place}invalid {key}={printable(value)} (must be {wanted}). Give {wanted} of columns.")
    return names


def kinds_of(given: Mapping[str, Any]) -> tuple[str, str]:
    """Which spread belongs to the errors and which to the innovations of a table; "" where there are none."""
    has_errors = "error" in given or ("estimate" in given and "truth" in given)
    fitting, spreads = True, []
    for has, names in ((has_errors, SPREADS), ("innovation" in given, SPREADS_OF_INNOVATIONS)):
        named = [name for name in names if name in given]
        fitting = fitting and len(named) == has
        spreads.append(named[0] if named else "")
    alone = [name for name in ("nees", "nis") if name in given]
    twice = "error" in given and ("estimate" in given or "truth" in given)
    if not fitting or twice or any(spreads) == bool(alone) or len(alone) > 1:
        raise InputError(
            "cannot judge this table (it takes error, or estimate and truth, and one of sigma, variance and "
            "covariance; innovation and one of innovation_sigma, innovation_variance and innovation_covariance; or "
            "nees or nis alone). Give the names of these columns."
        )
    if alone and "dimension" not in given:
        raise InputError(f"{alone[0]}: has no dimension. Say of how many numbers it is, such as dimension=3.")
    return spreads[0], spreads[1]


def looks_like_innovation(names: Sequence[str]) -> str | None:
    """The first column that is called like an innovation."""
    return next((name for name in names if _like_innovations.search(str(name))), None)


def record_names(labels: Sequence[str]) -> list[str]:
    """Names as a record can have them, each another one: texts of one line without commas, quotes, / and =."""
    found: list[str] = []
    for label in labels:
        name = "".join(c if c.isprintable() and c not in ",/=\"'`\\" else "_" for c in str(label)).strip() or "x"
        name = name if name != "all" else "all_"
        taken = [f"{name}_{i}" if i > 1 else name for i in range(1, len(found) + 2)]
        found.append(next(each for each in taken if each not in found))
    return found
