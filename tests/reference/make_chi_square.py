"""Prints chi_square.json: errors and innovations drawn by NumPy for a filter that is right, and what SciPy says of them:
every figure of the evidence, computed from the values and not from totals, for tests/calibration_reference_long_test.cpp.

    /usr/bin/python3 tests/reference/make_chi_square.py > tests/reference/chi_square.json

Deterministic; made with Python 3.11, NumPy 1.24.2 and SciPy 1.10.1. In JSON null is NaN.
"""

import json
import math

import numpy as np
from record_figures import CELLS, LEVELS, plain
from scipy import stats

TRIALS, STEPS, N, ROWS = 200, 5, 4, 4
GROUPS = {"all": (0, 4), "pose": (0, 2), "features": (2, 4)}
SIGMA = np.array([0.5, 0.75, 1, 1.5, 3])  # by step, the same for every component: P = sigma^2 I
LAGS = STEPS - 1


def t_quantile(alpha, degrees):
    """Two-sided: SciPy's t.isf is good to 1e-8 only; Newton's steps on its t.sf, which is exact, make it better."""
    q = stats.t.isf(alpha / 2, degrees)
    for _ in range(4):
        q += (stats.t.sf(q, degrees) - alpha / 2) / stats.t.pdf(q, degrees)
    return q


def moments(values):
    return {"mean": values.mean(), "sd": values.std(ddof=1), "se": stats.sem(values)}


def t_interval(values, alpha):
    half = t_quantile(alpha, len(values) - 1) * stats.sem(values)
    return [values.mean() - half, values.mean() + half]


def banded(totals, degrees):
    """Ratios of chi-square totals by step, and their bands: each for itself, and for all together."""
    ratio = totals / degrees
    result = {"degrees": degrees, "ratio": ratio}
    for name, alpha in [("band", 0.05), ("simultaneous_band", 0.05 / STEPS)]:
        band = np.array([stats.chi2.ppf(alpha / 2, degrees), stats.chi2.isf(alpha / 2, degrees)]).T / degrees[:, None]
        result[name] = band
        result["outside_" + name] = ((ratio < band[:, 0]) | (ratio > band[:, 1])).sum()
    return result


def wilson(count):
    interval = stats.binomtest(int(count), TRIALS).proportion_ci(0.95, method="wilson")
    return [interval.low, interval.high]


def coverage(nees, dimension, level):
    covered = (nees < stats.chi2.ppf(level, dimension)).sum(axis=0)
    return {"level": level, "share": covered / TRIALS, "interval": [wilson(count) for count in covered],
            "over_steps": (covered / TRIALS).mean()}


def accuracy(errors):
    """RMSE and its prediction, all components together; the ratio's interval is that of the mean square of a trial."""
    squares, predicted = (errors**2).sum(axis=2), errors.shape[2] * SIGMA**2
    return {"rmse": np.sqrt(squares.mean(axis=0)), "predicted": np.sqrt(predicted),
            "over_steps": math.sqrt(squares.mean()), "ratio": math.sqrt(squares.mean() / predicted.mean()),
            "interval": np.sqrt(np.array(t_interval(squares.mean(axis=1), 0.05)) / predicted.mean())}


def group(name, errors):
    first, end = GROUPS[name]
    dimension = end - first
    nees = ((errors[:, :, first:end] / SIGMA[None, :, None]) ** 2).sum(axis=2)
    over_steps = nees.mean(axis=1) / dimension
    return {"group": name, "dimension": dimension, "run": moments(over_steps), "interval": t_interval(over_steps, 0.05),
            "corrected_interval": t_interval(over_steps, 0.05 / (len(GROUPS) * (STEPS + 1))),
            "step": [moments(nees[:, k] / dimension) for k in range(STEPS)],
            "anees": banded(nees.sum(axis=0), np.full(STEPS, TRIALS * dimension)),
            "coverage": [coverage(nees, dimension, level) for level in LEVELS],
            "variance_ratio": nees.var(axis=0, ddof=1) / (2 * dimension), "accuracy": accuracy(errors[:, :, first:end])}


def nis(innovations):
    """S = I: of the rows that were observed, however many they are."""
    seen = ~np.isnan(innovations)
    totals, degrees = np.nansum(innovations**2, axis=(0, 2)), seen.sum(axis=(0, 2))
    ratio, all_degrees = totals.sum() / degrees.sum(), degrees.sum()
    scale = totals.sum() / np.array([stats.chi2.isf(0.025, all_degrees), stats.chi2.ppf(0.025, all_degrees)])
    by_trial = np.nansum(innovations**2, axis=(1, 2)) / (all_degrees / TRIALS)
    return {"nis": banded(totals, degrees), "degrees": all_degrees, "ratio": ratio, "scale95": scale,
            "ratio95": t_interval(by_trial, 0.05)}


def whiteness(innovations):
    result, size = [], nis(innovations)["ratio"]
    for lag in range(1, LAGS + 1):
        products = innovations[:, lag:] * innovations[:, :-lag]
        count = (~np.isnan(products)).sum()
        result.append({"lag": lag, "count": count, "correlation": np.nansum(products) / count,
                       "scaled": np.nansum(products) / count / size, "bound": stats.norm.isf(0.025) / math.sqrt(count),
                       "simultaneous_bound": stats.norm.isf(0.025 / LAGS) / math.sqrt(count)})
    return result


def distribution(nees):
    exact = [stats.kstest(nees[:, k], stats.chi2(N).cdf) for k in range(STEPS)]
    cells = []
    for k in range(STEPS):
        count, _ = np.histogram(stats.chi2.cdf(nees[:, k], N), np.arange(CELLS + 1) / CELLS)
        cells.append(np.abs(np.cumsum(count) / TRIALS - (np.arange(CELLS) + 1) / CELLS).max())
    return {"distance": [one.statistic for one in exact], "p": [one.pvalue for one in exact],
            "cell_distance": cells, "cell_p": stats.kstwo.sf(cells, TRIALS)}


def credibility(errors, nees):
    steps = []
    for k in range(STEPS):
        e = errors[:, k]
        actual = np.einsum("ij,jk,ik->i", e, np.linalg.inv(e.T @ e / TRIALS), e)
        decades = np.log10(nees[:, k] / actual)
        steps.append([10 * np.abs(decades).mean(), 10 * decades.mean()])
    return {"nci_by_step": [step[0] for step in steps], "inclination_by_step": [step[1] for step in steps],
            "nci": np.mean(steps, axis=0)[0], "inclination": np.mean(steps, axis=0)[1]}


rng = np.random.default_rng(20250711)
draws = np.round(rng.standard_normal((TRIALS, STEPS, N)), 5)
errors = draws * SIGMA[None, :, None]
innovations = np.round(rng.standard_normal((TRIALS, STEPS, ROWS)), 5)
innovations[rng.random(innovations.shape) < 0.3] = np.nan  # rows that were not observed
whole = ((errors / SIGMA[None, :, None]) ** 2).sum(axis=2)
bias = [{"component": j, "step": [moments(errors[:, k, j] / SIGMA[k]) for k in range(STEPS)]} for j in range(N)]

print(json.dumps(plain({
    "trials": TRIALS, "sigma": SIGMA, "draws": draws.ravel(), "innovations": innovations.ravel(),
    "groups": [group(name, errors) for name in GROUPS], "nis": nis(innovations), "whiteness": whiteness(innovations),
    "bias": bias, "distribution": distribution(whole), "credibility": credibility(errors, whole),
})).replace("], \"", "],\n\""))
