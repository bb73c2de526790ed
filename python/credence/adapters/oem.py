"""Arguments of :func:`credence.judge` from orbits: CCSDS Orbit Ephemeris Messages, read by `oem`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from credence._errors import InputError
from credence.adapters.tables import Array, Path, needed, note, one_line, paired, same_time, stacked

_names = [f"{of}{axis}" for of in ("", "v_") for axis in ("radial", "transverse", "normal")]


def _axes(frame: str, state: Array) -> Any:
    """[6, 6]: for position and for velocity the unit vectors of a frame that moves with an orbit, one a row [CCSDS
    502.0-B-3, annex B]: R, T, N, of which R is radial and N normal to the orbit, or T, N, W, of which T is along the
    velocity; None of others."""
    position, velocity = state[:3], state[3:]
    normal = np.cross(position, velocity)
    normal /= np.linalg.norm(normal)
    if frame.partition("_")[0] in ("RTN", "RSW", "RIC"):
        radial = position / np.linalg.norm(position)
        return np.kron(np.eye(2), np.stack([radial, np.cross(normal, radial), normal]))
    if frame.partition("_")[0] == "TNW":
        along = velocity / np.linalg.norm(velocity)
        return np.kron(np.eye(2), np.stack([along, np.cross(normal, along), normal]))
    return None


def _read(path: Path, start: Any = None) -> tuple[Any, list[tuple[Any, Array, Array]]]:
    """A time, by default that of the first state, and the segments, with the times since then (s) and states [step, 6]
    (km, km/s) of each."""
    oem = needed("oem", "oem", "read orbits")
    try:
        read = [(one, list(one.states)) for one in oem.OrbitEphemerisMessage.open(str(path)).segments]
        start = start or read[0][1][0].epoch
        return start, [
            (
                one,
                np.array([(each.epoch - start).sec for each in states]),
                np.array([each.vector[:6] for each in states]),
            )
            for one, states in read
        ]
    except Exception as error:  # what its parser runs into
        raise InputError(f"{path}: it cannot be read as an OEM ({one_line(error)}). Check the path.") from None


def _state(path: Path, orbit: list[tuple[Any, Array, Array]], epoch: Any, time: float, frame: tuple[str, str]) -> Any:
    """The state [6] at a time, which the message's own method interpolates; None where it has none."""
    for segment, times, states in orbit:
        nearest = int(np.argmin(np.abs(times - time)))
        known = abs(times[nearest] - time) <= same_time
        if not known and epoch not in segment:
            continue
        if (own := (segment.metadata["REF_FRAME"], segment.metadata["CENTER_NAME"])) != frame:
            raise InputError(f"{path}: its states are in {own}, those of the estimate in {frame}. Convert one.")
        return states[nearest] if known else np.array(segment(epoch).vector[:6])
    return None


def from_oem(estimate: Path | Sequence[Path], truth: Path | Sequence[Path]) -> dict[str, Any]:
    """Orbits with covariances in CCSDS Orbit Ephemeris Messages (KVN or XML).

    Needs `oem`. The steps are the epochs of the covariances, at which both orbits are interpolated as their messages
    say. Covariances in RTN (RSW) or TNW are those of the estimate's axes at this moment, without a turn rate; others
    are in the frame of the states.

    Parameters
    ----------
    estimate, truth : path, or list of paths
        A message for each run; the truth may be one for all.

    Returns
    -------
    dict
        `error` [trial, step, 6] and `covariance` [trial, step, 6, 6], radial, transverse and normal to the true orbit,
        positions before velocities (m, m/s), with `groups`, `steps` and `time` (s).

    Raises
    ------
    InputError
        If a message cannot be read, has no covariances, or the truth is in another frame or at other times.
    """
    runs = []
    for one, other in paired(estimate, truth):
        start, orbit = _read(one)
        true, rows, asked = _read(other, start)[1], [], 0
        for segment, _, _ in orbit:
            frame = segment.metadata["REF_FRAME"], segment.metadata["CENTER_NAME"]
            for covariance in segment.covariances:
                asked += 1
                epoch, time = covariance.epoch, (covariance.epoch - start).sec
                of, at = _state(one, orbit, epoch, time, frame), _state(other, true, epoch, time, frame)
                if of is None or at is None:
                    continue
                own, to = _axes(covariance.frame, of), _axes("RTN", at)
                if own is None and covariance.frame != frame[0]:
                    why = f"its covariances are in {covariance.frame}, and its states in {frame[0]}"
                    raise InputError(f"{one}: {why}. Give covariances in {frame[0]}, RTN or TNW.")
                J = to if own is None else to @ own.T
                P = J @ covariance.matrix @ J.T
                rows.append((time, to @ (of - at), P))
        if not rows:
            raise InputError(f"{one}: {asked} covariances, none at a time of both orbits. Give an OEM that has them.")
        if len(rows) < asked:
            note(f"{one}: {asked - len(rows)} of {asked} covariances are at times without a truth, and are left out")
        runs.append([np.array(each) for each in zip(*rows)])
    return {
        "error": 1e3 * stacked([error for _, error, _ in runs]),
        "covariance": 1e6 * stacked([P for _, _, P in runs]),
        "component_names": _names,
        "component_units": ["m"] * 3 + ["m/s"] * 3,
        "groups": {"position": [0, 1, 2], "velocity": [3, 4, 5]},
        "steps": np.array([len(time) for time, _, _ in runs]),
        "time": stacked([time for time, _, _ in runs]),
    }
