"""What pip builds the package with: scikit-build-core, before which it is seen to that there is a compiler with the
libraries, so that nothing is downloaded in vain; and which says on the terminal how far it is, since pip does not.
"""

from __future__ import annotations

import contextlib
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

Settings = dict[str, Any] | None

TREE = Path(__file__).parents[2]
HEADERS = {
    "Eigen": "Eigen/Core", "Boost.Program_options": "boost/program_options.hpp", "HDF5": "hdf5.h",
    "libdeflate": "libdeflate.h", "nlohmann_json": "nlohmann/json.hpp",
}  # fmt: skip
FOLDERS = ("/usr/include/eigen3", "/usr/include/hdf5/serial", "/usr/local/include/eigen3")
ELSEWHERE = ("CMAKE_ARGS", "CMAKE_PREFIX_PATH", "CONDA_PREFIX", "HDF5_ROOT")  # say where else CMake finds libraries
SECONDS = 5.0  # between two lines


def _missing(settings: Settings) -> list[str]:
    """What the build needs and is not there."""
    compiler = shutil.which(os.environ.get("CXX", "").split(" ")[0] or "c++") or shutil.which("g++")
    if compiler is None:
        return ["a C++ compiler"]
    if settings or any(os.environ.get(name) for name in ELSEWHERE) or shutil.which("h5cc"):
        return []
    found = [] if Path(sysconfig.get_path("include"), "Python.h").exists() else ["the headers of Python"]
    for name, header in HEADERS.items():
        told = [compiler, "-E", "-x", "c++", "-", "-o", os.devnull, *(f"-I{folder}" for folder in FOLDERS)]
        if subprocess.run(told, input=f"#include <{header}>\n", text=True, capture_output=True, check=False).returncode:
            found.append(name)
    return found


def _requires(settings: Settings) -> list[str]:
    missing = _missing(settings)
    if missing:
        packages = re.search('build_packages="([^"]*)"', (TREE / "experiments/setup.sh").read_text())
        assert packages is not None
        named = " ".join(packages[1].split())
        sys.exit(f"credence needs {', '.join(missing)}, which cannot be found. On Debian and Ubuntu this installs all "
                 f"that it needs, as root or with sudo:\n  apt-get install {named} python3-dev")  # fmt: skip
    tools = [name for name, tool in (("cmake>=3.22", "cmake"), ("ninja>=1.5", "ninja")) if shutil.which(tool) is None]
    return ["scikit-build-core>=1.1", "nanobind>=3.1", *tools]


@contextlib.contextmanager
def _said() -> Iterator[None]:
    """Say on the terminal how much is compiled: what ninja says on the standard output, which pip keeps to itself."""
    try:
        terminal = open("/dev/tty", "w", encoding="utf-8")  # noqa: SIM115
    except OSError:
        yield
        return
    with terminal:
        begun = last = time.monotonic()
        reading, writing = os.pipe()
        kept = os.dup(1)
        os.dup2(writing, 1)
        os.close(writing)

        def follow() -> None:
            nonlocal last
            with open(reading, "rb") as lines:
                for line in lines:
                    os.write(kept, line)
                    step = re.match(rb"\[(\d+)/(\d+)\]", line)
                    if step and time.monotonic() - last > SECONDS:
                        last = time.monotonic()
                        done = f"{int(step[1])} of {int(step[2])} parts compiled after {last - begun:.0f} s"
                        terminal.write(f"\n  credence: {done} ")
                        terminal.flush()

        follower = threading.Thread(target=follow)
        follower.start()
        try:
            yield
        finally:
            sys.stdout.flush()
            os.dup2(kept, 1)
            follower.join()
            os.close(kept)


def get_requires_for_build_wheel(config_settings: Settings = None) -> list[str]:
    return _requires(config_settings)


def get_requires_for_build_editable(config_settings: Settings = None) -> list[str]:
    return _requires(config_settings)


def get_requires_for_build_sdist(config_settings: Settings = None) -> list[str]:
    return ["scikit-build-core>=1.1"]


def build_wheel(wheel_directory: str, config_settings: Settings = None, metadata_directory: str | None = None) -> str:
    from scikit_build_core import build

    with _said():
        return build.build_wheel(wheel_directory, config_settings, metadata_directory)


def build_editable(
    wheel_directory: str, config_settings: Settings = None, metadata_directory: str | None = None
) -> str:
    from scikit_build_core import build

    with _said():
        return build.build_editable(wheel_directory, config_settings, metadata_directory)


def build_sdist(sdist_directory: str, config_settings: Settings = None) -> str:
    from scikit_build_core import build

    return build.build_sdist(sdist_directory, config_settings)


def prepare_metadata_for_build_wheel(metadata_directory: str, config_settings: Settings = None) -> str:
    from scikit_build_core import build

    return build.prepare_metadata_for_build_wheel(metadata_directory, config_settings)


def prepare_metadata_for_build_editable(metadata_directory: str, config_settings: Settings = None) -> str:
    from scikit_build_core import build

    return build.prepare_metadata_for_build_editable(metadata_directory, config_settings)
