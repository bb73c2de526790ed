"""What is in a record for `credence judge`, by NumPy and SciPy. See make_records.py."""

import math

import numpy as np
from scipy import stats

LEVELS = [0.5, 0.9, 0.95, 0.99]


class Record:
    def __init__(self, error, covariance, innovation=None, innovation_covariance=None, groups=None):
        self.error, self.covariance, self.steps = error, covariance, None
        self.innovation, self.innovation_covariance = innovation, innovation_covariance
        self.groups = groups or {}

    def datasets(self):
        names = ["error", "covariance", "innovation", "innovation_covariance", "steps"]
        return {name: getattr(self, name) for name in names if getattr(self, name) is not None}


def smallest_eigenvalues(covariances):
    """Of the correlation matrices; a component without variance keeps its zeros."""
    scale = np.sqrt(np.abs(np.diagonal(covariances, axis1=-2, axis2=-1)))
    scale = np.where(scale > 0, scale, 1)
    return np.linalg.eigvalsh(covariances / scale[..., :, None] / scale[..., None, :])[..., 0]


class Expected:
    """Figures of one record: values [trial, step], NaN where there is none."""

    def __init__(self, record):
        self.record = record
        self.trials, self.steps, self.n = record.error.shape
        self.groups = {"all": (0, self.n), **record.groups}
        known_error = ~np.isnan(record.error).all(axis=2)
        self.there = known_error | ~np.isnan(record.covariance).all(axis=(2, 3))
        last = [np.flatnonzero(row)[-1] + 1 if row.any() else 0 for row in known_error]
        self.ends = np.full(self.trials, max(last)) if record.steps is None else record.steps
        if record.steps is not None:
            self.there &= np.arange(self.steps) < record.steps[:, None]
        finite = np.isfinite(record.error).all(axis=2) & np.isfinite(record.covariance).all(axis=(2, 3))
        self.broken = self.there & ~finite
        self.P = np.where((self.there & finite)[..., None, None], record.covariance, np.eye(self.n))
        if record.innovation is not None:
            self.observed = ~np.isnan(record.innovation) & self.there[..., None]
            both = self.observed[..., :, None] & self.observed[..., None, :]
            # A row that is not observed becomes a 0 of variance 1 of its own: it changes neither NIS nor other rows.
            S, nu = (np.where(where, values, other) for where, values, other in
                     ((both, record.innovation_covariance, np.eye(both.shape[-1])), (self.observed, record.innovation, 0)))
            self.broken |= ~(np.isfinite(nu).all(axis=2) & np.isfinite(S).all(axis=(2, 3)))
            self.S = np.where(self.broken[..., None, None], np.eye(both.shape[-1]), S)
            self.nu = np.where(self.broken[..., None], 0, nu)
        self.troubles = self.find_troubles()
        self.failed = np.zeros(self.trials, dtype=bool)
        self.failed[[trouble[0] for trouble in self.troubles]] = True
        self.there &= ~self.failed[:, None]
        self.values = {}
        self.white = None
        self.compute_state()
        if record.innovation is not None:
            self.compute_innovations()
        self.counted = ~self.failed
        self.set_diverged_aside()

    def set_diverged_aside(self):
        """Unless more than half diverged. A trial of fewer than 20 numbers is not."""
        nees = self.values["nees", "all"]
        ratio = np.full(self.trials, np.nan)
        ratio[~self.failed] = np.nanmean(nees[~self.failed], axis=1) / self.n
        diverged = np.flatnonzero((ratio > 25) & (self.there.sum(axis=1) * self.n >= 20))
        if 2 * len(diverged) > (~self.failed).sum():
            return
        self.troubles += [[trial, int(np.nanargmax(nees[trial])),
                           f"the trial diverged: NEES/dim {ratio[trial]:.3g} over its steps, most here", 1]
                          for trial in diverged]
        self.troubles.sort(key=lambda trouble: trouble[0])
        self.counted[diverged] = False

    def find_troubles(self):
        """[trial, step, what, status] of the first trouble of each trial that has one."""
        smallest = [("covariance", smallest_eigenvalues(self.P))]
        if self.record.innovation is not None:
            smallest.append(("innovation covariance", smallest_eigenvalues(self.S)))
        beyond = np.nan_to_num(np.abs(self.record.error)).max(axis=2) > 1e70
        found = []
        for trial in range(self.trials):
            of_trial = []
            for step in np.flatnonzero(self.there[trial]):
                if self.broken[trial, step]:
                    of_trial.append([step, self.what_is_broken(trial, step), 3])
                    continue
                for name, value in smallest:
                    if value[trial, step] < 1e-12:
                        worse = value[trial, step] < -1e-12
                        of_trial.append([step, f"{name} is {'not positive definite' if worse else 'singular'}", 2])
                if beyond[trial, step]:
                    of_trial.append([step, "a figure of this step is beyond 1e140", 3])
            found += [[trial, *one] for one in (of_trial + self.early_end(trial))[:1]]
        return found

    def early_end(self, trial):
        if not self.there[trial].any():
            return [[0, "no step exists: every error is NaN", 3]]
        end, asked = int(np.flatnonzero(self.there[trial])[-1]) + 1, int(self.ends[trial])
        if end >= asked:
            return []
        of, unsaid = f"the trial ends after {end} of ", ", and no dataset `steps` declares that it is shorter"
        return [[end, of + (f"{asked} steps{unsaid}" if self.record.steps is None
                            else f"the {asked} steps that `steps` declares"), 3]]

    def what_is_broken(self, trial, step):
        e, P = self.record.error[trial, step], self.record.covariance[trial, step]
        if np.isnan(e).all():
            return "the error is NaN, and the covariance is not"
        if np.isnan(P).all():
            return "the covariance is NaN, and the error is not"
        variances = np.diagonal(P)
        for j in range(self.n):
            if np.isnan(variances[j]) and not np.isnan(e[j]):
                return f"the covariance of `x{j}` is NaN, and the error is not"
            if np.isnan(e[j]) and not np.isnan(variances[j]):
                return f"the error of `x{j}` is NaN, and the covariance is not"
        for what, values in (("error", e), ("covariance", P)):
            if not np.isfinite(values).all():
                return f"the {what} is not finite"
        return f"the innovation{'' if np.isinf(self.record.innovation[trial, step]).any() else ' covariance'} is not finite"

    def put(self, name, part, values):
        """`values` of the steps that are there, in order."""
        self.values[name, part] = np.full((self.trials, self.steps), np.nan)
        self.values[name, part][self.there] = values

    def compute_state(self):
        error, covariance = self.record.error[self.there], self.P[self.there]
        self.log_score = np.full((self.trials, self.steps), np.nan)
        score = np.empty(len(error))
        distinct, which = np.unique(covariance, axis=0, return_inverse=True)
        for i, P in enumerate(distinct):  # as SciPy decomposes each of them once
            score[which == i] = -stats.multivariate_normal.logpdf(error[which == i], cov=P)
        self.log_score[self.there] = score
        for name, (first, end) in self.groups.items():
            block, e = covariance[:, first:end, first:end], error[:, first:end]
            self.put("nees", name, (e * np.linalg.solve(block, e[..., None])[..., 0]).sum(axis=1))
            self.put("squared_error", name, (e**2).sum(axis=1))
            self.put("variance", name, np.trace(block, axis1=1, axis2=2))
        for j in range(self.n):
            self.put("standardised_error", f"x{j}", error[:, j] / np.sqrt(covariance[:, j, j]))

    def compute_innovations(self):
        S, nu = self.S[self.there], self.nu[self.there]
        self.put("nis", "all", (nu * np.linalg.solve(S, nu[..., None])[..., 0]).sum(axis=1))
        self.put("nis_rows", "all", self.observed[self.there].sum(axis=1))
        white = np.linalg.solve(np.linalg.cholesky(S), nu[..., None])[..., 0]
        self.white = np.full(self.nu.shape, np.nan)
        self.white[self.there] = np.where(self.observed[self.there], white, np.nan)

    def figure(self, name, part, values):
        values = values[self.counted]
        run = np.nanmean(values, axis=1) * self.steps
        if name in ("nis", "nis_rows"):
            run = np.nansum(values, axis=1)
        result = {"name": name, "part": part, "sum": np.nansum(values, axis=0), "run_sum": run.sum(),
                  "run_square_sum": (run**2).sum()}
        if name != "nis_rows":
            result["square_sum"] = np.nansum(values**2, axis=0)
        if name == "nees":
            first, end = self.groups[part]
            bounds = stats.chi2.ppf(LEVELS, end - first)
            result["dimension"] = end - first
            result["covered"] = [[int((values[:, k] < bound).sum()) for bound in bounds] for k in range(self.steps)]
        return result

    def products(self):
        """A lag counts the measurements of a row, whatever the steps between."""
        result = {"sum": [], "square_sum": [], "count": []}
        rows = [[row[~np.isnan(row)] for row in trial.T] for trial in self.white[self.counted]]
        for lag in range(1, min(10, self.steps - 1) + 1):
            pairs = [[row[lag:] * row[:-lag] for row in trial] for trial in rows]
            of_trials = np.array([sum(pair.sum() for pair in trial) for trial in pairs])
            result["sum"].append(of_trials.sum())
            result["square_sum"].append((of_trials**2).sum())
            result["count"].append(sum(len(pair) for trial in pairs for pair in trial))
        return result

    def columns(self):
        used = ~self.failed
        result = {name: np.full(self.trials, np.nan)
                  for name in ["trace_P", "pose_error", "nees_ratio", "nis_ratio", "mean_trace_P", "log_score"]}
        trace = self.values["variance", "all"]
        last = [np.flatnonzero(row)[-1] if row.any() else 0 for row in self.there]
        pose = "pose" if "pose" in self.groups else "all"
        result["trace_P"] = np.where(used, trace[np.arange(self.trials), last], np.nan)
        result["mean_trace_P"][used] = np.nanmean(trace[used], axis=1)
        result["pose_error"][used] = np.nansum(self.values["squared_error", pose][used], axis=1)
        result["nees_ratio"][used] = np.nanmean(self.values["nees", "all"][used], axis=1) / self.n
        result["log_score"][used] = np.nanmean(self.log_score[used], axis=1)
        if self.white is not None:
            sums = [np.nansum(self.values[name, "all"][used], axis=1) for name in ("nis", "nis_rows")]
            result["nis_ratio"][used] = np.divide(*sums, out=np.full(len(sums[0]), np.nan), where=sums[1] > 0)
        result["status"] = np.zeros(self.trials)
        result["status_pose"] = np.full(self.trials, -1.0)
        for trial, step, _, status in self.troubles:
            result["status"][trial], result["status_pose"][trial] = status, step + 1 if status > 1 else -1
        return result

    def everything(self, by_trial=True):
        nees = self.values["nees", "all"]
        there = self.there & self.counted[:, None]
        of_step = [nees[there[:, k], k] for k in range(self.steps)]
        result = {
            "trials": self.trials, "steps": self.steps, "n": self.n, "counted": int(self.counted.sum()),
            "present": there.sum(axis=0),
            "troubles": [trouble[:3] for trouble in self.troubles],
            "figures": [self.figure(*key, values) for key, values in self.values.items()],
            "shape_distance": [stats.kstest(v, stats.chi2(self.n).cdf).statistic if len(v) else math.nan
                               for v in of_step],
            "products": self.products() if self.white is not None else None,
        }
        if by_trial:
            result["columns"] = self.columns()
            result["nees"] = nees
        return result


def plain(value):
    """The value with NumPy's types made Python's, and NaN None."""
    if isinstance(value, dict):
        return {key: plain(one) for key, one in value.items()}
    if isinstance(value, (list, tuple, np.ndarray)):
        return [plain(one) for one in value]
    if value is None or isinstance(value, str):
        return value
    if isinstance(value, (int, np.integer)):
        return int(value)
    return None if math.isnan(value) else float(value)
