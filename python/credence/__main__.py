"""The program: ``python -m credence`` is ``credence``."""

from __future__ import annotations

import os
import signal
import sys

from credence import _core


def main() -> int:
    """Run the command line and return the exit code.

    Signals do what they do in the program: Python catches or ignores some of them, unless its parent asked for that.
    ``simulate`` and ``tune`` run functions of Python, and ``judge`` reads logs, which the program cannot.
    """
    if sys.argv[1:2] == ["simulate"]:
        from credence._simulate_command import main as simulate

        return simulate(sys.argv[2:])
    if sys.argv[1:2] == ["judge"]:
        from credence._judge_command import is_for_adapters
        from credence._judge_command import main as judge

        if is_for_adapters(sys.argv[2:]):
            return judge(sys.argv[2:])
    if sys.argv[1:2] == ["tune"]:
        from credence._tune_command import main as tune

        return tune(sys.argv[2:])
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    for ignored in (signal.SIGPIPE, signal.SIGXFSZ):
        signal.signal(ignored, signal.SIG_DFL)
    return _core.program([os.fsencode(argument) for argument in sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
