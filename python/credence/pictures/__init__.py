"""Pictures of studies and trials, one message each.

    credence.plot(study)                                # a matplotlib figure
    credence.plot(study, "coverage", group="pose").save("coverage.pdf")
    credence.animate(study, trial=17, path="trial.gif")

`python -m credence.pictures study.h5 -o pictures` draws all that a file has. Needs h5py, matplotlib and SciPy, which
are not imported before something is drawn.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .drawing import Picture, animate, plot

__all__ = ["Picture", "animate", "plot"]


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module 'credence.pictures' has no attribute {name!r}")
    from . import drawing

    return getattr(drawing, name)
