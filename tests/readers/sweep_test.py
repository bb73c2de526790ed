"""The grids of analysis/ against the program's own JSON, and their pictures looked through.

    sweep_test.py CREDENCE SWEPT.h5 FOLDER      a study over noise.heading=0.01,0.1 and sensor.noise=constant,ranged
"""
import json
import subprocess
import sys

import numpy as np

import analysis_test
from analysis_test import near, results, style

import plot  # noqa: E402
from pictures import sweep  # noqa: E402


def check_grid(file, report):
    (grid,) = results.grids(file)
    assert grid.of == "base" and list(grid.coordinates) == ["noise.heading", "sensor.noise"], grid
    near(grid.coordinates["noise.heading"], [0.01, 0.1])
    assert grid.coordinates["sensor.noise"].tolist() == ["constant", "ranged"]
    assert grid.names.shape == (2, 2) and grid.names[1, 0] == "base_heading-0p1_noise-constant"
    parts = {(part["scenario"], part["arm"]): part for part in report}
    for name in grid.names.flat:
        of, at = results.place(file[name])
        assert {"of": of, "at": at} == parts[name, "fixed.ekf"]["sweep"]
    means = results.over_grid(file, grid, lambda group: results.mean_with_interval(group["greedy.ekf"], "trace_P"))
    assert means.shape == (2, 2, 3)
    for place, name in np.ndenumerate(grid.names):
        expected = parts[name, "greedy.ekf"]["trace_P"]
        near(means[place], [expected["mean"], *expected["ci95"]])
    return grid, means


def check_dataset(file, grid, means):
    try:
        import xarray  # noqa: F401
    except ImportError:
        print("SKIPPED: python3-xarray is not installed")
        return
    dataset = results.as_dataset(file, grid)
    assert dict(dataset.sizes) == {"noise.heading": 2, "sensor.noise": 2, "arm": 2}, dataset
    chosen = dataset.sel({"noise.heading": 0.1, "sensor.noise": "ranged", "arm": "greedy.ekf"})
    near([chosen.trace_P.item(), chosen.trace_P_low.item(), chosen.trace_P_high.item()], means[1, 1])


def main(credence, path, folder):
    report = json.loads(subprocess.run([credence, "report", path, "--format", "json"], capture_output=True, check=True).stdout)
    with results.open_file(path) as file:
        check_dataset(file, *check_grid(file, report))
        grid = results.grids(file)[0]
        holes = results.Grid(grid.of, grid.coordinates, np.where(grid.names == grid.names[0, 0], "", grid.names))
        assert np.isnan(results.over_grid(file, holes, lambda group: 1.0)).sum() == 1
        analysis_test.PANELS["sweep"] = (3, 1)
        analysis_test.look_through(sweep.curves(file, grid, style.COLUMN), "column-sweep", style.COLUMN)
        analysis_test.PANELS["sweep"] = (6, 2)
        analysis_test.look_through(sweep.curves(file, holes), "holes-sweep")
    style.save = analysis_test.look_through_and_save
    assert plot.main([path, "-o", folder]) == 0
    assert set(analysis_test.seen) == {"base-heading-noise-sweep"}, analysis_test.seen


if __name__ == "__main__":
    main(*sys.argv[1:])
