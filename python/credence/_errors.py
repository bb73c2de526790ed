"""The errors of the package, and how its messages call an argument [CONTRIBUTING.md, Errors]."""

from __future__ import annotations

import contextlib
from collections.abc import Collection, Iterator


class _Complaint(Exception):
    """A message, and what it is made of, where that is known."""

    place = ""  # where it is, such as study.ini:3
    subject = ""  # the name of the refused value, or a whole such as "cannot write a.h5"
    value: str | None = None  # of a refused value
    reason = ""
    remedy = ""


class InputError(_Complaint, ValueError):
    """An argument or a file cannot be used; nothing has been computed or written.

    Attributes
    ----------
    place, subject, value, reason, remedy : str
        What the message is made of: ``PLACE: invalid SUBJECT=VALUE (REASON). REMEDY.``; empty where it is one text.
    """


class Failure(_Complaint, RuntimeError):
    """The work itself failed. Its attributes are those of `InputError`."""


InputError.__module__ = Failure.__module__ = "credence"

_options: Collection[str] = ()  # of the command whose process this is


@contextlib.contextmanager
def options_of(names: Collection[str]) -> Iterator[None]:
    """Call arguments by the options of a command that has these."""
    from credence import _core

    global _options
    _options = names
    _core.speak_of_options(True)
    try:
        yield
    finally:
        _options = ()
        _core.speak_of_options(False)


def argument(name: str) -> str:
    """How a message calls an argument: `max_gap`, or `--max-gap` in a command that has this option."""
    if name not in _options:
        return name
    return "-o" if name == "output" else "--" + name.replace("_", "-")


def printable(given: object) -> str:
    """What was given, fit for a message of one line."""
    text = given if isinstance(given, str) else repr(given)
    return "".join(c if c.isprintable() else ascii(c)[1:-1] for c in text)[:100]


def invalid(name: str, value: object, why: str, remedy: str) -> InputError:
    """The error that refuses the value of an argument."""
    error = wrong(name, why, remedy, f"={printable(value)}")
    error.value = printable(value)
    return error


def wrong(name: str, why: str, remedy: str, shown: str = "") -> InputError:
    """The error that refuses an argument, whose value would be too long to show."""
    error = InputError(f"invalid {argument(name)}{shown} ({why}). {remedy}.")
    error.subject, error.reason, error.remedy = argument(name), why, remedy
    return error
