#!/usr/bin/env python3
"""What credence says first of each record of known.py, as a table in Markdown: the gallery of docs/verdicts.md.

    python3 says.py            # needs credence
"""

from __future__ import annotations

import re
import warnings

from known import KNOWN, made

import credence


def said(verdict: credence.Verdict) -> list[str]:
    """The verdict, the first finding or note, or else the reason why there is none, and the first hint."""
    found = [re.sub(r" \([^()]* to [^()]*\)$", "", one["text"]) for one in [*verdict["findings"], *verdict["cautions"]]]
    return [
        verdict.verdict,
        found[0] if found else verdict.json[0].get("reason", "-").split(";")[0],
        verdict["hints"][0] if verdict["hints"] else "-",
    ]


if __name__ == "__main__":
    warnings.simplefilter("ignore")  # two records are made to look odd
    print("| record | what is wrong | verdict | the first finding | the first hint |\n|---|---|---|---|---|")
    for name, (_, wrong, _) in KNOWN.items():
        print(f"| `{name}` | {wrong} | {' | '.join(said(credence.judge(**made(name))))} |")
