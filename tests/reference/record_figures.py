"""What is in a record for `credence judge`, by NumPy and SciPy. See make_records.py."""

import math

import numpy as np
from scipy import stats

LEVELS = [0.5, 0.9, 0.95, 0.99]
CELLS = 4096


class Record:
    def __init__(self, error, covariance, innovation=None, innovation_covariance=None, blocks=None):
        self.error, self.covariance = error, covariance
        self.innovation, self.innovation_covariance = innovation, innovation_covariance
        self.blocks = blocks or {}

    def datasets(self):
        names = ["error", "covariance", "innovation", "innovation_covariance"]
        return {name: getattr(self, name) for name in names if getattr(self, name) is not None}


def squared(covariance, error):
    """e' P^-1 e"""
    return float(error @ np.linalg.solve(covariance, error))


def bad_covariance(covariance):
    """Whether it is not positive definite: singular, or worse. None: it is."""
    scale = np.sqrt(np.abs(np.diag(covariance)))
    scale[scale == 0] = 1
    smallest = np.linalg.eigvalsh(covariance / np.outer(scale, scale))[0]
    if smallest < -1e-12:
        return "is not positive definite"
    return "is singular" if smallest < 1e-12 else None


class Expected:
    """Figures of one record: values [trial, step], NaN where there is none."""

    def __init__(self, record):
        self.record = record
        self.trials, self.steps, self.n = record.error.shape
        self.blocks = {"all": (0, self.n), **record.blocks}
        self.there = ~np.isnan(record.error).all(axis=2)
        self.troubles = self.find_troubles()
        self.failed = np.zeros(self.trials, dtype=bool)
        self.failed[[trouble[0] for trouble in self.troubles]] = True
        self.there &= ~self.failed[:, None]
        self.values = {}
        self.white = None
        self.compute_state()
        if record.innovation is not None:
            self.compute_innovations()

    def find_troubles(self):
        found = []
        for trial in range(self.trials):
            trouble = self.first_trouble(trial)
            if trouble:
                found.append([trial, *trouble])
        return found

    def first_trouble(self, trial):
        for step in range(self.steps):
            if not self.there[trial, step]:
                continue
            what = bad_covariance(self.record.covariance[trial, step])
            if what:
                return [step, "covariance " + what, 2]
            if np.abs(self.record.error[trial, step]).max() > 1e70:
                return [step, "a figure of this step is beyond 1e140", 3]
            if self.record.innovation is None:
                continue
            rows = ~np.isnan(self.record.innovation[trial, step])
            what = bad_covariance(self.record.innovation_covariance[trial, step][np.ix_(rows, rows)]) if rows.any() else None
            if what:
                return [step, "innovation covariance " + what, 2]
        return None if self.there[trial].any() else [0, "no step exists: every error is NaN", 3]

    def put(self, name, part, at, value):
        self.values.setdefault((name, part), np.full((self.trials, self.steps), np.nan))[at] = value

    def compute_state(self):
        error, covariance = self.record.error, self.record.covariance
        for at in zip(*np.nonzero(self.there)):
            for name, (first, end) in self.blocks.items():
                block, e = covariance[at][first:end, first:end], error[at][first:end]
                self.put("nees", name, at, squared(block, e))
                self.put("squared_error", name, at, float(e @ e))
                self.put("variance", name, at, float(np.trace(block)))
            for j in range(self.n):
                self.put("standardised_error", f"x{j}", at, error[at][j] / math.sqrt(covariance[at][j, j]))

    def compute_innovations(self):
        innovation, covariance = self.record.innovation, self.record.innovation_covariance
        self.white = np.full(innovation.shape, np.nan)
        for at in zip(*np.nonzero(self.there)):
            rows = np.flatnonzero(~np.isnan(innovation[at]))
            block, nu = covariance[at][np.ix_(rows, rows)], innovation[at][rows]
            self.put("nis", "all", at, squared(block, nu) if len(rows) else 0.0)
            self.put("nis_rows", "all", at, float(len(rows)))
            if len(rows):
                self.white[at][rows] = np.linalg.solve(np.linalg.cholesky(block), nu)

    def figure(self, name, part, values):
        run = np.nanmean(values[~self.failed], axis=1) * self.steps
        if name in ("nis", "nis_rows"):
            run = np.nansum(values[~self.failed], axis=1)
        result = {"name": name, "part": part, "sum": np.nansum(values, axis=0), "run_sum": run.sum(),
                  "run_square_sum": (run**2).sum()}
        if name != "nis_rows":
            result["square_sum"] = np.nansum(values**2, axis=0)
        if name == "nees":
            first, end = self.blocks[part]
            bounds = stats.chi2.ppf(LEVELS, end - first)
            result["dimension"] = end - first
            result["covered"] = [[int((values[:, k] < bound).sum()) for bound in bounds] for k in range(self.steps)]
        return result

    def products(self):
        lags = range(1, min(10, self.steps - 1) + 1)
        pairs = [self.white[:, lag:] * self.white[:, :-lag] for lag in lags]
        of_trials = [np.nansum(pair, axis=(1, 2)) for pair in pairs]
        return {"sum": [one.sum() for one in of_trials], "square_sum": [(one**2).sum() for one in of_trials],
                "count": [int((~np.isnan(pair)).sum()) for pair in pairs]}

    def columns(self):
        used = ~self.failed
        result = {name: np.full(self.trials, np.nan)
                  for name in ["trace_P", "pose_error", "nees_ratio", "nis_ratio", "mean_trace_P"]}
        trace = self.values["variance", "all"]
        last = [np.flatnonzero(row)[-1] if row.any() else 0 for row in self.there]
        pose = "pose" if "pose" in self.blocks else "all"
        result["trace_P"] = np.where(used, trace[np.arange(self.trials), last], np.nan)
        result["mean_trace_P"][used] = np.nanmean(trace[used], axis=1)
        result["pose_error"][used] = np.nansum(self.values["squared_error", pose][used], axis=1)
        result["nees_ratio"][used] = np.nanmean(self.values["nees", "all"][used], axis=1) / self.n
        if self.white is not None:
            with np.errstate(invalid="ignore"):
                ratio = np.nansum(self.values["nis", "all"], axis=1) / np.nansum(self.values["nis_rows", "all"], axis=1)
            result["nis_ratio"][used] = ratio[used]
        result["status"] = np.zeros(self.trials)
        result["status_pose"] = np.full(self.trials, -1.0)
        for trial, step, _, status in self.troubles:
            result["status"][trial], result["status_pose"][trial] = status, step + 1
        return result

    def cells(self):
        """Trials in the lowest and highest sixteenth of the cells, by step."""
        cell = np.floor(stats.chi2.cdf(self.values["nees", "all"], self.n) * CELLS)
        return [[int((cell[:, k] < CELLS // 16).sum()), int((cell[:, k] >= CELLS - CELLS // 16).sum())]
                for k in range(self.steps)]

    def everything(self, by_trial=True):
        nees = self.values["nees", "all"]
        of_step = [nees[self.there[:, k], k] for k in range(self.steps)]
        result = {
            "trials": self.trials, "steps": self.steps, "n": self.n, "counted": int((~self.failed).sum()),
            "present": self.there.sum(axis=0),
            "troubles": [trouble[:3] for trouble in self.troubles],
            "figures": [self.figure(*key, values) for key, values in self.values.items()],
            "shape_distance": [stats.kstest(v, stats.chi2(self.n).cdf).statistic if len(v) else math.nan
                               for v in of_step],
            "cells": self.cells(),
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
