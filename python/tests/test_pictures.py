"""Pictures: one message each, arms told apart, nothing cut off, extremes kept, the same bytes each time."""

from __future__ import annotations

import itertools
import shutil
import subprocess
import sys
import warnings

import numpy as np
import pytest
import studies

import credence
from credence.pictures import style, trials
from credence.pictures.__main__ import main
from credence.pictures.drawing import OF_SCENARIO, OF_TRIAL

MAKERS = {1: studies.single_arm, 2: studies.one_scenario, 12: studies.twelve_arms}


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


SIZES = [(1, style.PAGE), (2, style.PAGE), (2, style.COLUMN), (12, style.PAGE), (12, style.COLUMN)]
CASES = [(kind, *size) for kind in OF_SCENARIO for size in SIZES if kind != "place" or size in SIZES[:2]]


@pytest.mark.parametrize(("kind", "count", "width"), CASES)
def test_every_kind_is_drawn_with_one_two_and_twelve_arms(kind, count, width):
    options = {"credence": studies.CREDENCE} if kind in ("verdicts", "map", "place") else {}
    if count == 1 and kind == "paired":
        with pytest.raises(ValueError, match="there is no arm with a fixed one"):
            credence.plot(MAKERS[count](), kind)
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
        assert f"greedy.ekf in {100 * np.mean(difference < 0):.0f} %" in title, title


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
    (cells,) = [one for one in picture.axes[0].collections if one.get_array() is not None]
    parts = {part["arm"]: part for part in studies.printed("report", studies.one_scenario())}
    ratios = np.array([group["anees"]["ratio"] for group in parts["fixed.ekf"]["groups"]])
    np.testing.assert_allclose(np.asarray(cells.get_array()).reshape(ratios.shape), np.log2(ratios))
    assert picture.axes[1].get_yticklabels()[0].get_text()


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


def test_a_trial_moves(tmp_path, monkeypatch):
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
    assert credence.animate(trajectory).name == "ekf-circle-ranged-greedy.ekf.gif"
    again = credence.animate(trajectory, path=tmp_path / "again.gif")
    assert again.read_bytes() == path.read_bytes()
    with pytest.raises(ValueError, match="must end in"):
        credence.animate(trajectory, path=tmp_path / "trial.png")


def test_a_film_needs_ffmpeg(tmp_path, monkeypatch):
    if shutil.which("ffmpeg"):
        film = credence.animate(studies.trajectory(), path=tmp_path / "trial.mp4")
        assert film.read_bytes()[4:8] == b"ftyp"
    monkeypatch.setattr(shutil, "which", lambda name: None)
    with pytest.raises(ValueError, match="there is no ffmpeg"):
        credence.animate(studies.trajectory(), path=tmp_path / "none.mp4")


def given(*words):
    return [*map(str, words), *(["--credence", studies.CREDENCE] if studies.CREDENCE else [])]


def test_the_command_draws_all_that_a_file_has(tmp_path, capsys):
    assert main(given(studies.two_scenarios(), "-o", tmp_path, "--scenario", "kf-circle-constant")) == 0
    kinds = ["verdicts", "map-fixed.kf", "map-greedy.kf", "nees", "nis", "coverage", "chi_square", "accuracy",
             *(f"{kind}-{column}" for kind in ("distribution", "paired")
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


def test_the_command_draws_grids_and_trials(tmp_path):
    assert main(given(studies.swept(), "-o", tmp_path)) == 0
    assert {path.stem for path in tmp_path.iterdir()} == {
        f"base-heading-noise-sweep-{what}" for what in ("nees_ratio", "trace_P", "difference")}
    assert main(given(studies.trajectory(), "-o", tmp_path / "trial")) == 0
    assert {path.stem for path in (tmp_path / "trial").iterdir()} == {
        f"ekf-circle-ranged-greedy.ekf-seed-1-trial-17-{kind}" for kind in OF_TRIAL}


def test_the_command_says_what_aggregates_do_not_hold(tmp_path, capsys):
    assert main(given(studies.aggregates(), "-o", tmp_path)) == 0
    assert "keeps aggregates. They need the trials" in capsys.readouterr().err
    assert not list(tmp_path.glob("*distribution*"))
    assert list(tmp_path.glob("*verdicts*"))


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
