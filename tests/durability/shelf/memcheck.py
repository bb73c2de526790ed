"""Every command of commands.py under Valgrind's memcheck, and what reads files from elsewhere with each seed and each
kept input of the fuzz targets: no value is used that was never written, and no memory that is not the program's.
(Clang's memory sanitizer would need libhdf5 and the C++ library compiled with it.) What happens within libhdf5 is
counted apart; one of the files of fuzz/libhdf5 shows that this is told from the program's own. The target is v3, the
widest that Valgrind knows. A program with such a fault comes first, which must be noticed.

With --every N only each N-th of the inputs."""

import os
import re
import shutil
import subprocess

from commands import commands
from harness import HERE, Bench, arguments, finish

FAULT = "#include <stdlib.h>\nint main(void) { int *n = malloc(sizeof *n); return *n > 0 ? 2 : 3; }\n"
FUZZ = HERE.parent / "fuzz"
HDF5_FAULT = FUZZ / "libhdf5" / "judge-H5Aread-H5HG_read-heap-buffer-overflow.h5"
READ = {  # by the folder's name, of a file that is put beside the program as x.h5 or its journal
    "results": ["report", "x.h5"],
    "judge": ["judge", "x.h5"],
    "noise": ["replay", str(FUZZ / "journal.ini"), "--set", "scenario.poses=2", "--noise", "x.h5"],
    "scenario": ["show", "x.h5"],
    "journal": ["watch", "x.h5", "--once"],
}


def checked(command, bench, expected=(0,)):
    """What memcheck says of a command, or how else it ended than expected: nothing where all is well."""
    log = bench.root / "memcheck.log"
    log.unlink(missing_ok=True)
    done = subprocess.run(["valgrind", "-q", f"--log-file={log}", *command], cwd=bench.at, capture_output=True,
                          text=True, errors="replace", timeout=600, check=False,
                          env={**os.environ, "CREDENCE_FORCE_TARGET": "v3"})
    ended = "" if done.returncode in expected else f"ended with {done.returncode}: {done.stderr[:200]}"
    return (log.read_text() if log.exists() else "there is no log; ") + ended


def of_hdf5(fault):
    """Whether a fault is libhdf5's: of the innermost frames, one is in it before one is in the program."""
    frames = re.findall(r"(?:at|by) 0x\w+: .*", fault)
    return "libhdf5" in next((frame for frame in frames if re.search(r"libhdf5|/credence\)|\.[ch]pp:", frame)), "")


def own_faults(found):
    """What is left of what memcheck says without the faults of libhdf5, and how many those are."""
    faults = re.split(r"^==\d+== *\n", found, flags=re.MULTILINE)
    own = [fault for fault in faults if fault.strip() and not of_hdf5(fault)]
    return "\n".join(own), sum(map(of_hdf5, faults))


def inputs(every):
    """Seeds and kept inputs, as pairs of the command that reads them and the file."""
    files = [(folder.name, file) for kind in ("found", "seeds") for folder in sorted((FUZZ / kind).iterdir())
             for file in sorted(folder.iterdir())]
    return [(READ[name], file) for name, file in files][::every]


def read_under_memcheck(bench, command, file):
    bench.empty()
    shutil.copy(file, bench.at / ("x.h5.journal" if command[0] == "watch" else "x.h5"))
    return own_faults(checked([bench.credence, *command], bench, expected=(0, 1, 2)))


def check_itself(bench):
    subprocess.run(["cc", "-w", "-O0", "-xc", "-", "-o", bench.root / "fault"], input=FAULT, text=True, check=True)
    found, _ = own_faults(checked([bench.root / "fault"], bench, expected=(3,)))
    if "uninitialised" not in found:
        yield "a value that was never written is not noticed"
    if read_under_memcheck(bench, READ["judge"], HDF5_FAULT)[1] == 0:
        yield f"no fault of libhdf5 is seen where it reads {HDF5_FAULT.name}"


def main():
    given = arguments(__doc__, every=1)
    counts = {"commands": 0, "inputs": 0, "with a fault": 0, "faults within libhdf5": 0}
    with Bench(given.credence) as bench:
        failures = list(check_itself(bench))
        for command in commands(bench):
            bench.begin(command.start)
            counts["commands"] += 1
            if found := checked([bench.credence, *command.command], bench):
                failures.append(f"{command.name}: {found[:1000]}")
        for command, file in inputs(given.every):
            found, hdf5 = read_under_memcheck(bench, command, file)
            counts["inputs"] += 1
            counts["faults within libhdf5"] += hdf5
            if found:
                failures.append(f"{command[0]} of {file.relative_to(FUZZ)}: {found[:1000]}")
    counts["with a fault"] = len(failures)
    finish("memcheck", counts, failures)


if __name__ == "__main__":
    main()
