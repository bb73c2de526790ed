"""``python -m credence judge LOG --truth GT``: the verdict on logs in formats that the adapters read."""

from __future__ import annotations

import argparse
import os
import shlex
import subprocess
import sys
import tempfile
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from credence._commands import command
from credence._errors import Failure, InputError, argument, invalid, printable
from credence._names import joined, parted
from credence._outputs import check_output, whole
from credence._record import Record

_of_judge = ("margin", "margin-direction", "bias", "failed", "segments", "format", "require", "truth-sigma")
_of_tables = ("components", "time", "runs")
_poses = ("manifold", "chart", "max_gap", "align", "body", "time_offset", "planar", "pair", "twist")
_of_logs = ("truth", "topic", "truth_topic", "times", "rows", "names", "map", "units", "order", *_of_tables, *_poses)


def _pairs(given: str) -> dict[str, str]:
    pairs = [word.rpartition("=") for word in parted(given)]
    if not all(name and unit for name, _, unit in pairs) or len({name for name, _, _ in pairs}) < len(pairs):
        raise argparse.ArgumentTypeError(f"{given} is no NAME=UNIT,… with each name once. Give heading=deg, for one")
    return {name: unit for name, _, unit in pairs}


class _Joint(argparse.Action):
    """An option that may be given several times, with other names each."""

    def __call__(self, _: object, given: argparse.Namespace, values: Any, option: str | None = None) -> None:
        setattr(given, self.dest, {**getattr(given, self.dest), **values})


def parser() -> argparse.ArgumentParser:
    made = argparse.ArgumentParser(
        prog="python -m credence judge",
        description="The verdict on a filter from its log, whose suffix says what it is: poses with covariances (TUM "
        ".txt, EuRoC .csv, KITTI), a table (.csv with names), a bag (.bag, .mcap, .db3, a folder of ROS 2), .mat, "
        ".npz, .ulg, RTKLIB's .pos, .oem. Records (.h5) are read by `credence judge`, whose options are taken, too.",
        epilog="Exit codes: 0 done, 1 what --require asks for does not hold, 2 bad input.",
        allow_abbrev=False,
    )
    made.add_argument("log", nargs="+", metavar="LOG", help="a log for each run")
    made.add_argument(
        "--truth", action="append", metavar="GT",
        help="its ground truth; or once for each log; of .pos also a point: LATITUDE,LONGITUDE,HEIGHT",
    )  # fmt: skip
    made.add_argument("--topic", help="of a bag: its poses with covariances")
    made.add_argument(
        "--truth-topic", metavar="TOPIC",
        help="of a bag: its truth, such as /gt or /tf:PARENT.CHILD; of a .ulg groundtruth, that of its simulator",
    )  # fmt: skip
    made.add_argument("--times", metavar="FILE", help="of KITTI: the times of the poses")
    made.add_argument("--rows", metavar="NAME,…", help="of .ulg: fields, such as gps_hpos,baro_vpos")
    made.add_argument(
        "--names", nargs="+", action="extend", default=[], metavar="WHAT=NAME,…",
        help="of a table: columns, such as estimate=x,y,yaw truth=gx,gy,gyaw sigma=sx,sy,sa angles=yaw time=t "
        "(docs/logs.md has all words); of .npz and .mat: arrays, such as error=e covariance=nav.P; .mat may "
        "need --order C for [step, n], F for [n, step]",
    )  # fmt: skip
    for name in _of_tables:
        made.add_argument(f"--{name}", type=parted, metavar="NAME,…", help=f"of a table: as {name}= of --names")
    made.add_argument("--map", metavar="FILE.toml", help="of a table: the same names, units and orders, in a file")
    made.add_argument(
        "--units", type=_pairs, action=_Joint, default={}, metavar="NAME=UNIT,…",
        help="of a table: of its columns, such as heading=deg,t=ms (rad, deg, mgon, arcsec, m, mm, cm, km, s, ms, us, "
        "ns); of times in text files: time, truth_time",
    )  # fmt: skip
    made.add_argument("--order", metavar="WORD,…", help="of covariances: upper, lower, rotation first, …")
    made.add_argument("--manifold", help="what the covariance of a pose is of: SE3 or 'R3 x SO3'; of arrays any")
    made.add_argument("--chart", choices=["local", "global"], help="the frame of the error: the body's or the world's")
    made.add_argument("--twist", action="store_true", default=None, help="of a bag: judge the velocities of Odometry")
    made.add_argument("--max-gap", type=float, metavar="SECONDS", help="between true poses that are interpolated (0.2)")
    made.add_argument(
        "--align", choices=["none", "first", "se3", "yaw", "first-yaw"],
        help="what moves the truth to the poses (none): the first pose or all, as a rigid body or about the vertical",
    )  # fmt: skip
    made.add_argument("--body", metavar="X,Y,Z[,QX,QY,QZ,QW]", help="the pose of the estimated body in the truth's")
    made.add_argument(
        "--pair", action="store_true", default=None, help="the truth is a second filter: judge both by their difference"
    )
    made.add_argument("--time-offset", type=float, metavar="SECONDS", help="what is added to the times of the log")
    made.add_argument("--planar", choices=["yes", "no"], help="judge x, y and yaw alone, or all (what is estimated)")
    made.add_argument("--record", metavar="FILE.h5", help="keep the record of what was judged")
    for name in _of_judge:
        made.add_argument(f"--{name}", metavar="…", help="as of credence judge")
    made.add_argument("-o", "--output", metavar="FILE", help="as of credence judge")
    for name in ("strict", "quiet", "overwrite", "truth-dependent"):
        made.add_argument(f"--{name}", action="store_true", help="as of credence judge")
    return made


def is_for_adapters(words: Sequence[str]) -> bool:
    """Whether the words of `judge` name a log that is no record."""
    asks = any(word in ("-h", "--help") or word.split("=")[0] in ("--truth", "--names", "--map") for word in words)
    paths = [word for before, word in zip(["", *words], words) if before not in ("-o", "--output")]
    return asks or any(_kind(word) for word in paths if not word.startswith("-"))


def _kind(word: str) -> str | None:
    """The kind of log that a path is of, or None where it is not one."""
    from credence.adapters.rosbag import is_bag

    suffix = Path(word).suffix.lower()
    if is_bag(word):
        return "bag"
    if suffix in (".ulg", ".mat", ".npz", ".pos", ".oem"):
        return suffix[1:]
    return "text" if suffix in (".csv", ".txt", ".tum", ".kitti", ".square", ".smfeval") else None


def _names(given: Sequence[str]) -> dict[str, list[str]]:
    pairs = [word.partition("=") for word in given]
    for what, _, name in pairs:
        if not what or not name:
            raise InputError(f"--names: {what} has no name (must be WHAT=NAME). Give one, such as error=e.")
        if [one for one, _, _ in pairs].count(what) > 1:
            raise InputError(f"--names: {what} is given twice. Give its names once, parted by commas.")
    return {what: parted(name) for what, _, name in pairs}


def arguments_of(given: argparse.Namespace) -> dict[str, Any]:
    """The arguments of judge from the logs that the command line names."""
    from credence import adapters
    from credence.adapters import trajectories

    kinds = {_kind(log) for log in given.log}
    if len(kinds) != 1 or None in kinds:
        raise InputError("logs have unknown suffixes or several formats. Give logs of one format, named as it is.")
    kind = kinds.pop()
    single = given.log[0] if len(given.log) == 1 else given.log
    names = _names(given.names)
    poses = {name: getattr(given, name) for name in _poses if getattr(given, name) is not None}
    if "planar" in poses:
        poses["planar"] = poses["planar"] == "yes"
    if "body" in poses:
        poses["body"] = poses["body"].split(",")
    used = {
        "text": {"truth", "times", "names", "map", "units", "order", *_of_tables, *_poses} - {"twist"},
        "bag": {"truth", "topic", "truth_topic", "units", *_poses},
        "oem": {"truth"},
        "pos": {"truth", "max_gap", "align", "time_offset", "planar", "pair"},
    }
    used["ulg"] = {"truth_topic", *_poses} - {"twist", "pair"} if given.truth_topic else {"rows"}
    if names or given.map:  # of a table
        used["text"] = {"truth", "names", "map", "units", "order", *_of_tables, *_poses} - {"twist"}
    allowed = used.get(kind or "", {"names", "order", "manifold", "chart"})
    for option in _of_logs:
        if getattr(given, option) not in (None, [], {}) and option not in allowed:
            raise InputError(f"{argument(option)}: says nothing about a log of this kind. Leave it out.")
    if kind == "bag":
        topics = {"topic": given.topic, "truth_topic": given.truth_topic}
        return adapters.from_rosbag(given.log, given.truth, **topics, units=given.units, **poses)
    if kind == "text" and not names and not given.map:
        _refuse_table(given)
    if kind in ("text", "pos", "oem") and not names and not given.map and given.truth is None:
        raise InputError("poses need a truth. Give --truth FILE; or the columns of a table that has both (--names).")
    if kind == "oem":
        return adapters.from_oem(given.log, given.truth)
    if kind == "pos":
        return adapters.from_rtklib(given.log, given.truth, **poses)
    if kind == "ulg" and given.truth_topic:
        if given.truth_topic != "groundtruth":
            raise invalid("truth_topic", given.truth_topic, "a .ulg has that of its simulator", "Give groundtruth")
        return adapters.from_px4(given.log, **poses)
    if kind != "text" and not isinstance(single, str):
        raise InputError(f"a verdict is on one .{kind} at a time, which has all runs in it. Give one.")
    if kind == "ulg":
        return adapters.from_ulog(single, given.rows and given.rows.split(","))
    if kind in ("mat", "npz"):
        arrays = {what: name[0] for what, name in names.items()}
        order = given.order or arrays.pop("order", "")
        return {"npz": adapters.from_npz, "mat": adapters.from_mat}[kind](single, arrays, order=order, **poses)
    if names or given.map:
        names |= {name: value for name in _of_tables if (value := getattr(given, name))}
        return _of_table(single, given, names, poses)
    return trajectories.from_files(given.log, given.truth, given.times, given.units, given.order, **poses)


def _refuse_table(given: argparse.Namespace) -> None:
    """Ask what the columns of a table are, and propose it where their names suggest it."""
    from credence.adapters.named_columns import names_of
    from credence.adapters.proposal import proposed

    names = names_of(given.log[0])
    if names:
        words = proposed(names, names_of(given.truth[0]) if given.truth else None)
        asked = (
            f"{words}, if that is so"
            if words
            else "WHAT=NAME,… (docs/logs.md has all words), and --truth FILE for a truth apart"
        )
        there = ", ".join(map(printable, names))
        raise InputError(
            f"{given.log[0]}: it is a table, and nothing says what its columns are ({there}). Say --names {asked}."
        )


def _of_table(
    log: Any, given: argparse.Namespace, names: dict[str, list[str]], poses: dict[str, Any]
) -> dict[str, Any]:
    from credence.adapters import from_table
    from credence.adapters.declared import KEYS

    unknown = [what for what in names if what not in KEYS or what in ("units", "order")]
    if unknown:
        known = ", ".join(key for key in KEYS if key not in ("units", "order"))
        raise InputError(f"--names: unknown {unknown[0]}. Give some of {known}.")
    if not isinstance(log, str) or len(given.truth or ()) > 1:
        raise InputError(
            "a verdict is on one table at a time. Put runs below each other, and name their column (runs)."
        )
    options: dict[str, Any] = names | poses | ({"order": given.order} if given.order else {})
    return from_table(log, given.truth[0] if given.truth else None, map=given.map, units=given.units, **options)


def log_of(given: argparse.Namespace) -> str:
    """The log and how it was read, as words of a shell."""
    words = list(given.log)
    for option in _of_logs:
        value = getattr(given, option)
        name = f"--{option.replace('_', '-')}"
        if option == "names" and value:
            words += [name, *value]
        elif option == "units" and value:
            words.append(f"{name}={joined(list(map('='.join, value.items())))}")
        elif option in _of_tables and value:
            words.append(f"{name}={joined(value)}")
        elif value is True:
            words.append(name)
        elif value:
            words += [f"{name}={one}" for one in (value if isinstance(value, list) else [value])]
        elif value == 0:
            words.append(f"{name}=0")
    log = shlex.join(words)
    return log if len(log.encode(errors="replace")) < 60_000 else ""  # what an attribute has room for


def write_record(path: str, arguments: Mapping[str, Any], log: str = "") -> None:
    """Write arguments of judge as a record, which may name the log that they were read from."""
    from credence import _arrays
    from credence.adapters.tables import needed

    h5py = needed("h5py", "h5py", "keep a record")
    record = Record(**{name: value for name, value in arguments.items() if name != "runs"})
    named = record.named()
    with whole(path) as part, h5py.File(part, "w") as file:
        file.attrs["record_version"] = 2
        if log:
            file.attrs["log"] = log.encode(errors="replace").decode()
        for name, text in named.attributes().items():
            file.attrs[name] = text
        for name, array in _arrays.prepared(record, arguments.get("runs")).items():
            file[name] = array
        for name, dimension in named.dimensions.items():
            file[name].attrs["dimension"] = dimension


@command(parser, "log")
def main(given: argparse.Namespace) -> int:
    """Run the command and return its exit code."""
    values = {name: getattr(given, name.replace("-", "_")) for name in _of_judge}
    options = [f"--{name}={value}" for name, value in values.items() if value is not None]
    flags = ("strict", "overwrite", "truth-dependent")
    options += [f"--{name}" for name in flags if getattr(given, name.replace("-", "_"))]
    options += [f"--output={os.path.abspath(given.output)}"] if given.output else []
    try:
        if given.record and Path(given.record).suffix != ".h5":
            raise invalid("record", given.record, "must end in .h5", "Give another name")
        inputs = [*given.log, *(given.truth or ()), *filter(None, [given.times, given.map])]
        for output in (given.record, given.output):
            if output:
                check_output(output, given.overwrite, inputs=inputs)
        if given.record and given.output and os.path.realpath(given.record) == os.path.realpath(given.output):
            raise invalid("record", given.record, "-o writes it, too", "Give another name")
        with warnings.catch_warnings(record=True) as notes:
            warnings.simplefilter("always", UserWarning)
            arguments = arguments_of(given)
        for one in notes:
            print(f"credence judge: note: {one.message}", file=sys.stderr)
        with tempfile.TemporaryDirectory(prefix="credence-") as folder:
            name = f"{Path(given.log[0]).name}.h5"
            record = os.path.abspath(given.record) if given.record else os.path.join(folder, name)
            write_record(record, arguments, log_of(given))
            del arguments  # what the program reads again
            # The program, in a process of its own: the folder goes when a signal ends it, too.
            program = [sys.executable, "-m", "credence", "judge", given.record or name, "--quiet", *options]
            where = None if given.record else folder  # the report names the record by its path
            code = subprocess.run(program, cwd=where, check=False).returncode
    except (InputError, Failure) as error:
        print(f"credence judge: {error}", file=sys.stderr)
        return 2 if isinstance(error, InputError) else 1
    return code if code >= 0 else 128 - code
