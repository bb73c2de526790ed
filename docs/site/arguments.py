"""Shows `judge` with the arguments that it takes: the fields of a dataclass [python/credence/judging.py, _takes]."""

from __future__ import annotations

from typing import Any

import griffe


class FieldsAsArguments(griffe.Extension):
    def on_package(self, *, pkg: griffe.Module, **_: Any) -> None:
        griffe.DataclassesExtension().on_package(pkg=pkg)
        asked = pkg["judging._Asked"].parameters
        pkg["judging.judge"].parameters = griffe.Parameters(*(one for one in asked if one.name != "self"))
