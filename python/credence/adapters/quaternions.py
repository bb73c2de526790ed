"""Covariances of quaternions, which have four numbers and three directions."""

from __future__ import annotations

import re
from typing import Any

import numpy as np

from credence._arrays import numbers
from credence._errors import InputError, argument, invalid
from credence.adapters.tables import Array, normalised, note


def tangent(states: Array, covariance: Array, manifold: str, chart: str, quaternion: str = "xyzw") -> Array:
    """Covariances [..., n, n] of the errors, from those [..., q, q] of the coordinates."""
    maps: list[Array] = []
    column = 0
    for factor in manifold.split(" x "):
        if not re.fullmatch(r"R\d+|SO[23]", factor):
            raise invalid(
                "manifold", manifold, f"a covariance of a quaternion is not that of {factor}", "Give R3 x SO3, for one"
            )
        size = 4 if factor == "SO3" else int(factor[1:]) if factor[0] == "R" else 1
        columns = slice(column, column + size)
        J = _to_rotation(states[..., columns], chart, quaternion) if factor == "SO3" else np.eye(size)
        maps.append(np.zeros((*states.shape[:-1], J.shape[-2], states.shape[-1])))
        maps[-1][..., columns] = J
        if factor == "SO3":
            q = normalised(states[..., columns])
            along = np.einsum("...i,...ij,...j", q, covariance[..., columns, columns], q)
            note(
                "the covariance of a quaternion is judged in the three directions that turn; the fourth, its length, "
                f"has sigmas up to {np.sqrt(max(0.0, np.nanmax(along))):.3g}, and is left out"
            )
        column += size
    J = np.concatenate(maps, axis=-2)
    reduced: Array = J @ covariance @ np.swapaxes(J, -1, -2)
    return reduced


def _to_rotation(quaternions: Array, chart: str, order: str) -> Array:
    """[..., 3, 4]: what a difference dq of a quaternion is as a rotation vector: 2 vec(q* dq) in the body's frame,
    2 vec(dq q*) in the world's [Sola 2017, 4.3]."""
    scalar, first = (0, 1) if order == "wxyz" else (3, 0)
    q = normalised(quaternions)
    v, w = q[..., first : first + 3], q[..., scalar]
    G = np.zeros((*q.shape[:-1], 3, 4))
    G[..., scalar] = -v
    G[..., first : first + 3] = w[..., None, None] * np.eye(3)
    G[..., first : first + 3] += np.cross(np.eye(3), -v[..., None, :]) * (1 if chart == "local" else -1)
    return 2 * G


def quaternion_at(values: Array) -> int | None:
    """Where in [..., q] four numbers begin that are of length 1 and change, as those of a quaternion."""
    rows = values.reshape(-1, values.shape[-1])
    rows = rows[np.isfinite(rows).all(axis=1)]
    for i in range(rows.shape[1] - 3 if len(rows) > 1 else 0):
        four = rows[:, i : i + 4]
        if np.abs(np.linalg.norm(four, axis=1) - 1).max() < 1e-3 and np.ptp(four, axis=0).max() > 0:
            return i
    return None


def from_quaternions(**arguments: Any) -> dict[str, Any]:
    """Arguments of :func:`credence.judge` with the covariance of the four numbers of a quaternion.

    Parameters
    ----------
    **arguments
        As `judge` takes them: `truth` and `estimate` [trial, step, q] on a `manifold` of ``R``, ``SO2`` and ``SO3``,
        such as ``"R3 x SO3"``, `chart`, `quaternion`, and `covariance` [trial, step, q, q] of the coordinates.

    Returns
    -------
    dict
        The same with `covariance` [trial, step, n, n] of the errors in the chart. A note names what is left out: the
        length of the quaternion.

    Raises
    ------
    InputError
        If the covariances are not of the coordinates, or the manifold has other factors.
    """
    for name in ("estimate", "covariance", "manifold", "chart", "quaternion"):
        if arguments.get(name) is None:
            raise InputError(f"there is no {argument(name)}. Give the arguments of judge.")
    states, P = (numbers(name, arguments[name]).astype(float) for name in ("estimate", "covariance"))
    if P.shape != (wanted := (*states.shape, states.shape[-1])):
        raise InputError(f"the covariances have the shape {P.shape} (must be {wanted}). Give those of the coordinates.")
    how = [arguments[name] for name in ("manifold", "chart", "quaternion")]
    return arguments | {"covariance": tangent(states, P, *how)}
