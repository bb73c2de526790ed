"""The pages: their blocks of Python run, from the top of a page to its bottom; their links lead somewhere; and the site
has all of them."""

from __future__ import annotations

import pathlib
import re

import matplotlib
import numpy as np
import pytest
import studies
from conftest import SCENARIO
from test_adapters import tum_pair

import credence

PAGES = sorted(
    page
    for folder in ("", "docs", "docs/theory", "analysis")
    for page in (studies.ROOT / folder).glob("*.md")
    if "```python" in page.read_text() and page.name != "logs.md"  # test_logs.py has its files
)
# A walk that is measured; its filter believes in q and r.
TRACKER = """
import numpy as np
import credence


def run(rng, q=1.0, r=1.0):
    x, m, P, errors, covariances = rng.normal(), 0.0, 1.0, [], []
    for _ in range(10):
        x, P = x + 0.2 * rng.normal(), P + q**2
        K = P / (P + r**2)
        m, P = m + K * (x + 2 * rng.normal() - m), (1 - K) * P
        errors.append(m - x)
        covariances.append(P)
    return credence.Run(np.array(errors)[:, None], np.array(covariances)[:, None, None])
"""


def block_lines(page: pathlib.Path) -> list[tuple[str, str | None]]:
    """The blocks of a page, each at its line, so that what fails names it, and what the page says that they print."""
    text = page.read_text()
    found = re.finditer(r"^```python\n(.+?)^```\n(?:```text\n(.+?)^```$)?", text, re.MULTILINE | re.DOTALL)
    return [("\n" * text[: block.start(1)].count("\n") + block[1], block[2]) for block in found]


def printed_like(shown: str) -> str:
    """An expression for what is printed, where a line `…` stands for any lines."""
    return "".join(r"(.*\n)*?" if line == "…" else re.escape(line + "\n") for line in shown.splitlines())


@pytest.fixture
def names(page, tmp_path, monkeypatch):
    """What the pages take as given: errors and covariances of a filter that is right, trajectories, and files."""
    monkeypatch.chdir(tmp_path)
    matplotlib.use("agg")
    study = studies.swept() if page.name == "sweep.md" else studies.two_scenarios()
    for name, made in (("study", study), ("credence", study), ("swept", studies.swept()),
                       ("trial", studies.trajectory())):
        (tmp_path / f"{name}.h5").symlink_to(made)
    (tmp_path / "scenario.ini").write_text(SCENARIO)
    (tmp_path / "tracker.py").write_text(TRACKER)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    covariances = np.broadcast_to(np.eye(3) + 0.5, (400, 5, 3, 3))
    errors = np.random.default_rng(1).standard_normal((400, 5, 3)) @ np.linalg.cholesky(covariances[0, 0]).T
    estimates, truths = tum_pair(tmp_path, np.eye(6).ravel())
    return {"credence": credence, "np": np, "errors": errors, "covariances": covariances, "estimates": estimates,
            "truths": truths, "__name__": "page"}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(studies.ROOT).as_posix())
def test_the_blocks_of_a_page_run(page, names, capsys):
    blocks = block_lines(page)
    assert blocks
    for block, shown in blocks:
        capsys.readouterr()
        exec(compile(block, str(page), "exec"), names)
        assert shown is None or re.fullmatch(printed_like(shown), capsys.readouterr().out)
    for test in [value for name, value in names.items() if name.startswith("test_")]:
        test()


def test_the_pages_are_found():
    assert {page.name for page in PAGES} >= {"README.md", "in-the-wild.md", "python.md", "results-format.md"}


NAV = (studies.ROOT / "docs" / "mkdocs.yml").read_text().partition("\nnav:\n")[2].partition("\nvalidation:")[0]
LISTED = set(re.findall(r"^ *- (?:[^:#\n]+: )?([\w./-]+\.md)$", NAV, re.MULTILINE))
WRITTEN = {
    path.relative_to(studies.ROOT).as_posix()
    for pattern in ("docs/*.md", "docs/theory/*.md", "[RC]*.md", "analysis/README.md")
    for path in studies.ROOT.glob(pattern)
}
HEADERS = {f"include/credence/{path.name}.md" for path in (studies.ROOT / "include" / "credence").glob("*.hpp")}
MADE = {"python/credence.md", "include/credence/index.md", *HEADERS}  # by docs/site/hooks.py
NOTEBOOKS = {f"docs/notebooks/{path.stem}.md" for path in (studies.ROOT / "docs" / "notebooks").glob("*.py")}


def test_the_site_leads_to_every_page():
    assert LISTED == WRITTEN | MADE | NOTEBOOKS


def anchors(page: pathlib.Path) -> set[str]:
    """Those of the headings of a page, as code hosts make them."""
    text = re.sub(r"^```.*?^```", "", page.read_text(), flags=re.MULTILINE | re.DOTALL)
    found = re.findall(r"^#+ (.+)$", text, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in found}


@pytest.mark.parametrize("name", sorted(WRITTEN))
def test_links_lead_somewhere(name):
    page = studies.ROOT / name
    text = re.sub(r"^```.*?^```|`[^`\n]*`", "", page.read_text(), flags=re.MULTILINE | re.DOTALL)
    for target, anchor in re.findall(r"\]\(([^)\s#]*)(?:#([^)\s]+))?\)", text):
        if re.match(r"https?:", target):
            continue
        path = (page.parent / target).resolve() if target else page
        assert path.exists(), target
        assert not anchor or anchor in anchors(path), f"{target}#{anchor}"


def test_the_page_on_filters_of_ones_own_shows_every_ready_part():
    parts = re.findall(r"^//   (\w+)", (studies.ROOT / "include/credence/filters.hpp").read_text(), re.MULTILINE)
    page = (studies.ROOT / "docs/own-filter.md").read_text()
    assert len(parts) > 6
    assert [part for part in parts if not re.search(rf"\b{part}\b", page)] == []


def test_the_page_on_performance_begins_with_how_fast_every_estimator_is_here():
    listed = (studies.ROOT / "include/credence/detail/estimator_list.hpp").read_text()
    names = re.findall(r"ESTIMATOR\((\w+), \w+, [A-Z]\w+\)", listed)
    start = "\n".join((studies.ROOT / "docs/performance.md").read_text().splitlines()[:16])
    assert {"ekf", "kf"} < {*names}
    assert [name for name in (*names, "fixed", "greedy", "credence run", "bench/run.sh") if name not in start] == []


def test_the_page_on_other_tools_names_their_packages():
    page = (studies.ROOT / "analysis/README.md").read_text()
    packages = ("pip install", "octave-netcdf", "r-cran-ncdf4", "hdf5-tools", "netcdf-bin", "python3-h5netcdf")
    assert [package for package in packages if package not in page] == []
