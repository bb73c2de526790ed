"""What `report`, `compare`, `plot` and `open` take: results, whoever made them."""

from __future__ import annotations

import abc
from typing import Any, NamedTuple


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
