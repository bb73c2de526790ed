"""Prints statistics.json: inputs and expected values for the tests of statistics (statistics, bootstrap, paired, goodness,
credibility), computed by NumPy and SciPy instead of the project's code.

    /usr/bin/python3 tests/reference/make_statistics.py > tests/reference/statistics.json

Deterministic, about half a minute; made with Python 3.11, NumPy 1.24.2 and SciPy 1.10.1. Numbers have the digits that
give the same double again (17 at most); null is NaN.
"""

import json
import math

import numpy as np
from scipy import stats
from scipy.stats import _ksstats

ROWS = np.random.default_rng(20240611)  # every input that is not written out below


def plain(value):
    """The value with NumPy's types made Python's, and NaN None."""
    if isinstance(value, dict):
        return {key: plain(one) for key, one in value.items()}
    if isinstance(value, (list, tuple, np.ndarray)):
        return [plain(one) for one in value]
    if isinstance(value, str):
        return value
    if isinstance(value, (int, np.integer)):
        return int(value)
    return None if math.isnan(value) else float(value)


def rounded(values):
    """Inputs with few digits, for a small file."""
    return np.round(values, 6)


def t_quantile(alpha, degrees):
    """Two-sided: SciPy's t.isf is good to 1e-8 only; Newton's steps on its t.sf, which is exact, make it better."""
    q = stats.t.isf(alpha / 2, degrees)
    for _ in range(4):
        q += (stats.t.sf(q, degrees) - alpha / 2) / stats.t.pdf(q, degrees)
    return q


def chi_square_quantile(p, degrees):
    """SciPy's, but that its gammainc is wrong by 0.6 % beyond 4.5 sd for millions of degrees: there the cube root's
    normal distribution [Wilson and Hilferty 1931], which is good to 1e-10 for so many."""
    if p < 3e-6 and degrees > 1e6:
        return degrees * (1 - 2 / (9 * degrees) + stats.norm.ppf(p) * math.sqrt(2 / (9 * degrees))) ** 3
    return stats.chi2.ppf(p, degrees)


def t_interval(values):
    half = t_quantile(0.05, len(values) - 1) * stats.sem(values)
    return [np.mean(values) - half, np.mean(values) + half]


def quantiles():
    alphas = [0.5, 0.1, 0.05, 0.01, 1e-4, 1e-8]
    degrees = [1, 2, 3, 9, 49, 255, 999.5, 9999, 1e6]
    counts = [1, 2, 9, 57, 450, 9000, 171000, 9e6]
    shares = [1e-6, 0.005, 0.025, 0.5, 0.95, 0.975, 0.99]
    return {
        "t_quantile": [[a, d, t_quantile(a, d)] for a in alphas for d in degrees],
        "normal_quantile": [[a, stats.norm.isf(a / 2)] for a in alphas],
        "chi_square_quantile": [[p, d, chi_square_quantile(p, d)] for p in shares for d in counts],
        "chi_square_upper_quantile": [[p, d, stats.chi2.isf(p, d)] for p in shares + [1e-12] for d in counts],
        "standardised_chi_square": [[a, d, (stats.chi2.ppf(a, d) - d) / math.sqrt(2 * d),
                                     (stats.chi2.isf(a, d) - d) / math.sqrt(2 * d)]
                                    for a in [0.025, 0.05 / 38] for d in [9e9, 2e10, 1.9e11, 1e13]],
        "chi_square_p": [[f * d, d, stats.chi2.sf(f * d, d)] for f in [0, 0.1, 0.7, 1, 1.3, 2, 5] for d in counts[:5]],
        "chi_square_band": [[d, a, stats.chi2.ppf(a / 2, d) / d, stats.chi2.isf(a / 2, d) / d]
                            for d in counts for a in [0.05, 0.01, 0.05 / 19]],
    }


def samples():
    """Symmetric with ties; heavy-tailed; two values; chi-square of 2 degrees, in which a 99th percentile is not the
    mean plus 2.33 sd."""
    result = []
    for values in [[3.25, -1.5, 7.125, 0.0, 2.0, 2.0, 11.75, -4.0], rounded(ROWS.lognormal(0, 1.5, 33)), [0.1, 0.4],
                   rounded(stats.chi2.ppf((np.arange(101) + 0.5) / 101, 2))]:
        values = np.asarray(values)
        inside = [values[0], values[1], float(np.median(values)), 0.3, -5.0, 1e3]
        result.append({
            "values": values, "mean": math.fsum(values) / len(values), "standard_deviation": values.std(ddof=1),
            "standard_error": stats.sem(values), "ci95": t_interval(values), "median": np.median(values),
            "quantiles": [[p, np.quantile(values, p)] for p in [0, 0.025, 0.1, 0.25, 0.5, 0.731, 0.975, 0.99, 1]],
            "percentiles": [[x, stats.percentileofscore(values, x, kind="mean")] for x in inside]})
    return result


def philox(counter, key):
    """Philox4x32-10 [Salmon, Moraes, Dror, Shaw 2011] of four arrays of words."""
    w = [np.asarray(word, dtype=np.uint64) for word in counter]
    k = [key & 0xffffffff, key >> 32]
    low = np.uint64(0xffffffff)
    for _ in range(10):
        product0, product1 = w[0] * np.uint64(0xD2511F53), w[2] * np.uint64(0xCD9E8D57)
        w = [(product1 >> np.uint64(32)) ^ w[1] ^ np.uint64(k[0]), product1 & low,
             (product0 >> np.uint64(32)) ^ w[3] ^ np.uint64(k[1]), product0 & low]
        k = [(k[0] + 0x9E3779B9) & 0xffffffff, (k[1] + 0xBB67AE85) & 0xffffffff]
    return w


LOW = np.uint64(0xffffffff)


def splitmix(key, position):
    """SplitMix64 [Steele, Lea, Flood 2014]: 64 bits at each position of the stream that a key names."""
    with np.errstate(over="ignore"):
        z = np.uint64(key) + (position.astype(np.uint64) + np.uint64(1)) * np.uint64(0x9e3779b97f4a7c15)
        z = (z ^ (z >> np.uint64(30))) * np.uint64(0xbf58476d1ce4e5b9)
        z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94d049bb133111eb)
    return z ^ (z >> np.uint64(31))


def bootstrap(by_trial, seed, figure, alpha=0.05):
    """The percentile bootstrap as bootstrap.hpp describes it: from the description, with NumPy's sums and quantiles."""
    by_trial = np.asarray(by_trial, dtype=float)
    fingerprint = 0xcbf29ce484222325
    for letter in figure.encode():
        fingerprint = ((fingerprint ^ letter) * 0x100000001b3) % 2**64
    counted = ~np.isnan(by_trial)
    blocks = [slice(first, first + 256) for first in range(0, len(by_trial), 256)]
    blocks = [block for block in blocks if counted[block].any()]
    if len(by_trial) >= 25600 and len(blocks) >= 100:
        sums = np.array([np.nansum(by_trial[block]) for block in blocks])
        counts = np.array([counted[block].sum() for block in blocks])
    else:
        sums, counts = by_trial[counted], np.ones(counted.sum())
    size = len(sums)
    whole = size // 4 * 4
    means = []
    for resample in range(2000):
        block = philox([[word] for word in (0, resample, fingerprint & 0xffffffff, (fingerprint >> 32) | 0xf0000)], seed)
        key = (int(block[0][0]) << 32) | int(block[1][0])
        pairs = splitmix(key, np.arange(whole // 2))
        words = np.concatenate([np.stack([pairs & LOW, pairs >> np.uint64(32)], axis=1).ravel(),
                                splitmix(key, np.arange(whole, size)) & LOW])
        index = (words * np.uint64(size)) >> np.uint64(32)
        means.append(sums[index].sum() / counts[index].sum())
    return np.quantile(means, [alpha / 2, 1 - alpha / 2])


def long_column(trials, failed, empty_block):
    """Trial i's value ((7919 i) mod 1009) / 64 + floor(i / 256) mod 7; NaN where i mod 97 = 5 and in block 3."""
    i = np.arange(trials)
    values = ((i * 7919) % 1009) / 64 + (i // 256) % 7
    if failed:
        values[i % 97 == 5] = np.nan
    if empty_block:
        values[i // 256 == 3] = np.nan
    return values


def bootstraps():
    result = []
    with_failed = rounded(ROWS.normal(5, 2, 37))
    with_failed[[0, 11, 36]] = np.nan
    for values, seed, figure, alpha in [
            ([1.0, 2.0], 1, "trace_P", 0.05), ([0.1, -3.5, 7.25, 1e3, 2.0], 2**64 - 1, "unseen", 0.05),
            (with_failed, 12345678901234567890, "a/greedy.ekf/trace_P", 0.05), (with_failed, 7, "", 0.1),
            (rounded(ROWS.lognormal(0, 1, 203)), 3, "nees", 0.01)]:
        result.append({"values": values, "seed": seed, "figure": figure, "alpha": alpha,
                       "interval": bootstrap(values, seed, figure, alpha)})
    for trials, failed, empty in [(25599, 0, 0), (25600, 0, 0), (25600, 1, 1), (25857, 1, 1), (27003, 1, 0)]:
        result.append({"trials": trials, "failed": failed, "empty_block": empty, "seed": 11, "figure": "trace_P",
                       "alpha": 0.05, "interval": bootstrap(long_column(trials, failed, empty), 11, "trace_P")})
    return result


def coverages(values=50, replications=10000, resamples=2000):
    """Share of 95 % percentile bootstrap intervals of `values` values that hold the true mean."""
    draws = np.random.default_rng(5)
    result = {"values": values, "replications": replications}
    for name, mean in [("normal", 0.0), ("lognormal", math.exp(0.5))]:
        held = 0
        for _ in range(replications):
            x = draws.standard_normal(values)
            x = np.exp(x) if name == "lognormal" else x
            means = x[draws.integers(0, values, (resamples, values), dtype=np.uint8)].mean(axis=1)
            low, high = np.quantile(means, [0.025, 0.975])
            held += low <= mean <= high
        result[name] = held / replications
    return result


def paired(a, b):
    a, b = np.asarray(a, dtype=float), np.asarray(b, dtype=float)
    interval = bootstrap(a - b, 99, "paired")
    kept = ~np.isnan(a - b)
    x, y = a[kept], b[kept]
    d = x - y
    test = stats.wilcoxon(d, zero_method="wilcox", correction=False, mode="approx")
    positive = stats.rankdata(np.abs(d[d != 0]))[d[d != 0] > 0].sum()
    sign = 1 if positive > len(d[d != 0]) * (len(d[d != 0]) + 1) / 4 else -1
    return {"a": a, "b": b, "pairs": len(d), "mean": math.fsum(d) / len(d), "ci95": t_interval(d),
            "bootstrap95": interval, "median": np.median(d), "wins_a": np.mean(x < y), "wins_b": np.mean(x > y),
            "ties": np.mean(x == y),
            "sign_p": stats.binomtest(int((x < y).sum()), int((x != y).sum())).pvalue,
            "wilcoxon_z": sign * abs(test.zstatistic), "wilcoxon_p": test.pvalue, "effect_size": d.mean() / d.std(ddof=1),
            "variance_reduction": (x.var(ddof=1) + y.var(ddof=1)) / d.var(ddof=1)}


def pairs():
    common = ROWS.normal(0, 3, 40)
    a = rounded(common + ROWS.normal(0.4, 1, 40))
    b = rounded(common + ROWS.normal(0, 1, 40))
    failed_a, failed_b = a.copy(), b.copy()
    failed_a[[3, 17]] = np.nan
    failed_b[[3, 29]] = np.nan
    quarters = ROWS.integers(0, 9, (2, 30)) / 4  # many zeros and ties
    return [paired(a, b), paired(failed_a, failed_b), paired(*quarters), paired([1.0, 2.5, 4.0], [1.0, 2.0, 5.5]),
            paired(np.arange(12.0), np.arange(12.0) ** 2 + 1)]


def fisher():
    return [[a, of_a, b, of_b, stats.fisher_exact([[a, of_a - a], [b, of_b - b]])[1]]
            for a, of_a, b, of_b in [(13, 300, 0, 300), (0, 300, 13, 300), (2, 300, 2, 300), (0, 20, 0, 20),
                                     (20, 20, 20, 20), (20, 20, 0, 20), (5, 40, 9, 31), (1, 3, 2, 7),
                                     (40, 1000, 9, 700), (3000, 10**5, 2900, 10**5)]]


def wilcoxon_level(n, z=stats.norm.isf(0.025)):
    """Exact P(|score| >= z) of the signed-rank test for n pairs without ties: all 2^n signs, by the sum of ranks."""
    ways = np.array([1.0])
    for rank in range(1, n + 1):
        longer = np.concatenate([ways, np.zeros(rank)])
        longer[rank:] += ways
        ways = longer
    score = (np.arange(len(ways)) - n * (n + 1) / 4) / math.sqrt(n * (n + 1) * (2 * n + 1) / 24)
    return {"pairs": n, "level": ways[np.abs(score) >= z].sum() / 2.0**n}


def wilson():
    rows = []
    for successes, trials in [(0, 1), (1, 1), (0, 50), (50, 50), (1, 50), (37, 50), (990, 1000), (1, 10**6),
                              (950123, 10**6)]:
        for alpha in [0.05, 0.01]:
            ends = stats.binomtest(successes, trials).proportion_ci(1 - alpha, method="wilson")
            rows.append([successes, trials, alpha, ends.low, ends.high])
    return rows


def kolmogorov_smirnov():
    """SciPy's survival function; where it only approximates, the exact value by its slow matrix method too; and for
    10^9 values SciPy's exp(-t) with the next term of its expansion, t = (6 n d + 1)^2 / (18 n)."""
    scores = [0.3, 0.5, 0.7, 0.9, 1.1, 1.36, 1.4, 1.49, 1.63, 2.1, 2.5, 3.5]
    counts = [1, 2, 3, 10, 50, 140, 141, 256, 1000, 8192, 8193, 20000, 100000, 100001, 10**6]
    rows = [[z / math.sqrt(n), n] for n in counts for z in scores if z < math.sqrt(n)]
    rows += [[d, n] for n in [2, 10, 141, 1000] for d in [0.4 / n, 0.6 / n, 0.99 / n, 0.5, 0.7, 1 - 0.5 / n]]
    exact = [[z / math.sqrt(n), n] for n in [141, 200, 500, 1000] for z in scores[1:-2]]
    large = []
    for z in scores[7:]:
        d, n = z / math.sqrt(10**9), 10**9
        t = (6 * n * d + 1) ** 2 / (18 * n)
        large.append([d, n, 2 * math.exp(-t) * (1 - (2 * t * t - 4 * t - 1) / (18 * n))])
    rows += [[z / math.sqrt(10**9), 10**9] for z in scores[:7]]
    return {"scipy": [[d, n, stats.kstwo.sf(d, n)] for d, n in rows],
            "scipy_large": [[d, n, stats.kstwo.sf(d, n)] for d, n, _ in large],
            "exact": [[d, n, _ksstats._kolmogn_DMTW(n, d, cdf=False)] for d, n in exact], "large": large}


def distances():
    result = []
    for degrees, count, cells in [(1, 5, 8), (3, 60, 16), (9, 40, 64)]:
        values = rounded(stats.chi2.rvs(degrees, size=count, random_state=ROWS))
        counts, _ = np.histogram(values, stats.chi2.ppf(np.arange(cells + 1) / cells, degrees))
        seen = np.abs(np.cumsum(counts) / count - (np.arange(cells) + 1) / cells).max()
        result.append({"degrees": degrees, "values": values, "counts": counts, "cell_distance": seen,
                       "distance": stats.kstest(values, stats.chi2(degrees).cdf).statistic})
    return result


def credibility(n, count, failed):
    """Errors of a covariance that is not the one claimed, and the two indices by NumPy."""
    root = np.tril(ROWS.normal(0, 1, (n, n))) + 2 * np.eye(n)
    errors = rounded(ROWS.normal(0, 1, (count, n)) @ root.T + 0.1) * (10.0 ** -np.arange(n))
    nees = rounded(ROWS.chisquare(n, count))
    nees[failed] = np.nan
    e, eps = errors[~np.isnan(nees)], nees[~np.isnan(nees)]
    actual = np.einsum("ij,jk,ik->i", e, np.linalg.inv(e.T @ e / len(e)), e)
    decades = np.log10(eps / actual)
    return {"n": n, "nees": nees, "errors": errors.ravel(), "count": len(e), "nci": 10 * np.mean(np.abs(decades)),
            "inclination": 10 * np.mean(decades)}


print(json.dumps(plain({
    **quantiles(), "samples": samples(), "bootstrap": bootstraps(), "paired": pairs(),
    "fisher": fisher(), "wilcoxon_level": wilcoxon_level(30), "wilson": wilson(),
    "kolmogorov_smirnov": kolmogorov_smirnov(),
    "distances": distances(),
    "credibility": [credibility(1, 9, [2]), credibility(3, 40, [0, 39]), credibility(5, 12, [])],
    "bootstrap_coverage": coverages(),
})).replace("], \"", "],\n\"").replace("]], ", "]],\n"))
