"""Every state of the standard streams: descriptors 0, 1 and 2 closed in all combinations, for commands that make
files, while libraries print what they can: OpenMP's settings and threads, the dynamic linker's statistics, HDF5's
complaint of a setting. No byte of it gets into a file. On open streams each of them must be heard.

Of these states every --every-th is tried. With --mutants fcntl says of closed descriptors that they are open
(shim/fail.c), so that the program does not hold them: then this must fail for each library that prints while a file is
open."""

import itertools
import os
import shutil
import subprocess
from dataclasses import dataclass

from commands import Command, commands
from harness import EXIT, Bench, Failed, arguments, finish


@dataclass
class Talker:
    """What makes a library print, words of it, and whether it prints while a file is open to be written."""

    name: str
    environment: dict
    says: bytes
    late: bool = False


# Before main() OpenMP's library prints its settings, and the linker, which prints again at the end, what it does. A
# refused allocation is said when the files are closed.
TALKERS = [
    Talker("libgomp, settings", {"OMP_DISPLAY_ENV": "verbose"}, b"OMP_"),
    Talker("libgomp, threads", {"OMP_DISPLAY_AFFINITY": "true", "OMP_AFFINITY_FORMAT": "OpenMP thread %n of %N"},
           b"OpenMP thread", late=True),
    Talker("libgomp, no thread", {"FAIL": "thread", "FAIL_AT": "2", "OMP_NUM_THREADS": "2"}, b"libgomp", late=True),
    Talker("glibc, linker", {"LD_DEBUG": "libs,statistics"}, b"runtime linker"),
    Talker("glibc, allocation", {"FAIL": "malloc", "FAIL_AT": "30000"}, b"memory"),
    Talker("HDF5", {"HDF5_DEBUG": "nosuch"}, b"HDF5_DEBUG", late=True),
]
SAID = (b"calling init", b"HDF5-DIAG", b"terminate called", b"credence run:",
        *(talker.says for talker in TALKERS if talker.says != b"memory"))
WRITERS = ("run", "resume", "overwrite", "merge", "report, page", "replay, file", "judge, page", "compare, file")
CLOSINGS = [closed for n in range(4) for closed in itertools.combinations((0, 1, 2), n)]


def writers(bench):
    """Commands, each with the files that it makes undisturbed, in a folder of their own."""
    by_name = {command.name: command for command in commands(bench)}
    by_name["compare, file"] = Command("compare, file", [*by_name["compare"].command, "-o", "r"])
    for command in (by_name[name] for name in WRITERS):
        bench.begin(command.start)
        bench.expect(0, *command.command)
        made = bench.root / command.name
        shutil.copytree(bench.at, made)
        yield command, made


def speaks(talker, command):
    """Only runs have threads that can fail to start."""
    return command.command[0] == "run" or talker.name != "libgomp, no thread"


def start(bench, command, closed, talker, mutant=False):
    """Runs the program with these descriptors closed; what libraries say on open ones is read."""
    bench.begin(command.start)
    closing = " ".join(f"{fd}{'<' if fd == 0 else '>'}&-" for fd in closed)
    environment = {**os.environ, **talker.environment}
    if "FAIL" in talker.environment or mutant:
        environment["LD_PRELOAD"] = bench.shim
    if mutant:
        environment = {"FAIL": "none", **environment, "FAIL_HELD": "1"}
    closed = ["bash", "-c", f'exec "$@" {closing}', "-", bench.credence]
    done = subprocess.run([*closed, *command.command], cwd=bench.at, env=environment, timeout=60,
                          stdin=subprocess.DEVNULL, capture_output=True)
    # Without memory libhdf5 may end it: fail_once.py looks at that.
    if done.returncode not in (0, 1, 2) and talker.environment.get("FAIL") != "malloc":
        raise Failed(f"it ended with {done.returncode}: {done.stderr[-200:]!r}")
    return done


def check_file(bench, name, data, made):
    """A file is one that the undisturbed command makes, or a journal."""
    if name.endswith(".journal"):
        if not data.startswith(b"credence-journal"):
            raise Failed(f"{name} begins with {data[:60]!r}")
    elif not (made / name).exists():
        raise Failed(f"there is a file {name}")
    elif not name.endswith(".h5"):
        if data != (made / name).read_bytes():
            raise Failed(f"{name} differs")
    elif data[:4] != b"\x89HDF":
        raise Failed(f"{name} is no HDF5 file: {data[:60]!r}")
    else:
        bench.check_same(made / name, name, "its file")


def killed_by_library(done, closed, talker):
    """Whether libhdf5 ended it without memory: by a signal or by exit(), whose code is 1 and which an open stream says."""
    by_exit = talker.environment.get("FAIL") == "malloc" and (2 in closed or EXIT.encode() in done.stderr)
    return done.returncode not in (0, 1, 2) or (done.returncode == 1 and by_exit)


def check(bench, command, made, done, killed):
    files = bench.files()
    if done.returncode == 0 and sorted(files) != sorted(path.name for path in made.iterdir()):
        raise Failed(f"it ended with 0, and left {sorted(files)}")
    for name, data in files.items():
        if done.returncode != 0 and name in command.start and data == command.start[name].read_bytes():
            continue
        if not (killed and name.endswith(".credence-partial")):
            check_file(bench, name, data, made)
        found = [words for words in SAID if words in data]
        if found and name.endswith((".h5", ".journal", ".credence-partial")):
            raise Failed(f"{name} holds {found}")


def states(bench, talkers, every):
    """Every `every`-th, and two commands with open streams besides, as one may bear a refused allocation."""
    everything = [(*one, talker) for one in writers(bench) for talker in talkers if speaks(talker, one[0])]
    for number, (one, closed) in enumerate(itertools.product(everything, CLOSINGS), start=1):
        if number % every == 0 or (closed == () and one[0].name in ("run", "merge")):
            yield *one, closed


def all_states(bench, every):
    counts = {"states": 0, "ended with 0": 0, "ended with 1": 0, "ended with 2": 0, "ended otherwise": 0}
    failures, heard, talkers = [], set(), TALKERS
    for command, made, talker, closed in states(bench, talkers, every):
        counts["states"] += 1
        try:
            done = start(bench, command, closed, talker)
            code = done.returncode
            counts[f"ended with {code}" if code in (0, 1, 2) else "ended otherwise"] += 1
            if closed == () and talker.says in done.stdout + done.stderr:
                heard.add(talker.name)
            check(bench, command, made, done, killed_by_library(done, closed, talker))
        except (Failed, subprocess.TimeoutExpired) as error:
            failures.append(f"{command.name}, {talker.name}, closed {closed}: {error}")
    failures += [f"{talker.name} says nothing on open streams" for talker in talkers if talker.name not in heard]
    finish("standard streams", counts, failures)


def mutants(bench):
    """The error stream is closed, so that the journal gets its descriptor."""
    command, made = next(writers(bench))
    late = [talker for talker in TALKERS if talker.late]
    survived = []
    for talker in late:
        done = start(bench, command, (2,), talker, mutant=True)
        try:
            check(bench, command, made, done, killed_by_library(done, (2,), talker))
            survived.append(f"no message of {talker.name} was found in a file")
        except Failed:
            pass
    finish("standard streams, not held", {"states": len(late), "found": len(late) - len(survived)}, survived)


def main():
    given = arguments(__doc__, every=1, mutants=0)
    with Bench(given.credence) as bench:
        mutants(bench) if given.mutants else all_states(bench, given.every)


if __name__ == "__main__":
    main()
