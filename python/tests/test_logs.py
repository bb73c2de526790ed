"""Adapters of formats that people have, on files that the libraries of these formats write."""

from __future__ import annotations

import html
import shlex
import struct
import subprocess
import warnings
from pathlib import Path
from types import SimpleNamespace
from typing import Any, ClassVar

import numpy as np
import pandas as pd
import pytest
import scipy.io
from conftest import python, refused
from evo.core import metrics, sync
from evo.tools import file_interface
from logs import Log, log, truth_at, write_bag
from scipy.spatial.transform import Rotation

import credence
from credence import adapters
from credence._judge_command import main as judge_command
from credence._judge_command import write_record

Array = np.ndarray[Any, Any]
Arguments = dict[str, Any]


def write(path: Path, rows: Array, delimiter: str = " ", header: str = "") -> Path:
    np.savetxt(path, rows, delimiter=delimiter, header=header, fmt="%.12g" if delimiter == " " else "%.18g")
    return path


def tum(folder: Path, of: Log) -> tuple[Path, Path]:
    return write(folder / "estimate.txt", of.rows()), write(folder / "truth.txt", of.truth_rows())


def euroc(path: Path, time: Array, pose: Array, *behind: Array, digits: int = 0) -> Path:
    """A file whose quaternions begin with w, and whose times are ns."""
    rows = np.c_[(np.round(1e9 * time, digits), pose[:, [0, 1, 2, 6, 3, 4, 5]], *behind)]
    return write(path, rows, ",", "#timestamp [ns]")


def kitti(pose: Array, rows: int = 3) -> Array:
    """The matrices of poses, a line each."""
    T = np.tile(np.eye(4), (len(pose), 1, 1))
    T[:, :3, :3], T[:, :3, 3] = Rotation.from_quat(pose[:, 3:]).as_matrix(), pose[:, :3]
    return T[:, :rows].reshape(len(pose), -1)


def nees(arguments: Arguments) -> Array:
    """[step], of errors in the world's frame."""
    true, estimated = arguments["truth"][0], arguments["estimate"][0]
    turn = Rotation.from_quat(estimated[:, 3:]) * Rotation.from_quat(true[:, 3:]).inv()
    error = np.hstack([estimated[:, :3] - true[:, :3], turn.as_rotvec()])
    solved = np.linalg.solve(arguments["covariance"][0], error[..., None])[..., 0]
    values: Array = (error * solved).sum(axis=-1)
    return values


def judged(arguments: Arguments) -> float:
    """What judge has as the mean of NEES/n."""
    return float(np.mean(credence.judge(**arguments)["groups"][0]["anees"]["ratio"]))


@pytest.mark.filterwarnings("error")
class TestPoses:
    def test_truth_is_interpolated(self, tmp_path: Path) -> None:
        of = log()
        arguments = adapters.from_tum(*tum(tmp_path, of), manifold="R3 x SO3", chart="global")
        between = truth_at(of.time - 100)
        np.testing.assert_allclose(arguments["truth"][0, :, :3], between[:, :3], atol=5e-5)  # a² h²/8
        turn = Rotation.from_quat(arguments["truth"][0, :, 3:]).inv() * Rotation.from_quat(between[:, 3:])
        assert turn.magnitude().max() < 1e-5
        assert judged(arguments) == pytest.approx(nees(arguments).mean() / 6)

    def test_formats_have_the_same_errors(self, tmp_path: Path) -> None:
        of = log(60)
        how: Any = {"manifold": "R3 x SO3", "chart": "global"}
        expected = adapters.from_tum(*tum(tmp_path, of), **how)
        behind = of.covariance.reshape(-1, 36)
        estimate = euroc(tmp_path / "estimate.csv", of.time, of.pose, behind)
        truth = euroc(tmp_path / "truth.csv", of.truth_time, of.truth, np.zeros((len(of.truth), 9)))
        lines = write(tmp_path / "kitti.txt", np.c_[kitti(of.pose), behind])
        times = write(tmp_path / "times.txt", of.time)
        for other in (adapters.from_euroc(estimate, truth, **how), adapters.from_kitti(lines, truth, times, **how)):
            np.testing.assert_allclose(nees(other), nees(expected), rtol=1e-6)
        truth = write(tmp_path / "kitti_truth.txt", kitti(of.truth[:60]))
        read = file_interface.read_kitti_poses_file(str(truth))
        counted = adapters.from_kitti(lines, truth, align="first")
        np.testing.assert_allclose(counted["estimate"][0, :, :3], of.pose[1:, :3], atol=1e-9)
        assert counted["time"][0].tolist() == list(range(1, read.num_poses))

    @pytest.mark.parametrize("align", ["first", "se3"])
    def test_alignment_is_that_of_evo(self, tmp_path: Path, align: str) -> None:
        of = log(80)
        turn = Rotation.from_rotvec([0.3, -0.2, 1.0])
        turned = (turn * Rotation.from_quat(of.truth[:, 3:])).as_quat()
        moved = turn.apply(of.truth[:, :3]) + np.array([5, 6, 7]), turned
        estimate, truth = tum(tmp_path, of._replace(truth=np.hstack(moved)))
        plain = write(tmp_path / "plain.txt", of.rows()[:, :8])
        both = [file_interface.read_tum_trajectory_file(str(path)) for path in (truth, plain)]
        matched = sync.associate_trajectories(*both, sync_method=sync.SyncMethod.interpolation)
        if align == "first":
            matched[1].align_origin(matched[0])
        else:
            matched[1].align(matched[0])
        ape = metrics.APE(metrics.PoseRelation.translation_part)
        ape.process_data(matched)
        arguments = adapters.from_tum(estimate, truth, align=align)
        distance = np.linalg.norm((arguments["estimate"] - arguments["truth"])[0, :, :3], axis=1)
        np.testing.assert_allclose(distance, ape.error[1 if align == "first" else 0 :], atol=1e-8)

    def test_frames_that_differ_are_said(self, tmp_path: Path) -> None:
        of = log(60)
        files = tum(tmp_path, of._replace(truth=of.truth + 4 * np.eye(7)[0]))
        with pytest.warns(UserWarning, match=r"its first pose is 4\.\d* m from the truth, \d+ sigmas. Are both in one"):
            adapters.from_tum(*files)

    @pytest.mark.parametrize("late", [0.0, 0.12, -0.35])
    def test_a_time_offset_is_found_and_not_applied(self, tmp_path: Path, late: float) -> None:
        of = log(400)
        how: Any = {"manifold": "R3 x SO3", "chart": "global"}
        files = tum(tmp_path, of._replace(time=of.time + late))
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            arguments = adapters.from_tum(*files, **how)
        np.testing.assert_allclose(arguments["time"][0], of.time + late, atol=1e-6)
        if not late:
            assert not said
            return
        (message,) = [str(one.message) for one in said]
        assert "would be" in message
        assert float(message.split("with ")[1].split(" s added")[0]) == pytest.approx(-late, abs=0.003)
        again = adapters.from_tum(*files, time_offset=-late, **how)  # says nothing: warnings are errors here
        np.testing.assert_allclose(again["truth"], adapters.from_tum(*tum(tmp_path, of), **how)["truth"], atol=1e-6)

    def test_poses_at_the_same_time(self, tmp_path: Path) -> None:
        of = log(30)
        rows = of.rows()
        estimate = write(tmp_path / "twice.txt", np.vstack([rows, rows[3] + np.r_[0, 1, np.zeros(42)]]))
        with pytest.warns(UserWarning, match="of 1 poses another one has the same time, and the last counts"):
            arguments = adapters.from_tum(estimate, write(tmp_path / "truth.txt", of.truth_rows()))
        assert arguments["estimate"][0, 3, 0] == pytest.approx(of.pose[3, 0] + 1)

    def test_refusals(self, tmp_path: Path) -> None:
        files = tum(tmp_path, log(20))
        refused("invalid align=up", adapters.from_tum, *files, align="up")
        refused("invalid manifold=SO3", adapters.from_tum, *files, manifold="SO3")
        refused("there are 1 runs and 2 truths", adapters.from_tum, files[0], [files[1]] * 2)
        refused(r"nowhere.txt: the file: cannot be found", adapters.from_tum, "nowhere.txt", files[1])


class TestPlanar:
    """z, roll and pitch that no filter estimated."""

    @staticmethod
    def flat(of: Log) -> Log:
        """The poses in the plane, as of the components x, y and yaw of P."""
        yaw = Rotation.from_quat(of.pose[:, 3:]).as_euler("ZYX")[:, 0]
        pose = np.c_[of.pose[:, :2], np.zeros((len(yaw), 3)), np.sin(yaw / 2), np.cos(yaw / 2)]
        return of._replace(pose=pose, covariance=of.covariance.copy())

    @pytest.mark.parametrize("placeholder", [0.0, 1e-9, -1.0, 1e6, 99999.0, np.nan])
    def test_placeholders(self, tmp_path: Path, placeholder: float) -> None:
        of = self.flat(log(60))
        of.covariance[:, [2, 3, 4]] = of.covariance[:, :, [2, 3, 4]] = 0
        of.covariance[:, [2, 3, 4], [2, 3, 4]] = placeholder
        with pytest.warns(UserWarning, match="z, roll, pitch: not estimated .*; judged: x, y, yaw"):
            arguments = adapters.from_tum(*tum(tmp_path, of), manifold="R3 x SO3")
        assert arguments["manifold"] == "R2 x SO2"
        assert arguments["component_names"] == ["x", "y", "yaw"]
        np.testing.assert_allclose(arguments["covariance"][0, 0], log(60).covariance[0][np.ix_([0, 1, 5], [0, 1, 5])])
        e = arguments["estimate"][0] - arguments["truth"][0]
        e[:, 2] = np.remainder(e[:, 2] + np.pi, 2 * np.pi) - np.pi
        expected = np.einsum("ki,kij,kj->k", e, np.linalg.inv(arguments["covariance"][0]), e).mean() / 3
        assert judged(arguments) == pytest.approx(expected)

    def test_on_the_manifold(self, tmp_path: Path) -> None:
        files = tum(tmp_path, self.flat(log(60)))
        assert adapters.from_tum(*files, planar=True)["manifold"] == "SE2"
        assert adapters.from_tum(*files, planar=False)["manifold"] == "SE3"

    def test_positions_alone(self, tmp_path: Path) -> None:
        of = log(60)
        of.covariance[:, 3:] = of.covariance[:, :, 3:] = 0
        with pytest.warns(UserWarning, match="roll, pitch, yaw: not estimated"):
            arguments = adapters.from_tum(*tum(tmp_path, of))
        assert arguments["manifold"] == "R3"
        np.testing.assert_allclose(arguments["estimate"], of.pose[None, :, :3], atol=1e-10)

    def test_height_missing(self, tmp_path: Path) -> None:
        of = log(60)
        of.covariance[:, 2] = of.covariance[:, :, 2] = 0
        files = tum(tmp_path, of)
        with pytest.warns(UserWarning, match="z: not estimated"):
            arguments = adapters.from_tum(*files, manifold="R3 x SO3", chart="global")
        whole = adapters.from_tum(*files, manifold="R3 x SO3", chart="global", planar=False)
        turn = Rotation.from_quat(whole["estimate"][0, :, 3:]) * Rotation.from_quat(whole["truth"][0, :, 3:]).inv()
        np.testing.assert_allclose(arguments["error"][0, :, 2:], turn.as_rotvec(), atol=1e-12)
        with (
            pytest.warns(UserWarning, match="not estimated"),
            pytest.raises(credence.InputError, match="cannot judge a part of SE3"),
        ):
            adapters.from_tum(*files)

    def test_no_covariances_at_all(self, tmp_path: Path) -> None:
        of = log(60)
        with pytest.raises(credence.InputError, match="no covariances \\(all its variances are placeholders"):
            adapters.from_tum(*tum(tmp_path, of._replace(covariance=0 * of.covariance)))


@pytest.mark.filterwarnings("error")
class TestBags:
    @pytest.mark.parametrize(("kind", "truth"), [("ros1", "pose"), ("sqlite3", "tf"), ("mcap", "tf")])
    def test_bags_have_the_numbers_of_text_and_of_evo(self, tmp_path: Path, kind: str, truth: str) -> None:
        of = log(60)
        bag = write_bag(tmp_path / ("run.bag" if kind == "ros1" else "run"), of, kind, truth=truth)
        path = next(bag.glob("*.mcap")) if kind == "mcap" else bag
        arguments = adapters.from_rosbag(path, truth_topic="/tf:map.base_link" if truth == "tf" else None)
        text = adapters.from_tum(*tum(tmp_path, of), manifold="R3 x SO3", chart="global")
        np.testing.assert_allclose(nees(arguments), nees(text), rtol=1e-5)
        apart = adapters.from_rosbag(path, tmp_path / "truth.txt")
        np.testing.assert_allclose(nees(apart), nees(text), rtol=1e-5)
        read = file_interface.read_tum_trajectory_file(str(write(tmp_path / "plain.txt", of.rows()[:, :8])))
        np.testing.assert_allclose(arguments["estimate"][0, :, :3], read.positions_xyz, atol=1e-11)

    def test_topics(self, tmp_path: Path) -> None:
        bag = write_bag(tmp_path / "run", log(20), "sqlite3")
        for how, message in (
            ({}, "no topic has poses for a truth. Name the topic \\(truth_topic\\): /tf:map.base_link"),
            ({"topic": "/odometry"}, "there is no topic /odometry of poses in it. Give one of /odom, /tf"),
            ({"truth_topic": "/tf:map.camera"}, "/tf has no transform `map.camera`. Give one .*, of map.base_link"),
            ({"topic": "/tf:map.base_link", "truth_topic": "/odom"}, "its poses have no covariances"),
        ):
            refused(message, adapters.from_rosbag, bag, **how)
        whole = write_bag(tmp_path / "whole.bag", log(20), "ros1", truth="pose").read_bytes()
        (tmp_path / "torn.bag").write_bytes(whole[: len(whole) // 2])
        refused(r"torn.bag: .*Give a whole bag", adapters.from_rosbag, tmp_path / "torn.bag")


def ulog_bytes(topics: dict[str, tuple[list[str], Array]]) -> bytes:
    """A log in PX4's format, whose topics have a row a time (µs) and fields of singles, or, with an `=`, doubles."""

    def message(kind: bytes, body: bytes) -> bytes:
        return struct.pack("<H", len(body)) + kind + body

    parts = [b"ULog\x01\x12\x35\x01" + struct.pack("<Q", 0), message(b"B", bytes(40))]
    for name, (fields, _) in topics.items():
        typed = "".join(f"float{one};" for one in fields).replace("float=", "double")
        parts.append(message(b"F", f"{name}:uint64_t timestamp;{typed}".encode()))
    for number, name in enumerate(topics):
        parts.append(message(b"A", struct.pack("<BH", 0, number) + name.encode()))
    for number, (fields, rows) in enumerate(topics.values()):
        counts = [int(one.partition("]")[0].lstrip("=[") or 1) if "[" in one else 1 for one in fields]
        codes = "".join(f"{count}{'d' if one[0] == '=' else 'f'}" for count, one in zip(counts, fields))
        for time, *values in rows.tolist():
            parts.append(message(b"D", struct.pack(f"<HQ{codes}", number, int(time), *values)))
    return b"".join(parts)


class TestUlog:
    """Two elements of the horizontal position, measured every other time, and a barometer."""

    @staticmethod
    def write(path: Path, names: tuple[str, ...]) -> tuple[Path, Array, Array]:
        rng = np.random.default_rng(3)
        times, S = 1e5 * np.arange(1, 401), np.array([0.25, 0.5, 2.0])
        nu = (np.sqrt(S) * rng.normal(size=(400, 3))).astype(np.float32).astype(float)
        nu[1::2, :2] = nu[::2, :2]
        fields, V = ["[2] gps_hpos", " baro_vpos", " flow"], np.tile(S, (400, 1))
        zeros = np.zeros((400, 1))
        if len(names) == 2:
            topics = {name: (fields, np.c_[times, rows, zeros]) for name, rows in zip(names, (nu, V))}
        else:
            both = ["[2] gps_hpos_innov", " baro_vpos_innov", "[2] gps_hpos_innov_var", " baro_vpos_innov_var"]
            topics = {names[0]: (both, np.c_[times, nu, V])}
        path.write_bytes(ulog_bytes(topics))
        return path, nu, S

    @pytest.mark.parametrize(
        "names", [("estimator_innovations", "estimator_innovation_variances"), ("ekf2_innovations",)]
    )
    def test_innovations(self, tmp_path: Path, names: tuple[str, ...]) -> None:
        path, nu, S = self.write(tmp_path / "flight.ulg", names)
        with pytest.warns(UserWarning, match=r"observed at 200 of 400 times \(gps_hpos\[0\] 200, .* baro_vpos 400\)"):
            arguments = adapters.from_ulog(path)
        assert arguments["groups"] == {"gps_hpos": [0, 1], "baro_vpos": [2]}
        np.testing.assert_array_equal(arguments["error"][0], nu[::2])
        np.testing.assert_array_equal(arguments["covariance"][0], np.tile(S, (200, 1)))
        assert judged(adapters.from_ulog(path, ["baro_vpos"])) == pytest.approx(np.mean(nu[:, 2] ** 2 / 2), rel=1e-6)
        assert adapters.from_ulog(path, ["gps_hpos"])["time"][0, :2] == pytest.approx([0.1, 0.3])

    def test_refusals(self, tmp_path: Path) -> None:
        path, *_ = self.write(tmp_path / "a.ulg", ("ekf2_innovations",))
        refused(r"no row was observed. Give some of gps_hpos", adapters.from_ulog, path, ["mag_field"])
        refused("of instance 1 \\(it has ekf2_innovations 0\\)", adapters.from_ulog, path, instance=1)
        (tmp_path / "b.ulg").write_text("no log\n")
        refused(r"b.ulg: it cannot be read as a log of PX4", adapters.from_ulog, tmp_path / "b.ulg")


class TestMat:
    @pytest.mark.parametrize("order", ["F", "C"])
    def test_orders(self, tmp_path: Path, order: str) -> None:
        rng = np.random.default_rng(4)
        error, P = rng.normal(size=(40, 7, 2)), np.tile(np.array([[1.0, 0.3], [0.3, 2.0]]), (40, 7, 1, 1))
        arrays = {"e": error.T if order == "F" else error, "covariance": P.T if order == "F" else P}
        texts = {"component_names": ["x", "vx"], "time": np.arange(7.0), "groups": "speed 1", "fs": 2.0}
        scipy.io.savemat(tmp_path / "a.mat", {**arrays, **texts})
        arguments = adapters.from_mat(tmp_path / "a.mat", {"error": "e"})
        np.testing.assert_array_equal(arguments["error"], error)
        assert arguments["component_names"] == ["x", "vx"]
        same = credence.judge(error, P, component_names=["x", "vx"], groups="speed 1", time=np.arange(7.0))
        assert credence.judge(**arguments).json == same.json

    def test_fields_of_structs_and_variances(self, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
        rng = np.random.default_rng(4)
        error, V = rng.normal(size=(60, 3)), np.tile([1.0, 2, 3], (60, 1))
        scipy.io.savemat(tmp_path / "a.mat", {"nav_e": {"vel": error, "filter": {"P": V}}, "nav": {"vel": 0.0}})
        names = {"error": "nav_e.vel", "covariance": "nav_e.filter.P"}
        with pytest.warns(UserWarning, match=r"its arrays are taken for \[step, n\]. Say order F if not"):
            assert adapters.from_mat(tmp_path / "a.mat", names)["error"].shape == (60, 3)
        arguments = adapters.from_mat(tmp_path / "a.mat", names, order="C")
        np.testing.assert_array_equal(arguments["error"], error)
        np.testing.assert_array_equal(arguments["covariance"], V)
        names["error"] = "nav_e.v"
        refused("no array nav_e.v in it .it has nav_e, nav_e.vel", adapters.from_mat, tmp_path / "a.mat", names)
        words = ["--names", "error=nav_e.vel", "covariance=nav_e.filter.P", "order=C"]
        assert judge_command([str(tmp_path / "a.mat"), *words]) == 0
        assert "one log of 60 steps" in capfd.readouterr().out

    def test_refusals(self, tmp_path: Path) -> None:
        scipy.io.savemat(tmp_path / "a.mat", {"error": np.ones((3, 4)), "covariance": np.ones((3, 4))})
        refused(r"covariances of \[3, 4\] fit both orders, or none. Say order C", adapters.from_mat, tmp_path / "a.mat")
        assert adapters.from_mat(tmp_path / "a.mat", order="F")["error"].shape == (4, 3)
        refused("there is no array e in it .it has error, cov", adapters.from_mat, tmp_path / "a.mat", {"error": "e"})
        (tmp_path / "b.mat").write_text("words")
        refused(r"b.mat: it cannot be read as a .mat file", adapters.from_mat, tmp_path / "b.mat")


class TestTables:
    @staticmethod
    def frame() -> pd.DataFrame:
        rng = np.random.default_rng(6)
        t = np.arange(200.0) / 10
        truth = np.c_[np.sin(t), np.cos(t), t]
        estimate = truth + 0.1 * rng.normal(size=(200, 3))
        estimate[:, 2] = np.remainder(estimate[:, 2] + np.pi, 2 * np.pi) - np.pi
        return pd.DataFrame(np.c_[t, estimate, truth], columns=["t", *"xya", "gx", "gy", "ga"]).assign(s=0.1, run="a")

    HOW: ClassVar[Arguments] = {"estimate": [*"xya"], "truth": ["gx", "gy", "ga"], "sigma": ["s"] * 3, "angles": "a",
                                "time": "t"}  # fmt: skip

    def test_frames_and_files(self, tmp_path: Path) -> None:
        frame = self.frame()
        arguments = adapters.from_table(frame, **self.HOW)
        assert np.abs(arguments["error"]).max() < 0.5  # the angle is wrapped
        assert arguments["covariance"] == pytest.approx(0.01 * np.ones((1, 200, 3)))
        for separator in (",", ";"):
            frame.to_csv(tmp_path / "a.csv", index=False, sep=separator)
            read = adapters.from_table(tmp_path / "a.csv", **self.HOW)
            np.testing.assert_allclose(read["error"], arguments["error"])
        by_run = adapters.from_table(pd.concat([frame, frame.assign(run="b")]), **self.HOW, runs="run")
        assert credence.judge(**by_run)["trials"] == 2

    def test_a_truth_of_its_own(self) -> None:
        frame = self.frame()
        t = np.arange(0, 19.5, 0.15)
        truth = pd.DataFrame({"t": t, "gx": np.sin(t), "gy": np.cos(t), "ga": np.remainder(t, 2 * np.pi)})
        with pytest.warns(UserWarning, match="of 200 poses have no truth"):
            arguments = adapters.from_table(frame, truth, **self.HOW)
        inside = frame["t"] <= t[-1]
        expected = adapters.from_table(frame[inside], **self.HOW)
        np.testing.assert_allclose(arguments["error"], expected["error"], atol=4e-3)  # h²/8

    def test_covariances(self) -> None:
        table = {name: np.arange(1.0, 4) for name in ("e", "f", "ee", "ef", "ff")}
        triangle = adapters.from_table(table, error=["e", "f"], covariance=["ee", "ef", "ff"])
        whole = adapters.from_table(table, error=["e", "f"], covariance=["ee", "ef", "ef", "ff"])
        np.testing.assert_array_equal(triangle["covariance"], whole["covariance"])
        assert triangle["covariance"].shape == (1, 3, 2, 2)

    @pytest.mark.parametrize(
        ("how", "message"),
        [
            ({"error": "x"}, "takes error, or estimate and truth, and one of sigma"),
            ({"error": "e", "sigma": "s"}, "there is no column e in it \\(it has t, x"),
            ({"error": "run", "sigma": "s"}, "the table: column run is an array of .* does not hold numbers"),
            ({"error": "x", "sigma": ["s", "s"]}, "sigma has 2 columns \\(must be 1"),
            ({"error": ["x", "y"], "covariance": ["s", "s"]}, "covariance has 2 columns \\(must be 4 or 3"),
            ({"error": "x", "sigma": "s", "angles": "y"}, "y is no column of the errors"),
            ({"estimate": ["x", "y"], "truth": "gx", "sigma": "s"}, "truth has 1 columns \\(must be 2"),
        ],
    )
    def test_refusals(self, how: Arguments, message: str) -> None:
        refused(message, adapters.from_table, self.frame(), **how)

    def test_files_that_are_no_tables(self, tmp_path: Path) -> None:
        (tmp_path / "a.csv").write_text("x,y\n1,2\n3\n")
        refused("a.csv: row 2 .* has 1 cells .must be 2", adapters.from_table, tmp_path / "a.csv", error="x", sigma="y")


class TestUnitsOfTimes:
    """A time in another unit than its format's pairs a pose with another one's truth."""

    @staticmethod
    def euroc(folder: Path, of: Log, scale: float, truth_scale: float) -> tuple[Path, Path]:
        at, of_truth = 1e-9 * scale * of.time, 1e-9 * truth_scale * of.truth_time
        estimate = euroc(folder / "estimate.csv", at, of.pose, of.covariance.reshape(-1, 36), digits=12)
        return estimate, euroc(folder / "truth.csv", of_truth, of.truth, digits=12)

    @pytest.mark.parametrize(("unit", "scale"), [("s", 1.0), ("ms", 1e3)])
    def test_a_spacing_below_a_microsecond_is_refused(self, tmp_path: Path, unit: str, scale: float) -> None:
        of = log(60)
        expected = adapters.from_tum(*tum(tmp_path, of))
        taken = r"estimate.csv: its times are taken for ns, in which they are 5e-\d+ s apart \(must be at least 1e-06"
        refused(rf"{taken} s.* such as units time={unit}", adapters.from_euroc, *self.euroc(tmp_path, of, scale, scale))
        with pytest.raises(credence.InputError, match=rf"truth.csv: .*, such as units truth_time={unit}."):
            adapters.from_euroc(*self.euroc(tmp_path, of, scale, scale), units={"time": unit})
        both = {"time": unit, "truth_time": unit}
        read = adapters.from_euroc(*self.euroc(tmp_path, of, scale, scale), units=both)
        np.testing.assert_allclose(nees(read), nees(expected), rtol=1e-6)
        mixed = adapters.from_euroc(self.euroc(tmp_path, of, scale, 1e9)[0], tum(tmp_path, of)[1], units={"time": unit})
        np.testing.assert_allclose(mixed["time"], expected["time"], rtol=1e-9)

    def test_the_unit_that_was_taken_is_said(self, tmp_path: Path) -> None:
        of = log(60)
        files = self.euroc(tmp_path, of, 1e6, 1e6)
        with pytest.warns(UserWarning, match=r"estimate.csv: its times are taken for ns, .* 5e-05 s apart. Say"):
            adapters.from_euroc(*files)
        late = of._replace(time=1e9 * of.time)
        with (
            pytest.warns(UserWarning, match="estimate.txt: its times are taken for s, .* such as units time=ns"),
            pytest.raises(credence.InputError, match="no pose has a truth"),
        ):
            adapters.from_tum(*tum(tmp_path, late))
        refused("units: time cannot be in deg", adapters.from_tum, *tum(tmp_path, of), units={"time": "deg"})

    def test_every_file_with_times(self, tmp_path: Path) -> None:
        of = log(60)
        estimate, truth = tum(tmp_path, of)
        lines = write(tmp_path / "kitti.txt", np.c_[kitti(of.pose), of.covariance.reshape(-1, 36)])
        times = write(tmp_path / "times.txt", 1e-9 * of.time)
        small = write(tmp_path / "small.txt", np.c_[1e-9 * of.truth_time, of.truth])
        bag = write_bag(tmp_path / "run.bag", of, "ros1", truth="pose")
        vins = write(tmp_path / "vins.txt", np.c_[of.time, of.pose, np.ones((60, 12))])
        frame = TestTables.frame()
        for call in (
            lambda: adapters.from_tum(estimate, small),
            lambda: adapters.from_kitti(lines, truth, times),
            lambda: adapters.from_rosbag(bag, small),
            lambda: adapters.from_openvins(vins, small),
            lambda: adapters.from_table(frame.assign(t=1e-9 * frame["t"]), **TestTables.HOW),
            lambda: (
                adapters.from_table(frame, frame.assign(t=1e-9 * frame["t"]), **TestTables.HOW, units={"t": "s"})
                and adapters.from_table(frame, frame, **TestTables.HOW, units={"truth_time": "ns"})
            ),
        ):
            refused(r"taken for n?s, .* s apart \(must be at least", call)
        units = {"t": "ms", "truth_time": "s"}
        in_ms = adapters.from_table(frame.assign(t=1e3 * frame["t"]), frame, **TestTables.HOW, units=units)
        np.testing.assert_allclose(in_ms["time"], adapters.from_table(frame, **TestTables.HOW)["time"])


class TestDegrees:
    """Differences of angles are folded at a turn, so that degrees must not be taken for rad."""

    HOW: ClassVar[Arguments] = {"estimate": ["x", "yaw"], "truth": ["gx", "gyaw"], "angles": "yaw"}
    P: ClassVar[Array] = np.array([[0.04, 0.002], [0.002, 0.01]])

    @classmethod
    def frames(cls) -> tuple[pd.DataFrame, pd.DataFrame]:
        """A turning robot in rad, and in deg."""
        rng = np.random.default_rng(12)
        t = np.arange(600.0) / 10
        truth = np.c_[np.sin(t), np.remainder(0.5 * t + np.pi, 2 * np.pi) - np.pi]
        estimate = truth + rng.multivariate_normal(np.zeros(2), cls.P, 600)
        estimate[:, 1] = np.remainder(estimate[:, 1] + np.pi, 2 * np.pi) - np.pi
        rad = pd.DataFrame(np.c_[t, estimate, truth], columns=["t", "x", "yaw", "gx", "gyaw"])
        rad = rad.assign(sx=0.2, syaw=0.1, vx=0.04, vyaw=0.01, xx=0.04, xyaw=0.002, yawyaw=0.01)
        turn = np.degrees(1.0)
        powers = {"yaw": 1, "gyaw": 1, "syaw": 1, "vyaw": 2, "xyaw": 1, "yawyaw": 2}
        return rad, rad.assign(**{name: rad[name] * turn**power for name, power in powers.items()})

    SPREADS: ClassVar[dict[str, Any]] = {"sigma": ["sx", "syaw"], "variance": ["vx", "vyaw"],
                                         "covariance": ["xx", "xyaw", "yawyaw"]}  # fmt: skip

    @pytest.mark.parametrize("spread", SPREADS)
    def test_all_are_converted_together(self, spread: str) -> None:
        rad, deg = self.frames()
        how = {**self.HOW, spread: self.SPREADS[spread]}
        expected = adapters.from_table(rad, **how)
        refused(r"yaw, an angle, .*: in degrees\? Say units yaw=deg, or yaw=rad", adapters.from_table, deg, **how)
        del how["angles"]
        for arguments in (
            adapters.from_table(deg, **how, units={"yaw": "deg"}),
            adapters.from_table(deg, deg, **how, time="t", units={"yaw": "deg"}),
        ):
            np.testing.assert_allclose(arguments["error"], expected["error"], atol=1e-12)
            np.testing.assert_allclose(arguments["covariance"], expected["covariance"], rtol=1e-12)
        whole = adapters.from_table(deg.assign(x=1e3 * deg.x, gx=1e3 * deg.gx), **how, units={"x": "mm", "yaw": "deg"})
        np.testing.assert_allclose(whole["error"], expected["error"], atol=1e-12)
        assert whole["component_units"] == ["m", "rad"]

    def test_what_cannot_be_rad(self) -> None:
        rad, deg = self.frames()
        sigma: Any = {"sigma": "s", "angles": "e"}
        rng = np.random.default_rng(13)
        for error, of in ((rng.normal(0, 4, 500), 0.1), (rng.normal(0, 1, 500), 5.0)):
            with pytest.raises(credence.InputError, match=r"e, an angle, has .*: in degrees\? Say units e=deg"):
                adapters.from_table({"e": error, "s": np.full(500, of)}, error="e", **sigma)
        two = {"e": rng.normal(0, 1.5, 500), "s": np.full(500, 1.5)}
        with pytest.warns(UserWarning, match="of 500 differences are beyond half a turn .* say units e=deg"):
            adapters.from_table(two, error="e", **sigma)
        slow = deg.assign(yaw=deg.t + rng.normal(0, 3, 600), gyaw=deg.t)
        refused("yaw, an angle, has numbers up to", adapters.from_table, slow, **self.HOW, variance=["vx", "vx"])
        with pytest.raises(credence.InputError, match=r"yaw, an angle, goes from .* wrapped at 360"):
            adapters.from_table(rad, deg, **self.HOW, variance=["vx", "vyaw"], time="t")

    @pytest.mark.filterwarnings("error")
    def test_angles_in_rad_are_taken(self) -> None:
        rad, _ = self.frames()
        how = {**self.HOW, "sigma": ["sx", "syaw"]}
        expected = adapters.from_table(rad, **how)["error"]
        unwrapped = rad.assign(gyaw=np.unwrap(rad.gyaw))
        assert unwrapped.gyaw.max() > 20
        np.testing.assert_allclose(adapters.from_table(unwrapped, **how)["error"], expected, atol=1e-12)
        np.testing.assert_allclose(adapters.from_table(rad, unwrapped, **how, time="t")["error"], expected, atol=1e-12)
        lost = rad.assign(yaw=np.random.default_rng(2).uniform(-40, 40, 600))
        assert np.abs(adapters.from_table(lost, **how, units={"yaw": "rad"})["error"]).max() <= np.pi

    def test_on_a_manifold(self, tmp_path: Path) -> None:
        rad, deg = self.frames()
        P = np.tile(self.P, (600, 1, 1))
        for frame, is_refused in ((rad, False), (deg, True)):
            given: Any = {"estimate": frame[["x", "yaw"]].to_numpy(), "truth": frame[["gx", "gyaw"]].to_numpy()}
            given |= {"covariance": P, "manifold": "R1 x SO2", "chart": "local"}
            if not is_refused:
                assert credence.judge(**given)["trials"] == 1
                credence.judge(**given, component_units=["m", "rad"])
                continue
            refused(r"estimate: has angles up to .* in degrees. Give", credence.judge, **given)
            write_record(str(tmp_path / "deg.h5"), given)
            refused(r"deg.h5: /estimate: has angles up to .* the attribute", credence.judge, tmp_path / "deg.h5")
            refused("component_units: has `deg` for theta, an", credence.judge, **given, component_units=["m", "deg"])


class TestWhatFilesLack:
    def test_kitti_with_all_rows(self, tmp_path: Path) -> None:
        of = log(40)
        behind, times = of.covariance.reshape(-1, 36), write(tmp_path / "times.txt", of.time)
        upper = of.covariance[(slice(None), *np.triu_indices(6))]
        truth = tum(tmp_path, of)[1]
        both = [(rows, cov) for rows in (3, 4) for cov in (behind, upper)]
        files = [write(tmp_path / f"{n}{cov.shape[1]}.txt", np.c_[kitti(of.pose, n), cov]) for n, cov in both]
        expected, *others = (adapters.from_kitti(file, truth, times) for file in files)
        for other in others:
            np.testing.assert_allclose(other["estimate"], expected["estimate"])
            np.testing.assert_allclose(other["covariance"], expected["covariance"], rtol=1e-9)

    def test_a_truth_that_lacks_lines(self, tmp_path: Path) -> None:
        of = log(40)
        estimate = write(tmp_path / "kitti.txt", np.c_[kitti(of.pose), of.covariance.reshape(-1, 36)])
        truth = write(tmp_path / "poses.txt", kitti(of.pose)[np.arange(40) != 7])
        times = write(tmp_path / "times.txt", of.time)
        refused(r"poses.txt: it has 39 poses, and .*kitti.txt 40. Give the true", adapters.from_kitti, estimate, truth)
        refused(r"times.txt: it has 40 times, and .*poses.txt 39 poses", adapters.from_kitti, estimate, truth, times)
        refused(r"kitti.txt: it has no times, and .*\(times\)", adapters.from_kitti, estimate, tum(tmp_path, of)[1])

    @pytest.mark.parametrize("more", [4, 8])
    def test_lines_of_tum_with_as_many_numbers_as_kitti_s(self, tmp_path: Path, more: int) -> None:
        of = log(40)
        estimate, truth = tum(tmp_path, of)
        wide = write(tmp_path / "wide.txt", np.c_[of.truth_rows(), np.ones((len(of.truth), more))])
        with pytest.warns(UserWarning, match=f"its lines have {8 + more} numbers and are no matrices"):
            found = adapters.from_tum(estimate, wide)["truth"]
        np.testing.assert_array_equal(found, adapters.from_tum(estimate, truth)["truth"])
        with (
            pytest.warns(UserWarning, match="no matrices of KITTI"),
            pytest.raises(credence.InputError, match="its poses have no covariances"),
        ):
            adapters.from_tum(write(tmp_path / "e.txt", np.c_[of.time, of.pose, np.ones((40, more))]), truth)
        neither = write(tmp_path / "neither.txt", np.random.default_rng(1).normal(size=(40, 8 + more)))
        refused(r"neither.txt: its lines .* begin neither with a rotation", adapters.from_tum, neither, truth)

    def test_columns_named_twice(self, tmp_path: Path) -> None:
        (tmp_path / "a.csv").write_text("x,y,y,s\n1,2,3,1\n1,2,3,1\n")
        one = pd.DataFrame([[1.0, 2, 3, 1]] * 2, columns=["x", "y", "y", "s"])
        for table in (tmp_path / "a.csv", one):
            assert adapters.from_table(table, error="x", sigma="s")["error"].shape == (1, 2, 1)
            refused(r"2 columns are called y. Rename", adapters.from_table, table, error=["x", "y"], sigma=["s", "s"])
        refused("x is named as two components", adapters.from_table, one, error=["x", "x"], sigma=["s", "s"])

    def test_negative_sigmas(self, tmp_path: Path) -> None:
        table = {"e": np.zeros(5), "s": np.array([1.0, 1, -0.5, 1, -2])}
        refused(r"sigma \(s\) is below 0 at row 3 \(-0.5\), and at 2", adapters.from_table, table, error="e", sigma="s")
        rows = np.c_[np.arange(4.0), np.tile([0, 0, 0, 1], (4, 1)), np.ones((4, 12))]
        files = [write(tmp_path / name, rows) for name in ("estimate", "truth")]
        with pytest.raises(credence.InputError, match="deviation: a standard deviation is below 0 at row 1"):
            adapters.from_openvins(*files, write(tmp_path / "deviation", np.c_[rows[:, 0], -rows[:, 1:]]))

    @pytest.mark.parametrize("kind", ["tum", "bag", "kitti"])
    def test_poses_that_are_none(self, tmp_path: Path, kind: str) -> None:
        of = log(60)
        truth = write(tmp_path / "truth.txt", of.truth_rows())

        def read(of: Log) -> Arguments:
            if kind == "bag":
                bag = write_bag(tmp_path / f"{of.pose[0, 3]}.bag", of, "ros1", truth="pose")
                return adapters.from_rosbag(bag, truth)
            if kind == "tum":
                return adapters.from_tum(write(tmp_path / "e.txt", of.rows()), truth)
            rows = np.c_[kitti(log(60).pose), of.covariance.reshape(-1, 36)]
            rows[np.isnan(of.pose[:, 0]), :12] = np.nan
            rows[np.linalg.norm(of.pose[:, 3:], axis=1) < 0.5, :3] = 0
            return adapters.from_kitti(write(tmp_path / "k.txt", rows), truth, write(tmp_path / "t.txt", of.time))

        for values, message in (
            (np.nan, r"pose 1 of 60, the first of 3, is not finite. Leave out what was written before"),
            (0, "begin neither with a rotation" if kind == "kitti" else r"pose 1 of 60 has a quaternion of length 0 "),
        ):
            pose = of.pose.copy()
            pose[:3, 0 if np.isnan(values) else 3 :] = values
            refused(message, read, of._replace(pose=pose))

    def test_a_truth_with_gaps(self, tmp_path: Path) -> None:
        of = log(60)
        rows = of.truth_rows()
        rows[200:203, 1:] = np.nan
        truth = write(tmp_path / "gaps.txt", rows)
        with pytest.warns(UserWarning, match=rf"gaps.txt: 3 of {len(rows)} true poses are not finite"):
            arguments = adapters.from_tum(tum(tmp_path, of)[0], truth)
        assert np.isfinite(arguments["truth"]).all()
        rows[:, 4:] = 0
        with pytest.raises(credence.InputError, match=r"zeros.txt: pose 1 of .* has a quaternion of length 0"):
            adapters.from_tum(tum(tmp_path, of)[0], write(tmp_path / "zeros.txt", rows[:200]))


class TestLongLogs:
    """More than 99,999 steps: everything over the steps is of all of them, and what is by step of every so many."""

    STEPS = 120_000

    @classmethod
    def arrays(cls) -> tuple[Array, Array]:
        error = np.random.default_rng(14).normal(size=(cls.STEPS, 2))
        error[5] += 7  # at no step that is given
        return error, np.broadcast_to(np.eye(2), (cls.STEPS, 2, 2))

    def test_all_steps_count(self) -> None:
        error, covariance = self.arrays()
        innovations = {"innovation": error, "innovation_covariance": covariance}
        verdict = credence.judge(error, covariance, **innovations, time=0.01 * np.arange(self.STEPS))
        every, (group, *_) = verdict["every"], verdict["groups"]
        assert every == 12
        nees = (error**2).sum(axis=1)
        np.testing.assert_allclose(group["anees"]["ratio"], nees[::every] / 2, rtol=1e-12)
        segment = verdict["segments"]["steps"]
        count = verdict["segments"]["count"]
        assert count == self.STEPS // segment
        assert group["nees_ratio"] == pytest.approx(nees[: count * segment].mean() / 2, rel=1e-12)
        assert verdict["pose_error"]["mean"] == pytest.approx(nees.sum(), rel=1e-12)
        assert f"one step in {every}: their step k is step {every} (k - 1) + 1" in " ".join(verdict["not_judged"])
        assert "one log of 120000 steps" in str(verdict)
        assert "Errors by step" in verdict.html
        short = credence.judge(error[:99_999], covariance[:99_999])
        assert "every" not in short.json[0]
        assert len(short["groups"][0]["anees"]["ratio"]) == 99_999

    def test_a_run_that_does_not_decorrelate(self) -> None:
        walk = np.cumsum(np.random.default_rng(15).normal(size=(self.STEPS, 1)), axis=0)
        verdict = credence.judge(walk, np.full((self.STEPS, 1), 1e5), segments="off")
        assert verdict["groups"][0]["nees_ratio"] == pytest.approx(np.mean(walk**2) / 1e5, rel=1e-12)

    def test_a_failure_at_a_step_that_is_not_given(self) -> None:
        error, covariance = self.arrays()
        broken = covariance.copy()
        broken[77_777] = 0
        verdict = credence.judge(error, broken)
        assert verdict.verdict == "failed"
        assert verdict["troubles"][0]["step"] == 77_777

    def test_as_many_numbers_as_no_memory_holds_are_refused(self) -> None:
        steps, n = 10**7, 40
        error, covariance = np.broadcast_to(np.ones(n), (steps, n)), np.broadcast_to(np.eye(n), (steps, n, n))
        refused("and 40 components at 10000000 steps, together", credence.judge, error, covariance)


def test_navlie_s_results() -> None:
    rng = np.random.default_rng(7)
    runs = [
        SimpleNamespace(stamp=np.arange(k), error=rng.normal(size=(k, 3)), covariance=np.tile(np.eye(3), (k, 1, 1)))
        for k in (5, 4)
    ]
    arguments = adapters.from_navlie(SimpleNamespace(trial_results=runs))
    assert arguments["steps"].tolist() == [5, 4]
    np.testing.assert_array_equal(arguments["error"][0], -runs[0].error)
    assert adapters.from_navlie(runs[0])["error"].shape == (1, 5, 3)
    refused("there are no results", adapters.from_navlie, [])


class TestCommand:
    @staticmethod
    def run(*words: object) -> subprocess.CompletedProcess[str]:
        return python("-m", "credence", "judge", *words)

    def test_a_bag_with_its_truth(self, tmp_path: Path) -> None:
        bag = write_bag(tmp_path / "run.bag", log(scale=0.25), "ros1", truth="pose")
        arguments = adapters.from_rosbag(bag)
        said = self.run("run.bag", "--margin", "10%", "--require=no-finding")
        assert said.returncode == 1
        assert str(credence.judge(**arguments, margin="10%", name="run.bag.h5")).startswith(said.stdout)
        assert "optimistic" in said.stdout

    def test_formats_and_options(self, tmp_path: Path) -> None:
        tum(tmp_path, log())
        said = self.run(
            "estimate.txt", "--truth", "truth.txt", "--manifold", "R3 x SO3", "--chart=global",
            "--require", "no-finding", "--format", "json", "-o", "verdict.json", "--record", "kept.h5",
        )  # fmt: skip
        assert (said.returncode, said.stdout, said.stderr) == (0, "", "")
        assert (tmp_path / "verdict.json").read_text() == self.run("kept.h5", "--format=json").stdout
        assert not self.run("kept.h5", "-o", "verdict.txt").stderr  # of the program: a record is no log
        TestTables.frame().to_csv(tmp_path / "table.csv")
        names = ["estimate=x,y,a", "truth=gx,gy,ga", "sigma=s,s,s", "angles=a", "time=t"]
        assert "one log of 200 steps" in self.run("table.csv", "--names", *names).stdout

    @pytest.mark.parametrize("option", ["-o", "--record"])
    @pytest.mark.parametrize("read", ["estimate.h5", "truth.h5", "linked.h5", "bag/run.db3"])
    def test_what_is_read_is_not_replaced(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str], option: str, read: str
    ) -> None:
        tum(tmp_path, log(20))
        monkeypatch.chdir(tmp_path)
        (tmp_path / "bag").mkdir()
        for name, link in (("truth.txt", "truth.h5"), ("estimate.txt", "estimate.h5"), ("estimate.h5", "linked.h5")):
            (tmp_path / link).symlink_to(name)
        (tmp_path / "bag" / "run.db3").write_text("a bag")
        logs = ["bag"] if read.startswith("bag") else ["estimate.txt", "--truth", "truth.txt"]
        output = "bag/../bag/run.db3" if read.startswith("bag") else read
        if option == "--record" and read.startswith("bag"):
            (tmp_path / "bag" / "run.db3").rename(tmp_path / "bag" / "run.h5")
            output = "bag/run.h5"
        before = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
        assert judge_command([*logs, option, output, "--overwrite"]) == 2
        assert f"cannot write {output} (it would replace " in capfd.readouterr().err
        assert judge_command([*logs, option, "nowhere/new.h5"]) == 2
        assert "there is no folder" in capfd.readouterr().err
        assert {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()} == before

    def test_one_file_is_not_written_twice(self, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
        tum(tmp_path, log(20))
        words = [tmp_path / "estimate.txt", "--truth", tmp_path / "truth.txt", "-o", tmp_path / "a.h5"]
        assert judge_command([*map(str, words), "--record", str(tmp_path / "a.h5")]) == 2
        assert "(-o writes it, too)" in capfd.readouterr().err

    @pytest.mark.parametrize(
        ("words", "message"),
        [
            (["estimate.txt"], "poses need a truth. Give --truth FILE"),
            (["estimate.txt", "--truth", "nowhere.txt"], "nowhere.txt: the file: cannot be found. Check the path."),
            (["estimate.txt", "--truth", "truth.txt", "--topic", "/a"], "--topic: says nothing about a log"),
            (["estimate.txt", "a.ulg", "--truth", "truth.txt"], "several formats"),
            (["estimate.txt", "--truth", "truth.txt", "--margin", "x"], "--margin"),
            (["table.csv", "--names", "error=x", "sd=s"], "--names: unknown sd"),
            (["table.csv", "--names", "error=x", "error=y", "sigma=s"], "--names: error is given twice"),
            (["table.csv", "--names", "error=x", "sigma=s", "--units", "y=deg"], "judge: --units: y is nothing that"),
            (["table.csv", "--names", "error=a", "sigma=s", "angles=a"], "in degrees? Say --units a=deg, or a=rad"),
            (["table.csv", "--names", "error=x", "sigma=s", "--pair"], "invalid --pair (two filters have estimates)"),
            (["a.npz", "--units", "a=deg"], "--units: says nothing about a log of this kind"),
            (["estimate.txt", "--truth", "truth.txt", "--max-gap", "1e-9"], "or a larger --max-gap"),
        ],
    )
    def test_refusals(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str],
        words: list[str], message: str,
    ) -> None:  # fmt: skip
        tum(tmp_path, log(20))
        (tmp_path / "table.csv").write_text("a,x,y,s\n" + "20,1,2,3\n-9,2,3,4\n")
        monkeypatch.chdir(tmp_path)
        assert judge_command(words) == 2
        said = capfd.readouterr()
        assert message in said.err
        assert len(said.err.splitlines()) == 1
        assert not said.out

    def test_the_page_names_the_log_and_how_it_was_read(self, tmp_path: Path) -> None:
        folder = tmp_path / "my logs"
        folder.mkdir()
        _, deg = TestDegrees.frames()
        deg.to_csv(folder / "drive.csv")
        words = ["my logs/drive.csv", "--names", "estimate=x,yaw", "truth=gx,gyaw", "sigma=sx,syaw", "time=t"]
        words += ["--units=yaw=deg"]
        assert not self.run(*words, "--margin=10%", "--format=html", "-o", "page.html").stderr
        page = (tmp_path / "page.html").read_text()
        (line,) = [line for line in html.unescape(page).splitlines() if "--format html -o page.html" in line]
        program, judge, *again = shlex.split(line.partition("<code>")[2].partition("</code>")[0])
        assert [program, judge, *again[: len(words)]] == ["credence", "judge", *words]
        assert "drive.csv.h5" not in page.partition('<h2 id="provenance">')[2]
        (tmp_path / "page.html").rename(tmp_path / "before.html")
        assert not self.run(*again).stderr
        assert (tmp_path / "page.html").read_text() == page
        files = tum(tmp_path, log(60))
        poses = [files[0].name, f"--truth={files[1].name}", "--chart=local", "--max-gap=0.5", "--planar=no"]
        assert not self.run(*poses, "--format=html", "-o", "poses.html", "--record=kept.h5").stderr
        assert f"credence judge {shlex.join(poses)} --margin" in html.unescape((tmp_path / "poses.html").read_text())


class TestPage:
    """docs/logs.md, on files as it names them."""

    @pytest.fixture
    def _files(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.chdir(tmp_path)
        of = log()
        write_bag(tmp_path / "run.bag", of, "ros1", truth="pose")
        ros2 = write_bag(tmp_path / "ros2", of, "mcap")
        next(ros2.glob("*.mcap")).rename("run.mcap")
        tum(tmp_path, of)
        for seed, name in enumerate("ab", 1):
            write(tmp_path / f"{name}.txt", log(seed=seed).rows())
        euroc(tmp_path / "estimate.csv", of.time, of.pose, of.covariance.reshape(-1, 36))
        euroc(tmp_path / "data.csv", of.truth_time, of.truth)
        write(tmp_path / "kitti.txt", np.c_[kitti(of.pose), of.covariance.reshape(-1, 36)])
        write(tmp_path / "poses.txt", kitti(of.pose))
        write(tmp_path / "times.txt", of.time)
        turn = np.degrees(1.0)
        frame = self.frame()
        frame = frame.assign(yaw=turn * frame.yaw, gyaw=turn * frame.gyaw, syaw=turn * frame.syaw)
        frame.assign(dx=frame.x - frame.gx, dy=frame.y - frame.gy).to_csv("table.csv")
        both = np.c_[of.time, of.pose[:, [0, 1, 2, 6, 3, 4, 5]], truth_at(of.time - 100)[:, [0, 1, 2, 6, 3, 4, 5]]]
        names = ["t", *"xyz", *(f"q{a}" for a in "wxyz"), *"XYZ", *(f"Q{a}" for a in "WXYZ")]
        sigmas = dict(zip(("sx", "sy", "sz", "sa", "sb", "sc"), np.sqrt(np.diag(of.covariance[0]))))
        pd.DataFrame(both, columns=names).assign(**sigmas).to_csv("poses.csv")
        page = (Path(__file__).parents[2] / "docs" / "logs.md").read_text(encoding="utf-8")
        Path("drive.toml").write_text(page.split("```toml\n")[1].split("```")[0], encoding="utf-8")
        self.drive().to_csv("drive.csv")
        scipy.io.savemat("results.mat", {"e": np.ones((2, 30)), "P": np.tile(np.eye(2)[:, :, None], (1, 1, 30))})
        head = "%  GPST latitude(deg) longitude(deg) height(m) Q ns sdn(m) sde(m) sdu(m) sdne(m) sdeu(m) sdun(m)"
        rows = [f"2356 {i}.0 35.16 139.61 70.{i % 7} 1 9 .1 .1 .3 .02 -.01 .02" for i in range(40)]
        Path("rover.pos").write_text("\n".join([head, *rows]))
        TestUlog.write(tmp_path / "flight.ulg", ("ekf2_innovations",))

    @classmethod
    def drive(cls) -> pd.DataFrame:
        names = {"x": "East (m)", "y": "North, m", "yaw": "Heading", "gx": "RefE", "gy": "RefN", "gyaw": "RefHdg"}
        of = {"p11": 0.01, "p12": 0.0, "p13": 0.0, "p22": 0.01, "p23": 0.0, "p33": 0.01 * np.degrees(1.0) ** 2}
        frame = cls.frame()
        frame = frame.assign(**of, track=1, GPST=pd.Timestamp("2024-05-06") + pd.to_timedelta(frame.t, "s"))
        return frame.assign(yaw=np.degrees(frame.yaw), gyaw=np.degrees(frame.gyaw)).rename(columns=names)

    @staticmethod
    def frame() -> pd.DataFrame:
        names = {"a": "yaw", "ga": "gyaw"}
        return TestTables.frame().rename(columns=names).assign(sx=0.1, sy=0.1, syaw=0.1)

    @pytest.mark.usefixtures("_files")
    @pytest.mark.filterwarnings("ignore")
    def test_commands_and_code(self, capfd: pytest.CaptureFixture[str]) -> None:
        page = (Path(__file__).parents[2] / "docs" / "logs.md").read_text(encoding="utf-8")
        code = {name: page.split(f"```{name}\n")[1].split("```")[0] for name in ("sh", "python")}
        commands = [shlex.split(line, comments=True) for line in code["sh"].splitlines() if line.startswith("python")]
        assert len(commands) == 14
        for _, _, _, _, *words in commands:
            assert judge_command(words) == 0, capfd.readouterr().err
            assert "one log of " in capfd.readouterr().out
        exec(code["python"], {"frame": self.frame()})
        assert capfd.readouterr().out.count("A consistent filter has NEES/dim 1") == 3
