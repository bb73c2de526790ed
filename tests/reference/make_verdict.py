"""Prints verdict.json: random studies, and what tests/oracle/verdict_oracle.py says of their bounds, directions, bias,
advice and lags, for tests/statistics/verdict_oracle_test.cpp. The trials are not stored: they are functions of the project's
keyed draws (include/credence/detail/draws.hpp), which this file and tests/statistics/verdict_cases.hpp both compute.

    python3 tests/reference/make_verdict.py > tests/reference/verdict.json

Deterministic up to rounding; made with Python 3.11, NumPy 2.4.6 and SciPy 1.17.1. In JSON null is NaN,
infinity, or what is not computed.
"""

import json
import os
import sys

import numpy as np

tree = os.path.join(os.path.dirname(__file__), "..", "..")
sys.path[:0] = [os.path.join(tree, "tests", "oracle"), os.path.join(tree, "experiments", "worlds", "compare")]
from keyed_draws import normal, uniform  # noqa: E402
from verdict_oracle import *  # noqa: E402,F403

WALK, MEASUREMENT, DETECTION = 2, 4, 6  # sources of draws
ADVICE_KEY = 0x616476696365


def scales(case, index):
    """One factor a trial, of mean square 1."""
    if case["tails"] == "t5":
        q = sum(normal(case["seed"], index, WALK, 0, j)[..., 0] ** 2 for j in range(5))
        return np.sqrt(3 / q)
    if case["tails"] == "contaminated":
        return np.where(uniform(case["seed"], index, DETECTION, 0) < 0.05, 3, 1) / np.sqrt(1.4)
    return np.ones(len(index))


def study(case):
    n, K, seed = case["n"], case["steps"], case["seed"]
    index = np.array([i for i in range(2 * case["trials"]) if not (case["gaps"] and i % 7 == 5)][: case["trials"]])
    i, k, j = index[:, None, None], np.arange(K)[:, None], np.arange(n)
    w = normal(seed, i, MEASUREMENT, k, j)[..., 0]
    for step in range(1, K):
        w[:, step] = case["rho"] * w[:, step - 1] + np.sqrt(1 - case["rho"] ** 2) * w[:, step]
    wobble = (0.8 + 0.4 * uniform(seed, index, DETECTION, 0, 1))[:, None] * (1 - np.arange(K) / (2 * K))
    powers = np.abs(j[:, None] - j)
    claimed = (case["claimed"] * wobble)[..., None, None] ** powers
    true = (case["true"] * wobble)[..., None, None] ** powers
    e = np.matmul(np.linalg.cholesky(true), w[..., None])[..., 0]
    e *= case["scale"] * scales(case, index)[:, None, None]
    e[..., 0] += case["bias"]
    judged = n
    if case["kind"] == "exact":  # the last component is known exactly
        e[..., -1] = 0
        judged = n - 1
    if case["kind"] == "singular":  # the last component is the first once more
        e[..., -1] = e[..., 0]
        claimed[..., -1, :], claimed[..., :, -1] = claimed[..., 0, :], claimed[..., :, 0]
        claimed[..., -1, -1] = 1
        judged = n - 1
    groups = [(str(g), c) for g, c in enumerate(case["groups"])]
    run = np.stack([nees_of(e, claimed, [m for m in c if m < judged]).mean(1) for _, c in groups], 1)
    return Numbers(case["trials"], K, groups, run, np.matmul(e.transpose(0, 2, 1), e), claimed.sum(1), e.mean(1),
                   index=index, error_size=np.abs(e).max((0, 1)))


def verdict_on_nees(x, g, limits):
    X, c, G = x.run[:, g], x.groups[g][1], len(x.groups)
    level, v = share_of(LEVEL_RUN, g, G) / 2, Verdict()
    degrees = degrees_over_steps(X, len(c), x.steps)
    m, s, N = X.mean(), X.std(ddof=1), x.trials
    compare(v, "run", g, m, s, N, degrees, level, limits.margin)
    return {"mean": m, "sd": s, "degrees": degrees, "level": level,
            "bounds": [lower(m, s, N, level), upper(m, s, N, level, UNSEEN)],
            "finding": v.findings[0][2] if v.findings else "", "accepted": accepts(X, X, N, limits.margin),
            "show": trials_to_show(m, s, level, limits.margin, N)}


def one_direction(x, c, which, level, limits):
    y, folds = crossed(x, c, which, limits)
    _, v = extreme(x, c, which, limits)
    low = lower(y.mean(), y.std(ddof=1), x.trials, level)
    high = upper(y.mean(), y.std(ddof=1), x.trials, level, UNSEEN)
    if x.steps * len(c) < 20:
        high = upper(y.mean(), y.std(ddof=1), x.trials, level) + (1 - UNSEEN_OF_FEW ** (1 / x.trials)) * max(0, 9 - y.mean())
        high += (y.max() - y.mean()) / x.trials
    entries = named(v, c)
    return {"components": list(entries), "weights": list(entries.values()), "ratio": y.mean(), "bounds": [low, high],
            "approximate": is_approximate(folds, v, part_of(x.predicted, c)),
            "finding": direction_found(x, y, which, level, limits, len(c)) is not None}


def verdict_on_directions(x, limits):
    groups, result = [c for _, c in x.groups if len(c) >= 2], []
    for g, c in enumerate(groups):
        level = share_of(LEVEL_DIRECTION, g, len(groups)) / 2
        basis = resolved_basis(part_of(x.predicted, c).sum(0), limits)
        result.append({"group": c, "level": level, "left_out": len(c) - basis.shape[1],
                       "largest": one_direction(x, c, -1, level, limits),
                       "smallest": one_direction(x, c, 0, level, limits)})
    return result


def verdict_on_all_directions(x, limits):
    c, N = x.groups[0][1], x.trials
    low, high = extreme(x, c, 0, limits)[0], extreme(x, c, -1, limits)[0]
    return {"smallest": low.mean(), "largest": high.mean(), "accepted": accepts_directions(x, limits),
            "bounds": [lower(low.mean(), low.std(ddof=1), N, LEVEL_ACCEPT),
                       upper(high.mean(), high.std(ddof=1), N, LEVEL_ACCEPT)]}


def verdict_on_bias(x, limits):
    v, n = Verdict(), x.bias.shape[1]
    find_bias(x, limits, v)
    found = {f[1] for f in v.findings}
    half = [bias_half(x, j, LEVEL_BIAS / (2 * n)) for j in range(n)]
    mean = x.bias.mean(0)
    return [{"value": mean[j], "interval": [mean[j] - half[j], mean[j] + half[j]], "size": x.error_size[j],
             "known": known_exactly(x, j, limits), "finding": j in found, "accepted": accepts_bias(x, j, limits)}
            for j in range(n)]


def advised(x, case, limits):
    if case["kind"] == "singular":
        return None
    weights = np.empty((ADVICE_DRAWS, x.trials))
    for b in range(0, ADVICE_DRAWS, 2):
        weights[b : b + 2] = normal(case["seed"] ^ ADVICE_KEY, x.index, 0, b // 2).T
    low, number, high, _ = advice(x, limits, weights)
    return {"range": [low, high], "number": number}


def verdict_on_lags(x):
    """The mean errors over the steps of a trial as its sums of products; their number differs from trial to trial."""
    lags = []
    for trials in (1, 3, 7, 8, x.trials):
        p, c = x.bias[:trials, 0] * 40, 40 + x.index[:trials] % 3
        level = 0.05 / 3 / 2
        r, half = correlation(p, c, (p**2).sum(), level)
        lags.append({"trials": trials, "r": r, "interval": [r - half, r + half]})
    return lags


def plain(value):
    if isinstance(value, dict):
        return {key: plain(part) for key, part in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(part) for part in value]
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float):
        return None if not np.isfinite(value) else float("%.15g" % value)
    return value


def cases():
    """Dimension 1 to 9, whole states, groups that are not contiguous, wrong sizes, correlations dropped or invented,
    heavy tails, biases, few trials."""
    rng = np.random.default_rng(1)
    consistent = {"rho": 0, "true": 0.4, "claimed": 0.4, "scale": 1, "bias": 0, "kind": "", "gaps": False}
    for n, tails, trials in ((3, "normal", 1502), (4, "t5", 502)):
        yield {"n": n, "steps": 8, "trials": trials, "groups": [list(range(n)), [0, 2]], "tails": tails, **consistent,
               "seed": n}
    for number in range(40):
        n = [1, 2, 3, 4, 5, 6, 7, 8, 9][number % 9]
        kind = {11: "exact", 23: "singular", 31: "exact", 34: "singular"}.get(number, "")
        judged = n - 1 if kind == "exact" else n
        groups = [list(range(judged))]
        if judged >= 3 and number % 2 == 0:
            groups += [list(range(0, judged, 2)), list(range(1, judged, 2))]
        true, claimed = [(0.0, 0.0), (0.5, 0.0), (0.4, 0.4), (0.0, 0.5), (0.8, 0.3)][number % 5]
        trials = [203, 297, 252, 45][number // 2 % 4 if number % 8 else 3]
        yield {"n": n, "steps": [1, 3, 8][number % 3], "trials": trials,
               "groups": groups, "tails": ["normal", "t5", "contaminated"][number // 3 % 3],
               "rho": [0, 0.8][number // 5 % 2], "true": true, "claimed": claimed,
               "scale": [1, 1, 1.3, 0.7][number // 4 % 4], "bias": [0, 0.05, 0.3][number // 6 % 3], "kind": kind,
               "gaps": number % 3 == 1, "seed": int(rng.integers(2**63))}


def expected(case):
    x, limits = study(case), Limits()
    if x.trials < DIRECTION_TRIALS or len(x.groups[0][1]) < 2:
        directions, accepted = None, None
    else:
        directions, accepted = verdict_on_directions(x, limits), verdict_on_all_directions(x, limits)
    return {**case, "nees": [verdict_on_nees(x, g, limits) for g in range(len(x.groups))], "directions": directions,
            "all_directions": accepted, "biases": verdict_on_bias(x, limits), "advice": advised(x, case, limits),
            "lags": verdict_on_lags(x)}


if __name__ == "__main__":
    print("[" + ",\n".join(json.dumps(plain(expected(case)), separators=(",", ":")) for case in cases()) + "]")
