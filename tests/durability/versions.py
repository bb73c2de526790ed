"""Journals of every version and results files of every schema version that were written, by the releases that wrote
them (versions/, and for schema version 2 the seeds of the fuzz targets): what is safe is gone on with, and the
file says whose trials are whose; anything else is refused, changes nothing and says which release to use. So is a
journal of a later version or schema, which is made here of this program's own.

With --mutants journals of other versions say that they are this program's, as if it did not look: then each must fail."""

import gzip
import re
import subprocess
import zlib

from harness import HERE, Bench, Failed, arguments, finish

WORLD = HERE.parent / "fuzz" / "journal.ini"
SEEDS = HERE.parent / "fuzz" / "seeds" / "results"
KEPT = {1: "trials", 2: "trials", 3: "aggregates", 4: "trials", 5: "aggregates", 6: "trials", 7: "aggregates"}


OWN = {"trials": 6, "aggregates": 7}  # versions of this program's journals
SCHEMA = 3


def stored(name):
    path = HERE / "versions" / name
    return path.read_bytes() if path.exists() else gzip.decompress(path.with_name(name + ".gz").read_bytes())


def labelled(journal, version, schema):
    """The journal under another version and schema version."""
    end = 24 + int.from_bytes(journal[20:24], "little")
    header = (journal[:16] + version.to_bytes(4, "little") + journal[20:24] + schema.to_bytes(4, "little") +
              journal[28:end])
    return header + zlib.crc32(header).to_bytes(4, "little") + journal[end + 4:]


class Versions:
    """`blind`: every journal says that it is this program's."""

    def __init__(self, bench, blind=False):
        self.bench, self.blind = bench, blind
        self.counts = {"journals": 0, "results files": 0, "gone on with": 0, "refused": 0}

    def journal(self, version):
        self.start(f"journal {version}", stored(f"journal-{version}"), KEPT[version])

    def later(self, keep, version, schema):
        """A journal that is later by so many versions. Its layout is this program's, so that only its label is wrong."""
        label = OWN[keep] + version, SCHEMA + schema
        self.start(f"journal {label[0]} of schema {label[1]}", labelled(stored(f"journal-{OWN[keep]}"), *label), keep)

    def start(self, name, data, keep):
        self.counts["journals"] += 1
        self.bench.empty()
        own = labelled(data, OWN[keep], SCHEMA)
        data, foreign = own if self.blind else data, data != own
        (self.bench.at / "x.h5.journal").write_bytes(data)
        self.grow(name, {"x.h5.journal": data}, keep, foreign)

    def results(self, version, data):
        self.counts["results files"] += 1
        self.bench.empty()
        (self.bench.at / "x.h5").write_bytes(data)
        self.bench.expect(0, "report", "x.h5")
        self.grow(f"results {version}", {"x.h5": data}, "trials")

    def grow(self, name, before, keep, foreign=False):
        """Goes on for more trials than are there. What is `foreign` must be refused."""
        done = self.bench.run("run", str(WORLD), "--trials", "600", "--keep", keep, "--quiet", "-o", "x.h5", "--resume")
        if done.returncode == 2:
            self.counts["refused"] += 1
            if self.bench.files() != before:
                raise Failed(f"{name}: it was refused, but changed")
            if not re.search(r"is a journal of version \d, this program's is \d.*release that began it|"
                             r"schema.version (is )?\d|computed trials of it", done.stderr):
                raise Failed(f"{name}: the refusal does not say whose it is: {done.stderr.strip()}")
            return
        if done.returncode != 0:
            raise Failed(f"{name}: it ended with {done.returncode}: {done.stderr.strip()}")
        if foreign:
            raise Failed(f"{name}: it was gone on with")
        self.counts["gone on with"] += 1
        whole = self.bench.root / f"{keep}.h5"
        if not whole.exists():
            self.bench.expect(0, "run", str(WORLD), "--trials", "600", "--keep", keep, "--quiet", "-o", str(whole))
        self.bench.check_same(whole, what=name)
        self.check_releases(name)

    def check_releases(self, name):
        """Blocks that the older release computed are said to be its own."""
        text = subprocess.run(["h5dump", "-a", "/run/computed_by", "x.h5"], cwd=self.bench.at, capture_output=True,
                              text=True, check=True).stdout
        own = re.search(r"git_revision: (\S+)", self.bench.expect(0, "--version").stdout)
        others = [revision for revision in re.findall(r"git revision ([0-9a-f]+(?:-dirty)?)", text)
                  if not own or revision != own[1]]
        if not others and "journal" not in name:  # those have a partial block alone, which is computed again
            raise Failed(f"{name}: it does not say whose trials are whose: {text}")


def failures_of(checks):
    failures = []
    for check in checks:
        try:
            check()
        except Failed as error:
            failures.append(str(error))
    return failures


def main():
    given = arguments(__doc__, mutants=0)
    with Bench(given.credence) as bench:
        versions = Versions(bench, blind=bool(given.mutants))
        foreign = [lambda v=v: versions.journal(v) for v in KEPT if v not in OWN.values()]
        foreign += [lambda k=k, v=v, s=s: versions.later(k, v, s) for k in OWN for v, s in ((2, 0), (0, 1), (2, 1))]
        if given.mutants:
            noticed = len(failures_of(foreign))
            return finish("versions, not looked at", {"journals": len(foreign), "noticed": noticed},
                          [] if noticed == len(foreign) else ["a journal of another version was gone on with, unnoticed"])
        own = [lambda v=v: versions.journal(v) for v in OWN.values()]
        own += [lambda: versions.results(2, (SEEDS / "schema-2.h5").read_bytes()),
                lambda: versions.results(3, stored("results-3.h5"))]
        finish("versions", versions.counts, failures_of(foreign + own))


if __name__ == "__main__":
    main()
