"""Arguments of :func:`credence.judge` from files of arrays."""

from __future__ import annotations

import inspect
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields
from typing import Any

import numpy as np

from credence import InputError, Record, judge
from credence._errors import argument, printable, wrong
from credence.adapters.orders import words_of
from credence.adapters.quaternions import from_quaternions, quaternion_at
from credence.adapters.tables import existing, needed, note, one_line


def from_npz(
    path: str | os.PathLike[str], names: Mapping[str, str] | None = None, *, order: str = "", **states: str
) -> dict[str, Any]:
    """Arrays of an ``.npz`` file that are called as the arguments of :func:`credence.judge`.

    Parameters
    ----------
    path
        A file that ``numpy.savez`` wrote. Texts, such as `groups` and `manifold`, may be in it. An array called
        ``group/NAME/covariance`` is the covariance of a group. Nothing in it is unpickled.
    names : dict
        Of arguments whose arrays are called otherwise: ``{"error": "e", "covariance": "P"}``.
    order : str
        ``"qw first"`` where quaternions begin with w.
    **states : str
        `manifold` and `chart` of estimates (docs/judge.md), where they are not in the file; without a manifold the
        truth is subtracted. Covariances of quaternions are taken as of :func:`from_quaternions`.

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
    words = words_of(order, "qw first")
    try:
        with np.load(source, allow_pickle=False) as file:
            return on_a_manifold(source, _arguments(source, file, names) | states, words)
    except InputError:
        raise
    except Exception as error:  # what zipfile, zlib and NumPy run into
        raise InputError(f"{source}: it cannot be read as an .npz file ({one_line(error)}). Check the path.") from None


def from_mat(
    path: str | os.PathLike[str], names: Mapping[str, str] | None = None, *, order: str = "", **states: str
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
        [trial, step, n]. By default what the shapes of error and covariance say; of variances, that there are more
        steps than components, which is noted. ``"qw first"`` may stand beside it.
    **states : str
        As of :func:`from_npz`.

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
    words = words_of(order, "qw first", "F", "C")
    order = next((word for word in words if word in ("F", "C")), "") or _order(source, arguments)

    def turned(name: str, array: Any) -> Any:
        if not isinstance(array, np.ndarray):
            return array
        if array.dtype.kind == "U":
            return [text.strip() for text in array.ravel().tolist()] if array.size > 1 else str(array.ravel()[0])
        array = array.T if order == "F" else array
        return array.ravel() if name == "steps" or (name == "time" and 1 in array.shape) else array

    read = {
        name: {group: turned(name, one) for group, one in value.items()}
        if isinstance(value, dict)
        else turned(name, value)
        for name, value in arguments.items()
    }
    return on_a_manifold(source, read | states, words)


def _fields(before: str, variables: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    """Variables by their names, those in structs by names with dots."""
    for name, value in variables.items():
        yield before + name, value
        fields = getattr(getattr(value, "dtype", None), "names", None)
        if fields and value.size == 1:
            yield from _fields(f"{before}{name}.", {field: value[field].item() for field in fields})


def _order(source: str, arguments: Mapping[str, Any]) -> str:
    """What the shapes of the errors and of their covariances say of the order of dimensions."""
    arrays = [arguments.get(name) for name in ("error", "estimate", "covariance")]
    e, c = (tuple(getattr(array, "shape", ())) for array in (arrays[1] if arrays[0] is None else arrays[0], arrays[2]))
    is_of_steps = c[-1:] == c[-2:-1] and c[:-2] in (e[:-1], e[1:-1])
    is_of_columns = c[:1] == c[1:2] and c[2:] in (e[1:], e[1:-1])
    fits = [order for order, fit in (("C", is_of_steps), ("F", is_of_columns)) if fit and len(c) > 2]
    if c == e and len(e) > 1:  # variances: there are many more steps than components
        fits = [order for order, fewer in (("C", 5 * e[-1] < e[-2]), ("F", 5 * e[0] < e[1])) if fewer]
        if len(fits) == 1:
            taken = {"C": "[step, n]", "F": "[n, step]"}[fits[0]]
            note(f"{source}: its arrays are taken for {taken}. Say {argument('order')} {'FC'[fits[0] == 'F']} if not.")
    if len(fits) == 1:
        return fits[0]
    has = f"errors of {list(e)} and covariances of {list(c)} fit both orders, or none"
    raise InputError(f"{source}: {has}. Say {argument('order')} C for [trial, step, n], or F for [n, step, trial].")


def on_a_manifold(source: str, arguments: dict[str, Any], words: Sequence[str] = ()) -> dict[str, Any]:
    """Arguments with estimates that have no manifold: of plain numbers, unless four of these are a quaternion."""
    if arguments.get("estimate") is None or arguments.get("covariance") is None:
        return arguments
    estimate, size = arguments["estimate"], arguments["covariance"].shape[-1]
    estimate = estimate[..., 0] if estimate.shape[-1] == 1 < size == estimate.shape[-2] else estimate
    if arguments.get("manifold") is None and size == estimate.shape[-1]:
        at = quaternion_at(estimate)
        if at is not None:
            has = f"numbers {at + 1} to {at + 4} of its estimates are quaternions"
            example = " x ".join(filter(None, [f"R{at}" * bool(at), "SO3", f"R{size - at - 4}" * (size > at + 4)]))
            say = f"Say {argument('manifold')} '{example}', and {argument('order')} 'qw first' if they begin with w"
            raise InputError(f"{source}: {has}. {say}.")
        note(f"{source}: estimates and truths are subtracted as they are. Angles need {argument('manifold')}.")
        return {"chart": "local"} | arguments | {"manifold": f"R{size}"}
    if "SO3" not in str(arguments.get("manifold")):
        return arguments
    how = {"chart": "local", "quaternion": "wxyz" if "qw first" in words else "xyzw"} | arguments
    return from_quaternions(**how) if size == estimate.shape[-1] else how


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
