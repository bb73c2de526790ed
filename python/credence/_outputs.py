"""Files that are written: whether one may be written, and how it appears whole under its name."""

from __future__ import annotations

import contextlib
import os
import shutil
import weakref
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

from credence._errors import InputError

File = str | os.PathLike[str]


def _refused(path: File, why: str, remedy: str) -> InputError:
    return InputError(f"cannot write {os.fspath(path)} ({why}). {remedy}.")


def _files_of(inputs: Iterable[File]) -> Iterator[File]:
    """What is read: the files themselves, and those in folders, such as bags."""
    for one in inputs:
        yield one
        for folder, _, names in os.walk(one):
            yield from (os.path.join(folder, name) for name in names)


def check_output(
    path: File, overwrite: bool = False, remedy: str = "Give another name or --overwrite", inputs: Iterable[File] = ()
) -> Path:
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
    """
    target = Path(os.path.realpath(path))
    if not target.parent.is_dir():
        raise _refused(path, f"there is no folder {target.parent}", "Make it first")
    if not os.access(target.parent, os.W_OK | os.X_OK):
        raise _refused(path, f"you may not write to {target.parent}", "Give a folder that you may write to")
    if not os.path.lexists(target):
        return target
    if not target.is_file():
        raise _refused(path, "there is something that is not a file", "Give another name")
    for one in _files_of(inputs):
        if os.path.exists(one) and os.path.samefile(one, target):
            raise _refused(path, f"it would replace {os.fspath(one)}, which is read", "Give another name")
    if not overwrite:
        raise _refused(path, "it is there already", remedy)
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
