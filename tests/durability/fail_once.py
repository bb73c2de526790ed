"""Every resource fails once: the n-th call of each kind of every command (shim/fail.c). The command does its work all
the same, or ends with 1 or 2 and one line that says what the system said, and does not speak of writing where it writes
no file; nothing is lost: every file is what it was before, is not there, or is whole, and the same command without the
failure ends as it always does. A read or write of half the bytes, one that is interrupted, and a file system without
the flags of renameat2 must make no difference. If memory is refused, libhdf5 1.10 may end the process itself, and so
do constants made before main(); if it gets no memory to start with, it prints what it always prints of an error.
OpenMP's library says of a thread and of memory that it does not get what the system said, and calls exit(): the
program's own line then follows.

With --most N at most N of the calls of a kind fail, at random, and --many N of the kinds that have thousands; 0: each.
With --every N only each N-th of the kinds, others from command to command. With --callers D, one allocation and one
mapping fail besides for each distinct chain of D innermost callers, counted over all commands, which have one thread
then, so that a call has the same number in each run. With --mutants failing calls say that they succeeded, as if the
program did not look: then this must fail."""

import os
import random
import shutil
import struct
import subprocess

from commands import commands
from harness import EXIT, HERE, Bench, Failed, arguments, finish, finish_all

IO = "input/output error"
MEMORY = ("malloc", "mmap")
MANY = (*MEMORY, "short", "eintr")
# What must be said of a failure; nothing of what a program has to bear.
KINDS = {"open": "too many open files", "read": IO, "write": IO, "cut": IO, "sync": IO, "rename": IO, "remove": IO,
         "stat": IO, "close": IO, "own": "operation not permitted", "lock": "no locks available",
         "thread": "resource temporarily unavailable", "short": None, "eintr": None, "norename2": None,
         **dict.fromkeys(MEMORY, "memory")}


def with_one_thread(command):
    return [("1" if before == "--threads" else word) for before, word in zip(["", *command], command)]


class Failing:
    def __init__(self, bench, command, most, many=0, kinds=tuple(KINDS), silent=None, callers=0, tried=None):
        self.bench, self.command, self.kinds = bench, command, kinds
        self.most = {kind: many if kind in MANY else most for kind in kinds}
        self.callers, self.tried = callers, set() if tried is None else tried
        self.silent = {"FAIL_SILENT": 1} if silent else {}
        self.counts = {"calls": 0, "failed": 0, "done all the same": 0, "refused": 0, "ended by libhdf5": 0,
                       "ended before main": 0}
        self.failures, self.one_thread = [], False

    def start(self):
        self.bench.begin(self.command.start)

    def once(self, kind, n, timeout=20, **more):
        count = self.bench.root / "count"
        count.unlink(missing_ok=True)
        command = with_one_thread(self.command.command) if self.one_thread else self.command.command
        done = self.bench.run(*command, timeout=timeout, environment={"FAIL": kind, "FAIL_AT": n, "FAIL_COUNT": count,
                                                                      **self.silent, **more})
        if n == 0 and done.returncode != self.expected.returncode:
            raise Failed(f"{self.command.name}: a run whose {kind} calls are counted ended with {done.returncode}")
        return done, int.from_bytes(count.read_bytes(), "little")

    def at_random(self, kind):
        """How many calls there are, and which of them fail."""
        _, calls = self.once(kind, 0)
        numbers = range(1, calls + 1)
        if self.most[kind] and calls > self.most[kind]:
            numbers = sorted(random.Random(calls).sample(numbers, self.most[kind]))
        return calls, numbers

    def first_of_each_chain(self, kind):
        """The first call of each chain of callers that no command before had."""
        places = self.bench.root / "places"
        places.unlink(missing_ok=True)
        # To look up the callers of each call takes seconds.
        _, calls = self.once(kind, 0, 200, FAIL_PLACES=places, FAIL_CALLERS=self.callers)
        with open(places, "rb") as file:
            hashes = [place for place, in struct.iter_unpack("=Q", file.read(8 * calls))]
        if 0 in hashes or len(hashes) != calls:
            raise Failed(f"{self.command.name}: the callers of some {kind} calls were not found")
        first = {place: n for n, place in reversed(list(enumerate(hashes, start=1))) if place not in self.tried}
        self.tried.update(first)
        return sorted(first.values())

    def all(self):
        self.start()
        self.expected = self.bench.expect(0, *self.command.command)
        self.made = self.bench.files()
        self.keep_made()
        for kind in self.kinds:
            self.start()
            calls, numbers = self.at_random(kind)
            self.counts["calls"] += calls
            self.fail_at(kind, numbers)
            if self.most[kind] and self.callers and kind in MEMORY:
                self.one_thread = True
                self.start()
                self.fail_at(kind, self.first_of_each_chain(kind))
                self.one_thread = False
        return self

    def fail_at(self, kind, numbers):
        for n in numbers:
            self.counts["failed"] += 1
            try:
                self.check(kind, n)
            except Failed as error:
                self.failures.append(f"{self.command.name}, {kind} {n}: {error}")

    def check(self, kind, n):
        self.start()
        before = self.bench.files()
        done, _ = self.once(kind, n)
        if done.returncode == self.expected.returncode:
            self.counts["done all the same"] += 1
            self.check_done(done)
        elif kind == "malloc" and "shim: it ended in libhdf5" in done.stderr:
            # By a signal, or by exit(), whose code is 1.
            self.counts["ended by libhdf5"] += 1
            self.check_kept(before)
        elif done.returncode in (1, 2) and KINDS[kind]:
            self.counts["refused"] += 1
            self.check_said(done, KINDS[kind])
            self.check_kept(before)
        elif kind == "malloc" and "shim: it ended in what runs before main" in done.stderr:
            self.counts["ended before main"] += 1
        else:
            raise Failed(f"ended with {done.returncode}: {done.stderr.strip()[:200]}")
        self.check_goes_on()

    def check_done(self, done):
        what = {"always the same": str, "the same words": str.split}.get(self.command.printed)
        if what and what(done.stdout) != what(self.expected.stdout):
            raise Failed("ended well, but printed something else")
        self.check_files("ended well, but left")

    def check_said(self, done, words):
        lines = [line for line in done.stderr.strip().splitlines() if not line.startswith("shim: ")]
        if words == "memory":
            lines = [line for line in lines if not line.startswith(("HDF5-DIAG", "  #", "    major: ", "    minor: "))]
        if len(lines) == 2 and lines[0].startswith("libgomp: ") and EXIT in lines[1]:
            del lines[1]
        if len(lines) != 1:
            raise Failed(f"ended with {done.returncode} and said {lines}")
        # pthread_create() says of memory that it does not get what it says of threads.
        threads = words == "memory" and "Thread creation failed: Resource temporarily unavailable" in lines[0]
        if words not in lines[0].lower() and not threads:
            raise Failed(f"ended with {done.returncode}, but did not say {words}: {lines[0]}")
        if "-o" not in self.command.command and "cannot write" in lines[0].replace("cannot write to the standard", ""):
            raise Failed(f"ended with {done.returncode}, but it writes no file: {lines[0]}")

    def keep_made(self):
        """Keeps what the undisturbed command made, beside the folder."""
        if self.command.whole:
            self.bench.check_same(self.command.whole, what="undisturbed")
        self.kept = self.bench.root / "made"
        shutil.rmtree(self.kept, ignore_errors=True)
        shutil.copytree(self.bench.at, self.kept)

    def is_whole(self, name, data):
        """Whether a file is what the undisturbed command made of that name."""
        if name.endswith(".h5"):
            return name in self.made and self.bench.same_results(self.kept / name, self.bench.at / name)
        return self.made.get(name) == data

    def check_kept(self, before):
        """Files are what they were, or whole, but for those of a run that is to be resumed."""
        now = self.bench.files()
        missing = [name for name in before if name not in now and name in self.made]
        changed = [name for name, data in now.items() if before.get(name) != data and not self.is_whole(name, data) and
                   not name.endswith((".journal", ".credence-partial"))]
        if missing or changed:
            raise Failed(f"{missing} gone, {changed} neither what they were nor whole")

    def check_files(self, what):
        now = self.bench.files()
        if sorted(now) != sorted(self.made):
            raise Failed(f"{what} {sorted(now)}")
        for name, data in now.items():
            if not self.is_whole(name, data):
                raise Failed(f"{what} another {name}")

    def check_goes_on(self):
        if not self.made:
            return
        done = self.bench.run(*self.command.again)
        if done.returncode != self.expected.returncode:
            raise Failed(f"going on ended with {done.returncode}: {done.stderr.strip()}")
        self.check_files("going on left")


def check_shim(bench):
    """A refused allocation of libhdf5 may damage the heap: what the library of shim/ does when the C library then ends
    the program must not wait for the heap's lock."""
    program = bench.root / "damaged_heap"
    subprocess.run(["cc", "-w", "-pthread", "-o", program, HERE / "damaged_heap.c"], check=True)
    variables = {**os.environ, "LD_PRELOAD": bench.shim, "FAIL": "malloc", "FAIL_AT": "100000"}
    done = subprocess.run([program], env=variables, capture_output=True, text=True, timeout=20)
    if "shim: it ended in" not in done.stderr:
        raise Failed(f"a damaged heap: the library does not say where the program ended: {done.stderr}")


def unnoticed(bench, command, kind):
    """Failures of which the command knew nothing: it ended well, but its work is not done, or it refused what it had not
    read, but did not say why."""
    failures = Failing(bench, command, 20, kinds=(kind,), silent=True).all().failures
    return [failure for failure in failures if ", but " in failure]


def mutants(bench):
    """Calls that fail silently, one kind after the other."""
    by_name = {command.name: command for command in commands(bench)}
    planted = [("run", "write"), ("run", "rename"), ("run", "remove"), ("report", "read"), ("merge", "read"),
               ("judge", "read")]
    survived = [f"{kind} of {name}" for name, kind in planted if not unnoticed(bench, by_name[name], kind)]
    finish("every resource fails once, silently", {"kinds": len(planted), "noticed": len(planted) - len(survived)},
           [f"nothing was noticed of a failed {one}" for one in survived])


def main():
    given = arguments(__doc__, most=0, many=0, every=1, callers=0, only="", mutants=0)
    tried = set()
    with Bench(given.credence) as bench:
        check_shim(bench)
        if given.mutants:
            return mutants(bench)
        kinds = [[kind for place, kind in enumerate(KINDS) if (place + shift) % given.every == 0]
                 for shift in range(given.every)]
        finish_all("every resource fails once",
                   ((command.name, Failing(bench, command, given.most, given.many, kinds[number % given.every],
                                           callers=given.callers, tried=tried).all())
                    for number, command in enumerate(commands(bench)) if given.only in ("", command.name)))


if __name__ == "__main__":
    main()
