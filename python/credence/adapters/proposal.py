"""What the columns of a table are, as their names suggest it: proposed in a message, never assumed."""

from __future__ import annotations

import itertools
import re
import shlex
from collections.abc import Sequence

from credence._names import joined

# Words in a column's name that tell its kind; what is left of the name tells its component.
_words = {
    "error": "err error",
    "truth": "true truth gt ref reference groundtruth actual",
    "estimate": "est estimate estimated hat ekf kf",
    "sigma": "sigma std stddev stdev sd",
    "variance": "var variance p",
    "innovation": "innov innovation residual res",
    "nees": "nees",
    "nis": "nis",
    "time": "t time stamp timestamp",
    "runs": "run trial track",
}
_kinds = {word: kind for kind, words in _words.items() for word in words.split()}
_initials = {"e": "error", "g": "truth", "s": "sigma"}  # of ex, gx and sx
_angles = {"roll", "pitch", "yaw", "heading", "theta", "phi", "psi", "azimuth", "bearing", "course", "angle"}
_Key = tuple[str, ...]


def _by_kind(names: Sequence[str], by_initials: bool) -> dict[str, dict[_Key, str]]:
    """The names of each kind by their components; those of no kind are under ``""``."""
    found: dict[str, dict[_Key, str]] = {}
    for name in names:
        words = [word.lower() for word in re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+", name)]
        if by_initials and len(name) > 1 and len(words) == 1 and name[0] in _initials:
            words = [_words[_initials[name[0]]].split()[0], name[1:].lower()]
        kinds = [_kinds[word] for word in words if word in _kinds]
        kind = "_".join(dict.fromkeys(kinds))
        for spread in ("sigma", "variance"):
            if set(kinds) == {"innovation", spread}:
                kind = f"innovation_{spread}"
        found.setdefault(kind, {}).setdefault(tuple(word for word in words if word not in _kinds), name)
    return found


def proposed(names: Sequence[str], of_truth: Sequence[str] | None = None) -> str:
    """The words of ``--names`` that the names of a table's columns suggest, for a shell; empty where none are. A truth
    in a table of its own has the columns `of_truth`, which are called like the estimate's."""
    return _proposed(names, of_truth, False) or _proposed(names, of_truth, True)


def _proposed(names: Sequence[str], of_truth: Sequence[str] | None, by_initials: bool) -> str:
    found = _by_kind(names, by_initials)
    plain = found.get("", {})
    if of_truth is not None:
        found["truth"] = {key: name for key, name in plain.items() if name in of_truth}
    for spread, first, kinds in itertools.product(
        ("sigma", "variance"), ("error", "estimate", "innovation"), (found, found | {"estimate": plain})
    ):
        needed = [first, f"innovation_{spread}" if first == "innovation" else spread]
        needed += ["truth"] if first == "estimate" else []
        columns = {kind: kinds.get(kind, {}) for kind in needed}
        keys = [key for key in columns[first] if all(key in each for each in columns.values())]
        if keys:
            words = [f"{kind}={joined([each[key] for key in keys])}" for kind, each in columns.items()]
            turning = [columns[first][key] for key in keys if _angles.intersection(key)]
            words += [f"angles={joined(turning)}"] if turning else []
            break
    else:
        words = [f"{kind}={name}" for kind in ("nees", "nis") for name in list(found.get(kind, {}).values())[:1]]
    about = [f"{kind}={name}" for kind in ("runs", "time") for name in list(found.get(kind, {}).values())[:1]]
    return shlex.join(words + about) if words else ""
