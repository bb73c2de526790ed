"""The errors of the package. Without its compiled module, as `cmake --install` lays it, it reads and draws files."""

from __future__ import annotations

try:
    from credence._core import Failure, InputError
except ImportError:

    class InputError(ValueError):  # type: ignore[no-redef]
        """An argument or a file cannot be used."""

    class Failure(RuntimeError):  # type: ignore[no-redef]
        """The work itself failed."""


__all__ = ["Failure", "InputError"]
