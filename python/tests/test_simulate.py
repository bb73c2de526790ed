"""`credence.simulate`: what its numbers are a function of, what is kept, and what becomes of trials that go wrong.

With CREDENCE_FLIPS=700 that many bytes of a record are changed, one at a time, in place of 60.
"""

from __future__ import annotations

import concurrent.futures
import copy
import filecmp
import math
import os
import pathlib
import re
import signal
import subprocess
import sys
import warnings

import filters
import h5py
import numpy as np
import pytest
import records
from conftest import python, refusal, refused, started
from scipy import stats

import credence
from credence import _trials

PAGE = pathlib.Path(__file__).parents[2] / "docs" / "python.md"
ARMS = {"right": {}, "calm": {"scale": 0.5}}
ARMS_OF_SLOW = {"right": {}, "calm": {}}
FLIPS = int(os.environ.get("CREDENCE_FLIPS", "60"))


def is_same(first, second):
    """Whether the records of two outputs are the same, byte for byte."""
    return filecmp.cmp(f"{first}.h5", f"{second}.h5", shallow=False)


def stopped(script, number, output):
    """Send a signal to a process that runs a script as soon as it has kept trials; its code and what it printed."""
    kept = f"{output}.trials"
    streams = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT}
    with started("-c", script, wait_for=kept, least=2000, **streams) as process:
        process.send_signal(number)
        return process.communicate(timeout=60)[0], process.returncode


# What the numbers are.


def test_the_generator_is_as_documented():
    study = credence.simulate(filters.drawn, trials=20)
    key = np.random.SeedSequence(1, spawn_key=(17,)).generate_state(2, np.uint64)
    documented = np.random.Generator(np.random.Philox(key=key))
    assert study.generator(17).bit_generator.state["state"]["key"].tolist() == key.tolist()
    expected = documented.standard_normal((filters.STEPS, filters.N))
    assert np.array_equal(study.arm("run").read("error")[17], expected)
    page = " ".join(PAGE.read_text().split())
    said = re.search(r"The first three standard normal numbers of trial 17 of seed 1 are `([^`]+)`", page)
    assert said is not None
    assert said[1].split(", ") == [repr(number) for number in expected.ravel()[:3].tolist()]


def test_streams_of_trials_are_independent():
    """A million draws of 1000 trials: uniform, and correlated neither along a stream nor across streams."""
    draws = np.array([_trials.generator(5, trial).random(1000) for trial in range(1000)])
    assert stats.kstest(draws.ravel(), "uniform").pvalue > 1e-4
    assert stats.kstest(draws[:, 0], "uniform").pvalue > 1e-4  # across trials
    centred = (draws - 0.5) * math.sqrt(12)
    for shifted in (centred[1:] * centred[:-1], centred[:, 1:] * centred[:, :-1], centred[2:] * centred[:-2]):
        assert abs(shifted.sum()) / math.sqrt(shifted.size) < 4  # standard deviations of a sum of independent ones
    joint = np.linalg.eigvalsh(centred @ centred.T / 1000)  # of independent streams: Marchenko and Pastur's law
    assert 3.6 < joint[-1] < 4.4
    assert len(np.unique(draws)) == draws.size


def test_every_arm_of_a_trial_has_the_same_stream():
    study = credence.simulate(filters.drawn, trials=30, arms=ARMS)
    right, calm = (study.arm(name) for name in ARMS)
    assert np.array_equal(right.read("error"), calm.read("error"))
    assert np.array_equal(calm.read("covariance"), 0.5 * right.read("covariance"))
    other = credence.simulate(filters.drawn, trials=30, seed=2)
    assert not np.isin(other.arm("run").read("error"), right.read("error")).any()


def test_spawned_generators_are_functions_of_the_trial():
    def run(rng):
        return filters.drawn(rng.spawn(2)[1])

    first, second = (credence.simulate(run, trials=10) for _ in range(2))
    assert first.is_repeatable
    assert np.array_equal(first.arm("run").read("error"), second.arm("run").read("error"))


def test_the_record_is_what_judge_says_of_the_arrays():
    given = records.corpus()
    names = ["joint", "groups", "names", "singles", "innovations", "variances", "of_groups", "nees_alone", "wxyz"]
    for name in [*names, "planar", "troubled", "growing", "steps", "time_of_trials"]:
        record = given[name]
        runs = iter([record_of_trial(record, trial) for trial in [0, *range(records.TRIALS)]])  # trial 0 runs twice
        study = credence.simulate(lambda rng, runs=runs: next(runs), trials=records.TRIALS)
        verdict, expected = study.arm("run").verdict, credence.judge(**record, name="run")
        for entry in (verdict.json[0], expected.json[0]):
            for varying in ("source", "arm"):
                entry.pop(varying, None)
            for column in entry.values():  # the arm's name is in the key of the bootstrap
                if isinstance(column, dict):
                    column.pop("bootstrap95", None)
        assert {key: value for key, value in verdict.json[0].items() if value != expected.json[0].get(key)} == {}, name
        arguments = study.arm("run").record()
        assert credence.judge(**arguments)["groups"] == verdict["groups"]


def record_of_trial(record, trial):
    """One trial of the arguments of `judge`."""

    def of(value):
        if isinstance(value, dict):
            return {name: of(one) for name, one in value.items()}
        is_of_trials = isinstance(value, np.ndarray) and len(value) == records.TRIALS
        return value[trial] if is_of_trials else value

    return credence.Run(**{name: value if name == "groups" else of(value) for name, value in record.items()})


# What is kept.


def test_a_study_grows_to_the_same_bits():
    grown = credence.simulate(filters.drawn, trials=500, arms=ARMS, output="grown.h5")
    assert grown.trials == 500
    credence.simulate(filters.drawn, trials=1000, arms=ARMS, output="grown.h5", resume=True)
    credence.simulate(filters.drawn, trials=1000, arms=ARMS, output="whole.h5")
    assert is_same("grown", "whole")
    with pytest.warns(UserWarning, match="has 1000 trials; what is written has the first 500"):
        shorter = credence.simulate(filters.drawn, trials=500, arms=ARMS, output="grown.h5", resume=True)
    credence.simulate(filters.drawn, trials=500, arms=ARMS, output="short.h5")
    assert shorter.trials == 500
    assert is_same("grown", "short")


def test_a_torn_tail_is_cut():
    credence.simulate(filters.slow, trials=60, arms=ARMS_OF_SLOW, output="whole.h5")
    kept = pathlib.Path("whole.h5.trials").read_bytes()
    cuts = np.random.default_rng(6).integers(1, len(kept), 6)
    for cut in cuts.tolist():
        pathlib.Path("torn.h5.trials").write_bytes(kept[:cut])
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            credence.simulate(filters.slow, trials=60, arms=ARMS_OF_SLOW, output="torn.h5", resume=True)
        assert is_same("whole", "torn")


@pytest.mark.parametrize("place", [0, 8, 16, 30, 400])
def test_a_damaged_chunk_costs_its_own_trials(place):
    """In the middle of the kept trials, at its mark, its length, its header and its numbers."""
    calls = []

    def run(rng):
        calls.append(filters.number_of(copy.deepcopy(rng), trials=120))
        return filters.drawn(rng)

    credence.simulate(filters.slow, trials=120, output="whole.h5", executor=2)
    kept = bytearray(pathlib.Path("whole.h5.trials").read_bytes())
    starts = [at for at in range(len(kept)) if kept[at : at + 8] == _trials.MAGIC]
    assert len(starts) > 5
    numbers = _trials.Frame(bytes(kept[starts[3] : starts[4]])).header["numbers"]
    kept[starts[3] + place] ^= 1
    pathlib.Path("whole.h5.trials").write_bytes(kept)
    with pytest.warns(UserWarning, match="in the middle of it are damaged; the trials that were there run again"):
        credence.simulate(run, trials=120, output="whole.h5", resume=True)
    assert set(numbers) <= set(calls) <= {0, 1, *numbers}  # and one that is compared
    credence.simulate(filters.drawn, trials=120, output="again.h5")
    assert is_same("whole", "again")


def test_a_frame_that_was_damaged_on_its_way_runs_again():
    class Damaging(concurrent.futures.ThreadPoolExecutor):
        count = 0

        def submit(self, function, /, *arguments):
            def damaged():
                data = bytearray(function(*arguments))
                Damaging.count += 1
                data[-40] ^= Damaging.count % 5 == 0
                return bytes(data)

            return super().submit(damaged)

    with Damaging(2) as executor:
        study = credence.simulate(filters.slow, trials=200, arms=ARMS_OF_SLOW, output="a.h5", executor=executor)
    assert study.failures == []
    assert Damaging.count > 10
    credence.simulate(filters.slow, trials=200, arms=ARMS_OF_SLOW, output="b.h5")
    assert is_same("a", "b")


@pytest.mark.parametrize("arms", [None, ARMS])
def test_a_byte_that_changed_gives_no_wrong_number(arms, program):
    """Of the whole record, its metadata too: what it says is the same, or it is refused."""

    def run(rng, scale=1.0):
        more = {"innovation": rng.standard_normal((4, 2)), "groups": {"a": [0]}}
        made = filters.drawn(rng, scale, innovation_covariance=np.broadcast_to(np.eye(2), (4, 2, 2)), **more)
        if made.columns["rmse"] > 1.4:
            raise ValueError("x")
        return made

    credence.simulate(run, trials=40, arms=arms, output="record.h5", failed=1)
    whole = pathlib.Path("record.h5").read_bytes()
    words = ("judge", "damaged.h5", "--quiet", "--format=json", "--failed=1")
    pathlib.Path("damaged.h5").write_bytes(whole)
    right = program(*words)
    assert right[0] == 0
    chance, refused = np.random.default_rng(4), 0
    for at in chance.choice(len(whole), FLIPS, replace=False):
        damaged = bytearray(whole)
        damaged[at] ^= 1 << int(chance.integers(8))
        pathlib.Path("damaged.h5").write_bytes(damaged)
        code, said, _ = program(*words)
        assert (code, said) == right[:2] or code == 2, at
        refused += code == 2
    assert refused > FLIPS / 10


def test_a_study_that_was_killed_before_trial_0_was_kept_is_of_one_function():
    credence.simulate(filters.slow, trials=60, arms={"right": {}}, output="kept.h5")
    kept = pathlib.Path("kept.h5.trials").read_bytes()
    starts = [at for at in range(len(kept)) if kept[at : at + 8] == _trials.MAGIC]
    without = kept[: starts[1]] + kept[starts[2] :]  # the frame of trial 0 is the first
    assert _trials.Frame(kept[starts[1] : starts[2]]).header["numbers"] == [0]
    for name in ("other.h5", "same.h5"):
        pathlib.Path(f"{name}.trials").write_bytes(without)
    given = {"trials": 60, "arms": {"right": {}}, "resume": True}
    said = refusal(credence.simulate, lambda rng: filters.drawn(rng, 2), output="other.h5", **given)
    assert "trial 1 of right gives other numbers than those that are kept" in said
    assert not pathlib.Path("other.h5").exists()
    credence.simulate(filters.slow, output="same.h5", **given)
    assert is_same("same", "kept")


def test_options_are_compared_by_their_values():
    class Noise:
        def __init__(self, q):
            self.q = q

    def run(rng, **_):
        return filters.drawn(rng)

    def study(resume=False, **option):
        return credence.simulate(run, trials=30, arms={"kf": option}, output="kept.h5", resume=resume)

    options = [
        ({"Q": np.eye(2)}, {"Q": 2 * np.eye(2)}),
        ({"Q": np.eye(2)}, {"Q": np.eye(2, dtype=np.float32)}),
        ({"Q": [np.eye(2), None]}, {"Q": [np.eye(2), 1]}),
        ({"Q": Noise(1.0)}, {"Q": Noise(2.0)}),
        ({"Q": Noise(np.eye(2))}, {"Q": Noise(2 * np.eye(2))}),
        ({"Q": np.nan}, {"Q": 1.0}),
        ({"Q": {"a": 1, 2: 3}}, {"Q": {"a": 1, 2: 4}}),
        ({"Q": {1, 2}}, {"Q": {1, 3}}),
        ({"Q": pathlib.Path("a")}, {"Q": pathlib.Path("b")}),
        ({"Q": filters.drawn}, {"Q": filters.slow}),
    ]
    for one, other in options:
        study(**one)
        study(resume=True, **copy.deepcopy(one))
        assert "kept.h5.trials: its trials have arms=" in refusal(study, resume=True, **other)
        for path in pathlib.Path().iterdir():
            path.unlink()
    within = []
    within.append(within)
    assert "an option contains itself" in refusal(study, Q=within)


def test_resuming_replaces_the_record_of_its_own_trials_alone():
    def study(output="mine.h5", **more):
        return credence.simulate(filters.drawn, trials=30, **{"output": output, "resume": True, **more})

    pathlib.Path("mine.h5").write_bytes(b"results of a week")
    refused(r"cannot resume mine.h5 \(its trials are not beside it, in mine.h5.trials\)", study)
    refused(r"mine.h5 \(it is there already\). Name another\.$", study, resume=False)
    assert [path.name for path in pathlib.Path().iterdir()] == ["mine.h5"]
    pathlib.Path("mine.h5").rename("week.h5")
    study()
    refused(r"Name another, or say resume=True", study, resume=False)
    for other in (b"results of a week", pathlib.Path("mine.h5").read_bytes()):
        credence.simulate(filters.drawn, trials=30, seed=2, output="two.h5")
        pathlib.Path("two.h5").write_bytes(other)
        refused(r"two.h5 \(it is no record of the trials in two.h5.trials\)", study, "two.h5", seed=2)
        assert pathlib.Path("two.h5").read_bytes() == other
        for name in ("two.h5", "two.h5.trials"):
            pathlib.Path(name).unlink()
    assert pathlib.Path("week.h5").read_bytes() == b"results of a week"


@pytest.mark.parametrize("output", ["mine", "mine.h5"])
def test_an_arm_may_have_any_name_of_a_file(output):
    arms = {name: {} for name in ("trials", "h5", "error", "h5.trials", "part")}
    study = credence.simulate(filters.drawn, trials=300, arms=arms, output=output)
    assert sorted(path.name for path in pathlib.Path().iterdir()) == [output, f"{output}.trials"]
    assert {verdict["trials"] for verdict in study.verdicts.values()} == {300}
    assert credence.simulate(filters.drawn, trials=400, arms=arms, output=output, resume=True).trials == 400


def test_a_link_is_followed():
    pathlib.Path("far").mkdir()
    pathlib.Path("near.h5").symlink_to("far/away.h5")
    study = credence.simulate(filters.drawn, trials=30, output="near.h5")
    grown = credence.simulate(filters.drawn, trials=60, output="near.h5", resume=True)
    assert pathlib.Path("near.h5").is_symlink()
    assert sorted(path.name for path in pathlib.Path("far").iterdir()) == ["away.h5", "away.h5.trials"]
    assert (study.arm("run").read("trial").size, grown.trials) == (60, 60)


def test_covariances_that_are_the_same_in_all_trials_take_little_room():
    """500 trials, whose S is the same in all or NaN where nothing is seen: 188 MB of numbers."""
    steps, m = 60, 28

    def run(rng):
        innovation = {"innovation": rng.standard_normal((steps, m))}
        return filters.drawn(rng, steps=steps, innovation_covariance=np.broadcast_to(S, (steps, m, m)), **innovation)

    root = np.random.default_rng(1).standard_normal((m, m))
    S = root @ root.T + np.eye(m)
    study = credence.simulate(run, trials=500, output="mine.h5")
    assert study.arm("run").read("innovation_covariance").nbytes > 188e6
    assert pathlib.Path("mine.h5").stat().st_size < 20e6
    assert pathlib.Path("mine.h5.trials").stat().st_size < 50e6
    assert study.verdicts["run"]["trials"] == 500


@pytest.mark.parametrize("executor", [None, 2])
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGKILL])
def test_a_process_that_is_stopped_or_killed_has_kept_what_was_done(executor, number):
    script = f"""
        import credence, filters
        try:
            credence.simulate(filters.slow, trials=4000, output="stopped.h5", executor={executor})
        except credence.Interrupted as stopped:
            print(stopped)
            print(stopped.study.trials, stopped.study.arm("run").read("error").shape)
    """
    said, code = stopped(script, number, "stopped.h5")
    assert code == (0 if number == signal.SIGINT else -number), said
    trials = 300
    if number == signal.SIGINT:
        found = re.search(r"stopped with (\d+) of 4000 trials done; .*stopped.h5.trials has them", said)
        assert found, said
        done = int(found[1])
        assert 0 < done < 4000
        assert f"{done} ({done}, 4, 2)" in said
        trials += done
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        credence.simulate(filters.drawn, trials=trials, output="stopped.h5", resume=True)
    credence.simulate(filters.drawn, trials=trials, output="whole.h5")
    assert is_same("stopped", "whole")


def test_only_the_same_trials_are_taken():
    credence.simulate(filters.drawn, trials=20, arms=ARMS, output="kept.h5")

    def again(run=filters.drawn, trials=30, arms=ARMS, **more):
        return credence.simulate(run, trials=trials, arms=arms, output="kept.h5", **{"resume": True, **more})

    refused(r"kept.h5.trials: its trials have seed=1, not 2. Give the same", again, seed=2)
    refused(r"its trials have arms=", again, arms={"right": {}, "calm": {"scale": 0.4}})
    refused(r"its trials have batch=0, not 256", again, filters.many, batch=True)
    refused(r"until: the trials have no number speed. Take one of rmse", again, until={"speed": 1})
    refused(r"trial 0 of right gives other numbers than those that are kept. Take the function", again,
            lambda rng, scale=1: filters.drawn(rng, scale * 1.0000001))  # fmt: skip
    refused(r"cannot write .*kept.h5.trials \(it is there already\). Name another, or say resume=True", again,
            resume=False)  # fmt: skip
    pathlib.Path("kept.h5.trials").write_bytes(b"something else, and longer than a header")
    refused("is no file of simulated trials", again)


def test_two_studies_do_not_add_to_one_file():
    script = "import credence, filters; credence.simulate(filters.slow, trials=100000, output='busy.h5')"
    with started("-c", script, wait_for="busy.h5.trials"):  # it is locked before its first byte is written
        refused("another process adds trials to it", credence.simulate, filters.slow, trials=10, output="busy.h5",
                resume=True)  # fmt: skip


def test_temporary_files_go_with_the_simulation(tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    study = credence.simulate(filters.drawn, trials=30)
    assert len(list(tmp_path.iterdir())) == 1
    assert study.verdicts["run"].verdict == "undecided"
    del study
    assert list(tmp_path.iterdir()) == []

    def raises(rng):
        raise OSError("no")

    with pytest.raises(credence.Failure):
        credence.simulate(raises, trials=30)
    assert list(tmp_path.iterdir()) == []


# What goes wrong.


@pytest.mark.parametrize(("executor", "hang"), [(None, "sleep"), (2, "loop")])
def test_trials_that_go_wrong_are_failed_and_nothing_is_lost(executor, hang):
    study = credence.simulate(filters.troubled, trials=40, arms={"kf": {"hang": hang}}, timeout=0.5, executor=executor)
    reasons = {one.trial: one.reason for one in study.failures}
    assert list(reasons) == [3, 5, 9, 11, 13, 15]
    assert reasons[3] == "ValueError: x is singular"
    assert reasons[5] == "it took longer than timeout=0.5 s"
    shape = "it is of another form than the first run: error is float64 [4, 3] here, and float64 [4, 2] in trial 0"
    assert reasons[9] == shape
    assert reasons[11].startswith("it is of another form than the first run: it has 2 steps, and trial 0 has 4; Run(")
    assert reasons[13] == "TypeError: the function returned ndarray, not a credence.Run"
    assert reasons[15].startswith("InputError: covariance: is [4, 3, 3], and error has 2 components. Give arrays")
    assert "raise ValueError" in study.failures[0].traceback
    assert "_trials.py" not in study.failures[0].traceback
    assert study.verdicts["kf"]["failed_trials"] == 7  # and trial 7, whose numbers are NaN
    assert study.verdicts["kf"].verdict == "failed"
    assert "6 without a result, the first: trial 3 of kf: ValueError: x is singular" in str(study)
    error = study.arm("kf").read("error")
    good = [trial for trial in range(40) if trial not in (*reasons, 7)]
    assert np.isfinite(error[good]).all()
    assert np.isnan(error[[*reasons, 7]]).all()
    assert study.arm("kf").read("failure")[5].decode() == reasons[5]


def test_a_share_of_failures_may_be_allowed():
    def run(rng):
        if filters.number_of(rng) == 3:
            raise ValueError
        return filters.drawn(rng)

    assert credence.simulate(run, trials=40).verdicts["run"].verdict == "failed"
    assert credence.simulate(run, trials=40, failed="5%").verdicts["run"].verdict != "failed"


def of_covariance(spoilt, covariance):
    covariance[2, 0, 1] += 1e-6 * spoilt
    return {}


def of_time(spoilt, covariance):
    return {"time": np.array([0.0, 1.0, 3.0, 2.0 if spoilt else 4.0])}


def of_halves(spoilt, covariance):
    """Halves may be asymmetric by 16 of their epsilons."""
    own = {name: np.broadcast_to(np.eye(n, dtype="f2"), (4, n, n)).copy() for n, name in enumerate("ab", 1)}
    own["b"][3, 0, 1] = 0.05 if spoilt else 0.01
    return {"groups": {"a": [0], "b": [0, 1]}, "group_covariance": own}


@pytest.mark.parametrize("batch", [False, 64])
@pytest.mark.parametrize(
    ("fault", "said"),
    [
        (of_covariance, "covariance: step 2 (counted from 0) is not symmetric: [0, 1] is 1e-06, [1, 0] is 0. Write"),
        (of_time, "time: step 3 (counted from 0) has 2, and the time before is 3. Write times that"),
        (of_halves, "group/b/covariance: step 3 (counted from 0) is not symmetric: [0, 1] is 0.0"),
    ],
)
def test_a_trial_that_judge_would_refuse_has_failed_with_its_reason(fault, said, batch):
    mended = []

    def single(rng):
        error, covariance = rng.standard_normal((4, 2)), np.broadcast_to(np.eye(2), (4, 2, 2)).copy()
        return credence.Run(error, covariance, **fault(not mended and np.array_equal(error, spoilt), covariance))

    def many(rngs):
        runs = [single(rng) for rng in rngs]

        def together(name):
            return np.array([run.arrays[name] for run in runs])

        own = {name.split("/")[1]: together(name) for name in runs[0].arrays if name.startswith("group/")}
        plain = {name: together(name) for name in runs[0].arrays if not name.startswith("group/")}
        return credence.Run(**plain, group_covariance=own, groups=runs[0].texts.get("groups"))

    spoilt = filters.drawn(_trials.generator(1, 137)).arrays["error"]
    for trials in (300, 320):
        study = credence.simulate(many if batch else single, trials=trials, batch=batch, output="a.h5", resume=True)
        assert [one.trial for one in study.failures] == [137]
        assert study.failures[0].reason.startswith(f"InputError: {said}")
        assert study.verdicts["run"]["failed_trials"] == 1
        assert study.verdicts["run"].verdict != "failed"
        assert np.isnan(study.arm("run").read("error")[137]).all()
        mended.append(True)  # what was kept of the others is the same


def test_a_function_that_always_fails_stops_the_study():
    calls = []

    def run(rng):
        calls.append(1)
        return 1 / 0

    with pytest.raises(credence.Failure, match="the first 20 trials of run all failed") as raised:
        credence.simulate(run, trials=100_000)
    assert "ZeroDivisionError" in str(raised.value)
    assert len(calls) < 2000


def test_the_length_of_a_run_may_differ_where_it_says_so():
    def run(rng):
        steps = int(rng.integers(3, 8))
        error = rng.standard_normal((steps, 2))
        return credence.Run(error, np.broadcast_to(np.eye(2), (steps, 2, 2)), steps=steps)

    study = credence.simulate(run, trials=300)
    assert study.failures == []
    assert study.verdicts["run"]["failed_trials"] == 0
    steps = study.arm("run").read("steps")
    assert set(steps.tolist()) == {3, 4, 5, 6, 7}
    assert np.isnan(study.arm("run").read("error")).sum() == 2 * (7 - steps).sum()


def test_what_does_not_repeat_itself_is_noticed():
    np.random.seed(1)
    with pytest.warns(UserWarning, match="trial 0 of run gives other numbers from the same generator a second time"):
        study = credence.simulate(lambda rng: filters.drawn(np.random), trials=30)
    assert not study.is_repeatable
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert credence.simulate(filters.drawn, trials=30).is_repeatable


def test_arrays_may_be_used_again():
    error, covariance = np.zeros((4, 2)), np.broadcast_to(np.eye(2), (4, 2, 2)).copy()

    def run(rng):
        rng.standard_normal(out=error)
        return credence.Run(error, covariance)

    kept = credence.simulate(run, trials=30).arm("run").read("error")
    assert np.array_equal(kept, credence.simulate(filters.drawn, trials=30).arm("run").read("error"))


@pytest.mark.parametrize(
    ("run", "said"),
    [
        (lambda rng: credence.Run(np.zeros((4, 2)), np.arange(16.0).reshape(4, 2, 2)), "trial 0 of run: covariance: "),
        (lambda rng: filters.drawn(rng, groups={"a b": [0]}), "trial 0 of run: "),
        (lambda rng: filters.drawn(rng, groups={"pose": [0, 7]}), "trial 0 of run: "),
        (lambda rng: filters.drawn(rng, component_names=["x"]), "trial 0 of run: "),
    ],
)
def test_what_cannot_be_judged_is_refused_at_trial_0(run, said):
    calls = []

    def counted(rng):
        calls.append(1)
        return run(rng)

    assert refusal(credence.simulate, counted, trials=1000).startswith(said)
    assert len(calls) == 2


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"trials": 0}, "invalid trials=0 (must be a whole number from 1 to 9007199254740992). Give one in that range"),
        ({"trials": 2.5}, "invalid trials=2.5 "),
        ({"seed": -1}, "invalid seed=-1 "),
        ({"seed": 2**64}, f"invalid seed={2**64} "),
        ({"batch": 0}, "invalid batch=0 "),
        ({"timeout": 0}, "invalid timeout=0 (must be a number above 0"),
        ({"arms": {}}, "invalid arms (there is none). "),
        ({"arms": {"../x": {}}}, "invalid arms (../x is no name of letters"),
        ({"arms": {"x": 3}}, "invalid arms (x has no dict of options)"),
        ({"executor": 0}, "invalid executor=0 "),
        ({"executor": "dask"}, "invalid executor of str (it has no submit). "),
        ({"failed": "some"}, "invalid failed=some "),
        ({"failed": 2}, "invalid failed=2 "),
        ({"resume": True}, "cannot resume (there is no output). "),
        ({"until": {"nees_ratio": "-1%"}}, "invalid until=nees_ratio=-1% (no half-width above 0). "),
        ({"until": "nees_ratio"}, "invalid until=nees_ratio"),
        ({"until": {"rmse[a-b]": 1}}, "invalid until=rmse[a-b]=1 (there are no two such arms). "),
        ({"until": {"speed": 1}}, "until: the trials have no number speed. Take one of rmse, nees_ratio."),
    ],
)
def test_bad_input_is_refused(given, said):
    assert refusal(credence.simulate, filters.drawn, **{"trials": 300, **given}).startswith(said)
    assert list(pathlib.Path.cwd().iterdir()) == []


def test_a_run_says_what_does_not_fit():
    error, P = np.ones((4, 2)), np.ones((4, 2, 2))
    for given, more, said in [
        ((error, P[:3]), {}, r"covariance: is \[3, 2, 2\], and error is \[4, 2\]. Give the same steps"),
        ((error[:, 0], P), {}, r"error: is \[4\], and has 1 dimensions in place of 2"),
        ((None, P), {}, "a Run has neither error, nor truth"),
        (([["a"]], P[:1, :1, :1]), {}, "error is an array of <U1, which does not hold numbers"),
        ((error, error), {"steps": 5}, "steps: is not a whole number from 1 to 4"),
        ((error, error), {"columns": {"a": [1, 2]}}, "column/a: is no number of a trial"),
    ]:
        with pytest.raises(credence.Failure, match=said):
            credence.simulate(lambda rng, given=given, more=more: credence.Run(*given, **more), trials=1)


def test_a_run_is_made_of_a_record_of_one_trial():
    given = records.corpus()["names"]
    one = {name: value[:1] if isinstance(value, np.ndarray) else value for name, value in given.items()}
    run = credence.Run.of_record({**one, "steps": np.array([records.STEPS]), "time": np.arange(records.STEPS)})
    assert np.array_equal(run.arrays["error"], given["error"][0])
    assert run.arrays["time"].shape == (records.STEPS,)
    assert run.texts == {name: given[name] for name in ("component_names", "component_units")}
    assert run.steps is None
    assert "error: has 40 trials. Give one" in refusal(credence.Run.of_record, given)


# Copies.


@pytest.mark.parametrize("executor", [None, 2])
def test_a_function_that_does_not_use_its_generator_is_refused(executor):
    def fixed(rng):
        return filters.drawn(np.random.default_rng(1))

    said = refusal(credence.simulate, fixed, trials=300, executor=executor)
    assert said.startswith("the first 20 trials of run have the same errors, to the last bit: the function does not us")
    assert "the first 2 trials of" in refusal(credence.simulate, fixed, trials=2)
    assert credence.simulate(fixed, trials=1).failures == []

    def of_one_number(rng):
        return credence.Run(np.ones((1, 1)), np.ones((1, 1, 1)), time=[0.0])

    assert credence.simulate(of_one_number, trials=30).verdicts["run"]["failed_trials"] == 0


def test_few_seeds_are_copies():
    """Of 30 seeds for 300 trials; the verdict rests on those that are distinct."""

    def run(rng):
        return filters.drawn(np.random.default_rng(rng.integers(30)))

    study = credence.simulate(run, trials=300)
    verdict, error = study.verdicts["run"], study.arm("run").read("error")
    distinct = np.unique(error.reshape(300, -1), axis=0)
    assert (verdict.verdict, verdict["failed_trials"]) == ("failed", 300 - len(distinct))
    assert f"Only {len(distinct)} of the 300 runs are distinct: {300 - len(distinct)} have the errors" in str(study)
    alone = credence.judge(distinct.reshape(-1, 4, 2), np.broadcast_to(np.eye(2), (len(distinct), 4, 2, 2)))
    ratio = study.arm("run").judge(failed=0.95)["groups"][0]["nees_ratio"]
    assert ratio == pytest.approx(alone["groups"][0]["nees_ratio"], rel=1e-12)


# Batches, precision, and what a simulation says.


def test_batches_are_whole_and_give_the_same_bits():
    single = credence.simulate(filters.drawn, trials=300, arms=ARMS, output="single.h5")
    sizes = []

    def many(rngs, **options):
        sizes.append(len(rngs))
        return filters.many(rngs, **options)

    credence.simulate(many, trials=150, arms=ARMS, output="batch.h5", batch=64)
    credence.simulate(many, trials=300, arms=ARMS, output="batch.h5", batch=64, resume=True)
    assert set(sizes) == {64}
    assert is_same("single", "batch")
    assert single.columns["calm"]["rmse"].shape == (300,)
    too_few = credence.Run(np.zeros((3, 4, 2)), np.zeros((3, 4, 2, 2)))
    with pytest.raises(credence.Failure, match="the function got 256 generators and returned error"):
        credence.simulate(lambda rngs: too_few, trials=30, batch=True)


def test_until_stops_at_the_first_analysis_that_is_narrow_enough():
    goal = {"nees_ratio": "3%", "rmse": 0.02}
    study = credence.simulate(filters.drawn, trials=5000, arms=ARMS, until=goal, output="a.h5")
    count, expected = 256, None
    for analysis in range(1, 10):
        alpha, widths = 0.05 / 2**analysis, []
        for name in ARMS:
            error = study.arm(name).read("error") if count <= study.trials else np.full((1, 4, 2), np.nan)
            ratio = np.mean(error[:count] ** 2, axis=(1, 2)) / ARMS[name].get("scale", 1)
            rmse = np.sqrt(np.mean(error[:count] ** 2, axis=(1, 2)))
            t = stats.t.ppf(1 - alpha / 2, count - 1) / np.sqrt(count)
            widths += [t * ratio.std(ddof=1) / ratio.mean() / 0.03, t * rmse.std(ddof=1) / 0.02]
        if max(widths) <= 1:
            expected = count
            break
        count *= 2
    assert study.trials == expected
    assert 256 < study.trials < 5000
    credence.simulate(filters.drawn, trials=study.trials, arms=ARMS, output="b.h5")
    assert is_same("a", "b")
    assert credence.simulate(filters.drawn, trials=300, until="rmse=0.0001").trials == 300
    paired = credence.simulate(filters.drawn, trials=5000, arms=ARMS, until={"rmse[calm-right]": 1e-9})
    assert paired.trials == 256  # both arms have the same errors


def test_nees_that_is_followed_is_that_of_the_verdict():
    for form in ("joint", "growing", "variances"):
        record = records.corpus()[form]
        arrays = {name: record[name] for name in ("error", "covariance")}
        ratio = _trials.metric("nees_ratio", arrays)
        whole = credence.judge(**arrays, segments="off")
        if form == "variances":
            expected = np.mean(record["error"] ** 2 / record["covariance"])
        else:
            totals = np.array(next(one for one in whole["groups"] if one["group"] == "all")["anees"]["ratio"])
            expected = totals.mean() if form == "joint" else None
        if expected is not None:
            assert np.mean(ratio) == pytest.approx(expected, rel=1e-12)
    error, covariance = np.ones((2, 3, 2)), np.broadcast_to(np.eye(2), (2, 3, 2, 2)).copy()
    covariance[1, 1] = 0
    ratios = _trials.metric("nees_ratio", {"error": error, "covariance": covariance})
    assert ratios[0] == 1
    assert np.isnan(ratios[1])
    assert _trials.metric("nees_ratio", {"error": error, "covariance": covariance, "steps": np.array([3, 1])})[1] == 1
    growing = {"error": np.array([[[2.0, np.nan], [2.0, 1.0]]]), "covariance": np.broadcast_to(np.eye(2), (1, 2, 2, 2))}
    assert _trials.metric("nees_ratio", growing).tolist() == [3.0]


def test_a_simulation_says_its_verdicts_and_compares_its_arms(program):
    study = credence.simulate(filters.drawn, trials=2000, arms=ARMS, output="mine.h5")
    assert [verdict.verdict for verdict in study.verdicts.values()] == ["consistent", "optimistic"]
    assert sorted(path.name for path in pathlib.Path().iterdir()) == ["mine.h5", "mine.h5.trials"]
    code, said, _ = program("judge", "mine.h5", "--quiet")
    assert code == 0
    *lines, hint = str(study).splitlines()
    assert said.splitlines()[1:] == lines[1:]
    assert hint == 'hint: what to change in it: credence.tune(drawn, free={"scale": (0.05, 5)}, start={"scale": 0.5})'
    with h5py.File("mine.h5") as file:
        assert file["calm/trial"][:].tolist() == list(range(2000))
        assert int(file.attrs["seed"]) == 1
        assert file.attrs["arms"] == b"right, calm"
    difference = credence.compare(study, arms=("calm", "right"))
    assert str(difference).startswith("calm - right, trial by trial: ")
    assert str(credence.compare(study)) == str(difference)
    record = os.path.abspath("mine.h5")
    assert program("compare", f"{record}:right", f"{record}:calm")[1] == str(difference)
    of_file = program("compare", record)[1]
    assert of_file.splitlines()[:6] == str(difference).splitlines()[:6]
    assert program("compare", record, "--arms=calm,right")[1] == of_file
    code, said, _ = program("judge", "mine.h5:calm", "--quiet")
    assert said.splitlines()[1:] == program("judge", study.arm("calm").path, "--quiet")[1].splitlines()[1:]
    assert "mine/calm" in said
    assert credence.judge("mine.h5:calm")["verdict"] == study.verdicts["calm"].verdict
    refused("^mine.h5: /: holds several arms. Name one as mine.h5:right or mine.h5:calm.$", credence.judge, "mine.h5")
    assert "has no arm fast" in refusal(credence.judge, "mine.h5:fast")
    code, _, said = program("judge", "mine.h5:calm", "-o", "mine.h5", "--overwrite")
    assert (code, "which is read" in said) == (2, True)
    refused(r"no arm fast\. It has right, calm", study.arm, "fast", raises=KeyError)
    refused(r"calm has no nothing\. It has column/rmse", study.arm("calm").read, "nothing", raises=KeyError)
    assert study.arm("right").judge(margin=0.5).verdict == "consistent"
    assert repr(study) == "<credence.Simulation of 2,000 trials, 0 without a result: right consistent, calm optimistic>"
    assert "<iframe" in study._repr_html_()


def test_progress_shows_the_rate_and_nees(capfd):
    credence.simulate(filters.slow, trials=700, progress=True)
    said = capfd.readouterr().err
    assert re.search(r"trials/s, NEES/n run \d\.\d{3}", said)


def test_without_h5py_it_says_so(monkeypatch):
    monkeypatch.setitem(sys.modules, "h5py", None)
    said = r"^cannot keep trials in a file of HDF5 \(.*h5py.*\). Install it: pip install h5py.$"
    refused(said, credence.simulate, filters.drawn, trials=3)


# python -m credence simulate.


def command(*words):
    done = python("-m", "credence", "simulate", *words)
    return done.returncode, done.stdout, done.stderr


def test_the_command_says_what_the_function_says():
    arms = ["--arm", "right", "--arm", "calm", "scale=0.5"]
    code, said, err = command("filters:drawn", "--trials", "2e2", *arms, "--executor", "2", "-o", "a.h5")
    assert (code, err) == (0, "")
    study = credence.simulate(filters.drawn, trials=200, arms=ARMS, output="b.h5")
    assert is_same("a", "b")
    assert said.splitlines()[1:3] == str(study).splitlines()[1:3]
    grown = command("filters:drawn", "--trials=300", *arms, "-o", "a.h5", "--resume", "--require", "no-finding")
    assert grown[0] == 1  # the calm filter is refuted
    assert command("filters:drawn", "--trials=2000", "--until", "rmse=5%", "--batch", "--quiet")[0] == 1
    assert command("filters:drawn", "--trials=300", "--require", "no-finding")[0] == 0


def test_the_command_refuses_bad_input():
    run = "filters:drawn"
    for words, expected in [
        (["mine.run"], "invalid function=mine.run (must be MODULE:FUNCTION)"),
        (["nothing_here:run"], "nothing_here:run: cannot be imported (No module named 'nothing_here')"),
        (["filters:walk"], "filters:walk: the module has no walk"),
        ([run, "--executor", "slurm"], "invalid --executor=slurm (must be a number, dask, dask:ADDRESS or mpi)"),
        ([run, "--arm", "calm", "0.5"], "invalid option 0.5 of the arm calm (must be NAME=VALUE)"),
        ([run, "--resume"], "cannot resume (there is no output)"),
    ]:
        code, said, err = command(*words, "--trials=30")
        assert (code, said) == (2, "")
        assert err.startswith(f"credence simulate: {expected}")
        assert err.count("\n") == 1


def test_a_batch_systems_signal_keeps_what_is_done():
    words = ["-m", "credence", "simulate", "filters:slow", "--trials=100000", "-o", "a.h5"]
    with started(*words, wait_for="a.h5.trials", least=2000, stderr=subprocess.PIPE) as process:
        process.terminate()
        err = process.communicate(timeout=60)[1]
    assert process.returncode == 3
    assert re.search(r"credence simulate: the simulation was stopped with \d+ of 100000 trials done; .*--resume", err)


# The page.


def test_the_example_of_the_page_comes_to_its_verdicts():
    block = re.search(r"```python\n(# tracker.py\n.+?)```", PAGE.read_text(), re.DOTALL)
    assert block is not None
    pathlib.Path("tracker.py").write_text(block[1])
    done = python("tracker.py")
    assert done.returncode == 0, done.stderr
    said = dict(re.findall(r"^ +tracker/(\w+) +(\w+)", done.stdout, re.MULTILINE))
    assert said == {"right": "consistent", "calm": "optimistic"}
    assert "calm - right, trial by trial" in done.stdout
    words = re.search(r"`python -m credence (simulate tracker:run [^`]+)`", " ".join(PAGE.read_text().split()))
    assert words is not None
    code, again, _ = command(*words[1].replace("1500", "100").replace("tracker.h5", "again.h5").split()[1:])
    assert code == 0
    assert re.search(r"again/calm +optimistic", again)
