"""Two programs that take turns: each waits before a call on a file until it may go on (shim/meet.c)."""

import os
import selectors
import socket
import subprocess
import tempfile

from harness import Failed

HANGS = 20  # seconds


class Side:
    """A program that takes turns."""

    def __init__(self, bench, words, folder, environment):
        self.name = " ".join(words[:1] + [word for word in words if word in ("--resume", "--overwrite")])
        self.turns, theirs = socket.socketpair()
        self.waits, self.taken = False, 0
        self.output = tempfile.TemporaryFile("w+")  # a pipe that is full would make it wait where it takes no turn
        variables = {**os.environ, "LD_PRELOAD": bench.shim, "MEET": str(theirs.fileno()), **environment}
        self.process = subprocess.Popen([bench.credence, *words], cwd=folder, env=variables, stdin=subprocess.DEVNULL,
                                        stdout=self.output, stderr=subprocess.PIPE, text=True, errors="replace",
                                        pass_fds=[theirs.fileno()])
        theirs.close()

    def read(self):
        """It waits before a call, or has ended."""
        if self.turns.recv(4096):
            self.waits = True
        else:
            self.turns.close()
            self.turns = None

    def goes_on(self):
        self.waits, self.taken = False, self.taken + 1
        self.turns.sendall(b"g")

    def end(self):
        self.said = self.process.communicate(timeout=30)[1]
        self.code = self.process.returncode
        self.output.seek(0)
        self.printed = self.output.read()

    def check_end(self):
        """It ended as a command may: where it refused, with one line."""
        if self.taken == 0:
            raise RuntimeError(f"{self.name} took no turn: the library of shim/ is not loaded")  # no mutant's failure
        if self.code not in (0, 1, 2):
            raise Failed(f"{self.name} ended with {self.code}: {self.said}")
        if self.code and not (self.said.startswith("credence ") and self.said.count("\n") == 1):
            raise Failed(f"{self.name} ended with {self.code}, and said {self.said!r}")


def by_shares(chance):
    """Which side has each turn: each has a share of them."""
    shares = chance.choice(((1, 1), (1, 8), (8, 1), (1, 50), (50, 1)))
    while True:
        yield chance.choices((0, 1), shares)[0]


def by_lengths(chance):
    """Which side has each turn: each has up to so many in a row, 20 to 2,000. So one may wait in the middle of its
    writing until the other has come to its own."""
    side, most = chance.randrange(2), [20 * 100 ** chance.random() for _ in (0, 1)]
    while True:
        for _ in range(int(most[side] * chance.random())):
            yield side
        side = 1 - side


def take_turns(sides, chance):
    """Lets one of those that wait go on, until both have ended."""
    selector = selectors.DefaultSelector()
    for side in sides:
        selector.register(side.turns, selectors.EVENT_READ, side)
    schedule = chance.choice((by_shares, by_lengths))(chance)
    while any(side.turns for side in sides):
        events = selector.select(HANGS)
        if not events:
            raise Failed(f"a program did nothing for {HANGS} s")
        for key, _ in events:
            turns_of = key.fileobj
            key.data.read()
            if key.data.turns is None:
                selector.unregister(turns_of)
        ready = [side for side in sides if side.turns]
        if ready and all(side.waits for side in ready):  # both wait, or the other has ended
            chosen = sides[next(schedule)]
            (chosen if chosen in ready else ready[0]).goes_on()
    for side in sides:
        side.end()
