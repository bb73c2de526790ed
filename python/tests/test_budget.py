"""The budget: against closed forms, against worlds that are run one by one, and what it refuses [docs/budget.md]."""

from __future__ import annotations

import csv
import io
import json
import math
import re
from pathlib import Path

import numpy as np
import pytest
from conftest import refused

import credence
from credence._streams import REST, Streams
from credence._trials import generator, seed_sequence
from credence.budgeting import estimated

STEPS, DECAY, NOISE, GAIN = 6, 0.9, {"start": 1.0, "process": 0.3, "measurement": 0.5}, (0.4, 0.7)


def linear(rng, late=False):
    """Two scalar filters with gains that do not change: their errors are sums over their draws."""
    e = NOISE["start"] * rng["start"].normal(size=2)
    errors = []
    for k in range(STEPS):
        e = DECAY * e - NOISE["process"] * rng["process", k].normal(size=2)
        e = (1 - np.array(GAIN)) * e + np.array(GAIN) * NOISE["measurement"] * rng["measurement", k].normal(size=2)
        errors.append(e)
    return credence.Run(np.array(errors), np.full((STEPS, 2), 0.1), component_names=["x", "y"],
                        component_units=["m", "rad"], groups={"place": [0]})  # fmt: skip


def variances(gain, at):
    """{source: the variance that it contributes to one of the filters}, in closed form."""
    of = {"start": NOISE["start"] ** 2, "process": 0.0, "measurement": 0.0}
    found = []
    for _ in range(STEPS):
        of = {name: DECAY**2 * value for name, value in of.items()}
        of["process"] += NOISE["process"] ** 2
        of = {name: (1 - gain) ** 2 * value for name, value in of.items()}
        of["measurement"] += gain**2 * NOISE["measurement"] ** 2
        found.append(of)
    return found[-1] if at == "last" else {name: np.mean([one[name] for one in found]) for name in of}


@pytest.mark.parametrize("at", ["last", "mean"])
def test_shares_of_a_linear_filter_are_those_of_the_closed_form(at):
    budget = credence.budget(linear, 600, at=at, seed=3, progress=False)
    assert budget.sources == ["start", "process", "measurement"]
    assert budget.parts == ["place", "x", "y"]
    for name, gain in zip(("x", "y"), GAIN):
        part, expected = budget[name], variances(gain, at)
        for one in part.contributions:
            low, high = one.alone_ci
            error = (high**2 - low**2) / 2 / 1.96
            assert one.alone**2 == pytest.approx(expected[one.source], abs=3.5 * error)
            assert one.with_others == pytest.approx(one.alone, rel=1e-9)
        assert part.closes
        assert part.interactions == pytest.approx(0, abs=1e-6)
        assert part.rmse**2 == pytest.approx(sum(expected.values()), rel=0.15)
        assert part.p_says**2 == pytest.approx(0.1)
    assert budget["place"].contributions == budget["x"].contributions
    assert all(math.isnan(one.p_counts) and math.isnan(one.ratio) for one in budget["x"].contributions)


def product(rng):
    u, v = rng["u"].normal(), rng["v"].normal()
    return credence.Run(np.array([[u + u * v]]), np.array([[[2.0]]]))


def world(trial, other):
    """The error of one trial of `product` with some sources of the other world, drawn by streams made here."""
    streams = Streams(seed_sequence(1, trial), other)
    return float(product(streams).error[0, 0])


def test_interactions_are_those_of_worlds_run_one_by_one():
    trials = 400
    part = credence.budget(product, trials, progress=False)["all"]
    error = {name: np.array([world(i, other) for i in range(trials)])
             for name, other in (("a", ()), ("b", "uv"), ("cu", "u"), ("cv", "v"))}  # fmt: skip
    error |= {"du": error["cv"], "dv": error["cu"]}  # of two sources
    centred = {name: one - one.mean() for name, one in error.items()}
    for one in part.contributions:
        x, y = centred["a"] - centred[f"c{one.source}"], centred[f"d{one.source}"] - centred["b"]
        alone, total = (x * y).sum() / 2 / (trials - 1), (x * x + y * y).sum() / 4 / (trials - 1)
        assert one.with_others == pytest.approx(math.sqrt(total), rel=1e-12)
        assert one.share == pytest.approx(2 * alone / (error["a"].var(ddof=1) + error["b"].var(ddof=1)), rel=1e-9)
        if alone > 0:
            assert one.alone == pytest.approx(math.sqrt(alone), rel=1e-9)
    u, v = sorted(part.contributions, key=lambda one: one.source)
    assert u.with_others**2 == pytest.approx(2, rel=0.4)
    assert v.with_others**2 == pytest.approx(1, rel=0.4)
    assert v.alone_ci[0] == 0  # V of v alone is 0
    assert part.interactions**2 == pytest.approx(1, rel=0.5)


def test_the_study_is_that_of_simulate_bit_for_bit_on_any_executor():
    one = credence.budget(linear, 40, progress=False)
    other = credence.budget(linear, 40, executor=2, progress=False)
    study = credence.simulate(linear, 40, progress=False)
    assert np.array_equal(one.simulation["a"].read("error"), study["run"].read("error"))
    assert one.json == other.json
    assert np.array_equal(study["run"]["status"], np.zeros(40))


def test_streams_leave_the_generator_as_it_is():
    named, plain = generator(4, 2), np.random.Generator(np.random.Philox(seed_sequence(4, 2)))
    named["m"].normal(size=3)
    assert np.array_equal(named.normal(size=5), plain.normal(size=5))
    assert [one.normal() for one in named.spawn(2)] == [
        np.random.Generator(np.random.Philox(one)).normal() for one in seed_sequence(4, 2).spawn(2)
    ]
    first = generator(4, 2)
    assert first["m", 3].normal() == generator(4, 2)["m", 3].normal() != first["m", 4].normal()
    assert first["m", 3] is first["m", 3]
    assert first["m", 5].normal() != first.other(["m"])["m", 5].normal()
    assert first["n", 5].normal() == first.other(["m"])["n", 5].normal()
    assert first.other([REST]).normal() != plain.normal()
    for wrong in ((), 3, ("m", -1), ("m", 1.5), (1, "m")):
        with pytest.raises(KeyError, match="whole numbers from 0 on"):
            first[wrong]


def shifting(rng, numbered=False):
    """Measures only where the state is positive; what is drawn by name alone is then no longer held."""
    total = 0.0
    for k in range(4):
        total += rng.normal()
        if total > 0:
            total -= (rng["measurement", k] if numbered else rng["measurement"]).normal()
    return credence.Run(np.array([[total]]), np.eye(1)[None])


def test_a_held_source_whose_number_of_draws_changes_is_warned_of():
    with pytest.warns(UserWarning, match=r"changes in number with rest.*rng\['measurement', k\]"):
        credence.budget(shifting, 60, progress=False)
    assert credence.budget(shifting, 60, options={"numbered": True}, progress=False).sources == ["measurement", REST]


def failing(rng):
    x = rng["x"].normal()
    if x > 1.5:
        raise ValueError("too large")
    return credence.Run(np.array([[x + rng["y"].normal()]]), np.array([[[2.0]]]))


def test_trials_that_fail_in_one_of_the_runs_are_left_out_of_all():
    budget = credence.budget(failing, 300, progress=False)
    drawn = [[Streams(seed_sequence(1, i), other)["x"].normal() for other in ((), ("x",))] for i in range(300)]
    assert budget.left_out == sum(max(pair) > 1.5 for pair in drawn)
    assert budget.trials == 300 - budget.left_out
    assert f"{budget.left_out} more that failed" in str(budget)


def late(rng):
    x = rng["x"].normal()
    return credence.Run(np.array([[x + (rng["rare"].normal() if x > 2.5 else 0)]]), np.eye(1)[None])


def test_a_source_that_the_first_trials_do_not_have_fails_its_trial():
    budget = credence.budget(late, 300, progress=False)
    assert budget.sources == ["x"]
    assert "draws from rare, which none of the first 20 trials does" in budget.simulation.failures[0].reason


SMALL = "[scenario]\nname = small\nposes = 3\n[arms]\ncontrollers = fixed, greedy\n[planner]\nspeeds = 1\n"


def test_the_budget_of_a_scenario_is_that_of_the_program_for_any_executor(tmp_path):
    budget = credence.budget(SMALL, 300, of="position", progress=False)
    assert budget.arms == ["small/fixed.ekf", "small/greedy.ekf"]
    assert budget.sources == ["odometry", "heading", "measurement", "walk", "deformation"]
    assert budget.json == credence.budget(SMALL, 300, of="position", executor=2, progress=False).json
    study = credence.run(SMALL, trials=300, progress=False)
    for column in ("trace_P", "pose_error"):
        assert np.array_equal(budget.study["small", "greedy.ekf"][column], study["greedy.ekf"][column])
    greedy = budget.arm("greedy.ekf")
    assert greedy["position"].contributions != budget["position"].contributions
    for part in (budget["position"], greedy["f0_x"]):
        assert sum(one.p_counts**2 for one in part.contributions) == pytest.approx(part.p_says**2, rel=1e-9)
    with pytest.raises(KeyError, match="no one arm x"):
        budget.arm("x")
    budget.plot().save(tmp_path / "budget.png")
    swept = credence.budget(SMALL, 20, sweep={"noise.heading": [0.001, 0.1]}, progress=False)
    assert len(swept.arms) == 4


# Of a NumPy program that knows neither ours nor its draws, 20,000 trials: alone, its interval, with others, P counts.
PROTOTYPE = {
    0.001: {
        "odometry": (0.1225, (0.1219, 0.1232), 0.1225, 0.1221),
        "heading": (0.0396, (0.0392, 0.0400), 0.0396, 0.0397),
        "walk": (0.0103, (0.0102, 0.0104), 0.0105, 0.0107),
        "deformation": (0.0021, (0.0021, 0.0021), 0.0027, 0.0074),
    },
    0.1: {
        "heading": (2.52, (2.50, 2.54), 2.72, 2.28),
        "walk": (0.253, (0.226, 0.277), 1.05, 0.595),
        "deformation": (0.097, (0.076, 0.115), 0.573, 0.502),
    },
}


@pytest.mark.parametrize("heading", PROTOTYPE)
def test_the_document_s_circle_has_the_budget_of_an_independent_program(heading):
    scenario = Path(__file__).parents[2] / "experiments" / "seed" / "ekf-circle-ranged.ini"
    budget = credence.budget(scenario, of="position", progress=False,
                             set={"noise.heading": heading, "arms.controllers": "fixed"})  # fmt: skip
    found = {one.source: one for one in budget["position"].contributions}
    assert budget["position"].closes == (heading < 0.01)  # beyond, three sources interact, there as here
    for name, (alone, (low, high), with_others, p_counts) in PROTOTYPE[heading].items():
        one = found[name]
        wide = math.hypot(high - low, one.alone_ci[1] - one.alone_ci[0]) / 2 / 1.96
        digit = 5 * 10.0 ** -(4 if heading < 0.01 else 3)  # what is not printed
        assert one.alone == pytest.approx(alone, abs=3.5 * wide + digit / 10)
        assert one.with_others == pytest.approx(with_others, rel=0.04, abs=digit / 10)
        counts = math.hypot(one.p_counts, found["edges"].p_counts if name == "deformation" else 0)  # one sigma
        assert counts == pytest.approx(p_counts, rel=0.04, abs=digit / 10)


REFUSALS = [
    (lambda rng: credence.Run(np.ones((2, 1)), np.ones((2, 1))), {}, "it draws nothing from rng"),
    (linear, {"of": "z"}, "invalid of=z (there is no such component, or group of one unit). Take place, x, y"),
    (linear, {"of": "all"}, "there is no such component, or group of one unit"),
    (linear, {"set": {"noise.heading": 1}}, "a function has no keys"),
    ("small.ini", {"options": {"q": 1}}, "a scenario has keys"),
    (SMALL, {"of": "pose"}, "Take heading, position, features"),
    (linear, {"at": "first"}, "Take last or mean"),
    (lambda rng: credence.Run(nees=rng["x"].chisquare(2, 3), dimension=2), {}, "has no error [step, n]"),
    (3, {}, "a int cannot be called"),
]


@pytest.mark.parametrize(("run", "options", "said"), REFUSALS)
def test_bad_input_is_refused(run, options, said):
    refused(re.escape(said), lambda: credence.budget(run, 20, progress=False, **options))


def test_text_csv_and_picture_say_the_same(tmp_path):
    budget = credence.budget(linear, 50, of="x", progress=False)
    assert [row["source"] for row in budget.table] == [one.source for one in budget["x"].contributions]
    rows = list(csv.DictReader(io.StringIO(budget.csv)))
    assert [float(row["alone"]) for row in rows if row["of"] == "x"] == [row["alone"] for row in budget.table]
    for row in budget.table:
        assert f"{row['alone']:9.4g}" in str(budget)
    assert budget.arms == ["run"]
    budget.plot().save(tmp_path / "budget.png")
    assert (tmp_path / "budget.png").stat().st_size > 1000
    assert "Budget of start, process, measurement" in repr(budget)


def test_intervals_of_a_linear_function_cover():
    """Of 400 studies of 200 trials of u + v/2 + w/10, with normal draws: how many intervals hold the true value."""
    rng, trials, scales = np.random.default_rng(1), 200, np.array([1, 0.5, 0.1])
    held = np.zeros(3)
    for _ in range(400):
        a, b = rng.normal(size=(2, trials, 3)) * scales
        swapped = [np.where(np.arange(3) == i, theirs, own) for i in range(3) for own, theirs in ((a, b), (b, a))]
        errors = [one.sum(axis=1)[:, None, None] for one in (a, b, *swapped)]
        said = json.loads(estimated(errors, ["0", "1", "2"], [("x", "")]).in_format("json"))
        for one in said[0]["parts"][0]["sources"]:
            low, high = one["alone_ci"]
            held[int(one["source"])] += low <= scales[int(one["source"])] <= high
    assert (held / 400 > 0.91).all(), held / 400
    assert (held / 400 < 0.98).all(), held / 400


def counted(rng, wrong=None):
    """The linear filters, which say what of P they count: in closed form, or wrong in one way."""
    run = linear(rng)
    of = {name: np.zeros((STEPS, 2, 2)) for name in NOISE}
    for j, gain in enumerate(GAIN):
        now = {"start": NOISE["start"] ** 2, "process": 0.0, "measurement": 0.0}
        for k in range(STEPS):
            now = {name: (DECAY * (1 - gain)) ** 2 * value for name, value in now.items()}
            now["process"] += ((1 - gain) * NOISE["process"]) ** 2
            now["measurement"] += (gain * NOISE["measurement"]) ** 2
            for name, value in now.items():
                of[name][k, j, j] = value
    P = sum(of.values())
    if wrong == "sum":
        of["start"] = 1.01 * of["start"]
    for name in list(of)[1 if wrong == "sometimes" and rng["start"].uniform() < 0.5 else 0 :]:
        rng.counts(name, of[name][:, 0] if wrong == "shape" else of[name])
    return credence.Run(run.error, P, component_names=["x", "y"], component_units=["m", "rad"])


@pytest.mark.parametrize("at", ["last", "mean"])
def test_what_a_function_counts_stands_beside_what_each_source_contributes(at):
    budget = credence.budget(counted, 300, at=at, progress=False)
    assert budget.counted_trials == 300
    for name, gain in zip(("x", "y"), GAIN):
        expected = variances(gain, at)
        for one in budget[name].contributions:
            assert one.p_counts**2 == pytest.approx(expected[one.source], rel=1e-12)
            assert one.ratio == pytest.approx(one.alone**2 / expected[one.source], rel=1e-9)
    assert "P counts" in str(budget)
    assert math.isnan(credence.budget(linear, 20, progress=False)["x"].contributions[0].p_counts)


@pytest.mark.parametrize(("wrong", "words"), [
    ("sum", "differs from covariance by"), ("shape", "are not all that of covariance"),
])  # fmt: skip
def test_what_a_function_counts_must_add_up_to_P_in_every_trial(wrong, words):
    with pytest.raises((credence.InputError, RuntimeError), match=words):
        credence.budget(counted, 20, options={"wrong": wrong}, progress=False)


def test_a_trial_that_counts_other_sources_than_the_first_ones_has_failed():
    budget = credence.budget(counted, 40, options={"wrong": "sometimes"}, progress=False)
    assert 5 < budget.left_out < 35
