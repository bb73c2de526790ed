"""The notebook goes from nothing to a verdict in ten cells, as it is committed."""

from __future__ import annotations

import re

import pytest
import studies

nbformat = pytest.importorskip("nbformat")
nbclient = pytest.importorskip("nbclient")
pytest.importorskip("credence._core")


def test_the_notebook_comes_to_both_verdicts(tmp_path):
    path = studies.ROOT / "analysis" / "first-verdict.ipynb"
    notebook = nbformat.read(path, as_version=4)
    assert len(notebook.cells) == 10
    assert not any(cell.get("outputs") for cell in notebook.cells)
    nbclient.NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(tmp_path)}}).execute()
    said = ["".join(output.get("text", "") for output in cell.get("outputs", [])) for cell in notebook.cells]
    assert re.search(r"right/record +consistent ", said[3])
    assert re.search(r"wrong/record +optimistic ", said[4])
    assert said[5].startswith("AssertionError: the filter is not consistent")
    shown = [output["data"] for cell in notebook.cells for output in cell.get("outputs", []) if "data" in output]
    assert "circle" in shown[0]["text/html"]
    assert "image/png" in shown[1]
    assert "image/gif" in shown[2]
    assert (tmp_path / "trial.gif").read_bytes().startswith(b"GIF89a")
