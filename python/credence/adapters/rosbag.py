"""Arguments of :func:`credence.judge` from bags of ROS 1 and 2 and MCAP files, read by `rosbags`."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path as FilePath
from typing import Any

import numpy as np

from credence._errors import InputError, argument, wrong
from credence.adapters.frames import Poses
from credence.adapters.geodesy import EARTH, axes, fix_arguments, fixes, positions, standing
from credence.adapters.poses import pose_arguments
from credence.adapters.tables import Array, Path, needed, note, one_line, paired, units_given
from credence.adapters.trajectories import read_poses
from credence.adapters.twists import twist_arguments

_fix = "sensor_msgs/msg/NavSatFix"
_with_covariance = ("nav_msgs/msg/Odometry", "geometry_msgs/msg/PoseWithCovarianceStamped")
_without = ("geometry_msgs/msg/PoseStamped", "geometry_msgs/msg/TransformStamped")
_twists = ("nav_msgs/msg/Odometry", "geometry_msgs/msg/TwistWithCovarianceStamped")
_twists_without = ("geometry_msgs/msg/TwistStamped",)
_transforms = "tf2_msgs/msg/TFMessage", "tf/msg/tfMessage"


def is_bag(path: Path) -> bool:
    """Whether the path is that of a bag: a file ``.bag``, ``.mcap`` or ``.db3``, or a folder of ROS 2."""
    return FilePath(path).suffix in (".bag", ".mcap", ".db3") or (FilePath(path) / "metadata.yaml").exists()


def _pose(message: Any) -> tuple[Any, Any, Any]:
    """The position, the orientation and the covariance, if any, of a message with a pose or a transform."""
    if hasattr(message, "transform"):
        return message.transform.translation, message.transform.rotation, None
    pose = message.pose
    if hasattr(pose, "covariance"):
        return pose.pose.position, pose.pose.orientation, pose.covariance
    return pose.position, pose.orientation, None


def _twist(message: Any) -> tuple[list[float], Any]:
    """The velocity (linear, angular) and the covariance, if any, of a message with a twist."""
    outer = message.twist
    twist = getattr(outer, "twist", outer)
    parts = (twist.linear, twist.angular)
    return [getattr(part, axis) for part in parts for axis in "xyz"], getattr(outer, "covariance", None)


def _messages(reader: Any, topic: str) -> Iterator[tuple[int, Any]]:
    connections = [one for one in reader.connections if one.topic == topic]
    for connection, at, raw in reader.messages(connections=connections):
        yield at, reader.deserialize(raw, connection.msgtype)


def _links(reader: Any, topic: str) -> dict[str, list[tuple[int, Any]]]:
    """The transforms of a topic, by ``PARENT.CHILD``."""
    links: dict[str, list[tuple[int, Any]]] = {}
    for at, message in _messages(reader, topic):
        for one in message.transforms:
            name = f"{one.header.frame_id.lstrip('/')}.{one.child_frame_id.lstrip('/')}"
            links.setdefault(name, []).append((at, one))
    return links


def _topic_messages(reader: Any, topic: str, source: str, twist: bool) -> list[tuple[int, Any]]:
    name, of_link, link = topic.partition(":")
    types = {of: info.msgtype for of, info in reader.topics.items()}
    taken = (*_twists, *_twists_without) if twist else (*_with_covariance, *_without, *_transforms, _fix)
    known = [one for one in types if types[one] in taken]
    if name not in known:
        what = "velocities" if twist else "poses"
        raise InputError(
            f"{source}: there is no topic {name} of {what} in it. Give one of {', '.join(known) or 'none'}."
        )
    if types[name] not in _transforms:
        return list(_messages(reader, name))
    links = _links(reader, name)
    if not of_link or link not in links:
        raise InputError(
            f"{source}: {name} has no transform `{link}`. Give one as {name}:PARENT.CHILD, of {', '.join(links)}."
        )
    return links[link]


def _chosen(reader: Any, source: str, types: Sequence[Sequence[str]], option: str, without: str | None) -> str:
    """The only topic of these types, or where there is none of the ones that follow."""
    of = {topic: info.msgtype for topic, info in reader.topics.items() if topic != without}
    found: list[str] = next(filter(None, ([topic for topic in of if of[topic] in one] for one in types)), [])
    if len(found) == 1:
        return found[0]
    transforms = [topic for topic, info in reader.topics.items() if info.msgtype in _transforms]
    links = [f"{topic}:{link}" for topic in transforms for link in _links(reader, topic)] if without else []
    why = "several topics have" if found else "no topic has"
    what = "poses for a truth" if without else "poses with covariances"
    choice = ": " * bool(found or links) + ", ".join([*found, *links])
    raise InputError(f"{source}: {why} {what}. Name the topic ({argument(option)}){choice}.")


def _read(bag: Path, topic: str | None, estimate_topic: str | None, twist: bool, like: str = "") -> tuple[Poses, str]:
    """The poses of a topic and its name; of the truth where there is the topic of an estimate, in the frame `like`."""
    rosbags = needed("rosbags.highlevel", "rosbags", "read bags")
    stores = needed("rosbags.typesys", "rosbags", "read bags")
    source = os.fspath(bag)
    types: list[Sequence[str]] = [_with_covariance, [_fix]]
    if estimate_topic:
        types = [[_fix]] if like == EARTH else [(*_with_covariance, *_without)]
    if twist:
        types = [(*_twists, *(_twists_without if estimate_topic else ()))]
    try:
        store = stores.get_typestore(stores.Stores.LATEST)
        with rosbags.AnyReader([FilePath(bag)], default_typestore=store) as reader:
            option = "truth_topic" if estimate_topic else "topic"
            topic = topic or _chosen(reader, source, types, option, estimate_topic)
            messages = _topic_messages(reader, topic, source, twist)
    except InputError:
        raise
    except Exception as error:  # what its parsers run into
        raise InputError(f"{source}: it cannot be read as a bag ({one_line(error)}). Give a whole bag.") from None
    if not messages:
        raise InputError(f"{source}: the topic {topic} has no messages. Name another topic.")
    return _poses(messages, f"{source} {topic}", twist), topic


def _poses(messages: list[tuple[int, Any]], source: str, twist: bool) -> Poses:
    stamps = np.array([message.header.stamp.sec + message.header.stamp.nanosec * 1e-9 for _, message in messages])
    if not stamps.any():
        note(f"{source}: its headers have no times; those at which its messages were recorded are taken")
        stamps = np.array([at for at, _ in messages]) * 1e-9
    if hasattr(messages[0][1], "latitude"):
        return _fixes([message for _, message in messages], source, stamps)
    if twist:
        read = [_twist(message) for _, message in messages]
        P = None if read[0][1] is None else np.array([each for _, each in read], dtype=float).reshape(-1, 6, 6)
        body = getattr(messages[0][1], "child_frame_id", "")
        return Poses(source, stamps, np.array([each for each, _ in read]), P, body)
    parts = [_pose(message) for _, message in messages]
    pose = np.array([(p.x, p.y, p.z, q.x, q.y, q.z, q.w) for p, q, _ in parts])
    first = parts[0][2]
    covariance = None if first is None else np.array([each for _, _, each in parts], dtype=float).reshape(-1, 6, 6)
    return Poses(source, stamps, pose, covariance, messages[0][1].header.frame_id.lstrip("/"))


def _fixes(messages: Sequence[Any], source: str, stamps: Array) -> Poses:
    """Fixes of satellites, without those that have none [sensor_msgs/NavSatStatus: -1]."""
    place = np.array([(one.latitude, one.longitude, one.altitude) for one in messages])
    found = np.isfinite(place).all(axis=1) & np.array([one.status.status >= 0 for one in messages])
    there = np.flatnonzero(found)
    if len(there) < len(messages):
        note(f"{source}: {len(messages) - len(there)} of {len(messages)} messages have no fix, and are left out")
    P = np.array([one.position_covariance for one in messages], dtype=float).reshape(-1, 3, 3)[there]
    kind = {one.position_covariance_type for one, is_there in zip(messages, found) if is_there}
    if kind & {1, 2}:
        note(f"{source}: some of its covariances have no correlations (types {kind}): these are taken for 0")
    place = place[there]
    A = axes(place[:, 0], place[:, 1])
    return fixes(source, stamps[there], positions(*place.T), None if 0 in kind else np.swapaxes(A, 1, 2) @ P @ A)


def from_rosbag(
    bag: Path | Sequence[Path],
    truth: Path | Sequence[Path] | None = None,
    *,
    topic: str | None = None,
    truth_topic: str | None = None,
    twist: bool = False,
    manifold: str = "R3 x SO3",
    chart: str = "global",
    units: Mapping[str, str] | None = None,
    **options: Any,
) -> dict[str, Any]:
    """Poses with covariances in bags of ROS 1 (``.bag``) or ROS 2 (a folder, ``.db3``, ``.mcap``).

    Needs `rosbags`. The times are those of the headers. A covariance of ROS is of x, y, z and of turns about the fixed
    axes X, Y, Z, all in the frame of the header: the difference of the positions, and the rotation vector in the
    world's frame. Many programs write another one into it: say so by `manifold` and `chart`.

    Parameters
    ----------
    bag : path, or list of paths
        A bag for each run.
    truth : path, or list of paths
        Bags, or text files as of :func:`from_tum`; of fixes also a point, as of :func:`from_rtklib`. By default the
        truth is in the same bag.
    topic : str
        Of ``nav_msgs/Odometry``, ``geometry_msgs/PoseWithCovarianceStamped``, or ``sensor_msgs/NavSatFix``, whose
        errors are to the east, to the north and up; the only one, by default.
    truth_topic : str
        Of such messages, or ``PoseStamped``, ``TransformStamped``, or of a transform in messages of TF:
        ``"/tf:PARENT.CHILD"``; the only one that is not `topic`, by default.
    twist : bool
        Whether the velocities of ``nav_msgs/Odometry`` or ``geometry_msgs/TwistWithCovarianceStamped`` are judged, with
        a truth of these or of ``TwistStamped``, in the frame of the body. Of the options it has `max_gap`,
        `time_offset` and `pair`.
    manifold, chart, **options
        As of :func:`from_tum`; `units` may have `truth_time` alone, of a text file.

    Returns
    -------
    dict
        As of :func:`from_tum`; of fixes and velocities as :func:`from_rtklib` and with `error` [trial, step, n].

    Raises
    ------
    InputError
        If a bag or a topic cannot be read, or a topic must be named; or as of :func:`from_tum`.
    """
    units = units_given(units, {"truth_time": ["time"]})
    estimates = [_read(one, topic, None, twist) for one, _ in paired(bag, bag)]
    still = [standing(each, truth, options.get("time_offset", 0.0)) for each, _ in estimates]
    pairs = [(each, point) for (each, _), point in zip(estimates, still) if point is not None]
    for (each, name), (_, other) in zip(estimates, [] if pairs else paired(bag, bag if truth is None else truth)):
        in_bag = truth is None or is_bag(other)
        read = _read(other, truth_topic, name, twist, each.frame)[0] if in_bag else read_poses(other, None, units)
        pairs.append((each, read))
    if twist:
        for option in options:
            if option not in ("max_gap", "time_offset", "pair"):
                raise wrong(option, "says nothing about velocities", "Leave it out")
        return twist_arguments(pairs, **options)
    if any(each.covariance is None for each, _ in pairs if each.frame == EARTH):
        raise InputError(f"{pairs[0][0].source}: position_covariance_type is 0, unknown. Give a log that knows them.")
    if EARTH in {each.frame for pair in pairs for each in pair}:
        return fix_arguments(pairs, **options)
    return pose_arguments(pairs, manifold=manifold, chart=chart, **options)
