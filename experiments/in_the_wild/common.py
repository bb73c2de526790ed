"""What the studies share: how one is described, what makes a filter wrong, and NEES as NumPy computes it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

Record = dict[str, Any]  # the arguments of credence.judge


@dataclass(frozen=True)
class Filter:
    """One filter of a study, and what its verdict must be. Filters with the same options stand together."""

    name: str
    expected: str
    options: Mapping[str, Any] = field(default_factory=dict)  # of the study's trial()
    fault: Callable[[Record], Record] | None = None  # what is then made wrong on purpose
    says: str = ""  # words that its report must have
    expected_short: str = ""  # with fewer trials and wider margins; the same as `expected` where it is empty
    says_short: str = ""  # likewise
    trials: int = 0  # where it needs others than its study


@dataclass(frozen=True)
class Study:
    """A filter that others wrote, from the example of its library to verdicts."""

    library: str
    name: str
    module: str
    trials: int
    trials_short: int
    filters: tuple[Filter, ...]
    batch: bool = False  # whether its function takes many generators


def halved(record: Record) -> Record:
    """P / 2: the filter believes too much of itself."""
    return record | {"covariance": record["covariance"] / 2}


def of_half_angles(record: Record) -> Record:
    """P of a quaternion's vector part, which is half the angle, in place of the rotation vector's."""
    return record | {"covariance": record["covariance"] / 4}


def without_correlations(record: Record) -> Record:
    """P with its groups' blocks alone, or with its variances alone where there are no groups."""
    covariance = record["covariance"]
    kept = np.zeros(covariance.shape[-2:], dtype=bool)
    for group in record.get("groups", {str(i): [i] for i in range(len(kept))}).values():
        kept[np.ix_(list(group), list(group))] = True
    return record | {"covariance": np.where(kept, covariance, 0)}


def in_world_frame(record: Record) -> Record:
    """Errors of planar poses as plain differences of coordinates, beside P of the body's frame."""
    error = record["estimate"] - record["truth"]
    error[..., 2] = (error[..., 2] + np.pi) % (2 * np.pi) - np.pi
    return {"error": error} | {name: record[name] for name in ("covariance", "component_names", "component_units")}


def nees(error: np.ndarray, covariance: np.ndarray) -> np.ndarray:
    """e' P^-1 e of each trial and step."""
    return np.einsum("tki,tki->tk", error, np.linalg.solve(covariance, error[..., None])[..., 0])
