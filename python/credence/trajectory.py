"""Trajectory files, what ``credence replay -o`` writes: single trials, pose after pose.

    (trial,) = credence.open_trajectories("trial.h5")
    trial.truth, trial.mean, trial.covariance           # [pose, component], and [pose, component, component]
"""

from __future__ import annotations

import re

import numpy as np

from . import _doors as doors
from ._file import RESULTS, Array, FloatArray, Source, Variables, open_hdf5, stem, text
from .arm import Scenario


class Trajectory(Variables):
    """One trial of one arm: an array for each variable of the file, by key or as an attribute."""

    @property
    def scenario(self) -> Scenario:
        """The scenario; its `arms` are those of the trajectory file."""
        return Scenario(self.group.parent)

    @property
    def source(self) -> str:
        """Where its noise came from, such as ``root seed 1, trial 17``."""
        return text(self.group, "source")

    @property
    def trial(self) -> int:
        """The trial's number; -1 where the noise was not that of a trial."""
        found = re.search(r"trial (\d+)", self.source)
        return int(found[1]) if found else -1

    @property
    def columns(self) -> dict[str, float]:
        """The trial's columns, such as ``trace_P`` and ``nees_ratio``."""
        return {name: float(value) for name, value in self.group.attrs.items()
                if isinstance(value, np.floating | np.integer) and name != "status"}

    @property
    def status(self) -> str:
        """How the trial ended, in words."""
        return text(self.group, "status_text")

    @property
    def components(self) -> list[str]:
        """Names of the state's components."""
        return self.words("component", "component_names")

    @property
    def component_units(self) -> list[str]:
        return self.words("component", "component_units")

    @property
    def errors(self) -> FloatArray:
        """[pose, component] estimate - truth after the update, the heading's wrapped to +-pi; each in its unit."""
        if "error" in self.group:
            return self.read("error")
        error: FloatArray = self.read("mean") - self.read("truth")
        for heading in (k for k, name in enumerate(self.components) if name == "theta"):
            error[:, heading] = (error[:, heading] + np.pi) % (2 * np.pi) - np.pi
        return error

    @property
    def has_path(self) -> bool:
        """Whether it has a robot and features in the plane: so of all worlds but those of users."""
        return "truth" in self.group and "r_x" in self.components

    def positions(self, name: str) -> tuple[FloatArray, FloatArray]:
        """Robot [pose, axis] and features [pose, feature, axis] of ``truth`` or ``mean``, in the length unit."""
        values: Array = self.read(name)
        robot = self.components.index("r_x")
        return values[:, robot:robot + 2], values[:, robot + 2:].reshape(len(values), -1, 2)

    def _said(self) -> str:
        return f"<credence.Trajectory {self.group.name[1:]}, {self.source}: {self.status}>"


@doors.door(source=doors.source)
def open_trajectories(source: Source) -> list[Trajectory]:
    """Opens a trajectory file; nothing but its header is read.

    Parameters
    ----------
    source : path or binary file
        What ``credence replay -o`` wrote.

    Returns
    -------
    list of Trajectory
        One for each scenario and arm, in the file's order. The file stays open as long as one of them is there.
    """
    file, kind = open_hdf5(source)
    if kind == RESULTS:
        file.close()
        raise ValueError(f"{source}: format: it has results, not trajectories. Take credence.open.")
    scenarios = [group for name, group in file["/"].items() if name != "run"]
    return [Trajectory(scenario[stem(arm)]) for scenario in scenarios for arm in scenario.values()]
