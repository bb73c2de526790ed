"""The statistics of the verdict in their slow, obvious version: the oracle of src/statistics/{mean_bounds, directions,
bias, advice}.cpp. docs/statistics.md says what the rules are, and docs/theory/statistics.md why.

numbers(e, P, groups)          what a study keeps of each trial: a few numbers per trial, and sums by step
judge(numbers, limits, advise) the verdict, without failed trials: word, findings, what is missing, advice
judge_runs(e, P, groups)       the verdict on runs that are counted by segments where these are more

Every level is one-sided. N trials, K steps, n components; S and C are sums over the steps of a trial of e e' and P,
both standardised by the standard deviations in P.
"""

from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np
from scipy import optimize, stats

LEVEL_RUN, LEVEL_STEP, LEVEL_DIRECTION, LEVEL_BIAS = 0.03, 0.00125, 0.015, 0.0025  # false findings: together about 5 %
UNSEEN = 0.135            # that more trials were missed than a finding allows for
UNSEEN_OF_FEW = 0.01      # the same of trials of fewer than 20 numbers
LEVEL_ACCEPT = 0.025      # each side of an acceptance: a two-sided 95 % interval
DIRECTION_TRIALS = 20     # least number of trials for a claim about directions
FOLDS = 3                 # parts of the trials; a direction is found on the others
ROUNDING_ERROR = 2.0**-48  # errors of at most this size are rounding: the component is known exactly
ADVICE_TRIALS = 30        # least number of trials for an advice
ADVICE_DRAWS = 400
ADVICE_SHARE = 0.85       # more than the 80 % that are promised, for the noise of the advice itself
LAG_PRODUCTS = 30         # least number of products of a lag


@dataclass
class Limits:
    margin: float = 0.05
    direction: float = 0.10
    bias: float = 0.1
    epsilon: float = 2.0**-52


@dataclass
class Numbers:
    trials: int
    steps: int
    groups: list             # [(name, [components])], the whole state first
    run: np.ndarray          # [trial, group] mean over the steps of NEES/dim
    squares: np.ndarray      # [trial, n, n] S
    predicted: np.ndarray    # [trial, n, n] C
    bias: np.ndarray         # [trial, n] mean over the steps of e/sigma
    step_mean: np.ndarray = None   # [group, step] mean over the trials of NEES/dim
    step_sd: np.ndarray = None     # [group, step]
    index: np.ndarray = None       # [trial] in the study, where trials that failed are counted
    error_size: np.ndarray = None  # [n] largest |e| of all trials and steps
    of_segments: bool = False      # the trials are segments of runs

    def __post_init__(self):
        if self.index is None:
            self.index = np.arange(self.trials)


def numbers(e, P, groups):
    """e [trial, step, n]; P [trial, step, n, n], or [step, n, n] for the same in all trials, or None for identity."""
    trials, steps, n = e.shape
    if P is None:
        z, predicted = e, np.broadcast_to(np.eye(n) * steps, (trials, n, n))
        nees = np.stack([(e[..., c] ** 2).sum(-1) / len(c) for _, c in groups])
    else:
        sigma = np.sqrt(np.einsum("...ii->...i", P))
        z = e / sigma
        R = P / (sigma[..., :, None] * sigma[..., None, :])
        predicted = R.sum(1) if R.ndim == 4 else np.broadcast_to(R.sum(0), (trials, n, n))
        nees = np.stack([nees_of(z, R, c) for _, c in groups])
    return Numbers(trials, steps, groups, nees.mean(2).T, np.matmul(z.transpose(0, 2, 1), z), predicted, z.mean(1),
                   nees.mean(1), nees.std(1, ddof=1), nees.max(1), error_size=np.abs(e).max((0, 1)))


def nees_of(z, R, c):
    """NEES/dim [trial, step] of the components c."""
    L = np.linalg.cholesky(R[..., c, :][..., c])
    if R.ndim == 3:
        whitened = np.stack([np.linalg.solve(L[k], z[:, k][:, c].T).T for k in range(z.shape[1])], 1)
    else:
        whitened = np.linalg.solve(L, z[..., c][..., None])[..., 0]
    return (whitened**2).sum(-1) / len(c)


# Bounds on the mean of a positive number


@lru_cache(None)
def t_quantile(level, degrees):
    """Upper quantile. SciPy's t.isf is good to 1e-8 only; Newton's steps on its t.sf make it better."""
    q = stats.t.isf(level, degrees)
    for _ in range(4):
        q += (stats.t.sf(q, degrees) - level) / stats.t.pdf(q, degrees)
    return q


def share_of(level, g, groups):
    """The level of group g: half for the whole state, the other half shared by the groups."""
    return level if groups == 1 else level / 2 if g == 0 else level / (2 * (groups - 1))


def lower(mean, sd, trials, level):
    return mean - t_quantile(level, trials - 1) * sd / np.sqrt(trials)


def upper(mean, sd, trials, level, unseen=None):
    """Student's bound and, for findings, what a share of trials that were not seen adds if each has a squared error of
    nine times the mean. The share: of which none is seen in `trials` with the probability `unseen`."""
    share = 0 if unseen is None else 1 - unseen ** (1 / trials)
    return mean + t_quantile(level, trials - 1) * sd / np.sqrt(trials) + share * 8 * mean


def ratio_numbers(a, b):
    """One number per trial whose mean is sum a / sum b, to first order."""
    r = a.sum() / b.sum()
    return r + (a - r * b) / b.mean()


# Directions


def resolved_basis(predicted, limits):
    """Orthonormal basis of the directions in which rounding may change a ratio by a tenth of the margin at most."""
    d = len(predicted)
    values, vectors = np.linalg.eigh(predicted * d / np.trace(predicted))
    kept = values >= d * limits.epsilon / (0.1 * limits.margin)
    return np.eye(d) if kept.all() else vectors[:, kept]


def generalised(squares, predicted, basis):
    """Eigenvalues, ascending, and eigenvectors v, v'predicted v = 1, in the span of the basis."""
    L = np.linalg.cholesky(basis.T @ predicted @ basis)
    A = np.linalg.solve(L, np.linalg.solve(L, basis.T @ squares @ basis).T)
    values, w = np.linalg.eigh((A + A.T) / 2)
    return values, basis @ np.linalg.solve(L.T, w)


def form(v, matrices):
    return np.einsum("i,tij,j->t", v, matrices, v, optimize=True)


def part_of(matrices, components):
    return matrices[:, components][:, :, components]


def parts(S):
    """Of each trial the part that it is in: the sum of SplitMix64 of its squared errors, in single precision."""
    total = np.zeros(len(S), dtype=np.uint64)
    for number in np.diagonal(S, axis1=1, axis2=2).astype(np.float32).view(np.uint32).T:
        hashes = number.astype(np.uint64) + np.uint64(0x9E3779B97F4A7C15)
        for shift, factor in ((30, 0xBF58476D1CE4E5B9), (27, 0x94D049BB133111EB)):
            hashes = (hashes ^ (hashes >> np.uint64(shift))) * np.uint64(factor)
        total += hashes ^ (hashes >> np.uint64(31))
    return (total % np.uint64(FOLDS)).astype(int)


def crossed(x, components, which, limits):
    """One number per trial, its direction found on the other parts, and the directions."""
    S, C = part_of(x.squares, components), part_of(x.predicted, components)
    basis = resolved_basis(C.sum(0), limits)
    a, b = np.empty(x.trials), np.empty(x.trials)
    directions = []
    part = parts(S)
    for fold in range(FOLDS):
        train, test = part != fold, part == fold
        v = generalised(S[train].mean(0), C[train].mean(0), basis)[1][:, which]
        a[test], b[test] = form(v, S[test]), form(v, C[test])
        directions.append(v)
    return ratio_numbers(a, b), directions


def extreme(x, components, which, limits):
    """The same in the direction of all trials: biased outwards, therefore safe for an acceptance."""
    S, C = part_of(x.squares, components), part_of(x.predicted, components)
    v = generalised(S.mean(0), C.mean(0), resolved_basis(C.sum(0), limits))[1][:, which]
    return ratio_numbers(form(v, S), form(v, C)), v


def named(v, components):
    """{component: weight}: of unit length, the largest entry positive, those below a tenth of it left out."""
    most = np.argmax(np.abs(v))
    v = v * np.sign(v[most]) / np.linalg.norm(v)
    return {components[j]: v[j] for j in range(len(v)) if abs(v[j]) >= 0.1 * v[most]}


def is_approximate(directions, v, predicted):
    """Whether the direction of some part is far from v, in the metric of P."""
    C = predicted.mean(0)
    return any(abs(u @ C @ v) < 0.7 * np.sqrt((u @ C @ u) * (v @ C @ v)) for u in directions)


# The verdict


@dataclass
class Verdict:
    word: str = "undecided"
    findings: list = field(default_factory=list)  # (kind, where, side, value, bound)
    missing: list = field(default_factory=list)   # why it is not consistent
    advice: tuple = None                          # (low, number, high, the need that binds)


def judge(x, limits=Limits(), advise=False):
    v = Verdict()
    find_nees(x, limits, v)
    find_components(x, limits, v)
    if x.trials >= DIRECTION_TRIALS:
        find_directions(x, limits, v)
    find_bias(x, limits, v)
    accept(x, limits, v)
    above = any(f[2] == "above" for f in v.findings)
    below = any(f[2] == "below" for f in v.findings)
    v.word = ("mixed" if above and below else "optimistic" if above else "pessimistic" if below
              else "undecided" if v.missing else "consistent")
    if advise and v.word == "undecided" and x.trials >= ADVICE_TRIALS:
        v.advice = advice(x, limits)
    return v


def beyond_chi_square(mean, degrees, side, level, margin):
    """Student's interval is too narrow for few trials, because chi-square is skewed: a claim must also be beyond the
    exact bound for NEES distributed as (1 -+ margin) chi-square."""
    if degrees is None:
        return True
    if side == "above":
        return mean / (1 + margin) * degrees > stats.chi2.isf(level, degrees)
    return mean / (1 - margin) * degrees < stats.chi2.ppf(level, degrees)


def compare(v, kind, where, mean, sd, trials, degrees, level, margin, unseen=UNSEEN, largest=0, numbers=np.inf):
    """Both sides of one figure. Of segments, one more like the largest may have been missed; of trials of few numbers,
    what was missed is nine whatever the mean is."""
    low, high = lower(mean, sd, trials, level), upper(mean, sd, trials, level, unseen)
    if numbers < 20:
        high = upper(mean, sd, trials, level) + (1 - min(unseen, UNSEEN_OF_FEW) ** (1 / trials)) * max(0, 9 - mean)
    high += max(0, largest - mean) / trials
    if low > 1 + margin and beyond_chi_square(mean, degrees, "above", level, margin):
        v.findings.append((kind, where, "above", mean, low))
    if high < 1 - margin and beyond_chi_square(mean, degrees, "below", level, margin):
        v.findings.append((kind, where, "below", mean, high))


def degrees_over_steps(X, dimension, steps):
    """Of the NEES over all steps, from its spread: at least one step's, at most all steps'."""
    fewest = len(X) * dimension
    return np.clip(2 * len(X) * (X.mean() / X.std(ddof=1)) ** 2, fewest, fewest * steps)


def own_groups(x):
    """The components that are groups beside those that are named."""
    return [j for j in x.groups[0][1] if [j] not in [list(c) for _, c in x.groups]]


def find_mean(x, X, kind, name, dimension, g, limits, v):
    compare(v, kind, name, X.mean(), X.std(ddof=1), len(X), degrees_over_steps(X, dimension, x.steps),
            share_of(LEVEL_RUN, g, len(x.groups) + len(own_groups(x))) / 2, limits.margin,
            largest=X.max() if x.of_segments or x.steps * dimension < 20 else 0, numbers=x.steps * dimension)


def find_components(x, limits, v):
    for place, j in enumerate(own_groups(x)):
        if x.error_size[j] > ROUNDING_ERROR:
            find_mean(x, x.squares[:, j, j] / x.predicted[:, j, j], "run", j, 1, len(x.groups) + place, limits, v)


def find_nees(x, limits, v):
    N, G = x.trials, len(x.groups) + len(own_groups(x))
    for g, (name, c) in enumerate(x.groups):
        find_mean(x, x.run[:, g], "run", name, len(c), g, limits, v)
        for k in range(x.steps if x.step_mean is not None else 0):
            level = LEVEL_STEP / (2 * G * x.steps)
            compare(v, "step", (name, k), x.step_mean[g, k], x.step_sd[g, k], N, N * len(c), level, limits.margin,
                    level, numbers=len(c))


def find_directions(x, limits, v):
    groups = [(name, c) for name, c in x.groups if len(c) >= 2]
    for g, (name, c) in enumerate(groups):
        level = share_of(LEVEL_DIRECTION, g, len(groups)) / 2
        for which in (-1, 0):
            found = direction_found(x, crossed(x, c, which, limits)[0], which, level, limits, len(c))
            if found:
                v.findings.append(("direction", name, *found))


def direction_found(x, y, which, level, limits, dimension):
    """The claim on the numbers y of a direction, as of a group of one component; of many trials without chi-square."""
    one = Verdict()
    degrees, numbers_ = degrees_over_steps(y, 1, x.steps) if x.trials < 200 else None, x.steps * dimension
    compare(one, "", "", y.mean(), y.std(ddof=1), x.trials, degrees, level, limits.margin,
            largest=y.max() if x.of_segments or numbers_ < 20 else 0, numbers=numbers_)
    side = "above" if which == -1 else "below"
    return next((finding[2:] for finding in one.findings if finding[2] == side), None)


def known_exactly(x, j, limits):
    z = x.bias[:, j]
    return x.error_size[j] <= ROUNDING_ERROR or (z.std(ddof=1) == 0 and abs(z.mean()) <= limits.bias)


def bias_half(x, j, level):
    return t_quantile(level, x.trials - 1) * x.bias[:, j].std(ddof=1) / np.sqrt(x.trials)


def find_bias(x, limits, v):
    n = x.bias.shape[1]
    for j in range(n):
        mean, half = x.bias[:, j].mean(), bias_half(x, j, LEVEL_BIAS / (2 * n))
        if not known_exactly(x, j, limits) and abs(mean) - half > limits.bias:
            v.findings.append(("bias", j, "above", mean, abs(mean) - half))


def accepts(low, high, trials, margin):
    """Of the numbers per trial whose mean must not be too small, and those whose mean must not be too large."""
    return (lower(low.mean(), low.std(ddof=1), trials, LEVEL_ACCEPT) >= 1 - margin
            and upper(high.mean(), high.std(ddof=1), trials, LEVEL_ACCEPT) <= 1 + margin)


def accepts_directions(x, limits):
    c = x.groups[0][1]
    return x.trials >= DIRECTION_TRIALS and accepts(extreme(x, c, 0, limits)[0], extreme(x, c, -1, limits)[0],
                                                    x.trials, limits.direction)


def accepts_bias(x, j, limits):
    return known_exactly(x, j, limits) or abs(x.bias[:, j].mean()) + bias_half(x, j, LEVEL_ACCEPT) <= limits.bias


def accept(x, limits, v):
    v.missing += [("run", name) for g, (name, _) in enumerate(x.groups)
                  if not accepts(x.run[:, g], x.run[:, g], x.trials, limits.margin)]
    if len(x.groups[0][1]) > 1 and not accepts_directions(x, limits):
        v.missing.append(("direction", x.groups[0][0]))
    v.missing += [("bias", j) for j in range(x.bias.shape[1]) if not accepts_bias(x, j, limits)]


# Runs by segments

MOST_RUNS, RUNS_THAT_TELL, LEAST_SEGMENTS, MOST_SEGMENTS, DOUBTED = 200, 5, 20, 4096, 0.01
ONE_DRAW = 3.2            # a mean error of runs that were drawn once each is below this many sigmas, over their root


def autocorrelation_time(values):
    """Sokal's, of a series about 0."""
    K = len(values)
    time = 0.5
    for lag in range(1, K // 2 + 1):
        time += (values[:-lag] * values[lag:]).sum() / (values**2).sum()
        if lag >= 5 * time:
            return max(time, 0.5)
    return np.inf


def without_trend(values, degree):
    t = np.linspace(-1, 1, len(values))
    return values - np.polyval(np.polyfit(t, values, degree), t)


def longest_time(z, nees):
    """z [run, step, n], nees [group, run, step]. Of few runs an offset and a drift are not correlation."""
    few = len(z) < RUNS_THAT_TELL
    series = [without_trend(one, 1) if few else one for run in z for one in run.T]
    series += [without_trend(one, 2) if few else one - one.mean() for group in nees for one in group]
    return max(autocorrelation_time(one) for one in series)


def segment_length(time, runs, steps):
    """0 where segments do not count."""
    count = lambda length: runs * (steps // length)  # noqa: E731
    if runs > MOST_RUNS or not np.ceil(10 * time) / 2 <= steps:
        return 0
    length = min(int(max(np.ceil(10 * time), np.ceil(runs * steps / MOST_SEGMENTS))), steps)
    shortest, parts = int(np.ceil(np.ceil(10 * time) / 2)), 1
    while count(length) < LEAST_SEGMENTS and length > shortest:
        length, parts = min(length, max(steps // parts, shortest)), parts + 1
    length = steps // (steps // length)
    return length if count(length) >= max(LEAST_SEGMENTS, 2 * runs) else 0


def cut(values, length):
    """[run, step, ...] as [segment, step, ...]."""
    runs, steps = values.shape[:2]
    count = steps // length
    return values[:, : count * length].reshape(runs * count, length, *values.shape[2:])


def runs_differ(values, runs, level):
    """One number a segment, as many of each run."""
    of = values.reshape(runs, -1)
    return runs > 1 and stats.f_oneway(*of).pvalue < level


def drifts(values, runs, level):
    """Whether the lines through the segments of each run explain more than chance."""
    of = values.reshape(runs, -1)
    left = sum((without_trend(one, 1) ** 2).sum() for one in of)
    explained = sum(((one - one.mean()) ** 2).sum() for one in of) - left
    degrees = of.size - 2 * runs
    return explained / runs > left / degrees * stats.f.isf(level, runs, degrees)


def explained(finding, x, runs, limits):
    """Whether a NEES/dim that is too small, or a direction, may be due to what was drawn once in each run: Chernoff."""
    kind, where, _, mean, _ = finding
    if kind != "run":
        return True
    names, own = [name for name, _ in x.groups], own_groups(x)
    g = names.index(where) if where in names else len(names) + own.index(where)
    d = len(x.groups[g][1]) if g < len(names) else 1
    level = share_of(LEVEL_RUN, g, len(names) + len(own)) / 2
    least = optimize.brentq(lambda c: runs * d / 2 * (c - 1 - np.log(c)) + np.log(level), 1e-300, 1)
    return mean / least >= 1 - limits.margin


def about_means(e, P, length, drifting):
    """Errors about the mean of their run or, of a component that drifts, of their segment, weighted by 1/P_jj."""
    w = 1 / np.einsum("rkii->rki", P)
    mean = lambda e, w: (e * w).sum(1, keepdims=True) / w.sum(1, keepdims=True)  # noqa: E731
    return np.where(drifting, cut(e, length) - mean(cut(e, length), cut(w, length)), cut(e - mean(e, w), length))


def judge_runs(e, P, groups, limits=Limits()):
    """e [run, step, n], P [run, step, n, n]. Returns the verdict and the length of segments, 0 where runs count."""
    R, K, n = e.shape
    of_runs = numbers(e, P, groups)
    sigma = np.sqrt(np.einsum("rkii->rki", P))
    correlations = P / (sigma[..., :, None] * sigma[..., None, :])
    z = e / sigma
    length = segment_length(longest_time(z, [nees_of(z, correlations, c) for _, c in groups]), R, K)
    if not length:
        return judge(of_runs, limits), 0
    x = numbers(cut(e, length), cut(P, length), groups)
    few = R < RUNS_THAT_TELL
    drifting = np.array([few and drifts(x.bias[:, j], R, DOUBTED / n) for j in range(n)])
    about = numbers(about_means(e, P, length, drifting), cut(P, length), groups) if few else x
    compared = list(about.run.T) + ([] if few else list(x.bias.T))
    if any(runs_differ(one, R, DOUBTED / (len(groups) + n)) for one in compared):
        return judge(of_runs, limits), 0
    x.of_segments, x.step_mean = True, None
    v = Verdict()
    for numbers_, side in ((about, "above"), (x, "below")):
        one = Verdict()
        find_nees(numbers_, limits, one), find_components(numbers_, limits, one)
        find_directions(numbers_, limits, one)
        withheld = few and side == "below"
        v.findings += [f for f in one.findings if f[2] == side and not (withheld and explained(f, x, R, limits))]
    steps = Verdict()
    find_nees(of_runs, limits, steps)
    v.findings += [f for f in steps.findings if f[0] == "step"]
    one = Verdict()
    find_bias(x if few else of_runs, limits, one)
    v.findings += [f for f in one.findings if not few or f[4] > ONE_DRAW / np.sqrt(R)]
    if few:
        v.missing.append("what is drawn once in a run")
    accept(x, limits, v)
    above, below = (any(f[2] == side for f in v.findings) for side in ("above", "below"))
    v.word = ("mixed" if above and below else "optimistic" if above else "pessimistic" if below
              else "undecided" if v.missing else "consistent")
    return v, length


# Advice


def trials_for(scaled, margin):
    """Least N with scaled/sqrt(N) <= margin."""
    return (np.maximum(scaled, 0) / margin) ** 2


def advice(x, limits, weights=None):
    """The number of trials at which an exactly consistent filter with this spread is shown consistent in 80 % of
    studies: the trials' numbers are centred on what is exactly consistent, and N trials are drawn from them with
    multipliers, the normal approximation of a resampled mean.
    weights [draw, trial]: standard normal draws."""
    if weights is None:
        weights = np.random.default_rng(0).standard_normal((ADVICE_DRAWS, x.trials))
    weights = (weights - weights.mean(1, keepdims=True)) / np.sqrt(x.trials)
    needs = needs_of(x, limits, weights)
    least = DIRECTION_TRIALS if len(x.groups[0][1]) > 1 else 2
    each = np.stack([trials_for(scaled, margin) for scaled, margin, _, _ in needs])  # [need, draw]
    number = max(least, np.quantile(each.max(0), ADVICE_SHARE))
    binding = needs[np.argmax(np.quantile(each, ADVICE_SHARE, axis=1))]
    values = binding[2]
    kurtosis = ((values - values.mean()) ** 4).mean() / values.var() ** 2
    width = np.exp(1.645 * np.sqrt((kurtosis - 1) / x.trials + 0.01))
    return number / width, number, number * width, binding[3]


def needs_of(x, limits, weights):
    """What must hold for `consistent`: (scaled deviation by draw, margin, values, name) each."""
    q, needs = stats.norm.isf(LEVEL_ACCEPT), []
    for g in range(x.run.shape[1]):
        X = x.run[:, g] / x.run[:, g].mean()
        Z, sd = weights @ X, X.std(ddof=1)
        needs.append((Z + q * sd * (1 + limits.margin), limits.margin, X, ("run", g, "above")))
        needs.append((-Z + q * sd, limits.margin, X, ("run", g, "below")))
    for j in range(x.bias.shape[1]):
        if not known_exactly(x, j, limits):
            z = x.bias[:, j]
            needs.append((np.abs(weights @ z) + q * z.std(ddof=1), limits.bias, z, ("bias", j, "above")))
    return needs + direction_needs(x, limits, weights, q)


def direction_needs(x, limits, weights, q):
    if len(x.groups[0][1]) < 2:
        return []
    needs, R = [], whitened(x)
    values, vectors = np.linalg.eigh(np.tensordot(weights, R, 1))
    for which in (-1, 0):
        w = vectors[:, :, which]
        forms = R.reshape(x.trials, -1) @ (w[:, :, None] * w[:, None, :]).reshape(len(w), -1).T  # [trial, draw]
        sd, first = forms.std(0, ddof=1), forms[:, 0]
        if which == -1:  # the spread grows with the ratio
            needs.append((values[:, -1] + q * sd * (1 + limits.direction), limits.direction, first,
                          ("direction", 0, "above")))
        else:
            needs.append((-values[:, 0] + q * sd, limits.direction, first, ("direction", 0, "below")))
    return needs


def whitened(x):
    """Residuals of every trial, centred on an exactly consistent filter, in coordinates where mean P is I."""
    S, C = part_of(x.squares, x.groups[0][1]), part_of(x.predicted, x.groups[0][1])
    A, D = (np.linalg.inv(np.linalg.cholesky(m.mean(0))) for m in (S, C))
    return np.matmul(np.matmul(A, S), A.T) - np.matmul(np.matmul(D, C), D.T)


def trials_to_show(mean, sd, level, margin, trials):
    """Trials at which a finding would be made if mean and sd stay; inf where the mean is inside."""
    a, room = t_quantile(level, trials - 1) * sd, abs(mean - 1) - margin
    c = np.log(1 / UNSEEN) * 8 * mean if mean < 1 else 0
    return ((a + np.sqrt(a * a + 4 * room * c)) / (2 * room)) ** 2 if room > 0 else np.inf


# Whiteness


def whiteness(innovations, level=0.05, most=10):
    """innovations [trial, step, row], whitened, NaN where a row is not observed. Lags count measurements, whatever the
    steps between. Returns [(lag, r, half-width, products)]; empty where no test can be made."""
    trials = [v[~np.isnan(v).all(1)] for v in innovations]
    sums = {}
    for lag in range(1, min(most, max(len(v) for v in trials) - 1) + 1):
        products = [v[:-lag] * v[lag:] for v in trials if len(v) > lag]
        p = np.array([np.nansum(q) for q in products])
        c = np.array([(~np.isnan(q)).sum() for q in products])
        if c.sum() >= LAG_PRODUCTS:
            sums[lag] = p[c > 0], c[c > 0], sum(np.nansum(q * q) for q in products)
    return [(lag, *correlation(*sums[lag], level / len(sums) / 2), sums[lag][1].sum()) for lag in sums]


def correlation(p, c, single_squares, level):
    """Correlation from the sums p over c products of every trial, and the half-width of its interval."""
    r = p.sum() / c.sum()
    normal = stats.norm.isf(level) * np.sqrt(single_squares) / c.sum()
    if len(p) < 2:
        return r, normal
    y = r + (p - r * c) / c.mean()
    half = t_quantile(level, len(p) - 1) * y.std(ddof=1) / np.sqrt(len(p))
    return r, half if len(p) >= 8 else max(half, normal)
