"""What MkDocs does beside its pages: the pages that no file of docs/site is, and Markdown as code hosts read it.

A page is called by its place in the project: docs/judge.md, README.md. What a page links to and is no page, a source
file or a folder of them, becomes one: experiments/worlds/robot.hpp.md.
"""

from __future__ import annotations

import logging
import posixpath
import re
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from markdown_it import MarkdownIt
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files, InclusionLevel
from mkdocs.structure.pages import Page

sys.path.insert(0, str(Path(__file__).parent))
import api

ROOT = Path(__file__).resolve().parents[2]
PAGES = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "analysis/README.md", "docs/*.md", "docs/theory/*.md")
PICTURES = "docs/figures/**/*.png"
NOTEBOOKS = ROOT / "build" / "site" / "notebooks"
LANGUAGES = {".hpp": "cpp", ".cpp": "cpp", ".py": "python", ".sh": "sh", ".m": "matlab", ".R": "r", ".ini": "ini",
             ".cmake": "cmake", ".cff": "yaml", "CMakeLists.txt": "cmake"}
LINK = re.compile(r"(?<=\]\()([^)\s#]+)(#[^)\s]*)?(?=\))")
FILE_AS_TEXT = re.compile(r"\[[\w/.-]+\.md\](?=\(([^)\s#]+)(?:#[^)\s]*)?\))")
FENCE = re.compile(r"^ *```", re.MULTILINE)

log = logging.getLogger("mkdocs.hooks.credence")


def _outside_code(text: str) -> Iterator[tuple[int, str]]:
    """The lines that are not in a block of code, with their numbers."""
    code = False
    for number, line in enumerate(text.split("\n")):
        if FENCE.match(line):
            code = not code
        elif not code:
            yield number, line


def _target(place: str, link: str) -> str | None:
    """What a link of a page leads to in the project; None for addresses of the web."""
    return None if re.match(r"[a-z]+:", link) else posixpath.normpath(posixpath.join(posixpath.dirname(place), link))


def _page_of(target: str) -> str:
    """The page that shows a file or a folder of the project."""
    path = ROOT / target
    if path.parent == ROOT / "docs" / "notebooks":
        return target.removesuffix(".py") + ".md"
    if path.is_dir():
        return f"{target}/README.md" if (path / "README.md").is_file() else f"{target}/index.md"
    return target if path.suffix in (".md", ".png") else f"{target}.md"


def _shown(path: Path) -> list[Path]:
    """The files of a folder that its page lists."""
    return sorted(one for one in path.iterdir() if one.is_file() and one.suffix in (*LANGUAGES, ".md", ".txt"))


def _source(target: str) -> str:
    """The page of a source file or a folder, in Markdown, which the search leaves out."""
    path, said = ROOT / target, [f"---\nsearch: {{exclude: true}}\nhide: [toc]\n---\n# {target}\n"]
    if path.is_dir():
        said += [f"- [{one.name}]({one.name})" for one in _shown(path)]
    elif path.suffix == ".md":
        return said[0].rpartition("#")[0] + path.read_text()
    else:
        language = LANGUAGES.get(path.suffix) or LANGUAGES.get(path.name, "text")
        said.append(f"````{language}\n{path.read_text().rstrip()}\n````")
    return "\n".join(said) + "\n"


def _destination(place: str) -> str:
    """The address of a page or picture: docs/judge.md has judge.html, and README.md index.html."""
    place = place.removeprefix("docs/")
    if place.endswith(".md"):
        folder, name = posixpath.split(place.removesuffix(".md"))
        place = posixpath.join(folder, "index" if name == "README" else name) + ".html"
    return place


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the project's pages and pictures, the references, the notebooks, and the source files that pages link to."""

    def add(place: str, content: str | None = None, *, listed: bool = True) -> None:
        inclusion = InclusionLevel.INCLUDED if listed else InclusionLevel.NOT_IN_NAV
        made = {"content": content} if content is not None else {"abs_src_path": str(ROOT / place)}
        file = File.generated(config, place, inclusion=inclusion, **made)
        file.dest_uri = _destination(place)
        files.append(file)

    for pattern in (*PAGES, PICTURES):
        for path in sorted(ROOT.glob(pattern)):
            add(path.relative_to(ROOT).as_posix())
    add("python/credence.md", api.python_page())
    add("include/credence/index.md", api.headers_page())
    for header in api.headers():
        add(f"include/credence/{header.name}.md", api.header_page(header))
    for path in sorted(NOTEBOOKS.rglob("*.*")):
        place = f"docs/notebooks/{path.relative_to(NOTEBOOKS).as_posix()}"
        add(place, path.read_text() if path.suffix == ".md" else None)
        if path.suffix != ".md":
            files.get_file_from_path(place).abs_src_path = str(path)

    waiting = [file for file in files if file.src_uri.endswith(".md")]
    while waiting:
        page = waiting.pop()
        for _, line in _outside_code(page.content_string):
            for link in LINK.finditer(line):
                target = _target(page.src_uri, link[1])
                if target and (ROOT / target).exists() and not files.get_file_from_path(_page_of(target)):
                    add(_page_of(target), _source(target), listed=False)
                    waiting.append(files.get_file_from_path(_page_of(target)))
    return files


def _as_on_code_hosts(text: str) -> str:
    """Markdown for Python-Markdown, which wants an empty line before a list, a table or a block, and one language."""
    lines = text.split("\n")
    for number, line in list(_outside_code(text)):
        before = lines[number - 1].strip() if number else ""
        listed = re.match(r"([-*]|\d+\.) ", line)
        if (line.startswith("|") and before[:1] not in ("|", "")) or (
            listed and before and not re.match(r"([-*]|\d+\.) ", before) and not lines[number - 1].startswith(" ")
        ):
            lines[number] = f"\n{line}"
        if re.fullmatch(r"<!-- .* -->", line):
            lines[number] = ""
    text = "\n".join(lines)
    return re.sub(r"^(```+)(\w+) slow$", r"\1\2", text, flags=re.MULTILINE)


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Lead links to source files to their pages, call pages by their titles, and end the front page with BibTeX."""
    place = page.file.src_uri

    def lead(link: re.Match[str]) -> str:
        target = _target(place, link[1])
        if target is None or not (ROOT / target).exists() or link[1].endswith(".md"):
            return link[0]
        return posixpath.relpath(_page_of(target), posixpath.dirname(place) or ".") + (link[2] or "")

    def call(text: re.Match[str]) -> str:
        target = files.get_file_from_path(_target(place, text[1]) or "")
        title = re.search(r"^# (.+)$", target.content_string, re.MULTILINE) if target else None
        return f"[{title[1]}]" if title else text[0]

    lines = markdown.split("\n")
    for number, line in _outside_code(markdown):
        lines[number] = LINK.sub(lead, FILE_AS_TEXT.sub(call, line))
    markdown = "\n".join(lines)
    if place == "README.md":
        markdown += f"\n\n```bibtex\n{api.bibtex()}\n```\n"
    page.meta["credence_markdown"] = markdown
    return _as_on_code_hosts(markdown)


COUNTED = ("h2", "h3", "ul", "ol", "li", "table", "tr", "td", "img", "em", "strong", "blockquote")


def on_page_content(html: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Warn if a page does not have the elements that a code host, which reads CommonMark, shows."""
    markdown = page.meta["credence_markdown"]
    if re.search(r"^::: |^<div", markdown, re.MULTILINE):
        return html
    expected = MarkdownIt("commonmark").enable("table").render(markdown)
    counts = [Counter(re.findall(r"<([a-z0-9]+)[ >]", text)) for text in (expected, html)]
    for tag in COUNTED:
        if counts[0][tag] != counts[1][tag]:
            log.warning("%s: %d <%s> on a code host, %d here", page.file.src_uri, counts[0][tag], tag, counts[1][tag])
    return html
