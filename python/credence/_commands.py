"""The edge of the commands that are written in Python: signals, errors, warnings and streams that fail become a line
and an exit code [docs/running.md, The commands].
"""

from __future__ import annotations

import contextlib
import importlib
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import argparse

    Command = Callable[[argparse.Namespace], int]
    Main = Callable[[Sequence[str]], int]

COMMANDS = ("simulate", "judge", "tune")
STOPPED = {"simulate": 3, "judge": 130, "tune": 130}  # exit codes: what simulate has done is kept
_stops = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


def _stop(*_: object) -> None:
    raise KeyboardInterrupt


def _ignore_stops() -> None:
    for number in _stops:
        if signal.getsignal(number) is _stop:
            signal.signal(number, signal.SIG_IGN)


def _stop_again(lost: sys.UnraisableHookArgs) -> None:
    """Stop a little later where a signal came in the middle of what cannot raise, such as a weak reference's end."""
    if issubclass(lost.exc_type, KeyboardInterrupt):
        threading.Timer(0.05, os.kill, (os.getpid(), signal.SIGTERM)).start()
    else:
        sys.__unraisablehook__(lost)


@contextlib.contextmanager
def _held() -> Iterator[None]:
    """Hold signals back, since an import must not be interrupted in its middle. Afterwards each of them stops the work,
    unless the parent of this process ignores it."""
    came: list[int] = []
    taken = [one for one in _stops if signal.getsignal(one) in (signal.SIG_DFL, signal.default_int_handler)]
    for number in taken:
        signal.signal(number, lambda number, _: came.append(number))
    yield
    for number in taken:
        signal.signal(number, _stop)
    if came:
        raise KeyboardInterrupt


def _say(name: str, message: object) -> None:
    with contextlib.suppress(OSError):
        print(f"credence {name}: {message}", file=sys.stderr, flush=True)


def _code_of(name: str, main: Main, words: Sequence[str]) -> int:
    """Run a command; the exit code, its own or that of its error."""
    from credence import Failure, InputError
    from credence._calls import say
    from credence._doors import said_of_system

    try:
        code = main(words)
        say("")
        return code
    except (InputError, Failure, MemoryError, OSError) as error:
        said: Exception = error
        if isinstance(error, OSError):
            said = said_of_system(error) or error
        elif isinstance(error, MemoryError):
            said = Failure("out of memory. Ask for less, or run it where there is more.")
        _say(name, said)
        return 2 if isinstance(said, InputError) else 1


def command(parser: Callable[[], argparse.ArgumentParser], positional: str) -> Callable[[Command], Main]:
    """Make a function of a command line a command, whose messages call arguments by its options."""

    def made(work: Command) -> Main:
        def main(words: Sequence[str]) -> int:
            from credence._errors import options_of

            given = parser().parse_args(words)
            with options_of(vars(given).keys() - {positional}):
                return work(given)

        return main

    return made


def obeyed(name: str, words: Sequence[str]) -> int | None:
    """Run a command and return its exit code; None where the words are for the program."""
    before = {number: signal.getsignal(number) for number in _stops}
    try:
        with _held():
            import warnings

            from credence import _calls

            module = importlib.import_module(f"credence._{name}_command")
            is_ours = name != "judge" or module.is_for_adapters(words)
        if not is_ours:
            for number, handler in before.items():
                signal.signal(number, handler)
            return None
        by_python = warnings.showwarning
        warnings.showwarning = lambda message, category, *place, **more: (
            _say(name, message) if category is UserWarning else by_python(message, category, *place, **more)
        )
        sys.unraisablehook = _stop_again
        _calls.speak_as(f"credence {name}")
        return _code_of(name, module.main, words)
    except KeyboardInterrupt:
        _ignore_stops()  # one that `_stop_again` sends may still come
        _say(name, "it was stopped.")
        return STOPPED[name]
    finally:  # at Python's end nothing is left to stop
        _ignore_stops()
