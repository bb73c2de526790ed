"""Power loss: every write and sync of a run, resume, overwrite and merge is recorded (shim/record.c); after every one
of them the disk forgets what it may (replay.py). The results file is then the old one, the whole new one or not there,
and the new one is there once the command had ended. The program goes on from there: it ends with the results of an
undisturbed run and computes no block again whose commit had returned. It may refuse only before anything was committed.
Of the ways in which many unsynced sectors reach the disk --some random ones are tried; of all folders every --every-th.

With --mutants every sync of a run and of a merge is left out in turn: then this must fail. Two of a run are not needed
for what is promised: that of the header, which the first commit's covers, and that of the journal's removal."""

import os
import shutil
import struct

from commands import torn_journal
from harness import LESS, Bench, Failed, arguments, finish, finish_all
from replay import Disk, read_trace

BLOCKS, PRESENT = 6, 2  # of the study; of less.h5 that it keeps


def commits_in(journal):
    """Whole commits (docs/theory/durability.md, The journal), by their lengths."""
    if len(journal) < 24:
        return 0
    position, count = 28 + struct.unpack_from("<I", journal, 20)[0], 0
    while position + 16 <= len(journal):
        position += 20 + struct.unpack_from("<q", journal, position + 8)[0]
        count += position <= len(journal)
    return count


class Case:
    """A command, the files that it starts with, and the command that goes on after a power failure."""

    def __init__(self, name, command, again, start=None, whole="whole.h5", blocks=BLOCKS, environment=None, code=0):
        self.name, self.command, self.again, self.start = name, command, again, start or {}
        self.whole, self.blocks, self.environment, self.code = whole, blocks, environment or {}, code


def cases(bench):
    study, resume = bench.study(), bench.study("--resume")
    aggregates = ["--keep", "aggregates"]
    bench.make("whole.h5")
    less, other = bench.make("less.h5", trials=LESS), bench.make("other.h5", "--seed", "2", trials=300)
    shards = [str(bench.make(f"{i}.h5", "--shard", f"{i}/3")) for i in range(3)]
    bench.make("aggregates.h5", *aggregates)
    merge = ["merge", *shards, "-o", "x.h5", "--quiet"]
    yield Case("fresh", study, resume)
    yield Case("stopped", study, resume, environment={"CRASH_SIGNAL_AT": 14}, code=3)
    yield Case("torn", resume, resume, start={"x.h5.journal": torn_journal(bench, "torn")})
    yield Case("grown", resume, resume, {"x.h5": less}, blocks=BLOCKS - PRESENT)
    yield Case("overwritten", bench.study("--overwrite"), resume, {"x.h5": other})
    yield Case("aggregates", bench.study(*aggregates), bench.study(*aggregates, "--resume"), whole="aggregates.h5")
    yield Case("merge", merge, [*merge, "--overwrite"], blocks=0)


class PowerLoss:
    def __init__(self, bench, case, some, every=1, left_out=0, places=()):
        self.bench, self.case, self.some, self.every = bench, case, some, every
        self.left_out, self.places = left_out, places  # which sync, 0: none; and where each of them is in the trace
        self.counts = {"changes": 0, "folders": 0, "resumed": 0, "refused": 0}
        self.failures, self.seen, self.whole = [], set(), set()

    def record(self):
        bench, case = self.bench, self.case
        bench.begin(case.start)
        start = {path.name: (path.stat().st_ino, path.read_bytes()) for path in bench.at.iterdir()}
        trace = bench.root / "trace"
        trace.unlink(missing_ok=True)
        bench.expect(case.code, *case.command,
                     environment={"RECORD": trace, "RECORD_LEFT_OUT": self.left_out, **case.environment})
        shutil.copy(bench.at / "x.h5", bench.root / "made.h5")
        self.events = read_trace(trace)
        disk = Disk(start)
        for event in self.events:
            disk.happens(event)
        if {name: disk.files[inode].now() for name, inode in disk.names.items()} != bench.files():
            raise Failed(f"{case.name}: a change passed unrecorded")
        self.base = start.get("x.h5")
        return start

    def all(self):
        """Power fails before every change, and after the last."""
        disk, promised = Disk(self.record()), 0
        # Up to a sync that is left out, nothing differs from the run that has it.
        first = self.left_out and self.places[self.left_out - 1]
        for number, event in enumerate([*self.events, None]):
            if number >= first:
                self.try_folders(disk, promised, number)
            if event is None or (self.left_out and self.failures):
                break
            journal = disk.names.get("x.h5.journal")
            if journal and (event.inode != journal or (event.call.startswith("pwrite") and event.at > 0)):
                # The program goes on to the next commit or to another file, so the commits before have returned.
                promised = max(promised, commits_in(disk.files[journal].now()))
            disk.happens(event)
            if event.call == "fdatasync" and event.inode == journal:
                promised = max(promised, commits_in(disk.files[journal].durable))
        self.counts["changes"] = len(self.events)
        return self

    def try_folders(self, disk, promised, number):
        for folder in disk.outcomes(number, self.some):
            key = (promised if self.case.blocks else 0, number == len(self.events),
                   frozenset((name, hash(image) if not name.endswith("partial") else 0)
                             for name, (_, image) in folder.items()))
            if key in self.seen:
                continue
            self.seen.add(key)
            if (len(self.seen) - 1) % self.every:
                continue
            self.counts["folders"] += 1
            try:
                self.go_on(folder, promised, number == len(self.events))
            except (Failed, OSError) as error:
                self.failures.append(f"{self.case.name}, power lost before change {number + 1}: {error}")
            if self.left_out and self.failures:
                return

    def put(self, folder):
        self.bench.empty()
        for name, (inode, image) in folder.items():
            if self.base and inode == self.base[0] and image == self.base[1]:
                os.link(self.case.start["x.h5"], self.bench.at / name)
            else:
                (self.bench.at / name).write_bytes(image)

    def check_file(self, folder, ended):
        """The results file is the old one, the whole new one or not there; the new one where the command had ended."""
        image = folder.get("x.h5", (None, None))[1]
        if not ended and image == (self.base and self.base[1]):
            return
        if image is None or image not in self.whole and not self.bench.same_results(self.bench.root / "made.h5",
                                                                                   self.bench.at / "x.h5"):
            raise Failed("the command had ended, and its file is not there" if ended else "there is half a file")
        self.whole.add(image)

    def go_on(self, folder, promised, ended):
        bench, case = self.bench, self.case
        self.put(folder)
        self.check_file(folder, ended)
        trace = bench.root / "again"
        trace.unlink(missing_ok=True)
        done = bench.run(*case.again, environment={"RECORD": trace})
        if done.returncode == 2:
            return self.refused(done, folder, promised, ended)
        if done.returncode != 0:
            raise Failed(f"going on ended with {done.returncode}: {done.stderr.strip()}")
        self.counts["resumed"] += 1
        if [path.name for path in bench.at.iterdir()] != ["x.h5"]:
            raise Failed("it left " + " ".join(path.name for path in bench.at.iterdir()))
        bench.check_same(bench.root / case.whole, what=case.name)
        again = computed(read_trace(trace))
        if case.blocks and again + promised > case.blocks:
            raise Failed(f"{promised} commits had returned, but {again} of {case.blocks} blocks ran again")
        if ended and case.code == 0 and trace.exists() and again:
            raise Failed("the command had ended with 0, but blocks ran again")

    def refused(self, done, folder, promised, ended):
        """A refusal changes nothing, is about a file that is there, and costs no commit that had returned."""
        self.counts["refused"] += 1
        if {name: image for name, (_, image) in folder.items()} != self.bench.files():
            raise Failed(f"it refused, and changed files: {done.stderr.strip()}")
        untouched = folder.get("x.h5", (None, None))[1] == (self.base and self.base[1])
        if promised or ended or not untouched or "x.h5" not in done.stderr:
            raise Failed(f"it refused after {promised} commits: {done.stderr.strip()}")


def computed(events):
    """Commits that a run appended; the write at 0 is the header's."""
    count = appended = 0
    for event in events:
        if event.call.startswith("pwrite") and event.path == "" and event.at > 0:
            appended = 1
        if event.call == "fdatasync":
            count, appended = count + appended, 0
    return count


def mutants(bench):
    """Leaves out each sync of a run and of a merge in turn, but for those that are not needed."""
    by_name, counts, survived = {case.name: case for case in cases(bench)}, {"syncs": 0, "needed": 0}, []
    for name, first, last in (("fresh", 2, -1), ("merge", 1, None)):
        undisturbed = PowerLoss(bench, by_name[name], 0)
        undisturbed.record()
        places = [n for n, event in enumerate(undisturbed.events) if event.call in ("fsync", "fdatasync")]
        needed = range(1, len(places) + 1)[first - 1:last]
        counts["syncs"] += len(places)
        counts["needed"] += len(needed)
        for n in needed:
            failures = PowerLoss(bench, by_name[name], 1, 1, n, places).all().failures
            print(f"  {name}, sync {n}: {failures[0][:200] if failures else 'not noticed'}", flush=True)
            if not failures:
                survived.append(f"{name}, sync {n}")
    finish("power loss, a sync left out", {**counts, "noticed": counts["needed"] - len(survived)},
           [f"nothing was lost without it: {one}" for one in survived])


def main():
    given = arguments(__doc__, some=40, every=1, case="", mutants=0)
    with Bench(given.credence) as bench:
        if given.mutants:
            return mutants(bench)
        finish_all("power loss", ((case.name, PowerLoss(bench, case, given.some, given.every).all())
                                  for case in cases(bench) if given.case in ("", case.name)))


if __name__ == "__main__":
    main()
