"""What results files and trajectory files have in common: how they are opened, and how their groups are read."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
from typing import Any, BinaryIO, NamedTuple

import h5py
import numpy as np
import numpy.typing as npt

from credence._results import cached

FloatArray = npt.NDArray[np.float64]
Array = npt.NDArray[Any]
Source = str | os.PathLike[str] | BinaryIO

SCHEMA_VERSION = 5
RESULTS, TRAJECTORIES = "credence results", "credence trajectories"


def open_hdf5(source: Source) -> tuple[h5py.File, str]:
    """The open file and its format; ValueError where credence did not write it, or in another schema version."""
    try:
        # A relative path would lead elsewhere in another folder.
        file = h5py.File(source if hasattr(source, "read") else os.path.abspath(os.fspath(source)), "r")
    except FileNotFoundError:
        raise FileNotFoundError(f"{source}: the file: cannot be found. Check the path.") from None
    except OSError as problem:
        raise ValueError(f"{source}: the file: cannot be read as HDF5 ({problem}). "
                         "Give one that credence wrote.") from None
    kind = text(file, "format") if "format" in file.attrs else "none"
    version = file.attrs.get("schema_version")
    if kind in (RESULTS, TRAJECTORIES) and version == SCHEMA_VERSION:
        return file, kind
    file.close()
    if version is None or kind not in (RESULTS, TRAJECTORIES):
        raise ValueError(f"{source}: format: invalid format={kind} (must be {RESULTS} or {TRAJECTORIES}). "
                         "Give a file that `credence run` or `credence replay` wrote.")
    raise ValueError(f"{source}: schema_version: invalid schema_version={version} (this package reads "
                     f"{SCHEMA_VERSION}). Take the package of the release that wrote it.")


def parted(path: str) -> tuple[str, str]:
    """A path FILE:ARM of a record as both; the arm is empty where the path is that of a file."""
    file, _, arm = path.rpartition(":")
    return (path, "") if os.path.exists(path) or not os.path.exists(file) else (file, arm)


def records_in(source: object) -> dict[str, str]:
    """{arm: path} of the records in a file, ``record`` where one does not name its arm; nothing if it has none."""
    if not isinstance(source, (str, os.PathLike)):
        return {}
    path, arm = parted(os.fsdecode(source))
    if not h5py.is_hdf5(path):
        return {}
    if arm:
        return {arm: f"{path}:{arm}"}
    names = ("error", "estimate", "innovation", "nees", "group")
    with contextlib.suppress(OSError), h5py.File(path, "r") as file:  # a damaged file is refused by its reader
        if "arms" in file.attrs:
            return {arm: f"{path}:{arm}" for arm in text(file, "arms").split(", ")}
        if "format" not in file.attrs and any(name in file for name in names):
            return {text(file, "arm") if "arm" in file.attrs else "record": path}
    return {}


def still_open(thing: Any) -> Any:
    """The h5py object, unless its file is closed."""
    if not thing:
        raise ValueError("cannot read a file that is closed. Open it again.")
    return thing


class Identity(NamedTuple):
    """A file and its contents: of two that differ, they are other files, or one was changed."""

    device: int
    inode: int
    size: int
    written: int

    @classmethod
    def of(cls, file: str | int) -> Identity | None:
        """That of a path or a descriptor; None where there is no such file."""
        try:
            status = os.stat(file)
        except OSError:
            return None
        return cls(status.st_dev, status.st_ino, status.st_size, status.st_mtime_ns)


def text(thing: Any, name: str) -> str:
    """A text attribute. HDF5 keeps an empty text as one null character."""
    value = thing.attrs[name]
    return (value.decode() if isinstance(value, bytes) else str(value)).rstrip("\0")


def _address(variable: h5py.Dataset) -> int:
    """Where the file keeps it: HDF5 goes through the whole file for the name of what a reference leads to."""
    return int(h5py.h5o.get_info(variable.id).addr)


def stem(group: h5py.Group) -> str:
    """The last word of a group's path."""
    return str(group.name).rsplit("/", 1)[-1]


class Description(NamedTuple):
    """What a number is: its unit (`1` without a dimension) and its meaning."""

    units: str
    meaning: str


def described(variable: Any, meaning: str = "") -> Description:
    """The description that a variable of the file has of itself."""
    return Description(text(variable, "units"), meaning or text(variable, "long_name"))


class Group:
    """A group of a file by its name, which is read as long as the file is open."""

    def __init__(self, group: h5py.Group) -> None:
        self._group = group
        self.name = stem(group)

    @property
    def group(self) -> h5py.Group:
        """The plain h5py group."""
        return still_open(self._group)

    def __iter__(self) -> Iterator[str]:
        return iter(self.group)

    def __repr__(self) -> str:
        return self._said() if self._group else f"<credence.{type(self).__name__}, closed>"

    def _said(self) -> str:
        raise NotImplementedError


class Variables(Group):
    """A group whose variables are read when they are asked for, by key or as attributes."""

    def read(self, name: str, selection: Any = ()) -> Array:
        """Reads a variable, or a part of it.

        Parameters
        ----------
        name : str
            The variable's name, such as ``trace_P``.
        selection : int, slice or tuple of them
            What to read of it, as h5py takes it; by default all. Nothing else is read from the disk.

        Returns
        -------
        ndarray
            In the variable's own type; as float64 with NaN for what is missing where the variable has a fill value.
        """
        variable = self.group.get(name)
        if not isinstance(variable, h5py.Dataset):
            raise KeyError(self._missing(name))
        values = np.asarray(variable[selection])
        if "_FillValue" not in variable.attrs:
            return values
        fill, values = variable.attrs["_FillValue"][0], values.astype(np.float64)
        return values if np.isnan(fill) else np.where(values == fill, np.nan, values)

    def describe(self, name: str) -> Description:
        """Unit and meaning of a variable."""
        variable = self.group.get(name)
        if not isinstance(variable, h5py.Dataset):
            raise KeyError(self._missing(name))
        return described(variable)

    @cached
    def dimensions(self) -> dict[str, list[str]]:
        """{variable: names of its dimensions}, of all variables that are not coordinates themselves."""
        variables = [(name, variable) for name, variable in self.group.items() if isinstance(variable, h5py.Dataset)]
        coordinates = {_address(one): name for name, one in variables if one.attrs.get("CLASS") == b"DIMENSION_SCALE"}
        return {name: [coordinates[_address(scales[0])] for scales in variable.dims] for name, variable in variables
                if name not in coordinates.values()}

    def words(self, variable: str, attribute: str) -> list[str]:
        """The words of a text attribute of a variable, such as ``component_names`` of ``component``."""
        return text(self.group[variable], attribute).split()

    def _missing(self, name: str) -> str:
        return f"{self.group.name} has no {name}"

    def __getitem__(self, name: str) -> Array:
        return self.read(name)

    def __getattr__(self, name: str) -> Array:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self[name]
        except KeyError as problem:
            raise AttributeError(problem.args[0]) from None

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and name in self.group

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self]
