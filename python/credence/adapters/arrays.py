"""Arguments of :func:`credence.judge` from files of arrays."""

from __future__ import annotations

import inspect
import os
from collections.abc import Iterator, Mapping
from dataclasses import fields
from typing import Any

import numpy as np

from credence import InputError, Record, judge
from credence._errors import invalid, printable, wrong
from credence.adapters.tables import existing, needed, note, one_line


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
        The arguments that are there, in their shapes. Other arrays are ignored, and so are those that are called as an
        option of `judge`, such as `margin`, with a note.

    Raises
    ------
    InputError
        If an array of `names` is not in the file or is to be an option, or none is that `judge` takes.
    """
    source = existing(path)
    try:
        with np.load(source, allow_pickle=False) as file:
            return _arguments(source, file, names)
    except InputError:
        raise
    except Exception as error:  # what zipfile, zlib and NumPy run into
        raise InputError(f"{source}: it cannot be read as an .npz file ({one_line(error)}). Check the path.") from None


def from_mat(
    path: str | os.PathLike[str], names: Mapping[str, str] | None = None, *, order: str | None = None
) -> dict[str, Any]:
    """Variables of a ``.mat`` file (to version 7) that are called as the arguments of :func:`credence.judge`.

    Needs SciPy. A file of version 7.3 is HDF5: where its datasets are called so, ``credence judge`` reads it as it is.

    Parameters
    ----------
    path
        A file that ``save`` of MATLAB or Octave, or ``scipy.io.savemat``, wrote.
    names : dict
        As of :func:`from_npz`; fields of structs are named with dots: ``{"error": "nav_e.vel"}``.
    order : ``"F"`` or ``"C"``
        ``"F"`` is [n, step, trial] with covariances [n, n, step, trial], as one writes them in MATLAB; ``"C"`` is
        [trial, step, n]. By default what the shapes of error and covariance say; variances [step, n] do not.

    Returns
    -------
    dict
        The arguments that are there, in their shapes. Other variables are ignored, as in :func:`from_npz`.

    Raises
    ------
    InputError
        If the file cannot be read, a variable of `names` is not in it, the order cannot be told, or none of its
        variables is an argument of `judge`.
    """
    source = existing(path)
    scipy_io = needed("scipy.io", "scipy", "read .mat")
    try:
        variables = scipy_io.loadmat(source)
    except NotImplementedError:
        why = "it is of version 7.3, which is HDF5"
        raise InputError(f"{source}: cannot be read here ({why}). Give it to credence.judge as a path.") from None
    except Exception as error:  # what its parser runs into
        raise InputError(f"{source}: it cannot be read as a .mat file ({one_line(error)}). Check the path.") from None
    named = dict(_fields("", {name: array for name, array in variables.items() if name[:2] != "__"}))
    arguments = _arguments(source, named, names)
    order = order or _order(source, arguments)
    if order not in ("F", "C"):
        raise invalid("order", order, "must be F or C", "Give one of them")

    def turned(name: str, array: Any) -> Any:
        if not isinstance(array, np.ndarray):
            return array
        if array.dtype.kind == "U":
            return [text.strip() for text in array.ravel().tolist()] if array.size > 1 else str(array.ravel()[0])
        array = array.T if order == "F" else array
        return array.ravel() if name == "steps" or (name == "time" and 1 in array.shape) else array

    return {
        name: {group: turned(name, one) for group, one in value.items()}
        if isinstance(value, dict)
        else turned(name, value)
        for name, value in arguments.items()
    }


def _fields(before: str, variables: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    """Variables by their names, those in structs by names with dots."""
    for name, value in variables.items():
        yield before + name, value
        fields = getattr(getattr(value, "dtype", None), "names", None)
        if fields and value.size == 1:
            yield from _fields(f"{before}{name}.", {field: value[field].item() for field in fields})


def _order(source: str, arguments: Mapping[str, Any]) -> str:
    """What the shapes of the errors and of their covariances say of the order of dimensions."""
    for name in ("error", "estimate"):
        if name in arguments and "covariance" in arguments:
            e, c = arguments[name].shape, arguments["covariance"].shape
            fits = {"C": c[:-2] == e[:-1] and c[-1:] == c[-2:-1], "F": c[2:] == e[1:] and c[:1] == c[1:2]}
            if len(c) == len(e) + 1 and sum(fits.values()) == 1:
                return "F" if fits["F"] else "C"
    raise InputError(
        f"{source}: the shapes of its variables fit both orders, or none. Give order, F for [n, step, trial]."
    )


def _arguments(source: str, file: Mapping[str, Any], names: Mapping[str, str] | None) -> dict[str, Any]:
    """The arrays of a file that are arguments of judge: the fields of a Record, and `runs`."""
    data = [*(field.name for field in fields(Record) if field.name != "columns"), "runs"]
    for name, array in (names or {}).items():
        if name not in data:
            raise wrong("names", f"{printable(name)} is no data of judge", f"Name some of {', '.join(data)}")
        if array not in file:
            raise InputError(f"{source}: there is no array {printable(array)} in it (it has {', '.join(file)})")
    called = {name: name for name in data} | dict(names or {})
    arguments = {name: _read(source, file, array) for name, array in called.items() if array in file}
    for what in ("covariance", "nees"):
        found = {name.split("/")[1]: _read(source, file, name) for name in file if _is_group(name, what)}
        if found:
            arguments[f"group_{what}"] = found
    if not arguments:
        raise InputError(f"{source}: no array in it is an argument of judge. Give their names.")
    options = {*inspect.signature(judge).parameters} & {*file} - {*data, *called.values()}
    if options:
        note(f"{source}: {', '.join(sorted(options))} in it are left out, because options do not come from data")
    single = {name: value for name, value in arguments.items() if isinstance(value, np.ndarray) and not value.ndim}
    return arguments | {name: value.item() for name, value in single.items()}


def _read(source: str, file: Mapping[str, Any], name: str) -> Any:
    """One array of a file; the others, which may be anything, are not read."""
    try:
        return file[name]
    except Exception as error:  # what its parser runs into
        why = f"its array {printable(name)} cannot be read ({printable(str(error))})"
        raise InputError(f"{source}: {why}. Give arrays of numbers.") from None


def _is_group(name: str, what: str) -> bool:
    parts = name.split("/")
    return len(parts) == 3 and parts[0] == "group" and parts[2] == what
