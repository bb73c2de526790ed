"""The program: ``python -m credence`` is ``credence``."""

from __future__ import annotations

import os
import signal
import sys

from credence import _commands


def main() -> int:
    """Run the command line and return the exit code.

    Signals do what they do in the program: Python catches or ignores some of them, unless its parent asked for that.
    ``simulate`` and ``tune`` run functions of Python, and ``judge`` reads logs, which the program cannot.
    """
    name, words = "".join(sys.argv[1:2]), sys.argv[2:]
    if name in _commands.COMMANDS and (code := _commands.obeyed(name, words)) is not None:
        return code
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    from credence import _core

    for ignored in (signal.SIGPIPE, signal.SIGXFSZ):
        signal.signal(ignored, signal.SIG_DFL)
    return _core.program([os.fsencode(argument) for argument in sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
