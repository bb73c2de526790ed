"""The pairs of commands that interleave.py lets take turns, and what must be true of what each does and prints."""

import json
import math

from harness import LESS, TRIALS, Failed

BLOCK = 256
WHOLE, OTHER = "whole.h5", "seed2.h5"  # two studies


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
    """The first shard is resumed, or replaced by one of another study, while all are merged: what is merged is of
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
