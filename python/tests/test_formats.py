"""Logs of receivers, flight controllers and orbits, in the formats that their programs print."""

from __future__ import annotations

from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pandas as pd
import pymap3d
import pytest
from conftest import refused
from test_logs import judged

from credence import adapters
from credence._judge_command import main as judge_command

Array = np.ndarray[Any, Any]
P = np.array([[4.0, 1.2, -0.6], [1.2, 2.25, 0.3], [-0.6, 0.3, 9.0]]) * 1e-4  # east, north, up


def expected_nees(error: Array, covariance: Array = P) -> float:
    return float((error * np.linalg.solve(covariance, error.T).T).sum(axis=1).mean() / error.shape[1])


class TestRtklib:
    """A path of 2 km, whose errors are drawn from P in east, north and up at each point."""

    HERE = (-33.45, -0.25, 570.0)  # deg, m; less than a degree, whose sign only a -0 has
    FIRST: ClassVar[dict[str, str]] = {
        "neu": "latitude(deg) longitude(deg) height(m)",
        "xyz": "x-ecef(m) y-ecef(m) z-ecef(m)",
        "enu": "e-baseline(m) n-baseline(m) u-baseline(m)",
    }

    @classmethod
    def path(cls, steps: int = 200) -> tuple[Array, Array]:
        """East, north and up [step, 3], and the errors there."""
        way = np.c_[10.0 * np.arange(steps), 300 * np.sin(np.arange(steps) / 20), np.cos(np.arange(steps) / 9)]
        return way, np.random.default_rng(3).multivariate_normal(np.zeros(3), P, steps)

    @classmethod
    def write(
        cls, path: Path, kind: str, place: Array, *, separator: str = " ", weeks: bool = False, system: str = "GPST"
    ) -> Path:
        """As `outsols` of RTKLIB 2.4.2 prints it; of kind ``dms`` with the angles in degrees, minutes and seconds."""
        axes = {"llh": "neu", "dms": "neu"}.get(kind, kind)
        a, b, c = axes
        names = [
            *cls.FIRST[axes].split(),
            "Q",
            "ns",
            *(f"sd{one}(m)" for one in (a, b, c, a + b, b + c, c + a)),
            "age(s)",
            "ratio",
        ]
        geodetic = np.transpose(pymap3d.enu2geodetic(*place.T, *cls.HERE))
        own = {"enu": place, "xyz": np.transpose(pymap3d.geodetic2ecef(*geodetic.T))}.get(kind, geodetic)
        lines = [
            f"% ref pos : {cls.HERE}",
            f"%  {system}{separator}" + separator.join(names),
        ]
        lines[1] = lines[1].replace("(deg)", "(d'\")") if kind == "dms" else lines[1]
        for k, (row, (lat, lon, _)) in enumerate(zip(own, geodetic)):
            A = np.eye(3)
            if kind == "xyz":
                A = np.array([np.ravel(pymap3d.enu2uvw(*axis, lat, lon)) for axis in np.eye(3)])
            S = A.T @ P @ A
            i = ["enu".index(axis) if kind != "xyz" else "xyz".index(axis) for axis in axes]
            values = [S[i[a], i[b]] for a, b in ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0))]
            roots = [np.sign(one) * np.sqrt(abs(one)) for one in values]
            stamp = (pd.Timestamp("2025-03-04") + pd.Timedelta(seconds=k)).strftime("%Y/%m/%d %H:%M:%S.000")
            stamp = f"2356{separator}{172800 + k}.000" if weeks else stamp
            if kind == "dms":
                parts = [(abs(one), "-" if one < 0 else "") for one in row[:2]]
                sexagesimal = [
                    f"{s}{int(a)}{separator}{int(a * 60) % 60:02d}{separator}{a * 3600 % 60:09.6f}" for a, s in parts
                ]
            cells = [*(sexagesimal if kind == "dms" else [f"{one:.10f}" for one in row[:2]]), f"{row[2]:.5f}"]
            lines.append(separator.join([stamp, *cells, "1", "9", *(f"{one:.6f}" for one in roots), "0.00", "3.1"]))
        path.write_text("\n".join(lines) + "\n")
        return path

    @pytest.mark.filterwarnings("error")
    @pytest.mark.parametrize(
        ("kind", "how"),
        [("llh", {}), ("llh", {"separator": ",", "weeks": True}), ("dms", {}), ("dms", {"separator": ","}), ("xyz", {}),
         ("enu", {"separator": "\t"})],
    )  # fmt: skip
    def test_all_forms_have_the_errors_of_the_east_north_and_up(self, tmp_path: Path, kind: str, how: Any) -> None:
        way, error = self.path()
        estimate = self.write(tmp_path / "rover.pos", kind, way + error, **how)
        arguments = adapters.from_rtklib(estimate, self.write(tmp_path / "truth.pos", kind, way))
        assert arguments["component_names"] == ["east", "north", "up"]
        np.testing.assert_allclose(
            (arguments["estimate"] - arguments["truth"])[0], error, atol=2e-4
        )  # of 2 km of Earth
        np.testing.assert_allclose(arguments["covariance"][0, 0], P, rtol=2e-4, atol=1e-7)  # of what is printed
        assert judged(arguments) == pytest.approx(expected_nees(error), rel=0.01)
        assert arguments["time"][0, 0] == 2356 * 604800 + 172800

    def test_a_point_that_stands_still(self, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
        error = self.path()[1]
        estimate = self.write(tmp_path / "rover.pos", "llh", error)
        for point in (self.HERE, "-33.45, -0.25, 570"):
            found = adapters.from_rtklib(estimate, point)
            np.testing.assert_allclose((found["estimate"] - found["truth"])[0], error, atol=1e-4)
        assert judge_command([str(estimate), "--truth=-33.45,-0.25,570"]) == 0
        assert "one log of 200 steps" in capfd.readouterr().out
        base = adapters.from_rtklib(self.write(tmp_path / "base.pos", "enu", error), (0, 0, 0))
        np.testing.assert_allclose((base["estimate"] - base["truth"])[0], error, atol=1e-5)

    def test_refusals(self, tmp_path: Path) -> None:
        way, _ = self.path(20)
        llh, enu, utc = (
            self.write(tmp_path / f"{name}.pos", kind, way, system=system)
            for name, kind, system in (("llh", "llh", "GPST"), ("enu", "enu", "GPST"), ("utc", "llh", "UTC"))
        )
        refused(
            r"llh.pos: its positions are in the frame the Earth's, those of the truth in of the",
            adapters.from_rtklib,
            llh,
            enu,
        )
        refused(r"llh.pos: its times are GPST, those of .* UTC. Give time_offset", adapters.from_rtklib, llh, utc)
        refused("invalid body .*no orientations", adapters.from_rtklib, llh, llh, body=[1, 2, 3])
        (tmp_path / "bare.pos").write_text("2025/03/04 00:00:00 1 2 3\n")
        refused("bare.pos: no line of it names its columns", adapters.from_rtklib, tmp_path / "bare.pos", llh)
