"""Shows `judge` with the arguments that it takes: the fields of a dataclass [python/credence/judging.py, _takes]."""

from __future__ import annotations

import re
from typing import Any

import griffe


class FieldsAsArguments(griffe.Extension):
    def on_package(self, *, pkg: griffe.Module, **_: Any) -> None:
        griffe.DataclassesExtension().on_package(pkg=pkg)
        asked = pkg["judging._Asked"].parameters
        judge, record = pkg["judging.judge"], pkg["judging.Record"]
        judge.parameters = griffe.Parameters(*(one for one in asked if one.name != "self"))
        of_fields = record.docstring.value.partition("----------\n")[2].rstrip()
        text = re.sub(r"(?m)^RECORD\n(?s:.+?)\n(?=runs )", lambda _: f"{of_fields}\n", judge.docstring.value)
        judge.docstring.value = text
