"""A model of a disk that forgets: what record.c wrote, and every folder that a power failure may leave of it.

A write reaches the disk in sectors of 512 bytes, in any order, until its file is synced; a sector that did not has
zeros or old bytes. The size of a file may be ahead of its data. A name that was made, renamed or removed is there or
not, in any order, until its folder is synced."""

import itertools
import random
from dataclasses import dataclass, field
from pathlib import Path

SECTOR = 512


@dataclass
class Event:
    call: str
    inode: int
    at: int
    data: bytes
    path: str
    to: str
    size: int = 0


def read_trace(path):
    raw, position, events = Path(path).read_bytes(), 0, []
    while position < len(raw):
        end = raw.index(b"\n", position)
        call, inode, at, size, name, to = raw[position:end].decode().split("\t")
        position = end + 1
        data = b""
        if int(size) and call not in ("writev", "pwritev"):
            data = raw[position:position + int(size)]
            position += int(size)
        events.append(Event(call, int(inode), int(at), data, name, to, int(size)))
    return events


@dataclass
class File:
    durable: bytes = b""
    pending: list = field(default_factory=list)  # (at, data), or (size, None) for a cut
    end: int = 0  # where write() goes on

    def now(self):
        return self.build([(at, data) for at, data in self.pending])

    def build(self, changes, size=None):
        image = bytearray(self.durable)
        for at, data in changes:
            if data is None:
                image = image[:at].ljust(at, b"\0")
                continue
            if len(image) < at + len(data):
                image.extend(bytes(at + len(data) - len(image)))
            image[at:at + len(data)] = data
        if size is not None:
            image = image[:size].ljust(size, b"\0")
        return bytes(image)

    def sectors(self):
        """The pending changes, one for each sector."""
        parts = []
        for at, data in self.pending:
            if data is None:
                parts.append((at, None))
                continue
            while data:
                here = SECTOR - at % SECTOR
                parts.append((at, data[:here]))
                at, data = at + here, data[here:]
        return parts

    def outcomes(self, chance, some):
        """What may be on the disk: every subset of the sectors where these are few, `some` random ones where not."""
        parts = self.sectors()
        if len(parts) <= 6:
            choices = list(itertools.product((0, 1), repeat=len(parts)))
        else:
            choices = [[1] * len(parts), [0] * len(parts)]
            choices += [[chance.random() < share for _ in parts]
                        for share in (chance.choice((0.02, 0.5, 0.98)) for _ in range(some))]
            for one in (0, len(parts) - 1, chance.randrange(len(parts))):  # all but one
                choices.append([place != one for place in range(len(parts))])
        full = len(self.now())
        for chosen in choices:
            taken = [part for part, keep in zip(parts, chosen) if keep]
            yield self.build(taken)
            if len(self.build(taken)) < full:
                yield self.build(taken, full)  # the size was ahead of the data
                lost = [(at, chance.randbytes(len(data))) for (at, data), keep in zip(parts, chosen)
                        if not keep and data is not None]
                yield self.build(taken + lost)  # and there are old bytes in its place


class Disk:
    """The folder as the events leave it, and what of it is durable."""

    def __init__(self, start):
        """`start`: names of files that are there, with inode and bytes."""
        self.files = {inode: File(data) for inode, data in start.values()}
        self.durable = {name: inode for name, (inode, _) in start.items()}
        self.names = dict(self.durable)
        self.pending = []  # changes of names

    def happens(self, event):
        call = event.call
        if call in ("writev", "pwritev", "mmap", "link"):
            raise ValueError(f"{call} is not replayed")
        if call in ("open", "fopen"):
            name = Path(event.path).name
            if name not in self.names:
                self.files[event.inode] = File()
                self.change([(name, event.inode)])
        elif call.startswith("rename"):
            source, target = Path(event.path).name, Path(event.to).name
            self.change([(source, None), (target, self.names[source])])
        elif call == "unlink":
            name = Path(event.path).name
            if name in self.names:
                self.change([(name, None)])
        elif call in ("fsync", "fdatasync"):
            if event.inode in self.files:
                file = self.files[event.inode]
                file.durable, file.pending = file.now(), []
            else:  # the folder
                self.durable, self.pending = dict(self.names), []
        elif call == "ftruncate":
            self.files[event.inode].pending.append((event.at, None))
        else:
            file = self.files[event.inode]
            at = event.at if event.at >= 0 else file.end
            file.pending.append((at, event.data))
            file.end = at + len(event.data)

    def change(self, parts):
        self.pending.append(parts)
        self.apply(self.names, parts)

    @staticmethod
    def apply(names, parts):
        for name, inode in parts:
            if inode is None:
                names.pop(name, None)
            else:
                names[name] = inode

    def namings(self, chance, some):
        """The names that may be on the disk."""
        subsets = (itertools.product((0, 1), repeat=len(self.pending)) if len(self.pending) <= 6 else
                   [[chance.random() < 0.5 for _ in self.pending] for _ in range(some)])
        for chosen in subsets:
            names = dict(self.durable)
            for parts, keep in zip(self.pending, chosen):
                if keep:
                    self.apply(names, parts)
            yield names

    def outcomes(self, seed, some):
        """Folders that a power failure may leave: by name, inode and bytes. What is still being written aside is
        removed unread, so one outcome of it is enough."""
        chance = random.Random(seed)
        for names in self.namings(chance, some):
            read = [name for name in names if not name.endswith(".credence-partial")]
            options = [list(self.files[names[name]].outcomes(chance, some)) for name in read]
            combined = list(itertools.islice(itertools.product(*options), 4096))
            if len(combined) > 4 * some + 64:
                combined = chance.sample(combined, 4 * some + 64)
            for images in combined:
                folder = {name: (names[name], image) for name, image in zip(read, images)}
                for name in set(names) - set(read):
                    folder[name] = (names[name], self.files[names[name]].now()[:SECTOR])
                yield folder
