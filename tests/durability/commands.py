"""The commands that the harnesses try: each that credence has, on small studies."""

import shutil

from harness import HERE, LESS


class Command:
    """`again` is what goes on after a failure; `whole` has the results that x.h5 must have, beside the folder."""

    def __init__(self, name, command, again=None, start=None, whole=None, printed="always the same"):
        self.name, self.command, self.again, self.printed = name, command, again or command, printed
        self.start, self.whole = start or {}, whole


def overwriting(command):
    return [*command, "--overwrite"]


def torn_journal(bench, name, *more, start=None):
    """The journal of a run that was killed within its third commit."""
    bench.begin(start or {})
    bench.run(*bench.study(*more), environment={"CRASH_AT": 11, "CRASH_HALF": 1})
    return shutil.copy(bench.at / "x.h5.journal", bench.root / name)


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
    grown = {"x.h5": less, "x.h5.journal": torn_journal(bench, "grown", "--resume", start={"x.h5": less})}
    torn = {"x.h5.journal": torn_journal(bench, "torn")}
    yield Command("resume, journal", [*two, "--resume"], start=torn, whole=whole)
    yield Command("resume, journal and file", [*two, "--resume"], start=grown, whole=whole)
    yield Command("aggregates", [*two, "--keep", "aggregates"], [*two, "--keep", "aggregates", "--resume"],
                  whole=bench.root / "aggregates.h5")
    yield Command("dry-run", [*two, "--dry-run"], printed="times")
    yield Command("merge", merge, overwriting(merge), whole=whole)
    yield Command("report", ["report", "../whole.h5"])
    page = ["report", "../whole.h5", "--format", "html", "-o", "r"]
    yield Command("report, page", page, overwriting(page))
    yield Command("compare", ["compare", "../whole.h5", "../changed.h5", "--arms", "fixed.ekf,fixed.ekf"])
    replay = ["replay", "../whole.h5", *trial]
    yield Command("replay", replay)
    yield Command("replay, file", [*replay, "-o", "t.h5"], overwriting([*replay, "-o", "t.h5"]))
    judge = ["judge", str(HERE.parent / "reference" / "record_gaussian.h5")]
    yield Command("judge", judge)
    page = [*judge, "--format", "html", "-o", "r"]
    yield Command("judge, page", page, overwriting(page))
    yield Command("watch", ["watch", "../whole.h5", "--once"])
    yield Command("watch, journal", ["watch", "x.h5", "--once"], start=torn, printed="times")
    yield Command("show", ["show", "../tiny.ini"])
    # Boost indents the text by the names that a stream of its own holds, whole or cut short.
    yield Command("help", ["run", "--help"], printed="the same words")
    yield Command("completion", ["completion", "bash"])
    yield Command("version", ["--version"], printed="the processor, where it can be read")
