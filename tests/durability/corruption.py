"""A byte is flipped between writing and reading: each byte of a small journal and of small results files in turn. What
reads them finds the same as before, repairs it (a journal's damaged commits are computed again), or refuses the file by
name. With --every N only each N-th byte, from --offset on; 1: all.

With --mutants the checksums are made right again after the flip, as if nothing looked at them: then this must fail."""

import random
import struct
import zlib

from harness import Bench, Failed, arguments, finish, finish_mutant

TRIALS = 300  # a block and a partial one


class Damage:
    def __init__(self, bench, every, offset, mutant):
        self.bench, self.every, self.offset, self.mutant = bench, every, offset, mutant
        self.counts = {"bytes": 0, "flipped": 0, "harmless": 0, "repaired": 0, "refused by name": 0}
        self.failures = []

    def flips(self, name, data):
        """Copies of `data` with one byte flipped: one bit of it, or all."""
        chance = random.Random(len(data))
        self.counts["bytes"] += len(data)
        for at in range(self.offset % self.every, len(data), self.every):
            changed = bytearray(data)
            changed[at] ^= chance.choice((1, 1 << chance.randrange(8), 255))
            self.counts["flipped"] += 1
            try:
                yield at, self.corrected(name, bytes(changed))
            except Failed as error:
                self.failures.append(f"{name}, byte {at} of {len(data)}: {error}")

    def corrected(self, name, data):
        if not self.mutant or "journal" not in name:
            return data
        return right_checksums(data)

    def try_all(self, name, data, check):
        for at, changed in self.flips(name, data):
            if self.mutant and self.failures:
                return
            try:
                self.counts[check(changed)] += 1
            except Failed as error:
                self.failures.append(f"{name}, byte {at} of {len(data)}: {error}")

    def results(self, name, whole, prints):
        """A file is reported and merged."""
        bench = self.bench

        def check(data):
            bench.empty()
            (bench.at / "x.h5").write_bytes(data)
            done = bench.run("report", "x.h5", "--format", "json")
            merged = bench.run("merge", "x.h5", "-o", "y.h5", "--quiet")
            if done.returncode == 0 and done.stdout != prints:
                raise Failed("report printed other numbers")
            if merged.returncode == 0:
                bench.check_same(whole, "y.h5", "merge")
            if done.returncode == merged.returncode == 0:
                return "harmless"
            for one in (done, merged):
                if one.returncode != 0 and not (one.returncode in (1, 2) and "x.h5" in one.stderr):
                    raise Failed(f"it ended with {one.returncode}: {one.stderr.strip()}")
            return "refused by name"

        self.try_all(name, whole.read_bytes(), check)

    def journal(self, name, journal, whole, more=()):
        """A journal is gone on with."""
        bench = self.bench

        def check(data):
            bench.empty()
            (bench.at / "x.h5.journal").write_bytes(data)
            done = bench.run(*bench.study("--resume", *more, trials=TRIALS))
            if done.returncode == 2 and "x.h5.journal" in done.stderr and bench.files() == {"x.h5.journal": data}:
                return "refused by name"
            if done.returncode != 0:
                raise Failed(f"it ended with {done.returncode}: {done.stderr.strip()}")
            bench.check_same(whole, what="resume")
            return "repaired"

        self.try_all(name, journal, check)


def right_checksums(journal):
    """The journal with every checksum computed again."""
    data = bytearray(journal)

    def put(start, end):
        if end + 4 <= len(data):
            data[end:end + 4] = struct.pack("<I", zlib.crc32(data[start:end]))
        return end + 4

    position = put(0, 24 + struct.unpack_from("<I", data, 20)[0])
    while position + 16 <= len(data):
        size = struct.unpack_from("<q", data, position + 8)[0]
        if not 0 <= size <= len(data):
            break
        position = put(position, position + 16 + size)
    return bytes(data)


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


def main():
    given = arguments(__doc__, every=1, offset=0, mutants=0)
    with Bench(given.credence) as bench:
        damage = Damage(bench, given.every, given.offset, given.mutants)
        for keep in ("trials", "aggregates"):
            more = ("--keep", keep)
            whole = bench.make(f"{keep}.h5", *more, trials=TRIALS)
            prints = bench.expect(0, "report", str(whole), "--format", "json").stdout
            damage.journal(f"journal of {keep}", left_journal(bench, *more), whole, more)
            if not given.mutants:
                damage.results(f"results of {keep}", whole, prints)
    if given.mutants:
        return finish_mutant("a flipped byte, checksums made right", damage.counts, damage.failures,
                             "no journal with right checksums and wrong bytes gave other results")
    finish("a flipped byte", damage.counts, damage.failures)


if __name__ == "__main__":
    main()
