#!/usr/bin/env python3
"""check_page.py PAGE.html REPORT.json: the page in headless Chromium. It loads nothing and complains of nothing, its
charts have marks that lie inside them, its figures are those of the JSON, it fits windows of 390 and 1200 pixels, its
contrasts suffice in light and dark, and its scenario is in the print."""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

from browser import Browser

FAULTS = []
COUNTED = {"figures": 0, "marks": 0}


def expect(good, text):
    if not good:
        FAULTS.append(text)


def same(shown, expected, what):
    """Whether the exact value behind a figure is the JSON's; null is shown as `-`."""
    COUNTED["figures"] += 1
    expect(shown == expected, f"{what}: the page has {shown}, the JSON {expected}")


def short(value):
    """As short_number of html.cpp: five significant digits."""
    if value is None:
        return "-"
    if abs(value) < 1e15 and (abs(value) >= 1e5 or value == round(value)):
        return f"{value:.0f}"
    return f"{value:.5g}"


def table(tables, words):
    found = [one for one in tables if one["caption"].startswith(words)]
    expect(len(found) == 1, f"{len(found)} tables with the caption {words!r}")
    return found[0] if found else {"caption": words, "rows": []}


def rows(found, group=None):
    return {
        row["head"]: row["cells"]
        for row in found["rows"]
        if group is None or row["group"] == group or row["group"] == ""
    }


def check_cells(cells, expected, what):
    """Each cell's exact values are those of a list; each is shown rounded."""
    for cell, values in zip(cells, expected):
        if values == [] or None in values:
            expect(cell["values"] == [], f"{what}: figures where the JSON has none")
            continue
        for one, (value, text) in enumerate(zip(values, cell["shown"] + [""] * len(values))):
            same(cell["values"][one] if one < len(cell["values"]) else None, value, what)
            number = text.rstrip(" %").lstrip("<> ")
            if number and "e" not in number:
                scale = 100 if text.endswith("%") else 1
                digits = len(number.partition(".")[2])
                near = (
                    abs(float(number) - scale * value) <= 0.5001 * 10 ** -digits or abs(value) >= 1e6 or text[0] in "<>"
                )
                expect(near, f"{what}: shows {text} for {value}")


def check_figures(tables, arm):
    found = table(tables, f"{arm['scenario']}: columns of the trials")
    groups = {
        "trace_P": "trace(P), last step",
        "mean_trace_P": "trace(P), mean",
        "unseen": "unseen",
        "pose_error": "pose error",
        "nees_ratio": "NEES/n",
        "nis_ratio": "NIS/m",
        "log_score": "log score",
        "path_length": "length of the true path",
    }
    if arm["arm"] == "record":
        del groups["path_length"]  # a record has no world in which a robot moves
    for name, words in groups.items():
        of_arm = [row for row in found["rows"] if row["group"].startswith(words) and row["head"] == arm["arm"]]
        figure = arm[name]
        if figure["n"] == 0:
            expect(not of_arm, f"{name} of {arm['arm']} has a row without values")
            continue
        published = figure.get("published")
        check_cells(
            of_arm[0]["cells"],
            [
                [figure["mean"]],
                figure["ci95"],
                figure.get("bootstrap95", []),
                [figure["median"]],
                [figure["sd"]],
                [published["value"], published["percentile"]] if published else [],
            ],
            f"{arm['arm']} {name}",
        )


def check_blocks(tables, arm, single):
    group = "" if single else arm["arm"]
    groups = rows(table(tables, f"{arm['scenario']}: groups of the state"), group)
    coverage = rows(table(tables, f"{arm['scenario']}: coverage"), group)
    shown = [group for group in arm["groups"] if group["group"] in groups]  # the ten farthest off
    expect(len(shown) == min(10, len(arm["groups"])), f"{arm['arm']}: {len(shown)} groups are shown")
    for group in shown:
        name, accuracy = group["group"], group["accuracy"]
        check_cells(
            [cell for i, cell in enumerate(groups[name]) if i not in (4, 5, 6)],
            [
                [group["dimension"]],
                [group["nees_ratio"]],
                group["ci95"],
                [group["se"]],
                [accuracy["rmse"]],
                [accuracy["rmse_ratio"]],
                accuracy["rmse_ratio_ci95"],
            ],
            f"{arm['arm']} group {name}",
        )
        out = f"{group['anees']['steps_outside_simultaneous']} of {group['anees']['steps']}"
        expect(groups[name][4]["text"] == out, f"{arm['arm']} {name}: steps out {groups[name][4]['text']}, not {out}")
        check_cells(
            coverage[name], [[level["mean"]] for level in group["coverage"]], f"{arm['arm']} coverage of {name}"
        )


def check_innovations(tables, arm, single):
    if not arm["nis"]:
        return
    group = "" if single else arm["arm"]
    nis = rows(table(tables, f"{arm['scenario']}: innovations"), group)
    for part in arm["nis"]:
        check_cells(
            nis[part["rows"]][:4],
            [[part["degrees"]], [part["ratio"]], part["ratio_ci95"], part["scale95"]],
            f"{arm['arm']} NIS of {part['rows']}",
        )
    if not arm["whiteness"]:
        return
    white = rows(table(tables, f"{arm['scenario']}: whiteness"), group)
    for lag in arm["whiteness"]:
        check_cells(
            white[str(lag["lag"])],
            [[lag["correlation"]], [lag["scaled"]], [lag["bound95"]], [lag["simultaneous_bound95"]], [lag["count"]]],
            f"{arm['arm']} lag {lag['lag']}",
        )


def check_pairs(tables, arm):
    pair = arm.get("paired_difference")
    if pair is None:
        return
    found = table(tables, f"{arm['scenario']}: {pair['pair']}, trial by trial")
    figures = [value for name, value in pair.items() if name != "pair" and value["n"] > 0]
    expect(len(figures) == len(found["rows"]), f"{pair['pair']}: {len(found['rows'])} rows for {len(figures)} figures")
    for figure, row in zip(figures, found["rows"]):
        check_cells(
            row["cells"],
            [
                [figure["mean"]],
                figure["ci95"],
                figure["bootstrap95"],
                [figure["median"]],
                [figure["below"]],
                [figure["above"]],
                [figure["ties"]],
                [figure["holm_p"]],
                [figure["effect_size"]],
                [figure["variance_reduction"]],
            ],
            f"{pair['pair']} {row['head']}",
        )


def check_hovers(charts, arm):
    """The marks of the verdict's picture and of NEES by step say what the JSON says."""
    hovers = {text for one in charts if one["title"].startswith(arm["scenario"] + ":") for text in one["hovers"]}
    for group in arm["groups"][:10] if len(arm["groups"]) <= 10 else arm["groups"][:1]:
        low, high = group["ci95"]
        if low is not None:
            says = f"{arm['arm']}, {group['group']}: NEES/dim {short(group['nees_ratio'])}"
            says += f", 95 % {short(low)} to {short(high)}"
            expect(says in hovers, f"no mark says: {says}")
        last = len(group["anees"]["ratio"])
        low, high = group["anees"]["simultaneous_band95"][-1]
        says = f"{arm['arm']}, step {last}: {short(group['anees']['ratio'][-1])}"
        says += f" (joint band {short(low)} to {short(high)})"
        expect(says in hovers, f"no mark says: {says}")


def check_contents(browser, arms):
    tables, charts = browser.evaluate("page.tables()"), browser.evaluate("page.charts()")
    verdicts = browser.evaluate("page.verdicts()")
    expect(
        [line["verdict"] for line in verdicts] == [arm["verdict"] for arm in arms], "verdicts are not those of the JSON"
    )
    expect(
        [line["arm"] for line in verdicts] == [f"{arm['scenario']} {arm['arm']}" for arm in arms],
        "arms are not the JSON's",
    )
    expect(all(line["why"] for line in verdicts), "a verdict without a reason")
    expect(all(one["caption"] and one["scoped"] for one in tables), "a table without caption or scope")
    scenarios = [arm["scenario"] for arm in arms]
    for arm in arms:
        check_figures(tables, arm)
        check_blocks(tables, arm, scenarios.count(arm["scenario"]) == 1)
        check_innovations(tables, arm, scenarios.count(arm["scenario"]) == 1)
        check_pairs(tables, arm)
        check_hovers(charts, arm)
    expect(len(charts) >= 5 * len(set(scenarios)), f"only {len(charts)} charts")
    for one in charts:
        COUNTED["marks"] += one["marks"]
        expect(one["marks"] > 0, f"no mark in {one['title']}")
        FAULTS.extend(f"{one['title']}: {fault}" for fault in one["faults"][:3])


def check_heads(browser):
    level = 0
    for depth, text in browser.evaluate("page.heads()"):
        expect(depth <= level + 1, f"the heading {text!r} skips a level")
        level = depth


def check_isolation(browser, address):
    own = [url for url in browser.requests if url != address and not url.startswith("data:")]
    expect(address in browser.requests, "the page's own request was not seen: nothing is observed")
    expect(not own, f"requests leave the page: {own}")
    expect(not browser.complaints, f"the console says: {browser.complaints[:3]}")
    expect(browser.evaluate("page.active()") == [], "the page has scripts or frames")
    outside = [url for url in browser.evaluate("page.addresses()") if not url.startswith(("#", "data:"))]
    expect(not outside, f"addresses outside the page: {outside}")
    expect(browser.evaluate("page.repeated()") == [], "an id stands twice")


def check_print(browser, arms):
    if shutil.which("pdftotext") is None:
        return
    with tempfile.TemporaryDirectory() as folder:
        browser.pdf(folder + "/page.pdf")
        text = subprocess.run(
            ["pdftotext", "-layout", folder + "/page.pdf", "-"], capture_output=True, text=True, check=True
        ).stdout
    for words in (
        {arm["verdict"] for arm in arms}
        | {"Provenance"}
        | ({"[scenario]"} if arms[0]["root_seed"] is not None else set())
    ):
        expect(words in text, f"the print lacks {words!r}")


def main(page, report):
    arms = json.loads(pathlib.Path(report).read_text())
    with Browser() as browser:
        browser.look(1200)
        address = browser.open(page)
        browser.evaluate("globalThis.page = " + pathlib.Path(__file__).with_name("page.js").read_text())
        check_isolation(browser, address)
        check_contents(browser, arms)
        check_heads(browser)
        for width, scheme in ((1200, "light"), (390, "light"), (390, "dark"), (1200, "dark")):
            browser.look(width, scheme=scheme)
            overflow = browser.evaluate(f"page.overflow({width})")
            expect(overflow <= 0, f"{overflow} pixels beyond a window of {width}")
            for words in browser.evaluate("[...page.pale(), ...page.paleMarks()]"):
                FAULTS.append(f"too little contrast ({scheme}): {words}")
        check_print(browser, arms)
        check_isolation(browser, address)
    for fault in FAULTS[:20]:
        print("page:", fault)
    if FAULTS:
        sys.exit(f"{page}: {len(FAULTS)} faults")
    print(
        f"{pathlib.Path(page).name}: {COUNTED['figures']} figures equal the JSON, {COUNTED['marks']} marks are in place"
    )


main(*sys.argv[1:])
