"""The error of a tracker by its sources: python3 experiments/budget/tracker.py [trials] prints the table of
docs/budget.md, of a filter that assumes the acceleration that there is, and of one that assumes a fifth of it."""

import math
import sys

import numpy as np

import credence

F, B, H = np.array([[1.0, 1.0], [0.0, 1.0]]), np.array([0.5, 1.0]), np.array([1.0, 0.0])
ACCELERATION, RANGE, STEPS = 0.2, 0.5, 50  # m/s^2, m


def run(rng, q=ACCELERATION):
    x, m, P = rng["start"].normal([0, 1], [1, 0.3]), np.array([0.0, 1.0]), np.diag([1, 0.3**2])
    parts = {"start": P, "acceleration": 0 * P, "measurement": 0 * P}  # of P, by source
    error, covariance, counted = [], [], {name: [] for name in parts}
    for k in range(STEPS):
        x = F @ x + B * ACCELERATION * rng["acceleration", k].normal()
        m, P = F @ m, F @ P @ F.T + q**2 * np.outer(B, B)
        z = H @ x + RANGE * rng["measurement", k].normal()
        K = P @ H / (H @ P @ H + RANGE**2)
        m, P = m + K * (z - H @ m), P - np.outer(K, H @ P)
        error.append(m - x)
        covariance.append(P)
        for name in parts:
            Q = q**2 * np.outer(B, B) * (name == "acceleration")
            A = np.eye(2) - np.outer(K, H)
            parts[name] = A @ (F @ parts[name] @ F.T + Q) @ A.T + RANGE**2 * np.outer(K, K) * (name == "measurement")
            counted[name].append(parts[name])
    for name, of_source in counted.items():
        rng.counts(name, of_source)
    return credence.Run(np.array(error), np.array(covariance), component_names=["position", "speed"],
                        component_units=["m", "m/s"])  # fmt: skip


def main(trials):
    print("| filter | source | alone [m] | 95 % | share | with others [m] | P counts [m] |")
    print("|---|---|---|---|---|---|---|")
    for name, q in (("right", ACCELERATION), ("calm", ACCELERATION / 5)):
        part = credence.budget(run, trials, of="position", options={"q": q}, progress=False)["position"]
        for one in part.contributions:
            low, high = one.alone_ci
            print(f"| {name} | {one.source} | {one.alone:.3f} | {low:.3f} to {high:.3f} | {100 * one.share:.1f} % "
                  f"| {one.with_others:.3f} | {one.p_counts:.3f} |")  # fmt: skip
        whole = f"RMSE {part.rmse:.3f}, P says {part.p_says:.3f}: error² {100 * part.ratio:.0f} % of P's"
        print(f"| {name} | together | {math.hypot(*(one.alone for one in part.contributions)):.3f} | {whole} | | | |")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 400)
