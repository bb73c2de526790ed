"""Shows `judge` with the arguments that it takes: the fields of a dataclass [python/credence/judging.py, _takes]."""

from __future__ import annotations

import inspect
from typing import Any

import griffe

import credence


class FieldsAsArguments(griffe.Extension):
    def on_package(self, *, pkg: griffe.Module, **_: Any) -> None:
        griffe.DataclassesExtension().on_package(pkg=pkg)
        asked = pkg["judging._Asked"].parameters
        judge = pkg["judging.judge"]
        judge.parameters = griffe.Parameters(*(one for one in asked if one.name != "self"))
        judge.docstring.value = inspect.getdoc(credence.judge)
