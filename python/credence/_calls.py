"""What all calls of the compiled module share: their progress, and errors that name arguments."""

from __future__ import annotations

import contextlib
import html
import importlib
import re
import sys
from collections.abc import Callable, Iterator
from typing import Any

from credence import _core


def said(message: str) -> str:
    """Return a message of the program with its options as the names of arguments."""
    return re.sub(r"(?<![\w`-])--([a-z]+(?:-[a-z]+)*)", lambda option: option[1].replace("-", "_"), message)


def said_of_arrays(message: str) -> str:
    """Return the same with the places of a record, such as ``/error`` and ``/@groups``, as the names of arguments."""
    return re.sub(r"(?<![\w./])/@?(?=[a-z])", "", said(message))


@contextlib.contextmanager
def errors_of_arguments(said: Callable[[str], str] = said) -> Iterator[None]:
    """Raise the program's errors with the names of arguments."""
    try:
        yield
    except (_core.InputError, _core.Failure) as error:
        raise type(error)(said(str(error))) from None


def framed(page: str) -> str:
    """Return a page as a part of a notebook, whose styles it does not touch."""
    return f'<iframe srcdoc="{html.escape(page)}" width="100%" height="600" style="border: 0"></iframe>'


def _is_watched() -> bool:
    """Whether a progress bar can be seen: on a terminal, or in a notebook."""
    shell = sys.modules.get("IPython")
    return sys.stderr.isatty() or (shell is not None and type(shell.get_ipython()).__name__ == "ZMQInteractiveShell")


def _tqdm(shown: bool | None) -> Any:
    """Return tqdm where a bar is to be drawn and it is installed; None otherwise."""
    if shown is False or (shown is None and not _is_watched()):
        return None
    try:
        return importlib.import_module("tqdm.auto").tqdm
    except ImportError:
        return None


@contextlib.contextmanager
def progress_bar(shown: bool | None) -> Iterator[Callable[..., object] | None]:
    """Yield a function of the trials done, of their total and of what is said beside, which draws a bar; or None.

    With `shown` None it is drawn on a terminal and in a notebook only.
    """
    tqdm = _tqdm(shown)
    if tqdm is None:
        yield None
        return
    with tqdm(unit=" trials", unit_scale=True, leave=False, delay=0.5) as bar:

        def draw(done: int, total: int, said: str = "") -> None:
            bar.total = total
            bar.set_postfix_str(said, refresh=False)
            bar.update(done - bar.n)

        yield draw
