"""`judge` on arrays says what the program says of the same record in a file."""

from __future__ import annotations

import html
import inspect
import json
import math
import pathlib
import re

import h5py
import numpy as np
import pytest
import records
from conftest import python, refusal, refused
from scipy import stats

import credence

CORPUS = records.corpus()
REFERENCE = sorted((pathlib.Path(__file__).parents[2] / "tests" / "reference").glob("record_*.h5"))


@pytest.mark.parametrize("name", CORPUS)
def test_arrays_give_the_bits_of_the_program(name, tmp_path, program):
    path = records.write(tmp_path / f"{name}.h5", CORPUS[name])
    code, printed, said = program("judge", path, "--format", "json", "--quiet")
    assert (code, said) == (0, "")
    verdict = credence.judge(**CORPUS[name], name=str(path))
    assert verdict.json == json.loads(printed)
    said = str(verdict).partition("hint: what to change in it: credence.tune(")
    assert (said[0], bool(said[1])) == (program("judge", path, "--quiet")[1], verdict.is_of_the_filter)


@pytest.mark.parametrize("path", REFERENCE, ids=lambda path: path.stem)
def test_files_give_the_bits_of_the_program(path, program):
    _, printed, _ = program("judge", path, "--format", "json", "--quiet")
    assert credence.judge(path).json == json.loads(printed)


def test_margins_and_the_page_are_those_of_the_program(tmp_path, program):
    path = records.write(tmp_path / "joint.h5", CORPUS["joint"])
    options = {"margin": "40%", "margin_direction": 0.9, "bias": 0.7, "failed": 0.5}
    words = ["judge", path, "--quiet", *(f"--{name.replace('_', '-')}={value}" for name, value in options.items())]
    verdict = credence.judge(**CORPUS["joint"], **options, name=str(path))
    assert verdict.json == json.loads(program(*words, "--format=json")[1])
    assert verdict.html == program(*words, "--format=html")[1]
    assert [verdict[name] for name in ("margin", "failed_limit")] == [0.4, 0.5]
    assert html.escape(verdict.html) in verdict._repr_html_()


@pytest.mark.parametrize("segments", ["auto", "off", 25])
def test_a_log_is_counted_in_segments_as_the_program_does(segments, tmp_path, program):
    errors = np.random.default_rng(1).normal(size=(2000, 2))
    log = {"error": errors, "covariance": np.broadcast_to(0.5 * np.eye(2), (2000, 2, 2))}
    path = records.write(tmp_path / "log.h5", log)
    printed = program("judge", path, f"--segments={segments}", "--format", "json", "--quiet")[1]
    verdict = credence.judge(**log, segments=segments, name=str(path))
    assert verdict.json == json.loads(printed)
    assert verdict["evidence"] == ("trials" if segments == "off" else "segments")
    if segments == "off":
        assert "segments" not in verdict.json[0]
    else:
        steps = verdict["segments"]["steps"]
        assert segments in ("auto", steps)
        assert verdict["segments"]["count"] == 2000 // steps
        assert (verdict["segments"]["autocorrelation_time"] is None) == (segments == 25)
        assert verdict.verdict == "optimistic"
    assert "one log of 2000 steps" in str(verdict)


def test_numbers_at_an_odd_address_are_copied():
    odd = np.frombuffer(bytes(8 * 6 + 1), offset=1).reshape(2, 3)
    assert not odd.flags.aligned
    assert credence._arrays.described(odd)[0].flags.aligned


def test_no_copy_of_the_arrays_is_made():
    """360 MB of covariances that share one matrix in memory: a copy would show in the largest size of the process."""
    script = """
        import resource
        import numpy as np
        import credence
        error = np.random.default_rng(0).normal(size=(2000, 100, 15))
        covariance = np.broadcast_to(np.eye(15), (2000, 100, 15, 15))
        credence.judge(error[:100], covariance[:100])
        before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        credence.judge(error, covariance)
        print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before)
    """
    assert int(python("-c", script).stdout) < 150_000  # kB; what is kept of NEES and errors takes up to 100 MB


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"covariance": np.zeros((3, 2, 2, 3))}, "covariance: does not fit: it is [3, 2, 2, 3] and error [3, 2, 2]."),
        ({"covariance": np.tile([[1, 0.5], [0, 1]], (3, 2, 1, 1))}, "covariance: trial 0, step 0 (both counted"),
        ({"groups": {"pose": [0, 2]}}, "groups: `pose 0 2` goes beyond the 2 components"),
        ({"margin": 2}, "invalid margin=2 (must be between 0 and 100 %"),
        ({"margin_direction": 0.01}, "invalid margin_direction=0.01 (less than the margin"),
        ({"segments": 1.5}, "invalid segments=1.5 (must be a whole number of steps from 2 on, auto or off). Write 50."),
        ({"innovation": np.ones((3, 2, 1))}, "innovation_covariance: is missing, but"),
        ({"covariance": None}, "covariance: is missing."),
    ],
)
def test_what_does_not_fit_is_refused(arguments, message):
    assert issubclass(credence.InputError, ValueError)
    given = {"covariance": np.ones((3, 2, 2, 2)), **arguments}
    assert refusal(credence.judge, np.zeros((3, 2, 2)), **given).startswith(message)


def test_a_record_is_judged_as_its_fields_are():
    record = credence.Record(**CORPUS["groups"])
    assert credence.judge(record, margin=0.2).json == credence.judge(**CORPUS["groups"], margin=0.2).json
    assert repr(record) == "<credence.Record of error, covariance, groups>"
    refused("Give it alone", credence.judge, record, groups="pose 0", raises=TypeError)
    fields = inspect.signature(credence.Record).parameters
    for taken in (credence.judge, credence.Run):
        assert fields.items() <= dict(inspect.signature(taken).parameters).items()
        assert inspect.signature(taken).parameters.keys() - fields.keys() <= {
            "runs", "margin", "margin_direction", "bias", "failed", "segments", "name", "progress"}
    said = credence.judge.__doc__
    assert [name for name in inspect.signature(credence.judge).parameters if not re.search(rf"\b{name}\b", said)] == []
    assert "array [trial, step, n]" in said
    refused(r"^judge\(\) got an unexpected keyword.*'marign'", credence.judge, record, marign=0.2, raises=TypeError)


def test_a_path_stands_alone():
    refused("Give it alone", credence.judge, "record.h5", np.zeros((1, 1, 1)), raises=TypeError)


def test_assert_consistent_says_why():
    rng = np.random.default_rng(3)
    consistent = {"error": rng.normal(size=(4000, 3, 2)), "covariance": np.broadcast_to(np.eye(2), (4000, 3, 2, 2))}
    credence.assert_consistent(**consistent, groups={"pose": [0]})
    optimistic = {**consistent, "covariance": consistent["covariance"] / 2}
    with pytest.raises(AssertionError, match=re.escape(str(credence.judge(**optimistic)))):
        credence.assert_consistent(**optimistic)
    assert credence.judge(**optimistic).verdict == "optimistic"


def test_assert_consistent_asks_for_a_proof_within_a_margin():
    errors, covariances = np.random.default_rng(4).normal(size=(50, 5, 2)), np.broadcast_to(np.eye(2), (50, 5, 2, 2))
    assert credence.judge(errors, covariances).verdict == "undecided"
    credence.assert_consistent(errors, covariances)
    with pytest.raises(AssertionError, match="not shown to be consistent within 10%\n\n"):
        credence.assert_consistent(errors, covariances, within="10%")
    many = np.random.default_rng(4).normal(size=(4000, 3, 2))
    credence.assert_consistent(many, np.broadcast_to(np.eye(2), (4000, 3, 2, 2)), within=0.1)


def test_an_error_in_progress_ends_the_call():
    class Stop(Exception):
        pass

    def stop(done, total):
        raise Stop

    from credence import _arrays, _core

    arrays = {"error": np.zeros((3, 2, 2)), "covariance": np.ones((3, 2, 2))}
    given = {name: _arrays.described(array) for name, array in arrays.items()}
    with pytest.raises(Stop):
        _core.judge(given, {}, {}, {}, {}, b"record", stop)


def test_planar_poses_in_space_are_judged_in_the_plane():
    rng = np.random.default_rng(3)
    plane = [0, 1, 5]
    error, covariance = np.zeros((200, 4, 6)), np.zeros((200, 4, 6, 6))
    error[..., plane] = rng.normal(size=(200, 4, 3))
    covariance[..., plane, plane] = 1
    names = ["x", "y", "z", "roll", "pitch", "yaw"]
    flat = credence.judge(error[..., plane], covariance[..., plane, :][..., plane], component_names=["x", "y", "yaw"])
    space = credence.judge(error, covariance, component_names=names, groups={"tilt": [3, 4]})
    assert space["not_judged"] == [
        "Not in the state, because their errors and variances are 0 at every step: z, roll, pitch.",
        "Groups of nothing else are left out: tilt.",
    ]
    assert {**space.json[0], "not_judged": None} == {**flat.json[0], "not_judged": None}


def test_reached_is_the_smallest_margin_that_is_accepted():
    errors = np.random.default_rng(4).normal(size=(900, 20, 2))
    covariances = np.broadcast_to(np.eye(2), (900, 20, 2, 2))
    reached = credence.judge(errors, covariances).reached

    def verdict(scale):
        margins = (scale * reached[name] for name in ("nees", "direction", "bias"))
        margin, direction, bias = margins
        return credence.judge(errors, covariances, margin=margin, margin_direction=direction, bias=bias).verdict

    assert verdict(1.0001) == "consistent"
    assert verdict(0.9999) == "undecided"
    few = credence.judge(errors[:19, :5], covariances[:19, :5])
    assert few.reached["direction"] is None
    assert 0 < few.reached["nees"] < 0.4
    assert f"NEES/dim within {math.ceil(100 * few.reached['nees'])} % of 1" in str(few)


def test_the_log_score_is_that_of_scipy():
    rng = np.random.default_rng(5)
    factor = np.array([[1, 0, 0], [0.5, 0.8, 0], [0.1, -0.3, 2]])
    errors, covariance = rng.normal(size=(40, 6, 3)) @ factor.T, factor @ factor.T * 1.3
    score = credence.judge(errors, np.broadcast_to(covariance, (40, 6, 3, 3))).log_score
    expected = -stats.multivariate_normal.logpdf(errors, cov=covariance).mean(axis=1)
    assert score["mean"] == pytest.approx(expected.mean(), rel=1e-12)
    assert score["sd"] == pytest.approx(expected.std(ddof=1), rel=1e-9)


def test_a_fault_of_every_third_trial_is_found_in_any_order():
    rng = np.random.default_rng(6)
    for _ in range(5):
        errors = rng.normal(size=(600, 10, 2))
        errors[::3, :, 1] = 0.8 * errors[::3, :, 0] + 0.6 * errors[::3, :, 1]
        verdicts = [
            credence.judge(one, np.broadcast_to(np.eye(2), (600, 10, 2, 2)))
            for one in (errors, errors[rng.permutation(600)], errors[rng.permutation(600)][:, :, ::-1])
        ]
        assert {one.verdict for one in verdicts} == {"mixed"}
        assert len({tuple(finding.about for finding in one.findings) for one in verdicts}) == 1


def test_strict_makes_notes_fail():
    rng = np.random.default_rng(7)
    n = 400
    errors, covariance = rng.normal(size=(n, 30, 1)), np.ones((n, 30, 1, 1))
    white = rng.normal(size=(n, 30, 1))
    correlated = white + 0.5 * np.roll(white, 1, axis=1)
    given = {"innovation": correlated, "innovation_covariance": np.full((n, 30, 1, 1), 1.25)}
    assert credence.assert_consistent(errors, covariance, **given).verdict == "consistent"
    with pytest.raises(AssertionError, match="has notes"):
        credence.assert_consistent(errors, covariance, strict=True, **given)


def test_records_of_other_runs_are_not_compared(tmp_path):
    rng = np.random.default_rng(8)
    truth = rng.normal(size=(60, 30, 2))

    def record(name, truth, time):
        path = tmp_path / name
        with h5py.File(path, "w") as file:
            file["truth"], file["estimate"], file["time"] = truth, truth + rng.normal(size=truth.shape), time
            file["covariance"] = np.broadcast_to(np.eye(2), (*truth.shape, 2))
            file.attrs.update(manifold="R2", chart="local")
        return path

    time = np.arange(30.0)
    first, same = record("first.h5", truth, time), record("same.h5", truth, time)
    assert "log score" in str(credence.compare(first, same))
    moved = truth.copy()
    moved[17, 3, 1] += 1e-9
    for other, said in (
        (record("moved.h5", moved, time), "/truth: differs from that of the first record in entry 17"),
        (record("later.h5", truth, time + 0.5), "/time: differs from that of the first record in entry 0"),
        (record("short.h5", truth[:, :20], time[:20]), r"/estimate: is \[60, 20, 2\], not \[60, 30, 2\]"),
    ):
        refused(said, credence.compare, first, other)


def test_records_are_compared_in_one_state_at_the_steps_that_all_have(tmp_path, program):
    rng = np.random.default_rng(12)
    errors, ones = rng.normal(size=(60, 30, 2)), np.broadcast_to(np.eye(2), (60, 30, 2, 2))

    def record(name, error, covariance=ones, columns=None, **attributes):
        path = tmp_path / name
        with h5py.File(path, "w") as file:
            file["error"], file["covariance"] = error, np.where(np.isnan(error)[..., None], np.nan, covariance)
            file.attrs.update(attributes)
            if columns:
                file["column/range"] = np.ones(60)
                file["column/range"].attrs["units"] = columns
        return path

    known = errors * [1, 0], ones * [[1, 0], [0, 0]]
    first = record("first.h5", errors, columns="m", component_names="x, y", component_units="m, m")
    for name, given, said in (
        ("swapped.h5", {"component_names": "y, x"}, "/@component_names: is y, x, and that of the first record x, y"),
        ("km.h5", {"component_units": "km, km"}, "/@component_units: is km, km, and that of the first record m, m"),
        ("column.h5", {"columns": "km"}, "range is in km in .*column.h5 and in m in "),
    ):
        other = record(name, errors, **given)
        refused(said, credence.compare, first, other)
        assert program("compare", first, other)[0] == 2
    plain = record("plain.h5", errors)
    refused("another number of components that are not known exactly: 1, and the first record 2", credence.compare,
            plain, record("known.h5", *known))
    assert "equal in every trial" in str(credence.compare(plain, record("named.h5", errors, component_names="x, y")))

    # What skips the steps at which it is worst does not win: it has the errors of the other at those that it has.
    hard = rng.random((60, 30)) < 0.1
    hard[:, -1] = False
    worse = np.where(hard[..., None], 5 * errors, errors)
    skips = record("skips.h5", np.where(hard[..., None], np.nan, errors))
    comparison = credence.compare(record("worse.h5", worse), skips)
    (pair,) = comparison.json
    assert pair["conclusion"] == "equal"
    assert pair["steps"] == {"any": 1800, "compared": 1800 - hard.sum()}
    assert (pair["of_a"]["steps"], pair["of_b"]["steps"]) == (1800 - hard.sum(), 1800)
    share = f"{hard.mean():.0%}".replace("%", " %")
    assert f"skips:record has no result at {share} of the steps: A - B is of the " in " ".join(str(comparison).split())
    assert "has no result at" in comparison.html
    # Runs without a step that both have are no pairs.
    halves = np.where(np.arange(60)[:, None, None] < 2, np.nan, errors)
    halves[:2, -1] = errors[:2, -1]
    others = errors.copy()
    others[:2, 15:], others[:2, 14:15] = np.nan, errors[:2, 14:15]
    (pair,) = credence.compare(record("some.h5", halves), record("others.h5", others, steps=15)).json
    assert (pair["trials"], pair["pairs"]) == (60, 58)


def test_what_cancels_over_all_steps_is_found_in_its_windows():
    rng = np.random.default_rng(9)
    errors, covariance = rng.normal(size=(2000, 50, 1)), np.ones((2000, 50, 1, 1))
    assert credence.judge(errors, covariance).verdict == "consistent"
    halves = np.where(np.arange(50) < 25, 0.5, -0.5)[:, None]
    moved = (errors + halves) / np.sqrt(1.25)  # of mean square 1 at every step
    found = credence.judge(moved, covariance)
    assert [one.about for one in found.findings] == ["window"]
    early = errors * np.where(np.arange(50) < 25, 0.83, 1.145)[:, None]
    assert credence.judge(early, covariance, margin=0.1).verdict != "consistent"


def test_p_that_is_wrong_where_it_is_large_and_where_it_is_small_is_found():
    rng = np.random.default_rng(4)
    scale = np.exp(rng.normal(size=(3000, 1, 1)) / 2)  # of a trial's sigmas, as it says
    errors, covariance = scale * rng.normal(size=(3000, 10, 2)), np.eye(2) * (scale**2)[..., None]
    covariance = np.broadcast_to(covariance, (3000, 10, 2, 2))
    right = credence.judge(errors, covariance)
    assert right.verdict == "consistent"
    wrong = errors * np.where(scale < 1, 1.15, 0.816)  # NEES/n 1.32 where P is small, 0.67 where it is large
    found = credence.judge(wrong, covariance)
    calibration = [one for one in found.findings if one.about == "calibration"]
    assert {one.when for one in calibration} >= {
        "the quintile of the trials with the smallest P",
        "the quintile of the trials with the largest P",
    }
    assert [one.what for one in calibration] == ["optimistic", "optimistic", "pessimistic", "pessimistic"]


def test_innovations_alone_are_judged_for_their_covariance():
    rng = np.random.default_rng(5)
    nu, S = rng.normal(size=(400, 20, 2)), np.broadcast_to(np.eye(2), (400, 20, 2, 2))
    right = credence.judge(innovation=nu, innovation_covariance=S, row_groups="gps 0, baro 1")
    assert right.verdict == "consistent"
    assert "the verdict is on the innovations and their S" in str(right)
    assert {group["group"] for group in right["groups"]} == {"all", "gps", "baro"}
    same = credence.judge(nu, S)
    assert right["groups"][0]["nees_ratio"] == same["groups"][0]["nees_ratio"]
    assert right["nis"] != []
    shifted = credence.judge(innovation=nu + np.array([0.5, 0]), innovation_covariance=S)
    assert [one.where for one in shifted.findings if one.about == "bias"] == ["row_0"]
    missed = nu.copy()
    missed[:, 5:8] = np.nan  # nothing is measured at three steps
    assert credence.judge(innovation=missed, innovation_covariance=S).verdict == "consistent"


def test_the_exact_hypothesis_has_students_p():
    rng = np.random.default_rng(6)
    errors = 1.02 * rng.normal(size=(500, 4, 1))
    verdict = credence.judge(errors, np.ones((500, 4, 1, 1)))
    assert verdict["p_exact"] == pytest.approx(stats.ttest_1samp((errors**2).mean((1, 2)), 1).pvalue, rel=1e-9)


def test_copies_of_runs_are_no_runs_of_their_own(tmp_path, program):
    record = {name: array[:30] for name, array in records.joint(np.random.default_rng(11)).items()}
    twice = {name: np.concatenate([array, array[[4, 7]]]) for name, array in record.items()}
    path = records.write(tmp_path / "twice.h5", twice)
    verdict, expected = credence.judge(**twice, name=str(path), failed=0.1), credence.judge(**record)
    assert verdict.json == json.loads(program("judge", path, "--failed=10%", "--format=json", "--quiet")[1])
    assert (verdict["trials"], verdict["failed_trials"]) == (32, 2)
    assert verdict["groups"][0]["nees_ratio"] == expected["groups"][0]["nees_ratio"]
    assert credence.judge(**twice).verdict == "failed"  # two of 32 are more than 1 %
    code, said, _ = program("judge", path, "--quiet", "--require=no-finding")
    assert (code, said.count("it is a copy")) == (1, 2)
    assert "trial 31, step 1 ([31, 0] in the file): its errors are those of trial 7, to the last bit" in said
    assert "Only 30 of the 32 runs are distinct: 2 have the errors of another one, to the last bit" in said
    assert "with status" not in said


def test_runs_that_agree_by_chance_are_no_copies():
    rng = np.random.default_rng(12)
    for shape in ((400, 1, 1), (400, 1, 2), (400, 2, 1), (400, 3, 1)):
        errors = np.rint(rng.normal(size=shape))
        assert len(np.unique(errors.reshape(400, -1), axis=0)) < 400
        assert credence.judge(errors, np.ones(shape))["failed_trials"] == 0
    errors = rng.normal(size=(400, 5, 2))
    errors[:, 0] = 0.3  # a start that is always the same, and components without an error
    errors[..., 1] = 0
    time, variances = np.tile(np.arange(5.0), (400, 1)), np.ones((400, 5, 2))
    assert credence.judge(errors, variances, time=time)["failed_trials"] == 0
    errors[200:] = errors[:200]
    assert credence.judge(errors, variances)["failed_trials"] == 200
    nees = rng.chisquare(2, (200, 4))
    assert credence.judge(nees=np.concatenate([nees, nees]), dimension=2)["failed_trials"] == 200


def test_a_mean_error_is_told_from_the_spread_about_it():
    """The mean of each step by generalised least squares, in plain NumPy."""
    random = np.random.default_rng(5)
    trials, steps, n = 600, 8, 3
    size = random.uniform(0.3, 3, (trials, steps, 1))
    mix = random.normal(size=(n, n)) + 2 * np.eye(n)
    error = (random.normal(size=(trials, steps, n)) * np.sqrt(size) + [1.0, 0.5, 0.0]) @ mix.T
    covariance = size[..., None] * (mix @ mix.T)
    error[3, 5:] = np.nan
    covariance[3, 5:] = np.nan
    inverse = np.linalg.inv(covariance)
    weighted = np.einsum("tkij,tkj->tki", inverse, error)
    there = (~np.isnan(error[..., 0])).sum(0)
    mean = np.linalg.solve(np.nansum(inverse, 0), np.nansum(weighted, 0)[..., None])[..., 0]
    about = error - mean
    nees = np.einsum("tki,tkij,tkj->tk", about, inverse, about) * (there / (there - 1)) / n
    square = np.nansum(np.einsum("tki,tki->tk", weighted, error), 0)
    common = np.einsum("ki,ki->k", np.nansum(weighted, 0), np.nansum(error, 0)) - square
    found = credence.judge(error, covariance, steps=np.array([5 if t == 3 else steps for t in range(trials)]))
    attribution = found["attribution"]
    assert attribution["carrier"] == "mean"
    assert attribution["nees_per_dimension"] == pytest.approx(np.mean(np.nanmean(nees, 1)), rel=1e-9)
    assert attribution["share"] == pytest.approx(
        np.sum(common / (there * (there - 1))) / np.sum(square / there), rel=1e-9)  # fmt: skip
    assert "a mean error alone is too large: apart from it P is right" in str(found)


@pytest.mark.filterwarnings("ignore:error. a table")
def test_the_truths_own_covariance_has_one_meaning_in_every_form(tmp_path, program):
    rng = np.random.default_rng(2)
    errors = rng.normal(size=(60, 20, 2)) + np.array([0.5, -0.4])
    named = {"component_names": ["x", "heading"], "component_units": ["m", "rad"], "groups": {"both": [0, 1]}}
    plain = {"error": errors, "covariance": np.broadcast_to(np.eye(2), (60, 20, 2, 2))}
    of = {**plain, **named}
    R = 0.25 * np.eye(2)
    assert credence.judge(**of).verdict == "optimistic"
    said = credence.judge(**of, truth_sigma=0.5)
    assert said.verdict == "undecided"
    assert said["truth"][0]["factor95"][0] < 1 < said["truth"][0]["factor95"][1]
    path = records.write(tmp_path / "record.h5", plain)
    for form in (np.diag(R), R, np.broadcast_to(R, (20, 2, 2)), np.broadcast_to(R, (60, 20, 2, 2))):
        assert credence.judge(**of, truth_covariance=form).json == said.json
    assert credence.judge(**of, truth_sigma={"x": "500mm", "heading": 0.5}).json == said.json
    assert credence.judge(path, truth_sigma=0.5)["truth"] == json.loads(
        program("judge", path, "--truth-sigma=0.5", "--format=json", "--quiet")[1]
    )[0]["truth"]
    rows = {"error": errors.reshape(-1, 2), "covariance": plain["covariance"].reshape(-1, 2, 2)}
    assert credence.judge(**rows, **named, runs=np.repeat(np.arange(60), 20), truth_covariance=R).json == said.json
    for wrong, message in (
        ({"truth_sigma": "both=0.1"}, "truth_sigma: `both=0.1` is of components in m and in rad"),
        ({"truth_sigma": {"z": 1}}, "truth_sigma: `z=1` names no group or component"),
        ({"truth_covariance": np.eye(3)}, r"truth_covariance: does not fit: it is \[3, 3\]"),
        ({"truth_covariance": -R}, "truth_covariance: .* is no covariance"),
        ({"truth_dependent": True}, "truth_dependent: says nothing"),
    ):
        with pytest.raises(credence.InputError, match=message):
            credence.judge(**of, **wrong)


def test_an_optimistic_log_has_its_turning_point():
    errors = np.random.default_rng(3).normal(size=(2000, 2))
    verdict = credence.judge(errors, np.broadcast_to(0.1 * np.eye(2), (2000, 2, 2)), component_units=["m", "m"])
    (point,) = verdict.turning_points
    assert (point["where"], point["unit"]) == ("all", "m")
    assert point["vanishes"] < point["right"] == pytest.approx(0.9**0.5, rel=0.05)
    assert "vanishes if the truth is off by" in str(verdict)
