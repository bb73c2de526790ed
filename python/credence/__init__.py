"""Can a filter's covariance be believed? Nothing is imported before it is used."""

from __future__ import annotations

import importlib
from typing import Any

_homes = {
    "Arm": "arm",
    "Scenario": "study",
    "Study": "study",
    "animate": "pictures",
    "open": "study",
    "open_trajectories": "trajectory",
    "plot": "pictures",
}

__all__ = sorted(_homes)


def __getattr__(name: str) -> Any:
    if name not in _homes:
        raise AttributeError(f"module 'credence' has no attribute {name!r}")
    return getattr(importlib.import_module(f"credence.{_homes[name]}"), name)
