"""Two programs on the same files take turns: before each call on a file the one waits while the other goes on
(shim/meet.c), in a schedule that a seed gives. They meet under one name, a symbolic link, a hard link or a bind
mount of the folder. No command that ends with 0 may lose its work: what it wrote, or what it went on with, is
there at the end, or was replaced by another one that was asked to.

With --mutants locks are not taken, as if files were locked by name only (FAIL=lock): then this must fail."""

import os
import random
import selectors
import socket
import subprocess

from harness import LESS, Bench, Failed, arguments, finish, finish_mutant

NAMES = ("same", "symbolic link", "hard link", "bind mount")


class Side:
    """A program that takes turns."""

    def __init__(self, bench, command, folder, environment):
        self.name = " ".join(command[:1] + [word for word in command if word in ("--resume", "--overwrite")])
        ours, theirs = socket.socketpair()
        self.turns, self.waits = ours, False
        variables = {**os.environ, "LD_PRELOAD": bench.shim, "MEET": str(theirs.fileno()), **environment}
        self.process = subprocess.Popen([bench.credence, *command], cwd=folder, env=variables, stdin=subprocess.DEVNULL,
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, errors="replace",
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
        self.waits = False
        self.turns.sendall(b"g")

    def end(self):
        self.said = self.process.communicate(timeout=30)[1]
        self.code = self.process.returncode


def take_turns(sides, chance):
    """Lets one of those that wait go on, until both have ended; a schedule has long and short runs of one side."""
    selector = selectors.DefaultSelector()
    for side in sides:
        selector.register(side.turns, selectors.EVENT_READ, side)
    shares, turns = chance.choice(((1, 1), (1, 8), (8, 1), (1, 50), (50, 1))), 0
    while any(side.turns for side in sides):
        for key, _ in selector.select(0 if any(side.waits for side in sides) else 20):
            turns_of = key.fileobj
            key.data.read()
            if key.data.turns is None:
                selector.unregister(turns_of)
        ready = [side for side in sides if side.turns]
        if ready and all(side.waits for side in ready):  # both wait, or the other has ended
            chance.choices(ready, [shares[sides.index(side)] for side in ready])[0].goes_on()
            turns += 1
    for side in sides:
        side.end()
    return turns


class Pair:
    """Two commands, and what is there when they begin. `path` is the second one's name of x.h5."""

    def __init__(self, name, first, second, start, expected):
        self.name, self.first, self.second, self.start, self.expected = name, first, second, start, expected


def pairs(bench):
    bench.make("whole.h5")
    bench.make("seed2.h5", "--seed", "2")
    less = bench.make("less.h5", trials=LESS)
    shards = [str(bench.make(f"{i}.h5", "--shard", f"{i}/3")) for i in range(3)]

    def run(*more):
        return lambda name: bench.study(*more, output=name)

    def merge(*more):
        return lambda name: ["merge", *shards, "-o", name, "--quiet", *more]

    def look(command):
        return lambda name: [command, name, *(["--once"] if command == "watch" else [])]

    whole, other = "whole.h5", "seed2.h5"
    yield Pair("run, run", run(), run("--seed", "2"), {}, (whole, other))
    yield Pair("run, resume", run(), run("--resume"), {}, (whole, whole))
    yield Pair("resume, resume", run("--resume"), run("--resume"), {"x.h5": less}, (whole, whole))
    yield Pair("run, overwrite", run(), run("--seed", "2", "--overwrite"), {}, (whole, other))
    yield Pair("resume, overwrite", run("--resume"), run("--seed", "2", "--overwrite"), {"x.h5": less}, (whole, other))
    yield Pair("overwrite, overwrite", run("--overwrite"), run("--seed", "2", "--overwrite"), {"x.h5": less},
               (whole, other))
    yield Pair("merge, run", merge(), run("--seed", "2"), {}, (whole, other))
    yield Pair("merge, resume", merge("--overwrite"), run("--resume"), {"x.h5": less}, (whole, whole))
    yield Pair("merge, merge", merge(), merge("--overwrite"), {}, (whole, whole))
    yield Pair("run, watch", run(), look("watch"), {}, (whole, None))
    yield Pair("resume, report", run("--resume"), look("report"), {"x.h5": less}, (whole, None))


class Interleaving:
    def __init__(self, bench, environment):
        self.bench, self.environment = bench, environment
        self.counts = {"schedules": 0, "turns": 0, "both ended with 0": 0, "one refused": 0, "both refused": 0}
        self.mounts = can_mount(bench)

    def second_folder(self, kind):
        """Where the second program works, and its name for the file."""
        at = self.bench.at
        if kind == "symbolic link":
            (at / "link.h5").symlink_to("x.h5")
            return at, "link.h5"
        if kind == "hard link" and (at / "x.h5").exists():
            os.link(at / "x.h5", at / "hard.h5")
            return at, "hard.h5"
        if kind == "bind mount":
            return self.bench.root / "mounted", "x.h5"
        return at, "x.h5"

    def one(self, pair, kind, seed):
        bench, chance = self.bench, random.Random(seed)
        bench.empty()
        for name, source in pair.start.items():
            (bench.at / name).write_bytes(source.read_bytes())
        folder, name = self.second_folder(kind)
        sides = [Side(bench, pair.first("x.h5"), bench.at, self.environment),
                 Side(bench, pair.second(name), folder, self.environment)]
        try:
            self.counts["turns"] += take_turns(sides, chance)
        finally:
            for side in sides:
                if side.process.poll() is None:
                    side.process.kill()
        self.counts["schedules"] += 1
        ended = sum(side.code == 0 for side in sides)
        self.counts[("both refused", "one refused", "both ended with 0")[ended]] += 1
        self.check(pair, sides, name if name == "hard.h5" else "x.h5", kind)

    def check(self, pair, sides, second_name, kind):
        """The work of each that ended with 0 is under its name, or was replaced by one that was asked to."""
        for side in sides:
            if side.code not in (0, 1, 2):
                raise Failed(f"{side.name} ended with {side.code}: {side.said}")
            if side.code and not side.said.startswith("credence "):
                raise Failed(f"{side.name} ended with {side.code}, and said {side.said!r}")
        for number, name in enumerate(("x.h5", second_name)):
            expected, other = pair.expected[number], pair.expected[1 - number]
            if sides[number].code != 0 or expected is None:
                continue
            allowed = {expected}
            same_name = name == ("x.h5", second_name)[1 - number]
            if sides[1 - number].code == 0 and other and same_name and "--overwrite" in sides[1 - number].name:
                allowed.add(other)
            if not (self.bench.at / name).exists() or not any(
                    self.bench.same_results(self.bench.root / one, self.bench.at / name) for one in allowed):
                raise Failed(f"{sides[number].name} ended with 0, and its work is gone (the other: "
                             f"{sides[1 - number].name} with {sides[1 - number].code}; there is "
                             f"{sorted(self.bench.files())})")
        left = [path for path in self.bench.files() if path.endswith(".credence-partial")]
        if left:
            raise Failed(f"it left {left}")


def can_mount(bench):
    mounted = bench.root / "mounted"
    mounted.mkdir(exist_ok=True)
    done = subprocess.run(["mount", "--bind", str(bench.at), str(mounted)], capture_output=True)
    return done.returncode == 0


def main():
    given = arguments(__doc__, schedules=1000, seed=1, mutants=0, only="")
    failures = []
    with Bench(given.credence) as bench:
        # Every lock is granted at once: fail.c says that each flock succeeded.
        granted = {"FAIL": "lock", "FAIL_SILENT": "1", "FAIL_ALWAYS": "1"}
        harness = Interleaving(bench, granted if given.mutants else {})
        names = [kind for kind in NAMES if kind != "bind mount" or harness.mounts]
        if not harness.mounts:
            print("  bind mount: left out, nothing can be mounted here", flush=True)
        everything = [(pair, kind) for pair in pairs(bench) for kind in names if given.only in pair.name]
        try:
            for number in range(given.schedules):
                pair, kind = everything[number % len(everything)]
                try:
                    harness.one(pair, kind, given.seed * 1_000_000 + number)
                except (Failed, subprocess.TimeoutExpired) as error:
                    failures.append(f"{pair.name}, {kind}, schedule {number}: {error}")
                if given.mutants and failures:
                    break
                if (number + 1) % 100 == 0:
                    print(f"  {number + 1} schedules, {len(failures)} failures", flush=True)
        finally:
            if harness.mounts:
                subprocess.run(["umount", str(bench.root / "mounted")], check=False)
    if given.mutants:
        return finish_mutant("two programs in turns, without locks", harness.counts, failures,
                             "nothing was lost without locks")
    finish("two programs in turns", harness.counts, failures)


if __name__ == "__main__":
    main()
