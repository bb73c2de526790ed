"""The program's commands as functions: they run, store and compare studies."""

from __future__ import annotations

import contextlib
import os
import shutil
import tempfile
import weakref
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from credence import _core
from credence import _doors as doors
from credence._calls import note, progress_bar
from credence._errors import Failure, InputError, invalid, wrong
from credence._names import not_utf8
from credence._outputs import goes_with
from credence._planners import Asked, Now, note_failures, setting_of
from credence._results import Printed, Results, Sources

if TYPE_CHECKING:
    from credence.study import Study
    from credence.trajectory import Trajectory

    File = str | os.PathLike[str]
    Settings = Mapping[str, object]
    Sweep = Mapping[str, str | Iterable[object]]
    Goals = str | Sequence[str] | Mapping[str, object]
    Planners = Mapping[str, tuple[str, Asked]]

SEED = doors.whole(0, 2**64 - 1)
SETTINGS = doors.mapping('{"noise.heading": 0.01}')
FILE = doors.file_or("Study")
REPORTED = doors.file_or("Study", "Simulation", "SimulatedArm")

STOPPED = 3  # the exit code of a run that a signal stopped, with everything kept


class Interrupted(KeyboardInterrupt):
    """A run was stopped by Ctrl-C, and what was done is kept.

    Attributes
    ----------
    study : Study, Simulation or None
        The trials that were done; ``credence.resume(study)`` resumes from those of a Study, and ``simulate`` with
        ``resume=True`` from those beside its output.
    """

    def __init__(self, message: str, study: Any) -> None:
        super().__init__(message)
        self.study = study


def _command(
    name: str, arguments: Sequence[str], options: Mapping[str, object], progress: bool | None = False,
    planners: Planners | None = None,
) -> tuple[int, str, str]:  # fmt: skip
    """Run a command of the program; return its exit code and what it said on both streams."""
    _refuse_what_is_not_utf8(arguments, options)
    with progress_bar(progress) as bar:
        result = _core.command(name, arguments, options, bar, planners or {})
    if planners:
        note_failures(planners)
    return result


def _refuse_what_is_not_utf8(arguments: Sequence[str], options: Mapping[str, object]) -> None:
    for name, given in [*(("path", one) for one in arguments), *options.items()]:
        for value in given if isinstance(given, list) else [given]:
            if isinstance(value, str) and not_utf8(value):
                raise invalid(name, value, "it is not UTF-8", "Give another name")


def _value_text(value: object) -> str:
    """A value of a scenario's key, a list with commas."""
    if isinstance(value, str) or not isinstance(value, Iterable):
        return str(value)
    return ", ".join(str(one) for one in value)


def _axis_text(values: str | Iterable[object]) -> str:
    """The values of a swept key: a range such as ``"0.01:0.1:5:log"``, or a list."""
    if isinstance(values, str):
        return values
    texts = [_value_text(one) for one in values]
    for text in texts:
        if "|" in text:
            raise wrong("sweep", f"{text!r} has a bar, which parts values", "Give values without bars")
    return "|".join([*texts, ""]) if any("," in text for text in texts) else ",".join(texts)


def settings_of(settings: Settings | None, sweep: Sweep | None = None) -> dict[str, list[str]]:
    """The options that change keys of scenarios."""
    return {"set": [f"{key}={_value_text(value)}" for key, value in (settings or {}).items()],
            "sweep": [f"{key}={_axis_text(values)}" for key, values in (sweep or {}).items()]}  # fmt: skip


def _goals(until: Goals | None) -> list[str]:
    if isinstance(until, Mapping):
        return [f"{metric}={width}" for metric, width in until.items()]
    return [until] if isinstance(until, str) else list(until or [])


@contextlib.contextmanager
def scenario_files(given: File | Sequence[File] | None) -> Iterator[list[str]]:
    """Paths of scenarios; a text that has lines is written into a file for as long as it is needed."""
    if given is None:
        yield []
    elif not isinstance(given, (str, os.PathLike)):
        yield [os.fspath(one) for one in given]
    elif isinstance(given, str) and "\n" in given:
        with tempfile.TemporaryDirectory(prefix="credence-") as folder:
            path = Path(folder) / "scenario.ini"
            path.write_text(given, encoding="utf-8")
            yield [str(path)]
    else:
        yield [os.fspath(given)]


def _path_of(study: Results | File) -> str:
    """The path of a results file. That of a study still leads to the file that it has open."""
    if not isinstance(study, Results):
        return os.fspath(study)
    sources = study.sources()
    if sources.records:
        raise InputError(
            "cannot use records here (`run` did not make them, so no trial can be run again). Call simulate again, "
            "with resume=True."
        )
    return sources.study


def _finish(
    name: str, arguments: Sequence[str], options: Mapping[str, object], output: str, progress: bool | None,
    folder: str | None = None, planners: Planners | None = None,
) -> Study:  # fmt: skip
    """Run a command that writes a results file, and open it. With the study goes the folder that was made for it."""
    from credence.study import open as open_study

    try:
        code, _, err = _command(name, arguments, {**options, "output": output, "quiet": True}, progress, planners)
        study = open_study(output)
    except BaseException as error:
        has_work = isinstance(error, Failure) and folder is not None and os.listdir(folder)
        if folder is not None and not has_work:
            shutil.rmtree(folder)
        raise
    if folder is not None:
        goes_with(study, folder)
    if code == STOPPED:
        raise Interrupted(" ".join(err.split()), study)
    if err:
        note(err.strip())
    return study


def _release(_: object) -> None:
    """Let go of what has been kept until now."""


@doors.door(
    path_or_text=doors.paths, trials=doors.whole(1), seed=SEED, threads=doors.whole(1), set=SETTINGS, sweep=doors.sweep,
    planners=doors.planners, until=doors.goals, output=doors.output, overwrite=doors.flag, keep=doors.text,
    force=doors.flag, executor=doors.executor, shards=doors.whole(1), progress=doors.flag,
)  # fmt: skip
def run(
    path_or_text: File | Sequence[File],
    *,
    trials: int | None = None,
    seed: int | None = None,
    threads: int | None = None,
    set: Settings | None = None,
    sweep: Sweep | None = None,
    planners: Mapping[str, Callable[[Now], Any]] | None = None,
    until: Goals | None = None,
    output: File | None = None,
    overwrite: bool = False,
    keep: str | None = None,
    force: bool = False,
    executor: Any = None,
    shards: int | None = None,
    progress: bool | None = None,
) -> Study:
    """Run a study: every scenario under all its arms. The results are those of ``credence run``, bit for bit.

    Python's other threads go on meanwhile. Ctrl-C stops the run and keeps what is done.

    Parameters
    ----------
    path_or_text : path, list of paths, or str
        Scenario files; or the text of one, which has more than one line.
    trials : int
        Trials of each scenario (10 000); with `until` their ceiling.
    seed : int
        The root seed, from 0 to 2^64 - 1 (1). The same scenarios and seed give the same results.
    threads : int
        Threads (all processors; with an executor one for each shard).
    set : dict
        Values of keys in place of the scenario's: ``{"noise.heading": 0.01}``.
    sweep : dict
        Values of keys at each of which every scenario is run, a grid where there are several keys: lists, or ranges
        such as ``"0.01:0.1:5:log"``.
    planners : dict
        Planners of one's own by name, for the worlds ``deformable`` and ``explore``: functions of a `Now` of up to 64
        trials that return the places of candidates, [B], or controls, [B, 3]. Each is an arm ``NAME.ESTIMATOR`` beside
        those of the scenario [docs/planner.md].
    until : str, list of str or dict
        Stop when a mean is known to a half-width: ``"trace_P=0.5%"``, ``{"trace_P": "0.5%"}``.
    output : path
        The results file. Without it the file is temporary: it goes with the study.
    overwrite : bool
        Whether `output` may replace a file.
    keep : str
        ``"trials"``, one number a trial of every column, or ``"aggregates"``, their totals alone.
    force : bool
        Whether a run starts for which memory or disk are too small.
    executor : int or executor
        Where shards of the study run, as of `simulate`; their files are merged [docs/cluster.md]. The files of the
        scenarios are sent along. Not with `until`, whose analyses need all trials.
    shards : int
        How many there are (as many as the executor has workers). Each has every so-many-th block of 256 trials.
    progress : bool
        Whether a bar of tqdm is drawn; by default on a terminal and in a notebook.

    Returns
    -------
    Study

    Raises
    ------
    InputError
        A ValueError: a scenario or an option cannot be used; nothing was run.
    Failure
        The work itself failed, such as on a full disk.
    Interrupted
        A KeyboardInterrupt: the run was stopped. Its `study` has what was done.
    """
    options: dict[str, Any] = {"trials": trials, "seed": seed, "threads": threads, "keep": keep, "force": force}
    of_planners = cast("Planners", planners)  # as the door has made them
    options |= settings_of({**(set or {}), **(setting_of(of_planners) if of_planners else {})}, sweep)
    if executor is not None:
        if until is not None:
            raise InputError("cannot stop shards by until (none of them has all trials). Leave executor out.")
        if output is not None and os.path.exists(output) and not overwrite:
            raise InputError(f"cannot write {output} (it exists). Say overwrite=True, or name another.")
        return _run_shards(path_or_text, options, executor, shards, progress, output, overwrite, of_planners)
    elif shards is not None:
        raise InputError("shards: say nothing without an executor. Give both, or leave it out.")
    options |= {"overwrite": overwrite, "until": _goals(until)}
    with scenario_files(path_or_text) as paths:
        return _written("run", paths, options, output, progress, of_planners)


def _run_shards(
    path_or_text: File | Sequence[File], options: Mapping[str, object], executor: Any, shards: int | None,
    progress: bool | None, output: File | None = None, overwrite: bool = False, planners: Planners | None = None,
) -> Study:  # fmt: skip
    from credence._shards import shards_of

    of_each = {**options, "threads": options.get("threads") or 1}
    with (
        scenario_files(path_or_text) as paths,
        shards_of(paths, of_each, executor, shards, progress, planners or {}) as parts,
    ):
        return merge(parts, output, overwrite=overwrite, progress=False)


def budget_of(
    path_or_text: File, of: str | None, at: str, options: Mapping[str, object], executor: Any, progress: bool | None
) -> tuple[_core.Said, Study]:
    """The budget of a scenario, and the study of its worlds [credence.budget]."""
    options = {**options, "budget": at}
    if executor is not None:
        study = _run_shards(path_or_text, options, executor, None, progress)
    else:
        with scenario_files(path_or_text) as paths:
            study = _written("run", paths, options, None, progress)
    return _said("budget", [study.path], {"of": of}), study


@doors.door(paths=doors.paths, output=doors.output, overwrite=doors.flag, progress=doors.flag)
def merge(
    paths: Sequence[File], output: File | None = None, *, overwrite: bool = False, progress: bool | None = None
) -> Study:
    """Make one results file of the shards of a study: the same bits as those of one run [docs/cluster.md].

    Parameters
    ----------
    paths : list of path
        The results files of all shards.
    output, overwrite, progress
        As of `run`.

    Returns
    -------
    Study

    Raises
    ------
    InputError
        A ValueError: shards are not of one study, or blocks are missing.
    """
    return _written("merge", [os.fspath(path) for path in paths], {"overwrite": overwrite}, output, progress)


def _written(
    name: str, arguments: Sequence[str], options: Mapping[str, object], output: File | None, progress: bool | None,
    planners: Planners | None = None,
) -> Study:  # fmt: skip
    """Run a command that writes a results file, a temporary one without `output`."""
    if output is not None:
        return _finish(name, arguments, options, os.fspath(output), progress, None, planners)
    folder = tempfile.mkdtemp(prefix="credence-")
    return _finish(name, arguments, options, os.path.join(folder, "study.h5"), progress, folder, planners)


@doors.door(
    study=FILE, trials=doors.whole(1), threads=doors.whole(1), planners=doors.planners, until=doors.goals,
    progress=doors.flag,
)  # fmt: skip
def resume(
    study: Study | File,
    *,
    trials: int | None = None,
    threads: int | None = None,
    planners: Mapping[str, Callable[[Now], Any]] | None = None,
    until: Goals | None = None,
    progress: bool | None = None,
) -> Study:
    """Run what a study lacks, after an interruption or up to more trials.

    Parameters
    ----------
    study : Study or path
        The study, or its results file; that of a run that was killed need not exist, its journal is beside its name.
    trials : int
        Trials of each scenario (those that were asked for before).
    threads, until, progress
        As of `run`.
    planners : dict
        Those of the study, whose sources must be what they were.

    Returns
    -------
    Study
        The same file, opened again.
    """
    options: dict[str, object] = {"resume": True, "trials": trials, "threads": threads, "until": _goals(until)}
    resumed = _finish("run", [], options, _path_of(study), progress, None, cast("Planners", planners))
    weakref.finalize(resumed, _release, study)  # a temporary file lives as long as either study
    return resumed


@doors.door(
    study=FILE, scenario=doors.text, arm=doors.text, trial=doors.whole(), noise=doors.path, set=SETTINGS,
    planners=doors.planners, output=doors.output, overwrite=doors.flag,
)  # fmt: skip
def replay(
    study: Study | File,
    *,
    scenario: str | None = None,
    arm: str | None = None,
    trial: int | None = None,
    noise: File | None = None,
    set: Settings | None = None,
    planners: Mapping[str, Callable[[Now], Any]] | None = None,
    output: File | None = None,
    overwrite: bool = False,
) -> list[Trajectory]:
    """Run one trial again, pose by pose: of a study, or of a scenario file on recorded noise.

    Parameters
    ----------
    study : Study or path
        The study, or a scenario file.
    scenario, arm : str
        Names in the study, such as ``"greedy.ekf"``; by default the only ones.
    trial : int
        The trial, from 0. It is checked against the study's columns bit for bit.
    noise : path
        A noise record, with a scenario file in place of `study`.
    set : dict
        Values of keys in place of the scenario's.
    planners : dict
        Those of the study, as of `resume`.
    output : path
        The trajectory file. Without it the file is temporary.
    overwrite : bool
        Whether `output` may replace a file.

    Returns
    -------
    list of Trajectory
        The trial under the arm; on recorded noise, under each arm.

    Raises
    ------
    InputError
        A ValueError: there is no such trial, or the output cannot be written.
    Failure
        The trial differs from the study's.
    """
    from credence.trajectory import open_trajectories

    options = {"scenario": scenario, "arm": arm, "trial": trial, "noise": noise, "overwrite": overwrite}
    with tempfile.TemporaryDirectory(prefix="credence-") as folder:
        path = os.path.join(folder, "trial.h5") if output is None else os.fspath(output)
        _command("replay", [_path_of(study)], {**options, **settings_of(set), "output": path}, False,
                 cast("Planners", planners))  # fmt: skip
        return open_trajectories(path)  # the open file outlives its name


def _said(command: str, paths: Sequence[str], options: Mapping[str, object]) -> _core.Said:
    _refuse_what_is_not_utf8(paths, options)
    return _core.Said(command, paths, options)


class Report(Printed):
    """What a study, a simulation or a record proves, with confidence; `json` has an entry for each scenario and arm."""


class Comparison(Printed):
    """Arms or runs compared trial by trial, A - B; `json` has an entry for each scenario and pair."""


def _sources_of(results: Results | File) -> Sources:
    if isinstance(results, Results):
        return results.sources()
    with contextlib.suppress(ImportError):  # without h5py there is no record but by judge
        from credence._file import records_in

        if records := records_in(results):
            return Sources(records=records)
    return Sources(os.fspath(results))


@doors.door(study=REPORTED)
def report(
    study: Results | File,
    *,
    margin: float | str | None = None,
    margin_direction: float | str | None = None,
    bias: float | None = None,
    failed: float | str | None = None,
) -> Report:
    """Say what a study proves: the verdict on each arm, and the numbers that it rests on.

    Parameters
    ----------
    study : Study, Simulation, one of its arms, or path
        The study, or its results file; or what `simulate` gives, or a record.
    margin, margin_direction, bias, failed
        As of `judge`; of a simulation `failed` is what it was given.

    Returns
    -------
    Report
    """
    sources = _sources_of(study)
    if failed is None and isinstance(study, Results):
        failed = study.limit
    options = {"margin": margin, "margin_direction": margin_direction, "bias": bias, "failed": failed}
    if sources.records:
        return Report(_said("judge", list(sources.records.values()), {**options, "quiet": True}))
    return Report(_said("report", [sources.study], options))


def _compared_records(given: Sequence[dict[str, str]], arms: str | tuple[str, str] | None) -> list[str]:
    """The paths of the records that are compared, the one that is subtracted first."""
    named = arms.split(",") if isinstance(arms, str) else arms
    wanted = None if named is None else [name.strip() for name in named]
    if wanted is not None:
        if len(wanted) != 2:
            raise invalid("arms", arms, "a comparison takes two", "Give A and B")
        if len(given) > 2:
            raise invalid("arms", arms, f"there are {len(given)} simulations", "Give two")
        for records, name in zip((given[0], given[-1]), wanted):
            if name not in records:
                raise KeyError(f"there is no arm {name}. There is {', '.join(records)}")
        return [given[-1][wanted[1]], given[0][wanted[0]]]
    if len(given) == 1:
        if len(given[0]) < 2:
            raise invalid("arms", None, "there is one arm, and a comparison takes two", "Give another")
        return list(given[0].values())
    if all(len(records) == 1 for records in given):
        return [path for records in given for path in records.values()]
    common = [name for name in given[0] if all(name in records for records in given)]
    if len(common) != 1:
        names = ", ".join(common or given[0])
        raise InputError(f"cannot compare all arms of several simulations ({names}). Give arms=(A, B), A of the "
                               "first and B of the second.")
    return [records[common[0]] for records in given]


@doors.door(arms=doors.texts)
def compare(
    *studies: Results | File,
    arms: str | tuple[str, str] | None = None,
    failed: float | str | None = None,
) -> Comparison:
    """Compare arms or runs trial by trial, A - B.

    Parameters
    ----------
    *studies : Study, Simulation, one of its arms, or path
        One study or simulation, whose arms are compared; several with the same seed and world; or records of the same
        runs.
    arms : tuple of str, or str
        A and B: ``("greedy", "fixed")``; of two studies A of the first and B of the second. By default every planned
        arm against its baseline, every arm of a simulation against its first, or the arms of further studies against
        those of the first.
    failed : float or str
        A warning comes first where more than this share of the trials failed (0.01, or what a simulation was given).

    Returns
    -------
    Comparison
    """
    sources = [_sources_of(study) for study in studies]
    of_records = [one.records for one in sources if one.records]
    if failed is None:
        failed = next((one.limit for one in studies if isinstance(one, Results)), None)
    if of_records and len(of_records) < len(studies):
        raise InputError("cannot compare records with results files. Give studies of one kind.")
    if of_records:
        return Comparison(_said("compare", _compared_records(of_records, arms), {"failed": failed}))
    both = arms if arms is None or isinstance(arms, str) else ",".join(arms)
    return Comparison(_said("compare", [one.study for one in sources], {"arms": both, "failed": failed}))


@doors.door(path_or_text=doors.paths, set=SETTINGS, sweep=doors.sweep)
def show(
    path_or_text: File | None = None,
    *,
    set: Settings | None = None,
    sweep: Sweep | None = None,
) -> str:
    """Return a scenario as resolved, with every default; without one, all defaults with what each key means.

    Parameters
    ----------
    path_or_text : path or str
        A scenario file, or the text of one.
    set, sweep : dict
        As of `run`.
    """
    with scenario_files(path_or_text) as paths:
        return _command("show", paths, settings_of(set, sweep))[1]
