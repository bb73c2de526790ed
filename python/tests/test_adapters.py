"""The adapters, on small files and objects whose numbers were computed by hand or by other programs."""

from __future__ import annotations

import warnings
from datetime import datetime, timedelta
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import scipy.io
from conftest import refused
from evo.core import metrics, sync
from evo.tools import file_interface

import credence
from credence import adapters

HALF = np.sqrt(0.5)
Arguments = dict[str, Any]


def write(path: Path, rows: Any) -> Path:
    np.savetxt(path, np.atleast_2d(rows), header="written by a test")
    return path


def nees(arguments: Arguments, group: str = "all") -> list[float]:
    """What judge has as the mean NEES of each step, not divided by the dimension."""
    found = next(one for one in credence.judge(**arguments)["groups"] if one["group"] == group)
    return [ratio * found["dimension"] for ratio in found["anees"]["ratio"]]


def tum_pair(folder: Path, covariance: np.ndarray) -> tuple[list[Path], Path]:
    """Two runs of two poses. The truth stands at the origin, and then at x = 1 turned by 90 degrees about z."""
    truth = write(folder / "truth.txt", [[0, 0, 0, 0, 0, 0, 0, 1], [1, 1, 0, 0, 0, 0, HALF, HALF]])
    first = np.r_[0, 0.2, 0, 0, 0, 0, 0, 1, covariance]
    second = np.r_[1, 1, 0.1, 0, 0, 0, HALF, HALF, covariance]  # its error is 0.1 along the body's own x
    return [write(folder / f"run{i}.txt", [first, second]) for i in (0, 1)], truth


class TestTum:
    P = np.diag([4.0, 1, 1, 1, 1, 1]) / 100 + 0.001

    def test_nees_by_hand(self, tmp_path: Path) -> None:
        estimates, truth = tum_pair(tmp_path, self.P.ravel())
        information = np.linalg.inv(self.P)[0, 0]
        by_hand = [0.2**2 * information, 0.1**2 * information]
        assert nees(adapters.from_tum(estimates, truth)) == pytest.approx(by_hand, rel=1e-12)

    def test_a_truth_that_bends_between_its_poses_is_noted(self, tmp_path: Path) -> None:
        def circle(times: np.ndarray) -> np.ndarray:
            still = np.zeros((len(times), 4))
            return np.column_stack([times, np.cos(times), np.sin(times), still, np.ones(len(times))])

        at = np.arange(0.5, 19.5, 0.1)
        estimate = write(tmp_path / "run.txt", np.hstack([circle(at), np.tile(self.P.ravel(), (len(at), 1))]))
        for rate, said in ((1, True), (100, False)):
            times = np.arange(0, 20, 1 / rate)
            truth = write(tmp_path / "truth.txt", circle(times))
            with warnings.catch_warnings(record=True) as notes:
                warnings.simplefilter("always")
                error = adapters.from_tum(estimate, truth, max_gap=1.5)
            of_P = np.linalg.norm((error["estimate"] - error["truth"])[0, :, :3], axis=1) / np.sqrt(0.063)
            told = [str(one.message) for one in notes if "sigma of P by their bends" in str(one.message)]
            assert len(told) == said, told
            if said:
                share = float(told[0].split(" straight lines miss ")[1].split()[0])
                assert share == pytest.approx(np.median(of_P), rel=0.1)

    def test_the_world_s_frame(self, tmp_path: Path) -> None:
        estimates, truth = tum_pair(tmp_path, self.P.ravel())
        second = nees(adapters.from_tum(estimates, truth, manifold="R3 x SO3"))[1]
        assert second == pytest.approx(0.1**2 * np.linalg.inv(self.P)[1, 1], rel=1e-12)

    def test_upper_triangle(self, tmp_path: Path) -> None:
        distinct = self.P + np.arange(36).reshape(6, 6) / 1e4
        P = (distinct + distinct.T) / 2
        full = adapters.from_tum(*tum_pair(tmp_path, P.ravel()))
        triangle = adapters.from_tum(*tum_pair(tmp_path, P[np.triu_indices(6)]))
        np.testing.assert_array_equal(full["covariance"], triangle["covariance"])

    def test_runs_that_end_early(self, tmp_path: Path) -> None:
        estimates, truth = tum_pair(tmp_path, self.P.ravel())
        write(estimates[1], np.loadtxt(estimates[1])[0])
        arguments = adapters.from_tum(estimates, truth)
        assert arguments["steps"].tolist() == [2, 1]
        assert arguments["truth"].shape == (2, 2, 7)
        assert credence.judge(**arguments)["failed_trials"] == 0

    def test_poses_without_a_truth_are_left_out(self, tmp_path: Path) -> None:
        estimates, truth = tum_pair(tmp_path, self.P.ravel())
        rows = np.loadtxt(estimates[0])
        write(estimates[0], [rows[0], np.r_[0.5, rows[0, 1:]], rows[1]])
        with pytest.warns(UserWarning, match=r"run0.txt: 1 of 3 poses have no truth within a gap of 0.2 s"):
            assert adapters.from_tum(estimates[0], truth)["time"].tolist() == [[0, 1]]

    def test_quaternions_are_made_unit(self, tmp_path: Path) -> None:
        estimates, truth = tum_pair(tmp_path, self.P.ravel())
        rows = np.loadtxt(estimates[0])
        write(estimates[0], np.hstack([rows[:, :4], rows[:, 4:8].round(3), rows[:, 8:]]))
        norms = np.linalg.norm(adapters.from_tum(estimates[0], truth)["estimate"][..., 3:], axis=-1)
        np.testing.assert_allclose(norms, 1, rtol=1e-15)

    @pytest.mark.parametrize(
        ("text", "message"),
        [
            ("0 0 0 0 0", r"its lines have 5 numbers \(must be at least 8\)"),
            ("0 0 0 0 0 0 0 0", "its poses have no covariances"),
            ("9 0 0 0 0 0 0 1" + " 0" * 36, r"no pose has a truth .* \(its times are 9 to 9 s, those of .*0 to 1 s\)"),
            ("# time x y z", "there are no numbers in it"),
            ("1 2 three", ".*three"),
        ],
    )
    def test_refusals(self, tmp_path: Path, text: str, message: str) -> None:
        _, truth = tum_pair(tmp_path, self.P.ravel())
        (tmp_path / "run.txt").write_text(text + "\n")
        refused(f"run.txt: {message}", adapters.from_tum, tmp_path / "run.txt", truth)

    def test_beside_evo(self, tmp_path: Path) -> None:
        rng = np.random.default_rng(5)
        poses = [np.hstack([rng.normal(size=(count, 3)), rng.normal(size=(count, 4))]) for count in (60, 50)]
        for each in poses:
            each[:, 3:] /= np.linalg.norm(each[:, 3:], axis=1, keepdims=True)
        times = np.arange(60) / 10
        between = np.sort(rng.uniform(0, 5.9, 50))
        truth = write(tmp_path / "truth.txt", np.c_[times, poses[0]])
        estimate = write(tmp_path / "estimate.txt", np.c_[between, poses[1], np.tile(np.eye(6).ravel(), (50, 1))])
        plain = write(tmp_path / "plain.txt", np.c_[between, poses[1]])
        read = file_interface.read_tum_trajectory_file
        how = {"sync_method": sync.SyncMethod.interpolation, "max_diff": 0.1}
        matched = sync.associate_trajectories(read(str(truth)), read(str(plain)), **how)
        arguments = adapters.from_tum(estimate, truth, manifold="R3 x SO3")
        np.testing.assert_array_equal(arguments["time"][0], matched[1].timestamps)
        np.testing.assert_allclose(arguments["truth"][0, :, :3], matched[0].positions_xyz, rtol=0, atol=1e-12)
        np.testing.assert_allclose(arguments["estimate"][0, :, :3], matched[1].positions_xyz)
        ape = metrics.APE(metrics.PoseRelation.rotation_angle_rad)
        ape.process_data(matched)
        both = {name: np.repeat(value, 2, axis=0) for name, value in arguments.items() if isinstance(value, np.ndarray)}
        groups = {"groups": {"rotation": [3, 4, 5]}}  # of the identity: NEES is the squared angle
        np.testing.assert_allclose(nees(arguments | both | groups, "rotation"), np.square(ape.error), rtol=1e-9)


def jpl_matrix(q: np.ndarray) -> np.ndarray:
    """The rotation matrix of a JPL quaternion (x, y, z, w) [Trawny and Roumeliotis 2005, eq. 62]."""
    x, y, z, w = q
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    matrix: np.ndarray = (2 * w * w - 1) * np.eye(3) - 2 * w * cross + 2 * np.outer(q[:3], q[:3])
    return matrix


def log(R: np.ndarray) -> np.ndarray:
    angle = np.arccos((np.trace(R) - 1) / 2)
    axis = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]) / (2 * np.sin(angle))
    vector: np.ndarray = angle * axis
    return vector


def random_states(rng: np.random.Generator, count: int, rest: int) -> tuple[np.ndarray, np.ndarray]:
    """Quaternions near each other beside numbers near each other."""
    true, estimated = rng.normal(size=(count, 4)), 0.05 * rng.normal(size=(count, 4))
    true /= np.linalg.norm(true, axis=1, keepdims=True)
    estimated += true
    estimated /= np.linalg.norm(estimated, axis=1, keepdims=True)
    numbers = rng.normal(size=(count, rest))
    return np.hstack([true, numbers]), np.hstack([estimated, numbers + 0.1 * rng.normal(size=(count, rest))])


class TestOpenVins:
    def test_trajectories_have_the_nees_of_ov_eval(self, tmp_path: Path) -> None:
        rng = np.random.default_rng(7)
        true, estimated = random_states(rng, 5, 3)
        roots = rng.normal(size=(2, 3, 3))
        orientation, position = (root @ root.T + np.eye(3) for root in roots)
        behind = np.r_[orientation[np.triu_indices(3)], position[np.triu_indices(3)]]
        times = np.arange(5.0)
        truth = write(tmp_path / "truth.txt", np.c_[times, true[:, 4:], true[:, :4]])
        rows = np.c_[times, estimated[:, 4:], estimated[:, :4], np.tile(behind, (5, 1))]
        estimate = write(tmp_path / "estimate.txt", rows)
        arguments = adapters.from_openvins([estimate] * 2, truth)
        errors = [-log(jpl_matrix(t[:4]) @ jpl_matrix(e[:4]).T) for t, e in zip(true, estimated)]  # as ov_eval has it
        expected = [e @ np.linalg.solve(orientation, e) for e in errors]
        assert nees(arguments, "orientation") == pytest.approx(expected, rel=1e-9)
        moved = estimated[:, 4:] - true[:, 4:]
        expected = [e @ np.linalg.solve(position, e) for e in moved]
        assert nees(arguments, "position") == pytest.approx(expected, rel=1e-9)

    def test_simulations(self, tmp_path: Path) -> None:
        rng = np.random.default_rng(8)
        true, estimated = random_states(rng, 4, 12)
        sigma, times, calibration = rng.uniform(0.5, 2, (4, 15)), np.arange(4.0), np.ones((4, 3))
        files = [
            write(tmp_path / f"state_{name}.txt", np.c_[times, rows, calibration])
            for name, rows in (("estimate", estimated), ("groundtruth", true), ("deviation", sigma))
        ]
        arguments = adapters.from_openvins(*([file] * 2 for file in files))
        errors = np.array([-log(jpl_matrix(t[:4]) @ jpl_matrix(e[:4]).T) for t, e in zip(true, estimated)])
        assert arguments["covariance"][0] == pytest.approx(sigma**2)
        assert nees(arguments, "ry") == pytest.approx((errors[:, 1] / sigma[:, 1]) ** 2, rel=1e-9)
        velocity = (estimated[:, 9] - true[:, 9]) / sigma[:, 8]
        assert nees(arguments, "vz") == pytest.approx(velocity**2, rel=1e-9)

    def test_simulations_at_other_times(self, tmp_path: Path) -> None:
        files = [write(tmp_path / name, np.ones((2, 17))) for name in ("estimate", "deviation")]
        truth = write(tmp_path / "truth", 2 * np.ones((2, 17)))
        with pytest.raises(ValueError, match=r"truth: its times are not those of .*estimate"):
            adapters.from_openvins(files[0], truth, files[1])


class TestNpz:
    def test_arguments_come_back(self, tmp_path: Path) -> None:
        rng = np.random.default_rng(9)
        error, covariance = rng.normal(size=(40, 3, 2)), np.broadcast_to(np.eye(2), (40, 3, 2, 2))
        np.savez(tmp_path / "a.npz", e=error, covariance=covariance, groups="first 0, second 1", other=3)
        arguments = adapters.from_npz(tmp_path / "a.npz", {"error": "e"})
        assert sorted(arguments) == ["covariance", "error", "groups"]
        assert credence.judge(**arguments).json == credence.judge(error, covariance, groups="first 0, second 1").json

    def test_groups_as_an_array_of_texts(self, tmp_path: Path) -> None:
        error, covariance = np.random.default_rng(9).normal(size=(40, 3, 2)), np.broadcast_to(np.eye(2), (40, 3, 2, 2))
        texts = {"groups": ["both 0:2", "second 1"], "component_names": ["x", "y"]}
        np.savez(tmp_path / "a.npz", error=error, covariance=covariance, **texts)
        verdict = credence.judge(**adapters.from_npz(tmp_path / "a.npz"))
        groups = {"both": [0, 1], "second": [1]}
        assert verdict.json == credence.judge(error, covariance, groups=groups, component_names=["x", "y"]).json

    def test_groups_of_their_own(self, tmp_path: Path) -> None:
        own = np.broadcast_to(np.eye(2), (40, 3, 2, 2))
        arrays = {"error": np.zeros((40, 3, 2)), "group/pose/covariance": own}
        np.savez(tmp_path / "a.npz", allow_pickle=False, **arrays)
        arguments = adapters.from_npz(tmp_path / "a.npz")
        assert list(arguments["group_covariance"]) == ["pose"]
        np.testing.assert_array_equal(arguments["group_covariance"]["pose"], own)

    @pytest.mark.parametrize("suffix", ["npz", "mat"])
    def test_options_do_not_come_from_data(self, tmp_path: Path, suffix: str) -> None:
        rng = np.random.default_rng(9)
        arrays: dict[str, Any] = {"error": rng.normal(size=(40, 3, 2)), "covariance": np.tile(np.eye(2), (40, 3, 1, 1))}
        options = {"bias": 2.0, "failed": 0.7, "margin": 0.5, "margin_direction": 0.9, "name": "x", "segments": 2.0}
        path = tmp_path / f"a.{suffix}"
        np.savez(path, **arrays, **options) if suffix == "npz" else scipy.io.savemat(path, {**arrays, **options})
        read: Any = adapters.from_npz if suffix == "npz" else adapters.from_mat
        with pytest.warns(UserWarning, match=f"a.{suffix}: {', '.join(options)} in it are left out, because options"):
            arguments = read(path)
        assert set(arguments) == {"error", "covariance"}
        assert credence.judge(**arguments).json == credence.judge(**arrays).json
        for name in ("margin", "eror"):
            refused(rf"invalid names \({name} is no data of judge\)\. Name", read, path, {name: "error"})

    def test_only_what_is_used_is_read(self, tmp_path: Path) -> None:
        np.savez(tmp_path / "a.npz", error=np.zeros((2, 3, 1)), covariance=np.ones((2, 3, 1)), notes=np.array([{}]))
        assert set(adapters.from_npz(tmp_path / "a.npz")) == {"error", "covariance"}

    def test_refusals(self, tmp_path: Path) -> None:
        np.savez(tmp_path / "a.npz", e=np.zeros(3))
        refused("no array in it is an argument of judge", adapters.from_npz, tmp_path / "a.npz", raises=ValueError)
        with pytest.raises(ValueError, match="there is no array err in it \\(it has e\\)"):
            adapters.from_npz(tmp_path / "a.npz", {"error": "err"})
        np.savez(tmp_path / "b.npz", error=np.array([{}], dtype=object))
        refused("allow_pickle", adapters.from_npz, tmp_path / "b.npz", raises=ValueError)


class TestGtsam:
    def test_pose3_has_the_nees_of_gtsam(self) -> None:
        gtsam = pytest.importorskip("gtsam")
        rng = np.random.default_rng(10)
        roots = rng.normal(size=(4, 6, 6))
        covariance = roots @ roots.transpose(0, 2, 1) + np.eye(6)
        truth = [gtsam.Pose3.Expmap(each) for each in rng.normal(size=(4, 6))]
        estimate = [true.retract(each) for true, each in zip(truth, 0.3 * rng.normal(size=(4, 6)))]
        back = [estimated.localCoordinates(true) for estimated, true in zip(estimate, truth)]
        expected = [each @ np.linalg.solve(P, each) for each, P in zip(back, covariance)]
        arguments = adapters.from_gtsam_poses([truth] * 2, [estimate] * 2, [covariance] * 2)
        assert nees(arguments) == pytest.approx(expected, rel=1e-9)

    def test_pose2_by_hand(self) -> None:
        def pose(x: float, y: float, angle: float) -> SimpleNamespace:
            return SimpleNamespace(x=lambda: x, y=lambda: y, theta=lambda: angle)

        P = np.diag([1.0, 4, 9])
        arguments = adapters.from_gtsam_poses([[pose(0, 0, np.pi / 2)]] * 2, [[pose(0, 1, np.pi / 2)]] * 2, [[P]] * 2)
        assert nees(arguments) == pytest.approx([1.0])  # one to the front, where the variance is 1
        runs = [[pose(0, 0, 0)] * 2, [pose(0, 0, 0)]]
        assert adapters.from_gtsam_poses(runs, runs, [[P, P], [P]])["steps"].tolist() == [2, 1]
        refused("do not have the same steps", adapters.from_gtsam_poses, runs, runs, [[P, P], [P, P]])
        with pytest.raises(ValueError, match="a pose has 3 components"):
            adapters.from_gtsam_poses([[pose(0, 0, 0)]], [[pose(0, 0, 0)]], [[np.eye(6)]])


def test_stonesoup_states() -> None:
    truth = [SimpleNamespace(state_vector=np.array([[1.0], [2.0]]))]
    track = [SimpleNamespace(state_vector=np.array([[1.5], [2.0]]), covar=[[2, 1], [1, 3]])]
    arguments = adapters.from_stonesoup([truth], [track])
    assert arguments["error"].tolist() == [[[0.5, 0]]]
    assert arguments["covariance"].tolist() == [[[[2, 1], [1, 3]]]]
    refused("run 0: its track has 1 states without times, and .* 2", adapters.from_stonesoup, [truth * 2], [track])


class TestStoneSoupTimes:
    """The truth is at 0 ... 5 s, and its state is its time. The track lags behind it by 0.1."""

    @staticmethod
    def state(second: float, value: float, variance: float = 1) -> SimpleNamespace:
        start = datetime(2026, 11, 26)
        at = start + timedelta(seconds=second)
        return SimpleNamespace(timestamp=at, state_vector=np.array([[value]]), covar=[[variance]])

    def test_states_are_compared_at_the_same_times(self) -> None:
        truth = [self.state(second, second) for second in range(6)]
        late = [self.state(second, second - 0.1) for second in (2, 3, 4, 5)]
        between = [self.state(second, second - 0.1) for second in (0, 1, 1.5, 2)]
        arguments = adapters.from_stonesoup([truth, truth], [late, between])
        assert arguments["steps"].tolist() == [4, 3]
        assert arguments["error"][0].ravel() == pytest.approx(-0.1 * np.ones(4))
        assert arguments["error"][1, :3].ravel() == pytest.approx(-0.1 * np.ones(3))
        assert credence.judge(**arguments)["failed_trials"] == 0

    def test_of_a_prediction_and_its_update_the_update_counts(self) -> None:
        track = [self.state(1, 2, 9), self.state(1, 1.5, 4)]
        arguments = adapters.from_stonesoup([[self.state(1, 1)]], [track])
        assert arguments["error"].tolist() == [[[0.5]]]
        assert arguments["covariance"].tolist() == [[[[4]]]]

    def test_times_that_do_not_meet_are_refused(self) -> None:
        with pytest.raises(credence.InputError, match="run 1: no state of its track has the time of one of its truth"):
            adapters.from_stonesoup([[self.state(1, 1)]] * 2, [[self.state(1, 1)], [self.state(2, 2)]])
        untimed = SimpleNamespace(state_vector=np.array([[1.0]]), covar=[[1]])
        with pytest.raises(credence.InputError, match="run 0: some of its states have a timestamp, and some have none"):
            adapters.from_stonesoup([[untimed]], [[self.state(1, 1)]])
