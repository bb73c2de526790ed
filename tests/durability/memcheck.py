"""Every command of fail_once.py under Valgrind's memcheck: no value is used that was never written, and no memory that
is not the program's. (Clang's memory sanitizer would need libhdf5 and the C++ library compiled with it.) The target is
v3, the widest that Valgrind knows. A program with such a fault comes first, which must be noticed."""

import os
import subprocess

from fail_once import commands
from harness import Bench, arguments, finish

FAULT = "#include <stdlib.h>\nint main(void) { int *n = malloc(sizeof *n); return *n > 0 ? 2 : 3; }\n"


def checked(command, bench, expected=0):
    """What memcheck says of a command, or how else it ended than expected: nothing where all is well."""
    log = bench.root / "memcheck.log"
    log.unlink(missing_ok=True)
    done = subprocess.run(["valgrind", "-q", f"--log-file={log}", *command], cwd=bench.at, capture_output=True,
                          text=True, errors="replace", timeout=600, check=False,
                          env={**os.environ, "CREDENCE_FORCE_UNIT": "v3"})
    ended = "" if done.returncode == expected else f"ended with {done.returncode}: {done.stderr[:200]}"
    return (log.read_text() if log.exists() else "there is no log; ") + ended


def main():
    given = arguments(__doc__)
    failures = []
    with Bench(given.credence) as bench:
        subprocess.run(["cc", "-w", "-O0", "-xc", "-", "-o", bench.root / "fault"], input=FAULT, text=True, check=True)
        if "uninitialised" not in checked([bench.root / "fault"], bench, expected=3):
            failures.append("a value that was never written is not noticed")
        number = 0
        for number, command in enumerate(commands(bench), start=1):
            bench.begin(command.start)
            found = checked([bench.credence, *command.command], bench)
            if found:
                failures.append(f"{command.name}: {found[:1000]}")
    finish("memcheck", {"commands": number, "with a fault": len(failures)}, failures)


if __name__ == "__main__":
    main()
