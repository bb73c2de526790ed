"""Logs in the shapes in which people have them, each with its right answer: tables of a filter whose P is right, unless
the answer is another one. `python3 shapes.py FOLDER` writes them, and the command that judges each.
"""

from __future__ import annotations

import shlex
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

Array = np.ndarray[Any, Any]
STEPS = 1500
TURN = np.degrees(1.0)  # of a rad


class Shape(NamedTuple):
    """What somebody has, and what they give the command."""

    table: pd.DataFrame
    words: str  # behind the name of the table
    said: str = ""  # what a note or a refusal has in it
    answer: str = "right"  # a verdict; `right`: nothing is found, and NEES/dim is near 1
    asks: bool = False  # it is refused until it is said what the message says
    files: dict[str, Any] = {}  # noqa: RUF012  further tables, or texts


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
    return Shape(plain(2).rename(columns=names), words, "in the report East_m is East .m., North_m is North, m$")


@shape
def rostopic_echo() -> Shape:
    names = [f"field.{part}.pose.{axis}" for part in ("pose", "truth") for axis in ("position.x", "position.y", "yaw")]
    table = plain(3, " ".join(names))
    table.insert(0, "%time", 1_700_000_000_000_000_000 + (1e9 * table.pop("t")).astype("int64"))
    words = f"--names estimate={','.join(names[:3])} truth={','.join(names[3:])} sigma=sx,sy,sh angles={names[2]}"
    return Shape(table, words + " time=%time --units=%time=ns", "field_pose_pose_yaw is field.pose.pose.yaw")


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


def write(folder: Path, name: str, made: Shape) -> list[str]:
    """Writes the files of a shape, and returns the words of the command that judges it."""
    made.table.to_csv(folder / f"{name}.csv", index=False)
    for path, content in made.files.items():
        if isinstance(content, str):
            (folder / path).write_text(content)
        else:
            content.to_csv(folder / path, index=False)
    return [f"{name}.csv", *shlex.split(made.words)]


if __name__ == "__main__":
    for name, make in SHAPES.items():
        (folder := Path(sys.argv[1]) / name).mkdir(parents=True, exist_ok=True)
        print("python -m credence judge", shlex.join(write(folder, name, make())))
