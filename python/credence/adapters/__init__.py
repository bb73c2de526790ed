"""From the objects and files of other programs to the arguments of :func:`credence.judge`.

Each function returns a dictionary, so that ``credence.judge(**adapters.from_tum(estimates, truths))`` is all there is
to write. The libraries that read a format (`rosbags`, `pyulog`, SciPy) are imported when a file of it is read; those
whose objects are taken are not imported at all. docs/logs.md says which function is for what.

In the shapes `trial` counts independent runs, `step` the steps of a run, and n is the dimension of the error.
"""

from __future__ import annotations

from credence.adapters.arrays import from_mat, from_npz
from credence.adapters.columns import from_table
from credence.adapters.objects import from_gtsam_poses, from_navlie, from_stonesoup
from credence.adapters.oem import from_oem
from credence.adapters.pair import from_pair
from credence.adapters.quaternions import from_quaternions
from credence.adapters.rosbag import from_rosbag
from credence.adapters.rtklib import from_rtklib
from credence.adapters.trajectories import from_euroc, from_kitti, from_openvins, from_square, from_tum
from credence.adapters.ulog import from_px4, from_ulog

__all__ = [
    "from_euroc",
    "from_gtsam_poses",
    "from_kitti",
    "from_mat",
    "from_navlie",
    "from_npz",
    "from_oem",
    "from_openvins",
    "from_pair",
    "from_px4",
    "from_quaternions",
    "from_rosbag",
    "from_rtklib",
    "from_square",
    "from_stonesoup",
    "from_table",
    "from_tum",
    "from_ulog",
]
