"""Pictures: one message each, arms told apart, nothing cut off, extremes kept, the same bytes each time."""

from __future__ import annotations

import functools
import importlib.util
import itertools
import shutil
import subprocess
import sys
import warnings

import numpy as np
import pytest
import studies
from conftest import refused

import credence
from credence.pictures import style, trials, verdicts
from credence.pictures.__main__ import main
from credence.pictures.drawing import OF_SCENARIO, OF_TRIAL

MAKERS = {1: studies.single_arm, 2: studies.one_scenario, 12: studies.twelve_arms,
          **{count: functools.partial(studies.arms, count) for count in (3, 5, 7)}}


def drawn(*given, **options):
    """A picture, drawn without a warning and looked through."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        picture = credence.plot(*given, **options)
        picture.canvas.draw()
    look_through(picture)
    return picture


def look_through(picture):
    """It has one bold message, every panel has marks and names its axes, no text is cut off or below 7 points."""
    assert picture.get_suptitle() if hasattr(picture, "get_suptitle") else picture._suptitle.get_text()
    hidden = hidden_labels(picture)
    for text in picture.findobj(style.matplotlib.text.Text):
        if text.get_visible() and text.get_text().strip() and text not in hidden:
            extent, box = text.get_window_extent(), picture.bbox
            inside = extent.x0 >= -1 and extent.y0 >= -1 and extent.x1 <= box.x1 + 1 and extent.y1 <= box.y1 + 1
            assert text.get_fontsize() >= 7, text
            assert inside, (text, extent, box)
    for axis in picture.axes:
        if axis.axison:
            assert axis.lines or axis.collections or axis.patches or axis.images, axis
            assert all(len(line.get_xdata()) <= style.MOST_POINTS + 1 for line in axis.lines)
            linked = axis.get_shared_x_axes().get_siblings(axis) + axis.get_shared_y_axes().get_siblings(axis)
            assert axis.get_xlabel() or axis.get_ylabel() or len(linked) > 2, axis


def hidden_labels(picture):
    """Ticks beyond the limits keep their labels, and are not drawn; nor are those of axes that are switched off."""
    hidden = set()
    for axes in picture.axes:
        for axis in (axes.xaxis, axes.yaxis):
            low, high = sorted(axis.get_view_interval())
            for tick in axis.majorTicks + axis.minorTicks:
                if not low <= tick.get_loc() <= high or not axes.axison:
                    hidden |= {tick.label1, tick.label2}
    return hidden


def legend(picture):
    found = [axis.get_legend() for axis in picture.axes if axis.get_legend()]
    return [text.get_text() for one in found for text in one.get_texts()]


def test_no_two_of_twelve_arms_look_the_same():
    lines = [style.arm_style(index) for index in range(12)]
    assert len({(line["color"], str(line["linestyle"])) for line in lines}) == 12
    marks = [style.arm_mark(index) for index in range(12)]
    assert len({tuple(mark.values()) for mark in marks}) == 12
    for index in range(6):  # those of one colour differ in both, so that a print without colours tells them apart
        assert lines[index]["linestyle"] != lines[index + 6]["linestyle"]
        assert marks[index]["marker"] != marks[index + 6]["marker"]


def test_thinned_curves_keep_their_extremes():
    rng = np.random.default_rng(1)
    curve, other = rng.normal(size=(2, 100_000))
    curve[12_345], curve[77_777], other[500] = 40, -50, 60
    curve[30_000:30_100] = np.nan
    kept = style.thinned(curve, other)
    assert kept.size <= style.MOST_POINTS
    assert (np.diff(kept) > 0).all()
    assert {0, 12_345, 77_777, 500, 99_999} <= set(kept.tolist())
    for stretch in np.array_split(np.arange(100_000), 100):  # a coarse look at both curves shows the same envelope
        there = kept[(kept >= stretch[0]) & (kept <= stretch[-1])]
        assert np.nanmax(curve[there]) >= np.nanquantile(curve[stretch], 0.99)
        assert np.nanmin(other[there]) <= np.nanquantile(other[stretch], 0.01)
    assert style.thinned(np.full(5000, np.nan)).tolist() == [0, 4999]
    assert style.thinned(np.arange(7)).tolist() == list(range(7))


SIZES = [(1, style.PAGE), (2, style.COLUMN), (3, style.PAGE), (5, style.COLUMN), (7, style.PAGE)]
CASES = [(kind, *size) for kind in OF_SCENARIO for size in SIZES]


@pytest.mark.parametrize(("kind", "count", "width"), CASES)
def test_every_kind_is_drawn_with_any_number_of_arms(kind, count, width):
    options = {"credence": studies.CREDENCE} if kind in ("verdicts", "map", "place") else {}
    if count == 1 and kind == "paired":
        refused("no arm has that of a simpler controller", credence.plot, MAKERS[count](), kind, raises=ValueError)
        return
    picture = drawn(MAKERS[count](), kind, width=width, **options)
    assert picture.get_figwidth() * 25.4 == pytest.approx(width)
    names = [entry.split(":")[0] for entry in legend(picture)]
    with credence.open(MAKERS[count]()) as study:
        arms = [arm.name for arm in study.arms]
    if kind == "paired":
        arms = [f"{planned} \N{MINUS SIGN} {fixed}" for planned, fixed in trials.pairs(arms)]
    if kind not in ("map", "place"):
        assert [name for name in names if name in arms] == arms


@pytest.mark.parametrize("make", [*MAKERS.values(), studies.waypoints])
def test_pairs_are_those_of_compare(make):
    with credence.open(make()) as study:
        found = trials.pairs([arm.name for arm in study.arms])
    expected = [] if make is studies.single_arm else studies.printed("compare", make())
    assert found == [(part["a"], part["b"]) for part in expected]


def test_two_arms_that_are_named_are_subtracted():
    for names in (("fixed.ekf", "greedy.ekf"), ("nearest", "random")):  # a controller with one arm stands for it
        picture = drawn(studies.arms(7), "paired", arms=names)
        a, b = (name if "." in name else f"{name}.ekf" for name in names)
        with credence.open(studies.arms(7)) as study:
            less = 100 * np.mean(study[a].trace_P < study[b].trace_P)
        assert [entry.split(":")[0] for entry in legend(picture)] == [f"{a} \N{MINUS SIGN} {b}"]
        assert f"{a} than {b} in {less:.0f} %" in picture._suptitle.get_text().replace("\n", " ")
    picture = drawn(studies.swept(), column="trace_P", difference=True, arms=("fixed", "greedy"))
    assert legend(picture) == ["fixed.ekf \N{MINUS SIGN} greedy.ekf"]
    with pytest.raises(ValueError, match=r"invalid arm fixed \(in ekf-circle-ranged it is fixed.ekf or fixed.ideal"):
        credence.plot(studies.twelve_arms(), "paired", arms=("fixed", "greedy"))
    with pytest.raises(ValueError, match=r"invalid arm nix \(ekf-circle-ranged has no such arm\)\. It has way"):
        credence.plot(studies.waypoints(), "nees", arms=["nix"])


@pytest.mark.parametrize("kind", ["distribution", "paired"])
@pytest.mark.parametrize("column", ["trace_P", "unseen", "pose_error"])
def test_the_labels_of_every_column_fit_into_a_column_of_a_page(kind, column):
    drawn(studies.one_scenario(), kind, column=column, width=style.COLUMN)


def test_no_place_is_cut_at_the_edge_of_a_path():
    for arm in ("fixed.ekf", "greedy.ekf"):  # the planner's robot stays near the edge of what there is
        for width in (style.COLUMN, style.PAGE):
            (trial,) = credence.open_trajectories(studies.trajectory(arm, 0, "landmarks"))
            picture = drawn(trial, "path", width=width)
            (axis,) = picture.axes
            robot, features = trial.positions("truth")
            shown = axis.transData.transform(np.concatenate([robot, features.reshape(-1, 2)]))
            mark = 2.5 * picture.dpi / 72  # half of the longest mark, the cross of an estimate: five points
            assert (shown - mark >= axis.bbox.min).all()
            assert (shown + mark <= axis.bbox.max).all()


def test_no_mark_of_a_path_hides_another():
    picture = drawn(studies.trajectory(), "path")
    lines = {line.get_label(): line for line in picture.axes[0].lines}
    true, estimated = lines["true path"], lines["estimated path"]
    assert true.get_zorder() < estimated.get_zorder()
    assert true.get_linewidth() > 2 * estimated.get_linewidth()
    assert estimated.get_marker() == "+"  # its true place is seen between the bars
    features = [lines[f"feature {feature}"] for feature in range(3)]
    assert len({line.get_marker() for line in features}) == 3  # also in a print without colours
    assert all(line.get_markerfacecolor() == "none" for line in features)
    picture = drawn(studies.two_scenarios(), "place", credence=studies.CREDENCE)
    marks = [line for line in picture.axes[-1].lines if len(line.get_xdata()) == 1]
    assert len(marks) == 4
    assert all(line.get_markerfacecolor() == "none" for line in marks)


def test_the_caption_of_a_ratio_says_how_far_it_is_from_1_and_what_chance_does():
    with credence.open(studies.one_scenario()) as study:
        picture = drawn(study, "nees")
        title = picture._suptitle.get_text().replace("\n", " ")
        assert title.startswith("NEES / dimension over all steps (by step): ")
        for arm in study.arms:
            ratio = arm.nees / arm.dimension("nees")
            expected = f"{arm.name} {ratio.mean():.2f} ({ratio.min():.2f} to {ratio.max():.2f})"
            assert expected in title
    assert "outside the grey band at 1 step of 20" in picture._supxlabel.get_text().replace("\n", " ")
    for kind in ("nees", "errors"):
        title = drawn(studies.trajectory(), kind)._suptitle.get_text().replace("\n", " ")
        assert title.endswith("poses (a consistent filter: at about 1)")


def test_a_map_of_a_consistent_filter_is_pale_and_labelled(monkeypatch):
    def report(scenario, arms, credence):
        steps = arms["fixed.ekf"][1]["step"].size
        ratios = 1 + 0.06 * np.sin(np.arange(steps))
        return {"fixed.ekf": {"verdict": "consistent", "groups": [
            {"group": name, "anees": {"ratio": ratios.tolist()}} for name in ("all", "pose")]}}

    monkeypatch.setattr(verdicts, "_report", report)
    for width in (style.PAGE, style.COLUMN):
        picture = drawn(studies.one_scenario(), "map", arm="fixed.ekf", width=width)
        cells, _ = [one for one in picture.axes[0].collections if one.get_array() is not None]
        red, green, blue, _ = cells.cmap(cells.norm(np.log2([0.94, 1.06]))).T
        assert min(red.min(), green.min(), blue.min()) > 0.65  # near white: of the darkest cells, 0.02 to 0.4
        labels = [float(label.get_text()) for label in picture.axes[1].get_yticklabels()]
        assert len(labels) >= 3
        assert 1 in labels
        assert min(labels) < 1 < max(labels)


def test_the_levels_of_a_colour_bar_do_not_touch():
    for reach in (np.log2(1.25), 0.6, 1, 2):
        for height in (18, 45, 90):
            ticks = np.log2(verdicts._ticks(reach, height))
            assert len(ticks) >= 3
            assert np.diff(ticks).min() * height / (2 * reach) > 3  # millimetres; the text is 2.6 high


def test_the_title_can_be_left_out(tmp_path):
    picture = credence.plot(studies.one_scenario(), "nees", title=False)
    assert picture.texts == []
    assert main(given(studies.one_scenario(), "-o", tmp_path, "--kind", "nees", "--no-title")) == 0
    assert (tmp_path / "ekf-circle-ranged-nees.png").read_bytes() == saved(picture, tmp_path)


def saved(picture, folder):
    picture.save(folder / "one.png")
    return (folder / "one.png").read_bytes()


def test_no_mark_of_the_planning_page_hides_another(tmp_path):
    found = importlib.util.spec_from_file_location("picture", studies.ROOT / "experiments/planning/picture.py")
    module = importlib.util.module_from_spec(found)
    found.loader.exec_module(module)
    for world in module.WORLDS:  # all controllers have the same means
        for name in ("baselines", *module.CRITERIA):
            arms = [f"{one}.ekf" for one in module.BASELINES] if name == "baselines" else ["greedy.ekf"]
            rows = [f"s,{arm},,,{column},,1,,0.9,1.1" for arm in arms for column in ("trace_P", "pose_error")]
            (tmp_path / f"criteria-{world}-{name}.csv").write_text("\n".join(rows))
    picture = module.draw(tmp_path)
    picture.canvas.draw()
    for axis in picture.axes[1:]:  # the first has the key
        places = np.concatenate([line.get_xydata() for line in axis.lines if line.get_marker() in ("o", "s")])
        shown = axis.transData.transform(places)
        apart = np.linalg.norm(shown[:, None] - shown[None], axis=2) + np.eye(len(shown)) * 1e6
        assert len(shown) == 20
        assert apart.min() > 4.5 * picture.dpi / 72  # a mark's size


def test_an_arm_looks_the_same_when_it_is_drawn_alone():
    def colours(**options):
        picture = credence.plot(studies.twelve_arms(), "distribution", **options)
        return [line.get_color() + str(line.get_linestyle()) for line in picture.axes[0].lines]

    with credence.open(studies.twelve_arms()) as study:
        last = study.arms[-1].name
    assert colours(arms=[last]) == colours()[-1:]


def test_a_long_study_is_thinned():
    for kind in ("nees", "nis", "coverage", "accuracy"):
        drawn(studies.many_steps(), kind)
    picture = drawn(studies.many_steps(), "nees")
    with credence.open(studies.many_steps()) as study:
        ratio = study.arms[0].nees / study.arms[0].dimension("nees")
    (line,) = [one for one in picture.axes[0].lines if len(one.get_xdata()) > 100]
    assert len(line.get_xdata()) < ratio.size
    assert (line.get_ydata().max(), line.get_ydata().min()) == pytest.approx((ratio.max(), ratio.min()))


def test_the_message_has_the_numbers_of_the_study():
    with credence.open(studies.one_scenario()) as study:
        medians = {arm.name: np.median(arm.trace_P) for arm in study.arms}
        title = drawn(study, "distribution")._suptitle.get_text().replace("\n", " ")
        assert all(f"{name} {value:.4g}" in title for name, value in medians.items()), title
        difference = study["greedy.ekf"].trace_P - study["fixed.ekf"].trace_P
        title = drawn(study, "paired")._suptitle.get_text()
        assert f"greedy.ekf than fixed.ekf in {100 * np.mean(difference < 0):.0f} %" in title, title


def test_the_percentile_of_a_published_run_is_that_of_the_report():
    parts = {part["arm"]: part for part in studies.printed("report", studies.two_scenarios())
             if part["scenario"] == "kf-circle-constant"}
    with credence.open(studies.two_scenarios()) as study:
        scenario = study["kf-circle-constant"]
        for arm, value in scenario.published("trace_P").items():
            expected = parts[arm]["trace_P"]["published"]
            assert [value, trials.percentile(scenario[arm].trace_P, value)] == pytest.approx(list(expected.values()))


def test_a_map_has_the_colours_of_its_values():
    picture = drawn(studies.one_scenario(), "map", arm="fixed.ekf", credence=studies.CREDENCE)
    cells, hatched = [one for one in picture.axes[0].collections if one.get_array() is not None]
    parts = {part["arm"]: part for part in studies.printed("report", studies.one_scenario())}
    ratios = np.array([group["anees"]["ratio"] for group in parts["fixed.ekf"]["groups"]])
    np.testing.assert_allclose(np.asarray(cells.get_array()).reshape(ratios.shape), np.log2(ratios))
    assert hatched.get_hatch()
    assert np.ma.count(hatched.get_array()) == np.sum(ratios > 1.05)
    assert picture.axes[1].get_yticklabels()[0].get_text()


def test_a_swept_arm_looks_the_same_when_it_is_drawn_alone():
    pictures = [drawn(studies.swept(), arms=arms) for arms in (None, ["greedy"])]
    colours = [[line.get_color() for line in picture.axes[0].lines] for picture in pictures]
    assert colours[0][1] == colours[1][0] != colours[0][0]


@pytest.mark.parametrize("width", [style.PAGE, style.COLUMN])
@pytest.mark.parametrize("options", [{}, {"column": "trace_P"}, {"column": "trace_P", "difference": True}])
def test_a_grid_is_drawn(options, width):
    picture = drawn(studies.swept(), width=width, **options)
    assert len(picture.axes) == (2 if width == style.PAGE else 1)
    assert picture.axes[0].get_xlabel() == "noise.heading"


def test_a_trial_is_drawn():
    for kind in OF_TRIAL:
        drawn(studies.trajectory(), kind)
    drawn(studies.trajectory(), "path", ellipse="1-sigma", width=style.COLUMN)


def test_a_trial_moves(tmp_path, monkeypatch, capsys):
    from PIL import Image

    study, trajectory = studies.two_scenarios(), studies.trajectory()
    monkeypatch.chdir(tmp_path)
    path = credence.animate(study, trial=17, arm="greedy.ekf", scenario="ekf-circle-ranged", credence=studies.CREDENCE)
    assert path.name == "ekf-circle-ranged-greedy.ekf-17.gif"
    with Image.open(path) as gif:
        frames, shown = [], []
        for frame in range(gif.n_frames):
            gif.seek(frame)
            frames.append(np.asarray(gif.convert("L"), int))
            shown.append(gif.info["duration"])
    assert len(frames) == 20
    assert set(shown[:-1]) == {120}  # ms: eight poses a second, in a GIF's unit of a hundredth
    assert shown[-1] >= 1000
    for before, after in itertools.pairwise(frames):
        assert np.abs(before - after).sum() > 0
    assert capsys.readouterr().err == ""  # not a terminal
    again = credence.animate(trajectory, progress=True)
    assert again.name == "ekf-circle-ranged-greedy.ekf.gif"
    assert again.read_bytes() == path.read_bytes()
    said = capsys.readouterr().err
    assert "greedy.ekf.gif: 0 of 28 frames" in said
    assert "greedy.ekf.gif: 27 of 28 frames" in said
    refused("must end in", credence.animate, trajectory, path=tmp_path / "trial.png", raises=ValueError)


@pytest.mark.parametrize(("words", "place"), [(["--kind", "animation"], "credence.pictures.animation.PillowWriter"),
                                              (["--kind", "path"], "credence.pictures.style.Picture")])
def test_what_is_interrupted_leaves_nothing_behind(words, place, tmp_path, monkeypatch, capsys):
    def interrupted(*given, **options):
        raise KeyboardInterrupt

    monkeypatch.setattr(f"{place}.{'grab_frame' if 'Pillow' in place else 'savefig'}", interrupted)
    assert main([str(studies.trajectory()), "-o", str(tmp_path), *words]) == 130
    assert capsys.readouterr().err == "credence.pictures: interrupted (0 files are written). Run it again.\n"
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(KeyboardInterrupt):
        credence.animate(studies.trajectory(), path=tmp_path / "trial.gif")
    assert list(tmp_path.iterdir()) == []


def test_a_film_needs_ffmpeg(tmp_path, monkeypatch):
    if shutil.which("ffmpeg"):
        film = credence.animate(studies.trajectory(), path=tmp_path / "trial.mp4")
        assert film.read_bytes()[4:8] == b"ftyp"
    monkeypatch.setattr(shutil, "which", lambda name: None)
    refused("there is no ffmpeg", credence.animate, studies.trajectory(), path=tmp_path / "none.mp4", raises=ValueError)


def given(*words):
    return [*map(str, words), *(["--credence", studies.CREDENCE] if studies.CREDENCE else [])]


def test_the_command_draws_all_that_a_file_has(tmp_path, capsys):
    assert main(given(studies.two_scenarios(), "-o", tmp_path, "--scenario", "kf-circle-constant")) == 0
    kinds = ["verdicts", "map-fixed.kf", "map-greedy.kf", "nees", "nis", "coverage", "chi_square", "trace_P",
             "accuracy", *(f"{kind}-{column}" for kind in ("distribution", "paired")
                           for column in ("trace_P", "unseen", "pose_error"))]
    expected = {f"kf-circle-constant-{kind}.{ending}" for kind in kinds for ending in ("pdf", "png")}
    assert {path.name for path in tmp_path.iterdir()} == expected
    assert len(capsys.readouterr().out.splitlines()) == len(expected)
    pdf = (tmp_path / "kf-circle-constant-nees.pdf").read_bytes()
    assert pdf.startswith(b"%PDF")
    assert b"CreationDate" not in pdf
    assert main(given(studies.two_scenarios(), "-o", tmp_path / "again", "--kind", "nees", "--vector", "svg")) == 0
    assert len(list((tmp_path / "again").iterdir())) == 4
    png = "kf-circle-constant-nees.png"
    assert (tmp_path / "again" / png).read_bytes() == (tmp_path / png).read_bytes()
    assert b"<dc:date>" not in (tmp_path / "again" / "kf-circle-constant-nees.svg").read_bytes()


THREE = [f"ekf-circle-ranged-paired-{column}" for column in ("trace_P", "unseen", "pose_error")]
FILMED = ["--kind", "animation", "--scenario", "ekf-circle-ranged", "--arms", "greedy", "--trial", "17"]
SVG = ["--vector", "svg"]  # takes half as long as PDF, whose fonts are cut to size


@pytest.mark.parametrize(("make", "words", "stems"), [
    (studies.swept, [], [f"base-heading-noise-sweep-{what}" for what in ("nees_ratio", "trace_P", "difference")]),
    (studies.trajectory, [], [f"ekf-circle-ranged-greedy.ekf-seed-1-trial-17-{kind}" for kind in OF_TRIAL]),
    (studies.waypoints, ["--kind", "paired"], THREE),
    (MAKERS[7], ["--kind", "paired", "--arms", "random,follow"], THREE),
    (studies.two_scenarios, FILMED, ["ekf-circle-ranged-animation-greedy.ekf"])])
def test_the_command_draws_grids_trials_pairs_and_films(make, words, stems, tmp_path):
    assert main(given(make(), "-o", tmp_path / "new", *SVG, *words)) == 0
    assert {path.stem for path in (tmp_path / "new").iterdir()} == {*stems}


def test_the_command_says_what_aggregates_do_not_hold(tmp_path, capsys):
    assert main(given(studies.aggregates(), "-o", tmp_path, *SVG)) == 0
    assert "keeps aggregates. They need the trials" in capsys.readouterr().err
    assert not list(tmp_path.glob("*distribution*"))
    assert list(tmp_path.glob("*verdicts*"))


def test_the_command_replaces_pictures_only_if_it_is_told_to(tmp_path, capsys):
    words = given(studies.single_arm(), "-o", tmp_path, "--kind", "nees")
    assert main(words) == 0
    made = sorted(tmp_path.iterdir())
    made[0].write_bytes(b"somebody's own")
    capsys.readouterr()
    assert main(words) == 2
    assert "(it is there already). Give --overwrite, or another folder." in capsys.readouterr().err
    assert made[0].read_bytes() == b"somebody's own"
    assert main([*words, "--overwrite"]) == 0
    assert made[0].read_bytes() != b"somebody's own"


@pytest.mark.parametrize(("make", "words", "said"), [
    (studies.single_arm, ["--kind", "paired"], "no picture of paired (no arm has that of a simpler controller and the "
                                               "same estimator beside it). Choose two by --arms A,B."),
    (studies.single_arm, ["--kind", "sweep"], "no picture of sweep (it is of a grid). Give a study of credence run "),
    (studies.single_arm, ["--kind", "path"], "no picture of path (it is of a trial). Give what credence replay "),
    (studies.swept, ["--kind", "nees"], "no picture of nees (it is of single scenarios). Name points of "),
    (studies.trajectory, ["--kind", "verdicts"], "no picture of verdicts (it is of a study). Give what credence "),
    (studies.aggregates, ["--kind", "paired"], "keeps aggregates. They need the trials (credence run --keep trials)."),
    (studies.single_arm, ["--arms", "nix"], "invalid arm nix (ekf-circle-ranged has no such arm). It has fixed.ekf.")])
def test_a_command_that_draws_nothing_says_why(make, words, said, tmp_path, capsys):
    assert main(given(make(), "-o", tmp_path / "none", *words)) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("credence.pictures: no picture")
    assert said in err
    assert err.count("\n") == 1
    assert not (tmp_path / "none").exists()


def test_the_command_refuses_bad_input(tmp_path, capsys):
    text = tmp_path / "text.h5"
    text.write_text("no HDF5 at all")
    for words, said in (([text], "cannot be read as HDF5"), ([tmp_path / "none.h5"], "cannot be found"),
                        ([studies.one_scenario(), "--scenario", "nix"],
                         "invalid --scenario nix (not in the file). It has ekf-circle-ranged.")):
        assert main(given(*words, "-o", tmp_path / "none")) == 2
        assert said in capsys.readouterr().err
    assert not (tmp_path / "none").exists()
    with pytest.raises(ValueError, match=r"invalid kind=nix \(must be one of verdicts, nees"):
        credence.plot(studies.one_scenario(), "nix")
    with pytest.raises(ValueError, match=r"invalid group=nix \(fixed.ekf has no such nees\). It has all, pose"):
        credence.plot(studies.one_scenario(), "nees", group="nix")


def test_a_missing_library_is_named():
    folder = studies.ROOT / "python"
    start = (f"import runpy, sys; sys.path[0] = {str(folder)!r}; sys.modules['scipy'] = None; sys.argv[1:] = ['x.h5']; "
             "runpy.run_module('credence.pictures.__main__')")
    done = subprocess.run([sys.executable, "-c", start],
                          capture_output=True, text=True, check=False)
    assert done.returncode == 2, done.stderr
    assert "Install python3-h5py" in done.stderr
    assert "Traceback" not in done.stderr
