"""notebooks.py FOLDER: executes the notebooks of docs/notebooks; writes NAME.md, its pictures and NAME.ipynb there."""

from __future__ import annotations

import pathlib
import sys
import tempfile

import jupytext
import nbformat
from nbclient import NotebookClient
from nbconvert import MarkdownExporter


def main(folder: pathlib.Path) -> None:
    for path in sorted((pathlib.Path(__file__).parents[1] / "notebooks").glob("*.py")):
        notebook = jupytext.read(path)
        with tempfile.TemporaryDirectory() as work:
            options = {"extra_arguments": ["--log-level=ERROR"], "resources": {"metadata": {"path": work}}}
            NotebookClient(notebook, timeout=1800, **options).execute()
        for output in [output for cell in notebook.cells for output in cell.get("outputs", [])]:
            if moving := output.get("data", {}).get("image/gif"):  # which the exporter does not know
                output.data["text/html"] = f'<img alt="moving picture" src="data:image/gif;base64,{moving.strip()}">'
        folder.mkdir(parents=True, exist_ok=True)
        pictures = {"unique_key": path.stem, "output_files_dir": path.stem}
        text, resources = MarkdownExporter().from_notebook_node(notebook, pictures)
        text = text.replace("![png]", "![what this cell draws]")
        for name, picture in resources["outputs"].items():
            (folder / name).parent.mkdir(exist_ok=True)
            (folder / name).write_bytes(picture)
        link = f"[{path.stem}.ipynb]({path.stem}.ipynb)"
        (folder / f"{path.stem}.md").write_text(f"{text}\nThis page as a notebook: {link}\n")
        nbformat.write(notebook, folder / f"{path.stem}.ipynb")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
