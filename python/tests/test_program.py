"""Commands of the program as functions."""

from __future__ import annotations

import functools
import gc
import json
import os
import pathlib
import signal
import subprocess
import threading
import time

import h5py
import numpy as np
import pytest
from conftest import SCENARIO, python, refusal, refused, started

import credence


def contents(path):
    """Every dataset and attribute of a results file but those of /run, which say when and where."""
    found = {}

    def note(name, thing):
        if name.split("/")[0] == "run":
            return
        if isinstance(thing, h5py.Dataset):
            found[name] = (thing.dtype, thing.shape, thing[()].tobytes())
        for key, value in thing.attrs.items():
            if key not in ("REFERENCE_LIST", "DIMENSION_LIST"):
                found[f"{name}@{key}"] = np.asarray(value).tobytes()

    with h5py.File(path) as file:
        note("", file)
        file.visititems(note)
    return found


def test_run_writes_what_the_program_writes(scenario, tmp_path, program):
    words = ["--trials=600", "--seed=3", "--set=noise.heading=0.02", "--sweep=sensor.sigma=0.1,0.2"]
    assert program("run", scenario, *words, "-o", tmp_path / "program.h5")[0] == 0
    changed = {"set": {"noise.heading": 0.02}, "sweep": {"sensor.sigma": [0.1, 0.2]}}
    study = credence.run(scenario, trials=600, seed=3, **changed, output=tmp_path / "package.h5")
    assert study.complete
    theirs, ours = contents(tmp_path / "program.h5"), contents(tmp_path / "package.h5")
    assert len(ours) > 100
    assert ours == theirs


def test_a_study_without_an_output_goes_with_its_file():
    study = credence.run(SCENARIO, trials=256)
    path = study.path
    assert os.path.exists(path)
    del study
    gc.collect()
    assert not os.path.exists(path)


def test_resume_goes_on_with_the_stored_study(scenario, tmp_path):
    credence.run(scenario, trials=256, seed=5, output=tmp_path / "grown.h5")
    grown = credence.resume(tmp_path / "grown.h5", trials=512)
    credence.run(scenario, trials=512, seed=5, output=tmp_path / "whole.h5")
    assert grown.trials == 512
    assert contents(tmp_path / "grown.h5") == contents(tmp_path / "whole.h5")


def test_until_stops_at_a_precision_and_warns_where_it_is_not_reached(scenario):
    study = credence.run(scenario, until={"trace_P": "20%"}, trials=100_000)
    assert study.trials == 4096
    with pytest.warns(UserWarning, match="not as precise as asked"):
        credence.run(scenario, until="trace_P=0.0001%", trials=4096)


def test_compare_report_and_replay_say_what_the_program_says(scenario, tmp_path, program):
    path = tmp_path / "study.h5"
    study = credence.run(scenario, trials=256, output=path)
    comparison = credence.compare(study, arms=("greedy", "fixed"))
    assert comparison.json == json.loads(program("compare", path, "--arms=greedy,fixed", "--format=json")[1])
    assert str(comparison) == program("compare", path, "--arms=greedy,fixed")[1]
    assert comparison.html.startswith("<!")
    expected = json.loads(program("report", path, "--margin=0.2", "--format=json")[1])
    assert credence.report(path, margin=0.2).json == expected
    (trial,) = credence.replay(study, scenario="small", arm="fixed", trial=17)
    words = ["--scenario=small", "--arm=fixed", "--trial=17", "--format=json"]
    (printed,) = json.loads(program("replay", path, *words)[1])
    assert trial.columns["trace_P"] == printed["trace_P"]
    assert trial.trial == 17
    refused("invalid trial=256", credence.replay, study, scenario="small", arm="fixed", trial=256)


def test_show_resolves_a_scenario(scenario, program):
    changed = program("show", scenario, "--set=noise.heading=0.5")[1]
    assert credence.show(scenario, set={"noise.heading": 0.5}) == changed
    assert credence.show() == program("show")[1]


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: credence.run("[scenario]\nposes = -1\n"), "invalid scenario.poses=-1"),
        (lambda: credence.run("missing.ini"), "missing.ini"),
        (lambda: credence.run(SCENARIO, trials=0), "invalid trials=0 (must be a whole number from 1 to"),
        (lambda: credence.compare("/missing.h5"), "/missing.h5: the file: cannot be found"),
        (lambda: credence.judge("/missing.h5"), "/missing.h5: the file: cannot be found"),
        (lambda: credence.show(SCENARIO, set={"noise.haeding": 1}), "noise.heading"),
    ],
)
def test_what_cannot_be_used_is_refused(call, message):
    assert message in refusal(call)


def test_refusals_name_what_python_does(scenario, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    study = credence.run(scenario, trials=256, output="study.h5", set={"arms.controllers": "fixed"})
    other = credence.run(scenario, trials=256, output="other.h5", set={"arms.controllers": "greedy"})
    totals = [credence.run(scenario, trials=256, keep="aggregates") for _ in range(2)]
    pathlib.Path("my own.ini").write_text("[scenario]\nposes = 3\n")
    pathlib.Path("x.journal").write_text("credence-journal")
    pathlib.Path("--set").mkdir()
    pathlib.Path("--set/--force").write_text("")
    with h5py.File("noise.h5", "w") as file:
        file["odometry"] = file["measurement"] = 0.0
    run = functools.partial(credence.run, scenario)
    for call, said in (
        (lambda: run(output="study.h5"), "Give another name, credence.resume() or overwrite=True."),
        (lambda: run(output="./--set/--force"), "cannot write ./--set/--force (it is there already). "),
        (lambda: run(output="x.html"), "invalid output=x.html (what is written there is HDF5). Give FILE.h5; "
                                       "credence.report() makes pages and tables of it."),
        (lambda: run(set={"noise.heading": "0,1"}), "set noise.heading: invalid noise.heading=0,1 (it has a comma, and "
                                                    "one number is wanted)."),
        (lambda: run(set={"noise.heading": "0,1"}), 'several values as sweep={"noise.heading": "0,1"}.'),
        (lambda: run(sweep={"noise.heading": [""]}), 'Write sweep={"section.key": "a,b,c"}.'),
        (lambda: run(set={"zzz": 1}), "credence.show() prints every key."),
        (lambda: run(trials=10**12), "see `credence run --dry-run`, or start it all the same with force=True."),
        (lambda: credence.report("my own.ini"), "credence.run('my own.ini') runs it."),
        (lambda: credence.report("noise.h5"), "credence.replay('SCENARIO.ini', noise='noise.h5') reads it."),
        (lambda: credence.report("x.journal"), "`credence watch x.journal` follows it, and credence.resume() resumes "
                                               "it."),
        (lambda: credence.report(study, margin_direction=0.01), "invalid margin_direction=0.01 (less than the margin). "
                                                                "Give at least margin=0.05."),
        (lambda: credence.compare(*totals), "Run it with keep='trials', or compare arms of one file."),
        (lambda: credence.compare(study, other), "Give arms='A,B' or other files: "),
    ):  # fmt: skip
        with pytest.raises(credence.InputError) as raised:
            call()
        assert said in str(raised.value)
    error = raised.value
    assert str(error) == f"{error.subject} ({error.reason}). {error.remedy}."
    with pytest.raises(credence.InputError) as raised:
        credence.report(study, bias=11)
    error = raised.value
    assert (error.subject, error.value, error.reason) == ("bias", "11", "must be above 0 and at most 10 sigmas")
    (trial,) = credence.replay(study, trial=3)  # of the only scenario and arm
    assert trial.trial == 3
    with pytest.warns(UserWarning, match="has 256 trials of each scenario already, more than trials=100"):
        credence.resume(study, trials=100)


def test_ctrl_c_keeps_what_is_done(tmp_path):
    script = f"""
        import sys, threading, time, os, signal
        import credence
        def interrupt():
            while not os.path.exists("big.h5.journal"):
                time.sleep(0.01)
            time.sleep(1)
            os.kill(os.getpid(), signal.SIGINT)
            os.kill(os.getpid(), signal.SIGINT)
        threading.Thread(target=interrupt).start()
        try:
            credence.run({SCENARIO!r}, trials=100_000_000, keep="aggregates", output="big.h5", force=True)
        except KeyboardInterrupt as stopped:
            print(stopped)
            print(stopped.study.complete, stopped.study.trials)
    """
    first, second = python("-c", script).stdout.splitlines()
    assert first.startswith("credence run: stopped by SIGINT with ")
    assert second == "False 100000000"


def test_ctrl_c_stops_the_program_as_ever(scenario, tmp_path):
    words = ["-m", "credence", "run", scenario, "--trials=100000000", "--keep=aggregates", "--force"]
    with started(*words, wait_for="credence.h5.journal", least=0, stderr=subprocess.PIPE) as run:
        time.sleep(0.5)
        run.send_signal(signal.SIGINT)
        assert "--resume" in run.communicate(timeout=60)[1]
    assert run.returncode == 3


def test_other_threads_go_on_during_a_run():
    thread = threading.Thread(target=credence.run, args=(SCENARIO,), kwargs={"trials": 20_000, "threads": 1})
    thread.start()
    count = 0
    while thread.is_alive():
        count += 1
    assert count > 1000


def test_progress_is_heard_to_its_end():
    from credence import _core

    heard = []
    with_text = pathlib.Path("small.ini")
    with_text.write_text(SCENARIO)
    options = {"trials": 600, "output": "small.h5", "quiet": True}
    _core.command("run", ["small.ini"], options, lambda *now: heard.append(now))
    assert heard[-1] == (600, 600)
    assert heard == sorted(heard)


def test_the_module_is_the_program(program):
    assert python("-m", "credence", "--version").stdout == program("--version")[1]
    wrong = python("-m", "credence", "judge", "missing.h5")
    assert (wrong.returncode, wrong.stderr) == (2, program("judge", "missing.h5")[2])


def test_importing_is_quick_and_lazy():
    script = """
        import sys, time
        start = time.process_time()
        import credence
        print(time.process_time() - start)
        print([name for name in ("numpy", "h5py", "matplotlib", "credence._core") if name in sys.modules])
    """
    seconds, imported = python("-c", script).stdout.splitlines()
    assert float(seconds) < 0.2
    assert imported == "[]"
