"""Logs as people have them (experiments/logs): the right answer at once, or a question whose answer gives it."""

from __future__ import annotations

import importlib.util
import json
import re
import shlex
import sys
import warnings
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pandas as pd
import pytest
from conftest import refused
from logs import log

import credence
from credence import adapters
from credence._judge_command import main as judge_command

SCRIPT = Path(__file__).parents[2] / "experiments" / "logs" / "shapes.py"
_spec = importlib.util.spec_from_file_location("shapes", SCRIPT)
assert _spec is not None and _spec.loader is not None  # noqa: PT018
shapes = sys.modules["shapes"] = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(shapes)


def answer(words: list[str]) -> str:
    """The verdict; `right` if nothing was found and NEES/dim is near 1 in every group; `refused`."""
    code = judge_command([*words, "--format=json", "--output=verdict.json", "--overwrite"])
    if code:
        return {2: "refused"}[code]
    (arm,) = json.loads(Path("verdict.json").read_text())
    Path("hints").write_text("\n".join(arm["hints"]))
    ratios = [group["nees_ratio"] for group in arm["groups"] if group["nees_ratio"] is not None]
    is_right = arm["verdict"] in ("consistent", "undecided") and not arm["findings"] and ratios
    return "right" if is_right and all(0.85 < ratio < 1.15 for ratio in ratios) else str(arm["verdict"])


@pytest.mark.parametrize("name", shapes.SHAPES)
def test_the_answer(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    made: Any = shapes.SHAPES[name]()
    words = shapes.write(tmp_path, name, made)
    found = answer(words)
    said = capfd.readouterr().err
    assert re.search(made.said, said, re.MULTILINE), said
    assert bool(made.said) == ("judge: " in said), said  # of a log about which there is nothing to say
    if made.asks:
        line = next(line for line in said.splitlines() if re.search(made.said, line))
        asked = re.search(r"(?:[Ss]ay |as |with |\()(--.*?)(, or| if|, if| of a|\.$|\. Is)", line)
        assert asked, said
        found = answer([*words, *shlex.split(asked[1])])
        said = capfd.readouterr().err
    assert re.fullmatch(made.answer, found), said
    assert not made.hints or re.search(made.hints, Path("hints").read_text())


class TestFromTable:
    @staticmethod
    def frame() -> Any:
        return shapes.plain(1, **shapes.triangle("upper"))

    MAP: ClassVar[dict[str, Any]] = {
        "estimate": ["x", "y", "h"], "truth": ["gx", "gy", "gh"], "covariance": [f"p{i}" for i in range(1, 7)],
        "components": ["east", "north", "heading"], "angles": ["heading"],
    }  # fmt: skip

    @pytest.mark.filterwarnings("error")
    def test_arguments_take_the_place_of_the_map_s(self) -> None:
        frame = self.frame().assign(other=lambda table: table.gx).assign(gx=0.0)
        by_map = adapters.from_table(frame, map={**self.MAP, "truth": ["other", "gy", "gh"]})
        both = adapters.from_table(frame, map=self.MAP, truth=["other", "gy", "gh"], order="upper")
        for name in ("error", "covariance"):
            np.testing.assert_array_equal(both[name], by_map[name])
        assert both["component_names"] == ["east", "north", "heading"]
        assert both["steps"].tolist() == [len(frame)]

    @pytest.mark.parametrize(
        ("changed", "message"),
        [
            ({"sigmas": ["sx"]}, "map: unknown key sigmas. Give some of error, "),
            ({"components": ["east", "heading"]}, r"components has 2 names \(must be 3"),
            ({"components": ["a", "a", "b"], "angles": []}, "a is named as two components. Give each name once."),
            ({"units": ["deg"]}, "units is no table of names"),
            ({"units": {"east": "s"}}, "units: east cannot be in s. Give one of rad"),
            ({"units": {"up": "m"}}, "units: up is nothing that has one here"),
            ({"order": 5}, r"invalid order=5 \(must be words\)"),
            ({"order": "columns"}, "order: unknown word columns"),
            ({"order": ["upper", "lower"]}, "order: upper and lower cannot be the order of 6 numbers"),
            ({"order": ["full"]}, "order: full cannot be the order of 6 numbers of 3"),
            ({"order": ["rotation first"], "angles": []}, "rotation first: no component is an angle"),
            ({"nees": "x", "dimension": 3}, "cannot judge this table"),
            ({"innovation": ["x"]}, "cannot judge this table"),
            ({"sigma": ["p1", "p2", "p3"]}, "cannot judge this table"),
            ({"dimension": "many"}, "invalid dimension=many"),
            ({"runs": ["x", "y"]}, "must be one name"),
            ({"time": ["x", "y", "h"]}, "no week and seconds of GPS"),
            ({"time": "what"}, r"column what has late at row 1 \(neither a number nor a date\). Give seconds, 2024-"),
            ({"estimate": ["x", "y", "stray"], "angles": []}, "column stray: row 9 has ---, which is no number. Leave"),
            ({"truth": ["gx", "gy", "none"]}, "column none has no number. Leave out this truth"),
        ],
    )
    def test_refusals(self, changed: dict[str, Any], message: str) -> None:
        frame = self.frame().assign(none=np.nan, what="late", stray=[*range(8), "---", *range(9, shapes.STEPS)])
        refused(message, adapters.from_table, frame, map={**self.MAP, **changed})

    def test_maps_that_are_none(self, tmp_path: Path) -> None:
        (tmp_path / "a.toml").write_text("error = x\n")
        refused("invalid map=3 .must be a path or a dict", adapters.from_table, self.frame(), map=3)
        refused("a.toml: it is no TOML", adapters.from_table, self.frame(), map=tmp_path / "a.toml")
        refused("b.toml: the file: cannot be found", adapters.from_table, self.frame(), map=tmp_path / "b.toml")

    def test_times_of_any_form_are_the_same(self) -> None:
        frame = self.frame().drop(columns="t").iloc[:20]
        at = pd.Timestamp("2024-05-06T23:59:59") + pd.to_timedelta(0.1 * np.arange(20), "s")
        gps = (at - pd.Timestamp("1980-01-06")).total_seconds().to_numpy()
        seconds = (at - pd.Timestamp(0)).total_seconds().to_numpy()
        table = frame.assign(
            iso=at.strftime("%Y-%m-%dT%H:%M:%S.%fZ"), slashes=at.strftime("%Y/%m/%d %H:%M:%S.%f"), dates=at,
            zone=at.tz_localize("UTC"), seconds=seconds, day=at.strftime("%Y/%m/%d"), hour=at.strftime("%H:%M:%S.%f"),
            week=gps // 604_800, tow=gps % 604_800, gps=[f"{int(s // 604_800)} {s % 604_800:.1f}" for s in gps],
        )  # fmt: skip
        for name in ("iso", "slashes", "dates", "zone", "seconds", "day,hour", "week,tow", "gps"):
            read = adapters.from_table(table, map=self.MAP, time=name.split(","))["time"][0]
            expected = gps if name in ("week,tow", "gps") else seconds
            np.testing.assert_allclose(read, expected, atol=1e-6, rtol=0, err_msg=name)

    def test_errors_and_innovations_of_one_filter(self) -> None:
        frame = self.frame().assign(u=0.1, v=np.where(np.arange(shapes.STEPS) % 5, np.nan, 0.2), S=0.04)
        both = adapters.from_table(frame, map=self.MAP, innovation=["u", "v"], innovation_variance=["S", "S"])
        assert both["innovation_covariance"].shape == (1, shapes.STEPS, 2, 2)
        assert np.isnan(both["innovation"][0, :, 1]).sum() == 0.8 * shapes.STEPS  # rows that were not observed
        assert credence.judge(**both)["trials"] == 1

    def test_a_variance_that_is_a_placeholder_in_the_middle(self) -> None:
        frame = self.frame()
        frame.loc[500:519, "p1"] = 1e10
        with pytest.warns(UserWarning, match='20 of 1500 steps cannot .* 20 have a variance that says "not known"'):
            arguments = adapters.from_table(frame, map=self.MAP)
        assert arguments["error"].shape == (1, shapes.STEPS - 20, 3)

    def test_steps_have_their_numbers_in_every_run(self) -> None:
        runs = [shapes.plain(seed, **shapes.triangle("upper")).head(50).assign(run=seed) for seed in range(3)]
        frame = pd.concat(runs, ignore_index=True)
        frame.loc[[60, 61, 98, 99], "gy"] = np.nan  # within the second run, and at its end
        with pytest.warns(UserWarning, match="4 of 150 steps cannot be judged"):
            arguments = adapters.from_table(frame, map=self.MAP, runs="run")
        assert np.bincount(arguments["runs"]).tolist() == [50, 48, 50]
        assert np.flatnonzero(np.isnan(arguments["error"]).all(axis=1)).tolist() == [60, 61]
        assert credence.judge(**arguments)["failed"] == 0


@pytest.mark.parametrize(("order", "said"), [("upper", ""), ("lower", "in the order lower alone")])
def test_the_triangle_of_tum_is_found(tmp_path: Path, order: str, said: str) -> None:
    of = log(60)
    rows, columns = np.triu_indices(6) if order == "upper" else np.tril_indices(6)
    lines = np.c_[of.time, of.pose, of.covariance[:, rows, columns]]
    paths = [tmp_path / "estimate.txt", tmp_path / "truth.txt"]
    for path, numbers in zip(paths, (lines, of.truth_rows())):
        np.savetxt(path, numbers, fmt="%.12g")
    with warnings.catch_warnings(record=True) as notes:
        warnings.simplefilter("always")
        arguments = adapters.from_tum(*paths)
    np.testing.assert_allclose(arguments["covariance"][0], of.covariance, rtol=1e-10)
    assert [said in str(one.message) for one in notes] == [True] * bool(said)
    first = adapters.from_tum(*paths, order=[order, "rotation first"])["covariance"][0]
    np.testing.assert_allclose(first[:, :3, :3], of.covariance[:, 3:, 3:], rtol=1e-10)
    quaternions = lines[:, [0, 1, 2, 3, 7, 4, 5, 6, *range(8, lines.shape[1])]]
    np.savetxt(paths[0], quaternions, fmt="%.12g")
    turned = adapters.from_tum(*paths, order=f"{order},qw first")
    np.testing.assert_array_equal(turned["estimate"], arguments["estimate"])
