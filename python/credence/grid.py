"""The grids of a sweep as arrays of scenarios with coordinates."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ._file import FloatArray
from .arm import Scenario

if TYPE_CHECKING:
    import xarray


@dataclasses.dataclass(frozen=True)
class Grid:
    """The grid that --sweep made of a scenario.

    Attributes
    ----------
    scenarios : dict of str to Scenario
        Those of the study.
    of : str
        The scenario that was swept.
    coordinates : dict of str to ndarray
        {key: its values}, numbers rising where all are numbers, texts in the order of the study.
    names : ndarray of str
        The scenarios at the points, along the keys' axes; an empty text where there is none.
    """

    scenarios: Mapping[str, Scenario]
    of: str
    coordinates: dict[str, npt.NDArray[Any]]
    names: npt.NDArray[Any]

    @property
    def points(self) -> list[Scenario]:
        """The scenarios at the points that there are."""
        return [self.scenarios[name] for name in self.names.flat if name]

    def values(self, number: Callable[[Scenario], npt.ArrayLike | None]) -> FloatArray:
        """``number(scenario)``, a number or an array of them, at every point, along the grid's axes and then its own;
        NaN where there is no scenario or it is None."""
        found = [number(self.scenarios[name]) if name else None for name in self.names.flat]
        shape = next((np.shape(value) for value in found if value is not None), ())
        filled = [np.full(shape, np.nan) if value is None else np.asarray(value, np.float64) for value in found]
        return np.reshape(np.array(filled), self.names.shape + shape)

    def to_xarray(self, columns: Sequence[str] | None = None) -> xarray.Dataset:
        """Means over the trials as COLUMN, COLUMN_low and COLUMN_high (the ends of a 95 % interval) over the swept keys
        and the arms, of all columns or of those named. Needs xarray and SciPy."""
        import xarray

        scenarios = self.points
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


def grids_of(scenarios: Mapping[str, Scenario]) -> list[Grid]:
    """Every grid of these scenarios."""
    found: dict[tuple[str, tuple[str, ...]], dict[str, tuple[float | str, ...]]] = {}
    for name, scenario in scenarios.items():
        if (point := scenario.sweep) is not None:
            found.setdefault((point[0], tuple(point[1])), {})[name] = tuple(point[1].values())
    return [_grid(scenarios, of, keys, points) for (of, keys), points in found.items()]


def _grid(
    scenarios: Mapping[str, Scenario], of: str, keys: Sequence[str], points: dict[str, tuple[float | str, ...]]
) -> Grid:
    axes: list[list[Any]] = []
    for values in zip(*points.values(), strict=True):
        texts = any(isinstance(value, str) for value in values)
        axes.append(list(dict.fromkeys(map(as_text, values))) if texts else sorted(set(values)))
    names = np.full([len(axis) for axis in axes], "", dtype=object)
    for name, place in points.items():
        at = (axis.index(value if value in axis else as_text(value)) for axis, value in zip(axes, place, strict=True))
        names[tuple(at)] = name
    return Grid(scenarios, of, {key: np.array(axis) for key, axis in zip(keys, axes, strict=True)}, names)


def as_text(value: Any) -> str:
    """A coordinate as people write it."""
    return value if isinstance(value, str) else f"{value:g}"
