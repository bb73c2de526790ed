"""What lies between a filter and its truth, or a second filter: frames, bodies, and covariances of quaternions."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import refused
from logs import Log, log, truth_at, write_bag
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation
from test_logs import euroc, judged, nees, tum, write

import credence
from credence import adapters
from credence._judge_command import main as judge_command

Array = np.ndarray[Any, Any]
HOW: dict[str, Any] = {"manifold": "R3 x SO3", "chart": "global"}


def moved(pose: Array, turn: Rotation, shift: Array) -> Array:
    return np.hstack([turn.apply(pose[:, :3]) + shift, (turn * Rotation.from_quat(pose[:, 3:])).as_quat()])


class TestAlignment:
    SHIFT = np.array([5.0, -3, 2])

    def files(self, folder: Path, turn: Rotation) -> tuple[Log, tuple[Path, Path]]:
        of = log(80)
        return of, tum(folder, of._replace(truth=moved(of.truth, turn.inv(), turn.inv().apply(-self.SHIFT))))

    def test_the_turn_about_the_vertical_is_the_best(self, tmp_path: Path) -> None:
        of, files = self.files(tmp_path, Rotation.from_euler("z", 1.2))
        arguments = adapters.from_tum(*files, align="yaw")
        found = (
            Rotation.from_quat(arguments["truth"][0, :, 3:]) * Rotation.from_quat(truth_at(of.time - 100)[:, 3:]).inv()
        )
        assert np.abs(found.as_rotvec()[:, :2]).max() < 1e-4  # of the interpolation
        true = adapters.from_tum(*files)["truth"][0, :, :3]

        def spread(to: Array) -> float:
            at = Rotation.from_euler("z", to[0]).apply(true) + to[1:]
            return float(((arguments["estimate"][0, :, :3] - at) ** 2).sum())

        least = minimize(spread, [1.0, *self.SHIFT], method="BFGS").fun
        errors = (arguments["estimate"] - arguments["truth"])[0, :, :3]
        assert (errors**2).sum() == pytest.approx(least, rel=1e-6)

    def test_a_tilt_stays_an_error(self, tmp_path: Path) -> None:
        tilt = Rotation.from_euler("x", 0.2)
        _, files = self.files(tmp_path, tilt)
        for align, left in (("se3", False), ("first", False), ("yaw", True), ("first-yaw", True)):
            arguments = adapters.from_tum(*files, align=align)
            E, T = (Rotation.from_quat(arguments[one][0, :, 3:]) for one in ("estimate", "truth"))
            assert ((E * T.inv()).magnitude().mean() > 0.15) == left, align

    @pytest.mark.parametrize("align", ["first", "first-yaw"])
    def test_the_first_pose_is_not_judged(self, tmp_path: Path, align: str) -> None:
        of, files = self.files(tmp_path, Rotation.from_euler("z", -0.7))
        arguments = adapters.from_tum(*files, align=align)
        np.testing.assert_allclose(arguments["time"][0], of.time[1:])
        assert arguments["covariance"].shape == (1, 79, 6, 6)
        one = write(tmp_path / "one.txt", of.rows()[:1])
        refused("one.txt: it has no pose behind the first", adapters.from_tum, one, files[1], align=align)


class TestBody:
    OFFSET = np.r_[0.3, -0.2, 0.1, Rotation.from_rotvec([0.4, 0.1, -0.9]).as_quat()]

    def test_the_truth_of_another_body(self, tmp_path: Path) -> None:
        of = log(60)
        there = Rotation.from_quat(of.truth[:, 3:]) * Rotation.from_quat(self.OFFSET[3:]).inv()
        at = of.truth[:, :3] - there.apply(self.OFFSET[:3])
        expected = adapters.from_tum(*tum(tmp_path, of), **HOW)
        files = tum(tmp_path, of._replace(truth=np.hstack([at, there.as_quat()])))
        np.testing.assert_allclose(nees(adapters.from_tum(*files, **HOW, body=self.OFFSET)), nees(expected), rtol=2e-3)
        assert nees(adapters.from_tum(*files, **HOW)).mean() > 100 * nees(expected).mean()
        only = adapters.from_tum(*files, **HOW, body=self.OFFSET[:3])
        turned = adapters.from_tum(*files, **HOW, body=[*self.OFFSET[:3], 0, 0, 0, 1])
        np.testing.assert_array_equal(only["truth"], turned["truth"])

    @pytest.mark.parametrize(
        ("body", "message"),
        [
            ("1,2", r"invalid --body=.*must be 7 finite numbers"),
            ("1,2,x", r"invalid --body=.*must be 7 finite numbers"),
            ("1,2,3,0,0,0,0", "--body: pose 1 of 1 has a quaternion of length 0"),
        ],
    )
    def test_refusals(self, tmp_path: Path, capfd: pytest.CaptureFixture[str], body: str, message: str) -> None:
        estimate, truth = map(str, tum(tmp_path, log(20)))
        assert judge_command([estimate, "--truth", truth, f"--body={body}"]) == 2
        assert re.search(message, capfd.readouterr().err)


class TestQuaternions:
    """Covariances of the seven numbers of a pose."""

    @staticmethod
    def seven(of: Log, chart: str) -> Array:
        """[step, 7, 7]: P as that of the coordinates, by differences, and beside it a quaternion that is not of length
        1 with sigma 0.5."""

        def off(e: Array) -> Array:
            turn, q = Rotation.from_rotvec(e[3:]), Rotation.from_quat(of.pose[:, 3:])
            turned = turn * q if chart == "global" else q * turn
            return np.hstack([of.pose[:, :3] + e[:3], turned.as_quat(canonical=False)])

        J = np.stack([(off(1e-6 * axis) - off(-1e-6 * axis)) / 2e-6 for axis in np.eye(6)], axis=-1)
        length = np.hstack([np.zeros((len(of.pose), 3)), of.pose[:, 3:]])
        return J @ of.covariance @ J.swapaxes(1, 2) + 0.25 * length[:, :, None] * length[:, None]

    @pytest.mark.parametrize("chart", ["local", "global"])
    def test_three_directions_are_judged(self, tmp_path: Path, chart: str) -> None:
        of, how = log(60), {"manifold": "R3 x SO3", "chart": chart}
        P = self.seven(of, chart)
        arguments = {"estimate": of.pose, "truth": of.pose, "covariance": P, "quaternion": "xyzw", **how}
        with pytest.warns(UserWarning, match="the fourth, its length, has sigmas up to 0.5, and is left out"):
            reduced = adapters.from_quaternions(**arguments)["covariance"]
        np.testing.assert_allclose(reduced, of.covariance, atol=1e-9)
        first = [0, 1, 2, 6, 3, 4, 5]
        arguments |= {"estimate": of.pose[:, first], "covariance": P[:, first][..., first], "quaternion": "wxyz"}
        with pytest.warns(UserWarning, match="the fourth"):
            np.testing.assert_allclose(adapters.from_quaternions(**arguments)["covariance"], reduced, atol=1e-12)
        truth = write(tmp_path / "truth.txt", of.truth_rows())
        upper = P[(slice(None), *np.triu_indices(7))]
        files = [write(tmp_path / "e.txt", np.c_[of.time, of.pose, P.reshape(60, 49)])]
        files.append(write(tmp_path / "u.txt", np.c_[of.time, of.pose, upper]))
        files.append(euroc(tmp_path / "e.csv", of.time, of.pose, P[:, first][..., first].reshape(60, 49)))
        for file in files:
            with pytest.warns(UserWarning, match="the fourth"):
                read = adapters.from_euroc(file, truth, **how)
            np.testing.assert_allclose(read["covariance"][0], of.covariance, atol=1e-8)

    def test_refusals(self, tmp_path: Path) -> None:
        of = log(20)
        estimate = write(tmp_path / "e.txt", np.c_[of.time, of.pose, self.seven(of, "local").reshape(20, 49)])
        truth = write(tmp_path / "truth.txt", of.truth_rows())
        refused("invalid manifold=SE3 .a covariance of a quaternion", adapters.from_tum, estimate, truth)
        given = {"estimate": of.pose, "covariance": of.covariance, "manifold": "R3 x SO3", "chart": "local"}
        refused("there is no quaternion", adapters.from_quaternions, **given)
        refused(r"shape \(20, 6, 6\) .must be \(20, 7, 7\)", adapters.from_quaternions, **given, quaternion="xyzw")


class TestSquare:
    """Files as SQUARE/0.3 defines them: a header, and the lower triangle behind each pose."""

    LOWER = (slice(None), *np.tril_indices(6))

    def write(self, path: Path, of: Log, **said: str) -> Path:
        keys = {"FORMAT": "SQUARE/0.3", "REPRESENTATION": "gaussian_se3", "POSE_FRAME": "world", "BODY_FRAME": "imu"}
        keys |= {"GAUGE": "fixed", "TANGENT_CONVENTION": "right_perturbation", "TANGENT_ORDER": "translation_rotation"}
        P = of.covariance
        if said.get("TANGENT_ORDER") == "rotation_translation":
            P = np.roll(P, 3, axis=(1, 2))
        header = "\n".join(f"#%{key} {value}" for key, value in {**keys, **said}.items())
        np.savetxt(path, np.c_[of.time, of.pose, P[self.LOWER]], header=header, comments="")
        return path

    @pytest.mark.parametrize(
        ("said", "how"),
        [({}, {}), ({"TANGENT_CONVENTION": "left_perturbation"}, {"chart": "global"}),
         ({"TANGENT_ORDER": "rotation_translation"}, {}), ({"GAUGE": "se3"}, {"align": "se3"}),
         ({"GAUGE": "gravity_yaw"}, {"align": "yaw"})],
    )  # fmt: skip
    def test_headers_stand_for_options(self, tmp_path: Path, said: dict[str, str], how: dict[str, str]) -> None:
        of = log(60)
        expected = adapters.from_tum(*tum(tmp_path, of), **how)
        with (
            pytest.warns(UserWarning, match=f"its gauge is .*: align is {how.get('align', 'none')}, unless"),
            pytest.warns(UserWarning, match="its poses are of the body imu. Give body if"),
        ):
            found = adapters.from_square(self.write(tmp_path / "a.square", of, **said), tmp_path / "truth.txt")
        assert (found["manifold"], found["chart"]) == ("SE3", how.get("chart", "local"))
        for name in ("truth", "covariance"):
            np.testing.assert_allclose(found[name], expected[name], rtol=1e-9, atol=1e-9)

    def test_lines_without_a_header(self, tmp_path: Path) -> None:
        of = log(60)
        files = tum(tmp_path, of)
        wide = write(tmp_path / "wide.txt", np.c_[of.time, of.pose, of.covariance[self.LOWER]])
        with pytest.warns(UserWarning, match="positive definite in the order lower alone"):
            found = adapters.from_tum(wide, files[1])
        np.testing.assert_allclose(found["covariance"], adapters.from_tum(*files)["covariance"], rtol=1e-9)
        none = write(tmp_path / "none.txt", np.c_[of.time, of.pose, -np.ones((60, 21))])
        refused("none.txt: the covariances are positive definite in no order", adapters.from_tum, none, files[1])

    @pytest.mark.filterwarnings("ignore:.*its poses are of the body")
    def test_refusals(self, tmp_path: Path) -> None:
        of = log(20)
        truth = write(tmp_path / "truth.txt", of.truth_rows())
        for said, message in (
            ({"GAUGE": "sim3"}, "a gauge of sim3 is not aligned. Give align"),
            ({"TANGENT_CONVENTION": "x"}, "unknown TANGENT_CONVENTION x"),
            ({"REPRESENTATION": "ensemble_se3"}, "it is a SQUARE of ensemble_se3, not gaussian_se3"),
        ):
            refused(f"a.square: {message}", adapters.from_square, self.write(tmp_path / "a.square", of, **said), truth)


class TestPair:
    """Two filters whose errors are independent, each drawn from its own P."""

    @staticmethod
    def files(folder: Path, scale: float = 1.0) -> tuple[Path, Path]:
        first, second = log(400, scale=scale, seed=1), log(400, scale=scale, seed=2)
        return write(folder / "a.txt", first.rows()), write(folder / "b.txt", second.rows())

    @pytest.mark.parametrize(("scale", "word"), [(1.0, "undecided"), (0.25, "optimistic")])
    def test_both_can_be_right_or_not(self, tmp_path: Path, scale: float, word: str) -> None:
        with pytest.warns(UserWarning, match=r"a.txt and .*b.txt are taken for independent: .* whether both can be"):
            arguments = adapters.from_pair(*self.files(tmp_path, scale), **HOW)
        first, second = log(400, scale=scale, seed=1), log(400, scale=scale, seed=2)
        np.testing.assert_allclose(arguments["covariance"][0], first.covariance + second.covariance, rtol=1e-9)
        verdict = credence.judge(**arguments)
        assert judged(arguments) == pytest.approx(1 / scale, rel=0.05)  # 2400 numbers: 3 sigmas are 0.09
        assert verdict.verdict == word

    @pytest.mark.filterwarnings("ignore:.*independent")
    def test_at_other_times_covariances_lie_between(self, tmp_path: Path) -> None:
        first, second = log(60, seed=1), log(60, seed=2)
        growing = second._replace(covariance=second.covariance * np.arange(1.0, 61)[:, None, None])
        late = growing._replace(time=growing.time + 0.02)
        files = [write(tmp_path / name, of.rows()) for name, of in (("a.txt", first), ("b.txt", late))]
        arguments = adapters.from_pair(*files, **HOW)
        between = growing.covariance[0] * (np.arange(1.0, 60) + 0.6)[:, None, None]
        np.testing.assert_allclose(arguments["covariance"][0], first.covariance[1:] + between, rtol=1e-6)

    @pytest.mark.filterwarnings("ignore:.*independent")
    def test_logs_bags_and_arrays_are_judged_alike(self, tmp_path: Path) -> None:
        files = self.files(tmp_path)
        expected = nees(adapters.from_pair(*files, **HOW))
        bags = [write_bag(tmp_path / f"{seed}.bag", log(400, seed=seed), "ros1", truth="pose") for seed in (1, 2)]
        np.testing.assert_allclose(nees(adapters.from_pair(*bags, truth_topic="/odom")), expected, rtol=1e-4)
        arrays = [
            {"estimate": of.pose, "covariance": of.covariance, **HOW, "quaternion": "xyzw", "time": of.time}
            for of in (log(400, seed=1), log(400, seed=2))
        ]
        both = adapters.from_pair(*arrays)
        found = credence.judge(**both)["groups"][0]["anees"]["ratio"]
        np.testing.assert_allclose(found, expected / 6, rtol=1e-4)

    @pytest.mark.filterwarnings("ignore:.*independent")
    def test_a_world_that_is_turned(self, tmp_path: Path) -> None:
        first, second = log(60, seed=1), log(60, seed=2)
        turn = Rotation.from_rotvec([0.3, -0.2, 1.0])
        R = np.kron(np.eye(2), turn.as_matrix())
        other = second._replace(pose=moved(second.pose, turn, np.ones(3)), covariance=R @ second.covariance @ R.T)
        files = [write(tmp_path / name, of.rows()) for name, of in (("a.txt", first), ("c.txt", other))]
        expected = adapters.from_pair(files[0], write(tmp_path / "b.txt", second.rows()), **HOW, align="se3")
        np.testing.assert_allclose(nees(adapters.from_pair(*files, **HOW, align="se3")), nees(expected), rtol=1e-6)

    @pytest.mark.filterwarnings("ignore:.*independent")
    def test_arrays(self) -> None:
        rng = np.random.default_rng(5)
        times, a, b = np.arange(10.0), rng.normal(size=(10, 2)), rng.normal(size=(10, 2))
        P = np.tile(np.array([[2.0, 1], [1, 3]]), (10, 1, 1))
        one: dict[str, Any] = {"estimate": a, "covariance": P, "component_units": ["m", "rad"], "time": times}
        two = {**one, "estimate": b + np.array([0, 2 * np.pi])}
        arguments = adapters.from_pair(one, credence.Record(**two))
        np.testing.assert_allclose(arguments["error"], a - b, atol=1e-12)
        np.testing.assert_allclose(arguments["covariance"], 2 * P)
        assert adapters.from_pair(one, {**two, "covariance": P[:, 0]})["covariance"].tolist() == [[4, 4]] * 10
        with pytest.warns(UserWarning, match="8 of 10 and 10 steps are at the same times"):
            later = adapters.from_pair(one, {**two, "time": times + 2})
        np.testing.assert_allclose(later["error"][0], a[2:] - b[:8], atol=1e-12)
        np.testing.assert_allclose(later["covariance"], 2 * P[None, :8])
        for changed, message in (
            ({"estimate": b[:9], "time": None}, r"estimates of shapes \(10, 2\) and \(9, 2\)"),
            ({"time": times + 0.5}, "invalid time"),
            ({"covariance": None}, "one of both filters has no covariance"),
            ({"component_units": ["m", "m"]}, "invalid component_units .both filters"),
        ):
            refused(message, adapters.from_pair, one, {**two, **changed})
        refused("invalid second", adapters.from_pair, one, "b.txt")

    def test_refusals(self, tmp_path: Path) -> None:
        a, b = self.files(tmp_path)
        refused("a.txt: a pair has two logs", adapters.from_pair, a)
        plain = write(tmp_path / "plain.txt", log(400).rows()[:, :8])
        refused("plain.txt: its poses have no covariances", adapters.from_pair, a, plain)
        refused("cannot judge this pair .body moves", adapters.from_pair, a, b, body=[0, 0, 0])
        refused("cannot judge this pair .align moves", adapters.from_pair, a, b, align="se3", chart="global")

    def test_the_command(self, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
        files = [str(file) for file in self.files(tmp_path, 0.25)]
        how = ["--manifold", "R3 x SO3", "--chart", "global", "--pair", "--require", "no-finding"]
        assert judge_command([files[0], "--truth", files[1], *how]) == 1
        said = capfd.readouterr()
        assert "taken for independent" in said.err
        assert "optimistic" in said.out
