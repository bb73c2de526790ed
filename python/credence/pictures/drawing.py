"""One picture of a study, a grid or a trial, and one trial as a moving picture."""

from __future__ import annotations

import os
import pathlib
import tempfile
from collections.abc import Callable, Sequence
from typing import Any

import matplotlib

from .. import _doors as doors
from .._file import RESULTS, open_hdf5, records_in
from .._results import Results
from ..arm import Scenario
from ..grid import Grid
from ..study import Study
from ..study import open as open_study
from ..trajectory import Trajectory, open_trajectories
from . import animation, program, style, sweep, trajectory, verdicts
from .place import place
from .steps import accuracy, chi_square, coverage, nees, nis, trace
from .style import Picture as Picture
from .trials import distribution, paired

OF_SCENARIO: dict[str, Callable[..., Picture]] = {
    "verdicts": verdicts.verdicts, "nees": nees, "nis": nis, "coverage": coverage, "chi_square": chi_square,
    "trace_P": trace, "accuracy": accuracy, "distribution": distribution, "paired": paired, "map": verdicts.ratio_map,
    "place": place}
OF_TRIAL: dict[str, Callable[..., Picture]] = {
    "path": trajectory.path, "errors": trajectory.errors, "nees": trajectory.nees}


@doors.door(
    what=doors.file_or("Study", "Simulation", "SimulatedArm", "Scenario", "Grid", "Trajectory"), kind=doors.text,
    scenario=doors.text, arms=doors.texts, width=doors.above_zero, path=doors.output, title=doors.flag,
)  # fmt: skip
def plot(
    what: Results | Scenario | Grid | Trajectory | str | os.PathLike[str],
    kind: str | None = None,
    *,
    scenario: str | None = None,
    arms: Sequence[str] | None = None,
    width: float = style.PAGE,
    path: str | os.PathLike[str] | None = None,
    title: bool = True,
    **options: Any,
) -> Picture:
    """Draws one picture, whose title says its message.

    Parameters
    ----------
    what : Study, Simulation or one of its arms, Scenario, Grid, Trajectory or path
        What to draw: of a study its first scenario, or its first grid where it has one; what `simulate` gives, or the
        path of a record; of a path to a trajectory file its first trial.
    kind : str, optional
        Of a scenario: ``nees`` (the default), ``nis``, ``coverage``, ``chi_square``, ``trace_P``, ``accuracy``,
        ``distribution``, ``paired``, ``verdicts``, ``map``, ``place``. Of a grid: ``sweep``. Of a trial: ``path`` (the
        default), ``errors``, ``nees``.
    scenario : str, optional
        The scenario of a study.
    arms : list of str, optional
        The arms to draw; all of them by default. An arm looks the same in every picture. A controller alone, such as
        ``greedy``, will do if it has one arm. Of two, (A, B), ``paired`` and a ``difference`` are A - B; by default
        these take the pairs of ``credence.compare``.
    width : float
        In millimetres: 175, a page, by default; 85 is a column.
    path : path, optional
        Where to save it as well: .pdf, .svg or .png.
    title : bool
        Whether it has its message and, below it, its source; without them a page says both in its caption.
    **options
        ``group`` of nees, coverage, trace_P and accuracy (``all``); ``level`` of coverage (0.95); ``column`` of
        distribution, paired (``trace_P``) and sweep (``nees_ratio``); ``difference`` of sweep (False); ``arm`` of map;
        ``ellipse`` of path (``95`` or ``1-sigma``).

    Returns
    -------
    Picture
        A matplotlib Figure.
    """
    if isinstance(what, str | os.PathLike):
        what = _first(what)
    if isinstance(what, Results):
        study: Study = what.study
        has_grid = scenario is None and kind in (None, "sweep") and study.grids
        what = study.grids[0] if has_grid else study.scenarios[scenario or next(iter(study))]
    with matplotlib.rc_context(style.PRINT):
        picture = _drawn(what, kind, arms, width, options)
        if not title:
            picture.leave_title_out()
        picture.fit_labels()
    if path is not None:
        picture.save(path)
    return picture


def opened(path: str | os.PathLike[str]) -> Study | list[Trajectory]:
    """What a results file or a trajectory file has."""
    if records_in(path):
        return open_study(path)
    file, kind = open_hdf5(path)
    file.close()
    return open_study(path) if kind == RESULTS else open_trajectories(path)


def _first(path: str | os.PathLike[str]) -> Study | Trajectory:
    found = opened(path)
    return found if isinstance(found, Study) else found[0]


def _drawn(what: Scenario | Grid | Trajectory, kind: str | None, arms: Sequence[str] | None, width: float,
           options: dict[str, Any]) -> Picture:
    if isinstance(what, Grid):
        wanted = [arm_meant(what.points[0], name) for name in arms] if arms else None
        return _known({"sweep": sweep.sweep}, kind or "sweep")(what, width, wanted=wanted, **options)
    if isinstance(what, Trajectory):
        return _known(OF_TRIAL, kind or "path")(what, width, **options)
    draw = _known(OF_SCENARIO, kind or "nees")
    there = {name: (place, arm) for place, (name, arm) in enumerate(what.arms.items())}
    chosen = {name: there[name] for name in ([arm_meant(what, name) for name in arms] if arms else there)}
    for name, (_, arm) in chosen.items():
        if arm.counted_trials == 0:
            why = "every trial failed" if arm.trials else "it is not run yet"
            raise ValueError(f"invalid arm {name} ({why}). Choose others with arms=[...].")
    if draw is paired and arms:
        options["wanted"] = list(chosen)
    return draw(what, chosen, width, **options)


def arm_meant(scenario: Scenario, name: str) -> str:
    """The arm that a name denotes: its own name, or that of the only arm of a controller."""
    there = list(scenario)
    meant = [arm for arm in there if arm == name] or [arm for arm in there if arm.partition(".")[0] == name]
    if len(meant) == 1:
        return meant[0]
    if meant:
        raise ValueError(f"invalid arm {name} (in {scenario.name} it is {' or '.join(meant)}). Give its whole name.")
    raise ValueError(f"invalid arm {name} ({scenario.name} has no such arm). It has {', '.join(there)}.")


def _known(kinds: dict[str, Callable[..., Picture]], kind: str) -> Callable[..., Picture]:
    if kind not in kinds:
        raise ValueError(f"invalid kind={kind} (must be one of {', '.join(kinds)}). Choose one.")
    return kinds[kind]


@doors.door(
    what=doors.file_or("Study", "Simulation", "Trajectory"), path=doors.output, trial=doors.whole(),
    scenario=doors.text, arm=doors.text, ellipse=doors.text, frames_per_second=doors.whole(1, 1000),
    credence=doors.path, progress=doors.flag,
)  # fmt: skip
def animate(
    what: Results | Trajectory | str | os.PathLike[str],
    *,
    path: str | os.PathLike[str] | None = None,
    trial: int = 0,
    scenario: str | None = None,
    arm: str | None = None,
    ellipse: str = "95",
    frames_per_second: int = 8,
    credence: str | None = None,
    progress: bool | None = None,
) -> pathlib.Path:
    """Writes one trial as a moving picture: true and estimated path, features and ellipses, pose after pose.

    Parameters
    ----------
    what : Study, Trajectory or path
        A study or results file, of which the trial is run again; or a trajectory.
    path : path, optional
        The file to write: .gif, or .mp4 where ffmpeg is installed; by default SCENARIO-ARM-TRIAL.gif in the current
        folder, SCENARIO-ARM.gif of a trajectory.
    trial : int
        The trial of a study, from 0.
    scenario, arm : str, optional
        Which of the study's; by default the first scenario and its last arm.
    ellipse : str
        ``95`` (percent) or ``1-sigma``.
    frames_per_second : int
        Poses a second. Trials of more than 150 poses skip some.
    credence : path, optional
        The program that runs the trial again where the package's compiled module is missing.
    progress : bool
        Whether a line says how many frames are drawn; by default on a terminal.

    Returns
    -------
    pathlib.Path
        The file.
    """
    if isinstance(what, str | os.PathLike):
        what = _first(what)
    if isinstance(what, Trajectory):
        path = pathlib.Path(path or f"{what.scenario.name}-{what.name}.gif")
        animation.animate(what, str(path), ellipse=ellipse, frames_per_second=frames_per_second,
                          progress=progress)
        return path
    study: Study = what.study
    if study.records:
        raise ValueError("cannot run a trial of records again (`credence.run` did not make them). Choose a study.")
    scenario = scenario or next(iter(study))
    arm = arm_meant(study.scenarios[scenario], arm) if arm else list(study.scenarios[scenario])[-1]
    with tempfile.TemporaryDirectory(prefix="credence-") as folder:
        file = os.path.join(folder, "trial.h5")
        program.replay(study.path, scenario, arm, trial, file, credence)
        (trajectory_of_trial,) = open_trajectories(file)
        return animate(trajectory_of_trial, path=path or f"{scenario}-{arm}-{trial}.gif", ellipse=ellipse,
                       frames_per_second=frames_per_second, progress=progress)
