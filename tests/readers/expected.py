"""Writes what every reader must find in a results file and a trajectory file, from the JSON of the program itself.

    expected.py REPORT.json REPLAY.json EXPECTED.tsv

A line is FILE (study or trace), PATH, QUANTITY, VALUE, parted by tabs. The readers beside this know the same
quantities:
  mean, median       of the variable's values that are not missing
  missing            number of values that are (the fill value)
  zeros              number of values that are 0
  failed             number of codes of at least 2
  last               the last value
  ratio_at_K         the total (part 0) at step K, over the trials that did not fail and the components of the state
  share_at_K         the count at step K and the third level, over the trials that did not fail
  per_row            the sum of the values over the sum of `rows` of the same group
  squared_error      of the robot: the sum of (mean - truth)^2 over poses and its components
  attribute:NAME     the attribute of the variable or group, number or text
  dimensions         names of the dimensions, the slowest first
"""
import json
import sys

STATUS = "completed diverged covariance_not_positive_definite non_finite"


def of_study(arm):
    path = f"/{arm['scenario']}/{arm['arm']}"
    for name in ("trace_P", "unseen", "pose_error", "nees_ratio", "nis_ratio", "mean_trace_P", "log_score",
                 "path_length"):
        yield f"{path}/{name}", "mean", arm[name]["mean"]
        yield f"{path}/{name}", "median", arm[name]["median"]
        yield f"{path}/{name}", "missing", arm["failed"]
        yield f"{path}/{name}", "attribute:units", arm[name]["unit"]
    yield f"{path}/status", "failed", arm["failed"]
    yield f"{path}/status", "attribute:flag_meanings", STATUS
    yield f"{path}/status_pose", "missing", arm["trials"] - arm["failed"]
    whole = arm["groups"][0]
    for step in (1, 10, 19):
        yield f"{path}/nees_total", f"ratio_at_{step}", whole["anees"]["ratio"][step - 1]
    yield f"{path}/nees_covered", "share_at_7", whole["coverage"][2]["share"][6]
    yield f"{path}/nees_total", "attribute:dimension", whole["dimension"]
    yield f"{path}/nees_total", "attribute:part_of", "all"
    yield f"{path}/nees_total", "dimensions", "step part"
    yield f"{path}/nees_covered", "dimensions", "step level"
    yield f"{path}/trace_P", "dimensions", "trial"
    yield path, "attribute:counted_trials", arm["trials"] - arm["failed"]


def of_trace(arm, names, units):
    path = f"/{arm['scenario']}/{arm['arm']}"
    for name in ("trace_P", "pose_error", "nees_ratio", "nis_ratio", "unseen", "status_pose"):
        yield path, f"attribute:{name}", arm[name]
    yield path, "attribute:status_text", arm["status"]
    yield f"{path}/trace_P", "last", arm["trace_P"]
    yield f"{path}/seen", "zeros", arm["unseen"]
    yield f"{path}/nees", "mean", arm["nees_ratio"] * len(names.split())
    yield f"{path}/nees", "missing", 1
    yield f"{path}/nis", "per_row", arm["nis_ratio"]
    yield f"{path}/mean", "squared_error", arm["pose_error"]
    yield f"{path}/component", "attribute:component_names", names
    yield f"{path}/component", "attribute:component_units", units
    yield f"{path}/seen", "attribute:flag_meanings", "not_looked_for unseen seen"
    yield f"{path}/truth", "dimensions", "pose component"
    yield f"{path}/covariance", "dimensions", "pose component component_2"


def main(report, replay, output):
    with open(report) as study, open(replay) as trace, open(output, "w") as lines:
        for arm in json.load(study):
            for fact in of_study(arm):
                print("study", *fact, sep="\t", file=lines)
        features = "f0_x f0_y f1_x f1_y f2_x f2_y"
        for arm in json.load(trace):
            for fact in of_trace(arm, f"theta r_x r_y {features}", "rad" + " dm" * 8):
                print("trace", *fact, sep="\t", file=lines)


main(*sys.argv[1:])
