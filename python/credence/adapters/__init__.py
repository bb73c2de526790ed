"""From the objects and files of other programs to the arguments of :func:`credence.judge`.

Each function returns a dictionary, so that ``credence.judge(**adapters.from_tum(estimates, truths))`` is all there is
to write. None of them imports the library whose objects it takes; it uses the methods that these objects have.

In the shapes `trial` counts independent runs, `step` the steps of a run, and n is the dimension of the error.
"""

from __future__ import annotations

from credence.adapters.arrays import from_npz
from credence.adapters.objects import from_gtsam_poses, from_stonesoup
from credence.adapters.trajectories import from_openvins, from_tum

__all__ = ["from_gtsam_poses", "from_npz", "from_openvins", "from_stonesoup", "from_tum"]
