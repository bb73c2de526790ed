"""The generator of a trial, whose draws can be named by their source, so that one source can be drawn anew alone."""

from __future__ import annotations

import hashlib
from collections.abc import Collection
from typing import Any

import numpy as np
import numpy.typing as npt

_NAMED, _NAMED_OTHER, _OTHER = 2**32 - 1, 2**32 - 2, 2**32 - 3  # no child of `spawn` has such a number
REST = "rest"  #: the source of what is drawn from the generator itself


class Streams(np.random.Generator):
    """The generator of a trial: NumPy's, with streams of their own by name, ``rng["measurement"]`` and
    ``rng["measurement", k]``.

    A stream is a function of the seed, the trial and the name (and of whole numbers behind it) alone. The generator
    itself gives what it would give without streams. Streams of one name are one source of `credence.budget`, and what
    the generator itself draws is the source ``"rest"``.

    Attributes
    ----------
    streams : dict of Generator
        Those that were used, by name and numbers.
    counted : dict of array
        What `counts` was told, by source.
    """

    def __init__(self, sequence: np.random.SeedSequence, other: Collection[str] = ()) -> None:
        self._sequence, self._other = sequence, frozenset(other)
        self._own = self._derived(_OTHER) if REST in self._other else sequence
        super().__init__(np.random.Philox(self._own))
        self.streams: dict[tuple[str | int, ...], np.random.Generator] = {}
        self.counted: dict[str, npt.NDArray[np.float64]] = {}

    def _derived(self, *key: int) -> np.random.SeedSequence:
        return np.random.SeedSequence(self._sequence.entropy, spawn_key=(*self._sequence.spawn_key, *key))

    def __getitem__(self, key: str | tuple[str | int, ...]) -> np.random.Generator:
        """The stream of a name, or of a name and whole numbers from 0 on; the same object every time."""
        parts = key if isinstance(key, tuple) else (key,)
        if parts not in self.streams:
            name, *numbers = parts or (None,)
            if not isinstance(name, str) or not all(isinstance(one, (int, np.integer)) and one >= 0 for one in numbers):
                raise KeyError(f'rng[{key!r}]: give a name, and whole numbers from 0 on, as rng["measurement", k]')
            words = np.frombuffer(hashlib.blake2b(name.encode(), digest_size=16).digest(), "<u4").tolist()
            world = _NAMED_OTHER if name in self._other else _NAMED
            derived = self._derived(world, *words, *map(int, numbers))
            self.streams[parts] = np.random.Generator(np.random.Philox(derived))
        return self.streams[parts]

    def counts(self, source: str, covariance: npt.ArrayLike) -> None:
        """Say what of P the filter counts for a source, [step, n, n]: propagated for the noise of that source alone,
        with the filter's own gains. `credence.budget` shows it; for all sources together it is P.
        """
        self.counted[source] = np.asarray(covariance, dtype=float)

    def spawn(self, n_children: int) -> list[np.random.Generator]:
        return [np.random.Generator(np.random.Philox(one)) for one in self._own.spawn(n_children)]

    def other(self, sources: Collection[str]) -> Streams:
        """The generator of the same trial, with these sources drawn anew, as in an independent world."""
        return Streams(self._sequence, sources)

    def drawn(self) -> dict[str, dict[tuple[int, ...], int]]:
        """How many words were drawn, by source and numbers; of the generator itself only if there were any."""
        found: dict[str, dict[tuple[int, ...], int]] = {}
        for (name, *numbers), stream in self.streams.items():
            found.setdefault(str(name), {})[tuple(map(int, numbers))] = _position(stream)
        own = _position(self) + self._own.n_children_spawned
        return found | ({REST: {(): own}} if own else {})


def _position(generator: np.random.Generator) -> int:
    """How many words of 64 bits a generator of Philox has given."""
    state: Any = generator.bit_generator.state
    return int(state["state"]["counter"][0]) * 4 + int(state["buffer_pos"]) - 4
