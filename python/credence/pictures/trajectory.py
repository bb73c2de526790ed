"""Pictures of one trial: an arm's group of a trajectory file."""
import numpy as np
from matplotlib.collections import EllipseCollection, LineCollection
from scipy import stats

import credence_results as results

from . import style

FEATURE_COLOURS = [style.GREEN, style.PURPLE, style.ORANGE]
# Name: how many standard deviations, and what to call it.
ELLIPSES = {"1-sigma": (1.0, "1-σ ellipses"), "95": (float(np.sqrt(stats.chi2.ppf(0.95, 2))), "95 % ellipses")}


def caption(arm):
    """Scenario, arm, trial and how it ended."""
    return f"{arm.name[1:]}, {results.text(arm, 'source')}"


def robot_axes(arm):
    """Places of the robot's x and y in the state; those of the features follow."""
    names = results.text(arm["component"], "component_names").split()
    return names.index("r_x"), names.index("r_x") + 2


def positions(arm, name):
    """Robot [pose, axis] and features [pose, feature, axis] of a state variable."""
    values, (robot, features) = arm[name][:], robot_axes(arm)
    return values[:, robot:features], values[:, features:].reshape(len(values), -1, 2)


def arm_colour(arm):
    """The colour that the arm has in the pictures of the study: that of its place among the scenario's arms."""
    controllers, estimators = (results.setting(arm.parent, "arms", key).replace(" ", "").split(",") or [""]
                               for key in ("controllers", "estimators"))
    names = [f"{controller or 'fixed'}.{estimator}" for controller in controllers for estimator in estimators]
    return style.arm_style(names.index(arm.name.rsplit("/", 1)[1]))["color"]


def _ellipses(axis, centres, covariances, scale, colour, **drawn):
    """Ellipses of the covariances [n, 2, 2]; those that are not there are left out."""
    there = np.isfinite(covariances).all(axis=(1, 2)) & np.isfinite(centres).all(axis=1)
    values, vectors = np.linalg.eigh(covariances[there])
    widths = 2 * scale * np.sqrt(np.maximum(values, 0))
    angles = np.degrees(np.arctan2(vectors[:, 1, 1], vectors[:, 0, 1]))
    axis.add_collection(EllipseCollection(widths[:, 1], widths[:, 0], angles, units="xy", offsets=centres[there],
                                          offset_transform=axis.transData, facecolors="none", edgecolors=colour,
                                          **drawn))


def _block(covariance, first):
    return covariance[:, first:first + 2, first:first + 2]


def _draw_features(axis, features, seen):
    """True features pose by pose, hollow where they were not seen."""
    for feature in range(features.shape[1]):
        own, missed = FEATURE_COLOURS[feature % len(FEATURE_COLOURS)], seen[:, feature] == 0
        axis.plot(*features[:, feature].T, color=own, linewidth=0.5, zorder=2)
        axis.plot(*features[~missed, feature].T, "o", color=own, markersize=1.9, zorder=2.5,
                  label=f"feature {feature}, drifting" if features.shape[1] <= len(FEATURE_COLOURS) else None)
        axis.plot(*features[missed, feature].T, "o", color=own, markersize=2.2, markerfacecolor="white",
                  markeredgewidth=0.6, zorder=2.5)
    axis.plot([], [], "o", color=style.GREY, markersize=2.4, markerfacecolor="white", markeredgewidth=0.6,
              label="not seen")


def draw_path(axis, arm, ellipse="95"):
    """True and estimated path, features with their drift, edges, ellipses, and lines of sight to what was seen."""
    (robot, features), (estimate, estimates) = positions(arm, "truth"), positions(arm, "mean")
    seen, covariance, scale = arm["seen"][:], arm["covariance"][:], ELLIPSES[ellipse][0]
    colour, (first, first_feature) = arm_colour(arm), robot_axes(arm)
    if "edge" in arm:
        ends = np.stack([features[:, arm["edge_from"][:]], features[:, arm["edge_to"][:]]], axis=2).reshape(-1, 2, 2)
        axis.add_collection(LineCollection(ends, colors="#B8B8B8", linewidths=0.5, zorder=1, label="edges"))
    sights = [(robot[pose], features[pose, feature]) for pose, feature in np.argwhere(seen == 1)]
    axis.add_collection(LineCollection(sights, colors=style.SKY, linewidths=0.6, zorder=1.5, label="lines of sight"))
    _draw_features(axis, features, seen)
    for feature in range(features.shape[1]):
        _ellipses(axis, estimates[:, feature], _block(covariance, first_feature + 2 * feature), scale,
                  FEATURE_COLOURS[feature % len(FEATURE_COLOURS)], linewidths=0.5, zorder=2.2)
    axis.plot(*robot.T, color="black", marker=".", markersize=2.5, linewidth=0.8, zorder=3, label="true path")
    axis.plot(*estimate.T, color=colour, marker="+", markersize=3.5, markeredgewidth=0.7, linewidth=0.6,
              linestyle="--", zorder=3.2, label="estimated path")
    _ellipses(axis, estimate, _block(covariance, first), scale, colour, linewidths=0.6, zorder=3.1)
    axis.plot([], [], "o", color=style.GREY, markersize=6, markerfacecolor="none", markeredgewidth=0.6,
              label=ELLIPSES[ellipse][1])
    unit = results.text(arm.parent, "length_unit")
    axis.set(aspect="equal", xlabel=f"x [{unit}]", ylabel=f"y [{unit}]")
    extent(axis, arm, ellipse)


def extent(axis, arm, ellipse="95"):
    """Sets the limits to what the trial holds, ellipses included, and returns width / height."""
    scale, (first, _) = ELLIPSES[ellipse][0], robot_axes(arm)
    reach = scale * np.sqrt(np.diagonal(arm["covariance"][:], axis1=1, axis2=2)[:, first:])
    mean, truth = arm["mean"][:, first:], arm["truth"][:, first:]
    places = np.concatenate([(mean - reach).reshape(-1, 2), (mean + reach).reshape(-1, 2), truth.reshape(-1, 2)])
    places = places[np.isfinite(places).all(axis=1)]
    low, high = places.min(axis=0) - 0.2, places.max(axis=0) + 0.2
    axis.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]))
    return (high[0] - low[0]) / (high[1] - low[1])


def path(arm, ellipse="95", width=style.PAGE):
    """The document's own figure: one trial in the plane, in a figure as high as the path asks for."""
    figure, axis = style.new_figure(width, 100)
    draw_path(axis, arm, ellipse)
    ratio, narrow = extent(axis, arm, ellipse), width < style.PAGE
    if narrow or ratio > 1.6:
        figure.set_figheight(((48 if narrow else 40) + (width - 15) / ratio) / 25.4)
        style.legend_above(axis, columns=2 if narrow else 4)
    else:
        figure.set_figheight(min(220, 18 + 110 / ratio) / 25.4)
        style.legend_right(axis)
    style.headline(figure, caption(arm))
    return figure


def _draw_error(axis, arm, component):
    """The error of a component of the state within 95 % of what the filter says."""
    names = results.text(arm["component"], "component_names").split()
    units = results.text(arm["component"], "component_units").split()
    error = arm["mean"][:, component] - arm["truth"][:, component]
    if names[component] == "theta":
        error = (error + np.pi) % (2 * np.pi) - np.pi
    half = stats.norm.ppf(0.975) * np.sqrt(arm["covariance"][:, component, component])
    axis.fill_between(arm["pose"][:], -half, half, color=style.BAND, linewidth=0)
    axis.plot(arm["pose"][:], error, marker=".", color=arm_colour(arm))
    axis.axhline(0, color=style.GREY, linewidth=0.6, zorder=0.5)
    axis.set_ylabel(f"error of {names[component]} [{units[component]}]")


def _draw_squared(axis, arm, name, degrees, label):
    """NEES or NIS of each pose, within 95 % of its chi-square."""
    low, high = (stats.chi2.ppf(tail, np.where(degrees > 0, degrees, np.nan)) for tail in (0.025, 0.975))
    axis.fill_between(arm["pose"][:], low, high, color=style.BAND, linewidth=0)
    axis.plot(arm["pose"][:], arm[name][:], marker=".", color=arm_colour(arm))
    axis.set(ylabel=label, ylim=(0, None))


def judged(arm):
    """What a single trial says of its filter: errors of the robot, NEES, NIS, trace(P) and what was seen, by pose; as
    wide as a page."""
    figure, axes = style.new_figure(style.PAGE, 100, nrows=2, ncols=3, sharex=True)
    first, first_feature = robot_axes(arm)
    for axis, component in zip(axes[0], range(first_feature)):
        _draw_error(axis, arm, component)
    seen = np.where(arm["seen"][:] == 1, 1, 0).sum(axis=1)
    if first_feature < 3:
        axes[0, 2].bar(arm["pose"][1:], seen[1:], color=arm_colour(arm), alpha=0.6, width=0.7)
        axes[0, 2].set(ylabel="features seen", ylim=(0, arm["feature"].size))
        axes[0, 2].yaxis.get_major_locator().set_params(integer=True)
    dimensions = np.where(arm["pose"][:] > 0, arm["component"].size, 0)
    _draw_squared(axes[1, 0], arm, "nees", dimensions, "NEES")
    _draw_squared(axes[1, 1], arm, "nis", np.maximum(arm["rows"][:], 0), "NIS")
    axes[1, 2].plot(arm["pose"][:], arm["trace_P"][:], marker=".", color=arm_colour(arm))
    axes[1, 2].set(ylabel="trace(P)" + style.unit_text(results.units(arm, "trace_P")), ylim=(0, None))
    for axis in axes[1]:
        style.step_axis(axis, arm["pose"][:], "pose")
    style.headline(figure, f"{caption(arm)}; grey: where 95 % of a consistent filter's are")
    return figure
