"""What the trials of a study came to that its file does not hold: log det P after the last update, and the length of the
robot's true path.

    python3 paths.py CREDENCE TRIALS STUDY.h5 ARM...

Replays the first trials of the file's only scenario, and prints for each arm both means with 95 % intervals, parted by |.
Needs numpy and h5py.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np


def replayed(credence: str, study: str, scenario: str, arm: str, trial: int, path: Path) -> tuple[float, float]:
    """log det P after the last update, and the length of the path, of one trial."""
    command = [credence, "replay", study, "--scenario", scenario, "--arm", arm, "--trial", str(trial), "-o", str(path)]
    subprocess.run([*command, "--overwrite"], check=True, stdout=subprocess.DEVNULL)
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
    with tempfile.TemporaryDirectory() as folder:
        for arm in arms:
            values = [replayed(credence, study, scenario, arm, i, Path(folder) / "trial.h5") for i in range(trials)]
            print(" | ".join(interval(column) for column in np.array(values).T))


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), *sys.argv[3:])
