"""Logs in the shapes in which people have them, each with its right answer: of a filter whose P is right, unless the
answer is another one. `python3 shapes.py FOLDER` writes them, and the command that judges each.
"""

from __future__ import annotations

import functools
import itertools
import shlex
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from scipy.io import savemat
from scipy.spatial.transform import Rotation

Array = np.ndarray[Any, Any]
STEPS = 1500
TURN = np.degrees(1.0)  # of a rad


class Shape(NamedTuple):
    """What somebody has, and what they give the command."""

    table: Any  # a frame, poses and covariances as lines of TUM, or a dictionary of arrays
    words: str = ""  # behind the names of the logs
    said: str = ""  # what a note or a refusal has in it
    answer: str = "right"  # a verdict; `right`: nothing is found, and NEES/dim is near 1
    asks: bool = False  # it is refused, or not right, until it is said what the message says
    files: dict[str, Any] = {}  # noqa: RUF012  further tables, or texts
    ends: str = ".csv"
    runs: tuple[Any, ...] = ()  # further logs like the first
    hints: str = ""  # what a hint of the report has in it


P = np.array([[0.04, 0.012, -0.002], [0.012, 0.02, 0.001], [-0.002, 0.001, 0.0009]])  # x, y (m), heading (rad)
SIGMAS = np.sqrt(np.diag(P))


def robot(seed: int, steps: int = STEPS, scale: Array | None = None) -> tuple[Array, Array, Array]:
    """Times, truths and estimates [step, 3] of a robot on a winding road."""
    rng = np.random.default_rng(seed)
    t = 0.1 * np.arange(steps)
    truth = np.c_[30 * np.sin(0.05 * t), 20 * np.cos(0.07 * t), 0.4 * t]
    error = rng.multivariate_normal(np.zeros(3), P, steps) * (1 if scale is None else scale)
    return t, truth, truth + error


def wrapped(angle: Array, turn: float = 2 * np.pi, first: float = -np.pi) -> Array:
    folded: Array = np.remainder(angle - first, turn) + first
    return folded


def plain(seed: int, names: str = "x y h gx gy gh", **more: Any) -> pd.DataFrame:
    """A table with the names of estimates and truths, angles within ± pi, and sigmas, or what is given of them."""
    t, truth, estimate = robot(seed)
    truth[:, 2], estimate[:, 2] = wrapped(truth[:, 2]), wrapped(estimate[:, 2])
    table = pd.DataFrame(np.c_[estimate, truth], columns=names.split()).assign(t=t)
    return table.assign(**(more or dict(zip(("sx", "sy", "sh"), SIGMAS))))


def triangle(order: str, of: Array = P) -> dict[str, float]:
    """Six numbers of P in an order, by the names p1 to p6."""
    places = {
        "upper": [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)],
        "lower": [(0, 0), (1, 0), (1, 1), (2, 0), (2, 1), (2, 2)],
        "diagonals": [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)],
    }[order]
    return {f"p{i + 1}": of[place] for i, place in enumerate(places)}


STATES = "--names estimate=x,y,h truth=gx,gy,gh"
SIX = "covariance=" + ",".join(f"p{i}" for i in range(1, 7))
SHAPES: dict[str, Callable[[], Shape]] = {}


def shape(make: Callable[[], Shape]) -> Callable[[], Shape]:
    SHAPES[make.__name__] = make
    return make


@shape
def names_of_a_device() -> Shape:
    names = {"x": "East (m)", "y": "North, m", "h": "Heading", "gx": "Ref.E", "gy": "/ref/n", "gh": "ref[2]"}
    toml = """
        estimate = ["East (m)", "North, m", "Heading"]
        truth = ["Ref.E", "/ref/n", "ref[2]"]
        sigma = ["sx", "sy", "sh"]
        components = ["east", "north", "heading"]
        units = { heading = "deg" }
        time = "t"
    """
    turned = {name: lambda table, name=name: TURN * table[name] for name in ("h", "gh", "sh")}
    return Shape(plain(1).assign(**turned).rename(columns=names), "--map drive.toml", files={"drive.toml": toml})


@shape
def names_of_a_device_in_options() -> Shape:
    names = {"x": "East (m)", "y": "North, m", "h": "heading"}
    words = """--names 'estimate=East (m),"North, m",heading' truth=gx,gy,gh sigma=sx,sy,sh --time t
        --components 'East (m),"North, m",yaw' --units '"North, m"=m,yaw=rad'"""
    return Shape(plain(2).rename(columns=names), words, "in the report North_ m is North, m$")


@shape
def rostopic_echo() -> Shape:
    names = [f"field.{part}.pose.{axis}" for part in ("pose", "truth") for axis in ("position.x", "position.y", "yaw")]
    table = plain(3, " ".join(names))
    table.insert(0, "%time", 1_700_000_000_000_000_000 + (1e9 * table.pop("t")).astype("int64"))
    words = f"--names estimate={','.join(names[:3])} truth={','.join(names[3:])} sigma=sx,sy,sh angles={names[2]}"
    return Shape(table, words + " time=%time --units=%time=ns")


@shape
def azimuth_in_degrees() -> Shape:
    table = plain(4)
    for name in ("h", "gh"):
        table[name] = wrapped(TURN * table[name], 360, 0)
    return Shape(table.assign(sh=TURN * table.sh), f"{STATES} sigma=sx,sy,sh angles=h", "in degrees?", asks=True)


@shape
def a_heading_that_is_not_said_to_be_one() -> Shape:
    return Shape(plain(27), f"{STATES} sigma=sx,sy,sh", "about 6.283, which is the range of its numbers", asks=True)


@shape
def a_truth_in_degrees_beside_rad() -> Shape:
    """The azimuth of a reference, and a filter's heading."""
    table = plain(33).assign(gh=lambda t: wrapped(TURN * t.gh, 360, 0))
    return Shape(table, f"{STATES} sigma=sx,sy,sh angles=h", "in degrees. Say --units gh=deg", asks=True)


@shape
def a_slow_heading_in_degrees() -> Shape:
    table = plain(5)
    table["gh"] = 40 + 0.001 * table.t
    table["h"] = table.gh + np.random.default_rng(5).normal(0, 0.1, STEPS)
    table = table.assign(sh=0.1)
    return Shape(table, f"{STATES} sigma=sx,sy,sh angles=h", "has numbers up to 40.*: in degrees?", asks=True)


@shape
def sigma_in_degrees_beside_rad() -> Shape:
    table = plain(6)
    said = "its sigmas, about 1.7., are 5.* times its errors. Are they in degrees, and the errors in rad"
    return Shape(table.assign(sh=TURN * table.sh), f"{STATES} sigma=sx,sy,sh angles=h", said, asks=True)


@shape
def large_sigmas_in_degrees_beside_rad() -> Shape:
    table = plain(30).assign(h=lambda t: wrapped(t.gh + 4 * (t.h - t.gh)), sh=4 * TURN * SIGMAS[2])
    said = "has sigmas of 6.88, and those of an angle are below pi rad: in degrees. Say --units sh=deg"
    return Shape(table, f"{STATES} sigma=sx,sy,sh angles=h", said, asks=True)


@shape
def sigmas_in_rad_beside_degrees() -> Shape:
    table = plain(32).assign(h=lambda t: TURN * t.h, gh=lambda t: TURN * t.gh)
    said = "its sigmas, about 0.03, are 0.017.* times its errors. Are they in rad, and the errors not. If so"
    return Shape(table, f"{STATES} sigma=sx,sy,sh --units h=deg", said, asks=True)


@shape
def a_covariance_in_degrees() -> Shape:
    turn = np.diag([1, 1, TURN])
    table = plain(7, **triangle("upper", turn @ P @ turn)).assign(h=lambda t: TURN * t.h, gh=lambda t: TURN * t.gh)
    return Shape(table, f"{STATES} {SIX} --units h=deg")


@shape
def a_lower_triangle() -> Shape:
    return Shape(plain(8, **triangle("lower")), f"{STATES} {SIX} angles=h", "definite in the order lower alone")


@shape
def a_lower_triangle_that_is_said() -> Shape:
    return Shape(plain(8, **triangle("lower")), f"{STATES} {SIX} angles=h --order lower")


@shape
def signed_roots() -> Shape:
    """Names and numbers of RTKLIB's .pos, as CSV."""
    root = np.sign(P) * np.sqrt(np.abs(P))
    table = plain(9, **triangle("diagonals", root))
    times = pd.Timestamp("2024-05-06") + pd.to_timedelta(table.pop("t"), "s")
    table["GPST"] = times.dt.strftime("%Y/%m/%d %H:%M:%S.%f")
    return Shape(table, f"{STATES} {SIX} angles=h time=GPST --order 'diagonals,signed roots'")


@shape
def an_order_that_is_none() -> Shape:
    table = plain(9, **triangle("upper", np.where(np.eye(3) > 0, -P, P)))
    said = "positive definite in no order .upper, lower, diagonals 0%, upper of signed roots 0%"
    return Shape(table, f"{STATES} {SIX} angles=h", said, "refused")


@shape
def rotation_first() -> Shape:
    turned = P[[2, 0, 1]][:, [2, 0, 1]]
    nine = {f"c{i}{j}": turned[i, j] for i in range(3) for j in range(3)}
    words = f"{STATES} covariance={','.join(nine)} angles=h --order 'rotation first'"
    return Shape(plain(10, **nine), words)


@shape
def an_error_of_innovations() -> Shape:
    rng = np.random.default_rng(11)
    table = pd.DataFrame({"innov_x": rng.normal(0, 0.3, STEPS), "S": 0.09})
    return Shape(table, "--names error=innov_x variance=S", "innov_x is given as an error, and called like an inno")


@shape
def innovations_alone() -> Shape:
    rng = np.random.default_rng(12)
    table = pd.DataFrame(rng.multivariate_normal([0, 0], P[:2, :2], STEPS), columns=["u", "v"])
    table.loc[100:299, "u"] = np.nan  # not measured, beside a finite S
    table = table.assign(uu=0.04, uv=0.012, vv=0.02)
    words = "--names innovation=u,v innovation_covariance=uu,uv,vv"
    return Shape(table, words, "200 of 1500 steps cannot be judged.* 200 have innovations of some rows alone")


@shape
def innovations_with_a_diffuse_start() -> Shape:
    table = pd.DataFrame({"v": np.random.default_rng(31).normal(0, 0.3, STEPS), "S": 0.09})
    table.loc[0, "S"] = 1e6
    said = 'v: left out of 1 of 1500 steps, at the start: P says "not known" .a variance of 1e.06'
    return Shape(table, "--names innovation=v innovation_variance=S", said)


@shape
def innovations_of_two_sensors_with_sigmas() -> Shape:
    rng = np.random.default_rng(13)
    table = pd.DataFrame(rng.multivariate_normal([0, 0], P[:2, :2], STEPS), columns=["u", "v"])
    return Shape(table.assign(su=0.2, sv=0.02**0.5), "--names innovation=u,v innovation_sigma=su,sv", "NEES is of NIS")


@shape
def residuals_after_the_update() -> Shape:
    """z - H x of the updated state, whose variance is R²/S, beside S: too large, which one log alone cannot refute."""
    rng = np.random.default_rng(14)
    table = pd.DataFrame({"res": rng.normal(0, 0.5, STEPS), "S": 1.0})
    return Shape(table, "--names innovation=res innovation_variance=S", answer="undecided")


@shape
def nis_alone() -> Shape:
    table = pd.DataFrame({"nis": np.random.default_rng(15).chisquare(3, STEPS)})
    return Shape(table, "--names nis=nis dimension=3", "NIS stands in the place of NEES")


@shape
def nis_alone_without_a_dimension() -> Shape:
    table = pd.DataFrame({"nis": np.random.default_rng(15).chisquare(3, STEPS)})
    return Shape(table, "--names nis=nis", "nis: has no dimension", "refused")


@shape
def a_truth_with_gaps() -> Shape:
    table = plain(16)
    table.loc[200:449, ["gx", "gy"]] = np.nan
    table.loc[1400:, "gh"] = np.nan
    table.loc[700:704, "t"] = np.nan
    said = "355 of 1500 steps .* 5 have no time, 350 have no truth"
    return Shape(table, f"{STATES} sigma=sx,sy,sh angles=h time=t", said)


@shape
def tracks_that_lose_their_truth() -> Shape:
    tables = []
    for track in range(90):
        table = plain(100 + track).head(40 + track).assign(track=f"T{track}")
        table.loc[30 + track // 2 : 30 + track // 2 + track % 5, ["gx", "gy", "gh"]] = np.nan
        tables.append(table)
    whole = pd.concat(tables).sort_values(["t", "track"])  # as a recorder has them
    return Shape(whole, f"{STATES} sigma=sx,sy,sh angles=h time=t runs=track", r"270 have no truth")


@shape
def an_estimate_that_is_nan() -> Shape:
    table = plain(17)
    table.loc[700, "h"] = np.nan
    return Shape(table, f"{STATES} sigma=sx,sy,sh angles=h", answer="failed")


@shape
def a_filter_that_diverges_to_nan() -> Shape:
    table = plain(18)
    table.loc[900:, ["x", "y", "h", "sx", "sy", "sh"]] = np.nan
    return Shape(table, f"{STATES} sigma=sx,sy,sh angles=h", answer="failed")


@shape
def estimates_at_every_tenth_row() -> Shape:
    """Two topics joined by their times: the filter was not asked at each of them."""
    table = plain(19)
    table.loc[np.arange(STEPS) % 10 != 3, ["x", "y", "h", "sx", "sy", "sh"]] = np.nan
    said = "1350 of 1500 steps .* 1350 have neither an estimate nor a covariance"
    return Shape(table, f"{STATES} sigma=sx,sy,sh angles=h time=t", said)


@shape
def a_diffuse_start_with_missing_months() -> Shape:
    rng = np.random.default_rng(20)
    level, P11 = np.cumsum(rng.normal(0, 0.1, 600)), np.full(600, 0.04)
    table = pd.DataFrame({"estimate": level + rng.normal(0, 0.2, 600), "level": level, "P": P11})
    table.loc[:2, ["estimate", "P"]] = [0.0, 1e7]
    table.loc[rng.choice(np.arange(50, 550), 40, replace=False), "level"] = np.nan
    table["month"] = pd.date_range("1970-01-01", periods=600, freq="MS").strftime("%Y-%m-%d")
    words = "--names estimate=estimate truth=level variance=P time=month"
    return Shape(table, words, "estimate: left out of 3 of 600 steps, at the start: P says .* .a variance of 1e")


@shape
def track_fits_with_flt_max() -> Shape:
    """Each fit is a run of one step; the variance of y is half of what it should be."""
    rng = np.random.default_rng(21)
    table = pd.DataFrame(rng.normal(0, [0.1, 0.2, 5], (3000, 3)), columns=["ex", "ey", "et"])
    table = table.assign(vx=0.01, vy=0.02, vt=3.4028235e38, fit=np.arange(3000))
    words = "--names error=ex,ey,et variance=vx,vy,vt --runs fit"
    return Shape(table, words, "et: not judged .its variance is a placeholder throughout, 3.4e.38", "optimistic")


@shape
def variances_below_zero() -> Shape:
    """By rounding in one component, which is a failure, and by ROS's word for "not known" in another."""
    table = plain(22, vx=-1.0, vy=P[1, 1], vh=P[2, 2])
    table.loc[[0, 800], "vh"] = -1.8e-8
    return Shape(table, f"{STATES} variance=vx,vy,vh angles=h", "x: not judged .* throughout, -1", answer="failed")


@shape
def a_start_in_degrees_that_says_not_known() -> Shape:
    table = plain(28).assign(h=lambda t: TURN * t.h, gh=lambda t: TURN * t.gh, sh=TURN * SIGMAS[2])
    table.loc[:9, "sh"] = 1000.0
    return Shape(table, f"{STATES} sigma=sx,sy,sh --units h=deg", "h: left out of 10 of 1500 steps, at the start")


@shape
def a_covariance_that_is_not_symmetric() -> Shape:
    nine = {f"c{i}{j}": P[i, j] * (1.1 if i > j else 1) for i in range(3) for j in range(3)}
    return Shape(plain(29, **nine), f"{STATES} covariance={','.join(nine)} angles=h", "is not symmetric", "refused")


@shape
def a_state_that_grows() -> Shape:
    table = plain(23)
    table = table.assign(ex=table.x - table.gx, ey=table.y - table.gy)
    table.loc[:499, ["ey", "sy"]] = np.nan
    return Shape(table, "--names error=ex,ey sigma=sx,sy time=t")


@shape
def an_orbit_of_large_numbers() -> Shape:
    """A variance from 10^6 on is one where errors are as large."""
    rng = np.random.default_rng(24)
    table = pd.DataFrame(rng.normal(0, 3000, (STEPS, 3)), columns=["r", "i", "c"]).assign(v=9e6)
    return Shape(table, "--names error=r,i,c variance=v,v,v")


@shape
def a_truth_in_a_table_of_its_own() -> Shape:
    """Times are week and seconds of GPS in one, and in the other, at 1 Hz, too; angles pass ± pi."""
    table = plain(25)
    start = 2_300 * 604_800 + 604_790.0  # a week ends
    table["week"], table["tow"] = divmod(start + table.pop("t"), 604_800)
    t = np.arange(0, 151.0)
    truth = pd.DataFrame({"gx": 30 * np.sin(0.05 * t), "gy": 20 * np.cos(0.07 * t), "gh": TURN * wrapped(0.4 * t)})
    truth["week"], truth["tow"] = divmod(start + t, 604_800)
    truth.loc[70:72, "gh"] = np.nan
    words = f"{STATES} sigma=sx,sy,sh angles=h time=week,tow --truth truth.csv --max-gap 1.5 --units gh=deg"
    said = "39 of 1500 poses have no truth"  # between 69 s and 73 s, but at both ends
    return Shape(table.drop(columns=["gx", "gy", "gh"]), words, said, files={"truth.csv": truth})


@shape
def times_in_milliseconds() -> Shape:
    table = plain(26)
    truth = table[["gx", "gy", "gh"]].assign(t=1000 * table.t)
    words = f"{STATES} sigma=sx,sy,sh angles=h time=t --truth truth.csv"
    table = table.drop(columns=["gx", "gy", "gh"]).assign(t=1000 * table.t)
    return Shape(table, words, "--units time=ms", asks=True, files={"truth.csv": truth})


D6 = np.diag([0.05, 0.06, 0.08, 0.01, 0.012, 0.02])
_R6 = np.random.default_rng(5).normal(size=(6, 6))
P6 = D6 @ (0.15 * _R6 @ _R6.T / 6 + np.eye(6)) @ D6  # x, y, z (m), and turns about the axes of the world (rad)
FIRST = [3, 4, 5, 0, 1, 2]
GLOBAL = "--manifold 'R3 x SO3' --chart global"


def way(steps: int = STEPS) -> tuple[Array, Array, Rotation]:
    t = 0.1 * np.arange(steps)
    places = np.c_[10 * np.sin(0.1 * t), 8 * np.cos(0.13 * t), np.sin(0.05 * t)]
    return t, places, Rotation.from_rotvec(np.c_[0.1 * np.sin(0.3 * t), 0.1 * np.cos(0.2 * t), 0.3 * t])


def poses(seed: int, of: Array = P6, steps: int = STEPS, scale: float = 1.0) -> Array:
    """Lines of TUM's format with 36 numbers behind each pose, which are `of`; P is right where these are P6."""
    t, places, turns = way(steps)
    error = scale * np.random.default_rng(seed).multivariate_normal(np.zeros(6), P6, steps)
    turned = (Rotation.from_rotvec(error[:, 3:]) * turns).as_quat()
    return np.c_[t, places + error[:, :3], turned, np.tile(of.ravel(), (steps, 1))]


def true_poses(steps: int = STEPS, every: int = 1, body: Array | None = None) -> Array:
    t, places, turns = way(steps)
    places = places if body is None else places + turns.apply(body)
    return np.c_[t, places, turns.as_quat()][::every]


TRUE = {"truth.txt": true_poses()}


@shape
def rotation_first_in_poses() -> Shape:
    table = poses(40, P6[FIRST][:, FIRST])
    said = "NEES/n is 1.*would be .* --order 'rotation first'. Is that"
    return Shape(table, "--truth truth.txt", said, asks=True, files=TRUE, ends=".txt")


@shape
def rotation_first_in_twenty_logs() -> Shape:
    logs = [poses(41 + i, P6[FIRST][:, FIRST], 200) for i in range(20)]
    said = "would be .* --order 'rotation first'. Is that"
    return Shape(logs[0], f"--truth truth.txt {GLOBAL}", said, asks=True, files=TRUE, ends=".txt", runs=(*logs[1:],))


@shape
def turns_in_the_world_frame_of_tum() -> Shape:
    return Shape(poses(62), "--truth truth.txt", f"with {GLOBAL}. Is", asks=True, files=TRUE, ends=".txt")


@shape
def a_right_invariant_P() -> Shape:
    """Of the error E inv(T) on SE(3), so that errors of positions grow with the distance from the origin."""
    t, places, turns = way()
    error = np.random.default_rng(63).multivariate_normal(np.zeros(6), P6, STEPS)
    turn, w = Rotation.from_rotvec(error[:, 3:]), error[:, 3:]
    a = np.linalg.norm(w, axis=1)[:, None]
    once = np.cross(w, error[:, :3])
    moved = error[:, :3] + (1 - np.cos(a)) / a**2 * once + (a - np.sin(a)) / a**3 * np.cross(w, once)
    table = np.c_[t, turn.apply(places) + moved, (turn * turns).as_quat(), np.tile(P6.ravel(), (STEPS, 1))]
    return Shape(table, "--truth truth.txt", "with --chart global. Is that", asks=True, files=TRUE, ends=".txt")


@shape
def a_lower_triangle_in_29_columns() -> Shape:
    rows, columns = np.tril_indices(6)
    table = np.c_[(of := poses(64))[:, :8], of[:, 8:].reshape(-1, 6, 6)[:, rows, columns]]
    return Shape(table, f"--truth truth.txt {GLOBAL}", "in the order lower alone", files=TRUE, ends=".txt")


@shape
def a_truth_at_1_Hz() -> Shape:
    said = "1350 of 1500 poses have no truth within a gap of 0.2 s"
    files = {"truth.txt": true_poses(every=10)}
    return Shape(poses(65), f"--truth truth.txt {GLOBAL}", said, files=files, ends=".txt")


@shape
def a_truth_of_25_cm() -> Shape:
    """Said so: the errors are then too large for neither, and too many for P to be shown right."""
    truth = true_poses()
    truth[:, 1:4] += np.random.default_rng(1).normal(0, 0.25, (STEPS, 3))
    words = f"--truth truth.txt {GLOBAL} --truth-sigma position=0.25"
    return Shape(poses(66), words, answer="undecided", files={"truth.txt": truth}, ends=".txt")


@shape
def a_truth_of_another_body() -> Shape:
    truth = true_poses(body=np.array([0.3, -0.1, 0.05]))
    said, words = "would be .* with --body=-0.*. Is that", f"--truth truth.txt {GLOBAL}"
    return Shape(poses(67), words, said, asks=True, files={"truth.txt": truth}, ends=".txt")


def odometry(drift: float) -> tuple[Array, Array]:
    """A filter that knows the vertical alone, from a start of its own, and its truth; drift in m/s."""
    t, places, turns = way(400)
    rng, up = np.random.default_rng(68), np.arange(400.0)[:, None]
    walk = np.cumsum(rng.normal(0, [0.02, 0.02, 0.02, 0, 0, 0.002], (400, 6)), axis=0)
    walk[:, 3:5] = rng.normal(0, 0.004, (400, 2))
    walk[:, :3] += drift * t[:, None]
    walk[:, [0, 1, 2, 5]] -= walk[0, [0, 1, 2, 5]]
    P = np.hstack([4e-4 * up.repeat(3, 1) + 1e-8, np.full((400, 2), 1.6e-5), 4e-6 * up + 1e-10])[:, :, None] * np.eye(6)
    start = Rotation.from_euler("z", 2.0)
    turned = start * Rotation.from_rotvec(walk[:, 3:]) * turns
    J = np.kron(np.eye(2), start.as_matrix())
    moved = start.apply(places + walk[:, :3]) + np.array([5.0, -3, 1])
    return np.c_[t, moved, turned.as_quat(), (J @ P @ J.T).reshape(-1, 36)], true_poses(400)


@shape
def yaw_and_position_that_are_not_observed() -> Shape:
    table, truth = odometry(0)
    said = "Are both in one frame. Nothing is aligned unless you ask for it .--align first-yaw"
    words = f"--truth truth.txt {GLOBAL}"  # one log of a walk is worth few runs
    return Shape(table, words, said, "undecided", asks=True, files={"truth.txt": truth}, ends=".txt")


@shape
def a_drift_of_one_log() -> Shape:
    table, truth = odometry(0.05)
    words = f"--truth truth.txt {GLOBAL} --align first-yaw"
    return Shape(table, words, answer="optimistic", files={"truth.txt": truth}, ends=".txt")


@shape
def two_filters_without_a_truth() -> Shape:
    files = {"other.txt": poses(70)}
    said = "taken for independent"
    return Shape(poses(69), f"--truth other.txt --pair {GLOBAL}", said, files=files, ends=".txt")


@shape
def a_table_without_a_word() -> Shape:
    table = plain(73, "x_est y_est heading_est x_true y_true heading_true", P_x=0.04, P_y=0.02, P_heading=0.0009)
    return Shape(table, "", "nothing says what its columns are", asks=True)


@shape
def a_table_of_errors_without_a_word() -> Shape:
    table = plain(77).assign(track=1)
    table = table.assign(ex=table.x - table.gx, ey=table.y - table.gy)[["track", "t", "ex", "ey", "sx", "sy"]]
    return Shape(table, "", "Say --names error=ex,ey", asks=True)


@shape
def two_tables_without_a_word() -> Shape:
    table = plain(79)
    names = {"gx": "x", "gy": "y", "gh": "yaw"}
    truth = table[["t", *names]].rename(columns=names)
    table = table[["t", "x", "y", "h", "sx", "sy", "sh"]].rename(columns={"h": "yaw"})
    table = table.rename(columns={"sx": "std_x", "sy": "std_y", "sh": "std_yaw"})
    return Shape(table, "--truth truth.csv", "Say --names estimate=x,y,yaw", asks=True, files={"truth.csv": truth})


@shape
def two_filters_in_tables() -> Shape:
    tables = [plain(seed).rename(columns={"x": "a", "y": "b"}).drop(columns=["gx", "gy", "gh"]) for seed in (71, 72)]
    words = "--names estimate=a,b,h sigma=sx,sy,sh time=t angles=h --truth other.csv --pair"
    return Shape(tables[0], words, "taken for independent", files={"other.csv": tables[1]})


def of_device(seed: int, first: list[int]) -> pd.DataFrame:
    """A quaternion that begins with w, and 36 numbers."""
    lines, truth, w = poses(seed, P6[first][:, first]), true_poses(), [0, 1, 2, 3, 7, 4, 5, 6]
    names = ["Time [s]", "X (m)", "Y (m)", "Z (m)", "Qw", "Qx", "Qy", "Qz", *(f"C{i}" for i in range(36))]
    table = pd.DataFrame(np.c_[lines[:, w], lines[:, 8:], truth[:, w[1:]]])
    return table.set_axis([*names, *(f"R{name}" for name in names[1:8])], axis=1)


DEVICE = (
    "--names 'estimate=X (m),Y (m),Z (m),Qw,Qx,Qy,Qz' 'truth=RX (m),RY (m),RZ (m),RQw,RQx,RQy,RQz' "
    f"covariance={','.join(f'C{i}' for i in range(36))} 'time=Time [s]'"
)


@shape
def a_device_with_rotation_first() -> Shape:
    return Shape(of_device(73, FIRST), DEVICE, "would be .* --order 'rotation first'. Is", asks=True)


@shape
def a_quaternion_with_a_covariance_of_four() -> Shape:
    _, _, turns = way()
    rng = np.random.default_rng(74)
    of = np.array([1e-4, 2e-4, 4e-4])
    turned = turns * Rotation.from_rotvec(rng.normal(0, np.sqrt(of), (STEPS, 3)))
    q = turned.as_quat(scalar_first=True) * rng.choice([-1, 1], (STEPS, 1))
    G = 0.5 * np.stack([-q[:, 1:], *(q[:, :1] * e + np.cross(e, -q[:, 1:]) for e in np.eye(3))], axis=1)
    G[:, 1:] = np.swapaxes(G[:, 1:], 1, 2)
    P = (G * of) @ np.swapaxes(G, 1, 2) + 1e-9 * np.eye(4)
    table = pd.DataFrame(np.c_[q, turns.as_quat(scalar_first=True), P.reshape(-1, 16)])
    table.columns = [f"q{a}" for a in "wxyz"] + [f"g{a}" for a in "wxyz"] + [f"P{i}" for i in range(16)]
    words = f"--names estimate=qw,qx,qy,qz truth=gw,gx,gy,gz covariance={','.join(f'P{i}' for i in range(16))}"
    return Shape(table, words, "the fourth, its length")


@shape
def a_receiver_s_sigmas_beside_degrees() -> Shape:
    error = np.random.default_rng(75).normal(0, [1.5, 2, 4], (STEPS, 3))
    table = pd.DataFrame({"lat": 47.4 + error[:, 0] / 111_177, "lon": 8.5 + error[:, 1] / 75_480, "alt": error[:, 2]})
    table = table.assign(glat=47.4, glon=8.5, galt=0.0, sn=1.5, se=2.0, su=4.0)
    words = "--names estimate=lat,lon,alt truth=glat,glon,galt sigma=sn,se,su"
    return Shape(table, words, "whose sigmas are in m. Say --units lat=latitude,lon=longitude, or", asks=True)


@shape
def errors_in_mm_beside_m() -> Shape:
    table = pd.DataFrame(np.random.default_rng(76).normal(0, [20, 30], (STEPS, 2)), columns=["ex", "ey"])
    said = "are 0.001 times its errors. Are they in m, and the errors in mm. If so, say --units ex=mm,sx=m,ey=mm,sy=m"
    return Shape(table.assign(sx=0.02, sy=0.03), "--names error=ex,ey sigma=sx,sy", said, asks=True)


@shape
def errors_in_mm_of_sixty_runs() -> Shape:
    arrays = {"error": np.random.default_rng(77).normal(0, [20, 30], (60, 50, 2)), "covariance": np.diag([4e-4, 9e-4])}
    return Shape(arrays, answer="failed", ends=".npz", hints=r"factor of about 1e.06 in every direction")


@shape
def variances_named_sigmas() -> Shape:
    table = pd.DataFrame(np.random.default_rng(78).normal(0, [0.2, 0.05], (STEPS, 2)), columns=["ex", "ey"])
    said, words = "as large as variances of its errors", "--names error=ex,ey sigma=sx,sy"
    return Shape(table.assign(sx=0.04, sy=0.0025), words, said, answer="optimistic")


@shape
def variances_as_powers_of_two() -> Shape:
    table = pd.DataFrame(np.random.default_rng(79).normal(0, [0.2, 0.1], (STEPS, 2)), columns=["ex", "ey"])
    return Shape(table.assign(vx=2**0.2, vy=2**0.1), "--names error=ex,ey variance=vx,vy", answer="undecided")


@shape
def one_propagated_P_for_500_runs() -> Shape:
    rng, F, Q = np.random.default_rng(80), np.array([[1, 0.1], [0, 1]]), np.diag([1e-3, 2e-2])
    P, errors, Ps = np.diag([0.1, 0.2]), [], []
    error = rng.multivariate_normal([0, 0], P, 500)
    for _ in range(50):
        errors, Ps = [*errors, error], [*Ps, P]
        error, P = error @ F.T + rng.multivariate_normal([0, 0], Q, 500), F @ P @ F.T + Q
    arrays = {"e": np.stack(errors, axis=1), "P": np.array(Ps)}
    return Shape(arrays, "--names error=e covariance=P", ends=".npz")


@shape
def states_that_are_columns() -> Shape:
    rng = np.random.default_rng(81)
    truth = np.cumsum(rng.normal(size=(STEPS, 4)), axis=0)
    estimate, P = truth + rng.normal(0, 0.2, (STEPS, 4)), np.tile(0.04 * np.eye(4), (STEPS, 1, 1))
    words = "--names estimate=x truth=g covariance=P"
    arrays = {"x": estimate[..., None], "g": truth[..., None], "P": P}
    return Shape(arrays, words, "subtracted as they are", ends=".npz")


@shape
def singles_with_a_negative_variance() -> Shape:
    P = np.tile(np.diag([0.01, 0.04]), (STEPS, 1, 1)).astype("f4")
    P[500, 1, 1] = -1.8e-8
    error = np.random.default_rng(82).normal(0, [0.1, 0.2], (STEPS, 2)).astype("f4")
    return Shape({"error": error, "covariance": P}, answer="failed", ends=".npz")


@shape
def structs_of_matlab_with_variances() -> Shape:
    error = np.random.default_rng(83).normal(0, [0.1, 0.2], (STEPS, 2))
    arrays = {"nav_e": {"vel": error, "P": np.tile([0.01, 0.04], (STEPS, 1))}}
    words = "--names error=nav_e.vel covariance=nav_e.P"
    return Shape(arrays, words, r"taken for \[step, n\]. Say --order F if not", ends=".mat")


@shape
def accepted_innovations_only() -> Shape:
    nu, S = np.random.default_rng(84).normal(size=(4000, 2)), np.tile(np.eye(2), (4000, 1, 1))
    inside = (nu**2).sum(axis=1) < 5.991
    arrays = {"innovation": nu[inside], "innovation_covariance": S[inside]}
    return Shape(arrays, answer="undecided", ends=".npz", hints="did a gate remove them")


def innovations_of(q: float, r: float, answer: str) -> Shape:
    """Of a random walk with steps of variance 0.1, measured with variance 1, for which the filter takes q and r."""
    rng = np.random.default_rng(86)
    z = np.cumsum(rng.normal(0, np.sqrt(0.1), 2 * STEPS)) + rng.normal(size=2 * STEPS)
    x, P, rows = 0.0, 1.0, []
    for one in z:
        P += q
        rows.append((one - x, P + r))
        x, P = x + P / (P + r) * (one - x), P * r / (P + r)
    table = pd.DataFrame(rows, columns=["innov", "S"])
    return Shape(table, "--names innovation=innov innovation_variance=S", answer=answer)


@shape
def innovations_with_q_too_small() -> Shape:
    return innovations_of(0.002, 1, "optimistic")


@shape
def innovations_with_r_too_large() -> Shape:
    return innovations_of(0.1, 9, "mixed")


def of_arcs(arcs: int, steps: int) -> Shape:
    """Errors in an inertial frame, and P in radial, in-track and cross-track."""
    angle = 0.03 * np.arange(steps)
    turn = Rotation.from_euler("x", 51.6, degrees=True) * Rotation.from_euler("z", angle[:, None])
    P = np.diag([10.0, 120, 25]) @ np.array([[1, 0.4, 0], [0.4, 1, 0.1], [0, 0.1, 1]]) @ np.diag([10.0, 120, 25])
    error = np.random.default_rng(85).multivariate_normal(np.zeros(3), P, (arcs, steps))
    arrays = {"error": np.einsum("kij,rkj->rki", turn.as_matrix(), error), "covariance": P}
    return Shape(arrays, answer="failed", ends=".npz", hints="is the error in the chart and frame")


for _arcs, _steps in ((50, 60), (200, 60), (1, STEPS)):
    SHAPES[f"P_in_RIC_of_{_arcs}_arcs"] = functools.partial(of_arcs, _arcs, _steps)

FAULTS: dict[str, tuple[Array, str]] = {
    "P_twice": (2 * P, "pessimistic"),
    "P_halved": (P / 2, "optimistic"),
    "no_correlations": (np.diag(np.diag(P)) * (1 + 1e-9), "mixed"),
    "one_component_in_degrees": (np.diag([1, 1, TURN]) @ P @ np.diag([1, 1, TURN]), "mixed"),
    "a_component_too_small": (np.diag([0.7, 1, 1]) @ P @ np.diag([0.7, 1, 1]), "optimistic|mixed"),
}


def planted(fault: str, runs: int) -> Shape:
    of, word = FAULTS[fault]
    steps = 2000 if runs == 1 else 100
    answer = "undecided" if runs == 1 and word == "pessimistic" else word  # of one log nothing is found too small
    answer = "optimistic" if runs == 1 and "mixed" in word else answer
    error = np.random.default_rng(runs).multivariate_normal(np.zeros(3), P, (runs, steps))
    return Shape({"error": error, "covariance": of}, answer=answer, ends=".npz")


for _fault, _runs in itertools.product(FAULTS, (1, 19, 20)):
    SHAPES[f"{_fault}_of_{_runs}_runs"] = functools.partial(planted, _fault, _runs)


def save(path: Path, content: Any) -> None:
    if isinstance(content, str):
        path.write_text(content)
    elif isinstance(content, dict):
        (np.savez if path.suffix == ".npz" else lambda name, **arrays: savemat(name, arrays))(path, **content)
    elif isinstance(content, pd.DataFrame):
        content.to_csv(path, index=False)
    else:
        np.savetxt(path, content, fmt="%.12g")


def write(folder: Path, name: str, made: Shape) -> list[str]:
    """Writes the files of a shape, and returns the words of the command that judges it."""
    logs = [f"{name}{i or ''}{made.ends}" for i in range(1 + len(made.runs))]
    for path, content in [*zip(logs, (made.table, *made.runs)), *made.files.items()]:
        save(folder / path, content)
    return [*logs, *shlex.split(made.words)]


if __name__ == "__main__":
    for name, make in SHAPES.items():
        (folder := Path(sys.argv[1]) / name).mkdir(parents=True, exist_ok=True)
        print("python -m credence judge", shlex.join(write(folder, name, make())))
