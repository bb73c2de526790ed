"""Results with coordinates: the grids of a sweep as arrays, and arms, grids and studies as xarray's objects."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ._file import FloatArray
from .arm import Arm
from .study import Scenario, Study

if TYPE_CHECKING:
    import xarray


@dataclasses.dataclass(frozen=True)
class Grid:
    """The grid that --sweep made of a scenario.

    Attributes
    ----------
    of : str
        The scenario that was swept.
    coordinates : dict of str to ndarray
        {key: its values}, numbers rising where all are numbers, texts in the order of the study.
    names : ndarray of str
        The scenarios at the points, along the keys' axes; an empty text where there is none.
    """

    study: Study
    of: str
    coordinates: dict[str, npt.NDArray[Any]]
    names: npt.NDArray[Any]

    def values(self, number: Callable[[Scenario], npt.ArrayLike | None]) -> FloatArray:
        """``number(scenario)``, a number or an array of them, at every point, along the grid's axes and then its own;
        NaN where there is no scenario or it is None."""
        scenarios = self.study.scenarios
        found = [number(scenarios[name]) if name else None for name in self.names.flat]
        shape = next((np.shape(value) for value in found if value is not None), ())
        filled = [np.full(shape, np.nan) if value is None else np.asarray(value, np.float64) for value in found]
        return np.reshape(np.array(filled), self.names.shape + shape)

    def to_xarray(self, columns: Sequence[str] | None = None) -> xarray.Dataset:
        """Means over the trials as COLUMN, COLUMN_low and COLUMN_high (the ends of a 95 % interval) over the swept keys
        and the arms, of all columns or of those named. Needs xarray and SciPy."""
        import xarray

        scenarios = [self.study[name] for name in self.names.flat if name]
        arms = list(dict.fromkeys(arm for scenario in scenarios for arm in scenario))
        described = next(iter(scenarios[0].arms.values())).columns
        variables: dict[str, Any] = {}
        for name in described if columns is None else columns:
            found = self.values(lambda scenario, name=name: [  # type: ignore[misc]
                mean_and_ends(scenario, arm, name) for arm in arms])
            for number, suffix in enumerate(("", "_low", "_high")):
                variables[name + suffix] = ([*self.coordinates, "arm"], found[..., number],
                                            {"units": described[name].units, "long_name": described[name].meaning})
        return xarray.Dataset(variables, {**self.coordinates, "arm": arms}, {"sweep_of": self.of})


def mean_and_ends(scenario: Scenario, arm: str, column: str, minus: str | None = None) -> list[float]:
    """[mean, low, high] of a column, or of its differences to another arm; NaN where an arm is not there."""
    if arm not in scenario.group or (minus is not None and minus not in scenario.group):
        return [np.nan] * 3
    found = scenario[arm].mean(column, scenario[minus] if minus else None)
    return [float(value) for value in (found.mean, *found.interval())]


def grids_of(study: Study) -> list[Grid]:
    """Every grid of a study."""
    found: dict[tuple[str, tuple[str, ...]], dict[str, tuple[float | str, ...]]] = {}
    for name, scenario in study.scenarios.items():
        if (point := scenario.sweep) is not None:
            found.setdefault((point[0], tuple(point[1])), {})[name] = tuple(point[1].values())
    return [_grid(study, of, keys, points) for (of, keys), points in found.items()]


def _grid(study: Study, of: str, keys: Sequence[str], points: dict[str, tuple[float | str, ...]]) -> Grid:
    axes: list[list[Any]] = []
    for values in zip(*points.values(), strict=True):
        texts = any(isinstance(value, str) for value in values)
        axes.append(list(dict.fromkeys(map(as_text, values))) if texts else sorted(set(values)))
    names = np.full([len(axis) for axis in axes], "", dtype=object)
    for name, place in points.items():
        at = (axis.index(value if value in axis else as_text(value)) for axis, value in zip(axes, place, strict=True))
        names[tuple(at)] = name
    return Grid(study, of, {key: np.array(axis) for key, axis in zip(keys, axes, strict=True)}, names)


def as_text(value: Any) -> str:
    """A coordinate as people write it."""
    return value if isinstance(value, str) else f"{value:g}"


def arm_to_xarray(arm: Arm) -> xarray.Dataset:
    """See Arm.to_xarray."""
    import xarray

    kept = {name: dimensions for name, dimensions in arm.dimensions.items()
            if dimensions[0] in ("trial", "detailed_trial")}
    variables: dict[str, Any] = {name: (dimensions, arm[name], _attributes(arm, name))
                                 for name, dimensions in kept.items()}
    for name in arm.series:
        means, attributes = arm.per_step(name), _attributes(arm, name)
        variables[name] = ("step", means.mean, attributes)
        variables[f"{name}_standard_error"] = ("step", means.standard_error, attributes)
    used = {"step"}.union(*kept.values())
    coordinates = {name: arm[name] for name in sorted(used - {"component"})}
    if "component" in used:
        coordinates["component"] = np.array(arm.words("component", "component_names"))
    counts = {"counted_trials": arm.counted_trials, "failed_trials": arm.failed_trials}
    return xarray.Dataset(variables, coordinates, counts)


def _attributes(arm: Arm, name: str) -> dict[str, str]:
    described = arm.describe(name)
    return {"units": described.units, "long_name": described.meaning}


def study_to_xarray(study: Study) -> xarray.DataTree:
    """See Study.to_xarray."""
    import xarray

    if not hasattr(xarray, "DataTree"):
        raise ImportError(f"xarray {xarray.__version__} has no DataTree. Install xarray 2024.10 or later, or take "
                          "Arm.to_xarray, a Dataset of each arm.")
    nodes = {f"/{scenario.name}/{arm.name}": arm_to_xarray(arm)
             for scenario in study.scenarios.values() for arm in scenario.arms.values()}
    root = xarray.Dataset(attrs={"trials": study.trials, "seed": str(study.seed), "complete": int(study.complete)})
    return xarray.DataTree.from_dict({"/": root, **nodes})
