"""Results files as numpy arrays: what is read is what h5py reads, and what the program reports."""

from __future__ import annotations

import io
import pathlib
import re

import h5py
import numpy as np
import pytest
import studies
from conftest import refused

import credence
from credence.grid import Grid
from credence.pictures.steps import band

COLUMNS = ["trace_P", "unseen", "pose_error", "nees_ratio", "nis_ratio", "mean_trace_P", "log_score", "path_length"]


def near(found, expected):
    """Sums in another order, and quantiles by another method."""
    np.testing.assert_allclose(np.asarray(found, float), np.asarray(expected, float), rtol=1e-9, atol=1e-13)


def report(path):
    return {(part["scenario"], part["arm"]): part for part in studies.printed("report", path)}


def test_columns_and_variables_are_those_of_h5py():
    with credence.open(studies.two_scenarios()) as study, h5py.File(studies.two_scenarios()) as file:
        assert list(study) == ["kf-circle-constant", "ekf-circle-ranged"]
        for arm in study.arms:
            plain = file[arm.group.name]
            assert list(arm.columns) == COLUMNS
            for name in COLUMNS:
                np.testing.assert_array_equal(arm[name], plain[name][:])
                assert arm.describe(name) == tuple(plain[name].attrs[one].decode() for one in ("units", "long_name"))
            np.testing.assert_array_equal(arm.detailed_nees, plain["detailed_nees"][:])
            np.testing.assert_array_equal(arm.nees, plain["nees_total"][:, 0] / 600)
            np.testing.assert_array_equal(arm.nis_rows, plain["nis_rows_total"][:] / 600)
            assert np.isnan(arm.status_pose).all()
            assert arm.status.dtype == np.int8


@pytest.mark.parametrize("make", [studies.two_scenarios, studies.aggregates])
def test_numbers_are_those_of_the_report(make):
    parts = report(make())
    with credence.open(make()) as study:
        for arm in study.arms:
            part = parts[arm.scenario.name, arm.name]
            assert arm.trials == part["trials"]
            assert arm.failed_trials == part["failed_trials"]
            for name in COLUMNS:
                found = arm.mean(name)
                near([found.mean, found.standard_error, *found.interval()],
                     [part[name]["mean"], part[name]["se"], *part[name]["ci95"]])
                assert found.units == part[name]["unit"]
            groups = arm.series_of("nees")
            assert list(groups) == [group["group"] for group in part["groups"]]
            for series, group in zip(groups.values(), part["groups"], strict=True):
                step, run = arm.per_step(series), arm.over_steps(series)
                assert step.dimension == group["dimension"]
                near(step.mean / step.dimension, group["anees"]["ratio"])
                near(step.over(step.dimension).standard_error, group["anees_se"])
                near(np.array([run.mean, run.standard_error, *run.interval()]) / run.dimension,
                     [group["nees_ratio"], group["se"], *group["ci95"]])
                near(band(arm.degrees(series)), np.transpose(group["anees"]["band95"]))
            for series, nis in zip(arm.series_of("nis").values(), part["nis"], strict=True):
                near(arm.degrees(series).sum(), nis["degrees"])
                near(arm[series].sum() * arm.counted_trials / arm.degrees(series).sum(), nis["ratio"])


@pytest.mark.parametrize("make", [studies.one_scenario, studies.aggregates])
def test_a_paired_mean_is_that_of_compare(make):
    (part,) = studies.printed("compare", make(), "--arms=greedy.ekf,fixed.ekf")
    with credence.open(make()) as study:
        for name in ("trace_P", "pose_error"):
            found = study["greedy.ekf"].mean(name, minus=study["fixed.ekf"])
            near([found.mean, found.standard_error], [part[name]["mean"], part[name]["se"]])
            other = study["fixed.ekf"].mean(name, minus=study["greedy.ekf"])
            near([other.mean, other.standard_error], [-found.mean, found.standard_error])


def test_aggregates_say_what_they_do_not_hold():
    with credence.open(studies.aggregates()) as study:
        arm = study["greedy.ekf"]
        assert list(arm.columns) == COLUMNS
        assert "aggregates" in repr(study)
        for ask in (lambda: arm.trace_P, lambda: arm.status):
            refused(r"because the study keeps aggregates\. Take arm\.mean", ask, raises=AttributeError)
        refused(r"has no nothing\. It has trace_P", arm.mean, "nothing", raises=KeyError)
        refused("an arm less itself is 0", arm.mean, "trace_P", minus=arm, raises=ValueError)
        assert arm.ended["completed"] == 600


def test_only_what_is_asked_for_is_read(monkeypatch):
    read = []
    plain = h5py.Dataset.__getitem__

    def counted(variable, selection, *more):
        values = plain(variable, selection, *more)
        read.append((variable.name.rsplit("/", 1)[-1], np.size(values)))
        return values

    monkeypatch.setattr(h5py.Dataset, "__getitem__", counted)
    with credence.open(studies.one_scenario()) as study:
        arm = study["greedy.ekf"]
        assert len(arm.columns) == 8
        assert arm.trials == 600
        assert read == []
        assert arm.read("trace_P", slice(3, 5)).shape == (2,)
        assert read == [("trace_P", 2)]
        assert study["ekf-circle-ranged", "greedy.ekf"].read("detailed_error", (7, slice(None), 0)).shape == (19,)
        assert read[1:] == [("detailed_error", 19)]


def test_failed_trials_are_nan_and_counted(tmp_path):
    def fail(file):
        arm = file["ekf-circle-ranged/greedy.ekf"]
        arm["status"][[1, 4]] = 2, 1
        arm["status_pose"][1] = 6
        arm.attrs.modify("counted_trials", 599)
        for name in COLUMNS:
            arm[name][1] = arm[name].attrs["_FillValue"][0]

    with credence.open(studies.edited(studies.one_scenario(), tmp_path / "failed.h5", fail)) as study:
        arm, other = study["greedy.ekf"], study["fixed.ekf"]
        for name in COLUMNS:
            assert np.flatnonzero(np.isnan(arm[name])).tolist() == [1]
            assert arm.mean(name).count == 599
            assert other.mean(name, minus=arm).count == 599
        assert arm.status_pose[1] == 6
        assert arm.ended == {"completed": 598, "diverged": 1, "covariance_not_positive_definite": 1, "non_finite": 0}
        assert (arm.trials, arm.counted_trials, arm.failed_trials) == (600, 599, 2)
        assert "600 trials, 2 failed" in repr(arm)


@pytest.mark.parametrize(("trials", "shard", "said"), [(600, "1/3", "not complete"), (256, "1/2", "not run yet")])
def test_a_shard_is_not_complete_and_may_be_empty(trials, shard, said):
    words = [f"--trials={trials}", f"--shard={shard}", "--quiet", "-o", "part.h5"]
    studies.program("run", studies.SEED / "ekf-circle-ranged.ini", *words)
    with credence.open("part.h5") as study:
        arm = study["greedy.ekf"]
        assert (study.trials, study.complete) == (trials, False)
        assert arm.trial.tolist() == list(range(256, min(trials, 512)))
        assert np.isnan(arm.nees).all() == np.isnan(arm.per_step("nees").standard_error).all() == (trials == 256)
        assert "not complete" in repr(study)
        assert said in study._repr_html_()


def test_what_cannot_be_read_is_refused():
    pathlib.Path("text.h5").write_text("no HDF5 at all")
    with h5py.File("other.h5", "w") as file:
        file["x"] = 1
    newer = studies.edited(studies.one_scenario(), pathlib.Path("new.h5"),
                           lambda file: file.attrs.modify("schema_version", np.int32(6)))  # fmt: skip
    for said, read, given in (
        ("cannot be read as HDF5", credence.open, "text.h5"),
        ("cannot be found", credence.open, "nothing.h5"),
        (r"Take credence\.open_trajectories", credence.open, studies.trajectory()),
        (r"Take credence\.open\.", credence.open_trajectories, studies.one_scenario()),
        ("format=none", credence.open, "other.h5"),
        (r"schema_version=6 \(this package reads 5\)", credence.open, newer),
    ):
        refused(said, read, given, raises=(ValueError, FileNotFoundError))


def test_names_are_found_or_refused_with_those_that_are_there():
    with credence.open(studies.two_scenarios()) as study:
        assert repr(study["ekf-circle-ranged", "greedy.ekf"]) == repr(study["ekf-circle-ranged"]["greedy.ekf"])
        with pytest.raises(KeyError, match=r"has no scenario greedy\.ekf\. It has kf-circle-constant, ekf-circle"):
            study["greedy.ekf"]
        with pytest.raises(KeyError, match=r"has no arm fixed\.kf\. It has fixed\.ekf, greedy\.ekf"):
            study["ekf-circle-ranged", "fixed.kf"]
        assert study["ekf-circle-ranged"].setting("sensor.noise") == "ranged"
        assert study["kf-circle-constant"].published("trace_P") == {"fixed.kf": 0.1061, "greedy.kf": 0.1063}


def test_a_study_shows_itself_with_twelve_arms():
    with credence.open(studies.twelve_arms()) as study:
        assert len(study.arms) == 12
        assert repr(study).count("60 trials, 0 failed") == 12
        assert study._repr_html_().count("<tr>") == 13
        assert {"trace_P", "nees", "group"} <= set(dir(study.arms[0]))
    assert "closed" in repr(study)


def test_a_study_is_read_from_memory():
    with credence.open(io.BytesIO(studies.one_scenario().read_bytes())) as study:
        assert study["greedy.ekf"].trace_P.size == 600


def test_a_grid_has_the_numbers_of_the_report():
    parts = report(studies.swept())
    with credence.open(studies.swept()) as study:
        (grid,) = study.grids
        assert grid.of == "base"
        assert {key: values.tolist() for key, values in grid.coordinates.items()} == {
            "noise.heading": [0.01, 0.1], "sensor.noise": ["constant", "ranged"]}
        means = grid.values(lambda scenario: scenario["greedy.ekf"].mean("trace_P").mean)
        for place, name in np.ndenumerate(grid.names):
            assert dict(zip(("of", "at"), study[name].sweep, strict=True)) == parts[name, "fixed.ekf"]["sweep"]
            near(means[place], parts[name, "greedy.ekf"]["trace_P"]["mean"])
        names = np.where(grid.names == grid.names[0, 0], "", grid.names)
        holes = Grid(study.scenarios, grid.of, grid.coordinates, names)
        assert np.isnan(holes.values(lambda scenario: 1.0)).tolist() == [[True, False], [False, False]]


def test_xarray_has_the_same_values_and_units():
    xarray = pytest.importorskip("xarray")
    with credence.open(studies.swept()) as study:
        (grid,) = study.grids
        chosen = grid.to_xarray().sel({"noise.heading": 0.1, "sensor.noise": "ranged", "arm": "greedy.ekf"})
        found = study[grid.names[1, 1], "greedy.ekf"].mean("trace_P")
        near([chosen.trace_P, chosen.trace_P_low, chosen.trace_P_high], [found.mean, *found.interval()])
    with credence.open(studies.one_scenario()) as study:
        arm = study["greedy.ekf"]
        dataset = arm.to_xarray()
        np.testing.assert_array_equal(dataset.trace_P, arm.trace_P)
        np.testing.assert_array_equal(dataset.nees_standard_error, arm.per_step("nees").standard_error)
        assert dataset.trace_P.units == "dm^2 + rad^2"
        assert dataset.detailed_error.dims == ("detailed_trial", "step", "component")
        assert dataset.component.values.tolist()[:3] == ["theta", "r_x", "r_y"]
        if not hasattr(xarray, "DataTree"):
            refused(re.escape("Install xarray 2024.10 or later"), study.to_xarray, raises=ImportError)
            return
        np.testing.assert_array_equal(study.to_xarray()["ekf-circle-ranged/greedy.ekf/trace_P"], arm.trace_P)


def test_a_trajectory_has_the_trial_of_its_study():
    (trial,) = credence.open_trajectories(studies.trajectory())
    with credence.open(studies.two_scenarios()) as study:
        arm = study["ekf-circle-ranged", "greedy.ekf"]
        for name in COLUMNS:
            assert trial.columns[name] == arm[name][17]
        np.testing.assert_array_equal(trial.errors[1:].astype(np.float32), arm.read("detailed_error", 17))
        np.testing.assert_allclose(trial.nees[1:], arm.read("detailed_nees", 17), rtol=1e-6)
    assert (trial.trial, trial.name, trial.status) == (17, "greedy.ekf", "completed")
    robot, features = trial.positions("truth")
    assert (robot.shape, features.shape) == ((20, 2), (20, 3, 2))
    squared = np.sum((trial.positions("mean")[0] - robot) ** 2) + np.sum(trial.errors[:, 0] ** 2)
    near(squared, trial.columns["pose_error"])
