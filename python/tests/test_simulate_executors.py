"""`credence.simulate` on executors: the same bits on all of them, and after workers were lost.

With CREDENCE_KILLS=500 that many workers are killed at random times, in place of 5, and that many times 2/5 studies are
stopped by a signal.
"""

from __future__ import annotations

import concurrent.futures
import contextlib
import filecmp
import multiprocessing
import os
import random
import shutil
import signal
import subprocess
import sys
import threading
import time

import filters
import pytest
from conftest import HERE, SCENARIO, environment, refused

import credence

ARMS = {"right": {}, "calm": {"scale": 0.5}}
MPIRUN = "mpirun --allow-run-as-root --oversubscribe -n 3"
LOOP = {"kf": {"hang": "loop"}}
OF_DASK = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None, "host": "127.0.0.1"}
KILLS = int(os.environ.get("CREDENCE_KILLS", "5"))
TRIALS = 400


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The output of one process."""
    path = tmp_path_factory.mktemp("whole") / "whole.h5"
    credence.simulate(filters.drawn, trials=TRIALS, arms=ARMS, output=path)
    return path


def is_same(first, second):
    return filecmp.cmp(first, second, shallow=False)


@pytest.mark.parametrize("processes", [1, 2, 4])
def test_any_number_of_processes_gives_the_same_bits(tmp_path, whole, processes):
    credence.simulate(filters.drawn, trials=TRIALS, arms=ARMS, output=tmp_path / "a.h5", executor=processes)
    assert is_same(tmp_path / "a.h5", whole)
    assert multiprocessing.active_children() == []


def test_closures_run_in_processes():
    scale = 0.5
    study = credence.simulate(lambda rng: filters.drawn(rng, scale), trials=50, executor=2)
    assert study.arm("run").read("covariance")[:, 0, 0, 0].tolist() == [0.5] * 50


@pytest.mark.parametrize("kind", ["threads", "spawned processes", "loky"])
def test_executors_of_concurrent_futures(tmp_path, whole, kind):
    if kind == "threads":
        executor = concurrent.futures.ThreadPoolExecutor(2)
    elif kind == "loky":
        executor = pytest.importorskip("loky").ProcessPoolExecutor(2)
    else:
        executor = concurrent.futures.ProcessPoolExecutor(2, multiprocessing.get_context("spawn"))
    with executor:
        credence.simulate(filters.drawn, trials=TRIALS, arms=ARMS, output=tmp_path / "a.h5", executor=executor)
        assert executor.submit(abs, -1).result() == 1  # it is the caller's, and stays as it is
    assert is_same(tmp_path / "a.h5", whole)


def test_a_cluster_of_dask(tmp_path, whole, monkeypatch):
    distributed = pytest.importorskip("distributed")
    monkeypatch.setenv("PYTHONPATH", environment()["PYTHONPATH"])
    with distributed.LocalCluster(**OF_DASK) as cluster, distributed.Client(cluster) as client:
        executor = client.get_executor()
        credence.simulate(filters.drawn, trials=TRIALS, arms=ARMS, output=tmp_path / "a.h5", executor=executor)
        hung = credence.simulate(filters.troubled, trials=40, arms=LOOP, timeout=1, executor=executor)
        assert {one.trial: one.reason for one in hung.failures}[5] == "it took longer than timeout=1 s"
    assert is_same(tmp_path / "a.h5", whole)


def test_mpi4py(tmp_path, whole):
    pytest.importorskip("mpi4py")
    if shutil.which("mpirun") is None:
        pytest.skip("mpirun is not installed")
    script = tmp_path / "script.py"
    script.write_text(
        "import credence, filters\n"
        "from mpi4py.futures import MPIPoolExecutor\n"
        "if __name__ == '__main__':\n"
        "    with MPIPoolExecutor() as executor:\n"
        f"        credence.simulate(filters.drawn, trials={TRIALS}, arms={ARMS}, output='a.h5', executor=executor)\n"
    )
    words = [*MPIRUN.split(), sys.executable, "-m", "mpi4py.futures"]
    subprocess.run([*words, str(script)], cwd=tmp_path, env=environment(), check=True, timeout=120)
    assert is_same(tmp_path / "a.h5", whole)


def test_a_hang_in_a_thread_is_ended():
    with concurrent.futures.ThreadPoolExecutor(2) as executor:
        study = credence.simulate(
            filters.troubled, trials=40, arms={"kf": {"hang": "loop"}}, timeout=0.5, executor=executor
        )
    assert {one.trial: one.reason for one in study.failures}[5] == "it took longer than timeout=0.5 s"


def test_a_hang_that_no_signal_ends_costs_its_trial(tmp_path):
    mark = tmp_path / "mark"
    mark.touch()
    given = {"trials": 40, "timeout": 0.1, "executor": 2, "arms": {"kf": {"mark": str(mark)}}}
    study = credence.simulate(filters.hung_in_c, output=tmp_path / "a.h5", **given)
    (lost,) = study.failures
    assert (lost.trial, lost.reason.split(" (")[0]) == (6, "its worker was lost 3 times")
    mark.unlink()
    resumed = credence.simulate(filters.hung_in_c, output=tmp_path / "a.h5", resume=True, **given)
    assert resumed.failures == []  # what was lost runs again


@pytest.mark.parametrize("kind", ["own", "standard"])
def test_a_worker_that_is_lost_costs_its_chunk(tmp_path, whole, kind):
    (tmp_path / "marks").mkdir()

    def study(times, output):
        executor = 2
        if kind == "standard":
            executor = concurrent.futures.ProcessPoolExecutor(2, multiprocessing.get_context("fork"))
        arms = {"kf": {"marks": str(tmp_path / "marks"), "times": times}}
        return credence.simulate(filters.killer, trials=40, arms=arms, executor=executor, output=output)

    survived = study(2, tmp_path / "twice.h5")
    assert len(list((tmp_path / "marks").iterdir())) == 2
    assert survived.failures == []
    lost = study(10**6, tmp_path / "always.h5")
    assert [(one.trial, one.reason.split(" (")[0]) for one in lost.failures] == [(6, "its worker was lost 3 times")]


def test_workers_that_are_killed_at_random_times(tmp_path):
    """The same record as if none had been killed."""
    trials, seconds = 300 + 60 * KILLS, 0.01
    running, killed = threading.Event(), []

    def kill():
        chance = random.Random(7)
        while running.is_set() and len(killed) < KILLS:
            time.sleep(chance.uniform(0.2, 0.6))
            processes = multiprocessing.active_children()
            if processes and running.is_set():
                with contextlib.suppress(ProcessLookupError, TypeError):
                    os.kill(chance.choice(processes).pid, signal.SIGKILL)
                    killed.append(1)

    killer = threading.Thread(target=kill)
    running.set()
    killer.start()
    try:
        study = credence.simulate(
            filters.slow, trials=trials, arms={"right": {"seconds": seconds}}, executor=2, output=tmp_path / "a.h5"
        )
    finally:
        running.clear()
        killer.join()
    assert len(killed) == KILLS
    assert study.failures == []
    assert multiprocessing.active_children() == []
    credence.simulate(
        filters.slow, trials=trials, arms={"right": {"seconds": seconds}}, executor=2, output=tmp_path / "b.h5"
    )
    assert is_same(tmp_path / "a.h5", tmp_path / "b.h5")


KILLED = """
import contextlib, multiprocessing, os, random, signal, sys, threading, time
import credence, filters

seed, kills, path, kind = int(sys.argv[1]), int(sys.argv[2]), sys.argv[3], sys.argv[4]
chance, killed, running = random.Random(seed), [], True
given = {"trials": 30 * kills, "arms": {"kf": {"seconds": 0.01}}, "output": path}

def kill():
    before = 0
    while running and len(killed) < kills:
        time.sleep(chance.uniform(0.02, 0.2))
        size = os.path.getsize(path + ".trials") if os.path.exists(path + ".trials") else 0
        processes = multiprocessing.active_children()
        if processes and size != before:  # something was done since: it is rare that a trial is hit three times
            before = size
            with contextlib.suppress(ProcessLookupError):
                os.kill(chance.choice(processes).pid, signal.SIGKILL)
                killed.append(1)

thread = threading.Thread(target=kill, daemon=True)
thread.start()
if kind == "own":
    study = credence.simulate(filters.large, executor=2, **given)
else:
    from concurrent.futures import ProcessPoolExecutor
    with ProcessPoolExecutor(2, multiprocessing.get_context("fork")) as pool:
        study = credence.simulate(filters.large, executor=pool, **given)
running = False
thread.join()
if study.failures:  # a trial that was hit three times on a busy machine: what is lost runs again
    assert all("lost 3 times" in one.reason for one in study.failures) and 3 * len(study.failures) <= len(killed)
    study = credence.simulate(filters.large, resume=True, **given)
print(len(killed), len(study.failures), len(multiprocessing.active_children()))
print(study.failures, file=sys.stderr)
"""


STOPPED = """
import pathlib, sys
import credence.simulating
from credence._commands import obeyed

pathlib.Path("begun").touch()
sys.exit(obeyed("simulate", sys.argv[1:]))
"""


def in_a_process(words, **given):
    return subprocess.Popen([sys.executable, *map(str, words)], start_new_session=True, env=environment(), **given)


@pytest.mark.parametrize("kind", ["own", "standard"])
def test_workers_that_are_killed_while_they_send(tmp_path, kind):
    """Trials of 1 MB, so that a worker is often killed in the middle of one; the same record, and an end."""
    left, total = KILLS if kind == "own" else 5, 0
    for seed in range(-(-left // 10)):
        kills, path = min(10, left - 10 * seed), tmp_path / "a.h5"
        words = ["-c", KILLED, seed, kills, path, kind]
        with in_a_process(words, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
            said, complaint = process.communicate(timeout=120)
        assert process.returncode == 0, complaint
        killed, failures, alive = map(int, said.split())
        assert (failures, alive) == (0, 0), complaint
        assert killed > 0
        total += killed
        print(f"{kind}: {total} killed", flush=True)
        if not (tmp_path / "b.h5").exists():
            arms = {"kf": {"seconds": 0.01}}
            credence.simulate(filters.large, trials=30 * kills, arms=arms, output=tmp_path / "b.h5")
        assert filecmp.cmp(path, tmp_path / "b.h5", shallow=False)
        for made in tmp_path.glob("a.h5*"):
            made.unlink()


def test_studies_that_are_stopped_at_random_times(tmp_path):
    """Ctrl-C, SIGTERM, and the end of the process: each of them ends it, and it goes on to the same record."""
    chance, path, begun, trials = random.Random(3), tmp_path / "a.h5", tmp_path / "begun", 150
    counts = {signal.SIGINT: 0, signal.SIGTERM: 0, signal.SIGKILL: 0}
    words = ["-c", STOPPED, "filters:large", "--trials", trials, "--executor", 2, "-o", path, "--resume", "--quiet"]
    while counts[signal.SIGINT] < max(3, KILLS * 2 // 5):
        with in_a_process(words, cwd=tmp_path, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE) as one:
            while one.poll() is None and not begun.exists():
                time.sleep(0.01)
            with contextlib.suppress(subprocess.TimeoutExpired):
                one.wait(chance.uniform(0, 0.7))
            number = chance.choice([signal.SIGINT, signal.SIGINT, signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
            if one.poll() is None:
                to_all = number == signal.SIGINT and chance.random() < 0.5  # as on a terminal
                (os.killpg if to_all else os.kill)(one.pid, number)
                counts[number] += 1
                print({one.name: count for one, count in counts.items()}, flush=True)
            try:
                complaint = one.communicate(timeout=60)[1].decode()
            except subprocess.TimeoutExpired:
                pytest.fail(f"it did not end after signal {number}, or something of it did not: {one.poll()}")
            assert one.returncode in (0, 3, -number), complaint
            assert "Traceback" not in complaint, complaint
        begun.unlink()
        if one.returncode == 0:
            credence.simulate(filters.large, trials=trials, output=tmp_path / "b.h5")
            assert filecmp.cmp(path, tmp_path / "b.h5", shallow=False)
            for made in tmp_path.iterdir():
                made.unlink()


def test_what_cannot_be_sent_is_refused():
    with concurrent.futures.ProcessPoolExecutor(1) as executor:
        refused("a task cannot be sent to the executor.*Define it in a module that the workers can import",
                credence.simulate, lambda rng: filters.drawn(rng), trials=30, executor=executor)  # fmt: skip


class Breaking(concurrent.futures.Executor):
    """An executor of a kind that cannot be made again, whose workers are lost."""

    def submit(self, function, /, *arguments, **named):
        future = concurrent.futures.Future()
        future.set_exception(concurrent.futures.BrokenExecutor("lost"))
        return future


class Losing(concurrent.futures.ThreadPoolExecutor):
    """An executor that loses every tenth task and goes on, as Dask's with its KilledWorker."""

    lost = 0

    def submit(self, function, /, *arguments, **named):
        Losing.lost += 1
        if Losing.lost % 10 == 0:
            future = concurrent.futures.Future()
            future.set_exception(RuntimeError("killed"))
            return future
        return super().submit(function, *arguments, **named)


def test_an_executor_that_cannot_be_made_again(tmp_path):
    with pytest.raises(credence.Failure, match=r"a worker was lost, and with it the Breaking. What was done is kept"):
        credence.simulate(filters.drawn, trials=30, executor=Breaking(), output=tmp_path / "a.h5")


def test_tasks_that_are_lost_run_again(tmp_path, whole):
    with Losing(2) as executor:
        credence.simulate(filters.drawn, trials=TRIALS, arms=ARMS, output=tmp_path / "a.h5", executor=executor)
    assert is_same(tmp_path / "a.h5", whole)
    assert Losing.lost > 10


# Studies of scenarios.

def is_same_study(first, second):
    """Whether two studies are the same outside the group /run, bit for bit."""
    found = []
    first.file.visit(lambda name: found.append(name))
    names = [name for name in found if not name.startswith("run") and name in second.file]
    values = ((study.file[name] for study in (first, second)) for name in names)
    arrays = [pair for pair in map(list, values) if hasattr(pair[0], "dtype")]
    assert len(arrays) > 50
    return all(a[()].tobytes() == b[()].tobytes() for a, b in arrays if a.dtype.kind in "fiu")


@pytest.mark.parametrize("kind", ["own", "standard", "dask"])
def test_shards_of_a_study_on_an_executor(tmp_path, scenario, kind):
    given = {"trials": 1500, "seed": 3, "sweep": {"noise.heading": [0.01, 0.02]}}
    whole = credence.run(scenario, **given)
    with contextlib.ExitStack() as stack:
        executor = 2
        if kind == "standard":
            pool = concurrent.futures.ProcessPoolExecutor(2, multiprocessing.get_context("spawn"))
            executor = stack.enter_context(pool)
        elif kind == "dask":
            distributed = pytest.importorskip("distributed")
            cluster = stack.enter_context(distributed.LocalCluster(**OF_DASK))
            executor = stack.enter_context(distributed.Client(cluster)).get_executor()
        merged = credence.run(scenario, executor=executor, shards=3, output=tmp_path / "merged.h5", **given)
    assert merged.complete
    assert is_same_study(whole, merged)
    assert str(credence.report(merged)).splitlines()[1:] == str(credence.report(whole)).splitlines()[1:]


def test_a_study_on_an_executor_refuses_bad_input(tmp_path):
    (tmp_path / "there.h5").touch()
    for scenario, given, said in (
        (SCENARIO, {"executor": 2, "until": {"trace_P": "1%"}}, "^cannot stop shards by until"),
        (SCENARIO, {"shards": 2}, "^shards: say nothing without an executor"),
        (SCENARIO, {"executor": 2, "shards": 0}, "^invalid shards=0 "),
        (SCENARIO.replace("12", "-12"), {"executor": 2}, "poses"),
        (tmp_path / "missing.ini", {"executor": 2}, r"missing.ini \(there is no such file\)"),
        (SCENARIO, {"executor": 2, "output": tmp_path / "there.h5"}, r"there.h5 \(it exists\)"),
    ):
        refused(said, credence.run, scenario, trials=300, **given)
    assert multiprocessing.active_children() == []


def test_parts_are_merged(tmp_path, scenario, program):
    parts = [tmp_path / f"part-{i}.h5" for i in range(2)]
    for i, part in enumerate(parts):
        assert program("run", scenario, "--trials=600", f"--shard={i}/2", "-o", part, "--quiet")[0] == 0
    assert is_same_study(credence.merge(parts), credence.run(scenario, trials=600))
    refused("lacks blocks 1 of 3", credence.merge, parts[:1], raises=credence.Failure)


# The batch scripts of experiments/cluster, on this machine.


@pytest.mark.parametrize("kind", ["dask", "mpi"])
def test_the_batch_scripts_give_the_same_bits(tmp_path, kind):
    pytest.importorskip("distributed" if kind == "dask" else "mpi4py")
    if kind == "mpi" and shutil.which("mpirun") is None:
        pytest.skip("mpirun is not installed")
    script = HERE.parents[1] / "experiments" / "cluster" / f"simulate_{kind}.sh"
    (tmp_path / "mine.py").write_text((HERE / "filters.py").read_text())
    given = {"FUNCTION": "mine:drawn", "TRIALS": "300", "OUTPUT": "out/a.h5", "PYTHON": sys.executable}
    given |= {"OPTIONS": "--arm right --arm calm scale=0.5", "MPIRUN": MPIRUN}
    done = subprocess.run(["bash", str(script)], env={**os.environ, **given}, check=False, timeout=300,
                          capture_output=True)  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert b"right" in done.stdout
    credence.simulate(filters.drawn, trials=300, arms=ARMS, output=tmp_path / "b.h5")
    assert is_same(tmp_path / "out" / "a.h5", tmp_path / "b.h5")
