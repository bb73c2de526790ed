"""The pages of the reference: Python's names, and the headers that users of the library are promised."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import yaml

ROOT = Path(__file__).resolve().parents[2]
SECTIONS = {
    "Verdicts": ("judge", "Record", "assert_consistent", "Verdict"),
    "Trials of a filter": ("simulate", "Run", "Simulation"),
    "What to change": ("tune", "Tuned"),
    "Why": ("budget", "Budget"),
    "Studies of scenarios": (
        "run", "resume", "merge", "show", "report", "compare", "replay", "Report", "Comparison", "Now", "Prospects",
    ),
    "Files": ("open", "Study", "Scenario", "Arm", "open_trajectories", "Trajectory"),
    "Pictures": ("plot", "animate"),
    "Errors": ("InputError", "Failure", "Interrupted"),
}


def bibtex() -> str:
    """The entry that CITATION.cff gives."""
    cited = yaml.safe_load((ROOT / "CITATION.cff").read_text())
    authors = " and ".join(f"{{{author['name']}}}" for author in cited["authors"])
    fields = {"title": f"{{{cited['title']}}}", "author": authors, "version": cited["version"],
              "year": cited["date-released"].year, "note": f"{cited['license']} licence"}
    return "@software{credence,\n" + ",\n".join(f"  {name} = {{{value}}}" for name, value in fields.items()) + "\n}"


def _all_names() -> list[str]:
    """What the package exports."""
    for node in ast.parse((ROOT / "python" / "credence" / "__init__.py").read_text()).body:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__":
            return list(ast.literal_eval(node.value))
    raise ValueError("python/credence/__init__.py has no __all__")


def python_page() -> str:
    """Every name of the package by section; what no section names comes last."""
    left = [name for name in _all_names() if not any(name in names for names in SECTIONS.values())]
    said = ["# Python reference\n\n[python.md](../docs/python.md) says how to begin.\n"]
    for section, names in {**SECTIONS, "Other": left}.items():
        said += [f"## {section}\n"] * bool(names) + [f"::: credence.{name}\n" for name in names]
    said.append("## Adapters\n\n::: credence.adapters\n    options:\n      show_root_heading: false\n")
    return "\n".join(said)


def headers() -> list[Path]:
    """The headers that users are promised."""
    return sorted((ROOT / "include" / "credence").glob("*.hpp"))


def _prose(lines: list[str]) -> str:
    """The text of a comment in Markdown. Lines that are set in are code, but not those of a list."""
    said: list[str] = []
    in_list = in_code = False
    for line in lines:
        is_code = line.startswith("  ") and not in_list
        in_list = line.startswith("- ") or (in_list and line.startswith("  "))
        if is_code != in_code:
            said.append("")
        in_code = is_code
        parts = re.split(r"(`[^`]*`)", line)
        parts[::2] = [re.sub(r"([*_\[\]])", r"\\\1", part).replace("<", "&lt;") for part in parts[::2]]
        said.append(f"  {line}" if is_code else "".join(parts))
    return "\n".join(said)


def _introduction(text: str) -> list[str]:
    """The lines of a header's first comment."""
    block = re.search(r"^(//.*\n)+", text, re.MULTILINE)
    return [re.sub(r"^// ?", "", line) for line in (block[0] if block else "").splitlines()]


def _declarations(text: str) -> Iterator[tuple[list[str], list[str]]]:
    """Each comment of a namespace's depth with the declarations that it is above, without their bodies."""
    comment: list[str] = []
    code: list[str] = []
    depth, was_comment = 0, False
    for line in text.splitlines():
        is_comment = depth == 0 and line.startswith("///")
        if (is_comment and not was_comment) or (depth == 0 and not line.strip()):
            if code:
                yield comment, code
            comment, code = [], []
        was_comment = is_comment
        if is_comment:
            comment.append(re.sub(r"^/// ?", "", line))
            continue
        if re.match(r"(inline )?namespace|}  // namespace|#", line):
            continue
        if line.strip() or depth:
            code.append(line)
        depth += line.count("{") - line.count("}")
    if code:
        yield comment, code


def _without_bodies(code: list[str]) -> str:
    """Declarations as a user needs them: neither bodies of functions, unless of a line, nor private members."""
    said: list[str] = []
    depth, body_of, is_private = 0, None, False
    for line in code:
        if line.strip() in ("private:", "public:"):
            is_private = line.strip() == "private:"
        if body_of is None and not (is_private and depth > 0 and not line.startswith("}")):
            if line.endswith("{") and ")" in line and not re.match(r"\s*(struct|class|enum)\b", line):
                line, body_of = f"{line[:-2]};", depth
            if line.startswith("}") and said and not said[-1].strip():
                said.pop()
            said.append(line)
        depth += line.count("{") - line.count("}") + (body_of == depth and line.endswith(";"))
        if body_of is not None and depth <= body_of:
            body_of = None
    return "\n".join(said).rstrip()


def _name(code: str) -> str:
    """What a declaration declares."""
    plain = re.sub(r"//.*|<[^<>]*(<[^<>]*>[^<>]*)*>", "", code)
    kinds = (r"(?:struct|enum class|class|enum|concept) (\w+)", r"(\w+)\(", r"(\w+)(?:\[\])? =", r"(\w+);")
    return next(found[1] for kind in kinds if (found := re.search(kind, plain)))


def header_page(header: Path) -> str:
    """A header: what it is for, and each declaration with its comment."""
    text = header.read_text()
    first, *rest = _introduction(text)
    module = re.match(r"Module (\w+): (.*)", first)
    said = [f"# {header.name}\n", f"`#include <credence/{header.name}>`" + (f" (module {module[1]})" if module else "")]
    said += ["", _prose([module[2][:1].upper() + module[2][1:] if module else first, *rest]), ""]
    for comment, code in _declarations(text.partition("namespace credence {")[2]):
        shown = _without_bodies(code)
        if re.fullmatch(r"struct \w+;", shown):
            continue
        said += [f"## {_name(shown)}\n", _prose(comment), "", f"```cpp\n{shown}\n```", ""]
    return "\n".join(said)


def headers_page() -> str:
    """The table of the headers."""
    said = ["# C++ reference\n", "The headers that users of the library are promised; each compiles alone.",
            "[own-filter.md](../../docs/own-filter.md) says how to begin.\n", "| header | what it has |", "|---|---|"]
    for header in headers():
        sentence = re.split(r"\. |: | \[", " ".join(_introduction(header.read_text())))[1]
        said.append(f"| [{header.name}]({header.name}.md) | {_prose([sentence.rstrip('.')])} |")
    return "\n".join(said) + "\n"
