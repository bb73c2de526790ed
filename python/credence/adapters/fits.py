"""What would make P of poses right: other options of its reader, each applied to the log."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from credence._errors import argument
from credence.adapters.frames import Poses, body_offset, errors_of, rotation, with_body
from credence.adapters.tables import Array, note

_most = 2000  # poses that are looked at


def spread_of(errors: Array, covariances: Array) -> tuple[float, float]:
    """NEES/n, and how far it is from 1 in the worst direction (the log of the ratio); inf where P is none."""
    try:
        whitened = np.linalg.solve(np.linalg.cholesky(covariances), errors[..., None])[..., 0]
    except np.linalg.LinAlgError:
        return np.inf, np.inf
    ratios = np.linalg.eigvalsh(whitened.T @ whitened / len(whitened))
    return float(ratios.mean()), float(np.abs(np.log(np.maximum(ratios, 1e-300))).max())


def ask_what_fits(runs: Sequence[tuple[Poses, Poses]], manifold: str, chart: str, moved: bool) -> bool:
    """Note the manifold, chart, order or offset of the body with which NEES/n is 1 in all directions where it is not as
    the log is read, the one that changes least; whether there is such a one."""
    every = 1 + sum(len(of.time) for of, _ in runs) // _most
    estimate, truth = (np.concatenate([run[i].pose[::every] for run in runs]) for i in (0, 1))
    P = np.concatenate([of.covariance[::every] for of, _ in runs if of.covariance is not None])
    if len(P) < 200 or P.shape[-1] != 6:
        return False
    forms = [(m, c) for m in ("SE3", "R3 x SO3") for c in ("local", "global")]
    forms.sort(key=lambda form: (form[0] != manifold) + (form[1] != chart))
    first = [3, 4, 5, 0, 1, 2]
    bodies = [(truth, "")]
    if not moved:
        T, E = rotation(truth[:, 3:]), rotation(estimate[:, 3:])
        place = T.inv().apply(estimate[:, :3] - truth[:, :3]).mean(axis=0)
        for offset in (place, np.r_[place, (T.inv() * E).mean().as_quat()]):
            at = with_body(Poses("", truth[:, 0], truth), body_offset(offset)).pose
            bodies.append((at, f"{argument('body')}={','.join(f'{one:.4g}' for one in offset)}"))
    orders = [("", P), (f"{argument('order')} 'rotation first'", P[:, first][:, :, first])]
    found = [
        (spread_of(errors_of(estimate, true, *form), of), form, [order, body])
        for true, body in bodies for order, of in orders for form in forms
    ]  # fmt: skip
    as_read, best = found[0][0], min(apart for (_, apart), _, _ in found)
    (ratio, apart), (m, c), others = next(one for one in found if one[0][1] <= 1.3 * best)
    if not 0.9 < ratio < 1.1 or apart > 0.5 or apart > 0.5 * as_read[1]:
        return False
    how = [f"{argument('manifold')} '{m}'" * (m != manifold), f"{argument('chart')} {c}" * (c != chart), *others]
    note(
        f"{runs[0][0].source}: NEES/n is {as_read[0]:.3g}, and would be {ratio:.3g} with "
        f"{' '.join(filter(None, how))}. Is that what its covariances are of?"
    )
    return True
