"""What the SQUARE files of smfeval say of their covariances, their gauge and their body [SQUARE/0.3]."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

from credence._errors import InputError, argument
from credence.adapters.tables import Path, note, text_of

_alignments = {"fixed": "none", "se3": "se3", "gravity_yaw": "yaw"}
_charts = {"right_perturbation": "local", "left_perturbation": "global"}


def square_header(path: Path) -> dict[str, str]:
    """The keys and values of lines ``#%KEY VALUE`` at the head of a file; none where it is no SQUARE."""
    said: dict[str, str] = {}
    with text_of(path) as encoding, open(path, encoding=encoding) as file:
        for line in file:
            if not line.startswith("#"):
                break
            key, _, value = line[2:].strip().partition(" ")
            said |= {key: value.strip()} if line.startswith("#%") else {}
    if "FORMAT" not in said:
        return {}
    if said.get("REPRESENTATION") not in ("gaussian_se3", "deterministic"):
        has = f"it is a SQUARE of {said.get('REPRESENTATION', 'no representation')}"
        raise InputError(f"{os.fspath(path)}: {has}, not gaussian_se3. Give its means and covariances.")
    return said


def square_order(path: Path) -> list[str]:
    """The words of an order [orders.py] that the header of a SQUARE stands for; none of another file."""
    header = square_header(path)
    turned = header.get("TANGENT_ORDER") == "rotation_translation"
    return [*(["lower"] if header else []), *(["rotation first"] if turned else [])]


def square_options(files: Sequence[tuple[Path, Path]], given: dict[str, Any]) -> dict[str, Any]:
    """The options that the headers of the estimates stand for, where they were not given; their bodies are noted."""
    headers = [(square_header(estimate), square_header(truth)) for estimate, truth in files]
    kinds = {(of.get("GAUGE"), of.get("TANGENT_CONVENTION"), of.get("BODY_FRAME")) for of, _ in headers if of}
    if not kinds:
        return given
    source = os.fspath(files[0][0])
    if len(kinds) > 1 or not all(of for of, _ in headers):
        raise InputError(f"{source}: the other logs have headers that say otherwise. Give logs of one kind.")
    ((gauge, convention, body),) = kinds
    if convention not in _charts:
        raise InputError(f"{source}: unknown TANGENT_CONVENTION {convention}. Give one of {', '.join(_charts)}.")
    if "align" not in given:
        if gauge not in _alignments:
            raise InputError(f"{source}: a gauge of {gauge} is not aligned. Give {argument('align')}.")
        note(
            f"{source}: its gauge is {gauge}: {argument('align')} is {_alignments[gauge]}, unless you give another one"
        )
    others = {truth.get("BODY_FRAME") for _, truth in headers}
    if "body" not in given and others != {body}:
        asked = f"Give {argument('body')} if those of the truth are of another one"
        note(f"{source}: its poses are of the body {body}. {asked}")
    return {"manifold": "SE3", "chart": _charts[convention], "align": _alignments.get(str(gauge)), **given}
