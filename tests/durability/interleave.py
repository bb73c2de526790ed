"""Two programs on the same files take turns: before each call on a file the one waits while the other goes on
(shim/meet.c), in a schedule that a seed gives. They meet under one name, a symbolic link, a hard link or a bind
mount of the folder. No command that ends with 0 may lose its work: what it wrote, or what it went on with, is
there at the end, or was replaced by another one that was asked to. What report and watch print is what they print of
a file that nobody touches, with the trials that were there at some time.

With --mutants 1 two bugs are planted, which must be noticed. Every lock is granted (FAIL=lock); and files are locked by
name (shim/locks.c), which must lose something under a bind mount, but nothing in the same schedules under one name."""

import json
import math
import os
import random
import selectors
import socket
import subprocess
import tempfile

from harness import LESS, TRIALS, Bench, Failed, arguments, finish, finish_mutant

NAMES = ("one name", "a symbolic link", "a hard link", "a bind mount")
BLOCK = 256
WHOLE, OTHER = "whole.h5", "seed2.h5"  # two studies
HANGS = 20  # seconds


class Side:
    """A program that takes turns."""

    def __init__(self, bench, words, folder, environment):
        self.name = " ".join(words[:1] + [word for word in words if word in ("--resume", "--overwrite")])
        self.turns, theirs = socket.socketpair()
        self.waits, self.taken = False, 0
        self.output = tempfile.TemporaryFile("w+")  # a pipe that is full would make it wait where it takes no turn
        variables = {**os.environ, "LD_PRELOAD": bench.shim, "MEET": str(theirs.fileno()), **environment}
        self.process = subprocess.Popen([bench.credence, *words], cwd=folder, env=variables, stdin=subprocess.DEVNULL,
                                        stdout=self.output, stderr=subprocess.PIPE, text=True, errors="replace",
                                        pass_fds=[theirs.fileno()])
        theirs.close()

    def read(self):
        """It waits before a call, or has ended."""
        if self.turns.recv(4096):
            self.waits = True
        else:
            self.turns.close()
            self.turns = None

    def goes_on(self):
        self.waits, self.taken = False, self.taken + 1
        self.turns.sendall(b"g")

    def end(self):
        self.said = self.process.communicate(timeout=30)[1]
        self.code = self.process.returncode
        self.output.seek(0)
        self.printed = self.output.read()

    def check_end(self):
        """It ended as a command may: where it refused, with one line."""
        if self.taken == 0:
            raise RuntimeError(f"{self.name} took no turn: the library of shim/ is not loaded")  # no mutant's failure
        if self.code not in (0, 1, 2):
            raise Failed(f"{self.name} ended with {self.code}: {self.said}")
        if self.code and not (self.said.startswith("credence ") and self.said.count("\n") == 1):
            raise Failed(f"{self.name} ended with {self.code}, and said {self.said!r}")


def by_shares(chance):
    """Which side has each turn: each has a share of them."""
    shares = chance.choice(((1, 1), (1, 8), (8, 1), (1, 50), (50, 1)))
    while True:
        yield chance.choices((0, 1), shares)[0]


def by_lengths(chance):
    """Which side has each turn: each has up to so many in a row, 20 to 2,000. So one may wait in the middle of its
    writing until the other has come to its own."""
    side, most = chance.randrange(2), [20 * 100 ** chance.random() for _ in (0, 1)]
    while True:
        for _ in range(int(most[side] * chance.random())):
            yield side
        side = 1 - side


def take_turns(sides, chance):
    """Lets one of those that wait go on, until both have ended."""
    selector = selectors.DefaultSelector()
    for side in sides:
        selector.register(side.turns, selectors.EVENT_READ, side)
    schedule = chance.choice((by_shares, by_lengths))(chance)
    while any(side.turns for side in sides):
        events = selector.select(HANGS)
        if not events:
            raise Failed(f"a program did nothing for {HANGS} s")
        for key, _ in events:
            turns_of = key.fileobj
            key.data.read()
            if key.data.turns is None:
                selector.unregister(turns_of)
        ready = [side for side in sides if side.turns]
        if ready and all(side.waits for side in ready):  # both wait, or the other has ended
            chosen = sides[next(schedule)]
            (chosen if chosen in ready else ready[0]).goes_on()
    for side in sides:
        side.end()


class Command:
    """What a side does: `words` makes its command line of its name for the shared file. Where it ends with 0, the file
    `output`, or else the shared one, has the results of the file `result` beside the folder, and `check` finds nothing
    wrong with what it printed. A command that only reads a file that is always there may not refuse."""

    def __init__(self, words, result=None, output=None, check=lambda printed: None, may_refuse=True):
        self.words, self.result, self.output = words, result, output
        self.check, self.may_refuse = check, may_refuse


class Pair:
    """Two commands, what is there when they begin, and the file that both name."""

    def __init__(self, name, first, second, start=None, shared="x.h5"):
        self.name, self.commands, self.start, self.shared = name, (first, second), start or {}, shared


def pairs(bench):
    bench.make(WHOLE)
    bench.make(OTHER, "--seed", "2")
    less = {"x.h5": bench.make("less.h5", trials=LESS)}
    shards = [bench.make(f"{i}.h5", "--shard", f"{i}/3") for i in range(3)]
    paths = [str(path) for path in shards]

    def run(*more, result=WHOLE):
        return Command(lambda name: bench.study(*more, output=name), result)

    def merge(*more):
        return Command(lambda name: ["merge", *paths, "-o", name, "--quiet", *more], WHOLE)

    def report(*sources):
        return Command(lambda name: ["report", name, "--format", "csv"], check=report_of(bench, sources),
                       may_refuse=False)

    def watch(may_refuse):
        return Command(lambda name: ["watch", name, "--once", "--format", "json"], check=snapshot,
                       may_refuse=may_refuse)

    resume, other = run("--resume"), run("--seed", "2", result=OTHER)
    overwrite, merge_over = run("--seed", "2", "--overwrite", result=OTHER), merge("--overwrite")
    snapshot = snapshot_of(bench)
    yield Pair("run, run", run(), other)
    yield Pair("run, resume", run(), resume)
    yield Pair("resume, resume", resume, resume, less)
    yield Pair("run, overwrite", run(), overwrite)
    yield Pair("resume, overwrite", resume, overwrite, less)
    yield Pair("overwrite, overwrite", run("--overwrite"), overwrite, less)
    yield Pair("overwrite, merge", overwrite, merge_over, less)
    yield Pair("merge, run", merge(), other)
    yield Pair("merge, resume", merge_over, resume, less)
    yield Pair("merge, merge", merge(), merge_over)
    yield Pair("run, watch", run(), watch(may_refuse=True))
    yield Pair("resume, watch", resume, watch(may_refuse=False), less)
    yield Pair("resume, report", resume, report("less.h5", WHOLE), less)
    yield Pair("overwrite, report", overwrite, report("less.h5", OTHER), less)
    yield Pair("merge, report", merge_over, report("less.h5", WHOLE), less)
    yield from pairs_of_inputs(bench, shards)


def pairs_of_inputs(bench, shards):
    """The first shard is gone on with, or replaced by one of another study, while all are merged: what is merged is of
    one study, and lacks nothing."""
    part = bench.root / "part.h5"
    shard = ["--shard", "0/3"]
    bench.expect(3, *bench.study(*shard, output=str(part)), environment={"CRASH_SIGNAL_AT": 6})
    bench.expect(1, "merge", str(part), *map(str, shards[1:]), "-o", "lacking.h5")  # it has only one of two blocks
    bench.make("other0.h5", *shard, "--seed", "2")
    start = {path.name: path for path in shards}
    merge = Command(lambda name: ["merge", name, "1.h5", "2.h5", "-o", "x.h5", "--quiet"], WHOLE, "x.h5")
    resume = Command(lambda name: bench.study(*shard, "--resume", output=name), "0.h5")
    overwrite = Command(lambda name: bench.study(*shard, "--seed", "2", "--overwrite", output=name), "other0.h5")
    yield Pair("merge, input resumed", merge, resume, {**start, "0.h5": part}, "0.h5")
    yield Pair("merge, input overwritten", merge, overwrite, start, "0.h5")


def report_of(bench, sources):
    """A check that a report is that of one of these files."""
    known = {bench.expect(0, "report", str(bench.root / source), "--format", "csv").stdout for source in sources}

    def check(printed):
        if printed not in known:
            raise Failed(f"it is the report of none of {', '.join(sources)}")

    return check


def snapshot_of(bench):
    """A check that a snapshot is that of a run up to the last of its trials: it has whole blocks, or all trials."""
    files = {LESS: "less.h5", TRIALS: WHOLE}
    for trials in (LESS, TRIALS, *range(BLOCK, TRIALS, BLOCK)):
        bench.make(files.setdefault(trials, f"{trials}-trials.h5"), trials=trials)
    known = {trials: json.loads(bench.expect(0, "watch", str(bench.root / name), "--format", "json").stdout)[0]
             for trials, name in files.items()}
    of_the_run = ("state", "trials_asked", "blocks_asked", "seconds_since_commit")

    def check(printed):
        for arm in json.loads(printed):
            done = arm["trials"]
            expected = {**known.get(done, {}), **{name: arm[name] for name in of_the_run}}
            if done != 0 and not same_numbers(arm, expected):
                raise Failed(f"a snapshot of {done} trials has other numbers than a file with them")
            if done != arm["trials_asked"] and arm["state"] == "complete":
                raise Failed(f"a snapshot says that {done} of {arm['trials_asked']} trials are complete")

    return check


def same_numbers(one, other):
    """But for the rounding of sums that are added up in another order."""
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(same_numbers(one[name], other[name]) for name in one)
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(same_numbers, one, other))
    if isinstance(one, float) and isinstance(other, float):
        return math.isclose(one, other, rel_tol=1e-9)
    return one == other


class Interleaving:
    def __init__(self, bench, environment=None):
        self.bench, self.environment, self.failures = bench, environment or {}, []
        self.counts = {"schedules": 0, "turns": 0, "both ended with 0": 0, "one refused": 0, "both refused": 0}

    def second_name(self, pair, kind):
        """The second program's folder and its name of the shared file."""
        at = self.bench.at
        if kind == "a symbolic link":
            (at / "link.h5").symlink_to(pair.shared)
            return at, "link.h5"
        if kind == "a hard link":
            os.link(at / pair.shared, at / "hard.h5")
            return at, "hard.h5"
        return self.bench.root / "mounted" if kind == "a bind mount" else at, pair.shared

    def one(self, pair, kind, seed):
        """A schedule; notes what went wrong."""
        try:
            self.check(pair, kind, self.sides(pair, kind, random.Random(seed)))
        except (Failed, subprocess.TimeoutExpired) as error:
            self.failures.append(f"{pair.name}, {kind}, seed {seed}: {error}")

    def sides(self, pair, kind, chance):
        """Two programs that have taken turns and ended."""
        self.bench.begin(pair.start)
        folder, name = self.second_name(pair, kind)
        first, second = pair.commands
        sides = [Side(self.bench, first.words(pair.shared), self.bench.at, self.environment),
                 Side(self.bench, second.words(name), folder, self.environment)]
        try:
            take_turns(sides, chance)
        finally:
            for side in sides:
                if side.process.poll() is None:
                    side.process.kill()
                    side.process.communicate()
        ended = sum(side.code == 0 for side in sides)
        where = "under one name" if kind == "one name" else "by " + kind
        for what, more in (("schedules", 1), ("turns", sum(side.taken for side in sides)),
                           (("both refused", "one refused", "both ended with 0")[ended], 1), (where, 1)):
            self.counts[what] = self.counts.get(what, 0) + more
        return sides

    def check(self, pair, kind, sides):
        for side in sides:
            side.check_end()
        for side, command in zip(sides, pair.commands):
            if side.code == 0:
                command.check(side.printed)
            elif not command.may_refuse:
                raise Failed(f"{side.name} refused a file that was always there: {side.said}")
        names = [command.output or name for command, name in
                 zip(pair.commands, (pair.shared, "hard.h5" if kind == "a hard link" else pair.shared))]
        for number in (0, 1):
            self.check_work(pair, sides, names, number)
        left = [path for path in self.bench.files() if path.endswith(".credence-partial")]
        if left:
            raise Failed(f"it left {left}")

    def check_work(self, pair, sides, names, number):
        """The work of a side that ended with 0 is under its name, or was replaced by the other that was asked to."""
        side, other = sides[number], sides[1 - number]
        if side.code != 0 or pair.commands[number].result is None:
            return
        allowed = [pair.commands[number].result]
        if other.code == 0 and names[0] == names[1] and "--overwrite" in other.name:
            allowed.append(pair.commands[1 - number].result)
        path = self.bench.at / names[number]
        if not path.exists() or not any(self.bench.same_results(self.bench.root / one, path) for one in allowed):
            raise Failed(f"{side.name} ended with 0, and its work is gone (the other: {other.name} with {other.code}; "
                         f"there is {sorted(self.bench.files())})")


class Mounted:
    """A second name of the folder, where this machine lets us; says so where it does not."""

    def __init__(self, bench):
        self.at = bench.root / "mounted"
        self.at.mkdir()
        self.there = subprocess.run(["mount", "--bind", bench.at, self.at], capture_output=True).returncode == 0

    def __enter__(self):
        return self.there

    def __exit__(self, *_):
        if self.there:
            subprocess.run(["umount", self.at], check=False)


def combinations(chosen, kinds):
    """Each pair under each kind of name; only a file that is there has a hard link."""
    return [(pair, kind) for pair in chosen for kind in kinds if kind != "a hard link" or pair.shared in pair.start]


def kept_apart(chosen):
    """The pairs that need locks most: two studies are written to one file, and that which is merged has no journal."""
    return [pair for pair in chosen if "merge" in pair.name and not pair.commands[0].output
            and {command.result for command in pair.commands} == {WHOLE, OTHER}]


def without_locks(bench, chosen, given, kinds):
    """Every lock is granted at once: fail.c says that each flock succeeded."""
    harness = Interleaving(bench, {"FAIL": "lock", "FAIL_SILENT": "1", "FAIL_ALWAYS": "1"})
    everything = combinations(chosen, kinds)
    for number in range(given.schedules):
        harness.one(*everything[number % len(everything)], given.seed * 1_000_000 + number)
        if harness.failures:
            break
    finish_mutant("two programs in turns, without locks", harness.counts, harness.failures,
                  "nothing was lost without locks")


def locks_by_name(bench, chosen, given):
    """Under a bind mount until it is noticed, and the same schedules under one name, where it is no bug."""
    (bench.root / "locks").mkdir()
    environment = {"LOCKS_BY_NAME": str(bench.root / "locks")}
    mounted, same = Interleaving(bench, environment), Interleaving(bench, environment)
    for number in range(given.schedules):
        seed, pair = given.seed * 1_000_000 + number, chosen[number % len(chosen)]
        mounted.one(pair, "a bind mount", seed)
        same.one(pair, "one name", seed)
        if mounted.failures:
            break
    name = "two programs in turns, locks by name"
    counts = {what: mounted.counts.get(what, 0) + same.counts.get(what, 0)
              for what in {**mounted.counts, **same.counts}}
    if same.failures:
        finish(name, counts, [f"under one name, where it is no bug: {failure}" for failure in same.failures])
    finish_mutant(name, counts, mounted.failures, "nothing was lost with locks by name")


def all_schedules(bench, chosen, given, kinds):
    harness, everything = Interleaving(bench), combinations(chosen, kinds)
    for number in range(given.schedules):
        harness.one(*everything[number % len(everything)], given.seed * 1_000_000 + number)
        if (number + 1) % 100 == 0:
            print(f"  {number + 1} schedules, {len(harness.failures)} failures", flush=True)
    finish("two programs in turns", harness.counts, harness.failures)


def main():
    given = arguments(__doc__, schedules=1000, seed=1, mutants=0, only="")
    with Bench(given.credence) as bench, Mounted(bench) as there:
        chosen = [pair for pair in pairs(bench) if given.only in pair.name]
        kinds = [kind for kind in NAMES if kind != "a bind mount" or there]
        # A line that begins with the name of a summary, and is not hidden by all.sh.
        left_out = "left out, nothing can be mounted here"
        if not given.mutants:
            if not there:
                print(f"two programs in turns: a bind mount is {left_out}", flush=True)
            return all_schedules(bench, chosen, given, kinds)
        without_locks(bench, kept_apart(chosen), given, kinds)
        if not there:
            return print(f"two programs in turns, locks by name: {left_out}", flush=True)
        locks_by_name(bench, kept_apart(chosen), given)


if __name__ == "__main__":
    main()
