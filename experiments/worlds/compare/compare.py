"""The tracker beside what one would write instead, on one processor core: a table in Markdown.

    compare.py TRACKER INI LOOP...      the programs; each LOOP is NAME=PATH of a build of loop.cpp

Each way is first run on credence's own draws, and must give its NEES/n of every trial to 1e-9; then its processor time
a step is measured with draws of its own, the best of several runs. JAX and simdkalman are left out where missing.
"""

import pathlib
import resource
import subprocess
import sys
import tempfile
import time

import h5py
import keyed_draws
import numpy as np

STEPS, SEED = 49, 1
F = np.block([[np.eye(2), np.eye(2)], [np.zeros((2, 2)), np.eye(2)]])
G = np.vstack([np.eye(2) / 2, np.eye(2)])
Q, R = 0.04 * G @ G.T, 4 * np.eye(2)
P0 = np.diag([2500.0, 2500, 25, 25])


def draws_of_credence(trials):
    """Of a study: start [N, 4], acceleration and noise [N, K, 2], detection [N, K]."""
    i, k = np.arange(trials)[:, None], np.arange(1, STEPS + 1)
    start = np.concatenate([keyed_draws.normal(SEED, i[:, 0], source, 0) for source in (0, 1)], axis=-1)
    moves, measurements = (keyed_draws.normal(SEED, i, source, k) for source in (2, 3))
    return start, moves, measurements, keyed_draws.uniform(SEED, i, 4, k)


def draws_of_numpy(trials, random):
    return (random.standard_normal((trials, 4)), random.standard_normal((trials, STEPS, 2)),
            random.standard_normal((trials, STEPS, 2)), random.random((trials, STEPS)))


def numpy_batched(draws):
    start, acceleration, noise, detection = draws
    x = start * [50, 50, 5, 5]
    estimate, P, nees = np.zeros_like(x), np.broadcast_to(P0, (len(x), 4, 4)), 0
    for k in range(STEPS):
        x = x @ F.T + 0.2 * acceleration[:, k] @ G.T
        estimate, P = estimate @ F.T, F @ P @ F.T + Q
        innovation = x[:, :2] + 2 * noise[:, k] - estimate[:, :2]
        S = P[:, :2, :2] + R
        K = np.where((detection[:, k] < 0.9)[:, None, None], P[:, :, :2] @ np.linalg.inv(S), 0)
        estimate = estimate + (K @ innovation[..., None])[..., 0]
        P = P - K @ S @ K.transpose(0, 2, 1)
        e = (estimate - x)[..., None]
        nees = nees + (e * np.linalg.solve(P, e)).sum((1, 2))
    return nees / STEPS / 4


def jax_mapped():
    """One trial, vmapped and compiled."""
    import jax
    import jax.numpy as jnp
    jax.config.update("jax_enable_x64", True)

    def trial(start, acceleration, noise, detection):
        def step(state, drawn):
            x, estimate, P = state
            a, v, u = drawn
            x = F @ x + 0.2 * G @ a
            estimate, P = F @ estimate, F @ P @ F.T + Q
            S = P[:2, :2] + R
            K = jnp.where(u < 0.9, P[:, :2] @ jnp.linalg.inv(S), 0)
            estimate = estimate + K @ (x[:2] + 2 * v - estimate[:2])
            P = P - K @ S @ K.T
            e = estimate - x
            return (x, estimate, P), e @ jnp.linalg.solve(P, e)
        first = (start * jnp.array([50.0, 50, 5, 5]), jnp.zeros(4), jnp.array(P0))
        return jax.lax.scan(step, first, (acceleration, noise, detection))[1].mean() / 4

    every = jax.jit(jax.vmap(trial))
    return lambda draws: np.asarray(every(*draws))


def simdkalman_filter():
    import simdkalman
    kalman = simdkalman.KalmanFilter(F, Q, np.eye(2, 4), R)

    def run(draws):
        start, acceleration, noise, detection = draws
        x, truth = start * [50, 50, 5, 5], []
        for k in range(STEPS):
            x = x @ F.T + 0.2 * acceleration[:, k] @ G.T
            truth.append(x)
        truth = np.stack(truth, axis=1)
        z = np.where((detection < 0.9)[..., None], truth[..., :2] + 2 * noise, np.nan)
        # Its first step has no prediction: it is given the belief that the first prediction gives.
        result = kalman.compute(z, 0, initial_value=np.zeros(4), initial_covariance=F @ P0 @ F.T + Q,
                                filtered=True, smoothed=False)
        e = (result.filtered.states.mean - truth)[..., None]
        return (e * np.linalg.solve(result.filtered.states.cov, e)).sum((2, 3)).mean(1) / 4
    return run


def seconds_of_children():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def seconds_of_program(program, scenario, folder, arms):
    """Of the steps that one run has more than another: without the start and the detailed trials."""
    def run(trials):
        before = seconds_of_children()
        subprocess.run([program, "run", scenario, "--trials", str(trials), "--threads", "1", "--quiet", "--overwrite",
                        "--keep", "aggregates", "-o", folder / "timed.h5"], check=True, stdout=subprocess.DEVNULL)
        return seconds_of_children() - before
    few, many = 20_000, 220_000
    return min(run(many) for _ in range(3)) - min(run(few) for _ in range(3)), (many - few) * STEPS * arms


def main(program, scenario, *loops):
    folder = pathlib.Path(tempfile.mkdtemp())
    command = [program, "run", scenario, "--trials", "2000", "--seed", str(SEED), "--quiet", "-o", folder / "study.h5"]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    with h5py.File(folder / "study.h5") as file:
        expected = file["tracker/kf/nees_ratio"][:]
    draws = draws_of_credence(len(expected))
    rows = []

    def agreement(name, nees):
        worst = np.abs(nees / expected - 1).max()
        if not worst < 1e-9:
            sys.exit(f"{name} has other NEES than credence: they differ by {worst:.1e}.")
        return worst

    seconds, steps = seconds_of_program(program, scenario, folder, 2)
    rows.append(("credence, in lanes", "draws, filter, all statistics, files", seconds / steps, 0.0))
    for one in loops:
        name, path = one.rsplit("=", 1)
        start, acceleration, noise, detection = draws
        flat = np.concatenate([acceleration, noise, detection[..., None]], axis=-1)
        np.concatenate([np.pad(start, ((0, 0), (0, 1)))[:, None], flat], axis=1).tofile(folder / "draws")
        subprocess.run([path, folder / "draws", folder / "nees"], check=True)
        worst = agreement(name, np.fromfile(folder / "nees"))
        command = [path, "1", "20000", "-"]
        runs = [float(subprocess.run(command, check=True, capture_output=True, text=True).stdout.split()[0])
                for _ in range(5)]
        rows.append((name, "draws, filter, NEES", min(runs) / STEPS, worst))
    ways = {"numpy, batched": lambda: numpy_batched, "JAX, vmap and jit": jax_mapped, "simdkalman": simdkalman_filter}
    for name, make in ways.items():
        try:
            run = make()
        except ImportError:
            print(f"{name} is left out, because its package is missing.", file=sys.stderr)
            continue
        worst = agreement(name, run(draws))
        times, random = [], np.random.default_rng(1)
        for _ in range(5):
            before = time.process_time()
            run(draws_of_numpy(len(expected), random))
            times.append(time.process_time() - before)
        rows.append((name, "draws, filter, NEES", min(times) / len(expected) / STEPS, worst))
    times_credence = "\N{MULTIPLICATION SIGN} credence"
    print(f"| way | what it computes | µs a step | {times_credence} | NEES differs by |\n|---|---|---|---|---|")
    for name, what, seconds, worst in rows:
        difference = f"{worst:.0e}" if worst else ""
        print(f"| {name} | {what} | {seconds * 1e6:.3g} | {seconds / rows[0][2]:.3g} | {difference} |")


if __name__ == "__main__":
    main(*sys.argv[1:])
