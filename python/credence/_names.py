"""Names, groups and dimensions of what is judged, as lists of entries: a name, and behind it its components."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable, Mapping, Sequence
from numbers import Integral, Real
from typing import Any, NamedTuple

from credence._errors import printable, wrong

Entries = list[list[str]]
_example = '{"pose": [0, 1, 2]}'


class Named(NamedTuple):
    """The names, groups and dimensions of a record, as its file has them."""

    texts: dict[str, str]
    lists: dict[str, Entries]
    dimensions: dict[str, int]  # by the place of the NEES

    def attributes(self) -> dict[str, str]:
        """The texts and the lists, each as one text."""
        lists = {name: ", ".join(map(" ".join, entries)) for name, entries in self.lists.items()}
        return {name: text for given in (self.texts, lists) for name, text in sorted(given.items())}


def not_utf8(text: str) -> bool:
    """Whether a text has halves of characters, which UTF-8 cannot write."""
    return re.search("[\ud800-\udfff]", text) is not None


def parted(text: str) -> list[str]:
    """Names that are parted by commas; one that has a comma is quoted."""
    return next(csv.reader([text], skipinitialspace=True), [])


def joined(names: Sequence[str]) -> str:
    """The text that `parted` takes apart."""
    return ",".join(f'"{name}"' if "," in str(name) else str(name) for name in names)


def _whole(given: object) -> int | None:
    if isinstance(given, bool) or not isinstance(given, Real):
        return None
    return int(given) if isinstance(given, Integral) else int(float(given)) if float(given).is_integer() else None


def _name(argument: str, given: object) -> str:
    if not isinstance(given, str) or not_utf8(given):
        raise wrong(argument, f"{printable(given)} is not a text in UTF-8", "Give one")
    return given


def _members(argument: str, name: str, given: Any) -> list[str]:
    members = list(given) if isinstance(given, Iterable) and not isinstance(given, str) else [given]
    indices = [_whole(one) for one in members]
    for member, index in zip(members, indices):
        if index is None:
            why = f"{printable(member)} of {printable(name)} is not the index of a component"
            remedy = f"Give indices, such as {_example}; those of a mask are numpy.flatnonzero(mask)"
            raise wrong(argument, why, remedy)
    return [str(index) for index in indices]


def _groups(argument: str, given: Any) -> Entries:
    """Groups as a dictionary of their members, or as a list of texts such as ``pose 0:3``."""
    if isinstance(given, Mapping):
        return [[_name(argument, name), *_members(argument, name, members)] for name, members in given.items()]
    if not isinstance(given, Iterable):
        raise wrong(argument, f"{printable(given)} is no dict", f"Give one, such as {_example}")
    return [_name(argument, one).split() for one in given]


def _names(argument: str, given: Any) -> Entries:
    if not isinstance(given, Iterable):
        raise wrong(argument, f"{printable(given)} is no list", "Give a list of texts, one for each component")
    return [[_name(argument, one)] for one in given]


def truth_text(given: Any) -> str:
    """`truth_sigma` or `truth_dependent` as a record has it."""
    if isinstance(given, bool):
        return "yes" if given else "no"
    return ",".join(f"{name}={value}" for name, value in given.items()) if isinstance(given, Mapping) else str(given)


def texts_and_lists(given: Mapping[str, Any]) -> tuple[dict[str, str], dict[str, Entries]]:
    """The attributes of a record that are texts, and those that are lists."""
    texts = {argument: text for argument, text in given.items() if isinstance(text, str)}
    lists = {}
    for argument in given.keys() - texts.keys():
        if argument in ("manifold", "chart", "quaternion"):
            texts[argument] = _name(argument, given[argument])
        elif argument.startswith("truth_"):
            texts[argument] = truth_text(given[argument])
        else:
            entries = _groups if argument.endswith("groups") else _names
            lists[argument] = entries(argument, given[argument])
    return texts, lists


def dimensions(given: Any, groups: Any, nees: bool, group_nees: Iterable[str]) -> dict[str, int]:
    """The dimension of each NEES, by its place in a record."""
    by_name = dict(given) if isinstance(given, Mapping) else {} if given is None else {"all": given}
    known = [*group_nees, *(["all"] if nees else [])]
    for name, dimension in by_name.items():
        if name not in known or _whole(dimension) is None:
            unknown = name not in known
            why = f"{printable(name)} has no NEES" if unknown else f"{printable(dimension)} is not a whole number"
            raise wrong("dimension", why, "Give the number of components of each NEES, by its name")
    if isinstance(groups, Mapping):
        by_name = {name: len(_members("groups", name, groups[name])) for name in group_nees if name in groups} | by_name
    place = {name: "nees" if name == "all" else f"group/{name}/nees" for name in by_name}
    return {place[name]: int(dimension) for name, dimension in by_name.items()}
