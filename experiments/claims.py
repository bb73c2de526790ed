"""Whether the sentences of a page, or of several, are true of the tables that a script prints:

    ... | python3 claims.py CLAIMS.py [-] [TABLE.csv...] [PAGE.md...]

CLAIMS.py has the dictionary CLAIMS, of sentences and their conditions, and TABLES, which gives the tables' cells names.
Conditions are checked on the tables of the standard input (-, which is passed on), of CSV files, reports of `credence
report --format csv` among them, and of the pages. With pages every table must be there, no two may differ in a row that both have, every
sentence must stand in one of the pages, and every number of their bullets and pictures must stand in one of the
sentences. Without a page, what needs another script's table is left out.
"""

import csv
import importlib.util
import re
import sys
from pathlib import Path
from types import SimpleNamespace

REPORT = "scenario arm name mean se verdict"


class Missing(LookupError):
    """A table that another script prints."""


class Number(float):
    """What a cell such as `**0.103 ± 0.002**` says, and half its interval."""

    def __new__(cls, text):
        mean, _, half = text.strip("*").partition(" ± ")
        number = super().__new__(cls, mean)
        number.half = float(half or 0)
        return number


class Table(dict):
    """Rows by their first cells, or first cell."""

    def __missing__(self, key):
        raise KeyError(key) if self else Missing

    def items(self):
        if not self:
            raise Missing
        return super().items()

    def values(self):
        return [row for _, row in self.items()]

    def add(self, key_count, names, cells):
        row = SimpleNamespace()
        for name, text in zip(names, cells[key_count:], strict=True):
            try:
                setattr(row, name, Number(text))
            except ValueError:
                setattr(row, name, text)
        if self.setdefault(tuple(cells[:key_count]) if key_count > 1 else cells[0], row) != row:
            yield f"two tables differ in the row {' | '.join(cells[:key_count])}"


def rows_of(text):
    """The rows of all Markdown tables, each with the head of its table."""
    head = None
    for line in text.splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")] if line.startswith("|") else None
        if head and cells and not cells[0].startswith("---"):
            yield head, cells
        head = head or cells if cells else None


def add_row(tables, described, head, cells):
    """What is wrong with the row."""
    for name, (begin, key_count, names) in described.items():
        if " | ".join(head).startswith(begin) and len(head) == key_count + len(names.split()):
            yield from tables[name].add(key_count, names.split(), cells)


def in_one_line(text):
    return " ".join(text.split())


def check_pages(pages, claims):
    """What is wrong between the pages and the sentences."""
    bullets = [bullet for page in pages for bullet in
               re.findall(r"^(?:- |!\[).*(?:\n  .*)*", page.partition("\n## References\n")[0], re.M)]
    rest = "\n".join(map(in_one_line, bullets))
    for sentence in sorted(claims, key=len, reverse=True):
        if not any(sentence in in_one_line(page) for page in pages):
            yield f"this stands in no page: {sentence}"
        rest = rest.replace(sentence, "")
    for line in rest.splitlines():
        if re.search(r"\d", line):
            yield f"there is no claim for the numbers in: {line}"


def main(claims_file, *sources):
    spec = importlib.util.spec_from_file_location("described", claims_file)
    described = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(described)
    tables = {name: Table() for name in described.TABLES}
    wrong, pages = [], []
    for source in sources:
        if source.endswith(".csv"):
            with open(source, newline="") as file:
                head, *rows = csv.reader(file)
            wanted = [head.index(name) for name in REPORT.split()] if {*REPORT.split()} < {*head} else range(len(head))
            for row in rows:
                wrong += add_row(tables, described.TABLES, [head[at] for at in wanted], [row[at] for at in wanted])
            continue
        text = sys.stdin.read() if source == "-" else Path(source).read_text()
        if source == "-":
            print(text, end="", flush=True)
        else:
            pages.append(text)
        for head, cells in rows_of(text):
            wrong += add_row(tables, described.TABLES, head, cells)
    if pages:
        wrong += check_pages(pages, described.CLAIMS)
        wrong += [f"there is no table {name}" for name, table in tables.items() if not table]
    vars(described).update(tables)
    for sentence, holds in described.CLAIMS.items():
        try:
            if not holds():
                wrong.append(f"the tables do not bear this: {sentence}")
        except KeyError as row:
            wrong.append(f"there is no row {row} for this: {sentence}")
        except Missing:
            pass
    for what in wrong:
        print(what, file=sys.stderr)
    return len(wrong)


if __name__ == "__main__":
    sys.exit(min(1, main(*sys.argv[1:])))
