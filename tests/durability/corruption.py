"""A byte is flipped between writing and reading: each byte of a small journal and of small results files in turn. What
reads them finds the same as before, repairs it (a journal's damaged commits are computed again), cuts it short (`watch`
shows the commits before the damage), or refuses the file by name. The readers take turns: each flip is tried with the
next one. With --every N only each N-th byte, from --offset on; 1: all.

With --mutants all checksums are 0, as if none were compared: then each must fail."""

import random
import re
import shutil
import struct

from harness import Bench, Failed, arguments, finish

TRIALS = 300  # a block and a partial one
MORE = 600
KEPT = ("trials", "aggregates")


class Reader:
    """A command that reads x.h5, or its journal. `made` is the file that it makes, with the results of `whole`; `cuts`
    are what it may take a journal for as well."""

    def __init__(self, bench, name, data, command, made=None, whole=None, cuts=(), does="harmless"):
        self.bench, self.name, self.command, self.does = bench, name, command, does
        self.made, self.whole = made, whole
        self.cut_short = {printed(self.run(cut, bench.expect, 0)) for cut in cuts}
        self.printed = printed(self.run(data, bench.expect, 0))
        self.check_made()

    def run(self, data, run, *code):
        self.bench.empty()
        (self.bench.at / self.name).write_bytes(data)
        return run(*code, *self.command)

    def check_made(self):
        if self.made:
            self.bench.check_same(self.whole, self.made, self.command[0])

    def check(self, data):
        done = self.run(data, self.bench.run)
        if done.returncode == 0:
            if printed(done) != self.printed:
                if printed(done) in self.cut_short:
                    return "cut short"
                raise Failed(f"{self.command[0]} printed something else")
            self.check_made()
            return self.does
        if done.returncode not in (1, 2) or self.name not in done.stderr:
            raise Failed(f"{self.command[0]} ended with {done.returncode}: {done.stderr.strip()}")
        if self.bench.files() != {self.name: data}:
            raise Failed(f"{self.command[0]} refused it, but changed something: {sorted(self.bench.files())}")
        return "refused by name"


def printed(done):
    """What a command printed, but for the seconds since the last commit."""
    return re.sub(r'"seconds_since_commit": [^,\n]*', "", done.stdout)


def readers_of_results(bench, data, keep):
    same, grown, merged = (bench.root / f"{keep}-{what}.h5" for what in ("undamaged", "grown", "merged"))
    same.write_bytes(data)
    shutil.copy(same, grown)
    grow = ["run", "--resume", "--trials", str(MORE), "--quiet", "-o"]
    bench.expect(0, *grow, str(grown))
    bench.expect(0, "merge", str(same), "-o", str(merged), "--quiet")
    yield Reader(bench, "x.h5", data, ["report", "x.h5", "--format", "json"])
    yield Reader(bench, "x.h5", data, ["merge", "x.h5", "-o", "y.h5", "--quiet"], "y.h5", merged)
    yield Reader(bench, "x.h5", data, [*grow, "x.h5"], "x.h5", grown)
    yield Reader(bench, "x.h5", data, ["replay", "x.h5", "--scenario", "tiny", "--arm", "fixed.ekf", "--trial", "3",
                                       "--format", "json"])
    if keep == "trials":  # what keeps aggregates has nothing to compare trial by trial
        yield Reader(bench, "x.h5", data, ["compare", "x.h5", str(same), "--arms", "fixed.ekf,fixed.ekf", "--format",
                                           "json"])


def readers_of_journal(bench, data, keep, whole):
    name = "x.h5.journal"
    yield Reader(bench, name, data, bench.study("--resume", "--keep", keep, trials=TRIALS), "x.h5", whole,
                 does="repaired")
    yield Reader(bench, name, data, ["watch", "x.h5", "--once", "--format", "json"],
                 cuts=[data[:end + 4] for _, end in sections(data)])


class Damage:
    def __init__(self, every, offset):
        self.every, self.offset = every, offset
        self.counts = {"bytes": 0, "flipped": 0, "harmless": 0, "repaired": 0, "cut short": 0, "refused by name": 0}
        self.failures = []

    def flips(self, data):
        """Copies of `data` with one byte flipped: one bit of it, or all."""
        chance = random.Random(len(data))
        for at in range(self.offset % self.every, len(data), self.every):
            changed = bytearray(data)
            changed[at] ^= chance.choice((1, 1 << chance.randrange(8), 255))
            yield at, bytes(changed)

    def try_all(self, name, data, readers, to_first=False):
        """Each flip with the next reader; `to_first`: until one fails."""
        readers, before = list(readers), len(self.failures)
        self.counts["bytes"] += len(data)
        for number, (at, changed) in enumerate(self.flips(data)):
            if to_first and len(self.failures) > before:
                return
            self.counts["flipped"] += 1
            try:
                self.counts[readers[number % len(readers)].check(changed)] += 1
            except Failed as error:
                self.failures.append(f"{name}, byte {at} of {len(data)}: {error}")


def sections(journal):
    """Of a journal's beginning and each commit: where it starts and where its checksum does, by the sizes in it."""
    start, end = 0, 24 + struct.unpack_from("<I", journal, 20)[0]
    while end + 4 <= len(journal):
        yield start, end
        start = end + 4
        size = struct.unpack_from("<q", journal, start + 8)[0] if start + 16 <= len(journal) else -1
        if not 0 <= size <= len(journal):
            return
        end = start + 16 + size


def left_journal(bench, *more):
    """The journal of a run that is killed before it writes its file."""
    bench.empty()
    log = bench.root / "log"
    bench.expect(0, *bench.study(*more, trials=TRIALS), environment={"CRASH_LOG": log})
    changes = log.read_text().splitlines()
    log.unlink()
    last = next(i for i, line in enumerate(changes) if "partial" in line)
    bench.empty()
    bench.run(*bench.study(*more, trials=TRIALS), environment={"CRASH_AT": last + 1})
    return (bench.at / "x.h5.journal").read_bytes()


def undamaged(bench, keep):
    """A journal, and the results file of the same study."""
    return left_journal(bench, "--keep", keep), bench.make(f"{keep}.h5", "--keep", keep, trials=TRIALS)


def try_both(bench, damage, to_first=False):
    """Bytes of a journal and of a results file of each kind."""
    for keep in KEPT:
        journal, whole = undamaged(bench, keep)
        data = whole.read_bytes()
        damage.try_all(f"journal of {keep}", journal, readers_of_journal(bench, journal, keep, whole), to_first)
        damage.try_all(f"results of {keep}", data, readers_of_results(bench, data, keep), to_first)


def main():
    given = arguments(__doc__, every=1, offset=0, mutants=0)
    damage = Damage(given.every, given.offset)
    with Bench(given.credence) as bench:
        if given.mutants:
            bench.planted = {"NO_CHECKSUMS": 1}
        try_both(bench, damage, to_first=bool(given.mutants))
    if given.mutants:
        noticed = len(damage.failures)
        return finish("a flipped byte, checksums not compared", {**damage.counts, "noticed": noticed},
                      [] if noticed == 2 * len(KEPT) else [f"only these were noticed: {damage.failures}"])
    finish("a flipped byte", damage.counts, damage.failures)


if __name__ == "__main__":
    main()
