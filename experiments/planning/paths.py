"""What the trials of a study came to that its file does not hold: log det P after the last update, and the length of
the robot's true path.

    python3 paths.py CREDENCE TRIALS STUDY.h5 ARM...

Replays the first trials of the file's only scenario, and prints for each arm both means with 95 % intervals, parted
by |. Needs numpy and h5py.
"""

import os
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import h5py
import numpy as np


def replayed(command: list[str], scenario: str, arm: str, trial: int, folder: str) -> tuple[float, float]:
    """log det P after the last update, and the length of the path, of one trial."""
    path = Path(folder) / f"{arm}-{trial}.h5"
    subprocess.run([*command, "--scenario", scenario, "--arm", arm, "--trial", str(trial), "-o", path], check=True,
                   stdout=subprocess.DEVNULL)
    with h5py.File(path) as file:
        group = file[f"{scenario}/{arm}"]
        names = group["component"].attrs["component_names"].split()
        moves = np.diff(group["truth"][:, [names.index(b"r_x"), names.index(b"r_y")]], axis=0)
        return np.linalg.slogdet(group["covariance"][-1])[1], np.linalg.norm(moves, axis=1).sum()


def interval(values: np.ndarray) -> str:
    """`mean ± half-width`, with two digits of the half-width."""
    half = 1.96 * values.std(ddof=1) / np.sqrt(len(values))
    digits = max(0, 1 - int(np.floor(np.log10(half)))) if half > 0 else 4
    return f"{values.mean():.{digits}f} ± {half:.{digits}f}"


def main(credence: str, trials: int, study: str, *arms: str) -> None:
    with h5py.File(study) as file:
        scenario = next(name for name in file if name != "run")
    command = [credence, "replay", study]
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(os.cpu_count()) as pool:
        for arm in arms:
            values = pool.map(lambda trial, arm=arm: replayed(command, scenario, arm, trial, folder), range(trials))
            print(" | ".join(interval(column) for column in np.array(list(values)).T))


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), *sys.argv[3:])
