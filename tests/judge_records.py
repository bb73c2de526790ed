"""Judges the records that make_records.py --big wrote: each gets the right verdict, place and figures.

    judge_records.py CREDENCE DIR

Figures are held against NumPy's and SciPy's (DIR/*.json) to 1e-9; verdicts against what was done to the record.
"""
import json
import math
import pathlib
import subprocess
import sys

from scipy import stats

# record: (margin, verdict, findings that must be there as (what, where), cautions likewise). Nothing else may be found.
EXPECTED = {
    "exact": [("5%", "consistent", [], [])],
    "inflated": [("5%", "consistent", [], []), ("0.8%", "pessimistic", [("pessimistic", "all")], [])],
    "deflated": [("5%", "consistent", [], []), ("0.8%", "optimistic", [("optimistic", "all")], [])],
    "correlated": [("5%", "consistent", [], [("correlated", "innovations")])],
    "heavy": [("5%", "consistent", [], [("non-chi-square", "all")])],
    "biased": [("5%", "optimistic", [("biased", "x1")], [])],
    "block": [("5%", "optimistic", [("optimistic", one) for one in ("feature_1", "all", "x3", "x4")], [])],
    "missing": [("5%", "consistent", [], [])],
}


def judged(credence, record, margin):
    out = subprocess.run([credence, "judge", record, "--margin", margin, "--format", "json", "--quiet"], check=True,
                         capture_output=True, text=True).stdout
    return json.loads(out)[0]


def near(ours, theirs):
    if ours is None or theirs is None:
        return ours is theirs
    return abs(ours - theirs) <= 1e-9 * max(1.0, abs(theirs))


def relative_bound(products, place, trials, nis_ratio):
    """Half of Student's 95 % interval of a correlation over NIS/m, the number of products taken as equal in all trials."""
    spread = (products["square_sum"][place] - products["sum"][place] ** 2 / trials) / (trials - 1)
    half = stats.t.ppf(0.975, trials - 1) * math.sqrt(spread / trials)
    return half / (products["count"][place] / trials) / nis_ratio


def check_figures(ours, theirs):
    figures = {figure["part"]: figure for figure in theirs["figures"] if figure["name"] == "nees"}
    for group in ours["groups"]:
        name = group["group"]
        for step, (total, count) in enumerate(zip(figures[name]["sum"], theirs["present"])):
            ratio = total / (count * group["dimension"])
            assert near(group["anees"]["ratio"][step], ratio), (name, step)
            spread = (figures[name]["square_sum"][step] - total * total / count) / (count - 1)
            assert near(group["variance_ratio"][step], spread / (2 * group["dimension"])), (name, step)
    for step, distance in enumerate(theirs["shape_distance"]):
        assert near(ours["distribution"]["distance"][step], distance), step
    products = theirs["products"]
    for lag in ours["whiteness"]:
        assert near(lag["correlation"], products["sum"][lag["lag"] - 1] / products["count"][lag["lag"] - 1])
        assert near(lag["bound95"], relative_bound(products, lag["lag"] - 1, theirs["counted"], ours["nis"][0]["ratio"]))


def places(findings):
    return sorted({(finding["what"], finding["where"]) for finding in findings})


def main(credence, folder):
    for kind, cases in EXPECTED.items():
        expected = json.loads((folder / f"{kind}.json").read_text())
        for margin, verdict, findings, cautions in cases:
            ours = judged(credence, folder / f"{kind}.h5", margin)
            said = ours["verdict"], places(ours["findings"]), places(ours["cautions"])
            assert said[0] == verdict, (kind, margin, said)
            assert set(findings) <= set(said[1]) and (findings or not said[1]), (kind, margin, said)
            if margin == "5%":
                assert said[1:] == (sorted(findings), sorted(cautions)), (kind, margin, said)
            check_figures(ours, expected)
        print(f"{kind}: {', '.join(f'{case[1]} at {case[0]}' for case in cases)}")


main(sys.argv[1], pathlib.Path(sys.argv[2]))
