"""Writes records for `credence judge`, and what is in them as NumPy and SciPy compute it instead of the project's code.

    /usr/bin/python3 tests/reference/make_records.py                small ones beside this file, and records.json
    /usr/bin/python3 tests/reference/make_records.py --big DIR      [--trials N], each with its own JSON, in DIR
    /usr/bin/python3 tests/reference/make_records.py --large FILE   [--trials N], about 1 GB, nothing said of it

Deterministic; made with Python 3.11, NumPy 1.24.2, SciPy 1.10.1 and h5py 3.7. In JSON null is NaN.
"""

import argparse
import json
import math
import pathlib

import h5py
import numpy as np
from record_figures import Expected, Record, plain


def random_covariances(rng, count, size):
    """[count, size, size], components of different sizes and correlated, on a grid so that the files compress."""
    factors = rng.normal(size=(count, size, size)) * 0.4 + 1.2 * np.eye(size)
    factors *= np.geomspace(0.5, 2, size)[:, None]
    return np.round(np.einsum("cij,ckj->cik", factors, factors) * 256) / 256 + 0.125 * np.eye(size)


def draws(rng, covariances, z=None):
    """Errors [trial, step, n] with the covariances [trial, step, n, n]."""
    lower = np.linalg.cholesky(covariances)
    z = rng.normal(size=covariances.shape[:3]) if z is None else z
    return np.einsum("tkij,tkj->tki", lower, z)


def rounded(values):
    return np.round(values * 65536) / 65536


def per_step(rng, trials, steps, size):
    """The same covariances in every trial, [trial, step, size, size]."""
    return np.broadcast_to(random_covariances(rng, steps, size), (trials, steps, size, size)).copy()


def write(path, record, attribute=None, without_trials=False, **options):
    with h5py.File(path, "w", libver=("earliest", "v108")) as file:
        for name, values in record.datasets().items():
            values = values[0] if without_trials else values
            settings = dict(options)
            if "chunks" in settings and settings["chunks"] is not True:
                settings["chunks"] = tuple(min(a, b) for a, b in zip(settings["chunks"], values.shape))
            file.create_dataset(name, data=values, track_times=False, **settings)
            if "dtype" in settings:  # what is expected is of the values in the file
                setattr(record, name, file[name][...].astype(float))
        if attribute is not None:
            file.attrs.create("groups", *attribute)


# ---- small records, one a way of writing -----------------------------------------------------------------------------


def gaussian(rng, trials, steps, n, m=0, groups=None):
    P = random_covariances(rng, trials * steps, n).reshape(trials, steps, n, n)
    if not m:
        return Record(rounded(draws(rng, P)), P, groups=groups)
    S = random_covariances(rng, trials * steps, m).reshape(trials, steps, m, m)
    return Record(rounded(draws(rng, P)), P, rounded(draws(rng, S)), S, groups)


def hide_rows(rng, record, share):
    """Rows not observed: innovation NaN, and anything in the covariance."""
    hidden = rng.random(record.innovation.shape) < share
    record.innovation[hidden] = np.nan
    for at in zip(*np.nonzero(hidden)):
        record.innovation_covariance[at[:2]][at[2], :] = np.nan
        record.innovation_covariance[at[:2]][:, at[2]] = 7


def end_runs(rng, record, first=1):
    """Runs of different lengths, declared, and one step missing within a run."""
    trials, steps, _ = record.error.shape
    record.steps = rng.integers(first, steps + 1, size=trials).astype(np.int32)
    for trial, length in enumerate(record.steps):
        record.error[trial, length:] = np.nan
        record.covariance[trial, length:] = np.nan
    record.error[0, :] = rounded(rng.normal(size=record.error[0].shape))
    record.covariance[0] = np.eye(record.error.shape[2])
    record.steps[0] = steps
    record.error[0, 2] = record.covariance[0, 2] = np.nan


def ragged(rng):
    record = gaussian(rng, 40, 7, 3, 5, {"pose": (0, 2), "all_but-1": (1, 3)})
    hide_rows(rng, record, 0.3)
    end_runs(rng, record)
    record.innovation[3, 0] = np.nan  # a step without any row, in a run that has no other
    record.error[3, 1:] = np.nan  # the covariance is not: behind the end it is not looked at
    record.steps[3] = 1
    record.error[5] = 7           # nor is this
    record.steps[5] = 1
    return record


def cut(rng):
    """Runs that end early: most do not say so, and the longest is shorter than the file."""
    record = gaussian(rng, 40, 8, 2)
    for trial, length in enumerate([7] * 30 + list(rng.integers(1, 7, size=10))):
        record.error[trial, length:] = record.covariance[trial, length:] = np.nan
    return record


def broken(rng):
    """Trials that fail in every way that is not a covariance's, and one that declares steps it does not have."""
    record = gaussian(rng, 20, 5, 3, 2)
    record.error[1, 2] = np.nan
    record.covariance[2, 2] = np.nan
    record.error[3, 4, 1] = np.nan
    record.error[4, 0, 2] = -np.inf
    record.covariance[5, 1, 0, 2] = np.inf
    record.covariance[6, 1, 1, 1] = np.nan
    record.innovation[7, 3, 1] = np.inf
    record.innovation_covariance[8, 3, 0, 1] = np.nan
    record.error[9, 3, 0] = 2e12                       # diverged
    record.covariance[10, 3:] *= 2.0**50               # large, and nothing else
    record.error[11, 1, 0] = 2e12                      # diverged, were it not for the next
    record.covariance[11, 4] = 0
    record.error[12, 4] = record.covariance[12, 4] = np.nan
    record.error[12, 2] = record.covariance[12, 2] = np.nan
    record.steps = np.full(20, 5.0)
    record.steps[13] = 2
    record.error[13, 3] = np.inf                       # behind its end
    return record


def troubled(rng):
    record = gaussian(rng, 30, 4, 3, 2, {"first": (0, 1)})
    line = np.array([0.5, 1.0, -2.0])
    record.covariance[4, 2] = np.outer(line, line)                              # rank 1
    record.covariance[7, 1] = [[1, 0.9, -0.9], [0.9, 1, 0.9], [-0.9, 0.9, 1]]   # indefinite
    record.covariance[7, 3] = 0
    record.covariance[9, 3, 1, :] = record.covariance[9, 3, :, 1] = 0           # a component without variance
    record.innovation_covariance[12, 0] = [[1, 1], [1, 1]]
    record.innovation_covariance[15, 1] = [[-1, 0], [0, 1]]
    record.innovation[16, 1, 0] = np.nan
    record.innovation_covariance[16, 1] = [[-1, 0], [0, 1]]                     # that row was not observed: no trouble
    record.error[20] = np.nan
    record.error[22, 1, 2] = 1e150
    record.covariance[25, 1] = np.nan
    record.error[25, 1] = np.nan
    record.covariance[26, 0, 0, 1] *= 1 + 1e-10                                 # as symmetric as rounding leaves it
    return record


def many_troubles(rng):
    record = gaussian(rng, 25, 2, 2)
    record.covariance[1:24, 1] = 0
    return record


def small(folder):
    utf8, ascii_ = h5py.string_dtype("utf-8"), h5py.string_dtype("ascii")
    text = "pose 0:3, feature_1 3:5"
    cases = {
        "gaussian": (lambda rng: gaussian(rng, 60, 6, 5, 4, {"pose": (0, 3), "feature_1": (3, 5)}),
                     dict(attribute=(text, (), utf8), compression="gzip", shuffle=True)),
        "ragged": (ragged, dict(attribute=(np.bytes_("pose 0:2 ,all_but-1\t1:3"),), compression="gzip", shuffle=True)),
        "troubled": (troubled, dict(attribute=(["first 0:1"], (1,), ascii_))),
        "many troubles": (many_troubles, dict()),
        "single": (lambda rng: gaussian(rng, 1, 12, 4, 3), dict(without_trials=True)),
        "singles": (lambda rng: gaussian(rng, 50, 5, 4, groups={"a": (0, 2), "b": (1, 4)}),
                    dict(attribute=(np.array([b"a 0:2", b"b 1:4"]),), dtype="f4", chunks=(7, 2, 3, 3),
                         compression="gzip")),
        "one": (lambda rng: gaussian(rng, 30, 3, 1, 1), dict(attribute=(h5py.Empty("S1"),))),
        "cut": (cut, dict(compression="gzip")),
        "broken": (broken, dict()),
    }
    expected = {}
    for seed, (name, (make, how)) in enumerate(cases.items()):
        record = make(np.random.default_rng([20261121, seed]))
        write(folder / f"record_{name.replace(' ', '+')}.h5", record, **how)
        expected[name] = Expected(record).everything()
        expected[name]["file"] = f"record_{name.replace(' ', '+')}.h5"
    (folder / "records.json").write_text(json.dumps(plain(expected), indent=None, separators=(",", ":")) + "\n")


# ---- large records, one a way of being wrong -------------------------------------------------------------------------
# With 5000 trials of 20 steps of 5 components NEES/dim of the whole state, over time, has a standard error of
# sqrt(2 / (5 20 5000)) = 0.0020: 2 % lie well inside a margin of 5 %, and 6 standard errors outside one of 0.8 %, of
# which the corrected interval takes 3.4. At a level of 5 % one record in twenty shows something that is not there (seeds
# 7 and 8 have one, a bias); those of seed 9 to 11 do not.


def ar1(rng, shape, correlation):
    """Standard normal draws [trial, step, ...], correlated from step to step."""
    z = rng.normal(size=shape)
    for k in range(1, shape[1]):
        z[:, k] = correlation * z[:, k - 1] + math.sqrt(1 - correlation**2) * z[:, k]
    return z


def student(rng, shape, degrees):
    """Multivariate t of unit covariance over the last dimension."""
    chi2 = rng.chisquare(degrees, size=shape[:-1])
    return rng.normal(size=shape) * np.sqrt((degrees - 2) / chi2)[..., None]


def big_record(rng, kind, trials, steps=20, n=5, m=4):
    P, S = per_step(rng, trials, steps, n), per_step(rng, trials, steps, m)
    z = {"correlated": lambda shape: ar1(rng, shape, 0.5), "heavy": lambda shape: student(rng, shape, 5)}.get(
        kind, lambda shape: rng.normal(size=shape))
    error, innovation = draws(rng, P, z((trials, steps, n))), draws(rng, S, z((trials, steps, m)))
    if kind == "inflated":
        P *= 1.02
    if kind == "deflated":
        P *= 0.98
    if kind == "biased":
        error[:, :, 1] += 0.2 * np.sqrt(P[:, :, 1, 1])
    if kind == "block":
        scale = np.where(np.arange(n) < 3, 1, math.sqrt(0.8))
        P *= np.outer(scale, scale)
    record = Record(error, P, innovation, S, {"pose": (0, 3), "feature_1": (3, 5)})
    if kind == "missing":
        hide_rows(rng, record, 0.3)
        end_runs(rng, record, first=steps // 2)
    return record


def big(folder, trials):
    folder.mkdir(parents=True, exist_ok=True)
    for seed, kind in enumerate(["exact", "inflated", "deflated", "correlated", "heavy", "biased", "block", "missing"]):
        record = big_record(np.random.default_rng([9, seed]), kind, trials)
        attribute = ("pose 0:3, feature_1 3:5", (), h5py.string_dtype("utf-8"))
        write(folder / f"{kind}.h5", record, attribute=attribute)
        expected = plain(Expected(record).everything(by_trial=False))
        (folder / f"{kind}.json").write_text(json.dumps(expected) + "\n")


def large(path, trials):
    """Written some trials at a time. 200 steps of 12 components and 6 rows: 316 kB a trial."""
    rng, at_once, shape = np.random.default_rng(3), 50, (200, 12, 6)
    P, S = per_step(rng, at_once, shape[0], shape[1]), per_step(rng, at_once, shape[0], shape[2])
    with h5py.File(path, "w") as file:
        sizes = {"error": (12,), "covariance": (12, 12), "innovation": (6,), "innovation_covariance": (6, 6)}
        for name, size in sizes.items():
            file.create_dataset(name, shape=(trials, 200, *size), dtype="f8")
        file.attrs["groups"] = "pose 0:3, features 3:12"
        for first in range(0, trials, at_once):
            part = slice(first, min(first + at_once, trials))
            count = part.stop - part.start
            file["error"][part], file["innovation"][part] = draws(rng, P)[:count], draws(rng, S)[:count]
            file["covariance"][part], file["innovation_covariance"][part] = P[:count], S[:count]


if __name__ == "__main__":
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--big", type=pathlib.Path, metavar="DIR")
    arguments.add_argument("--large", type=pathlib.Path, metavar="FILE")
    arguments.add_argument("--trials", type=int)
    given = arguments.parse_args()
    if given.big:
        big(given.big, given.trials or 5000)
    elif given.large:
        large(given.large, given.trials or 3300)
    else:
        small(pathlib.Path(__file__).parent)
