"""What the package says of the registry's other distribution of the name credence."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import credence


def test_the_other_distribution_is_named_when_it_shares_the_folder(tmp_path):
    (tmp_path / "credence").symlink_to(Path(credence.__file__).parent)

    def imported():
        done = subprocess.run([sys.executable, "-c", "import credence; print(credence.__file__)"], capture_output=True,
                              text=True, check=True, env=os.environ | {"PYTHONPATH": str(tmp_path)}, cwd=tmp_path)
        assert done.stdout.startswith(str(tmp_path))
        return done.stderr

    (tmp_path / "credence_filters-0.3.0.dist-info").mkdir()
    (tmp_path / "credence-agents-0.3.0.dist-info").mkdir()
    assert imported() == ""
    (tmp_path / "credence-0.2.0.dist-info").mkdir()
    assert "Run pip uninstall credence credence-filters" in imported()
