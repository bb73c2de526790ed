"""Logs of receivers, flight controllers and orbits, in the formats that their programs print."""

from __future__ import annotations

from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pandas as pd
import pymap3d
import pytest
from conftest import refused
from logs import header_of, log, truth_at, types_of, write_messages
from scipy.spatial.transform import Rotation
from test_logs import judged, ulog_bytes

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
            at = pd.Timestamp("2025-03-04") + pd.Timedelta(seconds=k, hours=9 if system == "JST" else 0)
            stamp = at.strftime("%Y/%m/%d %H:%M:%S.000")
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

    @pytest.mark.filterwarnings("ignore:.*independent")
    def test_two_receivers_of_other_frames(self, tmp_path: Path) -> None:
        way, error = self.path()
        files = [self.write(tmp_path / f"{k}.pos", "enu", way + (-1) ** k * error) for k in range(2)]
        np.testing.assert_allclose(adapters.from_rtklib(*files, pair=True)["covariance"][0, 0], 2 * P, rtol=1e-3)
        turned = self.write(tmp_path / "turned.pos", "enu", Rotation.from_euler("z", 0.5).apply(way))
        arguments = adapters.from_rtklib(files[0], turned, pair=True, align="yaw")
        found = Rotation.from_euler("z", -0.5).as_matrix() @ P @ Rotation.from_euler("z", 0.5).as_matrix()
        np.testing.assert_allclose(arguments["covariance"][0, 0], P + found, rtol=0.05)

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
        japan = self.write(tmp_path / "jst.pos", "llh", way, system="JST")
        assert adapters.from_rtklib(japan, utc)["time"][0, 0] == 2356 * 604800 + 172800
        refused("invalid body .*no orientations", adapters.from_rtklib, llh, llh, body=[1, 2, 3])
        (tmp_path / "bare.pos").write_text("2025/03/04 00:00:00 1 2 3\n")
        refused("bare.pos: no line of it names its columns", adapters.from_rtklib, tmp_path / "bare.pos", llh)


class TestBags:
    """Fixes of satellites, and velocities of Odometry."""

    @staticmethod
    def fix(at: float, place: Array, kind: int, status: int = 0, here: Any = TestRtklib.HERE) -> Any:
        types = types_of("sqlite3").types
        lat, lon, height = np.ravel(pymap3d.enu2geodetic(*place, *here))
        state = types["sensor_msgs/msg/NavSatStatus"](status, 1)
        return types["sensor_msgs/msg/NavSatFix"](
            header_of("sqlite3", at, "gps"), state, lat, lon, height, P.ravel(), kind
        )

    def bag(self, path: Path, kind: int = 3) -> tuple[Path, Array]:
        """Every tenth message has no fix."""
        way, error = TestRtklib.path()
        messages = [
            (1.0 + k, "/fix", self.fix(1.0 + k, row, kind, -(k % 10 == 9))) for k, row in enumerate(way + error)
        ]
        messages += [(1.0 + k, "/gt", self.fix(1.0 + k, row, 0)) for k, row in enumerate(way)]
        return write_messages(path, "sqlite3", sorted(messages, key=lambda one: one[0])), error

    def test_fixes_are_judged_in_east_north_and_up(self, tmp_path: Path) -> None:
        bag, error = self.bag(tmp_path / "run")
        with pytest.warns(UserWarning, match="20 of 200 messages have no fix, and are left out"):
            arguments = adapters.from_rosbag(bag, topic="/fix")
        left = error[np.arange(200) % 10 != 9]
        assert arguments["component_names"] == ["east", "north", "up"]
        np.testing.assert_allclose((arguments["estimate"] - arguments["truth"])[0], left, atol=2e-4)
        assert judged(arguments) == pytest.approx(expected_nees(left), rel=0.01)
        still = [(1.0 + k, "/fix", self.fix(1.0 + k, row, 2)) for k, row in enumerate(error)]
        with pytest.warns(UserWarning, match=r"no correlations \(types \{2\}\)"):
            point = adapters.from_rosbag(write_messages(tmp_path / "still", "sqlite3", still), TestRtklib.HERE)
        np.testing.assert_allclose((point["estimate"] - point["truth"])[0], error, atol=1e-4)

    @pytest.mark.filterwarnings("ignore:.*no fix")
    def test_fixes_without_covariances_are_refused(self, tmp_path: Path) -> None:
        bag, _ = self.bag(tmp_path / "run", kind=0)
        refused("position_covariance_type is 0, unknown", adapters.from_rosbag, bag, topic="/fix", truth_topic="/gt")
        refused("several topics have poses with cov.* /fix, /gt", adapters.from_rosbag, bag)

    def test_velocities(self, tmp_path: Path) -> None:
        types, rng = types_of("ros1").types, np.random.default_rng(4)
        vector = types["geometry_msgs/msg/Vector3"]

        def odometry(at: float, v: float, w: float, Q: Array) -> Any:
            twist = types["geometry_msgs/msg/Twist"](vector(v, 0.0, 0.0), vector(0.0, 0.0, w))
            with_covariance = types["geometry_msgs/msg/TwistWithCovariance"](twist, Q.ravel())
            point, turn = (
                types["geometry_msgs/msg/Point"](0.0, 0.0, 0.0),
                types["geometry_msgs/msg/Quaternion"](0.0, 0.0, 0.0, 1.0),
            )
            pose = types["geometry_msgs/msg/PoseWithCovariance"](
                types["geometry_msgs/msg/Pose"](point, turn), np.zeros(36)
            )
            return types["nav_msgs/msg/Odometry"](header_of("ros1", at, "odom"), "base", pose, with_covariance)

        Q = np.zeros((6, 6))
        Q[np.ix_([0, 5], [0, 5])] = R = np.array([[0.04, 0.01], [0.01, 0.09]])
        error = rng.multivariate_normal(np.zeros(2), R, 100)
        times = 5 + 0.1 * np.arange(100)
        messages = [(t, "/odom", odometry(t, 2 * t + a, 3 - t + b, Q)) for t, (a, b) in zip(times, error)]
        messages += [(t, "/gt", odometry(t, 2 * t, 3 - t, 0 * Q)) for t in np.arange(4.95, 16, 0.1)]
        bag = write_messages(tmp_path / "run.bag", "ros1", messages)
        with pytest.warns(UserWarning, match="vy, vz, wx, wy: not estimated, and left out"):
            arguments = adapters.from_rosbag(bag, topic="/odom", truth_topic="/gt", twist=True)
        assert (arguments["component_names"], arguments["component_units"]) == (["vx", "wz"], ["m/s", "rad/s"])
        np.testing.assert_allclose(arguments["error"][0], error, atol=1e-9)
        np.testing.assert_allclose(arguments["covariance"][0, 3], R)
        how: Any = {"topic": "/odom", "truth_topic": "/gt", "twist": True}
        refused("invalid align .says nothing about velocities", adapters.from_rosbag, bag, **how, align="yaw")
        refused("the point: it has no velocities", adapters.from_rosbag, bag, (0, 0, 0), topic="/odom", twist=True)
        refused(
            "there is no topic /a of velocities in it. Give one of /gt, /odom",
            adapters.from_rosbag,
            bag,
            topic="/a",
            twist=True,
        )


class TestPx4:
    """A flight whose truth has another origin, as a simulator and the estimator have it."""

    @pytest.mark.parametrize("kind", ["now", "before 1.14", "states", "states before 1.15"])
    def test_the_truth_of_a_simulation(self, tmp_path: Path, kind: str, capfd: pytest.CaptureFixture[str]) -> None:
        of = log(300, start=0)  # with errors of turns in the world's frame
        true = truth_at(of.time)
        turn, q = Rotation.from_quat(true[:, 3:]), [6, 3, 4, 5]
        error = np.hstack([of.pose[:, :3] - true[:, :3], (Rotation.from_quat(of.pose[:, 3:]) * turn.inv()).as_rotvec()])
        P, variances, pose = of.covariance[0], np.diagonal(of.covariance[0]), of.pose.copy()
        if kind == "now":  # turns in the body's frame
            pose[:, 3:] = (turn * Rotation.from_rotvec(error[:, 3:])).as_quat()
        fields, behind = {
            "now": (["[3] position", "[4] q", "[3] position_variance", "[3] orientation_variance"], variances),
            "before 1.14": ([" x", " y", " z", "[4] q", "[21] pose_covariance"], P[np.triu_indices(6)]),
            "states": (["[11] states", "[10] covariances"], [*variances[3:], 0, 0, 0, *variances[:3], 0]),
            "states before 1.15": (["[10] states", "[10] covariances"], [*[1e-4] * 4, 0, 0, 0, *variances[:3]]),
        }[kind]  # fmt: skip
        own = pose[:, [0, 1, 2, *q]]
        if "states" in kind:
            own = np.hstack([pose[:, q], np.zeros((300, 3)), pose[:, :3], np.zeros((300, int(kind == "states")))])
        if kind != "before 1.14":
            P = np.diag(variances if kind != "states before 1.15" else [*variances[:3], *[4e-4] * 3])
        here, there = [47.4, 8.5, 488.0], np.ravel(pymap3d.ned2geodetic(30, -20, 5, 47.4, 8.5, 488.0))
        refs, at, at_truth = (
            [" x", " y", " z", "= ref_lat", "= ref_lon", " ref_alt"],
            1e6 * of.time,
            1e6 * of.truth_time,
        )
        rows = np.vstack([np.full((3, own.shape[1]), np.nan), own])
        odometry = np.c_[np.r_[[1.0, 2, 3], at], rows, np.tile(behind, (303, 1))]
        places = np.c_[at_truth, of.truth[:, :3] - [30, -20, 5], np.tile(there, (len(at_truth), 1))]
        topics = {
            "estimator_states" if "states" in kind else "vehicle_odometry": (fields, odometry),
            "vehicle_local_position": (refs, np.c_[at, pose[:, :3], np.tile(here, (300, 1))]),
            "vehicle_local_position_groundtruth": (refs, places),
            "vehicle_attitude_groundtruth": (["[4] q"], np.c_[at_truth + 2000, truth_at(of.truth_time + 0.002)[:, q]]),
        }
        path = tmp_path / "flight.ulg"
        path.write_bytes(ulog_bytes(topics))
        with (
            pytest.warns(UserWarning, match="3 messages before the first pose are left out"),
            pytest.warns(UserWarning, match="the origin of its truth is moved by 36.4 m, to that of the estimate"),
        ):
            arguments = adapters.from_px4(path)
        assert arguments["chart"] == ("local" if kind == "now" else "global")
        found = arguments["covariance"][0]
        assert found.shape == ((300, 6, 6) if kind == "before 1.14" else (300, 6))
        np.testing.assert_allclose(found[7], P if found.ndim == 3 else np.diagonal(P), rtol=1e-5)
        whole = {**arguments, "covariance": np.tile(P, (1, 300, 1, 1))}
        assert judged(whole) == pytest.approx(expected_nees(error, P), rel=0.05)  # of singles: 1e-6 m in 30 m
        assert judge_command([str(path), "--truth-topic=groundtruth"]) == 0
        assert "one log of 300 steps" in capfd.readouterr().out

    def test_refusals(self, tmp_path: Path) -> None:
        (tmp_path / "a.ulg").write_bytes(ulog_bytes({"vehicle_odometry": ([" x"], np.ones((3, 2)))}))
        refused("a.ulg: it has not all of vehicle_local_position_groundtruth", adapters.from_px4, tmp_path / "a.ulg")
        assert judge_command([str(tmp_path / "a.ulg"), "--truth-topic=/gt"]) == 2


class TestOem:
    """The covariance that CCSDS 502.0-B-3 prints in its figure of an OEM, in each of its frames."""

    LOWER = (
        "3.3313494e-04\n4.6189273e-04 6.7824216e-04\n-3.0700078e-04 -4.2212341e-04 3.2319319e-04\n"
        "-3.3493650e-07 -4.6860842e-07 2.4849495e-07 4.2960228e-10\n"
        "-2.2118325e-07 -2.8641868e-07 1.7980986e-07 2.6088992e-10 1.7675147e-10\n"
        "-3.0413460e-07 -4.9894969e-07 3.5403109e-07 1.8692631e-10 1.0088625e-10 6.2244443e-10\n"
    )

    @classmethod
    def write(cls, path: Path, states: Array, frames: tuple[str, ...] = (), frame: str = "EME2000") -> Path:
        head = "CCSDS_OEM_VERS = 2.0\nCREATION_DATE = 1996-11-04T17:22:31\nORIGINATOR = NASA/JPL\nMETA_START\n"
        head += f"OBJECT_NAME = MARS GLOBAL SURVEYOR\nOBJECT_ID = 1996-062A\nCENTER_NAME = EARTH\nREF_FRAME = {frame}\n"
        head += "TIME_SYSTEM = UTC\nSTART_TIME = 1996-12-28T21:00:00\nSTOP_TIME = 1996-12-28T21:09:00\nMETA_STOP\n"
        rows = [f"1996-12-28T21:0{k}:00 " + " ".join(f"{one:.9f}" for one in row) for k, row in enumerate(states)]
        blocks = [
            f"EPOCH = 1996-12-28T21:0{k}:{'30' if k == 4 else '00'}\nCOV_REF_FRAME = {one}\n{cls.LOWER}"
            for k, one in enumerate(frames)
        ]
        covariances = ["COVARIANCE_START\n" + "".join(blocks) + "COVARIANCE_STOP"] if frames else []
        path.write_text("\n".join([head + "\n".join(rows), *covariances]) + "\n")
        return path

    @staticmethod
    def orbit(off: Array) -> Array:
        """[minute, 6] (km, km/s): a circle that is inclined, and an offset."""
        turn, w = Rotation.from_euler("x", 0.7), np.sqrt(398600.4418 / 7000**3)
        t = w * 60 * np.arange(10)
        place, speed = np.c_[np.cos(t), np.sin(t), 0 * t], np.c_[-np.sin(t), np.cos(t), 0 * t]
        return np.hstack([turn.apply(7000 * place), turn.apply(7000 * w * speed)]) + off

    def test_covariances_are_turned_from_their_frame(self, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
        off = np.array([0.02, -0.01, 0.015, 1e-5, 2e-5, -1e-5])
        true = self.orbit(np.zeros(6))
        frames = ("RTN", "TNW", "EME2000", "RSW", "RTN")  # the last between two states
        files = [self.write(tmp_path / "a.oem", true + off, frames), self.write(tmp_path / "b.oem", true)]
        arguments = adapters.from_oem(*files)
        assert arguments["time"][0] == pytest.approx([0, 60, 120, 180, 270])
        lower = [[float(one) for one in line.split()] for line in self.LOWER.splitlines()]
        P = np.array([row + [0.0] * (6 - len(row)) for row in lower])
        P += np.tril(P, -1).T
        turn, w = Rotation.from_euler("x", 0.7), np.sqrt(398600.4418 / 7000**3)
        for k, (frame, minute) in enumerate(zip(frames, (0, 1, 2, 3, 4.5))):
            # Of a circle T is the direction of the velocity, N that of the centre's opposite, up to the offset.
            R = (turn * Rotation.from_euler("z", w * 60 * minute)).as_matrix().T  # radial, transverse, normal
            e = np.r_[R @ off[:3], R @ off[3:]]
            np.testing.assert_allclose(arguments["error"][0, k], 1e3 * e, rtol=1e-4, atol=1e-5)
            own = {"EME2000": np.eye(3), "TNW": np.stack([R[1], -R[0], R[2]])}.get(frame, R)
            J = np.kron(np.eye(2), R @ own.T)
            np.testing.assert_allclose(arguments["covariance"][0, k], 1e6 * J @ P @ J.T, rtol=1e-3, atol=1e-2)
        assert judge_command([str(files[0]), "--truth", str(files[1])]) == 0
        assert "one log of 5 steps" in capfd.readouterr().out

    def test_refusals(self, tmp_path: Path) -> None:
        true = self.orbit(np.zeros(6))
        one, plain = self.write(tmp_path / "a.oem", true, ("RTN",)), self.write(tmp_path / "b.oem", true)
        other, axes = (
            self.write(tmp_path / f"{name}.oem", true, ("ITRF2000",), frame)
            for name, frame in (("c", "ITRF2000"), ("d", "EME2000"))
        )
        refused("b.oem: 0 covariances", adapters.from_oem, plain, one)
        refused("c.oem: its states are in .'ITRF", adapters.from_oem, one, other)
        refused("d.oem: its covariances are in ITRF2000", adapters.from_oem, axes, plain)
        (tmp_path / "e.oem").write_text("no orbit\n")
        refused("e.oem: it cannot be read as an OEM", adapters.from_oem, tmp_path / "e.oem", plain)
