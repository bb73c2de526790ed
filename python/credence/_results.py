"""Results, whoever made them, which `report`, `compare`, `plot` and `open` take; and what is said of them."""

from __future__ import annotations

import abc
import json
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Generic, NamedTuple, TypeVar

if TYPE_CHECKING:
    from credence import _core

T = TypeVar("T")


class cached(Generic[T]):  # it is used as a word, as property is
    """A property that is computed once, as `functools.cached_property`. That one holds a lock before Python 3.12, for
    which the child of a fork in the middle of it would wait forever."""

    def __init__(self, work: Callable[[Any], T]) -> None:
        self._work = work
        self.__doc__ = work.__doc__

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    def __get__(self, instance: Any, owner: type | None = None) -> T:
        if instance is None:
            return self  # type: ignore[return-value]
        value = instance.__dict__[self._name] = self._work(instance)
        return value


class Sources(NamedTuple):
    """The files that results are in, as the program takes them: a results file, or records by their arms."""

    study: str = ""
    records: dict[str, str] = {}  # noqa: RUF012  # of a tuple, never changed


class Results(abc.ABC):
    """Arms with their trials: a study that was run, what `simulate` gives or one arm of it, or records in files."""

    limit: float | str | None = None  #: The share of failed trials that they were made with.

    @property
    @abc.abstractmethod
    def study(self) -> Any:
        """The columns and series of the arms, as a Study."""

    @abc.abstractmethod
    def sources(self) -> Sources:
        """The files; InputError where they are not there as they were."""


class Printed:
    """What a command says of files, or of arrays, as they were: ``str()`` is the text that it prints, and a notebook
    shows its page. Pickled, it says the same in another process.

    Attributes
    ----------
    json : list of dict
        What the command prints with ``--format json``, the same bits.
    """

    def __init__(self, said: _core.Said | dict[str, str]) -> None:
        self._said = said

    def _in(self, form: str) -> str:
        return self._said[form] if isinstance(self._said, dict) else self._said.in_format(form)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), ({form: self._in(form) for form in ("text", "json", "html")},)

    @cached
    def json(self) -> list[dict[str, Any]]:
        found: list[dict[str, Any]] = json.loads(self._in("json"))
        return found

    def __str__(self) -> str:
        return self._in("text")

    @property
    def html(self) -> str:
        """The page that the command writes with ``--format html``; it loads nothing and runs no script."""
        return self._in("html")

    def _repr_html_(self) -> str:
        from credence._calls import framed

        return framed(self.html)
