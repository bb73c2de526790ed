"""Records of every form, as arguments of `credence.judge` and as files for the program."""

from __future__ import annotations

from collections.abc import Mapping

import h5py
import numpy as np

TRIALS, STEPS, N = 40, 6, 4


def covariances(rng, size, trials=TRIALS, steps=STEPS):
    """Positive definite matrices [trial, step, size, size]."""
    roots = rng.normal(size=(trials, steps, size, size))
    return roots @ roots.transpose(0, 1, 3, 2) + size * np.eye(size)


def drawn(rng, covariance):
    """Errors that have these covariances."""
    normal = rng.normal(size=(*covariance.shape[:-1], 1))
    return (np.linalg.cholesky(covariance) @ normal)[..., 0]


def joint(rng, scale=1.0):
    covariance = covariances(rng, N)
    return {"error": scale * drawn(rng, covariance), "covariance": covariance}


def with_innovations(rng):
    innovation_covariance = covariances(rng, 3)
    innovation = drawn(rng, innovation_covariance)
    innovation[rng.random(innovation.shape) < 0.2] = np.nan
    return {
        **joint(rng),
        "innovation": innovation,
        "innovation_covariance": innovation_covariance,
        "row_groups": {"gps": [0, 2], "baro": [1]},
    }


def variances(rng):
    record = joint(rng)
    return {**record, "covariance": np.diagonal(record["covariance"], axis1=2, axis2=3), "groups": {"pose": [0, 1]}}


def growing(rng):
    record = joint(rng)
    for trial in range(TRIALS):
        enters = trial % STEPS
        record["error"][trial, :enters, 3] = np.nan
        record["covariance"][trial, :enters, 3, :] = np.nan
        record["covariance"][trial, :enters, :, 3] = np.nan
    return {**record, "groups": "pose 0:3, landmark 3"}


def of_groups(rng):
    record = joint(rng)
    pose = record["covariance"][..., :2, :2]
    velocity = record["covariance"][..., 2:, 2:]
    nees = np.einsum("...i,...ij,...j", record["error"][..., 2:], np.linalg.inv(velocity), record["error"][..., 2:])
    return {
        "error": record["error"],
        "groups": {"pose": [0, 1], "velocity": [2, 3]},
        "group_covariance": {"pose": pose},
        "group_nees": {"velocity": nees},
    }


def nees_alone(rng):
    return {
        "nees": rng.chisquare(4, (TRIALS, STEPS)),
        "group_nees": {"pose": rng.chisquare(3, (TRIALS, STEPS))},
        "dimension": {"all": 4, "pose": 3},
    }


def quaternions(rng):
    q = rng.normal(size=(TRIALS, STEPS, 4))
    return q / np.linalg.norm(q, axis=-1, keepdims=True)


def poses(rng, order, chart):
    truth = np.concatenate(
        [rng.normal(size=(TRIALS, STEPS, 3)), quaternions(rng), rng.normal(size=(TRIALS, STEPS, 2))], -1
    )
    estimate = truth + 0.01 * rng.normal(size=truth.shape)
    estimate[..., 3:7] /= np.linalg.norm(estimate[..., 3:7], axis=-1, keepdims=True)
    return {
        "truth": truth,
        "estimate": estimate,
        "manifold": "SE3 x R2",
        "chart": chart,
        "quaternion": order,
        "covariance": 1e-4 * covariances(rng, 8),
    }


def planar(rng):
    truth = rng.normal(size=(TRIALS, STEPS, 4))
    covariance = 1e-3 * covariances(rng, 4)
    return {
        "truth": truth,
        "estimate": truth + drawn(rng, covariance),
        "covariance": covariance,
        "manifold": "SE2 x SO2",
        "chart": "global",
    }


def troubled(rng):
    record = joint(rng)
    record["covariance"][3, 2] = 0  # singular
    record["error"][5, 1, 2] = np.inf
    record["error"][7, 4:] = np.nan  # ends early
    record["covariance"][7, 4:] = np.nan
    record["error"][9] *= 1e13  # diverged
    return record


def shorter(rng):
    return {**joint(rng), "steps": rng.integers(2, STEPS + 1, TRIALS), "time": np.arange(STEPS) / 10}


def in_type(record, dtype):
    return {key: value.astype(dtype) if isinstance(value, np.ndarray) else value for key, value in record.items()}


def corpus():
    """{name: arguments of judge}, every form that a record may have."""
    rng = np.random.default_rng(2026)
    named = {"component_names": ["x", "y", "heading", "speed"], "component_units": ["m", "m", "rad", "m/s"]}
    return {
        "joint": joint(rng),
        "optimistic": joint(rng, 1.5),
        "pessimistic": joint(rng, 0.5),
        "groups": {**joint(rng), "groups": {"pose": [0, 1, 2], "odd": [1, 3]}},
        "groups_as_text": {**joint(rng), "groups": "pose 0:3, odd 1 3"},
        "names": {**joint(rng), **named},
        "singles": in_type(joint(rng), "f4"),
        "halves": in_type(joint(rng), "f2"),
        "long_doubles": in_type(joint(rng), "g"),
        "big_endian": in_type(joint(rng), ">f8"),
        "innovations": with_innovations(rng),
        "variances": variances(rng),
        "growing": growing(rng),
        "of_groups": of_groups(rng),
        "nees_alone": nees_alone(rng),
        "wxyz": poses(rng, "wxyz", "local"),
        "xyzw": poses(rng, "xyzw", "global"),
        "planar": planar(rng),
        "troubled": troubled(rng),
        "steps": shorter(rng),
        "time_of_trials": {**joint(rng), "time": rng.random((TRIALS, STEPS)).cumsum(1)},
        "one_run": {key: value[0] for key, value in joint(rng).items()},
    }


def write(path, record):
    """Write the arguments of `judge` as a record [docs/judge.md]."""
    groups = record.get("groups")
    with h5py.File(path, "w") as file:
        file.attrs["record_version"] = 2
        for key, value in record.items():
            if isinstance(value, np.ndarray):
                file[key] = value
            elif key in ("groups", "row_groups") and isinstance(value, Mapping):
                file.attrs[key] = ", ".join(" ".join(map(str, [name, *members])) for name, members in value.items())
            elif key in ("group_covariance", "group_nees"):
                for name, array in value.items():
                    file[f"group/{name}/{key.removeprefix('group_')}"] = array
            elif key != "dimension":
                file.attrs[key] = value
        dimensions = (
            record.get("dimension") or {name: len(members) for name, members in (groups or {}).items()}
            if isinstance(groups, Mapping) or "dimension" in record
            else {}
        )
        for name, dimension in dimensions.items():
            nees = "nees" if name == "all" else f"group/{name}/nees"
            if nees in file:
                file[nees].attrs["dimension"] = dimension
    return path
