"""Pictures of one trial: its path in the plane, its errors within what P says, its NEES."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection, LineCollection
from matplotlib.colors import ListedColormap
from matplotlib.patches import Wedge
from scipy import stats

from .._file import FloatArray
from ..trajectory import Trajectory
from . import style
from .style import Picture

FEATURES = [(style.GREEN, "o"), (style.PURPLE, "s"), (style.ORANGE, "^")]  # of more than these all look like the first
TRUE_PATH = {"color": "#A8A8A8", "linewidth": 2.6, "markerfacecolor": "black", "markeredgecolor": "black"}
SIGMA = "\N{GREEK SMALL LETTER SIGMA}"
ELLIPSES = {"1-sigma": (1.0, f"1-{SIGMA} ellipses"), "95": (float(np.sqrt(stats.chi2.ppf(0.95, 2))), "95 % ellipses")}


def source(trial: Trajectory) -> str:
    """Scenario, arm and trial."""
    return f"{trial.scenario.name}, {trial.name}, {trial.source}"


def arm_colour(trial: Trajectory) -> str:
    """The colour that the arm has in the pictures of the study: that of its place among the scenario's arms."""
    controllers, estimators = (trial.scenario.setting(f"arms.{key}").replace(" ", "").split(",") or [""]
                               for key in ("controllers", "estimators"))
    names = [f"{controller or 'fixed'}.{estimator}" for controller in controllers for estimator in estimators]
    return str(style.arm_style(names.index(trial.name) if trial.name in names else 0)["color"])


def ellipses(centres: FloatArray, covariances: FloatArray, scale: float, axis: Axes, **drawn: Any) -> None:
    """Ellipses of the covariances [n, 2, 2] about centres [n, 2]; those that are not there are left out."""
    there = np.isfinite(covariances).all(axis=(1, 2)) & np.isfinite(centres).all(axis=1)
    values, vectors = np.linalg.eigh(covariances[there])
    widths = 2 * scale * np.sqrt(np.maximum(values, 0))
    angles = np.degrees(np.arctan2(vectors[:, 1, 1], vectors[:, 0, 1]))
    axis.add_collection(EllipseCollection(widths[:, 1], widths[:, 0], angles, units="xy", offsets=centres[there],
                                          offset_transform=axis.transData, facecolors="none", **drawn))


def block(covariance: FloatArray, first: int) -> FloatArray:
    """The 2 x 2 part of each covariance."""
    return covariance[:, first:first + 2, first:first + 2]


def _numbers(trial: Trajectory, key: str) -> FloatArray:
    """The numbers of a setting; none where it is `none`."""
    said = trial.scenario.setting(key).replace(",", " ").split()
    return np.array([] if said == ["none"] else said, float)


def map_box(trial: Trajectory) -> FloatArray:
    """[low x, high x, low y, high y] of the grid of the world `explore`."""
    low, cell = _numbers(trial, "map.box")[:2], _numbers(trial, "map.cell")
    return np.stack([low, low + cell * trial["cell_viewed"].shape[::-1]], axis=1).ravel()


def draw_map(axis: Axes, trial: Trajectory, pose: int) -> None:
    """Of the world `explore`: walls, the cells that were in sight up to a pose, and the view there."""
    if "cell_viewed" not in trial:
        return
    viewed, robot, heading = trial["cell_viewed"], trial.positions("truth")[0], trial["truth"][:, 0]
    axis.imshow(np.where((viewed >= 0) & (viewed <= pose), 0.0, np.nan), ListedColormap([style.BAND]),
                extent=tuple(map_box(trial)), origin="lower", interpolation="nearest", zorder=0.1)
    axis.add_collection(LineCollection(list(_numbers(trial, "walls.segments").reshape(-1, 2, 2)), colors="black",
                                       linewidths=1.6, zorder=2, label="walls"))
    half, reach = np.degrees(_numbers(trial, "sensor.view")[0] / 2), _numbers(trial, "sensor.range_max")[0]
    if np.isfinite(reach):
        middle = np.degrees(heading[pose])
        axis.add_patch(Wedge(tuple(robot[pose]), reach, middle - half, middle + half, facecolor=style.SKY, alpha=0.25,
                             linewidth=0, zorder=0.2))


def extent(trial: Trajectory, scale: float) -> FloatArray:
    """[low x, high x, low y, high y] of what the trial holds: all true places, and estimates with their ellipses as far
    as they are within a sixth of its size from the truth, with room for their marks."""
    first = trial.components.index("r_x")
    mean, truth = trial["mean"][:, first:], trial["truth"][:, first:]
    true_places = truth.reshape(-1, 2)
    size = float(np.ptp(true_places[np.isfinite(true_places).all(axis=1)], axis=0).max())
    reach = scale * np.sqrt(np.diagonal(trial["covariance"], axis1=1, axis2=2)[:, first:])
    near = np.abs(mean - truth) + reach < size / 6
    ends = [np.where(near, end, truth).reshape(-1, 2) for end in (mean - reach, mean + reach, truth)]
    places = np.concatenate([*ends, map_box(trial).reshape(2, 2).T] if "cell_viewed" in trial else ends)
    places = places[np.isfinite(places).all(axis=1)]
    low, high = places.min(axis=0) - 0.03 * size, places.max(axis=0) + 0.03 * size
    return np.stack([low, high], axis=1).ravel()


def shape(box: FloatArray) -> float:
    """Width / height of an extent."""
    return float((box[1] - box[0]) / (box[3] - box[2]))


def show(axis: Axes, trial: Trajectory, box: FloatArray) -> None:
    """Shows that extent, with the same scale in both directions."""
    unit = trial.scenario.group.attrs["length_unit"]
    unit = unit.decode() if isinstance(unit, bytes) else unit
    axis.set(xlim=box[:2], ylim=box[2:], aspect="equal", xlabel=f"x [{unit}]", ylabel=f"y [{unit}]")


def draw_path(axis: Axes, trial: Trajectory, ellipse: str = "95") -> None:
    """True and estimated path, features, edges, ellipses, and lines of sight to what was seen."""
    (robot, features), (estimate, estimates) = trial.positions("truth"), trial.positions("mean")
    seen, covariance, scale = trial["seen"], trial["covariance"], ELLIPSES[ellipse][0]
    draw_map(axis, trial, len(robot) - 1)
    colour, first, few = arm_colour(trial), trial.components.index("r_x"), features.shape[1] <= len(FEATURES)
    if "edge" in trial:
        ends = np.stack([features[:, trial["edge_from"]], features[:, trial["edge_to"]]], axis=2).reshape(-1, 2, 2)
        axis.add_collection(LineCollection(list(ends), colors="#A0A0A0", linewidths=0.6, linestyles=":",
                                           zorder=1, label="edges"))
    sights = [(robot[pose], features[pose, feature]) for pose, feature in np.argwhere(seen == 1)]
    axis.add_collection(LineCollection(sights, colors=style.SKY, linewidths=0.6 if few else 0.2, zorder=1.5,
                                       label="lines of sight"))
    shown = style.thinned(*robot.T, *estimate.T)
    short = len(robot) <= 60
    for feature in range(features.shape[1]):
        own, mark = FEATURES[feature if few else 0]
        drawn = slice(None) if few else slice(-1, None)  # many stand still: their last ellipse says it all
        ellipses(estimates[drawn, feature], block(covariance, first + 2 + 2 * feature)[drawn], scale, axis,
                 edgecolors=own, linewidths=0.5, zorder=3.3)
        axis.plot(*features[:, feature].T, mark, linestyle="-", color=own, linewidth=0.5, markersize=2.6, zorder=3.4,
                  markerfacecolor="none", markeredgewidth=0.7,
                  label=f"feature {feature}" if few else ("features" if feature == 0 else None))
    axis.plot(*robot[shown].T, marker="." if short else "", markersize=2.5, zorder=2.8, label="true path",
              **TRUE_PATH)  # type: ignore[arg-type]
    axis.plot(*estimate[shown].T, color=colour, marker="+" if short else "", markersize=5, markeredgewidth=0.7,
              linewidth=0.9, linestyle="--", zorder=3.2, label="estimated path")
    some = np.unique(np.linspace(0, len(robot) - 1, min(len(robot), 30)).astype(int))
    ellipses(estimate[some], block(covariance, first)[some], scale, axis, edgecolors=colour, linewidths=0.6, zorder=3.1)
    axis.plot([], [], "o", color=style.GREY, markersize=6, markerfacecolor="none", markeredgewidth=0.6,
              label=ELLIPSES[ellipse][1])


def need_path(trial: Trajectory) -> None:
    if not trial.has_path:
        raise ValueError(f"invalid kind=path ({trial.name} has no robot in the plane). Take errors or nees.")


def path(trial: Trajectory, width: float, *, ellipse: str = "95") -> Picture:
    """The trial in the plane, in a picture as high as the path asks for."""
    need_path(trial)
    picture, axis = style.one_panel(width)
    draw_path(axis, trial, ellipse)
    box = extent(trial, ELLIPSES[ellipse][0])
    show(axis, trial, box)
    ratio = shape(box)
    entries = list(zip(*axis.get_legend_handles_labels(), strict=True))
    if ratio > 1.6 or width < style.PAGE:
        picture.set_figheight((34 + (width - 22) / ratio) / 25.4)
        style.key(axis, entries, width, beside_panel=False)
    else:
        picture.set_figheight(min(180, 28 + (width - 58) / ratio) / 25.4)
        style.beside(axis, entries)
    columns, first = trial.columns, trial.components.index("r_x")
    last = float(np.linalg.norm(trial.errors[-1, first:first + 2]))
    half = float(np.sqrt(np.trace(block(trial["covariance"][-1:], first)[0])))
    unit = trial.component_units[first]
    picture.title(f"The last position is off by {last:.3g} {unit}; the filter says {half:.3g} {unit} (1 {SIGMA}). "
                  f"NEES / n is {columns['nees_ratio']:.2f}", source(trial))
    return picture


def errors(trial: Trajectory, width: float) -> Picture:
    """The error of each component of the robot (of a user's own world the first three) within 95 % of what P says."""
    shown = trial.components.index("r_x") + 2 if trial.has_path else min(3, len(trial.components))
    picture = Picture(width, 24 + 34 * shown)
    axes = picture.subplots(nrows=shown, sharex=True, squeeze=False)[:, 0]
    outside, pose = {}, trial["pose"]
    for component, axis in enumerate(axes):
        error = trial.errors[:, component]
        half = stats.norm.ppf(0.975) * np.sqrt(trial["covariance"][:, component, component])
        drawn = style.thinned(error, half)
        axis.fill_between(pose[drawn], -half[drawn], half[drawn], color=style.BAND, linewidth=0)
        axis.plot(pose[drawn], error[drawn], marker="." if drawn.size <= 200 else "", color=arm_colour(trial))
        axis.axhline(0, color=style.GREY, linewidth=0.6, zorder=0.5)
        axis.set_ylabel(f"error of {trial.components[component]} [{trial.component_units[component]}]")
        outside[trial.components[component]] = float(np.sum(np.abs(error) > half))
    style.step_axis(axes[-1], pose, "pose")
    style.key(axes[0], [style.band_entry("95 % of what P says")], width)
    measured = int(np.isfinite(trial.errors[:, 0]).sum())
    picture.title("Errors leave the 95 % of what P says: " + style.ranked(outside, lambda count: f"at {count:.0f}")
                  + f" of {measured} poses{_by_chance(measured)}", source(trial))
    return picture


def _by_chance(poses: int) -> str:
    """What a consistent filter has of that."""
    return f" (a consistent filter: at about {poses / 20:.0f})"


def nees(trial: Trajectory, width: float) -> Picture:
    """NEES at each pose, within 95 % of its chi-square."""
    picture, axis = style.one_panel(width)
    pose, values, n = trial["pose"], trial["nees"], len(trial.components)
    low, high = (float(stats.chi2.ppf(tail, n)) for tail in (0.025, 0.975))
    drawn = style.thinned(values)
    axis.axhspan(low, high, color=style.BAND, linewidth=0, zorder=0)
    axis.plot(pose[drawn], values[drawn], marker="." if drawn.size <= 200 else "", color=arm_colour(trial))
    axis.set(ylabel=f"NEES ({n} components)", ylim=(0, None))
    style.step_axis(axis, pose, "pose")
    style.key(axis, [style.band_entry(f"95 % of χ²({n})")], width)
    there = np.isfinite(values)
    picture.title(f"NEES lies outside the 95 % of χ²({n}) at {np.sum((values < low) | (values > high))} of "
                  f"{there.sum()} poses{_by_chance(there.sum())}", source(trial))
    return picture
