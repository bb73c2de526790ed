"""Modules of the package import each other in one direction, inside their functions, too."""

from __future__ import annotations

import ast
import graphlib
import importlib.util
import pathlib

import credence

PACKAGE = pathlib.Path(credence.__file__).parent


def imported_by(path: pathlib.Path) -> set[str]:
    """The modules of the package that a module imports anywhere, for types as well."""
    module = ".".join(["credence", *path.relative_to(PACKAGE).with_suffix("").parts]).removesuffix(".__init__")
    package = module if path.stem == "__init__" else module.rpartition(".")[0]
    found: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom):
            of = importlib.util.resolve_name("." * node.level + (node.module or ""), package)
            found |= {place_of(of, name.name) for name in node.names}
        elif isinstance(node, ast.Import):
            found |= {name.name for name in node.names}
    return {name for name in found if name.split(".")[0] == "credence" and name != "credence"}


def place_of(module: str, name: str) -> str:
    """Where a name is that is imported from a module: the face of the package hands on what others define."""
    if module == "credence" and name in credence._places:
        return f"credence.{credence._places[name]}"
    within = PACKAGE.joinpath(*module.split(".")[1:], name)
    return f"{module}.{name}" if within.with_suffix(".py").exists() or name == "_core" else module


def graph() -> dict[str, set[str]]:
    paths = [path for path in PACKAGE.rglob("*.py") if path != PACKAGE / "__init__.py"]
    names = {".".join(["credence", *path.relative_to(PACKAGE).with_suffix("").parts]): path for path in paths}
    return {name.removesuffix(".__init__"): imported_by(path) for name, path in names.items()}


def test_no_modules_import_each_other_in_a_circle():
    found = graph()
    assert {"credence.tuning", "credence.pictures.tuning", "credence.adapters"} <= found.keys()
    assert "credence.pictures.tuning" in found["credence.tuning"]  # in a function
    assert "credence._record" in found["credence._arrays"]
    order = list(graphlib.TopologicalSorter(found).static_order())  # CycleError names those of a circle
    assert order.index("credence._record") < order.index("credence.judging") < order.index("credence.simulating")
