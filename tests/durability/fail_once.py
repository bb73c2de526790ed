"""Every resource fails once: the n-th allocation, open, read, lock, thread, sync, rename, removal or write of every
command (shim/fail.c). The command does its work all the same, or ends with 1 or 2 and one line that says what the
system said; nothing is lost: the same command without the failure ends as it always does. Where memory is refused,
libhdf5 1.10 may end the process itself, and so do constants made before main(); where it gets no memory to start with,
it prints what it always prints of an error.

With --most N at most N of the calls of a kind fail, at random; 0: each. With --callers D, one allocation and one
mapping fail besides for each distinct chain of D innermost callers, counted over all commands, which have one thread
then, so that a call has the same number in each run. With --mutants failing calls say that they succeeded, as if the
program did not look: then this must fail."""

import os
import random
import struct
import subprocess

from harness import HERE, LESS, Bench, Failed, arguments, finish, finish_all

KINDS = {"open": "too many open files", "read": "input/output error", "thread": "resource temporarily unavailable",
         "sync": "input/output error", "rename": "input/output error", "remove": "input/output error",
         "lock": "no locks available", "write": "input/output error", "malloc": "memory",
         "mmap": "memory"}


class Command:
    """`again` is what goes on after a failure; `whole` the file that it makes, beside the folder."""

    def __init__(self, name, command, again=None, start=None, whole=None, output=None, printed="always the same"):
        self.name, self.command, self.again, self.printed = name, command, again or command, printed
        self.start, self.whole, self.output = start or {}, whole, output


def commands(bench):
    whole, less = bench.make("whole.h5"), bench.make("less.h5", trials=LESS)
    bench.make("aggregates.h5", "--keep", "aggregates")
    other = bench.make("other.h5", "--seed", "2", trials=300)
    bench.make("changed.h5", "--set", "noise.odometry=0.02")
    shards = [str(bench.make(f"{i}.h5", "--shard", f"{i}/3")) for i in range(3)]
    two = bench.study(threads=2)
    merge = ["merge", *shards, "-o", "x.h5", "--quiet"]
    trial = ["--scenario", "tiny", "--arm", "fixed.ekf", "--trial", "3"]
    yield Command("run", two, [*two, "--resume"], whole=whole)
    yield Command("resume", [*two, "--resume"], start={"x.h5": less}, whole=whole)
    yield Command("overwrite", [*two, "--overwrite"], start={"x.h5": other}, whole=whole)
    yield Command("aggregates", [*two, "--keep", "aggregates"], [*two, "--keep", "aggregates", "--resume"],
                  whole=bench.root / "aggregates.h5")
    yield Command("dry-run", [*two, "--dry-run"], printed="times")
    yield Command("merge", merge, [*merge, "--overwrite"], whole=whole)
    yield Command("report", ["report", "../whole.h5"])
    yield Command("report, page", ["report", "../whole.h5", "--format", "html", "-o", "r"],
                  ["report", "../whole.h5", "--format", "html", "-o", "r", "--overwrite"], output="r")
    yield Command("compare", ["compare", "../whole.h5", "../changed.h5", "--arms", "fixed.ekf,fixed.ekf"])
    yield Command("replay", ["replay", "../whole.h5", *trial])
    yield Command("replay, file", ["replay", "../whole.h5", *trial, "-o", "t.h5"],
                  ["replay", "../whole.h5", *trial, "-o", "t.h5", "--overwrite"])
    record = str(HERE.parent / "reference" / "record_gaussian.h5")
    yield Command("judge", ["judge", record])
    yield Command("judge, page", ["judge", record, "--format", "html", "-o", "r"],
                  ["judge", record, "--format", "html", "-o", "r", "--overwrite"], output="r")
    yield Command("watch", ["watch", "../whole.h5", "--once"])
    yield Command("show", ["show", "../tiny.ini"])
    # Boost indents the text by the names that a stream of its own holds, whole or cut short.
    yield Command("help", ["run", "--help"], printed="the same words")
    yield Command("manual", ["manual"])
    yield Command("completion", ["completion", "bash"])
    yield Command("version", ["--version"], printed="the processor, where it can be read")


def with_one_thread(command):
    return [("1" if before == "--threads" else word) for before, word in zip(["", *command], command)]


class Failing:
    def __init__(self, bench, command, most, kinds=tuple(KINDS), silent=None, callers=0, tried=None):
        self.bench, self.command, self.most, self.kinds = bench, command, most, kinds
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
        if self.most and calls > self.most:
            numbers = sorted(random.Random(calls).sample(numbers, self.most))
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
        for kind in self.kinds:
            self.start()
            calls, numbers = self.at_random(kind)
            self.counts["calls"] += calls
            self.fail_at(kind, numbers)
            if self.most and self.callers and kind in ("malloc", "mmap"):
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
        elif done.returncode in (1, 2):
            self.counts["refused"] += 1
            self.check_said(done, KINDS[kind])
            self.check_kept(before)
        elif kind == "malloc" and "shim: it ended in libhdf5" in done.stderr:
            self.counts["ended by libhdf5"] += 1
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
        if len(lines) != 1:
            raise Failed(f"ended with {done.returncode} and said {lines}")
        # pthread_create() says of memory that it does not get what it says of threads.
        threads = words == "memory" and "Thread creation failed: Resource temporarily unavailable" in lines[0]
        if words not in lines[0].lower() and not threads:
            raise Failed(f"ended with {done.returncode}, but did not say {words}: {lines[0]}")

    def check_kept(self, before):
        now = self.bench.files()
        for name, data in before.items():
            if now.get(name) != data and not (self.command.whole and name in now and
                                              self.bench.same_results(self.command.whole, self.bench.at / name)):
                raise Failed(f"{name} is neither what it was nor whole")

    def check_files(self, what):
        now = self.bench.files()
        if sorted(now) != sorted(self.made):
            raise Failed(f"{what} {sorted(now)}")
        if self.command.output and now[self.command.output] != self.made[self.command.output]:
            raise Failed(f"{what} another {self.command.output}")
        if self.command.whole:
            self.bench.check_same(self.command.whole, what=what)

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


def mutants(bench):
    """Calls that fail silently, one kind after the other."""
    by_name = {command.name: command for command in commands(bench)}
    planted = [("run", "write"), ("run", "rename"), ("run", "remove"), ("report", "read"), ("merge", "read"),
               ("judge", "read")]
    survived = [f"{kind} of {name}" for name, kind in planted
                if not Failing(bench, by_name[name], 20, (kind,), silent=True).all().failures]
    finish("every resource fails once, silently", {"kinds": len(planted), "noticed": len(planted) - len(survived)},
           [f"nothing was noticed of a failed {one}" for one in survived])


def main():
    given = arguments(__doc__, most=0, callers=0, only="", mutants=0)
    tried = set()
    with Bench(given.credence) as bench:
        check_shim(bench)
        if given.mutants:
            return mutants(bench)
        finish_all("every resource fails once",
                   ((command.name, Failing(bench, command, given.most, callers=given.callers, tried=tried).all())
                    for command in commands(bench) if given.only in ("", command.name)))


if __name__ == "__main__":
    main()
