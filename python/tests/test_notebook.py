"""The notebook goes from nothing to its verdicts and pictures, as it is committed."""

from __future__ import annotations

import re

import pytest
import studies

jupytext = pytest.importorskip("jupytext")
nbclient = pytest.importorskip("nbclient")
pytest.importorskip("credence._core")


def test_the_notebook_comes_to_both_verdicts(tmp_path):
    notebook = jupytext.read(studies.ROOT / "docs" / "notebooks" / "first_verdict.py")
    nbclient.NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(tmp_path)}}).execute()
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    said = "".join(output.get("text", "") for output in outputs)
    assert re.search(r"run/right +consistent ", said)
    assert re.search(r"run/wrong +optimistic ", said)
    assert "AssertionError: the filter is not consistent" in said
    shown = [output["data"] for output in outputs if "data" in output]
    kinds = [next(kind for kind in ("text/html", "image/png", "image/gif") if kind in data) for data in shown]
    assert kinds == ["image/png", "text/html", "image/png", "image/gif"]
    assert "circle" in shown[1]["text/html"]
    assert (tmp_path / "trial.gif").read_bytes().startswith(b"GIF89a")
