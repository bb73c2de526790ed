"""The log score of one run: of its errors beside their covariance, or of its innovations beside theirs."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from credence import InputError
from credence._trials import Array
from credence.judging import Verdict, judge

OBJECTIVES = ("errors", "innovations", "nees")


def _terms(error: Array, covariance: Array) -> tuple[Array, Array, Array]:
    """Components that are there, log det P and NEES of each step; NaN everywhere where a P is not positive definite."""
    error, covariance = error.astype(np.float64, copy=False), covariance.astype(np.float64, copy=False)
    there = ~np.isnan(error)
    count, error = there.sum(axis=1), np.where(there, error, 0)
    if covariance.ndim == 2:
        variance = np.where(there, covariance, 1)
        with np.errstate(all="ignore"):
            return count, np.log(variance).sum(axis=1), (error**2 / variance).sum(axis=1)
    if not there.all():  # a component that is not there is one of its own, with a variance of 1
        covariance = np.where(there[:, :, None] & there[:, None, :], covariance, np.eye(error.shape[1]))
    try:
        root = np.linalg.cholesky(covariance)
    except np.linalg.LinAlgError:
        return count, np.full(len(error), np.nan), np.full(len(error), np.nan)
    nees = (np.linalg.solve(root, error[..., None])[..., 0] ** 2).sum(axis=1)
    return count, 2 * np.log(np.diagonal(root, axis1=1, axis2=2)).sum(axis=1), nees


def step_scores(objective: str, arrays: Mapping[str, Array]) -> Array:
    """The score of each step of a run [step], whose mean is the run's: (n log 2 pi + log det P + NEES) / 2 in nats, the
    negative logarithm of a normal density, or NEES/n.

    NaN where nothing is there, and everywhere if one P is not positive definite.

    Raises
    ------
    InputError
        The run does not have what the objective needs.
    """
    first, second = ("innovation", "innovation_covariance") if objective == "innovations" else ("error", "covariance")
    if first not in arrays or second not in arrays:
        raise InputError(f"objective={objective}: the Run has no {first} beside a {second}. Give both, or another one.")
    steps = int(arrays["steps"]) if "steps" in arrays else len(arrays[first])
    count, size, nees = _terms(arrays[first][:steps], arrays[second][:steps])
    if not np.isfinite((size + nees)[count > 0]).all():
        return np.full(steps, np.nan)
    with np.errstate(invalid="ignore"):
        scores: Array = nees / count if objective == "nees" else (count * math.log(2 * math.pi) + size + nees) / 2
    return np.where(count > 0, scores, np.nan)


def judged_score(objective: str, verdict: Verdict) -> float:
    """The score of an objective that rests on errors, as the verdict has it."""
    found = verdict["log_score" if objective == "errors" else "nees_ratio"]["mean"]
    return math.nan if found is None else float(found)


def run_score(objective: str, arrays: Mapping[str, Array], texts: Mapping[str, Any]) -> float:
    """The score of a run, the mean over its steps: the log score in nats, or NEES/n; NaN where there is none.

    States on a manifold are judged, one run at a time, because their chart is the library's.
    """
    if objective != "innovations" and "error" not in arrays and "estimate" in arrays:
        record: dict[str, Any] = {name: array[None] for name, array in arrays.items() if "/" not in name}
        words = {name: text for name, text in texts["texts"].items() if name in ("manifold", "chart", "quaternion")}
        said = judge(**record, **words, segments="off", progress=False)
        return judged_score(objective, said)
    scores = step_scores(objective, arrays)
    scores = scores[~np.isnan(scores)]
    return float(scores.mean()) if scores.size else math.nan
