"""What `simulate` gives, and records in files, are taken where a study is: by `report`, `compare`, `open`, `plot`,
pictures, and the numbers of an arm."""

from __future__ import annotations

import pathlib

import h5py
import numpy as np
import pytest
import records
from conftest import refusal, refused

import credence
from credence.pictures.__main__ import main
from credence.pictures.drawing import OF_SCENARIO

ARMS = {"planned": {"sigma": 0.8}, "fixed": {"sigma": 1.0}}
STEPS, N = 6, 2


def path(rng, sigma):
    """A filter on a path that is better or worse; what it does not see is a column of its own."""
    covariance = np.broadcast_to(sigma**2 * np.eye(N), (STEPS, N, N)) * rng.uniform(0.9, 1.1)
    error = np.einsum("kij,kj->ki", np.linalg.cholesky(covariance), rng.standard_normal((STEPS, N)))
    columns = {"rmse": float(np.sqrt(np.mean(error**2))), "unseen": float(rng.integers(4)) + 2 * (sigma == 1)}
    return credence.Run(error, covariance, columns=columns)


@pytest.fixture(scope="module")
def simulated(tmp_path_factory):
    folder = tmp_path_factory.mktemp("simulated")
    return credence.simulate(path, trials=300, arms=ARMS, output=folder / "slam.h5")


def test_columns_are_in_report_page_json_and_compare(simulated):
    report = credence.report(simulated)
    for said in (str(report), str(simulated), report.html):
        assert "rmse" in said
        assert "unseen" in said
    for part, (name, arm) in zip(report.json, simulated.columns.items()):
        assert (part["scenario"], part["arm"]) == ("slam", name)
        for column in ("rmse", "unseen"):
            assert part[column]["mean"] == pytest.approx(arm[column].mean(), rel=1e-12)
    difference = credence.compare(simulated, arms=("planned", "fixed"))
    (pair,) = difference.json
    for column in ("rmse", "unseen"):
        values = simulated.columns["planned"][column] - simulated.columns["fixed"][column]
        assert pair[column]["mean"] == pytest.approx(values.mean(), rel=1e-12)
    assert (pair["a"], pair["b"]) == ("planned", "fixed")
    assert set(pair["lower"]) >= {"log_score", "trace_P", "pose_error", "unseen", "rmse", "mean_trace_P"}
    assert pair["higher"] == []
    conclusion = " ".join(str(difference).split())
    assert "log score (lower is better): planned is lower than fixed" in conclusion
    for column in ("trace_P", "unseen", "pose_error", "rmse"):
        assert f"{column} lower by {-pair[column]['mean']:.2f}"[:-1] in conclusion
    assert ":record" not in str(difference)
    assert "slam/planned " in str(report)


def test_columns_that_do_not_differ_are_not_concluded_on(simulated):
    def same(rng, sigma):
        run = path(rng, 1.0)
        return credence.Run(run.arrays["error"], run.arrays["covariance"] * sigma, columns={"lucky": rng.random()})

    (pair,) = credence.compare(credence.simulate(same, trials=60, arms=ARMS)).json
    assert pair["lucky"]["mean"] == 0
    assert "lucky" not in pair["lower"] + pair["higher"]
    assert "pose_error" not in pair["lower"] + pair["higher"]
    assert "trace_P" in pair["higher"]


def file_of(arm):
    """Its path is FILE:ARM."""
    return pathlib.Path(arm.path.rpartition(":")[0])


def test_seeds_and_trials_that_differ_are_no_pairs(simulated, program, tmp_path):
    other = credence.simulate(path, trials=300, seed=2, arms=ARMS, output=tmp_path / "other.h5")
    files = [simulation.arm("fixed").path for simulation in (simulated, other)]
    said = "/@seed: is 2, and that of the first record 1: trials of different seeds are no pairs"
    refused(said, credence.compare, *files)
    refused(said, credence.compare, simulated["fixed"], other["fixed"])
    refused("/@seed: is ", credence.compare, simulated, other, arms=("fixed", "planned"))
    code, _, err = program("compare", *files)
    assert (code, "/@seed: is 2" in err) == (2, True)
    huge = [credence.simulate(path, trials=20, seed=2**64 - i, arms=ARMS) for i in (1, 2)]
    assert f"/@seed: is {2**64 - 2}" in refusal(credence.compare, huge[0]["fixed"], huge[1]["fixed"])
    moved = tmp_path / "moved.h5"
    moved.write_bytes(file_of(simulated["fixed"]).read_bytes())
    with h5py.File(moved, "r+") as file:
        file["fixed/trial"][17] = 1000
    assert "/trial: differs from that of the first record in entry 17" in refusal(
        lambda: credence.compare(files[0], f"{moved}:fixed"))
    fewer = credence.simulate(path, trials=200, arms=ARMS)
    assert "these are other runs" in refusal(credence.compare, simulated["fixed"], fewer["fixed"])


def test_simulations_of_one_seed_are_compared_arm_by_arm(simulated):
    again = credence.simulate(lambda rng: path(rng, 0.9), trials=300)
    assert "Give arms=(A, B)" in refusal(credence.compare, simulated, simulated)
    assert str(credence.compare(simulated, again, arms=("fixed", "run"))).startswith("fixed - run, ")
    assert str(credence.compare(simulated["fixed"], again["run"])).startswith("run - fixed, ")
    assert str(credence.compare(simulated.study)) == str(credence.compare(simulated))
    refused("no arm fast. There is planned,", credence.compare, simulated, arms=("fast", "fixed"), raises=KeyError)


def test_an_arm_has_columns_series_and_means_as_that_of_a_study(simulated):
    study = credence.open(simulated)
    assert (study.trials, study.seed, [arm.name for arm in study.arms]) == (300, 1, ["planned", "fixed"])
    for name in ARMS:
        arm, plain = simulated[name], study["slam", name]
        error, covariance = arm.read("error"), arm.read("covariance")
        trace = np.trace(covariance, axis1=2, axis2=3)
        found = arm.per_step("trace_P")
        assert found.mean == pytest.approx(trace.mean(axis=0), rel=1e-12)
        assert found.standard_error == pytest.approx(trace.std(axis=0, ddof=1) / 300**0.5, rel=1e-6)
        assert plain.per_step("squared_error").mean == pytest.approx((error**2).sum(axis=2).mean(axis=0), rel=1e-12)
        assert arm["trace_P"].tolist() == pytest.approx(trace[:, -1].tolist(), rel=1e-12)
        assert plain.rmse.tolist() == simulated.columns[name]["rmse"].tolist()
        assert plain.describe("rmse") == ("1", "rmse")
    difference = simulated["planned"].mean("unseen", minus=simulated["fixed"])
    assert float(difference.mean) == pytest.approx(-2)
    with pytest.raises(AttributeError):
        simulated["planned"].nothing  # noqa: B018


@pytest.mark.parametrize("form", sorted(records.corpus()))
def test_every_form_of_record_is_opened(form, tmp_path):
    from credence._judge_command import write_record

    record = records.corpus()[form]
    write_record(str(tmp_path / "one.h5"), record)
    arm = credence.open(tmp_path / "one.h5").arms[0]
    verdict = credence.judge(**record, segments="off")
    assert arm.mean("nees_ratio").mean == pytest.approx(verdict["nees_ratio"]["mean"] or np.nan, nan_ok=True)
    for role, name in (("squared_error", "rmse_by_step"), ("variance", "predicted_by_step")):
        if series := arm.series_of(role).get("all"):
            expected = np.array(verdict["groups"][0]["accuracy"][name], dtype=float)
            assert np.sqrt(arm.per_step(series).mean) == pytest.approx(expected, rel=1e-12, nan_ok=True)
    credence.plot(tmp_path / "one.h5")


def test_report_says_what_judge_says(simulated, tmp_path):
    assert str(credence.report(simulated["fixed"])) == str(credence.report(simulated["fixed"].path))
    assert credence.report(simulated.study).json == credence.report(simulated).json
    assert credence.report(simulated["fixed"]).json == simulated["fixed"].verdict.json
    assert [arm.name for arm in credence.open(simulated["fixed"]).arms] == ["fixed"]  # an arm is a result, too
    assert credence.plot(simulated["fixed"], "nees").axes
    assert credence.report(simulated, margin=0.5).json[0]["margin"] == 0.5
    damaged = tmp_path / "damaged.h5"
    damaged.write_bytes(file_of(simulated["fixed"]).read_bytes()[:700])
    assert "damaged.h5" in refusal(credence.open, damaged, raises=ValueError)
    assert "resume=True" in refusal(credence.resume, simulated.study)


def test_a_report_has_trace_and_error_by_step_of_all_arms(simulated):
    lines = str(credence.report(simulated)).splitlines()
    at = lines.index(next(line for line in lines if line.startswith("by step")))
    assert lines[at].split()[2:] == ["1", "2", "4", "5", "6"]
    for row, name, values in ((2, "planned", "covariance"), (3, "fixed", "covariance"), (5, "planned", "error")):
        assert lines[at + row].split()[0] == name
        given = simulated[name].read(values)
        by_step = np.trace(given, axis1=2, axis2=3) if values == "covariance" else (given**2).sum(axis=2)
        shown = lines[at + row].split()[1]
        assert float(shown) == pytest.approx(by_step[:, 0].mean(), abs=1.01 * 10.0 ** -len(shown.split(".")[1]))


@pytest.mark.parametrize("kind", [kind for kind in OF_SCENARIO if kind not in ("nis", "place")])
def test_every_picture_is_drawn_of_a_simulation(simulated, kind):
    picture = credence.plot(simulated, kind)
    assert {name for entry in picture.axes[0].get_legend().get_texts() for name in ARMS if name in entry.get_text()} \
        == set(ARMS) if kind not in ("map",) else picture.axes


def test_the_command_draws_columns_of_ones_own(simulated, tmp_path, capsys):
    assert main([simulated["fixed"].path, "-o", str(tmp_path), "--vector", "svg"]) == 0
    drawn = {one.stem for one in tmp_path.iterdir()}
    assert {f"slam-distribution-{name}" for name in ("rmse", "unseen", "trace_P", "pose_error")} <= drawn
    assert "slam-trace_P" in drawn
    title = credence.plot(simulated, "paired", column="rmse").get_suptitle()
    assert "rmse: fixed than planned" in title
    assert "cannot run a trial of records again" in refusal(credence.animate, simulated, raises=ValueError)
    assert "invalid kind=place" in refusal(credence.plot, simulated, "place", raises=ValueError)


def test_judge_takes_columns_and_gives_them_again(simulated):
    record = simulated["fixed"].record()
    verdict = credence.judge(**record)
    assert verdict["rmse"]["mean"] == pytest.approx(record["columns"]["rmse"].mean(), rel=1e-12)
    masked = np.ma.masked_array(np.arange(300.0), mask=np.arange(300) == 7)
    odd = credence.judge(**record | {"columns": {"odd": masked, "verdict": np.arange(300)}})
    assert odd["odd"]["n"] == 299
    assert odd.verdict == verdict.verdict
    assert odd["column verdict"]["mean"] == 149.5
    assert "column/short: does not fit: it is [7]" in refusal(
        lambda: credence.judge(**record | {"columns": {"short": np.arange(7)}}))
    assert "trial 0 of run: column/trace_P: is no name" in refusal(
        lambda: credence.simulate(lambda rng: credence.Run(np.ones((2, 1)), np.ones((2, 1)), columns={"trace_P": 1}),
                                  trials=3))
