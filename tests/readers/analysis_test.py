"""The modules of analysis/ against the program's own JSON, and every picture looked through before it is saved.

    analysis_test.py CREDENCE STUDY.h5 REPORT.json TRACE.h5 FOLDER [OCTAVE.tsv PICTURE.svg]

FOLDER, where the pictures go, has kf-circle-constant-ARM.h5 of a trial for the figure of the README, and the studies
own.h5, of the tracker, arms.h5, of ten arms, and steps.h5, of 600 steps.
"""
import json
import math
import pathlib
import subprocess
import sys

import numpy as np

ANALYSIS = pathlib.Path(__file__).resolve().parents[2] / "analysis"
sys.path.insert(0, str(ANALYSIS))

import credence_results as results  # noqa: E402
import figures  # noqa: E402
import plot  # noqa: E402
from pictures import study, style  # noqa: E402


def near(found, expected):
    """Sums in another order, and quantiles by another method."""
    np.testing.assert_allclose(np.asarray(found, dtype=float), np.asarray(expected, dtype=float), rtol=1e-9, atol=1e-13)


def check_arm(scenario, group, part):
    for name in ("trace_P", "unseen", "pose_error", "nees_ratio", "nis_ratio", "mean_trace_P"):
        values = results.column(group, name)
        near([np.nanmean(values), np.nanmedian(values)], [part[name]["mean"], part[name]["median"]])
        assert results.units(group, name) == part[name]["unit"]
        if "published" in part[name]:
            place = results.published(scenario, name)[part["arm"]]
            near([place, study.percentile(values, place)], list(part[name]["published"].values()))
    assert np.isnan(results.column(group, "status_pose")).all()
    assert results.flags(group["status"])[2] == "covariance_not_positive_definite"
    blocks = dict(zip(results.figures(group, "nees"), part["blocks"]))
    assert len(blocks) == len(part["blocks"])
    for figure, block in blocks.items():
        step, run = results.per_step(group, figure), results.over_steps(group, figure)
        assert step.dimension == block["dimension"]
        near(step.mean / step.dimension, block["anees"]["ratio"])
        near(step.standard_error / step.dimension, block["anees_se"])
        near([value / step.dimension for value in run[:4]], [block["nees_ratio"], block["se"], *block["ci95"]])
        near(results.chi_square_band(results.degrees(group, figure)), np.transpose(block["anees"]["band95"]))
    for figure, nis in zip(results.figures(group, "nis"), part["nis"]):
        near(results.degrees(group, figure).sum(), nis["degrees"])
        near(results.total(group, f"{figure}_total").sum() / results.degrees(group, figure).sum(), nis["ratio"])


def check_module(study_file, report):
    with results.open_file(study_file) as file:
        in_order = [name for name, _ in results.scenarios(file)]
        assert in_order == ["kf-circle-constant", "ekf-circle-ranged"], in_order
        for scenario, arm, group in results.arms(file):
            check_arm(file[scenario], group, report[scenario, arm])


# Picture: panels, and the curves, patches and collections that each must have at least.
PANELS = {"consistency": (2, 2), "distributions": (2, 2), "paired": (3, 1), "coverage": (6, 1), "blocks": (4, 1),
          "path": (1, 6), "judged": (6, 1), "figure": (5, 0)}
seen = {}


def look_through(figure, stem, width=style.PAGE):
    """Every panel has marks and labels, and no text is cut off or smaller than print allows."""
    figure.canvas.draw()
    name, box = stem.rsplit("-", 1)[1], figure.bbox
    panels, least = PANELS[name]
    assert len(figure.axes) == panels, (stem, len(figure.axes))
    assert figure.get_figwidth() * 25.4 <= width + 0.01, stem
    for axis in figure.axes:
        marks = len(axis.lines) + len(axis.collections) + len(axis.patches)
        assert marks >= least, (stem, marks)
        assert axis.get_xlabel() or not axis.axison or axis.get_shared_x_axes().get_siblings(axis) != [axis], stem
    beyond = hidden_labels(figure)
    for text in figure.findobj(style.plt.Text):
        if text.get_visible() and text.get_text().strip() and text not in beyond:
            extent = text.get_window_extent()
            inside = extent.x0 >= -1 and extent.y0 >= -1 and extent.x1 <= box.x1 + 1 and extent.y1 <= box.y1 + 1
            assert text.get_fontsize() >= 7, (stem, text.get_text(), text.get_fontsize())
            assert inside, (stem, text.get_text(), extent, box)


def look_through_and_save(figure, folder, stem, vector="pdf"):
    """Instead of style.save."""
    look_through(figure, stem)
    seen[stem] = saved(figure, folder, stem, vector)
    return seen[stem]


def every_picture(credence, file, folder):
    """{stem: figure} of a study, without files; each of them is looked through."""
    drawn = {}

    def look_at(figure, _, stem, vector):
        look_through(figure, stem)
        drawn[stem.rsplit("-", 1)[1]] = figure
        return []

    style.save, before = look_at, style.save
    assert plot.main([str(file), "-o", str(folder), "--credence", credence]) == 0
    style.save = before
    return drawn


def check_own_world(credence, folder):
    """A world of one's own has other columns: what it has is drawn."""
    PANELS["blocks"] = (4, 1)
    assert set(every_picture(credence, folder / "own.h5", folder)) == {"consistency", "distributions", "coverage", "blocks"}


def check_ten_arms(credence, folder):
    """Twelve arms differ in line, and in mark; every arm is in the legends of the pictures, once; no two share a line."""
    for drawn in (lambda i: str(style.arm_style(i)["color"]) + str(style.arm_style(i)["linestyle"]),
                  lambda i: str(style.arm_mark(i))):
        assert len({drawn(i) for i in range(12)}) == 12
    PANELS["blocks"] = (12, 1)
    pictures = every_picture(credence, folder / "arms.h5", folder)
    for name in ("consistency", "distributions", "coverage", "blocks", "paired"):
        (legend,) = pictures[name].legends
        entries = [text.get_text().split(":")[0] for text in legend.get_texts()]
        assert len(entries) == len(set(entries)) and len(entries) == {"paired": 5, "blocks": 11}.get(name, 10), entries
    levels = [axis for axis in pictures["coverage"].axes if axis.get_title(loc="left")]
    assert [axis.get_title(loc="left") for axis in levels] == [f"{level} % quantile" for level in (50, 90, 95, 99)]
    for axis in levels:
        assert len(axis.lines) == 11, "an arm's line, and the level"


def check_many_steps(credence, folder):
    """The map of NEES by step has the colours of its values: their mean is that of the picture."""
    PANELS["blocks"] = (7, 1)
    figure = every_picture(credence, folder / "steps.h5", folder)["blocks"]
    figure.canvas.draw()
    pixels = np.asarray(figure.canvas.buffer_rgba()) / 255
    for axis in figure.axes[1:6]:
        (cells,) = [one for one in axis.collections if one.get_array() is not None]
        expected = cells.to_rgba(cells.get_array()).reshape(-1, 4).mean(axis=0)
        box = axis.get_window_extent()
        shown = pixels[int(len(pixels) - box.y1) + 1:int(len(pixels) - box.y0) - 1, int(box.x0) + 1:int(box.x1) - 1]
        np.testing.assert_allclose(shown.reshape(-1, 4).mean(axis=0), expected, atol=0.05, err_msg=axis.get_title(loc="left"))


def hidden_labels(figure):
    """Ticks beyond the limits keep their labels, and are not drawn."""
    hidden = set()
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            low, high = sorted(axis.get_view_interval())
            for tick in axis.majorTicks + axis.minorTicks:
                if not low <= tick.get_loc() <= high:
                    hidden |= {tick.label1, tick.label2}
    return hidden


def check_pictures(credence, study_file, trace_file, folder):
    assert plot.main([study_file, "-o", folder, "--scenario", "kf-circle-constant", "--credence", credence]) == 0
    assert plot.main([trace_file, "-o", folder, "--vector", "svg"]) == 0
    with results.open_file(study_file) as file:
        traces = figures.open_traces(pathlib.Path(folder), "kf-circle-constant")
        look_through_and_save(figures.draw(3, file["kf-circle-constant"], traces), folder, "of-figure")
        for name, draw in plot.STUDY_PICTURES.items():
            look_through(draw(file["ekf-circle-ranged"], style.COLUMN), f"column-{name}", style.COLUMN)
    assert {stem.rsplit("-", 1)[1] for stem in seen} == set(PANELS)
    for paths in seen.values():
        vector, picture = (path.read_bytes() for path in paths)
        assert vector[:4] in (b"%PDF", b"<?xm") and len(vector) > 8000, paths
        assert b"CreationDate" not in vector and b"<dc:date>" not in vector, paths
        assert picture[:4] == b"\x89PNG" and len(picture) > 20000, paths


def check_refusals(credence, study_file, folder):
    text = pathlib.Path(folder) / "text.h5"
    text.write_text("no HDF5 at all")
    for arguments, said in (([str(text)], "is no HDF5 file"), ([f"{folder}/nothing.h5"], "there is no file"),
                            ([study_file, "--scenario", "nix"], "invalid --scenario nix (not in the file). It has kf-"),
                            ([study_file, "--vector", "png"], "invalid choice")):
        done = subprocess.run([sys.executable, ANALYSIS / "plot.py", *arguments, "-o", f"{folder}/none"],
                              capture_output=True, text=True)
        assert done.returncode == 2 and said in done.stderr and "Traceback" not in done.stderr, done.stderr
    done = subprocess.run([sys.executable, "-S", ANALYSIS / "plot.py", study_file], capture_output=True, text=True,
                          env={"PYTHONNOUSERSITE": "1", "PYTHONPATH": ""})
    assert done.returncode == 2 and "Install python3-h5py" in done.stderr, done.stderr
    assert not pathlib.Path(folder, "none").exists()


def check_octave(study_file, said, picture):
    lines = [line.split("\t") for line in pathlib.Path(said).read_text().splitlines()]
    with results.open_file(study_file) as file:
        assert [line[0] for line in lines] == [f"/{scenario}/{arm}/" for scenario, arm, _ in results.arms(file)]
        for line, (_, _, group) in zip(lines, results.arms(file)):
            trace, nees = results.column(group, "trace_P"), results.per_step(group, "nees")
            assert line[1] == results.units(group, "trace_P")
            near([float(word) for word in line[2:]],
                 [trace.mean(), trace.size, 10, nees.mean[9], nees.low[9], nees.high[9]])
    drawn = pathlib.Path(picture).read_text()
    for label in ("NEES / state dimension", "fixed.kf", "greedy.kf", "trials at or below"):
        assert label in drawn, label
    assert drawn.count("<path") > 10


saved = style.save
style.save = look_through_and_save


def main(credence, study_file, report_file, trace_file, folder, *octave):
    report = {(part["scenario"], part["arm"]): part for part in json.loads(pathlib.Path(report_file).read_text())}
    assert len(report) == 4 and not math.isnan(report["kf-circle-constant", "fixed.kf"]["trace_P"]["mean"])
    check_module(study_file, report)
    check_pictures(credence, study_file, trace_file, folder)
    check_refusals(credence, study_file, folder)
    check_own_world(credence, pathlib.Path(folder))
    check_ten_arms(credence, pathlib.Path(folder))
    check_many_steps(credence, pathlib.Path(folder))
    if octave:
        check_octave(study_file, *octave)
    print(f"analysis: {len(report)} arms as in the JSON, {len(seen)} pictures looked through"
          f"{', and what Octave says' if octave else ''}")


if __name__ == "__main__":
    main(*sys.argv[1:])
