"""What all calls of the compiled module share: their progress, and errors that name arguments."""

from __future__ import annotations

import contextlib
import html
import importlib
import re
import shlex
import sys
from collections.abc import Callable, Iterator
from typing import Any

from credence import _core

_FUNCTIONS = ("run", "report", "judge", "compare", "replay", "merge", "show")
_SWITCHES = {"overwrite": "overwrite=True", "force": "force=True", "resume": "credence.resume()",
             "dry-run": "`credence run --dry-run`"}  # fmt: skip
_OPTION = r"(?<![^\s(,=])(?:--([a-z]+(?:-[a-z]+)*)|-o\b(?!\w))"
_VALUE = r"(?:[= ]([0-9.]+%?|[A-Z](?:,[A-Z])+|aggregates|trials|consistent|no-finding)(?=[\s,;:)]|\.?$|\. ))?"


def _call(command: re.Match[str]) -> str:
    """A command line in backticks as a call of the function of that name, where there is one."""
    name, *words = shlex.split(command[1])
    if name not in _FUNCTIONS:
        return command[0]
    if words == ["--help"]:
        return f"help(credence.{name})"
    if "--resume" in words:
        return "credence.resume()"
    options = [i for i, word in enumerate(words) if word.startswith("--")]
    given = [f"{words[i][2:]}={words[i + 1]!r}" for i in options if i + 1 < len(words)]
    paths = [repr(word) for i, word in enumerate(words) if not {i, i - 1} & {*options}]
    return f"credence.{name}({', '.join(paths + given)})"


def _argument(option: re.Match[str]) -> str:
    """An option as an argument, with its value where it has one."""
    name, value = option[1] or "output", option[2]
    if value is not None:
        return f"{name.replace('-', '_')}={value if value.replace('.', '').isdigit() else repr(value)}"
    return _SWITCHES.get(name, name.replace("-", "_"))


def said(message: str) -> str:
    """Return a message of the program with its commands as calls, and its options as arguments."""
    message = re.sub(r"`credence ([a-z]+(?: [^`]*)?)`", _call, message)
    message = re.sub(r"--(set|sweep) ([\w.]+)=(\S*[^\s.;)])", r'\1={"\2": "\3"}', message)
    return re.sub(_OPTION + _VALUE, _argument, message)


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
