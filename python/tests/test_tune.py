"""`credence.tune`: what it finds and how well it says that it knows it, where it cannot know, and what it refuses."""

from __future__ import annotations

import concurrent.futures
import math
import os
import sys
import warnings

import numpy as np
import pytest
from conftest import python, refusal, refused
from scipy import stats

import credence
from credence import _scores
from credence._tune_search import FAILED, Objective, Space

SIGMA, K, N, FEW = 2.0, 100, 100, 25
CLOSED_FORM_ERROR = SIGMA / math.sqrt(2 * N * K)
MATCHED = """[scenario]
name = matched
poses = 8
[arms]
controllers = fixed
[model]
process = translation
[truth]
deformation = walk
edge_noise = independent
[sensor]
range_min = 0
range_max = inf
"""


def normal(rng, s=1.0, t=1.0, bias=0.0, fails_above=1e9):
    """Errors and innovations with a sigma of 2, of which the filter says that it is s t."""
    if s > fails_above:
        raise ValueError("s is too large")
    error, innovation = SIGMA * rng.standard_normal((2, K, 1))
    P = np.full((K, 1, 1), (s * t) ** 2)
    return credence.Run(error + bias, P, innovation=innovation, innovation_covariance=P)


def rms(seed=1, trials=FEW, which=0):
    """The best s: the root mean square over all trials, which has a closed form."""
    values = [SIGMA * credence.simulating.generator(seed, i).standard_normal((2, K, 1))[which] for i in range(trials)]
    return float(np.sqrt(np.mean(np.square(values))))


def tuned(free=("s",), **options):
    bounds = {"s": (0.05, 50), "t": (0.1, 10), "bias": (-3, 3)}
    box = {name: bounds[name] for name in free}
    return credence.tune(normal, free=box, **{"trials": FEW, "held_out": 40, **options})


@pytest.fixture(scope="module")
def best():
    return tuned(trials=N, held_out=400)


# What is minimised.


def test_scores_are_those_of_scipy_and_of_the_verdict():
    rng = np.random.default_rng(3)
    error, root = rng.standard_normal((6, 3)), rng.standard_normal((6, 3, 3))
    P = root @ root.transpose(0, 2, 1) + np.eye(3)
    densities = _scores.step_scores("errors", {"error": error, "covariance": P})
    expected = [-stats.multivariate_normal(np.zeros(3), cov).logpdf(e) for e, cov in zip(error, P)]
    assert densities == pytest.approx(expected, rel=1e-12)
    error[0, 1] = P[0, 1] = P[0, :, 1] = np.nan  # a component that is not yet in the state
    for arrays in ({"error": error, "covariance": P}, {"error": error, "covariance": np.diagonal(P, axis1=1, axis2=2)}):
        ours = _scores.run_score("errors", arrays, {})
        judged = credence.judge(arrays["error"][None], arrays["covariance"][None], segments="off")
        assert ours == pytest.approx(judged["log_score"]["mean"], rel=1e-12)
    joint = {"error": error, "covariance": P}
    ratio = credence.judge(error[None], P[None], segments="off")["nees_ratio"]["mean"]
    assert _scores.run_score("nees", joint, {}) == pytest.approx(ratio, rel=1e-12)
    assert math.isnan(_scores.run_score("errors", {"error": error, "covariance": -P}, {}))


def test_states_on_a_manifold_have_the_score_of_the_verdict():
    rng = np.random.default_rng(4)
    truth, P = rng.uniform(-1, 1, (5, 3)), np.broadcast_to(0.01 * np.eye(3), (5, 3, 3))
    arrays = {"truth": truth, "estimate": truth + 0.1 * rng.standard_normal((5, 3)), "covariance": P}
    words = {"texts": {"manifold": "SE2", "chart": "local"}}
    judged = credence.judge(**{name: array[None] for name, array in arrays.items()}, **words["texts"], segments="off")
    assert _scores.run_score("errors", arrays, words) == judged["log_score"]["mean"]


# What is found.


def test_the_best_and_its_error_are_those_of_the_closed_form(best):
    value, se = best.parameters["s"]
    assert value == pytest.approx(rms(trials=N), rel=1e-4)
    assert se == pytest.approx(CLOSED_FORM_ERROR, rel=0.15)  # of 100 trials the spread of scores is known to 10 %
    assert best.start == {"s": 1.0}
    assert (best.verdict.verdict, best.verdict_before.verdict) == ("consistent", "optimistic")
    assert best.score_after == best.verdict.log_score["mean"] < best.score_before
    assert best.verdict["trials"] == 400
    assert best.gains["s"] > 0
    assert str(best.parameters["s"]) == f"{value:.3f} ± {se:.3f}"
    half = stats.t.ppf(0.975, N - 1) * se / value  # of the logarithm
    assert best.parameters["s"].interval == pytest.approx((value * math.exp(-half), value * math.exp(half)))
    assert "On 400 other trials (seed 2):" in str(best)


def test_innovations_need_no_truth():
    found = tuned(objective="innovations")
    assert found.parameters["s"].value == pytest.approx(rms(which=1), rel=1e-4)
    assert found.score_after < found.score_before
    before, after = (one.log_score["mean"] for one in (found.verdict_before, found.verdict))
    assert f"log score of the errors: {before:.4g} before, {after:.4g} after" in str(found)


def test_the_custom_of_the_field_is_warned_of():
    with pytest.warns(UserWarning, match="NEES/n first is 1"):
        custom = tuned(free=("s", "t"), objective="nees")
    product = math.prod(one.value for one in custom.parameters.values())
    assert product == pytest.approx(rms(), rel=1e-3)
    assert len(custom.unidentified) == 1


def test_directions_that_the_score_does_not_see_are_named():
    found = tuned(free=("s", "t"))
    (flat,) = found.unidentified
    assert flat["s"] == pytest.approx(-flat["t"], rel=0.01)
    assert math.prod(one.value for one in found.parameters.values()) == pytest.approx(rms(), rel=1e-4)
    assert all(math.isinf(one.se) for one in found.parameters.values())
    assert "does not tell" in str(found)
    assert "with" in str(found).split("does not tell")[1]


def limit():
    """The variance up to which that of the trials is not excluded, by Student's t: a closed form."""
    each = [SIGMA**2 * np.mean(credence.simulating.generator(1, i).standard_normal((2, K, 1))[0] ** 2)
            for i in range(FEW)]  # fmt: skip
    return float(stats.t.interval(0.95, FEW - 1, np.mean(each), stats.sem(each))[1])


@pytest.mark.parametrize("low", [0.0, 0.001])
def test_a_truth_at_zero_has_an_upper_limit(low):
    found = credence.tune(lambda rng, r=1.0: normal(rng, math.hypot(SIGMA, r)), free={"r": (low, 10)},
                          trials=FEW, held_out=40)  # fmt: skip
    expected = 1.05 * math.sqrt(limit() - SIGMA**2)  # to a tenth
    assert found.parameters["r"].interval == pytest.approx((-math.inf, expected), rel=0.05)
    assert math.isnan(found.parameters["r"].se)
    assert f"  below {found.parameters['r'].interval[1]:.3g}  " in str(found)
    assert f"r may be at its bound, {low:g}." in str(found)
    assert "does not see" not in str(found)


def test_what_only_counts_by_its_square_beside_another_has_an_upper_limit():
    free = {"a": (0.01, 10), "b": (0.01, 10)}
    found = credence.tune(lambda rng, a=0.3, b=0.3: normal(rng, math.hypot(a, b)), free=free, trials=FEW, held_out=40)
    for one in found.parameters.values():  # the search stops a little elsewhere on another processor
        assert one.interval == pytest.approx((-math.inf, 1.05 * math.sqrt(limit())), rel=0.08)
    assert "a may be at its bound, 0.01, with b 1.9" in str(found)


@pytest.mark.parametrize("used", [lambda s: round(5 * s) / 5, lambda s: s * (1 + 0.05 * (int(20 * s) % 2))])
def test_a_score_that_jumps_gives_no_standard_error(used):
    found = credence.tune(lambda rng, s=1.0: normal(rng, used(s)), free={"s": (0.5, 50)}, trials=FEW, held_out=40)
    assert found.unidentified == []
    assert math.isnan(found.parameters["s"].se)
    assert "The score jumps along s" in str(found)


def test_a_parameter_that_is_not_used_is_named():
    found = credence.tune(lambda rng, s=1.0, nothing=1.0: normal(rng, s), free={"s": (0.1, 9), "nothing": (0.1, 9)},
                          trials=FEW, held_out=40)  # fmt: skip
    assert "The score does not see nothing." in str(found)
    assert math.isfinite(found.parameters["s"].se)


def test_a_bound_that_is_active_is_said():
    found = credence.tune(normal, free={"s": (0.1, 1.5)}, trials=FEW, held_out=40)
    assert found.at_bounds == {"s": "upper"}
    assert found.parameters["s"].value == pytest.approx(1.5, rel=1e-3)
    assert "s is at its upper bound" in str(found)


def test_a_region_that_fails_is_survived():
    def run(rng, s=20.0):
        return normal(rng, s, fails_above=5)

    found = credence.tune(run, free={"s": (0.05, 50)}, trials=FEW, held_out=40)
    assert found.parameters["s"].value == pytest.approx(rms(), rel=1e-3)
    assert "had no result, the first: trial 0: ValueError: s is too large" in str(found)
    assert found.verdict_before is None
    assert math.isnan(found.score_before)
    with pytest.raises(credence.Failure, match=r"no point has a result.*s is too large"):
        credence.tune(run, free={"s": (6, 50)}, trials=FEW)


def test_trials_without_a_result_count_as_the_worst_of_the_others():
    class Given:
        objective, trouble = "errors", ""

        def scores(self, values, count):
            return np.where(np.arange(count) < values["failed"], np.nan, np.arange(count, dtype=float))

    space = Space(("failed",), np.array([0.0]), np.array([200.0]))
    objective = Objective(Given(), space, 200)
    assert objective.scores(np.array([200 * FAILED / 200])).tolist() == [199, 199, *range(2, 200)]
    assert np.isnan(objective.scores(np.array([0.1]))).all()


def test_what_no_parameter_repairs_is_said():
    found = credence.tune(lambda rng, s=1.0: normal(rng, s, bias=3.0), free={"s": (0.1, 10)}, trials=FEW, held_out=200)
    assert found.verdict.verdict not in ("consistent", "undecided")
    assert "do not make the filter right" in str(found)
    assert "left: biased" in str(found)


def test_the_bits_are_the_same_for_any_executor():
    best = tuned()
    with concurrent.futures.ThreadPoolExecutor(3) as threads:
        for executor in (2, threads):
            found = tuned(executor=executor)
            assert found.parameters == best.parameters
            assert found.verdict["log_score"] == best.verdict["log_score"]
            assert str(found) == str(best)


def test_many_at_once():
    def run(rngs, s=1.0):
        each = [normal(rng, s).arrays for rng in rngs]
        return credence.Run(*(np.array([one[name] for one in each]) for name in ("error", "covariance")))

    found = credence.tune(run, free={"s": (0.05, 50)}, trials=FEW, batch=16, held_out=40)
    assert found.parameters["s"].value == pytest.approx(rms(), rel=1e-4)


def test_copies_of_trials_are_noticed():
    def seeded(seed):
        return lambda rng, s=1.0: normal(np.random.default_rng(seed(rng)), s)

    said = refusal(credence.tune, seeded(lambda rng: 1), free={"s": (0.05, 50)}, trials=FEW)
    assert said.startswith("the first 20 trials have the same score, to the last bit: the function does not use rng")
    few = credence.tune(seeded(lambda rng: rng.integers(5)), free={"s": (0.05, 50)}, trials=FEW, held_out=40)
    assert f"Only 5 of the {FEW} trials are distinct: their scores agree to the last bit." in str(few)
    assert few.verdict.verdict == "failed"
    assert "are distinct" not in str(tuned())


# One log.


def test_a_log_is_tuned_on_its_first_steps():
    rng = np.random.default_rng(5)
    error = SIGMA * rng.standard_normal((3000, 1))
    found = credence.tune(lambda s: credence.Run(error, np.full((3000, 1, 1), s**2)), free={"s": (0.1, 10)})
    assert found.parameters["s"].value == pytest.approx(np.sqrt(np.mean(error[:1500] ** 2)), rel=1e-4)
    assert found.parameters["s"].se == pytest.approx(SIGMA / math.sqrt(2 * 1500), rel=0.2)
    second = stats.norm(0, found.parameters["s"].value).logpdf(error[1500:]).mean()
    assert found.score_after == pytest.approx(-second, rel=1e-6)
    assert "segments of the first 1,500 steps of the log" in str(found)
    whole = credence.tune(lambda s: credence.Run(error, np.full((3000, 1, 1), s**2)), free={"s": (0.1, 10)}, held_out=0)
    assert whole.parameters["s"].value == pytest.approx(np.sqrt(np.mean(error**2)), rel=1e-4)
    assert whole.verdict["segments"]["count"] > 100


def test_a_log_of_few_segments_warns_and_takes_students_t():
    rng = np.random.default_rng(7)
    error = np.convolve(rng.standard_normal(600), 0.95 ** np.arange(200))[:600, None]
    with pytest.warns(UserWarning, match="segments, fewer than 20: 95 % are"):
        found = credence.tune(lambda s: credence.Run(error, np.full((600, 1, 1), s**2)), free={"s": (0.01, 1000)})
    count = found._objective.source.segments
    assert 2 < count < 20
    value, se = found.parameters["s"]
    assert math.log(found.parameters["s"].interval[1] / value) == pytest.approx(
        stats.t.ppf(0.975, count - 1) * se / value
    )
    assert f"Only {count} segments, fewer than 20" in str(found)


def test_a_log_without_truth():
    nu = SIGMA * np.random.default_rng(6).standard_normal((2000, 2))

    def log(s):
        return credence.Run(innovation=nu, innovation_covariance=np.broadcast_to(s**2 * np.eye(2), (2000, 2, 2)))

    found = credence.tune(log, free={"s": (0.1, 10)}, objective="innovations")
    assert found.parameters["s"].value == pytest.approx(np.sqrt(np.mean(nu[:1000] ** 2)), rel=1e-4)
    assert "score of the errors" not in str(found)
    assert "has no error beside a covariance" in refusal(credence.tune, log, free={"s": (0.1, 10)})


# Scenarios.


def test_keys_of_a_scenario():
    text = MATCHED + "[filter]\nmeasurement = 0.5\n"
    found = credence.tune(text, free=["filter.measurement"], trials=300, held_out=20_000)
    value, se = found.parameters["filter.measurement"]
    assert abs(value - 1) < 4 * se < 0.25
    assert (found.verdict.verdict, found.verdict_before.verdict) == ("consistent", "optimistic")


def test_the_program_of_a_world_of_ones_own(tmp_path):
    own = os.environ.get("CREDENCE")
    if own is None:  # the package's own program, which starts more slowly
        own = tmp_path / "program"
        own.write_text(f'#!/bin/sh\nexec {sys.executable} -m credence "$@"\n')
        own.chmod(0o755)
    options = {"free": {"filter.measurement": (0.3, 3)}, "trials": 20, "held_out": 20}
    found = credence.tune(MATCHED, program=own, **options)
    assert found.parameters == credence.tune(MATCHED, **options).parameters
    assert found.score_after == found.verdict.log_score["mean"]
    refused(r"filter\.measurement", credence.tune, MATCHED, program=own, free={"filter.measurement": (-1, 3)})


# Pictures.


def test_the_profile_has_its_least_at_the_best(tmp_path):
    best = tuned()
    values, scores = best.profile("s", points=5)
    assert values[2] == pytest.approx(best.parameters["s"].value, rel=0.01)
    assert np.argmin(scores) == 2
    best.plot().save(tmp_path / "s.png")
    assert (tmp_path / "s.png").stat().st_size > 3000
    refused(r"t was not tuned\. Those are s", best.profile, "t", raises=KeyError)
    assert "cannot make a grid of 1 parameters" in refusal(best.grid)


def test_the_picture_shows_what_was_evaluated_and_evaluates_nothing():
    found = tuned(free=("s", "bias"), start={"bias": 1.0})  # the bias is searched without logarithms
    assert abs(found.parameters["bias"].value) < 4 * found.parameters["bias"].se
    assert found.parameters["bias"].se == pytest.approx(SIGMA / math.sqrt(FEW * K), rel=0.3)
    evaluations = found._objective.evaluations
    assert len(found.plot().axes) == 4  # with the scale of colours
    assert found._objective.evaluations == evaluations
    points, rises = found.searched()
    assert points["s"].shape == rises.shape
    assert min(rises) == 0
    values, rise = found.parabola("s", points=3)
    assert values[1] == pytest.approx(found.parameters["s"].value)
    at, scores = found.profile("s", points=3)
    assert at == pytest.approx(values)
    assert rise == pytest.approx(scores - scores[1], rel=0.2)
    x, y, scores = found.grid(4)
    assert scores.shape == (len(x), len(y))
    assert np.nanmin(scores) == pytest.approx(found._objective.value(found._w), abs=1e-9)


# What is refused.


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"free": {}}, "invalid free (it has no parameter)"),
        ({"free": "s"}, "invalid free=s (must be a dict of bounds)"),
        ({"free": ["s"]}, "invalid free (s has no bounds)"),
        ({"free": {"s": 3}}, "invalid free (s has no pair of bounds)"),
        ({"free": {"s": (2, 1)}}, "invalid free (s is from 2 to 1)"),
        ({"free": {"s": (0, math.inf)}}, "must be a finite number"),
        ({"free": {"u": (1, 2)}}, "invalid free (u is no option of the function). It has rng, s, t, bias"),
        ({"free": {"s": (2, 3)}}, "invalid start (s starts at 1, outside 2 to 3)"),
        ({"free": {"s": (0.1, 3)}, "start": {"t": 1}}, "invalid start (t is not free)"),
        ({"free": {"s": (0.1, 3)}, "objective": "rmse"}, "invalid objective=rmse"),
        ({"free": {"s": (0.1, 3)}, "trials": 1}, "invalid trials=1"),
        ({"free": {"s": (0.1, 3)}, "held_out": 0}, "invalid held_out=0"),
        ({"free": {"s": (0.1, 3)}, "arm": "kf"}, "arm and program: say nothing of a function"),
    ],
)
def test_bad_input_is_refused(options, said):
    assert said in refusal(credence.tune, normal, **options)


def test_bad_keys_are_refused():
    for what, free, more, said in (
        (MATCHED, ["filter.nothing"], {}, "filter.nothing is no key of the scenario"),
        (MATCHED, ["sensor.noise"], {}, "sensor.noise is constant, not a number"),
        (MATCHED, {"filter.measurement": (-1, 1)}, {}, "filter.measurement"),
        (MATCHED, ["filter.measurement"], {"objective": "innovations"}, "no likelihood of its innovations"),
        (3, {"s": (1, 2)}, {}, "cannot be called"),
    ):
        refused(said, credence.tune, what, free=free, **more)


# python -m credence tune.


def command(*words):
    done = python("-m", "credence", "tune", *words)
    return done.returncode, done.stdout, done.stderr


def test_the_command_says_what_the_function_says(tmp_path):
    words = ["test_tune:normal", "--trials", f"{FEW}", "--held-out=40", "--quiet"]
    drawn = [*words, "--free", "s=0.05:50", "--picture=s.png"]
    assert command(*drawn, "--require=no-finding") == (0, str(tuned()), "")
    picture = (tmp_path / "s.png").read_bytes()
    code, said, err = command(*drawn)
    assert (code, said) == (2, "")
    assert "cannot write s.png (it is there already). Give another name or --overwrite." in err
    (tmp_path / "s.png").write_bytes(b"")
    assert command(*drawn, "--overwrite")[0] == 0
    assert (tmp_path / "s.png").read_bytes() == picture
    wrong = "credence tune: invalid --free=s=a:b (must be NAME=LOW:HIGH). Give two numbers.\n"
    assert command(*words, "--free", "s=a:b")[::2] == (2, wrong)


def test_no_warning_but_of_the_custom():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        tuned(trials=10, held_out=30)
