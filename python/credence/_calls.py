"""What all calls of the compiled module share: their progress, and what they say."""

from __future__ import annotations

import contextlib
import html
import importlib
import os
import signal
import sys
import time
import warnings
from collections.abc import Callable, Iterator
from typing import Any

from credence._errors import Failure


def note(message: str) -> None:
    """Warn at the line that called the package."""
    level, frame = 2, sys._getframe(1)
    while frame.f_back is not None and str(frame.f_globals.get("__name__")).startswith("credence."):
        level, frame = level + 1, frame.f_back
    warnings.warn(message, stacklevel=level)


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


def say(text: str) -> None:
    """Print a command's result; end the process as SIGPIPE does where nobody reads it."""
    try:
        if text:
            sys.stdout.write(text)
        sys.stdout.flush()
    except OSError as error:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # Python writes it once more at its end
        if isinstance(error, BrokenPipeError):
            sys.exit(128 + signal.SIGPIPE)
        raise Failure("cannot write to the standard output.") from None


_speaker = ""  # the command whose process this is


def speak_as(command: str) -> None:
    """Say progress by lines where there is no terminal, as the program does: this process is a command's."""
    global _speaker
    _speaker = command


class _Line:
    """Progress without tqdm, as the program says it: a line that is drawn anew, or one now and then elsewhere."""

    def __init__(self) -> None:
        self._is_terminal = sys.stderr.isatty()
        self._begun = time.monotonic()
        self._next = 0.5 if self._is_terminal else 10.0
        self._is_drawn = False

    def draw(self, done: int, total: int, said: str = "") -> None:
        seconds = time.monotonic() - self._begun
        if seconds < self._next or not done:
            return
        self._next = seconds + (0.2 if self._is_terminal else 30)
        of = f" of {total} trials ({100 * done / total:.0f} %)" if total else " trials"
        rest = f", {said}" if said else ""
        line = f"{done}{of}, {done / seconds:.0f} trials/s{rest}"
        with contextlib.suppress(OSError):
            sys.stderr.write(f"\r\x1b[K{line}" if self._is_terminal else f"{_speaker or 'credence'}: {line}\n")
            sys.stderr.flush()
        self._is_drawn = self._is_terminal

    def end(self) -> None:
        if self._is_drawn:
            sys.stderr.write("\r\x1b[K")
            sys.stderr.flush()


@contextlib.contextmanager
def progress_bar(shown: bool | None) -> Iterator[Callable[..., object] | None]:
    """Yield a function of the trials done, of their total and of what is said beside, which draws a bar; or None.

    With `shown` None it is drawn on a terminal and in a notebook only, and by a command everywhere.
    """
    tqdm = _tqdm(shown)
    if tqdm is None:
        is_shown = shown is not False and (shown or bool(_speaker) or _is_watched())
        line = _Line()
        try:
            yield line.draw if is_shown else None
        finally:
            line.end()
        return
    with tqdm(unit=" trials", unit_scale=True, leave=False, delay=0.5) as bar:

        def draw(done: int, total: int, said: str = "") -> None:
            bar.total = total
            bar.set_postfix_str(said, refresh=False)
            bar.update(done - bar.n)

        yield draw
