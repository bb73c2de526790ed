"""Planners that are functions of Python: their arms beside the built-in ones, and what becomes of their mistakes."""

import numpy as np
import pytest

import credence

EXPLORE = """[scenario]
world = explore
name = small
poses = 21
[walls]
segments = 2 -3 2 1
[features]
count = 6
extent = 10
[map]
box = -5 -5, 5 5
[sensor]
range_max = 4
view = 2
[arms]
controllers = fixed, greedy
"""
DEFORMABLE = """[scenario]
name = circle
poses = 12
[features]
path = circle
[arms]
controllers = fixed, greedy
"""
TRANSLATION = DEFORMABLE + "[model]\nprocess = translation\n"


def least_trace(now):
    return np.where(now.prospects.allowed, now.prospects.trace, np.inf)


def greedy(now):
    """The built-in planner's rule: of equals, the last."""
    cost = least_trace(now)
    equal = cost <= cost.min(axis=1, keepdims=True) * (1 + 1e-12)
    return cost.shape[1] - 1 - equal[:, ::-1].argmax(axis=1)


def first(now):
    return np.zeros(len(now.trial), dtype=int)


def column(study, arm, name):
    (scenario,) = study.scenarios
    return np.asarray(study[scenario, arm][name])


def columns(study, arm):
    return {name: column(study, arm, name) for name in ("trace_P", "pose_error", "path_length")}


@pytest.mark.parametrize("scenario", [EXPLORE, DEFORMABLE, TRANSLATION], ids=["explore", "deformable", "translation"])
def test_the_rule_of_the_built_in_planner_goes_its_way(scenario):
    study = credence.run(scenario, planners={"mine": greedy}, trials=100)
    estimator = "kf" if scenario is TRANSLATION else "ekf"
    ours, mine = columns(study, f"greedy.{estimator}"), columns(study, f"mine.{estimator}")
    same = np.isclose(ours["trace_P"], mine["trace_P"], rtol=1e-9)
    assert same.mean() > 0.95  # candidates that rounding alone tells apart
    for name in ours:
        np.testing.assert_allclose(mine[name][same], ours[name][same], rtol=1e-7)
    assert not np.allclose(mine["trace_P"], columns(study, f"fixed.{estimator}")["trace_P"])


def test_the_control_may_be_no_candidate():
    def circle(now):
        return np.tile([0.3, 0.4, 0.1], (len(now.trial), 1))

    study = credence.run(
        EXPLORE, planners={"circle": circle}, trials=70, set={"noise.odometry": 1e-9, "walls.segments": "none"}
    )
    np.testing.assert_allclose(columns(study, "circle.ekf")["path_length"], 20 * np.hypot(0.4, 0.1), rtol=1e-6)


def test_what_is_told():
    seen = []

    def look(now):
        seen.append(now)
        _ = now.mean, now.covariance, now.known, now.cells, now.trial, now.candidates
        return first(now)

    credence.run(EXPLORE, planners={"look": look}, trials=70, threads=1)
    now = next(one for one in seen if one.step == 20 and len(one.trial) == 64)
    assert now.mean.shape == (64, 15)
    assert now.covariance.shape == (64, 15, 15)
    assert now.cells.shape == (64, 10, 10)
    assert now.candidates.shape[1] == 3
    np.testing.assert_array_equal(now.trial, np.arange(64))
    np.testing.assert_allclose(now.covariance, now.covariance.transpose(0, 2, 1))
    absent = np.isnan(now.mean[:, 3::2])
    np.testing.assert_array_equal(absent, ~now.known)  # a landmark that is not there tells nothing of its place
    assert absent.any()
    assert now.known.any()
    np.testing.assert_array_equal(np.isnan(now.covariance[:, 3::2, 0]), absent)
    with pytest.raises(credence.InputError, match="the step is over"):
        _ = now.prospects


def drawn(now):
    return (now.rng.random() * len(now.candidates)).astype(int)[:, 0]


def test_the_same_bits_for_any_threads_shards_and_resumption(tmp_path):
    planners = {"drawn": drawn, "mine": greedy}
    one = credence.run(EXPLORE, planners=planners, trials=600, threads=1)
    two = credence.run(EXPLORE, planners=planners, trials=600, threads=2)
    shards = credence.run(EXPLORE, planners=planners, trials=600, executor=2)
    begun = credence.run(EXPLORE, planners=planners, trials=300, output=tmp_path / "a.h5")
    grown = credence.resume(begun, planners=planners, trials=600)
    for other in (two, shards, grown):
        for arm in ("drawn.ekf", "mine.ekf"):
            for name, values in columns(one, arm).items():
                np.testing.assert_array_equal(columns(other, arm)[name], values)


def test_a_trial_runs_again(tmp_path):
    study = credence.run(EXPLORE, planners={"mine": greedy}, trials=40, output=tmp_path / "a.h5")
    (trajectory,) = credence.replay(study, arm="mine.ekf", trial=33, planners={"mine": greedy})
    assert trajectory.columns["trace_P"] == column(study, "mine.ekf", "trace_P")[33]
    with pytest.raises(credence.InputError, match="no such planner"):
        credence.replay(study, arm="mine.ekf", trial=33)


def test_a_study_goes_on_with_its_own_planner_alone(tmp_path):
    study = credence.run(EXPLORE, planners={"mine": greedy}, trials=10, output=tmp_path / "a.h5")
    with pytest.raises(credence.InputError, match="another function when the study began"):
        credence.resume(study, planners={"mine": first}, trials=20)
    with pytest.raises(credence.InputError, match="no such planner"):
        credence.resume(study, trials=20)

    def of(place):
        return lambda now: np.full(len(now.trial), place)

    held = credence.run(EXPLORE, planners={"mine": of(3)}, trials=10)
    held = credence.resume(held, planners={"mine": of(3)}, trials=20)
    assert held.trials == 20
    with pytest.raises(credence.InputError, match="another function when the study began"):
        credence.resume(held, planners={"mine": of(4)}, trials=30)
    assert "mine.ekf" in str(credence.report(tmp_path / "a.h5"))


def test_trials_in_which_it_fails_are_lost_alone():
    def sometimes(now):
        if np.isin(now.trial, [3, 65]).any() and now.step == 4:
            raise RuntimeError("cannot say")
        return first(now)

    with pytest.warns(
        UserWarning, match=r"(?s)planner sometimes failed in 2 trials; the first is trial 3, at step 4.*cannot say"
    ):
        study = credence.run(EXPLORE, planners={"sometimes": sometimes}, trials=100)
    status = column(study, "sometimes.ekf", "status")
    np.testing.assert_array_equal(np.flatnonzero(status), [3, 65])
    np.testing.assert_array_equal(column(study, "sometimes.ekf", "status_pose")[[3, 65]], 4)
    assert not column(study, "greedy.ekf", "status").any()


@pytest.mark.parametrize(
    ("answer", "message"),
    [
        (lambda now: np.where(now.trial == 2, 10_000, 0), "10000 is no place of 33 candidates"),
        (lambda now: np.where(now.trial == 2, -1, 0), "-1 is no place of 33 candidates"),
        (lambda now: np.where(now.trial[:, None] == 2, [np.nan, 0, 0], [0.1, 0.2, 0]), "is not finite"),
        (lambda now: np.where(now.trial[:, None] == 2, [0, 30.0, 0], [0.1, 0.2, 0]), "moves farther than the longest"),
    ],
)
def test_a_control_that_is_none_loses_its_trial(answer, message):
    with pytest.warns(UserWarning, match=message):
        study = credence.run(EXPLORE, planners={"mine": answer}, trials=5)
    np.testing.assert_array_equal(np.flatnonzero(column(study, "mine.ekf", "status")), [2])


def fails(now):
    raise ValueError("no idea")


@pytest.mark.parametrize(
    ("planner", "message"),
    [
        (lambda now: np.zeros((3, 2)), r"returns float64 of the shape \(3, 2\) for \d+ trials"),
        (lambda now: ["left"] * len(now.trial), "returns <U4"),
        (lambda now: np.zeros(len(now.trial)), "places of candidates"),
        (lambda now: None, "returns object"),
        (fails, r"(?s)fails in all of 64 trials at step 1.*no idea"),
        (lambda now: np.random.default_rng().integers(33, size=len(now.trial)), "goes another way a second time"),
        (lambda now: np.arange(len(now.trial)) * 7 % 33 if len(now.trial) > 40 else first(now), "beside other trials"),
    ],
)
def test_what_is_no_planner_is_refused_before_any_trial_is_kept(planner, message, tmp_path):
    with pytest.raises(credence.InputError, match=message):
        credence.run(EXPLORE, planners={"mine": planner}, trials=100, output=tmp_path / "a.h5")
    assert not (tmp_path / "a.h5").exists()


@pytest.mark.parametrize(
    ("planners", "message"),
    [
        ({"greedy": first}, "there is a controller greedy already"),
        ({"a.b": first}, "only letters"),
        ({"mine": 3}, "cannot be called"),
        ([first], "is no dict"),
    ],
)
def test_names_and_functions_are_checked(planners, message):
    with pytest.raises(credence.InputError, match=message):
        credence.run(EXPLORE, planners=planners, trials=5)
