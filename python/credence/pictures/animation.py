"""One trial as a moving picture: true and estimated path, features and ellipses, pose after pose."""

from __future__ import annotations

import contextlib
import os
import shutil
import sys
from collections.abc import Callable, Iterator

import matplotlib
import numpy as np
from matplotlib.animation import AbstractMovieWriter, FFMpegWriter, PillowWriter
from matplotlib.lines import Line2D

from .._outputs import whole
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


def animate(trial: Trajectory, path: str, *, ellipse: str = "95", frames_per_second: int = 8,
            progress: bool | None = None) -> None:
    """Writes the trial to a .gif or .mp4."""
    trajectory.need_path(trial)
    writer = _writer(path, frames_per_second)
    poses = np.unique(np.linspace(0, len(trial["pose"]) - 1, min(len(trial["pose"]), MOST_FRAMES)).astype(int))
    poses = np.r_[poses, np.repeat(poses[-1], frames_per_second)]  # the end is held for a second
    with matplotlib.rc_context(style.PRINT), whole(path) as part, _said(path, progress) as said:
        frame = _Frame(trial, trajectory.ELLIPSES[ellipse][0], trajectory.ELLIPSES[ellipse][1])
        writer.setup(frame.picture, str(part), dpi=130)
        try:
            for done, pose in enumerate(poses):
                said(f"{done} of {poses.size} frames")
                frame.show(int(pose))
                writer.grab_frame()
                frame.picture.set_layout_engine("none")  # all frames have the layout of the first
            said("all frames are drawn, writing")
        except BaseException:
            with contextlib.suppress(Exception):  # what ends it matters, not that the film is no film
                writer.finish()
            raise
        writer.finish()


@contextlib.contextmanager
def _said(path: str, progress: bool | None) -> Iterator[Callable[[str], object]]:
    """A function that says how far it is, on one line of the error stream; by default only on a terminal."""
    if not (sys.stderr.isatty() if progress is None else progress):
        yield lambda words: None
        return
    try:
        yield lambda words: print(f"\r\033[K{path}: {words}", end="", file=sys.stderr, flush=True)
    finally:
        print("\r\033[K", end="", file=sys.stderr, flush=True)


class _Frame:
    """A picture whose limits stay, and what it shows of a pose."""

    def __init__(self, trial: Trajectory, scale: float, called: str) -> None:
        self.trial, self.scale, self.colour = trial, scale, trajectory.arm_colour(trial)
        (self.robot, self.features), (self.mean, self.means) = trial.positions("truth"), trial.positions("mean")
        self.covariance, self.seen, self.nees = trial["covariance"], trial["seen"], trial["nees"]
        self.first = trial.components.index("r_x")
        self.picture, self.axis = style.one_panel(140)
        self.box = trajectory.extent(trial, scale)
        self.picture.set_figheight(min(150, 34 + 118 / trajectory.shape(self.box)) / 25.4)
        marks = [("true path", trajectory.TRUE_PATH | {"marker": "o"}),
                 ("features", {"color": style.GREEN, "marker": "o"}),
                 ("estimated path", {"color": self.colour, "linestyle": "--", "marker": "+"}),
                 (called, {"color": self.colour, "marker": "o", "linestyle": "", "markerfacecolor": "none"})]
        self.entries = [(Line2D([], [], **drawn), label) for label, drawn in marks]  # type: ignore[arg-type]

    def show(self, pose: int) -> None:
        axis = self.axis
        axis.clear()
        trajectory.draw_map(axis, self.trial, pose)
        for feature in np.flatnonzero(self.seen[pose] == 1):
            axis.plot(*np.stack([self.robot[pose], self.features[pose, feature]]).T, color=style.SKY, linewidth=0.8)
        axis.plot(*self.features[pose].T, "o", color=style.GREEN)
        axis.plot(*self.robot[:pose + 1].T, **trajectory.TRUE_PATH)  # type: ignore[arg-type]
        axis.plot(*self.robot[pose], "o", color="black", markersize=5)
        axis.plot(*self.mean[:pose + 1].T, color=self.colour, linestyle="--", linewidth=0.9)
        axis.plot(*self.mean[pose], "+", color=self.colour, markersize=7, markeredgewidth=1.4)
        centres = np.concatenate([self.mean[pose][None], self.means[pose]])
        covariances = np.stack([self.covariance[pose, k:k + 2, k:k + 2]
                                for k in range(self.first, self.first + 2 * len(centres), 2)])
        trajectory.ellipses(centres, covariances, self.scale, axis, linewidths=0.9,
                            edgecolors=[self.colour] + [style.GREEN] * (len(centres) - 1))
        trajectory.show(axis, self.trial, self.box)
        style.key(axis, self.entries, 140)
        nees = f", NEES {self.nees[pose]:.1f} of {len(self.trial.components)}" if np.isfinite(self.nees[pose]) else ""
        self.picture.title(f"Pose {pose} of {len(self.robot) - 1}{nees}", trajectory.source(self.trial))
