"""Two programs on the same files take turns: before each call on a file the one waits while the other goes on
(shim/meet.c), in a schedule that a seed gives. They meet under one name, a symbolic link, a hard link or a bind
mount of the folder. No command that ends with 0 may lose its work: what it wrote, or what it went on with, is
there at the end, or was replaced by another one that was asked to. What report and watch print is what they print of
a file that nobody touches, with the trials that were there at some time.

With --mutants 1 two bugs are planted, which must be noticed. Every lock is granted (FAIL=lock); and files are locked by
name (shim/locks.c), which must lose something under a bind mount, but nothing in the same schedules under one name."""

import os
import random
import subprocess

from harness import Bench, Failed, arguments, finish, finish_mutant
from pairs import OTHER, WHOLE, pairs
from turns import Side, take_turns

NAMES = ("one name", "a symbolic link", "a hard link", "a bind mount")


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
