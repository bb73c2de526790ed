"""Scenarios of a results file, and their arms: columns and series as numpy arrays, and their means."""

from __future__ import annotations

import configparser
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from . import means
from ._file import Array, Description, FloatArray, Group, Variables, described, text
from .means import Means

if TYPE_CHECKING:
    import xarray


class Arm(Variables):
    """One arm of a scenario: an array for each column [trial] and each series [step], by key or as an attribute.

    A series is its mean over the counted trials. Whatever else the file has is there under its own name, such as
    ``detailed_nees`` [detailed_trial, step] and ``detailed_error`` [detailed_trial, step, component].
    """

    @property
    def scenario(self) -> Scenario:
        """The scenario that it is an arm of."""
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
        names = self.words("column", "column_names")
        return {name: Description(unit, name) for name, unit in zip(names, units, strict=True)}

    @property
    def series(self) -> dict[str, Description]:
        """The series, one number a step, with unit and meaning."""
        ends = "_run_square_total"
        names = (name.removesuffix(ends) for name in self.group if name.endswith(ends))
        return {name: described(self.group[f"{name}_total"]) for name in names}

    def series_of(self, role: str) -> dict[str, str]:
        """{component group or kind of rows: series} of a role: ``nees``, ``nis``, ``squared_error``, ``variance``.
        The whole state is called ``all``."""
        totals = {name: self.group[f"{name}_total"] for name in self.series}
        return {text(total, "part_of"): name for name, total in totals.items() if text(total, "role") == role}

    @property
    def trials(self) -> int:
        """Trials that are there, failed ones too."""
        return int(self.group["trial"].size) if self.keeps_trials else int(self.group["status_count"][:].sum())

    @property
    def counted_trials(self) -> int:
        """Trials over which the series run: all but those that failed (a covariance that is not positive definite,
        values that are not finite). The group ``without_diverged`` has the series without diverged ones."""
        return int(self.group.attrs["counted_trials"])

    @property
    def ended(self) -> dict[str, int]:
        """{how they ended: trials}, such as ``completed`` and ``diverged``."""
        status = self.group["status" if self.keeps_trials else "status_code"]
        codes = status.attrs["flag_values"].tolist()
        counts = [np.sum(status[:] == code) for code in codes] if self.keeps_trials else self.group["status_count"][:]
        return dict(zip(text(status, "flag_meanings").split(), map(int, counts), strict=True))

    @property
    def failed_trials(self) -> int:
        """Trials that failed or diverged; a verdict counts them so."""
        return self.trials - self.ended["completed"]

    def read(self, name: str, selection: Any = ()) -> Array:
        if f"{name}_total" not in self.group or name in self.group:
            return super().read(name, selection)
        mean: Array = np.asarray(means.of_totals(
            self._total(f"{name}_total"), self._total(f"{name}_total"), self._counts(name), 1, "").mean[selection])
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
        """The mean of a series over the counted trials at each step [step], in the series' unit; ``trace_P`` is a name
        for ``trace_P_step``. The standard error is NaN for series of integers, whose squares are not kept."""
        name = name if f"{name}_total" in self.group or f"{name}_step_total" not in self.group else f"{name}_step"
        total, squares = self._total(f"{name}_total"), f"{name}_square_total"
        square_total = self._total(squares) if squares in self else np.full_like(total, np.nan)
        return means.of_totals(total, square_total, self._counts(name), self.dimension(name),
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
            return np.broadcast_to(np.float64(self._counts(name)) * self.dimension(name), (steps,))
        rows = text(self.group[f"{name}_total"], "rows")
        more: FloatArray = np.full(steps, float(attributes["more_rows"]) * self.counted_trials)
        return more + self._total(f"{rows}_total") if rows else more

    def to_xarray(self) -> xarray.Dataset:
        """The arm as an xarray.Dataset: columns [trial], series [step] with SERIES_standard_error, the detailed
        variables, each with its unit. Needs xarray; reads all of these."""
        import xarray

        kept = {name: dimensions for name, dimensions in self.dimensions.items()
                if dimensions[0] in ("trial", "detailed_trial")}
        variables: dict[str, Any] = {name: (dimensions, self[name], self._attributes(name))
                                     for name, dimensions in kept.items()}
        for name in self.series:
            means, attributes = self.per_step(name), self._attributes(name)
            variables[name] = ("step", means.mean, attributes)
            variables[f"{name}_standard_error"] = ("step", means.standard_error, attributes)
        used = {"step"}.union(*kept.values())
        coordinates = {name: self[name] for name in sorted(used - {"component"})}
        if "component" in used:
            coordinates["component"] = np.array(self.words("component", "component_names"))
        counts = {"counted_trials": self.counted_trials, "failed_trials": self.failed_trials}
        return xarray.Dataset(variables, coordinates, counts)

    def _attributes(self, name: str) -> dict[str, str]:
        described = self.describe(name)
        return {"units": described.units, "long_name": described.meaning}

    def _counts(self, series: str) -> Any:
        """Over how many trials a series runs: [step] of a record, whose runs may lack steps."""
        return self.group[f"{series}_count"][:] if f"{series}_count" in self.group else self.counted_trials

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

    def _said(self) -> str:
        kept = "" if self.keeps_trials else ", aggregates"
        return f"<credence.Arm {self.group.name[1:]}: {self.trials:,} trials, {self.failed_trials:,} failed{kept}>"


def settings_in(scenario: str) -> dict[str, str]:
    """{key: its text} of a scenario."""
    parser = configparser.ConfigParser(interpolation=None, delimiters=("=",), comment_prefixes=("#",))
    parser.optionxform = str  # type: ignore[assignment,method-assign]
    parser.read_string(scenario)
    return {f"{section}.{key}": value for section in parser.sections() for key, value in parser.items(section)}


class Scenario(Group):
    """A scenario of a study: its arms by name, in the study's order."""

    @property
    def arms(self) -> dict[str, Arm]:
        return {name: Arm(group) for name, group in self.group.items()}

    @property
    def text(self) -> str:
        """The scenario as resolved: an INI text that ``credence.run`` reads."""
        return text(self.group, "scenario")

    def setting(self, name: str) -> str:
        """A key such as ``noise.heading``, as text; empty where the world has none of that name."""
        return settings_in(self.text).get(name, "")

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

    def __len__(self) -> int:
        return len(self.group)

    def _said(self) -> str:
        return "\n".join([f"<credence.Scenario {self.name}>", *(f"  {arm!r}" for arm in self.arms.values())])
