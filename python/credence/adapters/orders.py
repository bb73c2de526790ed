"""Covariances from their numbers in a row, in the orders in which programs write them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from credence._errors import InputError, argument, invalid, printable
from credence.adapters.tables import Array, from_upper, note

TRIANGLES = ("upper", "lower", "diagonals")
WORDS = (*TRIANGLES, "full", "rotation first", "signed roots")


def _places(triangle: str, n: int) -> NDArray[np.intp]:
    """Where each number of the upper triangle, row by row, stands in the order of a triangle."""
    rows, columns = np.triu_indices(n)
    if triangle == "lower":  # (0, 0), (1, 0), (1, 1), (2, 0), ...
        return np.asarray(columns * (columns + 1) // 2 + rows)
    if triangle == "diagonals":  # the diagonal, then (0, 1), (1, 2), ..., then (0, 2), ...
        apart = columns - rows
        return np.asarray(apart * n - apart * (apart - 1) // 2 + rows)
    return np.arange(len(rows))


def _rooted(values: Array) -> Array:
    return np.asarray(np.sign(values) * values**2)


def _positive(values: Array, triangle: str, n: int) -> float:
    """The share of matrices that are positive definite, beside components whose variance is a placeholder or 0."""
    matrices = from_upper(values[:, _places(triangle, n)], n)
    variances = np.diagonal(matrices, axis1=1, axis2=2)
    known = variances > 0
    both = known[:, :, None] & known[:, None, :]
    root = np.sqrt(np.where(known, variances, 1))
    scaled = np.where(both, matrices / root[:, :, None] / root[:, None, :], np.eye(n))
    beside = ~both & ~np.eye(n, dtype=bool) & (matrices != 0)
    good = known.any(axis=1) & ~beside.any(axis=(1, 2)) & (np.linalg.eigvalsh(scaled)[:, 0] > -1e-9)
    return float(good.mean())


def _found(source: str, values: Array, n: int, roots: bool) -> str:
    """The order of a triangle that was not said: the one in which the matrices are positive definite."""
    rows = np.flatnonzero(np.isfinite(values).all(axis=1))
    sample = values[rows[:: max(1, len(rows) // 1000)]]
    if n == 1 or not len(sample):
        return "upper"
    sample = _rooted(sample) if roots else sample
    shares = {triangle: _positive(sample, triangle, n) for triangle in TRIANGLES}
    best = max(shares.values())
    fit = [triangle for triangle in TRIANGLES if shares[triangle] > 0.9 * best]
    say = f"Say {argument('order')}"
    if not best:
        others = {} if roots else {each: _positive(_rooted(sample), each, n) for each in TRIANGLES}
        tried = [", ".join(shares) + " 0%", *(f"{each} of signed roots {share:.0%}" for each, share in others.items())]
        fitting = [f" '{each},signed roots'" for each, share in others.items() if share > 0.9]
        raise InputError(
            f"{source}: the covariances are positive definite in no order ({', '.join(tried)}). "
            f"{say}{fitting[0] if fitting else ', or give all numbers row by row'}."
        )
    first = sample[:, _places(fit[0], n)]
    also = [each for each in fit[1:] if each != "diagonals" and np.any(sample[:, _places(each, n)] != first)]
    if also:
        note(f"{source}: the covariances may be in the order {fit[0]} or {also[0]}: {fit[0]} is taken. {say} if not.")
    elif fit[0] != "upper":
        note(f"{source}: the covariances are positive definite in the order {fit[0]} alone, which is taken")
    return fit[0]


def words_of(order: str | Sequence[str] | None, *more: str) -> list[str]:
    """The words that say an order, of a text in which commas part them, or as they are; `more` are known besides."""
    words = [word.strip() for word in order.split(",") if word.strip()] if isinstance(order, str) else order or []
    if not isinstance(words, (list, tuple)):
        raise invalid("order", order, "must be words", "Give some, such as lower")
    words = [str(word) for word in words]
    for word in words:
        if word not in (*WORDS, *more):
            known = ", ".join((*WORDS, *more))
            raise InputError(f"{argument('order')}: unknown word {printable(word)}. Give some of {known}.")
    return words


def matrices_of(source: str, values: Array, n: int, words: Sequence[str] = (), turns: Sequence[int] = ()) -> Array:
    """Matrices [row, n, n] of n(n + 1)/2 numbers [row, …], a triangle, or of n², row by row.

    `words` say their order (docs/logs.md); `turns` are the components that are angles.
    """
    shapes = [word for word in words if word in (*TRIANGLES, "full")]
    is_full = values.shape[1] == n * n and n > 1
    if len(shapes) > 1 or (shapes and (shapes[0] == "full") != is_full and n > 1):
        has = f"{' and '.join(shapes)} cannot be the order of {values.shape[1]} numbers of {n} components"
        raise InputError(f"{argument('order')}: {has}. Give the one that they have.")
    roots = "signed roots" in words
    triangle = "full" if is_full else shapes[0] if shapes else _found(source, values, n, roots)
    values = _rooted(values) if roots else values
    matrices = values.reshape(-1, n, n) if is_full else from_upper(values[:, _places(triangle, n)], n)
    if "rotation first" not in words:
        return matrices
    if not turns:
        has = "rotation first: no component is an angle"
        raise InputError(f"{argument('order')}: {has}. Say which are ({argument('units')} NAME=rad).")
    first = np.argsort([*turns, *(i for i in range(n) if i not in turns)])
    return np.asarray(matrices[:, first][:, :, first])
