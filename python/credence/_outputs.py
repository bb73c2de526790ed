"""Files that are written: whether one may be written, and how it appears whole under its name."""

from __future__ import annotations

import contextlib
import os
import shutil
import weakref
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

from credence._errors import InputError, argument, printable

File = str | os.PathLike[str]


def _files_of(inputs: Iterable[File]) -> Iterator[File]:
    """What is read: the files themselves, and those in folders, such as bags."""
    for one in inputs:
        yield one
        for folder, _, names in os.walk(one):
            yield from (os.path.join(folder, name) for name in names)


def check_output(
    path: File, overwrite: bool = False, remedy: str = "Give another name or --overwrite", inputs: Iterable[File] = (),
    name: str = "",
) -> Path:  # fmt: skip
    """Return where a file would be written, which is where its links lead; InputError where it may not be.

    Parameters
    ----------
    path : path
    overwrite : bool
        Whether a file that is there may be replaced; never one that is read.
    remedy : str
        What to do about a file that is there.
    inputs : paths
        What is read.
    name : str
        The argument that the path is of.
    """
    target = Path(os.path.realpath(path))
    folder, why = target.parent, ""
    if target.is_dir():
        why, remedy = "it is a folder", "Name a file in it"
    elif not folder.exists():
        why, remedy = f"there is no folder {folder}", "Make it first"
    elif not folder.is_dir():
        why, remedy = f"{folder} is not a folder", "Give another place"
    elif not os.access(folder, os.W_OK | os.X_OK):
        why, remedy = f"you may not write to {folder}", "Give a folder that you may write to"
    elif os.path.lexists(target) and not target.is_file():
        why, remedy = "there is something that is not a file", "Give another name"
    elif target.exists():
        read = [one for one in _files_of(inputs) if os.path.exists(one) and os.path.samefile(one, target)]
        if read:
            why, remedy = f"it would replace {os.fspath(read[0])}, which is read", "Give another name"
        elif not overwrite:
            why = "it is there already"
    if why:
        called = f"{argument(name)}={os.fspath(path)}" if name else os.fspath(path)
        raise InputError(f"cannot write {printable(called)} ({why}). {remedy}.")
    return target


def _remove(folder: str, owner: int) -> None:
    """Remove a folder, unless this process is a fork of its owner."""
    if os.getpid() == owner:
        shutil.rmtree(folder, ignore_errors=True)


def goes_with(thing: object, folder: str) -> Callable[[], object]:
    """Let a temporary folder go with an object of this process, or when the function that is returned is called."""
    return weakref.finalize(thing, _remove, folder, os.getpid())


@contextlib.contextmanager
def whole(path: File) -> Iterator[Path]:
    """Yield a name to write to, which becomes `path` once all is written: what is interrupted leaves nothing behind."""
    target = Path(os.path.realpath(path))
    part = target.with_name(f".{target.stem}.part{target.suffix}")
    try:
        yield part
        with open(part, "rb+") as file:
            os.fsync(file.fileno())
        part.replace(target)
    except OSError as error:
        error.filename = str(target)
        raise
    finally:
        part.unlink(missing_ok=True)
