"""Logs of a robot whose filter is right, written by the libraries of each format."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Writer2
from rosbags.typesys import Stores, get_typestore
from scipy.spatial.transform import Rotation

Array = np.ndarray[Any, Any]


class Log(NamedTuple):
    time: Array  # [step]
    pose: Array  # [step, 7]: x, y, z and the quaternion x, y, z, w
    covariance: Array  # [step, 6, 6]
    truth_time: Array
    truth: Array

    def rows(self) -> Array:
        """Lines of TUM's format with the covariance behind."""
        return np.c_[self.time, self.pose, self.covariance.reshape(-1, 36)]

    def truth_rows(self) -> Array:
        return np.c_[self.truth_time, self.truth]


def truth_at(time: Array) -> Array:
    """A path on which position and heading change all the time."""
    position = np.c_[3 * np.sin(0.7 * time), 2 * np.cos(0.9 * time), 0.3 * np.sin(0.4 * time)]
    turn = np.c_[0.1 * np.sin(time), 0.1 * np.cos(1.1 * time), 0.5 * time]
    return np.hstack([position, Rotation.from_rotvec(turn).as_quat()])


def log(steps: int = 300, *, scale: float = 1.0, start: float = 100.0, seed: int = 1) -> Log:
    """Errors in the world's frame, in ROS's order, drawn from P, which is then multiplied by `scale`; the truth has
    100 poses a second, the filter 20 and at other times."""
    rng = np.random.default_rng(seed)
    time = start + 1.5 + 0.05 * np.arange(steps) + 0.003
    of = start + 0.01 * np.arange(5 * steps + 300)
    root = rng.normal(size=(6, 6))
    P = 1e-4 * (root @ root.T + np.eye(6))
    error = rng.multivariate_normal(np.zeros(6), P, steps)
    true = truth_at(time - start)
    turned = Rotation.from_rotvec(error[:, 3:]) * Rotation.from_quat(true[:, 3:])
    pose = np.hstack([true[:, :3] + error[:, :3], turned.as_quat()])
    return Log(time, pose, np.tile(scale * P, (steps, 1, 1)), of, truth_at(of - start))


def write_bag(path: Path, of: Log, kind: str, *, truth: str = "tf") -> Path:
    """Writes Odometry and its truth, as TF or PoseStamped, into a bag of the kind ``ros1``, ``sqlite3`` or ``mcap``."""
    types = types_of(kind).types

    def header(at: float, frame: str) -> Any:
        return header_of(kind, at, frame)

    def pose(row: Array) -> Any:
        point = types["geometry_msgs/msg/Point"](*row[:3])
        return types["geometry_msgs/msg/Pose"](point, types["geometry_msgs/msg/Quaternion"](*row[3:]))

    def transform(at: float, row: Array) -> Any:
        moved = types["geometry_msgs/msg/Vector3"](*row[:3])
        both = types["geometry_msgs/msg/Transform"](moved, types["geometry_msgs/msg/Quaternion"](*row[3:]))
        link = types["geometry_msgs/msg/TransformStamped"](header(at, "map"), "base_link", both)
        return types["tf2_msgs/msg/TFMessage"]([link])

    def odometry(at: float, row: Array, P: Array) -> Any:
        twist = types["geometry_msgs/msg/Twist"](*[types["geometry_msgs/msg/Vector3"](0.0, 0.0, 0.0)] * 2)
        moving = types["geometry_msgs/msg/TwistWithCovariance"](twist, np.zeros(36))
        with_covariance = types["geometry_msgs/msg/PoseWithCovariance"](pose(row), P.ravel())
        return types["nav_msgs/msg/Odometry"](header(at, "map"), "base_link", with_covariance, moving)

    stamped = types["geometry_msgs/msg/PoseStamped"]
    messages = [(at, "/odom", odometry(at, *rest)) for at, *rest in zip(of.time, of.pose, of.covariance)]
    for at, row in zip(of.truth_time, of.truth):
        one = ("/tf", transform(at, row)) if truth == "tf" else ("/gt", stamped(header(at, "map"), pose(row)))
        messages.append((at, *one))
    return write_messages(path, kind, messages)


def header_of(kind: str, at: float, frame: str) -> Any:
    types, sec = types_of(kind).types, int(at)
    stamp = types["builtin_interfaces/msg/Time"](sec, round((at - sec) * 1e9))
    return types["std_msgs/msg/Header"](*([0] if kind == "ros1" else []), stamp, frame)


@cache
def types_of(kind: str) -> Any:
    return get_typestore(Stores.ROS1_NOETIC if kind == "ros1" else Stores.ROS2_HUMBLE)


def write_messages(path: Path, kind: str, messages: Sequence[tuple[float, str, Any]]) -> Path:
    """Writes messages of `types_of` the kind at their times (s) and topics."""
    store, ros1 = types_of(kind), kind == "ros1"
    serialize = store.serialize_ros1 if ros1 else store.serialize_cdr
    writer: Any = Writer1(path)
    if not ros1:
        writer = Writer2(path, version=9, storage_plugin=StoragePlugin[kind.upper()])
    with writer:
        connections = {
            topic: writer.add_connection(topic, message.__msgtype__, typestore=store)
            for topic, message in {topic: message for _, topic, message in messages}.items()
        }
        for at, topic, message in messages:
            writer.write(connections[topic], round(at * 1e9), serialize(message, message.__msgtype__))
    return path
