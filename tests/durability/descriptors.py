"""Every state of the standard streams: descriptors 0, 1 and 2 closed in all combinations, while libraries print what
they can: OpenMP's settings and threads, the dynamic linker's statistics, HDF5's tracing, MPI's. No byte of it gets
into a file.

Of these states every --every-th is tried. With --mutants fcntl says of closed descriptors that they are open
(shim/fail.c), so that the program does not hold them: then this must fail."""

import itertools
import os
import shutil
import subprocess

from harness import Bench, Failed, arguments, finish, finish_mutant

TALK = {
    "libgomp, settings": {"OMP_DISPLAY_ENV": "verbose"},
    "libgomp, threads": {"OMP_DISPLAY_AFFINITY": "true", "OMP_AFFINITY_FORMAT": "OpenMP thread %n of %N"},
    "libgomp, no thread": {"FAIL": "thread", "FAIL_AT": "2", "OMP_NUM_THREADS": "2"},  # of those that compute
    "glibc, linker": {"LD_DEBUG": "libs,statistics"},
    "glibc, allocation": {"FAIL": "malloc", "FAIL_AT": "30000"},
    "HDF5": {"HDF5_DEBUG": "all"},
}
SAID = (b"OMP_", b"OpenMP thread", b"libgomp", b"calling init", b"runtime linker", b"HDF5-DIAG", b"terminate called",
        b"H5Fcreate(", b"credence run:", b"PMIX", b"mca_")
MPI = {"MPI": {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
               "OMPI_MCA_mpi_show_mca_params": "all", "OMPI_MCA_rmaps_base_oversubscribe": "1",
               "OMPI_MCA_btl_base_verbose": "100"}}


def commands(bench):
    """Of each: its arguments, the file that it makes, and that file as it is undisturbed."""
    whole = bench.make("whole.h5")
    shards = [str(bench.make(f"{i}.h5", "--shard", f"{i}/3")) for i in range(3)]
    trial = ["--scenario", "tiny", "--arm", "fixed.ekf", "--trial", "3"]
    yield bench.study(threads=4), "x.h5", whole
    yield ["merge", *shards, "-o", "x.h5", "--quiet"], "x.h5", whole
    yield (["report", "../whole.h5", "-o", "r.txt"], "r.txt",
           made(bench, ["report", "../whole.h5", "-o", "../r.txt"], "r.txt"))
    yield (["replay", "../whole.h5", *trial, "-o", "t.h5"], "t.h5",
           made(bench, ["replay", "../whole.h5", *trial, "-o", "../t.h5"], "t.h5"))


def made(bench, command, name):
    bench.expect(0, *command)
    return bench.root / name


def start(bench, command, closed, talk, mutant, launcher=()):
    """Runs the program with these descriptors closed; what libraries say on open ones is read and thrown away."""
    bench.empty()
    closing = " ".join(f"{fd}{'<' if fd == 0 else '>'}&-" for fd in closed)
    environment = {**os.environ, **talk}
    if "FAIL" in talk or mutant:
        environment["LD_PRELOAD"] = bench.shim
    if mutant:
        environment = {"FAIL": "none", **environment, "FAIL_HELD": "1"}
    closed = ["bash", "-c", f'exec "$@" {closing}', "-", bench.credence]  # under mpirun those of the ranks, not its own
    done = subprocess.run([*launcher, *closed, *command], cwd=bench.at, env=environment, timeout=60,
                          stdin=subprocess.DEVNULL, capture_output=True)
    # Without memory libhdf5 may end it: fail_once.py looks at that.
    if done.returncode not in (0, 1, 2) and talk.get("FAIL") != "malloc":
        raise Failed(f"it ended with {done.returncode}: {done.stderr[-200:]!r}")
    return done


def check(bench, done, output, whole):
    for name, data in bench.files().items():
        if name == output and output.endswith(".h5"):
            if data[:4] != b"\x89HDF":
                raise Failed(f"{name} is no HDF5 file: {data[:60]!r}")
            bench.check_same(whole, name, "its file")
        elif name == output:
            if data != whole.read_bytes():
                raise Failed(f"{name} differs")
        elif name.endswith(".journal") and not data.startswith(b"credence-journal"):
            raise Failed(f"{name} begins with {data[:60]!r}")
        found = [words for words in SAID if words in data] if not name.endswith(".txt") else []
        if found:
            raise Failed(f"{name} holds {found}")
    if done.returncode == 0 and output not in bench.files():
        raise Failed("it ended with 0 without its file")


def main():
    given = arguments(__doc__, every=1, mutants=0)
    ends = ("ended with 0", "ended with 1", "ended with 2", "ended otherwise")
    number, counts, failures = 0, {"states": 0, **dict.fromkeys(ends, 0)}, []
    closings = [closed for n in range(4) for closed in itertools.combinations((0, 1, 2), n)]
    with Bench(given.credence) as bench:
        launchers = [((), TALK)]
        has_mpi = "MPI Open MPI" in bench.expect(0, "--version").stdout
        if has_mpi and shutil.which("mpirun") and not given.mutants:
            launchers.append((("mpirun", "-n", "2"), MPI))
        everything = [(one, launcher, talk) for one in commands(bench) for launcher, talks in launchers
                      for talk in talks.items() if not launcher or one[0][0] == "run"]
        for (command, output, whole), launcher, (name, talk) in everything:
            for closed in closings:
                number += 1
                if number % given.every or (given.mutants and failures):
                    continue
                counts["states"] += 1
                try:
                    done = start(bench, command, closed, talk, given.mutants, launcher)
                    code = done.returncode
                    counts[f"ended with {code}" if code in (0, 1, 2) else "ended otherwise"] += 1
                    check(bench, done, output, whole)
                except (Failed, subprocess.TimeoutExpired) as error:
                    failures.append(f"{command[0]}, {name}, closed {closed}: {error}")
    if given.mutants:
        return finish_mutant("standard streams, not held", counts, failures, "no library's message was found in a file",
                             noticed="found")
    finish("standard streams", counts, failures)


if __name__ == "__main__":
    main()
