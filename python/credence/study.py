"""Results files as numpy arrays. Nothing is read from the disk until it is asked for.

    study = credence.open("study.h5")
    arm = study["kf-circle-constant", "greedy.kf"]      # of a study of one scenario: study["greedy.kf"]
    arm.trace_P                                         # [trial], NaN for trials without a result
    arm.nees                                            # [step], the mean over the trials
    arm.per_step("nees").standard_error                 # [step]
    arm.mean("trace_P", minus=study["kf-circle-constant", "fixed.kf"]).interval()

docs/results-format.md says what is in a file. `arm.group` is the plain h5py group.
"""

from __future__ import annotations

import html
import json
import os
import tempfile
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, overload

import h5py

from . import _doors as doors
from ._errors import InputError
from ._file import TRAJECTORIES, Identity, Source, open_hdf5, parted, records_in, stem, still_open, text
from ._results import Results, Sources
from .arm import Arm, Scenario
from .grid import Grid, grids_of
from .means import Means

if TYPE_CHECKING:
    import xarray

__all__ = ["Arm", "Means", "Scenario", "Study", "open"]

SHOWN = 40  # arms of a study that its table in a notebook shows


class Study(Results):
    """A results file. ``study["scenario", "arm"]`` is an Arm and ``study["scenario"]`` a Scenario; in a study of one
    scenario ``study["arm"]`` is an Arm, too. Close it, or use it in a `with` statement, to let go of the file."""

    def __init__(self, file: h5py.File) -> None:
        self._file = file
        #: Which file is open, to be compared with what its path leads to later; None of one in memory.
        self.identity = Identity.of(file.id.get_vfd_handle()) if file.driver == "sec2" else None

    @property
    def file(self) -> h5py.File:
        """The plain h5py file."""
        return still_open(self._file)

    @property
    def scenarios(self) -> dict[str, Scenario]:
        """The scenarios in the study's order, which h5py keeps for file["/"] only."""
        return {name: Scenario(group) for name, group in self.file["/"].items() if name != "run"}

    @property
    def arms(self) -> list[Arm]:
        """All arms of all scenarios."""
        return [arm for scenario in self.scenarios.values() for arm in scenario.arms.values()]

    @property
    def trials(self) -> int:
        """Trials of each scenario that were asked for."""
        return int(self.file.attrs["trials"])

    @property
    def complete(self) -> bool:
        """Whether all of them were run; otherwise it is a part of a study, or an interrupted run."""
        return bool(self.file.attrs["complete"])

    @property
    def seed(self) -> int | None:
        """The root seed; None of records that have none."""
        return int(text(self.file, "root_seed_text")) if "root_seed_text" in self.file.attrs else None

    @property
    def records(self) -> list[str]:
        """The paths of the records that the study was made of; none of a results file."""
        return list(json.loads(text(self.file, "records"))) if "records" in self.file.attrs else []

    @property
    def path(self) -> str:
        """The absolute path that it was opened by."""
        return str(self.file.filename)

    @property
    def study(self) -> Study:
        """Itself, which `Simulation.study` is of a simulation."""
        return self

    def sources(self) -> Sources:
        if records := self.records:
            return Sources(records={arm.name: path for arm, path in zip(self.arms, records)})
        if self.identity is None:
            raise InputError("cannot use a study in memory here (it has no path). Give the path of its file.")
        if Identity.of(self.path) != self.identity:
            why = "it was changed, replaced or removed since the study was opened"
            raise InputError(f"cannot use {self.path} ({why}). Open it again.")
        return Sources(self.path)

    @property
    def grids(self) -> list[Grid]:
        """The grids that sweeps made (docs/sweep.md), as arrays of scenarios with coordinates."""
        return grids_of(self.scenarios)

    def to_xarray(self) -> xarray.DataTree:
        """The study as an xarray.DataTree: a node for each scenario, and in it one for each arm. It reads the file.
        Needs xarray 2024.10 or later; Arm.to_xarray works with any."""
        import xarray

        if not hasattr(xarray, "DataTree"):
            raise ImportError(f"xarray {xarray.__version__} has no DataTree. Install xarray 2024.10 or later, or take "
                              "Arm.to_xarray, a Dataset of each arm.")
        nodes = {f"/{arm.scenario.name}/{arm.name}": arm.to_xarray() for arm in self.arms}
        root = xarray.Dataset(attrs={"trials": self.trials, "seed": str(self.seed), "complete": int(self.complete)})
        return xarray.DataTree.from_dict({"/": root, **nodes})

    def close(self) -> None:
        self._file.close()

    @overload
    def __getitem__(self, name: tuple[str, str]) -> Arm: ...
    @overload
    def __getitem__(self, name: str) -> Any: ...
    def __getitem__(self, name: str | tuple[str, str]) -> Any:
        if isinstance(name, tuple):
            return self[name[0]][name[1]]
        scenarios = self.scenarios
        if name in scenarios:
            return scenarios[name]
        if len(scenarios) == 1:
            return next(iter(scenarios.values()))[name]
        raise KeyError(f"the study has no scenario {name}. It has {', '.join(scenarios)}")

    def __iter__(self) -> Iterator[str]:
        return iter(self.scenarios)

    def __len__(self) -> int:
        return len(self.scenarios)

    def __enter__(self) -> Study:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _source(self) -> str:
        return ", ".join(self.records) or self.path

    def _state(self) -> str:
        kept = ", aggregates" if "keep" in self.file.attrs else ""
        seed = "" if self.seed is None else f", seed {self.seed}"
        return f"{self.trials:,} trials{seed}, {'complete' if self.complete else 'not complete'}{kept}"

    def __repr__(self) -> str:
        if not self._file:
            return "<credence.Study, closed>"
        shown = [f"  {arm!r}" for arm in self.arms[:SHOWN]]
        return "\n".join([f"<credence.Study {self._source()}: {self._state()}>", *shown, *self._rest()])

    def _repr_html_(self) -> str:
        if not self._file:
            return html.escape(repr(self))
        rows = "".join("<tr>" + "".join(f"<td>{html.escape(str(cell))}</td>" for cell in _row(arm)) + "</tr>"
                       for arm in self.arms[:SHOWN])
        heads = "".join(f"<th>{head}</th>" for head in ("scenario", "arm", "trials", "failed", "NEES / n"))
        rest = "".join(f"<p>{line}</p>" for line in self._rest())
        return (f"<p><b>{html.escape(self._source())}</b>: {self._state()}</p><table><thead><tr>{heads}</tr></thead>"
                f"<tbody>{rows}</tbody></table>{rest}")

    def _rest(self) -> list[str]:
        more = len(self.arms) - SHOWN
        return [f"and {more} arms more"] if more > 0 else []


def _row(arm: Arm) -> tuple[str, ...]:
    ratio = arm.over_steps("nees") if "nees" in arm.series else None
    shown = f"{float(ratio.mean) / ratio.dimension:.3f}" if ratio and arm.counted_trials else "\N{EN DASH}"
    trials = f"{arm.trials:,}" if arm.trials else "not run yet"
    return stem(arm.group.parent), arm.name, trials, f"{arm.failed_trials:,}", shown


def of_records(paths: Sequence[str]) -> Study:
    """The study whose arms are records of the same trials: their columns, and their series by step."""
    from credence import _core

    whole = [os.path.abspath(os.fspath(path)) for path in paths]
    with h5py.File(parted(whole[0])[0], "r") as first:
        seed = int(first.attrs["seed"]) if "seed" in first.attrs else None
    with tempfile.TemporaryDirectory(prefix="credence-") as folder:
        path = os.path.join(folder, "records.h5")
        _core.write_results_of([os.fsencode(one) for one in whole], seed or 0, os.fsencode(path))
        with h5py.File(path, "r+") as file:
            file.attrs["records"] = json.dumps(whole)
            if seed is None:
                del file.attrs["root_seed_text"]
        return Study(h5py.File(path, "r"))  # the open file outlives its name


def _openable(name: str, value: Any) -> Any:
    if isinstance(value, Results):
        return value
    return doors.paths(name, value) if isinstance(value, (list, tuple)) else doors.source(name, value)


@doors.door(source=_openable)
def open(source: Source | Results | Sequence[str | os.PathLike[str]]) -> Study:
    """Opens a results file, of which nothing but the header is read; or records, which are read whole.

    Parameters
    ----------
    source : path, binary file, Simulation or list of paths
        What ``credence run -o`` wrote, of schema version 5, or an open file, such as io.BytesIO; what `simulate` gives;
        or the path of a record [docs/judge.md], or several of the same trials, which are then its arms.

    Returns
    -------
    Study

    Raises
    ------
    FileNotFoundError, ValueError
        The file is not there, or is not a results file of a version that this package reads.
    """
    if isinstance(source, Results):
        study: Study = source.study
        return study
    if isinstance(source, (list, tuple)):
        return of_records([os.fspath(one) for one in source])
    if records := records_in(source):
        return of_records(list(records.values()))
    file, kind = open_hdf5(source)  # type: ignore[arg-type]
    if kind == TRAJECTORIES:
        file.close()
        raise ValueError(f"{source}: format: it has trajectories, not results. Take credence.open_trajectories.")
    return Study(file)
