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

import configparser
import html
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, overload

import h5py
import numpy as np

from . import means
from ._file import TRAJECTORIES, Array, Description, FloatArray, Source, Variables, described, open_hdf5, stem, text
from .means import Means

if TYPE_CHECKING:
    import xarray

    from .grid import Grid

__all__ = ["Arm", "Means", "Scenario", "Study", "open"]

SHOWN = 40  # arms of a study that its table in a notebook shows


class Arm(Variables):
    """One arm of a scenario: an array for each column [trial] and each series [step], by key or as an attribute.

    A series is its mean over the counted trials. Whatever else the file has is there under its own name, such as
    ``detailed_nees`` [detailed_trial, step] and ``detailed_error`` [detailed_trial, step, component].
    """

    @property
    def scenario(self) -> Scenario:
        return Scenario(self.group.parent)

    @property
    def keeps_trials(self) -> bool:
        """Whether the file has columns: it has totals instead of a study that keeps aggregates."""
        return "keep" not in self.group.file.attrs

    @property
    def columns(self) -> dict[str, Description]:
        """The columns, one number a trial, with unit and meaning; also where only their totals are kept."""
        if self.keeps_trials:
            known = ("status", "status_pose")
            return {name: described(self.group[name]) for name, dimensions in self.dimensions.items()
                    if dimensions == ["trial"] and name not in known}
        units = text(self.group["column"], "column_units").split(", ")
        return {name: Description(unit, name) for name, unit in zip(self.words("column", "column_names"), units)}

    @property
    def series(self) -> dict[str, Description]:
        """The series, one number a step, with unit and meaning."""
        ends = "_run_square_total"
        names = (name.removesuffix(ends) for name in self.group if name.endswith(ends))
        return {name: described(self.group[f"{name}_total"]) for name in names}

    def series_of(self, role: str) -> dict[str, str]:
        """{component group or kind of rows: series} of a role: ``nees``, ``nis``, ``squared_error``, ``variance``, … .
        The whole state is called ``all``."""
        totals = {name: self.group[f"{name}_total"] for name in self.series}
        return {text(total, "part_of"): name for name, total in totals.items() if text(total, "role") == role}

    @property
    def trials(self) -> int:
        """Trials that are there, failed ones too."""
        return int(self.group["trial"].size) if self.keeps_trials else int(self.group["status_count"][:].sum())

    @property
    def counted_trials(self) -> int:
        """Trials that have numbers, over which the means run: all but those with a covariance that is not positive
        definite or with values that are not finite."""
        return int(self.group.attrs["counted_trials"])

    @property
    def ended(self) -> dict[str, int]:
        """{how they ended: trials}, such as ``completed`` and ``diverged``."""
        status = self.group["status" if self.keeps_trials else "status_code"]
        codes = status.attrs["flag_values"].tolist()
        counts = [np.sum(status[:] == code) for code in codes] if self.keeps_trials else self.group["status_count"][:]
        return dict(zip(text(status, "flag_meanings").split(), map(int, counts)))

    @property
    def failed_trials(self) -> int:
        """Trials that did not complete, those that diverged too; a verdict counts them so."""
        return self.trials - self.ended["completed"]

    def read(self, name: str, selection: Any = ()) -> Array:
        if f"{name}_total" not in self.group or name in self.group:
            return super().read(name, selection)
        total = self.group[f"{name}_total"]
        values = total[:] if total.ndim == 1 else total[..., 0]
        mean: Array = np.asarray((values / self.counted_trials if self.counted_trials else values * np.nan)[selection])
        return mean

    def describe(self, name: str) -> Description:
        """Unit and meaning of a column, a series or another variable."""
        if name in self.group:
            return super().describe(name)
        if f"{name}_total" in self.group:
            return described(self.group[f"{name}_total"])
        return self.columns[name] if name in self.columns else super().describe(name)

    def mean(self, name: str, minus: Arm | None = None) -> Means:
        """The mean of a column, or of its differences trial by trial to another arm of the same scenario.

        Parameters
        ----------
        name : str
            A column, such as ``trace_P``.
        minus : Arm, optional
            The arm that is subtracted; a trial that has no value in one of the arms is left out.

        Returns
        -------
        Means
            One number, in the column's unit; also of files that keep aggregates, from their exact totals.
        """
        units = self.describe(name).units
        if self.keeps_trials:
            values = self._numbers(name)
            return means.of_values(values - minus._numbers(name) if minus else values, units)
        column = self._place("column", "column_names", name)
        if minus is None:
            return self._exact("column", column, units)
        if self.name == minus.name:
            raise ValueError(f"invalid minus={minus.name} (an arm less itself is 0). Name two arms.")
        if "subtracted_arm" in self and minus.name in self.words("subtracted_arm", "arm_names"):
            return self._exact("difference", (self._place("subtracted_arm", "arm_names", minus.name), column), units)
        return -minus.mean(name, minus=self)

    def per_step(self, name: str) -> Means:
        """The mean of a series over the counted trials at each step [step], in the series' unit. The standard error is
        NaN for series of integers, whose squares are not kept."""
        total, squares = self._total(f"{name}_total"), f"{name}_square_total"
        square_total = self._total(squares) if squares in self else np.full_like(total, np.nan)
        return means.of_totals(total, square_total, self.counted_trials, self.dimension(name),
                               self.describe(name).units)

    def over_steps(self, name: str) -> Means:
        """The mean of a series over trials and steps. Its standard error takes one number a trial, because steps are
        correlated."""
        total, squares = self._total(f"{name}_total").sum(), self._total(f"{name}_run_square_total")
        whole = means.of_totals(np.asarray(total), np.asarray(squares), self.counted_trials, self.dimension(name),
                                self.describe(name).units)
        return whole.over(self.group["step"].size)

    def dimension(self, name: str) -> int:
        """Components of the group that a series belongs to; 1 for a series without a dimension."""
        return int(self.group[f"{name}_total"].attrs.get("dimension", 1))

    def degrees(self, name: str) -> FloatArray:
        """[step] degrees of freedom of the chi-square that the total of a NEES or NIS follows if the filter is
        consistent."""
        attributes, steps = self.group[f"{name}_total"].attrs, self.group["step"].size
        if "dimension" in attributes:
            return np.full(steps, float(self.counted_trials * self.dimension(name)))
        rows = text(self.group[f"{name}_total"], "rows")
        more: FloatArray = np.full(steps, float(attributes["more_rows"]) * self.counted_trials)
        return more + self._total(f"{rows}_total") if rows else more

    def to_xarray(self) -> xarray.Dataset:
        """The arm as an xarray.Dataset: columns [trial], series [step] with SERIES_standard_error, the detailed
        variables, each with its unit. Needs xarray; reads all of these."""
        from .grid import arm_to_xarray

        return arm_to_xarray(self)

    def _total(self, name: str) -> FloatArray:
        variable = self.group[name]
        return np.asarray(variable[:] if variable.dtype.kind == "i" else variable[..., 0], np.float64)

    def _numbers(self, name: str) -> FloatArray:
        return self.read(name).astype(np.float64)

    def _exact(self, of: str, place: Any, units: str) -> Means:
        return means.of_exact_totals(self.group[f"{of}_total"][place], self.group[f"{of}_square_total"][place],
                                     int(self.group[f"{of}_count"][place]), units)

    def _place(self, variable: str, attribute: str, name: str) -> int:
        names = self.words(variable, attribute)
        if name not in names:
            raise KeyError(f"{self.group.name} has no {name}. It has {', '.join(names)}")
        return names.index(name)

    def _missing(self, name: str) -> str:
        if not self.keeps_trials and name in (*self.columns, "trial", "status", "status_pose"):
            return (f"{self.group.name} has no {name} of single trials, because the study keeps aggregates. Take "
                    f"arm.mean({name!r}), or run the study with --keep trials")
        return f"{self.group.name} has no {name}. It has {', '.join([*self.columns, *self.series])}"

    def __contains__(self, name: object) -> bool:
        return super().__contains__(name) or f"{name}_total" in self.group

    def __iter__(self) -> Iterator[str]:
        yield from self.series
        yield from self.group

    def __repr__(self) -> str:
        kept = "" if self.keeps_trials else ", aggregates"
        return f"<credence.Arm {self.group.name[1:]}: {self.trials:,} trials, {self.failed_trials:,} failed{kept}>"


class Scenario:
    """A scenario of a study: its arms by name, in the study's order."""

    def __init__(self, group: h5py.Group) -> None:
        #: The plain h5py group.
        self.group = group
        self.name = stem(group)

    @property
    def arms(self) -> dict[str, Arm]:
        return {name: Arm(group) for name, group in self.group.items()}

    @property
    def text(self) -> str:
        """The scenario as resolved: an INI text that ``credence.run`` reads."""
        return text(self.group, "scenario")

    def setting(self, name: str) -> str:
        """A key such as ``noise.heading``, as text; empty where the world has none of that name."""
        parser = configparser.ConfigParser(interpolation=None, delimiters=("=",), comment_prefixes=("#",))
        parser.optionxform = str  # type: ignore[assignment,method-assign]
        parser.read_string(self.text)
        return parser.get(*name.split(".", 1), fallback="")

    def published(self, column: str) -> dict[str, float]:
        """{arm: value of the column in the published single run}, where the scenario names one."""
        pairs = [pair.split() for pair in self.setting(f"published.{column}").split(",") if pair.strip()]
        return {pair[0]: float(pair[1]) for pair in pairs if len(pair) == 2}

    @property
    def sweep(self) -> tuple[str, dict[str, float | str]] | None:
        """(scenario that was swept, {key: value here}) of a point of a grid; None of another scenario."""
        if "sweep_of" not in self.group.attrs:
            return None
        values = {key: self.group.attrs[f"sweep.{key}"] for key in text(self.group, "sweep_keys").split()}
        return text(self.group, "sweep_of"), {
            key: text(self.group, f"sweep.{key}") if isinstance(value, bytes | str) else float(value)
            for key, value in values.items()}

    def __getitem__(self, arm: str) -> Arm:
        if arm not in self.group:
            raise KeyError(f"{self.name} has no arm {arm}. It has {', '.join(self.group)}")
        return Arm(self.group[arm])

    def __iter__(self) -> Iterator[str]:
        return iter(self.group)

    def __len__(self) -> int:
        return len(self.group)

    def __repr__(self) -> str:
        return "\n".join([f"<credence.Scenario {self.name}>", *(f"  {arm!r}" for arm in self.arms.values())])


class Study:
    """A results file. ``study["scenario", "arm"]`` is an Arm and ``study["scenario"]`` a Scenario; in a study of one
    scenario ``study["arm"]`` is an Arm, too. Close it, or use it in a `with` statement, to let go of the file."""

    def __init__(self, file: h5py.File) -> None:
        #: The plain h5py file.
        self.file = file

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
    def seed(self) -> int:
        return int(text(self.file, "root_seed_text"))

    @property
    def path(self) -> str:
        return str(self.file.filename)

    @property
    def grids(self) -> list[Grid]:
        """The grids that sweeps made (docs/sweep.md), as arrays of scenarios with coordinates."""
        from .grid import grids_of

        return grids_of(self)

    def to_xarray(self) -> xarray.DataTree:
        """The study as an xarray.DataTree: a node for each scenario, and in it one for each arm. It reads the file.
        Needs xarray 2024.10 or later; Arm.to_xarray works with any."""
        from .grid import study_to_xarray

        return study_to_xarray(self)

    def close(self) -> None:
        self.file.close()

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

    def _state(self) -> str:
        kept = ", aggregates" if "keep" in self.file.attrs else ""
        return f"{self.trials:,} trials, seed {self.seed}, {'complete' if self.complete else 'not complete'}{kept}"

    def __repr__(self) -> str:
        if not self.file:
            return "<credence.Study, closed>"
        shown = [f"  {arm!r}" for arm in self.arms[:SHOWN]]
        return "\n".join([f"<credence.Study {self.path}: {self._state()}>", *shown, *self._rest()])

    def _repr_html_(self) -> str:
        if not self.file:
            return html.escape(repr(self))
        rows = "".join("<tr>" + "".join(f"<td>{html.escape(str(cell))}</td>" for cell in _row(arm)) + "</tr>"
                       for arm in self.arms[:SHOWN])
        heads = "".join(f"<th>{head}</th>" for head in ("scenario", "arm", "trials", "failed", "NEES / n"))
        rest = "".join(f"<p>{line}</p>" for line in self._rest())
        return (f"<p><b>{html.escape(self.path)}</b>: {self._state()}</p><table><thead><tr>{heads}</tr></thead>"
                f"<tbody>{rows}</tbody></table>{rest}")

    def _rest(self) -> list[str]:
        more = len(self.arms) - SHOWN
        return [f"and {more} arms more"] if more > 0 else []


def _row(arm: Arm) -> tuple[str, ...]:
    ratio = arm.over_steps("nees") if "nees" in arm.series else None
    shown = f"{float(ratio.mean) / ratio.dimension:.3f}" if ratio and arm.counted_trials else "\N{EN DASH}"
    trials = f"{arm.trials:,}" if arm.trials else "not run yet"
    return stem(arm.group.parent), arm.name, trials, f"{arm.failed_trials:,}", shown


def open(source: Source) -> Study:
    """Opens a results file; nothing but its header is read.

    Parameters
    ----------
    source : path or binary file
        What ``credence run -o`` wrote, of schema version 2 or 3; or an open file, such as io.BytesIO.

    Returns
    -------
    Study

    Raises
    ------
    FileNotFoundError, ValueError
        The file is not there, or is not a results file of a version that this package reads.
    """
    file, kind = open_hdf5(source)
    if kind == TRAJECTORIES:
        file.close()
        raise ValueError(f"{source}: format: it has trajectories, not results. Take credence.open_trajectories.")
    return Study(file)
