#!/usr/bin/env python3
"""credence beside batched numpy and JAX: a table for docs/performance.md.

usage: peers.py [--credence build/credence] [--check [TRIALS]] [--repeats 5]

First the columns of trials with credence's own draws are compared, trial by trial, in all cells of the reference study
with the heading model; a difference above 1e-9 ends the program. --check stops there; without JAX, numpy alone is
checked. Then each is timed on one processor, with a generator of its own: processor time, medians of runs in turn.
"""

import argparse
import importlib.util
import itertools
import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

TREE = Path(__file__).resolve().parents[2]
sys.path.append(str(TREE / "experiments" / "worlds" / "compare"))

SEED, TOLERANCE = 1, 1e-9
CELLS = list(itertools.product(("straight", "circle"), ("constant", "ranged"), ("fixed", "greedy")))
# Name, cell, which batch sizes to try, trials of credence's longer run, seconds a trial of the authors' program in GNU
# Octave, as given.
ROWS = [
    ("fixed path", ("straight", "ranged", "fixed"), "fixed", 400_000, 0.068),
    ("greedy straight (21)", ("straight", "ranged", "greedy"), "straight", 200_000, 0.9),
    ("greedy circle (126)", ("circle", "ranged", "greedy"), "circle", 100_000, 5.1),
]
BATCH_SIZES = {
    "numpy": {"fixed": (1024, 2048, 4096), "straight": (256, 512, 1024), "circle": (128, 256, 512)},
    "JAX": {"fixed": (64, 128, 256), "straight": (64, 128, 256), "circle": (32, 64, 128)},
}
SECONDS = 0.5  # of each timed run
ONE_THREAD = "--xla_cpu_multi_thread_eigen=false "
WIDE = "--xla_cpu_prefer_vector_width=512"  # XLA's default is half of what AVX-512 has


def backends():
    """numpy and, where it is installed, JAX; imported late, because both read the environment."""
    from backends import Jax, Numpy

    return [Numpy, Jax] if importlib.util.find_spec("jax") else [Numpy]


def credence_run(credence, cell, trials, output):
    path, noise, controller = cell
    scenario = TREE / "experiments" / "seed" / f"ekf-{path}-{noise}.ini"
    keys = ["--set", f"arms.controllers={controller}"]
    how = ["--seed", str(SEED), "--trials", str(trials), "--threads", "1", "--quiet", "--overwrite", "-o", output]
    subprocess.run([credence, "run", scenario, *keys, *how], check=True)


def credence_columns(credence, cell, trials, output):
    import h5py
    import numpy as np
    from model import COLUMNS

    credence_run(credence, cell, trials, output)
    path, noise, controller = cell
    with h5py.File(output) as file:
        return np.stack([file[f"ekf-{path}-{noise}/{controller}.ekf/{name}"][:] for name in COLUMNS])


def credence_draws(trials):
    """What credence's trials draw: [K, NORMALS, trials]"""
    import keyed_draws
    import numpy as np
    from model import NORMALS, K, M

    i, normals = np.arange(trials), np.zeros((K, NORMALS, trials))

    def pair(source, pose, index):
        return keyed_draws.normal(SEED, i, source, pose, index).T

    for k in range(K):
        normals[k, 0], normals[k, 1:3] = pair(0, k, 0)[0], pair(1, k, 0)
        for place, (source, pose) in enumerate([(2, k - 1), (3, k), (4, k)]):  # row k - 1 of the walk leads to pose k
            for j in range(M if pose >= 0 else 0):
                first = 3 + 2 * (M * place + j)
                normals[k, first : first + 2] = pair(source, pose, j)
    return normals


def check(credence, trials, output):
    import numpy as np
    from model import COLUMNS

    normals, worst = credence_draws(trials), {}
    for cell, backend in itertools.product(CELLS, backends()):
        ours = credence_columns(credence, cell, trials, output)
        theirs = backend(*cell).columns(normals)
        off = ~(np.abs(theirs - ours) <= TOLERANCE * np.abs(ours))  # what is not a number is off, too
        if off.any():
            column, trial = np.argwhere(off)[0]
            sys.exit(f"{backend.name} disagrees with credence: cell={' '.join(cell)} trial={trial} column="
                     f"{COLUMNS[column]} ({theirs[column, trial]!r}, credence has {ours[column, trial]!r}).")
        difference = np.abs(theirs - ours) / np.where(ours == 0, 1, np.abs(ours))
        worst[backend.name] = max(worst.get(backend.name, 0), difference.max())
    for name, difference in worst.items():
        print(f"{name}: {trials} trials in each of {len(CELLS)} cells agree with credence, columns to {difference:.1e}")
    if "JAX" not in worst:
        print("JAX is not installed: only numpy is compared")


def per_trial(batch, size, clock):
    """Microseconds a trial, from batches of at least SECONDS in all."""
    count, start = 0, clock()
    while clock() - start < SECONDS:
        batch()
        count += size
    return (clock() - start) / count * 1e6


def chosen(backend, cell, sizes, clock):
    """The fastest of the batch sizes, and seconds until the first batch of it was there."""
    tried = []
    for size in sizes:
        start = time.perf_counter()
        batch = backend(*cell).batches(size)
        batch()
        first = time.perf_counter() - start
        tried.append((per_trial(batch, size, clock), size, first, batch))
    return min(tried, key=lambda found: found[0])[1:]


def credence_per_trial(credence, cell, trials, output):
    """The program's whole time of `trials` less that of a tenth of them: what starts and ends it is in both."""
    def seconds(count):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        credence_run(credence, cell, count, output)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

    return (seconds(trials) - seconds(trials // 10)) / (0.9 * trials) * 1e6


def measured(credence, row, repeats, output):
    """Microseconds a trial: {name: median}, and what is to be said of the batches."""
    _, cell, sizes, trials, _ = row
    batches = {backend.name: chosen(backend, cell, BATCH_SIZES[backend.name][sizes], time.process_time)
               for backend in backends()}
    runs = {name: [] for name in (*batches, "credence")}
    for _ in range(repeats):
        for name, (size, _, batch) in batches.items():
            runs[name].append(per_trial(batch, size, time.process_time))
        runs["credence"].append(credence_per_trial(credence, cell, trials, output))
    said = ", ".join(f"{name} {size} trials at once, first batch after {first:.1f} s"
                     for name, (size, first, _) in batches.items())
    return {name: statistics.median(times) for name, times in runs.items()}, said


def on_all(processors, repeats):
    """JAX's wall time on all processors, of a process of its own, since XLA makes its threads when it starts."""
    command = [sys.executable, __file__, "--repeats", str(repeats), "--as-it-comes", *map(str, processors)]
    run = subprocess.run(command, check=True, stdout=subprocess.PIPE, env={**os.environ, "XLA_FLAGS": WIDE})
    return json.loads(run.stdout)


def as_it_comes(processors, repeats):
    os.sched_setaffinity(0, processors)
    from backends import Jax

    times = []
    for _, cell, sizes, *_ in ROWS:
        size, _, batch = chosen(Jax, cell, (BATCH_SIZES["JAX"][sizes][-1], 1024), time.perf_counter)
        times.append(statistics.median(per_trial(batch, size, time.perf_counter) for _ in range(repeats)))
    print(json.dumps(times))


def table(credence, repeats, output, processors):
    everywhere = on_all(processors, repeats)
    heads = ["row", "Octave (given) s/trial", "numpy µs/trial", "JAX µs/trial",
             f"JAX on all {len(processors)} processors µs/trial", "credence µs/trial",
             "Octave / credence", "numpy / credence", "JAX / credence"]
    print("", f"| {' | '.join(heads)} |", "|---" * len(heads) + "|", sep="\n")
    said = []
    for row, wide in zip(ROWS, everywhere):
        times, batches = measured(credence, row, repeats, output)
        own = times["credence"]
        print(f"| {row[0]} | {row[4]} | {times['numpy']:.3g} | {times['JAX']:.3g} | {wide:.3g} | {own:.3g} | "
              f"{row[4] * 1e6 / own:,.0f} | {times['numpy'] / own:.3g} | {times['JAX'] / own:.3g} |", flush=True)
        said.append(f"{row[0]}: {batches}")
    print("\n" + "\n".join(said))


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1].split("\n")[0])
    parser.add_argument("--credence", default=TREE / "build" / "credence")
    parser.add_argument("--check", type=int, nargs="?", const=64)
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--as-it-comes", type=int, nargs="+", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.as_it_comes:
        return as_it_comes(given.as_it_comes, given.repeats)
    processors = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {max(processors)})
    os.environ.update(XLA_FLAGS=ONE_THREAD + WIDE, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")
    with tempfile.TemporaryDirectory() as folder:
        output = Path(folder) / "study.h5"
        check(given.credence, given.check or 256, output)
        if given.check is None:
            if len(backends()) < 2:
                sys.exit("peers.py: the table needs JAX. Run bench/peers.sh, which installs it.")
            table(given.credence, given.repeats, output, processors)


if __name__ == "__main__":
    main()
