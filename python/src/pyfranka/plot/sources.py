# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Sources of states: motion logs, bags, topics, robots on the network. ROS is imported when it is used."""

from __future__ import annotations

import csv
import os
import re
import threading
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

import pyfranka
from pyfranka.plot.recording import (
    COMMANDS,
    FIELDS,
    Abort,
    Array,
    BadInput,
    Collector,
    Recording,
    answering,
    kind_of,
)
from pyfranka.sim.arguments import path

TOPIC = "/franka_state_controller/franka_states"
MESSAGE = "franka_msgs/FrankaState"
REASON = re.compile(r"^Robot's protocol version: (\d+)$", re.M)
FIRST_STATE = 10.0  # [s] to wait for it (chosen here)


# ---- motion logs -----------------------------------------------------------------------------------------


def read_log(
    file: str | os.PathLike[str], reason: str | os.PathLike[str] | None = None, version: int = 0
) -> tuple[Recording, Abort | None]:
    """A motion log: the CSV of franka::logToCSV. The reason is in a text file, by default beside it.

    Raises BadInput with a sentence if it is none.

    >>> written = (folder / "motion.csv").write_text(pyfranka.log_to_csv(error.log))
    >>> recording, abort = pyfranka.plot.read_log(folder / "motion.csv")
    >>> len(recording) == len(error.log)
    True
    """
    file, reason = Path(path(file, "file")), None if reason is None else Path(path(reason, "reason"))
    columns = _read_columns(file)
    if "time" not in columns or not any(name.startswith("state.") for name in columns):
        raise BadInput(
            f"{file} is not a motion log: its first line has no columns time and state.q[0]. Motion logs are "
            "what log_to_csv and logToCSV write, and the files that the topic abort names."
        )
    values = {}
    for name, size in FIELDS.items():
        if f"state.{name}[0]" in columns:
            values[name] = _together(columns, f"state.{name}", size, file)
    if "success_rate" in columns:
        values["control_command_success_rate"] = columns["success_rate"][:, None]
    for name, (_, size) in COMMANDS.items():
        if f"{name}[0]" in columns:
            values[name] = answering(_together(columns, name, size, file))
    abort = _read_reason(file, reason)
    if not version and abort is not None:
        found = REASON.search(abort.text)
        version = int(found.group(1)) if found else 0
        abort = Abort(REASON.sub("", abort.text).strip(), abort.errors)
    time = 1e-3 * columns["time"]  # [ms] in the file
    return Recording(file.name, time, values, version=version or kind_of(file.name)), abort


def _read_columns(file: Path) -> dict[str, Array]:
    try:
        with file.open(newline="") as stream:
            lines = list(csv.reader(stream))
        names, rows = lines[0], np.array(lines[1:], float)
    except OSError as error:
        raise BadInput(f"{file} cannot be read: {error.strerror}.") from None
    except IndexError:
        raise BadInput(f"{file} is empty.") from None
    except (ValueError, csv.Error):
        raise BadInput(f"{file} is not a table of numbers.") from None
    if not len(rows):
        raise BadInput(f"{file} has a first line with names, but no states.")
    if rows.ndim != 2 or rows.shape[1] != len(names):
        raise BadInput(f"{file}: its lines do not have {len(names)} numbers, as its first line says.")
    return {name.strip(): column for name, column in zip(names, rows.T)}


def _together(columns: Mapping[str, Array], name: str, size: int, file: Path) -> Array:
    try:
        return np.stack([columns[f"{name}[{i}]"] for i in range(size)], axis=1)
    except KeyError as error:
        raise BadInput(f"{file} has no column {error.args[0]}.") from None


def _read_reason(file: Path, reason: Path | None) -> Abort | None:
    path = reason or file.with_suffix(".txt")
    if reason is None and not path.exists():
        return None
    try:
        return Abort.of_text(path.read_text())
    except OSError as error:
        raise BadInput(f"{path} cannot be read: {error.strerror}.") from None
    except UnicodeDecodeError:
        raise BadInput(f"{path} is not a text file.") from None


# ---- bags ------------------------------------------------------------------------------------------------


def read_bag(file: str | os.PathLike[str], topic: str = "", version: int = 0) -> Recording:
    """The states in a bag. Raises BadInput with a sentence if there are none, or of several robots."""
    file = Path(path(file, "file"))
    try:
        import rosbag
    except ImportError:
        raise BadInput("Bags need ROS: run franka_plot in ./franka shell, or a sourced workspace.") from None
    try:
        with rosbag.Bag(str(file)) as bag:
            topics = bag.get_type_and_topic_info().topics
            found = sorted(name for name, info in topics.items() if info.msg_type == MESSAGE)
            topic = _topic_in(file, topic, topics, found)
            collector = Collector(f"{topic} in {file.name}")
            for _, message, _ in bag.read_messages([topic]):
                collector.add(message)
            collector.version = version or kind_of(topic) or _kind_beside(bag, topic)
    except (OSError, rosbag.ROSBagException) as error:
        raise BadInput(f"{file} cannot be read as a bag: {error}.") from None
    return collector.recording()


def _kind_beside(bag: Any, topic: str) -> int:
    """The states have no name: joint states and wrenches of the same robot have one."""
    node = topic.rsplit("/", 1)[0]
    for name in (f"{node}/joint_states", f"{node}/F_ext", "/joint_states"):
        for _, message, _ in bag.read_messages([name]):
            if version := kind_of(" ".join([message.header.frame_id, *getattr(message, "name", ())])):
                return version
            break
    return 0


def _topic_in(file: Path, topic: str, topics: Mapping[str, Any], found: list[str]) -> str:
    if topic:
        if topic not in topics:
            raise BadInput(f"{file} has no topic {topic}." + _choices(found))
        if topic not in found:
            raise BadInput(f"{topic} in {file} has messages of {topics[topic].msg_type}, not {MESSAGE}.")
        return topic
    if len(found) != 1:
        what = "no messages of type" if not found else "several topics of type"
        raise BadInput(f"{file} has {what} {MESSAGE}." + _choices(found))
    return found[0]


def _choices(found: list[str]) -> str:
    return f" Choose with --topic: {', '.join(found)}." if found else ""


# ---- live sources ----------------------------------------------------------------------------------------


class Live:
    """States that arrive while the program runs. Use as a context: it ends with the block."""

    def __init__(self, collector: Collector):
        self.collector = collector
        self.ended = threading.Event()  # no more states will come
        self.error = ""  # why

    def __enter__(self) -> Live:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Ends the connection."""

    def await_first(self) -> None:
        """Raises BadInput if no state comes."""
        waited = 0.0
        while not len(self.collector) and waited < FIRST_STATE and not self.ended.wait(0.02):
            waited += 0.02
        if not len(self.collector):
            raise BadInput(
                self.error or f"No state came from {self.collector.name} within {FIRST_STATE:g} s."
            )


class FromRobot(Live):
    """A robot on the network, without ROS."""

    def __init__(self, address: str, fields: Iterable[str], most: int, version: int = 0):
        try:
            self._robot = pyfranka.Robot(address, pyfranka.RealtimeConfig.Ignore)
        except pyfranka.Exception as error:
            raise BadInput(f"{address}: {error}") from None
        version = version or int(self._robot.server_version())
        super().__init__(Collector(address, version, most, fields))
        self._closing = False
        self._thread = threading.Thread(target=self._read, daemon=True)
        self._thread.start()

    def _read(self) -> None:
        try:
            self._robot.read(self._take)
        except pyfranka.Exception as error:
            self.error = f"{self.collector.name}: {error}"
        self.ended.set()

    def _take(self, state: pyfranka.RobotState) -> bool:
        self.collector.add(state)
        return not self._closing

    def close(self) -> None:
        self._closing = True
        self._thread.join(2.0)


class FromTopic(Live):
    """A topic with franka_msgs/FrankaState."""

    def __init__(self, topic: str, fields: Iterable[str], most: int, version: int = 0):
        try:
            import rosgraph
            import rospy_connections
            from franka_msgs.msg import FrankaState
        except ImportError:
            raise BadInput(
                "Topics need ROS: run franka_plot in ./franka shell, or a sourced workspace."
            ) from None
        if not rosgraph.is_master_online():
            raise BadInput("There is no ROS master: start roslaunch first, or set ROS_MASTER_URI.")
        import rospy

        rospy_connections.init_node("franka_plot", anonymous=True, disable_signals=True)
        self._shutdown: Callable[[str], None] = rospy.signal_shutdown
        super().__init__(Collector(topic, version, most, fields))
        self._require_type(topic)
        if not version:
            name = rospy.resolve_name(topic)
            arm_id = str(rospy.get_param(f"{name.rsplit('/', 1)[0]}/arm_id", ""))  # of the state controller
            self.collector.version = kind_of(name) or kind_of(arm_id)
        self._subscriber = rospy.Subscriber(topic, FrankaState, self._take, queue_size=100)

    def _require_type(self, topic: str) -> None:
        import rospy

        types = dict(rospy.get_published_topics())
        name = rospy.resolve_name(topic)
        if name in types and types[name] != MESSAGE:
            raise BadInput(f"{name} has messages of {types[name]}, not {MESSAGE}.")
        found = sorted(other for other, kind in types.items() if kind == MESSAGE)
        if name not in types:
            others = f" There are: {', '.join(found)}." if found else ""
            raise BadInput(f"No node publishes {name}.{others}")

    def _take(self, message: Any) -> None:
        self.collector.add(message)

    def close(self) -> None:
        self._subscriber.unregister()
        self._shutdown("the plot ended")
