"""Results files for the tests of readers and pictures, each made once by the program."""

from __future__ import annotations

import functools
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

import h5py

ROOT = pathlib.Path(__file__).resolve().parents[2]
SEED = ROOT / "experiments" / "seed"
CONTROLLERS = ("fixed", "greedy", "horizon", "follow", "nearest", "random", "waypoints")
CREDENCE = os.environ.get("CREDENCE")  # the program, where the package has no compiled module


def program(*words) -> str:
    """What the program prints: that of the environment's CREDENCE, else the package's own."""
    start = [CREDENCE] if CREDENCE else [sys.executable, "-m", "credence"]
    return subprocess.run([*start, *map(str, words)], capture_output=True, text=True, check=True).stdout


def printed(*words) -> list:
    return json.loads(program(*words, "--format=json"))


@functools.cache
def folder() -> pathlib.Path:
    return pathlib.Path(tempfile.mkdtemp(prefix="credence-tests-"))


@functools.cache
def made(name: str, scenario: str, *options: str) -> pathlib.Path:
    path = folder() / f"{name}.h5"
    program("run", *(SEED / f"{one}.ini" for one in scenario.split()), "--quiet", "-o", path, *options)
    return path


def two_scenarios():
    return made("two", "kf-circle-constant ekf-circle-ranged", "--trials=600")


def one_scenario():
    return made("one", "ekf-circle-ranged", "--trials=600")


def aggregates():
    return made("aggregates", "ekf-circle-ranged", "--trials=600", "--keep=aggregates")


def twelve_arms():
    return made("arms", "ekf-circle-ranged", "--trials=60", "--set=arms.estimators=ekf,ideal,fej,riekf",
                "--set=arms.controllers=fixed,greedy,horizon")


def single_arm():
    return made("single", "ekf-circle-ranged", "--trials=10", "--set=arms.controllers=fixed")


def arms(count: int):
    """A study of one estimator under so many controllers."""
    options = ["--set=control.waypoints=2 0, 4 2"] if "waypoints" in CONTROLLERS[:count] else []
    return made(f"arms-{count}", "ekf-circle-ranged", "--trials=40",
                f"--set=arms.controllers={','.join(CONTROLLERS[:count])}", *options)


def waypoints():
    return made("waypoints", "ekf-circle-ranged", "--trials=40", "--set=control.waypoints=2 0, 4 2",
                "--set=arms.controllers=waypoints,greedy")


def landmarks():
    """Landmarks about a loop, of which the planner's robot leaves out most."""
    return made("landmarks", "../planning/landmark-loop", "--trials=10")


def swept():
    return made("swept", "ekf-circle-ranged", "--trials=60", "--set=scenario.name=base",
                "--sweep=noise.heading=0.01,0.1", "--sweep=sensor.noise=constant,ranged")


def many_steps():
    return made("steps", "kf-circle-constant", "--trials=30", "--set=scenario.poses=3001",
                "--set=arms.controllers=fixed")


@functools.cache
def trajectory(arm: str = "greedy.ekf", trial: int = 17, of: str = "") -> pathlib.Path:
    path = folder() / f"{of}{arm}-{trial}.h5"
    study, scenario = (landmarks(), "landmark-loop") if of else (two_scenarios(), "ekf-circle-ranged")
    program("replay", study, f"--scenario={scenario}", f"--arm={arm}", f"--trial={trial}", "-o", path)
    return path


def edited(path: pathlib.Path, target: pathlib.Path, edit) -> pathlib.Path:
    """A copy of a file after `edit(h5py.File)`."""
    shutil.copy(path, target)
    with h5py.File(target, "r+") as file:
        edit(file)
    return target
