"""One trial as a moving picture: true and estimated path, features and ellipses, pose after pose."""

from __future__ import annotations

import os
import shutil

import matplotlib
import numpy as np
from matplotlib.animation import AbstractMovieWriter, FFMpegWriter, PillowWriter
from matplotlib.lines import Line2D

from ..trajectory import Trajectory
from . import style, trajectory

MOST_FRAMES = 150  # longer trials skip poses


def _writer(path: str, frames_per_second: int) -> AbstractMovieWriter:
    ending = os.path.splitext(path)[1].lower()
    if ending == ".gif":
        return PillowWriter(fps=frames_per_second)
    if ending != ".mp4":
        raise ValueError(f"invalid path={path} (must end in .gif or .mp4). Name such a file.")
    if shutil.which("ffmpeg") is None:
        raise ValueError(f"invalid path={path} (there is no ffmpeg, which .mp4 needs). Install it, or name a .gif.")
    return FFMpegWriter(fps=frames_per_second)


def animate(trial: Trajectory, path: str, *, ellipse: str = "95", frames_per_second: int = 8) -> None:
    """Writes the trial to a .gif or .mp4."""
    trajectory.need_path(trial)
    writer = _writer(path, frames_per_second)
    poses = np.unique(np.linspace(0, len(trial["pose"]) - 1, min(len(trial["pose"]), MOST_FRAMES)).astype(int))
    with matplotlib.rc_context(style.PRINT):
        frame = _Frame(trial, trajectory.ELLIPSES[ellipse][0], trajectory.ELLIPSES[ellipse][1])
        with writer.saving(frame.picture, path, dpi=130):
            for pose in [*poses, *[poses[-1]] * frames_per_second]:  # the end is held for a second
                frame.show(int(pose))
                writer.grab_frame()
                frame.picture.set_layout_engine("none")  # all frames have the layout of the first


class _Frame:
    """A picture whose limits stay, and what it shows of a pose."""

    def __init__(self, trial: Trajectory, scale: float, called: str) -> None:
        self.trial, self.scale, self.colour = trial, scale, trajectory.arm_colour(trial)
        (self.robot, self.features), (self.mean, self.means) = trial.positions("truth"), trial.positions("mean")
        self.covariance, self.seen, self.nees = trial["covariance"], trial["seen"], trial["nees"]
        self.first = trial.components.index("r_x")
        self.picture, self.axis = style.one_panel(140)
        ratio = trajectory.limits(self.axis, trial, scale)
        self.box = self.axis.get_xlim(), self.axis.get_ylim()
        self.picture.set_figheight(min(150, 34 + 118 / ratio) / 25.4)
        marks = [("true path", {"color": "black", "marker": "o"}), ("features", {"color": style.GREEN, "marker": "o"}),
                 ("estimated path", {"color": self.colour, "linestyle": "--", "marker": "+"}),
                 (called, {"color": self.colour, "marker": "o", "linestyle": "", "markerfacecolor": "none"})]
        self.entries = [(Line2D([], [], **drawn), label) for label, drawn in marks]  # type: ignore[arg-type]

    def show(self, pose: int) -> None:
        axis, labels = self.axis, (self.axis.get_xlabel(), self.axis.get_ylabel())
        axis.clear()
        for feature in np.flatnonzero(self.seen[pose] == 1):
            axis.plot(*np.stack([self.robot[pose], self.features[pose, feature]]).T, color=style.SKY, linewidth=0.8)
        axis.plot(*self.features[pose].T, "o", color=style.GREEN)
        axis.plot(*self.robot[:pose + 1].T, color="black", linewidth=0.9)
        axis.plot(*self.robot[pose], "o", color="black", markersize=5)
        axis.plot(*self.mean[:pose + 1].T, color=self.colour, linestyle="--", linewidth=0.9)
        axis.plot(*self.mean[pose], "+", color=self.colour, markersize=7, markeredgewidth=1.4)
        centres = np.concatenate([self.mean[pose][None], self.means[pose]])
        covariances = np.stack([self.covariance[pose, k:k + 2, k:k + 2]
                                for k in range(self.first, self.first + 2 * len(centres), 2)])
        trajectory.ellipses(centres, covariances, self.scale, axis, linewidths=0.9,
                            edgecolors=[self.colour] + [style.GREEN] * (len(centres) - 1))
        axis.set(xlim=self.box[0], ylim=self.box[1], aspect="equal", xlabel=labels[0], ylabel=labels[1])
        style.key(axis, self.entries, 140)
        nees = f", NEES {self.nees[pose]:.1f} of {len(self.trial.components)}" if np.isfinite(self.nees[pose]) else ""
        self.picture.title(f"Pose {pose} of {len(self.robot) - 1}{nees}", trajectory.source(self.trial))
