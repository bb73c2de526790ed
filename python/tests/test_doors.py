"""What is refused at the edge of the package, by every function and every command, and how it is said."""

from __future__ import annotations

import concurrent.futures
import functools
import inspect
import os
import pathlib
import pty
import signal
import subprocess
import sys
import textwrap
import time

import numpy as np
import pytest
from conftest import SCENARIO, environment, python, refusal, refused

import credence

ERROR, P = np.zeros((30, 2, 1)), np.ones((30, 2, 1, 1))


def run(rng, q=1.0):
    return credence.Run(rng.standard_normal((3, 1)), np.full((3, 1, 1), q))


class Odd:
    def __repr__(self):
        return "<odd\nthing>"


@pytest.fixture(autouse=True)
def _with_a_module(_in_a_folder_of_its_own):
    pathlib.Path("mine.py").write_text(textwrap.dedent("""
        import time, numpy as np, credence
        def run(rng, q=1.0, seconds=0.0):
            time.sleep(seconds)
            return credence.Run(rng.standard_normal((3, 1)), np.full((3, 1, 1), q))
        def log(q):
            raise OSError(28, "No space left on device")
        """))


# Arguments. Whatever is no value of an argument is refused by its name, before any work.

NO_PATH = [5, -1, 1.5, b"x", [], {}, None, True, Odd(), "", "a\0b", np.ones(3), lambda: 0]
NO_OUTPUT = [*NO_PATH[:6], *NO_PATH[7:], "missing/x.h5", "mine.py/x.h5", "."]
NO_WHOLE = ["many", -1, 1.5, float("nan"), float("inf"), 10**400, True, [], {}, b"1", Odd(), np.ones(3), 1j]
NO_FLAG = [5, "yes", [], {}, Odd(), np.ones(3), 1.0]
NO_DICT = [5, "text", b"x", [5], True, Odd(), {5: 5}, {"": 1}, np.ones(3), lambda: 0]
NO_TEXT = [5, b"x", [], {}, True, Odd(), "", "\udcff", np.ones(3)]
NO_NUMBER = ["many", float("nan"), float("inf"), -1, 0, b"1", [], {}, Odd(), 1j]
NO_GOALS = [5, b"x", [], [5], True, Odd(), {5: 5}, {"nees_ratio": None}, {"nees_ratio": 0}, "", "nees_ratio", "a=b"]
NO_EXECUTOR = [0, -1, 1.5, "two", b"x", [], {}, True, Odd(), np.ones(3)]
NO_FILE = [*NO_PATH, object()]
NO_SHARE = ["many", float("nan"), -1, b"1", [5], {}, Odd(), "\udcff"]

FUNCTIONS = {
    "run": (credence.run, {"path_or_text": SCENARIO, "trials": 4}),
    "merge": (credence.merge, {"paths": ["a.h5"]}),
    "resume": (credence.resume, {"study": "a.h5"}),
    "replay": (credence.replay, {"study": "a.h5"}),
    "report": (credence.report, {"study": "a.h5"}),
    "compare": (functools.partial(credence.compare, "a.h5"), {}),
    "show": (credence.show, {"path_or_text": SCENARIO}),
    "judge": (credence.judge, {"error": ERROR, "covariance": P}),
    "assert_consistent": (credence.assert_consistent, {"error": ERROR, "covariance": P}),
    "simulate": (credence.simulate, {"run": run, "trials": 4}),
    "tune": (credence.tune, {"what": run, "free": {"q": (0.5, 2)}, "trials": 4}),
    "open": (credence.open, {}),
    "open_trajectories": (credence.open_trajectories, {}),
    "plot": (credence.plot, {"what": "a.h5"}),
    "animate": (credence.animate, {"what": "a.h5"}),
}
OF_RUN = {
    "trials": [*NO_WHOLE, 0], "seed": [*NO_WHOLE, 2**64], "threads": [*NO_WHOLE, 0], "set": NO_DICT,
    "sweep": [*NO_DICT, {"noise.heading": 5}], "planners": [*NO_DICT, {"a.b": print}, {"mine": 5}],
    "until": NO_GOALS, "output": NO_OUTPUT, "overwrite": NO_FLAG,
    "keep": [*NO_TEXT, "everything"], "force": NO_FLAG, "executor": NO_EXECUTOR, "shards": [*NO_WHOLE, 0],
    "progress": NO_FLAG,
}  # fmt: skip
BAD = {
    "run": {"path_or_text": [*NO_PATH, [5]], **OF_RUN},
    "merge": {"paths": [*NO_PATH, [5]], **{one: OF_RUN[one] for one in ("output", "overwrite", "progress")}},
    "resume": {"study": NO_FILE,
               **{one: OF_RUN[one] for one in ("trials", "threads", "planners", "until", "progress")}},
    "replay": {"study": NO_FILE, "scenario": NO_TEXT, "arm": NO_TEXT, "trial": NO_WHOLE, "noise": NO_OUTPUT[:5],
               **{one: OF_RUN[one] for one in ("set", "planners", "output", "overwrite")}},
    "report": {"study": NO_FILE, "margin": [*NO_SHARE, 0, 1], "margin_direction": [*NO_SHARE, 0, 1], "bias": NO_SHARE,
               "failed": NO_SHARE},
    "compare": {"arms": [5, b"x", [], {}, True, Odd(), "", [5]], "failed": NO_SHARE},
    "show": {"path_or_text": NO_OUTPUT[:6], "set": OF_RUN["set"], "sweep": OF_RUN["sweep"]},
    "judge": {"margin": [*NO_SHARE, 0, 1], "margin_direction": [*NO_SHARE, 0, 1], "bias": NO_SHARE, "failed": NO_SHARE,
              "segments": [*NO_SHARE, "0", 1.5], "groups": [5, {5: [0]}, {"a": Odd()}, [5], "\udcff"],
              "component_names": [5, [5], ["\udcff"]], "component_units": [5, [5]], "name": NO_TEXT[:7],
              "progress": NO_FLAG, "group_covariance": NO_DICT, "group_nees": NO_DICT, "manifold": [5, [], "SE3"],
              "chart": [5, "local"], "quaternion": [5, "wxyz"], "columns": NO_DICT,
              "truth_sigma": [-1, "a=b"], "truth_covariance": [np.eye(7)], "truth_dependent": [True]},
    "assert_consistent": {"within": [*NO_SHARE, 0, 1], "strict": NO_FLAG},
    "simulate": {"run": [None, 5, "x", Odd()], "arms": [[], 5, "calm", {"calm": 5}, {5: {}}, {}, {"a b": {}}],
                 "batch": [*NO_WHOLE[:6], 0, [], {}, Odd()], "resume": [*NO_FLAG, True], "failed": NO_SHARE,
                 "timeout": NO_NUMBER, **{one: OF_RUN[one] for one in ("trials", "seed", "executor", "output", "until",
                                                                      "progress")}},
    "tune": {"what": [None, 5, Odd(), [run]], "objective": [*NO_TEXT, "rmse"], "start": [*NO_DICT, {"q": None}],
             "free": [None, 5, "q", b"q", [], {}, [5], {5: (1, 2)}, {"q": 5}, {"q": (2, 1)}, {"u": (1, 2)}, Odd(),
                      {"q": (0, float("nan"))}, {"q": None}],
             "batch": [*NO_WHOLE[:6], 0, [], {}, Odd()], "held_out": NO_WHOLE, "arm": NO_TEXT, "program": NO_OUTPUT[:6],
             **{one: OF_RUN[one] for one in ("trials", "seed", "executor", "progress")}},
    "open": {"source": NO_PATH},
    "open_trajectories": {"source": NO_PATH},
    "plot": {"what": NO_FILE, "kind": NO_TEXT, "scenario": NO_TEXT, "arms": [5, [], {}, [5], Odd()],
             "width": NO_NUMBER, "path": NO_OUTPUT, "title": NO_FLAG},
    "animate": {"what": NO_FILE, "path": NO_OUTPUT, "trial": NO_WHOLE, "scenario": NO_TEXT, "arm": NO_TEXT,
                "ellipse": NO_TEXT, "frames_per_second": [*NO_WHOLE, 0], "credence": NO_OUTPUT[:6],
                "progress": NO_FLAG},
}  # fmt: skip
NOT_HERE = {  # arrays, whose odd values are in test_odd_inputs.py
    "judge": {"error", "covariance", "innovation", "innovation_covariance", "row_groups", "steps", "time", "runs",
              "truth", "estimate", "nees", "dimension"},
}  # fmt: skip


@pytest.mark.parametrize(("function", "argument"), [(name, one) for name, table in BAD.items() for one in table])
def test_what_is_no_value_of_an_argument_is_refused_by_its_name(function, argument):
    call, others = FUNCTIONS[function]
    before = sorted(os.listdir())
    for value in BAD[function][argument]:
        said = refusal(call, raises=(credence.InputError, TypeError), **{**others, argument: value})
        assert argument in said, f"{function}({argument}={value!r}): {said}"
        assert said.endswith((".", "?")), f"{function}({argument}={value!r}): {said}"
    assert sorted(os.listdir()) == before


def test_every_argument_is_in_the_table():
    for name, (function, _) in FUNCTIONS.items():
        there = {one.name for one in inspect.signature(function).parameters.values() if one.kind not in (2, 4)}
        assert there - NOT_HERE.get(name, set()) == BAD[name].keys(), name


def test_what_has_verdicts_of_its_own_is_not_judged():
    simulation = credence.simulate(run, 25)
    study = credence.run(SCENARIO, trials=256)
    refused("Take its verdicts.$", credence.judge, simulation)
    refused("Take its verdict.$", credence.judge, simulation.arm("run"))
    refused(r"Take credence.report\(study\).$", credence.judge, study)


def test_without_the_compiled_module_files_are_read_and_drawn():
    credence.run(SCENARIO, trials=256, output="study.h5")
    script = """
import sys
sys.modules["credence._core"] = None
import credence
study = credence.open("study.h5")
credence.plot(study, "nees", path="nees.png")
try:
    credence.plot("study.h5", path="missing/nees.png")
except ValueError as error:
    print(error)
"""
    done = python("-c", script)
    assert done.stdout.startswith("cannot write path=missing/nees.png (there is no folder")
    assert pathlib.Path("nees.png").exists()


# What the system refuses.


def test_a_pool_that_is_closed_is_refused():
    with concurrent.futures.ThreadPoolExecutor(1) as pool:
        pass
    for call in (lambda: credence.simulate(run, 4, executor=pool),
                 lambda: credence.tune(run, {"q": (0.5, 2)}, trials=4, executor=pool),
                 lambda: credence.run(SCENARIO, trials=4, executor=pool)):  # fmt: skip
        assert refusal(call).startswith("invalid executor of ThreadPoolExecutor (cannot schedule new futures")


def test_a_precision_that_is_not_reached_is_said():
    missed = r"not as precise as asked at the ceiling of 40 trials \(nees_ratio=1%\)"
    with pytest.warns(UserWarning, match=missed) as said:
        credence.simulate(run, 40, until={"nees_ratio": "1%"})
    assert said[0].filename == __file__


def test_what_is_noted_is_at_the_line_that_called():
    kept = []

    def repeats_nothing(rng):
        kept.append(0.0)
        return credence.Run(rng.standard_normal((3, 1)) + len(kept), np.ones((3, 1, 1)))

    pandas = pytest.importorskip("pandas")
    errors = pandas.DataFrame(np.random.default_rng(1).standard_normal((60, 2)))
    for call in (lambda: credence.judge(errors, np.ones((60, 2))), lambda: credence.simulate(repeats_nothing, 4),
                 lambda: credence.run(SCENARIO, until="trace_P=0.0001%", trials=256),
                 lambda: credence.tune(run, {"q": (0.5, 2)}, trials=4, objective="nees", held_out=30)):  # fmt: skip
        with pytest.warns(UserWarning, match=".") as said:
            call()
        assert {one.filename for one in said} == {__file__}


def test_a_log_whose_filter_fails_is_said():
    def fails(q):
        raise OSError(28, "No space left on device")

    with pytest.raises(credence.Failure, match=r"the function failed with q=1 \(OSError: .*No space"):
        credence.tune(fails, {"q": (0.5, 2)})


# Commands.


def command(*words, before="", stdout=subprocess.PIPE, **options):
    """Exit code and both streams of a command; `before` are words of a shell that come before it."""
    here = environment(pathlib.Path.cwd())
    told = ["bash", "-c", f'{before} exec "$0" -m credence "$@"', sys.executable, *words]
    done = subprocess.run(told, stdout=stdout, stderr=subprocess.PIPE, text=True, check=False, env=here, timeout=120,
                          **options)  # fmt: skip
    return done.returncode, done.stdout, done.stderr


SIMULATE = ["simulate", "mine:run", "--trials=30", "--quiet"]
TUNE = ["tune", "mine:run", "--free", "q=0.5:2", "--trials=4", "--held-out=30", "--quiet"]


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        ([*SIMULATE, "-o", "missing/a.h5"], 2, "cannot write -o=missing/a.h5 (there is no folder"),
        ([*SIMULATE, "-o", "mine.py/a.h5"], 2, "cannot write -o=mine.py/a.h5 ("),
        ([*SIMULATE, "-o", "."], 2, "cannot write -o=. (it is a folder). Name a file in it."),
        ([*SIMULATE, "--until", "nees_ratio"], 2, "invalid --until=nees_ratio (no half-width"),
        ([*SIMULATE, "--failed", "7"], 2, "invalid --failed=7 (must be from 0 to 100 %)"),
        ([*SIMULATE, "--timeout", "-1"], 2, "invalid --timeout=-1.0 ("),
        ([*TUNE, "--free", "z=1:2"], 2, "invalid --free ("),
        ([*TUNE, "--picture", "missing/a.png"], 2, "cannot write missing/a.png (there is no folder"),
        (["tune", "mine:log", "--free", "q=1:2"], 1, "the function failed with q=1.41421 (OSError: "),
        (["judge", "a.csv", "--names", "error=e", "--record", "missing/a.h5"], 2, "cannot write missing/a.h5 ("),
    ],
)
def test_a_command_refuses_in_one_line_before_any_work(words, code, said):
    pathlib.Path("a.csv").write_text("e\n1\n")
    found = command(*words)
    assert found[:2] == (code, "")
    assert found[2].startswith(f"credence {words[0]}: {said}")
    assert found[2].count("\n") == 1


@pytest.mark.parametrize("words", [SIMULATE, TUNE])
def test_a_stream_that_is_full_is_said(words):
    with open("/dev/full", "w") as full:
        code, _, said = command(*words, stdout=full)
    assert (code, said) == (1, f"credence {words[0]}: cannot write to the standard output.\n")


def test_a_full_disk_is_said():
    code, _, said = command(*SIMULATE, "-o", "a.h5", before="trap '' XFSZ; ulimit -f 1;")
    assert code == 1
    assert said.startswith("credence simulate: cannot write ")
    assert "(File too large). Raise the limit" in said
    assert said.count("\n") == 1


def test_modules_that_are_missing_are_named():
    pathlib.Path("mpi4py.py").write_text("")
    pathlib.Path("distributed.py").write_text("raise ImportError('no dask')")
    for where, module in (("mpi", "mpi4py"), ("dask", "distributed")):
        code, _, said = command(*SIMULATE, "--executor", where)
        assert code == 2
        assert said.endswith(f"Install it: pip install {module}.\n")
        assert said.count("\n") == 1
    pathlib.Path("broken.py").write_text("x = 1\ny = x / 0\n")
    code, _, said = command("simulate", "broken:run", "--trials=4")
    assert code == 2
    assert "cannot be imported (ZeroDivisionError: division by zero; " in said
    assert said.endswith("broken.py, line 2). Mend the module.\n")


@pytest.mark.skipif(os.geteuid() != 0, reason="mounts need root")
def test_memory_need_not_be_shared():
    read_only = ["unshare", "-m", "bash", "-c", 'mount -t tmpfs -o ro none /dev/shm && exec "$0" "$@"', sys.executable,
                 "-m", "credence", *SIMULATE]  # fmt: skip
    here = {"env": environment(pathlib.Path.cwd()), "capture_output": True, "text": True, "timeout": 120}
    if subprocess.run([*read_only[:4], "mount -t tmpfs none /dev/shm"], capture_output=True, check=False).returncode:
        pytest.skip("mounts are not allowed")
    for executor in ([], ["--executor=2"]):
        done = subprocess.run([*read_only, *executor], check=False, **here)
        assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_at_any_time_stops_simulate_with_one_line(number):
    words = [sys.executable, "-m", "credence", *SIMULATE[:2], "--trials=3000", "-o", "a.h5", "--quiet"]
    seconds = []
    for share in (None, 0.1, 0.3, 0.5, 0.9):  # of the time that it takes
        begun = time.monotonic()
        streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
        process = subprocess.Popen(words, env=environment(pathlib.Path.cwd()), **streams)
        if share is not None:
            time.sleep(share * seconds[0])
            process.send_signal(number)
        said = process.communicate(timeout=120)[1]
        seconds.append(time.monotonic() - begun)
        begins_late = process.returncode == -number or (number == signal.SIGINT and "site" in said)
        assert process.returncode == (0 if share is None else 3) or process.returncode == 0 or begins_late, said
        assert begins_late or said.count("\n") == (process.returncode == 3), said
        for one in pathlib.Path().glob("a.h5*"):
            one.unlink()


def test_progress_is_said_without_tqdm():
    pathlib.Path("tqdm.py").write_text("raise ImportError('no tqdm')")
    leader, follower = pty.openpty()
    words = [*TUNE[:-1], "--trials=40"]
    done = python("-m", "credence", *words, stderr=follower, env=environment(pathlib.Path.cwd()))
    os.close(follower)
    said = os.read(leader, 2**20).decode()
    os.close(leader)
    assert "tuned" in done.stdout
    assert "evaluations, score " in said
    assert said.endswith("\x1b[K")
