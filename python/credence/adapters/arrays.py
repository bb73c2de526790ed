"""Arguments of :func:`credence.judge` from files of arrays."""

from __future__ import annotations

import inspect
import os
from collections.abc import Mapping
from typing import Any

import numpy as np

from credence import InputError, judge


def from_npz(path: str | os.PathLike[str], names: Mapping[str, str] | None = None) -> dict[str, Any]:
    """Arrays of an ``.npz`` file that are called as the arguments of :func:`credence.judge`.

    Parameters
    ----------
    path
        A file that ``numpy.savez`` wrote. Texts, such as `groups` and `manifold`, may be in it. An array called
        ``group/NAME/covariance`` is the covariance of a group. Nothing in it is unpickled.
    names : dict
        Of arguments whose arrays are called otherwise: ``{"error": "e", "covariance": "P"}``.

    Returns
    -------
    dict
        The arguments that are there, in their shapes. Other arrays are ignored.

    Raises
    ------
    InputError
        If an array of `names` is not in the file, or none is that `judge` takes.
    """
    known = [name for name in inspect.signature(judge).parameters if name not in ("progress", "name")]
    called = {name: name for name in known} | dict(names or {})
    with np.load(path, allow_pickle=False) as file:
        missing = [array for array in (names or {}).values() if array not in file.files]
        if missing:
            there = ", ".join(file.files)
            raise InputError(f"{os.fspath(path)}: there is no array {missing[0]} in it (it has {there})")
        arguments: dict[str, Any] = {name: file[array] for name, array in called.items() if array in file.files}
        for what in ("covariance", "nees"):
            found = {name.split("/")[1]: file[name] for name in file.files if _is_group(name, what)}
            if found:
                arguments[f"group_{what}"] = found
    if not arguments:
        raise InputError(f"{os.fspath(path)}: no array in it is an argument of judge. Give their names.")
    single = {name: value for name, value in arguments.items() if isinstance(value, np.ndarray) and not value.ndim}
    return arguments | {name: value.item() for name, value in single.items()}


def _is_group(name: str, what: str) -> bool:
    parts = name.split("/")
    return len(parts) == 3 and parts[0] == "group" and parts[2] == what
