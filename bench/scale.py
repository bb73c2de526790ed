#!/usr/bin/env python3
"""What studies cost: the measurements of docs/cluster.md. Standard library only.

usage: scale.py [--credence build/credence] [--repeats 5] PART...
  cost    processor time of a million trials on one core, for each of the seed's scenarios, both arms
  sizes   bytes of journal and file of a million trials
  merge   time and memory of merging 1,000 shards, and of 100 shards of the same study
  aggregates  time, memory, journal and file of 10^6 trials that are kept, and of 10^6 and 10^7 of which totals are, and a merge
Medians of the repeats; the spread is (largest - smallest) / median.
"""

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
import time

SEED = [f"{model}-{path}-{noise}" for model in ("ekf", "kf") for path in ("straight", "circle")
        for noise in ("constant", "ranged")]
FOLDER = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "experiments", "seed")


def scenario(name):
    return os.path.join(FOLDER, name + ".ini")


def measured(command):
    """Wall seconds, processor seconds and the largest memory in MB of a command."""
    start = time.monotonic()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit(f"{' '.join(command)} ended with {os.waitstatus_to_exitcode(status)}")
    return time.monotonic() - start, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1000


def summary(values):
    middle = statistics.median(values)
    return middle, (max(values) - min(values)) / middle


def run(credence, names, trials, output, *more):
    return [credence, "run", *map(scenario, names), "--trials", str(trials), "--quiet", "--overwrite", "-o", output, *more]


def cost(credence, repeats, folder):
    trials = 100_000
    print(f"processor time of 10^6 trials, both arms, one core (from {trials} trials, median of {repeats}):")
    for name in SEED:
        seconds, spread = summary([measured(run(credence, [name], trials, f"{folder}/x.h5", "--threads", "1"))[1]
                                   for _ in range(repeats)])
        print(f"  {name:22s} {seconds * 1e6 / trials:7.1f} s   spread {100 * spread:.0f} %", flush=True)


def watched(command, output):
    """What `measured` says of a run, and the largest size that its journal was seen to have."""
    start, journal = time.monotonic(), 0
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    while True:
        done, status, usage = os.wait4(process.pid, os.WNOHANG)
        if done:
            break
        try:
            journal = max(journal, os.stat(output + ".journal").st_size)
        except FileNotFoundError:
            pass
        time.sleep(0.005)
    if status != 0:
        sys.exit(f"{' '.join(command)} ended with {os.waitstatus_to_exitcode(status)}")
    return time.monotonic() - start, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1000, journal


def sizes(credence, repeats, folder):
    trials = 1_000_000
    print("bytes of 10^6 trials, both arms:")
    for name in ("ekf-straight-constant", "kf-straight-constant"):
        output = f"{folder}/{name}.h5"
        journal = watched(run(credence, [name], trials, output), output)[-1]
        print(f"  {name:22s} journal {journal / 1e6:.1f} MB, file {os.stat(output).st_size / 1e6:.1f} MB", flush=True)
        os.remove(output)


def aggregates(credence, repeats, folder):
    name, output = "kf-straight-constant", f"{folder}/x.h5"
    print(f"{name}, both arms, on all processors:")
    for trials, keep in ((1_000_000, "trials"), (1_000_000, "aggregates"), (10_000_000, "aggregates")):
        wall, processor, memory, journal = watched(run(credence, [name], trials, output, "--keep", keep), output)
        report = measured([credence, "report", output, "--format", "json"])
        print(f"  {trials:9d} trials, keep {keep:10s}: {wall:.1f} s, processor {processor:.1f} s, {memory:.0f} MB of memory; "
              f"journal {journal / 1e6:.1f} MB, file {os.stat(output).st_size / 1e6:.1f} MB; report: {report[1]:.1f} s of "
              f"processor, {report[2]:.0f} MB", flush=True)
        os.remove(output)
    parts = [f"{folder}/{i}.h5" for i in range(50)]
    for i, part in enumerate(parts):
        measured(run(credence, [name], 51_200, part, "--keep", "aggregates", "--threads", "1", "--shard", f"{i}/50"))
    wall, processor, memory = measured([credence, "merge", *parts, "-o", output, "--quiet"])
    print(f"  merge of 50 shards, 51200 trials: {wall:.1f} s, processor {processor:.2f} s, {memory:.0f} MB of memory", flush=True)


def merge(credence, repeats, folder):
    trials, name = 1_024_000, "ekf-straight-constant"
    print(f"merging {trials} trials of {name} (median of {repeats}):")
    for shards in (100, 1000):
        parts = [f"{folder}/{shards}-{i}.h5" for i in range(shards)]
        for i, part in enumerate(parts):
            measured(run(credence, [name], trials, part, "--shard", f"{i}/{shards}"))
        results = [measured([credence, "merge", *parts, "-o", f"{folder}/merged.h5", "--overwrite", "--quiet"])
                   for _ in range(repeats)]
        seconds, spread = summary([wall for wall, _, _ in results])
        processor, _ = summary([processor for _, processor, _ in results])
        size = sum(os.stat(part).st_size for part in parts) / 1e6
        print(f"  {shards:5d} shards, {size:.0f} MB: {seconds:.1f} s (processor {processor:.1f} s), spread "
              f"{100 * spread:.0f} %, {max(memory for _, _, memory in results):.0f} MB of memory, file "
              f"{os.stat(folder + '/merged.h5').st_size / 1e6:.1f} MB", flush=True)
        for part in parts:
            os.remove(part)


PARTS = {"cost": cost, "sizes": sizes, "aggregates": aggregates, "merge": merge}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--credence", default="build/credence")
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("part", nargs="+", choices=PARTS)
    arguments = parser.parse_args()
    credence = os.path.abspath(arguments.credence)
    with open("/proc/loadavg") as load:
        print(f"{os.cpu_count()} processors, load {load.read().split()[0]}")
    for part in arguments.part:
        with tempfile.TemporaryDirectory() as folder:
            PARTS[part](credence, arguments.repeats, folder)


if __name__ == "__main__":
    main()
