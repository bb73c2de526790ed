"""What a log has no word on: steps that cannot be judged, and variances that say "not known"."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from credence._errors import InputError
from credence.adapters.tables import Array, note

Rows = NDArray[np.bool_]


def placeholders(variances: Array) -> Rows:
    """Whether each variance [row, n] says "not known": -1 or so, from 10^6 on, or from 10^4 on and always the same."""
    never_changes = (variances >= 1e4).all(axis=0) & (variances == variances[:1]).all(axis=0)
    return np.asarray((variances < -0.5) | (variances >= 1e6) | never_changes)


def none_throughout(covariances: Sequence[Array]) -> Rows:
    """[n]: whether the variance of a component is none at any step of the runs, of covariances [row, n, n] each."""
    variances = np.concatenate([np.diagonal(each, axis1=1, axis2=2) for each in covariances])
    return np.asarray((placeholders(variances) | ~(variances > 0)).all(axis=0))


def variances_of(covariances: Array) -> Array:
    """[row, n] of variances [row, n] or covariances [row, n, n]"""
    return covariances if covariances.ndim == 2 else np.diagonal(covariances, axis1=1, axis2=2)


def without(covariances: Array, missing: Rows) -> Array:
    """Covariances that are NaN in the rows and columns of what is missing [row, n]."""
    if covariances.ndim == 2:
        return np.where(missing, np.nan, covariances)
    return np.where(missing[:, :, None] | missing[:, None, :], np.nan, covariances)


def held(flags: Rows, run: NDArray[np.intp]) -> Rows:
    """Where a flag [row, n] has held since the first row of its run; `run` [row] numbers the runs."""
    order = np.argsort(run, kind="stable")
    over = np.cumsum(~flags[order], axis=0)
    first = np.searchsorted(run[order], run[order])  # of each row's run
    before = np.where(first[:, None] > 0, over[first - 1], 0)
    since_start = np.empty_like(flags)
    since_start[order] = over == before
    return since_start


def not_known(
    source: str, errors: Array, variances: Array, names: Sequence[str], run: NDArray[np.intp]
) -> tuple[list[int], Rows, Rows]:
    """The components [index] whose variance is a number somewhere, where each is not in the state yet [row, n], and
    the later rows at which P says "not known" of one.

    Errors and variances [row, n] are in the units of the log. A variance from 10^4 on is a placeholder only if it is
    far beyond the squared errors of the component.
    """
    finite = [column[np.isfinite(column)] for column in errors.T]
    usual = np.array([np.median(np.abs(column)) ** 2 if len(column) else 0.0 for column in finite])
    flags = placeholders(variances) & ~((variances > 0) & (variances < 1e4 * usual))
    starts = held(flags, run)
    kept = [i for i in range(len(names)) if not flags[:, i].all()]
    if not kept:
        why = "all its variances are placeholders, such as -1 or 10^6"
        raise InputError(f"{source}: it has no covariances ({why}). Give a log that has them.")
    for i, name in enumerate(names):
        if i not in kept:
            note(f"{source}: {name}: not judged (its variance is a placeholder throughout, {variances[0, i]:.3g})")
        elif starts[:, i].any():
            count, at = f"{starts[:, i].sum()} of {len(starts)} steps", variances[np.argmax(starts[:, i]), i]
            note(f'{source}: {name}: left out of {count}, at the start: P says "not known" (a variance of {at:.3g})')
    later = (flags & ~starts & (variances > 0))[:, kept].any(axis=1)  # one below 0 is a failure there
    return kept, starts, np.asarray(later)


def say_left_out(source: str, count: int, reasons: Mapping[str, Rows]) -> Rows:
    """The rows that cannot be judged, by the first reason that each has, and a note of how many and why."""
    left = np.zeros(count, dtype=bool)
    told = []
    for reason, rows in reasons.items():
        if (rows & ~left).any():
            told.append(f"{(rows & ~left).sum()} {reason}")
        left |= rows
    if count and left.all():
        raise InputError(f"{source}: none of its {count} steps can be judged ({', '.join(told)}). Check its columns.")
    if left.any():
        note(f"{source}: {left.sum()} of {count} steps cannot be judged, and are left out: {', '.join(told)}")
    return left
