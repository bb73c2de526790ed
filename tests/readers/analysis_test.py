"""What the functions of analysis/ for Octave and R read, against the Python package; and the package's pictures of a
user's own world.

    analysis_test.py STUDY.h5 OWN.h5 FOLDER    with octave.tsv, octave.svg and r.tsv in FOLDER, as far as they were made
"""
import pathlib
import sys

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "python" / "tests")]

import credence  # noqa: E402
import studies  # noqa: E402
from credence.pictures.__main__ import main as draw  # noqa: E402
from test_pictures import drawn  # noqa: E402


def check_own_world(file, folder):
    """A world of one's own has other columns and groups: what it has is drawn."""
    assert draw([file, "-o", folder, "--credence", studies.CREDENCE]) == 0
    found = {path.stem.removeprefix("tracker-") for path in pathlib.Path(folder).glob("tracker-*.png")}
    with credence.open(file) as study:
        (scenario,) = study.scenarios.values()
        first = next(iter(scenario.arms.values()))
        columns = [column for column in ("trace_P", "squared_error") if column in first.columns]
        assert {*(f"distribution-{column}" for column in columns), "nees", "coverage", "accuracy"} <= found, found
        for kind in ("nees", "accuracy", "coverage"):
            for group in first.series_of("nees"):
                drawn(scenario, kind, group=group)


def check_lines(study_file, said):
    """Of each arm: unit and mean of trace_P, trials without a status pose, a step, the mean NEES there with its ends."""
    lines = [line.split("\t") for line in said.read_text().splitlines()]
    with credence.open(study_file) as study:
        assert [line[0] for line in lines] == [f"{arm.group.name}/" for arm in study.arms]
        for line, arm in zip(lines, study.arms):
            nees = arm.per_step("nees")
            low, high = nees.interval()
            assert line[1] == arm.describe("trace_P").units
            np.testing.assert_allclose([float(word) for word in line[2:]], [
                arm.trace_P.mean(), arm.trace_P.size, 10, nees.mean[9], low[9], high[9]], rtol=1e-9)


def check_picture(picture):
    shown = picture.read_text()
    for label in ("NEES / state dimension", "fixed.kf", "greedy.kf", "trials at or below"):
        assert label in shown, label
    assert shown.count("<path") > 10


def main(study_file, own, folder):
    check_own_world(own, folder)
    made = [pathlib.Path(folder, name) for name in ("octave.tsv", "octave.svg", "r.tsv")]
    there = [path for path in made if path.exists() and path.stat().st_size]
    for path in there:
        check_lines(study_file, path) if path.suffix == ".tsv" else check_picture(path)
    print(f"analysis: {', '.join(path.name for path in there) or 'nothing'} as in the Python package")


if __name__ == "__main__":
    main(*sys.argv[1:])
