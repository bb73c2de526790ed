"""Journals and results files of this release and the one before, as they wrote them (versions/): each is resumed, and
the file names both programs; or it is refused by name, unchanged. So is a journal of another version or schema, which is
made here of this program's own.

With --mutants journals of other versions say that they are this program's, and this program's that they are later ones:
then each must fail."""

import gzip
import re
import subprocess
import zlib
from dataclasses import dataclass

from harness import HERE, Bench, Failed, arguments, finish

WORLD = HERE.parent / "fuzz" / "journal.ini"
KEEPS = "trials", "aggregates"
OWN = 10  # version of this program's journals
SCHEMA = 5
MORE = 600  # trials: three blocks
LATER = ((2, 0), (-2, 0), (0, 1), (0, -1), (2, 1))  # a journal's version and its schema's, over this program's
RELEASE = "0.3"  # journals and results files of it are resumed, if their schema is this program's
BEFORE = "0.3"  # those of it with schema 4 are refused
FINISH = "Finish the run with the release that began it."
AGAIN = (f"/@schema_version: is 4, this program's is {SCHEMA}; the file was made by release 0.3.0. Report it with that "
         "release, or run the study again.")


def stored(name):
    path = HERE / "versions" / name
    return path.read_bytes() if path.exists() else gzip.decompress(path.with_name(name + ".gz").read_bytes())


def labelled(journal, version, schema):
    """The journal under another version and schema version."""
    end = 24 + int.from_bytes(journal[20:24], "little")
    header = (journal[:16] + version.to_bytes(4, "little") + journal[20:24] + schema.to_bytes(4, "little") +
              journal[28:end])
    return header + zlib.crc32(header).to_bytes(4, "little") + journal[end + 4:]


@dataclass
class File:
    """`refused`: the words with which it is refused; nothing if it is resumed."""

    what: str
    data: bytes
    keep: str = "trials"
    refused: str = ""

    @property
    def name(self):
        return "x.h5.journal" if self.data.startswith(b"credence-journal") else "x.h5"


def later(keep, version, schema):
    """A journal of so many versions later. Its layout is this program's, so that only its label is wrong."""
    version, schema = OWN + version, SCHEMA + schema
    words = (f"is a journal of version {version}, this program's is {OWN}. {FINISH}" if version != OWN
             else f"is of schema version {schema}, this program's is {SCHEMA}. {FINISH}")
    data = labelled(stored(f"journal-{keep}-{RELEASE}"), version, schema)
    return File(f"journal {version} of schema {schema}", data, keep, words)


def foreign_journals():
    yield File(f"journal of {BEFORE}", stored(f"journal-9-{BEFORE}"), "trials",
               f"is a journal of version 9, this program's is {OWN}. {FINISH}")
    for keep in KEEPS:
        for version, schema in LATER:
            yield later(keep, version, schema)


def own_journals():
    """Of a block and a partial one."""
    for keep in KEEPS:
        yield File(f"journal of {keep}", stored(f"journal-{keep}-{RELEASE}"), keep)


def results_files():
    yield File(f"results of {BEFORE}", stored(f"results-4-{BEFORE}.h5"), refused=AGAIN)
    for keep in KEEPS:
        yield File(f"results of {keep}", stored(f"results-{keep}-{RELEASE}.h5"), keep)


def growing(keep, output):
    return "run", str(WORLD), "--trials", str(MORE), "--keep", keep, "--quiet", "-o", str(output), "--resume"


class Versions:
    def __init__(self, bench):
        self.bench = bench
        self.counts = {"journals": 0, "results files": 0, "resumed": 0, "refused": 0}

    def check(self, file):
        self.counts["journals" if "journal" in file.name else "results files"] += 1
        done = self.run(file, *growing(file.keep, "x.h5"))
        if file.refused:
            self.check_refused(file, done)
            self.counts["refused"] += 1
        else:
            self.check_grown(file, done)
            self.counts["resumed"] += 1
            if file.name == "x.h5":
                list(self.check_readers(file, ("merge", "x.h5", "-o", "y.h5", "--quiet")))

    def run(self, file, *command):
        self.bench.empty()
        (self.bench.at / file.name).write_bytes(file.data)
        return self.bench.run(*command)

    def check_refused(self, file, done):
        if done.returncode != 2:
            raise Failed(f"{file.what}: {done.args[1]} did not refuse it, and ended with {done.returncode}")
        if file.refused not in done.stderr or "x.h5" not in done.stderr:
            raise Failed(f"{file.what}: the refusal is another one: {done.stderr.strip()}")
        if self.bench.files() != {file.name: file.data}:
            raise Failed(f"{file.what}: it was refused, but changed")

    def check_grown(self, file, done):
        if done.returncode != 0:
            raise Failed(f"{file.what}: it was not resumed: {done.stderr.strip()}")
        self.bench.check_same(self.whole(file.keep), what=file.what)
        self.check_releases(file)

    def whole(self, keep):
        """The study as this program runs it at once."""
        path = self.bench.root / f"{keep}.h5"
        if not path.exists():
            self.bench.expect(0, *growing(keep, path))
        return path

    def check_readers(self, file, *more):
        """A file is reported; a trial is replayed; and what more there is."""
        for command in (("report", "x.h5", "--format", "csv"),
                        ("replay", "x.h5", "--scenario", "tiny", "--arm", "fixed.ekf", "--trial", "3"), *more):
            done = self.run(file, *command)
            if done.returncode != 0:
                raise Failed(f"{file.what}: {command[0]} ended with {done.returncode}: {done.stderr.strip()}")
            yield done

    def check_releases(self, file):
        """Both the program that began and the one that resumed are named."""
        said = subprocess.run(["h5dump", "-a", "/run/computed_by", "x.h5"], cwd=self.bench.at, capture_output=True,
                              text=True, check=True).stdout
        expected = list(dict.fromkeys([release_in(file.data), self.own_release()]))
        if re.findall(r"credence [^\"\n]*", said) != expected:
            raise Failed(f"{file.what}: it does not name {expected}: {said}")

    def own_release(self):
        said = self.bench.expect(0, "--version").stdout
        return f"{said.splitlines()[0]}, git revision {re.search(r'git_revision: (.*)', said)[1]}"


def release_in(data):
    return re.search(rb"credence [0-9.]+, git revision [0-9a-f]{12}(-dirty)?", data)[0].decode()


def failures_of(files, check):
    failures = []
    for file in files:
        try:
            check(file)
        except Failed as error:
            failures.append(str(error))
    return failures


def mislabelled():
    """Journals under the other kind's label, but what is expected of them is what it was."""
    for file in foreign_journals():
        yield File(file.what, labelled(file.data, OWN, SCHEMA), file.keep, file.refused)
    for file in own_journals():
        yield File(file.what, later(file.keep, *LATER[0]).data, file.keep)


def main():
    given = arguments(__doc__, mutants=0)
    with Bench(given.credence) as bench:
        versions = Versions(bench)
        if given.mutants:
            planted = list(mislabelled())
            noticed = len(failures_of(planted, versions.check))
            return finish("versions, not looked at", {"journals": len(planted), "noticed": noticed},
                          [] if noticed == len(planted) else ["a journal under a wrong label was not noticed"])
        finish("versions", versions.counts,
               failures_of([*foreign_journals(), *own_journals(), *results_files()], versions.check))


if __name__ == "__main__":
    main()
