"""What the harnesses in Python share: the program, the library of shim/, a folder, and small studies."""

import argparse
import os
import shutil
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
TRIALS = 1500  # five blocks and a partial one
LESS = 700  # two blocks and a partial one
EXIT = ": cannot finish (exit() was called in the middle of it, by a world or by a library)."  # said by the program

# What is set for OpenMP or credence where the tests run must not change what they do.
for name in [name for name in os.environ if name.startswith(("OMP_", "CREDENCE"))]:
    del os.environ[name]


class Failed(Exception):
    pass


def arguments(description, **numbers):
    """The command line of a harness: the program, and numbers with their defaults."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("credence", type=Path)
    for name, default in numbers.items():
        parser.add_argument("--" + name.replace("_", "-"), type=type(default), default=default)
    return parser.parse_args()


def threads(pid):
    """What each thread of a process does: its state, its system call's number, and where the kernel lets it wait."""
    def read(task, name):
        try:
            return (task / name).read_text()
        except OSError:
            return "? "

    return ", ".join(" ".join([read(task, "stat").rpartition(")")[2].split()[0], read(task, "syscall").split()[0],
                               read(task, "wchan")]) for task in sorted(Path(f"/proc/{pid}/task").glob("*")))


class Bench:
    """A folder with the library, the scenario and studies of it, undisturbed; `at` is the folder to work in."""

    def __init__(self, credence):
        signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # so that folders and mounts are removed then too
        self.credence = str(Path(credence).resolve())
        self.root = Path(tempfile.mkdtemp(prefix="credence-durability-"))
        self.shim = str(self.root / "shim.so")
        subprocess.run(["cc", "-O1", "-Wno-missing-field-initializers", "-shared", "-fPIC", "-o", self.shim,
                        *map(str, sorted((HERE / "shim").glob("*.c"))), "-ldl"], check=True)
        shutil.copy(HERE / "tiny.ini", self.root)
        self.at = self.root / "at"
        self.at.mkdir()
        self.planted = {}  # of the library's environment, in every run

    def __enter__(self):
        return self

    def __exit__(self, *_):
        shutil.rmtree(self.root, ignore_errors=True)

    def study(self, *more, output="x.h5", trials=TRIALS, threads=1):
        return ["run", "../tiny.ini", "--trials", str(trials), "--quiet", "-o", output, "--commit-every", "1",
                "--threads", str(threads), *more]

    def make(self, name, *more, trials=TRIALS):
        """Runs a study, undisturbed, to the file `name` beside the folder."""
        path = self.root / name
        if not path.exists():
            self.expect(0, *self.study(*more, output=str(path), trials=trials))
        return path

    def run(self, *command, environment=None, timeout=20, **more):
        """Runs the program in the folder; `environment` is the library's."""
        variables = dict(os.environ)
        if environment is not None or self.planted:
            library = {**self.planted, **(environment or {})}
            variables.update({k: str(v) for k, v in library.items()}, LD_PRELOAD=self.shim)
        more.setdefault("stdin", subprocess.DEVNULL)
        process = subprocess.Popen([self.credence, *command], cwd=self.at, env=variables, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, errors="replace", **more)
        try:
            out, said = process.communicate(timeout=timeout)
        except subprocess.TimeoutExpired:
            waiting = threads(process.pid)
            process.kill()
            process.communicate()
            raise Failed(f"{' '.join(command)} did not end in {timeout} s; its threads: {waiting}") from None
        return subprocess.CompletedProcess(process.args, process.returncode, out, said)

    def expect(self, code, *command, **more):
        done = self.run(*command, **more)
        if done.returncode != code:
            raise Failed(f"{' '.join(command)} ended with {done.returncode}: {done.stderr}")
        return done

    def empty(self):
        """Empties the folder."""
        for path in self.at.iterdir():
            shutil.rmtree(path) if path.is_dir() and not path.is_symlink() else path.unlink()

    def begin(self, files):
        """Empties the folder, and puts these files into it, each under its name: the results file itself, as a journal
        names its inode; of the others copies."""
        self.empty()
        for name, source in files.items():
            (os.link if name == "x.h5" else shutil.copy)(source, self.at / name)

    def files(self):
        """The folder's files and their bytes."""
        return {path.name: path.read_bytes() for path in sorted(self.at.iterdir()) if path.is_file()}

    def same_results(self, one, other):
        """Whether two files have the same results: outside /run the same links, values and attributes."""
        done = subprocess.run(["h5diff", "--exclude-path", "/run", str(one), str(other)], capture_output=True)
        return done.returncode == 0 and not done.stdout

    def check_same(self, expected, path="x.h5", what=""):
        if not self.same_results(expected, self.at / path):
            raise Failed(f"{what}: other results than those of an undisturbed run")


def finish_all(name, done):
    """Prints the counts of each of `done`, pairs of a name and what has counts and failures; and ends with their sums."""
    total, failures = {}, []
    for part, one in done:
        print(f"  {part}: " + ", ".join(f"{number:,} {what}" for what, number in one.counts.items()), flush=True)
        failures += one.failures
        for what, number in one.counts.items():
            total[what] = total.get(what, 0) + number
    finish(name, total, failures)


def finish_mutant(name, counts, failures, unnoticed, noticed="noticed"):
    """Ends a run with a planted bug, which must have failed: where it did not, that is the failure."""
    finish(name, {**counts, noticed: len(failures)}, [] if failures else [unnoticed])


def finish(name, counts, failures):
    """Prints what was done; ends with 1 where something failed."""
    print(f"{name}: " + ", ".join(f"{number:,} {what}" for what, number in counts.items()), flush=True)
    for failure in failures[:20]:
        print("FAILED: " + failure, file=sys.stderr)
    if failures:
        print(f"FAILED: {name}, {len(failures)} times", file=sys.stderr)
        sys.exit(1)
