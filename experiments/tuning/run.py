"""Prints the tables of docs/tuning.md.

    python run.py [NAME...]      tracker, radar, document, attitude, nile; all without a name

`gallery` as a name is of worlds of one's own, whose program is that of experiments/worlds: GALLERY, or
build/worlds/gallery.
"""

from __future__ import annotations

import os
import pathlib
import sys
import warnings
from collections.abc import Iterable
from typing import Any

import filters

import credence

DOCUMENT = """[scenario]
name = document
title = the document's world
[arms]
controllers = fixed, greedy
"""
EXACT = 1e-4  # factor on the believed noise of edges


def table(head: str, rows: Iterable[Iterable[object]]) -> None:
    names = head.split(" | ")
    print(f"\n| {head} |\n|{'---|' * len(names)}")
    for row in rows:
        print(f"| {' | '.join(map(str, row))} |")


def group(verdict: Any, name: str) -> dict[str, Any]:
    return next(one for one in verdict["groups"] if one["group"] == name)


def with_interval(column: dict[str, Any], digits: int = 3) -> str:
    if column["mean"] is None:
        return "-"
    return f"{column['mean']:.{digits}f} ± {(column['ci95'][1] - column['ci95'][0]) / 2:.{digits}f}"


def sides(found: credence.Tuned, part: str) -> list[list[object]]:
    """Rows of before and after: log score, RMSE of a part, NEES/n, verdict."""
    rows = []
    for name, one in (("before", found.verdict_before), ("after", found.verdict)):
        rmse = f"{group(one, part)['accuracy']['rmse']:.4g}"
        rows.append([name, with_interval(one["log_score"]), rmse, with_interval(one["nees_ratio"]), one.verdict])
    return rows


def tracker() -> None:
    rows = []
    for objective in ("errors", "innovations", "nees"):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of the custom
            found = credence.tune(filters.tracker, free={"q": (0.01, 10), "r": (0.1, 10)}, batch=True,
                                  objective=objective)  # fmt: skip
        rows += [[objective, *found.parameters.values(), found.evaluations, *sides(found, "position")[1][1:]]]
    start = [["the start", 1, 1, "-", *sides(found, "position")[0][1:]]]
    table("objective | q (truth 0.2) | r (truth 2) | evaluations | log score | RMSE of position [m] | NEES/n | verdict",
          start + rows)  # fmt: skip


def radar() -> None:
    free = {"q": (0.1, 10), "distance": (1, 1000), "bearing": (1e-4, 0.1)}
    found = credence.tune(filters.radar, free=free, executor=2)
    table("parameter | truth | start | tuned | put back, the score rises by",
          ([name, filters.RADAR[name], found.start[name], one, f"{found.gains[name]:.2g}"]
           for name, one in found.parameters.items()))  # fmt: skip
    table(" | log score | RMSE of position [m] | NEES/n | verdict", sides(found, "position"))


def document() -> None:
    fixed = DOCUMENT.replace("fixed, greedy", "fixed")
    found = credence.tune(fixed, free={"filter.features": (0.02, 20), "filter.edges": (EXACT, 10)}, trials=1000,
                          held_out=20_000)  # fmt: skip
    table("factor | tuned | put back, the score rises by",
          ([name, one, f"{found.gains[name]:.2g}"] for name, one in found.parameters.items()))  # fmt: skip
    names = ("all", "pose", "feature_0", "feature_1", "feature_2")
    table("NEES/dim | " + " | ".join(names) + " | RMSE of features [dm] | verdict",
          ([side, *(f"{group(one, name)['nees_ratio']:.3f}" for name in names),
            f"{group(one, 'features')['accuracy']['rmse']:.4f}", one.verdict]
           for side, one in (("before", found.verdict_before), ("after", found.verdict))))  # fmt: skip
    rows = []
    for side, factor in (("before", 1), ("after", EXACT)):
        study = credence.run(DOCUMENT, trials=10_000, set={"filter.edges": factor}, progress=False)
        for arm in study.arms:
            means = [arm.mean(column) for column in ("pose_error", "trace_P", "unseen")]
            ends = [one.interval() for one in means]
            rows.append([f"{side}, {arm.name}", *(f"{float(one.mean):.4f} ± {float(high - low) / 2:.4f}"
                                                   for one, (low, high) in zip(means, ends))])  # fmt: skip
    table("filter and arm | pose error, sum over the poses | trace(P), last step | unseen", rows)


def attitude() -> None:
    free = {name: (0.001, 10) for name in ("gyro", "accelerometer", "magnetometer")}
    found = credence.tune(filters.attitude, free=free, trials=60, held_out=1000, executor=2)
    table("sigma of | simulated | as documented | tuned | put back, the score rises by",
          ([name, true, found.start[name], one, f"{found.gains[name]:.2g}"]
           for (name, one), true in zip(found.parameters.items(), ("0.01745", "0.01", "0.005"))))  # fmt: skip
    table(" | log score | RMSE [rad] | NEES/n | verdict", sides(found, "all"))


def nile() -> None:
    free = {"level": (1, 1e6), "noise": (1, 1e6)}
    found = credence.tune(filters.nile, free=free, objective="innovations", held_out=0)
    level, noise = (found.parameters[name].value for name in ("level", "noise"))
    rows = [["Durbin and Koopman 2012, 2.10", "1469.1", "15099"], ["credence.tune", f"{level:.1f}", f"{noise:.0f}"]]
    table(" | variance of the level's yearly step | variance of a measurement", rows)


def gallery() -> None:
    program, rows = os.environ.get("GALLERY", "build/worlds/gallery"), []
    worlds = pathlib.Path(__file__).parents[1] / "worlds"
    for world, arm, keys in (
        ("attitude", "local", ("gyro", "walk", "direction")),
        ("coordinated_turn", "ekf", ("acceleration", "rate", "range", "bearing")),
    ):
        found = credence.tune(worlds / f"{world}.ini", free=[f"filter.{key}" for key in keys], arm=arm, program=program)
        values = ", ".join(f"{key} {one}" for key, one in zip(keys, found.parameters.values()))
        for told, row in zip(("all 1", values), sides(found, "all")):
            rows.append([f"{world}, {row[0]}", told, row[1], *row[3:]])
    table("world | factors | log score | NEES/n | verdict", rows)


if __name__ == "__main__":
    for name in sys.argv[1:] or ("tracker", "radar", "document", "attitude", "nile"):
        globals()[name]()
