"""The edge of the package: arguments are checked by their names before any work, and what the operating system refuses
becomes `InputError` or `Failure` [CONTRIBUTING.md, Errors].
"""

from __future__ import annotations

import contextlib
import errno
import functools
import importlib
import inspect
import os
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any, TypeVar

from credence._errors import Failure, InputError, invalid, printable
from credence._names import not_utf8
from credence._outputs import check_output

Function = TypeVar("Function", bound=Callable[..., Any])
Check = Callable[[str, Any], Any]  # of the name and the value of an argument: returns what is taken, or raises

_space = "Free some space, or write to another place"
_others = "Write to a folder that you may write to"
_remedies = {
    errno.ENOSPC: _space,
    errno.EDQUOT: _space,
    errno.EFBIG: "Raise the limit on the size of files (ulimit -f), or write to another place",
    errno.EACCES: _others,
    errno.EPERM: _others,
    errno.EROFS: _others,
    errno.ENOENT: "Check the path, or make its folder first",
    errno.EMFILE: "Raise the limit on open files (ulimit -n)",
    errno.ENOMEM: "Run it where there is more memory",
}
_of_input = (errno.ENOENT, errno.ENOTDIR, errno.EISDIR, errno.EACCES, errno.EPERM, errno.ENAMETOOLONG, errno.ELOOP)


# What arguments of many functions have to be.


def whole(least: int = 0, most: int = 2**53) -> Check:
    """A whole number in a range, of any type that has its value."""

    def check(name: str, value: Any) -> int:
        number = getattr(value, "item", lambda: value)() if getattr(value, "ndim", None) == 0 else value
        is_whole = isinstance(number, (int, float)) and not isinstance(number, bool) and number == number // 1
        if not is_whole or not least <= number <= most:
            raise invalid(name, value, f"must be a whole number from {least} to {most}", "Give one in that range")
        return int(number)

    return check


def flag(name: str, value: Any) -> bool:
    if type(value).__name__ not in ("bool", "bool_"):
        raise invalid(name, value, "must be True or False", "Give one of them")
    return bool(value)


def above_zero(name: str, value: Any) -> Any:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not 0 < value <= 1e9:
        raise invalid(name, value, "must be a number above 0 and at most 1e9", "Give one, or leave it out")
    return value


def title(name: str, value: Any) -> str:
    """A text that may be the name of a file, which need not be UTF-8."""
    if not isinstance(value, str) or not value:
        raise invalid(name, value, "must be a text", "Give one, or leave it out")
    return value


def text(name: str, value: Any) -> str:
    return str(plain(name, title(name, value)))


def plain(name: str, value: Any) -> Any:
    """Anything but a text that cannot be written as UTF-8."""
    if isinstance(value, str) and not_utf8(value):
        raise invalid(name, value, "is not UTF-8", "Give another text")
    return value


def path(name: str, value: Any) -> Any:
    if not isinstance(value, (str, os.PathLike)):
        raise invalid(name, value, "must be a path", "Give that of a file")
    given = os.fspath(value)
    if not given or "\0" in os.fsdecode(given):
        raise invalid(name, value, "is no path", "Give that of a file")
    return value


def output(name: str, value: Any) -> Any:
    """A file that is to be written once the work is done: its folder is there before."""
    check_output(path(name, value), overwrite=True, name=name)
    return value


def mapping(example: str) -> Check:
    """A dict whose keys are names."""

    def check(name: str, value: Any) -> Any:
        if not isinstance(value, Mapping):
            raise invalid(name, value, "must be a dict", f"Give one, such as {example}")
        for key in value:
            if not isinstance(key, str) or not key:
                raise invalid(name, value, f"{printable(key)} is not a name", f"Give texts, such as {example}")
        return value

    return check


def planners(name: str, value: Any) -> Any:
    """Functions by names; as the library takes them [credence._planners]."""
    from credence._planners import asked

    return asked(value)


def texts(name: str, value: Any) -> Any:
    """A text, or several."""
    each = [value] if isinstance(value, str) else value
    if not isinstance(each, Sequence) or not each or not all(isinstance(one, str) and one for one in each):
        raise invalid(name, value, "must be texts", "Give a list of them")
    return value


def paths(name: str, value: Any) -> Any:
    """A path, or several."""
    each = [value] if isinstance(value, (str, os.PathLike)) else value
    if not isinstance(each, Sequence) or isinstance(each, bytes) or not each:
        raise invalid(name, value, "must be a path, or a list of them", "Give those of files")
    for one in each:
        path(name, one)
    return value


def file_or(*kinds: str) -> Check:
    """A path, or one of our own objects, such as a Study."""
    both = " or ".join(("a path", *(f"a {kind}" for kind in kinds)))

    def check(name: str, value: Any) -> Any:
        if isinstance(value, (str, os.PathLike)):
            return path(name, value)
        if not any(kind.__name__ in kinds for kind in type(value).__mro__):
            raise invalid(name, value, f"must be {both}", "Give one")
        return value

    return check


def source(name: str, value: Any) -> Any:
    """A path, or an open file."""
    return value if hasattr(value, "read") else path(name, value)


def sweep(name: str, value: Any) -> Any:
    example = '{"noise.heading": [0.01, 0.02]}'
    for key, each in mapping(example)(name, value).items():
        if not isinstance(each, Iterable) or (isinstance(each, str) and not each):
            raise invalid(name, value, f"{printable(key)} has no list of values", f"Give one, such as {example}")
    return value


def executor(name: str, value: Any) -> Any:
    """A number of processes, or what has the `submit` of `concurrent.futures`."""
    if isinstance(value, int) and not isinstance(value, bool):
        return whole(1, 2**20)(name, value)
    if not callable(getattr(value, "submit", None)):
        raise InputError(f"invalid {name} of {type(value).__name__} (it has no submit). Give a number of processes, or "
                         "an executor of concurrent.futures.")  # fmt: skip
    return value


def goals(name: str, value: Any) -> Any:
    """Means and the half-widths to which they are to be known."""
    if isinstance(value, Mapping):
        return mapping('{"nees_ratio": "1%"}')(name, value)
    given = [value] if isinstance(value, str) else value
    if not isinstance(given, Sequence) or not given or not all(isinstance(one, str) for one in given):
        remedy = 'Give one, such as {"nees_ratio": "1%"} or "nees_ratio=1%"'
        raise invalid(name, value, "is no number with a half-width", remedy)
    return value


# Errors of the system.


def said_of_system(error: OSError) -> InputError | Failure | None:
    """What to say of a file, or of the system; None where the error has words of its own."""
    number = error.errno
    if number is None:
        return None
    given = error.filename if error.filename2 is None else error.filename2
    named = re.search(r"name = '([^']+)'", str(error))  # HDF5 names the file in its text alone
    what = printable(os.fsdecode(given)) if isinstance(given, (str, bytes)) else named[1] if named else "a file"
    verb = "access" if number == errno.ENOENT else "write" if number in _remedies else "use"
    kind = InputError if number in _of_input else Failure
    said = f"cannot {verb} {what} ({os.strerror(number)}). {_remedies.get(number, 'Give another path')}."
    return kind(said)


@contextlib.contextmanager
def errors_of_system() -> Iterator[None]:
    """Raise what the system refuses as `InputError`, where another path will do, or as `Failure`."""
    try:
        yield
    except OSError as error:
        found = said_of_system(error)
        if found is None:
            raise
        raise found from error


def door(**checks: Check) -> Callable[[Function], Function]:
    """Make a function check these arguments before it does anything. What is left at a default is not checked."""

    def made(function: Function) -> Function:
        signature = inspect.signature(function)

        @functools.wraps(function)
        def entered(*arguments: Any, **named: Any) -> Any:
            __tracebackhide__ = True
            try:
                bound = signature.bind(*arguments, **named)
            except TypeError:
                return function(*arguments, **named)  # Python's own words
            for name, check in checks.items():
                default = signature.parameters[name].default
                if name in bound.arguments and bound.arguments[name] is not default:
                    bound.arguments[name] = check(name, bound.arguments[name])
            with errors_of_system():
                return function(*bound.args, **bound.kwargs)

        return entered  # type: ignore[return-value]

    return made


def needed(module: str, package: str, what: str) -> Any:
    """A module that only some functions need, and which is imported when they do."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        raise InputError(f"cannot {what} ({error}). Install it: pip install {package}.") from None
