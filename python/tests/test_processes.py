"""What processes do around the package: folders, forks, signals, threads and ends, as odd_processes.csv says."""

from __future__ import annotations

import csv
import io
import os
import pathlib
import pickle
import re
import subprocess
import textwrap

import numpy as np
import pytest
from conftest import SCENARIO, python, refused

import credence

TABLE = pathlib.Path(__file__).with_name("odd_processes.csv")

# What happens in the middle of a call finds `long_judge` at work on most machines, and `endless_run` on all.
PREAMBLE = f"""
import os, pathlib, signal, sys, threading, time
import numpy as np
import credence
SCENARIO = {SCENARIO!r}
def judged(trials):
    error = np.random.default_rng(5).standard_normal((trials, 50, 6))
    return credence.judge(error, np.broadcast_to(np.eye(6), (trials, 50, 6, 6))).verdict
def long_judge():
    return judged(6000)
def in_thread(work, daemon=False):
    thread = threading.Thread(target=work, daemon=daemon)
    thread.start()
    time.sleep(0.3)
    return thread
def endless_run():
    credence.run(SCENARIO, trials=10**8, keep="aggregates", force=True, output="endless.h5")
def wait_for(path):
    while not os.path.exists(path):
        time.sleep(0.01)
"""


def process(script):
    """Exit code of a Python process, and what it printed on both streams; a process that hangs fails the test."""
    done = python("-c", PREAMBLE + textwrap.dedent(script), stderr=subprocess.STDOUT)
    return done.returncode, done.stdout


def refusal(call):
    """What a call raises, as the page shows it."""
    with pytest.raises((ValueError, TypeError, credence.Failure)) as raised:
        call()
    return f"{raised.type.__name__}: {raised.value}"


@pytest.fixture(autouse=True)
def _with_temporary_files_of_its_own(tmp_path, monkeypatch):
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr("tempfile.tempdir", None)


@pytest.fixture
def study():
    return credence.run(SCENARIO, trials=256, output="study.h5")


def closed(study):
    study.close()
    assert repr(study) == "<credence.Study, closed>"
    uses = [lambda: study.trials, lambda: study["fixed"]]
    calls = [*uses, lambda: credence.report(study), lambda: credence.resume(study)]
    (said,) = {refusal(call) for call in calls}
    return said


def changed_beneath(study):
    arm = study["fixed.ekf"]
    before, report = arm["trace_P"], credence.report(study)
    said_before = str(report)
    credence.run(SCENARIO, trials=512, seed=9, output="study.h5", overwrite=True)
    assert np.array_equal(arm["trace_P"], before)
    assert str(report) == said_before
    assert "256 trials" in report.html
    calls = [
        lambda: credence.report(study),
        lambda: credence.compare(study),
        lambda: credence.resume(study, trials=1024),
        lambda: credence.replay(study, scenario="scenario", arm="fixed", trial=0),
    ]
    (said,) = {refusal(call) for call in calls}
    assert credence.open("study.h5").trials == 512
    return said


def in_another_folder(study):
    os.mkdir("other")
    os.chdir("other")
    assert credence.resume(study, trials=512).path == str(pathlib.Path("../study.h5").resolve())
    return "nothing" if os.listdir() == [] else "a second file"


def pickled(study):
    return refusal(lambda: pickle.dumps(study))


def in_memory(study):
    held = credence.open(io.BytesIO(pathlib.Path(study.path).read_bytes()))
    assert np.array_equal(held["fixed.ekf"]["trace_P"], study["fixed.ekf"]["trace_P"])
    return refusal(lambda: credence.report(held))


def forked(_):
    code, said = process("""
        study = credence.run(SCENARIO, trials=256)
        thread = in_thread(long_judge)
        child = os.fork()
        if child == 0:
            signal.alarm(60)
            print(judged(300), credence.run(SCENARIO, trials=256).trials, credence.compare(study).json[0]["trials"])
            sys.exit(0)
        assert os.waitpid(child, 0)[1] == 0
        thread.join()
        print(os.path.exists(study.path))
    """)
    assert (code, said.split()[-4:]) == (0, ["consistent", "256", "256", "True"]), said
    return "waits"


def handled(_):
    code, said = process("""
        signal.signal(signal.SIGALRM, lambda *_: judged(300))
        signal.setitimer(signal.ITIMER_REAL, 0.5, 0.5)
        try:
            while True:  # until a signal finds it at work
                long_judge()
        except credence.Failure as failure:
            signal.setitimer(signal.ITIMER_REAL, 0)
            print(f"{type(failure).__name__}: {failure}")
    """)
    assert code == 0
    return said


def installed_meanwhile(_):
    code, said = process("""
        thread = in_thread(lambda: credence.run(SCENARIO, trials=100_000, threads=1))
        assert thread.is_alive()
        signal.signal(signal.SIGTERM, lambda *_: print("caught"))
        thread.join()
        os.kill(os.getpid(), signal.SIGTERM)
        time.sleep(0.1)
    """)
    assert (code, said) == (0, "caught\n")
    return "stays"


def ended(_):
    for work in ("long_judge", "endless_run"):
        code, said = process(f"""
            in_thread({work}, daemon=True)
            if {work} is endless_run:
                wait_for("endless.h5.journal")
            sys.exit(7)
        """)
        assert code == 7, said
    assert os.path.exists("endless.h5")
    assert credence.open("endless.h5").complete is False
    return "exit code"


def left(_):
    code, said = process("""
        import ctypes
        thread = in_thread(endless_run, daemon=True)
        wait_for("endless.h5.journal")
        ctypes.CDLL(None).exit(0)
    """)
    assert code == 1
    return said


def interrupted(_):
    code, said = process("""
        def interrupt():
            while not list(pathlib.Path().glob("credence-*/*.journal")):
                time.sleep(0.01)
            for _ in range(3):
                os.kill(os.getpid(), signal.SIGINT)
                time.sleep(0.2)
        threading.Thread(target=interrupt).start()
        credence.run(SCENARIO, trials=10**8, keep="aggregates", force=True)
    """)
    assert "KeyboardInterrupt" in said or "Interrupted" in said
    assert code != 0
    assert list(pathlib.Path().glob("credence-*")) == []
    return "removed"


def with_decimal_commas(_):
    """What is said in a locale that is made here: a system need not have one."""
    pathlib.Path("ascii").write_text("<escape_char> /\nCHARMAP\n<U0000>..<U007F> /x00 ASCII\nEND CHARMAP\n")
    pathlib.Path("commas").write_text('LC_NUMERIC\ndecimal_point ","\nthousands_sep "."\nEND LC_NUMERIC\n')
    subprocess.run(["localedef", "-cf", "./ascii", "-i", "./commas", "./xx_XX"], capture_output=True, check=False)
    credence.run(SCENARIO, trials=5000, set={"noise.heading": 0.2}, output="noisy.h5")
    said = {}
    for name in ("C", "xx_XX"):
        code, said[name] = process(f"""
            import locale
            os.environ["LOCPATH"] = os.getcwd()
            locale.setlocale(locale.LC_ALL, {name!r})
            assert locale.localeconv()["decimal_point"] == {"." if name == "C" else ","!r}
            error = 1.3 * np.random.default_rng(5).standard_normal((400, 30, 2)) + 0.2
            ones = np.broadcast_to(np.eye(2), (400, 30, 2, 2))
            verdict = credence.judge(error, ones, innovation=error, innovation_covariance=ones)
            for one in (credence.report("noisy.h5"), credence.compare("noisy.h5"), verdict):
                print(one, one.html, one.json)
            table, trial = {{"format": "csv"}}, {{"scenario": "scenario", "arm": "fixed", "trial": 3}}
            for name, options in (("report", table), ("compare", table), ("replay", trial)):
                print(credence._core.command(name, ["noisy.h5"], options, None))
            print(credence.show(SCENARIO, set={{"noise.heading": 0.25}}))
            credence.run(SCENARIO, trials=8192, until="trace_P=1e-9")  # which is warned of
        """)
        assert code == 0, said[name]
    return "no other number" if said["C"] == said["xx_XX"] else said["xx_XX"]


CASES = {
    "A study that is closed": closed,
    "A study whose file was changed, replaced or removed since it was opened": changed_beneath,
    "A study in a process that changes its folder": in_another_folder,
    "A study that is pickled or copied": pickled,
    "A study in memory (`io.BytesIO`)": in_memory,
    "`os.fork` or a forked pool while another thread is in a call": forked,
    "A signal handler that calls credence in the middle of a call": handled,
    "A signal handler that is installed while another thread runs a study": installed_meanwhile,
    "The end of Python while a daemon thread is in a call": ended,
    "`exit()` of a C or C++ library in the middle of a call": left,
    "Ctrl-C, once or more, in a run without `output`": interrupted,
    "A locale with decimal commas": with_decimal_commas,
}


def rows():
    """{what: what it gets} of the table."""
    with TABLE.open(encoding="utf-8", newline="") as file:
        return dict(list(csv.reader(file))[1:])


def test_the_table_of_odd_processes_has_the_tested_cases():
    assert list(rows()) == list(CASES)


@pytest.mark.parametrize("what", CASES)
def test_an_odd_process_gets_what_the_table_says(what, study):
    found = CASES[what](study)
    promised = re.findall(r"\*([^*]+)\*", rows()[what])  # messages and outcomes are in italics
    assert promised
    for words in promised:
        assert words in found


def test_a_report_is_computed_when_it_is_made(study):
    report, comparison = credence.report(study), credence.compare(study)
    pathlib.Path("study.h5").unlink()
    assert report.json[0]["trials"] == 256
    assert "256 trials" in str(report)
    assert "256 trials" in report.html
    assert "trial by trial" in str(comparison)


def test_a_folder_of_a_run_that_is_interrupted_while_it_is_opened_is_removed(tmp_path, monkeypatch):
    def interrupt(_):
        raise KeyboardInterrupt

    monkeypatch.setattr("credence.study.open", interrupt)
    with pytest.raises(KeyboardInterrupt):
        credence.run(SCENARIO, trials=256)
    assert list(tmp_path.glob("credence-*")) == []


def test_a_fork_leaves_the_temporary_file_of_its_parent():
    code, said = process("""
        study = credence.run(SCENARIO, trials=256)
        child = os.fork()
        if child == 0:
            sys.exit(0)
        os.waitpid(child, 0)
        print(os.path.exists(study.path))
    """)
    assert (code, said) == (0, "True\n")


def test_a_call_that_waits_for_its_turn_hears_signals():
    code, said = process("""
        def late(*_):
            raise TimeoutError
        signal.signal(signal.SIGALRM, late)
        thread = in_thread(endless_run, daemon=True)
        wait_for("endless.h5.journal")
        signal.setitimer(signal.ITIMER_REAL, 0.3)
        try:
            judged(300)
        except TimeoutError:
            print("late", thread.is_alive())
    """)
    assert (code, said) == (0, "late True\n")


def test_what_python_calls_at_its_end_may_call_credence_and_fork():
    code, said = process("""
        import atexit
        def last():
            child = os.fork()
            print(judged(300), flush=True)
            if child == 0:
                os._exit(0)
            os.waitpid(child, 0)
        atexit.register(last)
        judged(300)
    """)
    assert (code, said.count("consistent")) == (0, 2), said


def test_a_run_does_not_replace_its_own_scenario():
    pathlib.Path("own.ini").write_text(SCENARIO)
    refused(r"it would replace own\.ini, which is read", credence.run, "own.ini", output="own.ini", overwrite=True)
    assert pathlib.Path("own.ini").read_text() == SCENARIO
