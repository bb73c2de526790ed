"""What pip says of an installation: what is missing before it downloads anything, and how far it is."""

from __future__ import annotations

import importlib.util
import os
import pathlib
import pty
import subprocess
import sys
import time

import pytest

import credence

TREE = pathlib.Path(__file__).parents[2]
BACKEND = TREE / "python" / "packaging" / "build_backend.py"


def backend():
    spec = importlib.util.spec_from_file_location("build_backend", BACKEND)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_pip_names_what_is_missing_before_it_downloads_anything(tmp_path):
    tools = tmp_path / "bin"  # all but compilers
    tools.mkdir()
    here = {name: value for name, value in os.environ.items() if name not in ("CXX", "CMAKE_ARGS", "HDF5_ROOT")}
    words = [sys.executable, "-m", "pip", "install", "--index-url=http://127.0.0.1:9", "--no-cache-dir", "--retries=0",
             "--disable-pip-version-check", "--target", tmp_path / "to", TREE]  # fmt: skip
    done = subprocess.run(words, env={**here, "PATH": str(tools)}, capture_output=True, text=True, check=False,
                          timeout=120)  # fmt: skip
    assert done.returncode == 1
    said = done.stdout + done.stderr
    assert "credence needs a C++ compiler, which cannot be found." in said
    assert "  apt-get install g++ cmake make ninja-build libeigen3-dev libboost-program-options-dev libhdf5-dev" in said
    assert said.count("127.0.0.1") == 1  # Looking in indexes: nothing was asked of it
    assert "Traceback" not in said


def test_libraries_that_are_missing_are_named(tmp_path, monkeypatch, capsys):
    for name in ("CXX", *backend().ELSEWHERE):
        monkeypatch.delenv(name, raising=False)
    compiler = tmp_path / "c++"
    compiler.write_text("#!/bin/sh\nread line\ncase $line in *hdf5*|*json*) exit 1 ;; esac\n")
    compiler.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(SystemExit, match=r"credence needs HDF5, nlohmann_json, which cannot be found"):
        backend().get_requires_for_build_wheel()
    needed = ["scikit-build-core>=1.1", "nanobind>=3.1", "cmake>=3.22", "ninja>=1.5"]
    assert backend().get_requires_for_build_wheel({"cmake.define.CREDENCE_PREFIX": "/opt"}) == needed


def test_a_build_says_on_the_terminal_how_far_it_is():
    script = f"""
import importlib.util, subprocess, time
spec = importlib.util.spec_from_file_location("build_backend", {str(BACKEND)!r})
backend = importlib.util.module_from_spec(spec)
spec.loader.exec_module(backend)
backend.SECONDS = 0.0
with backend._said():
    subprocess.run(["sh", "-c", "echo '[3/7] a'; sleep 0.1; echo '[4/7] b'"])
print("end")
"""
    process, terminal = pty.fork()
    if process == 0:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        os.execv(sys.executable, [sys.executable, "-c", script])
    said, end = "", time.monotonic() + 60
    while time.monotonic() < end:
        try:
            said += os.read(terminal, 4096).decode()
        except OSError:  # the process has ended
            break
    os.close(terminal)
    assert os.waitpid(process, 0)[1] == 0
    assert "credence: 3 of 7 parts compiled after 0 s" in said
    assert "credence: 4 of 7 parts compiled after 0 s" in said


def test_the_extra_of_studies_opens_a_file_with_xarray(tmp_path, scenario):
    """As docs/results-format.md shows it, with what `pip install '.[study]'` installs and no more."""
    study = (TREE / "pyproject.toml").read_text().split("study = [")[1].split("]")[0]
    assert "h5netcdf" in study
    import xarray

    credence.run(scenario, trials=256, output=tmp_path / "credence.h5")
    arm = xarray.open_dataset(tmp_path / "credence.h5", group="small/fixed.ekf")
    assert arm["trace_P"].shape == (256,)
