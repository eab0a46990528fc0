# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Calls every service of a moving franka_control_node as fast as possible; prints a report as JSON.

Run by test_service_storm.py with ROS's interpreter. Arguments: the node's process, and how long [s].
"""

import json
import socket
import struct
import sys
import threading
import time
import xmlrpc.client
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent / "support"))

import rospy  # noqa: E402
import rospy_connections  # noqa: E402
from actionlib_msgs.msg import GoalStatus  # noqa: E402
from controller_manager_msgs.srv import (  # noqa: E402
    ListControllers,
    ListControllerTypes,
    LoadController,
    SwitchController,
)
from fci_session import memory_of  # noqa: E402
from franka_msgs.msg import FrankaState  # noqa: E402
from recovery_client import Robot  # noqa: E402
from setters import SETTERS  # noqa: E402
from std_msgs.msg import Bool  # noqa: E402
from std_srvs.srv import Trigger  # noqa: E402

MOVING = "effort_joint_trajectory_controller"
LOOKING = "franka_state_controller"
STATES = "/franka_state_controller/franka_states"
SMALL = 2048  # receive buffer of the subscriber that never reads [B]


class Caller(threading.Thread):
    """Calls one service again and again."""

    def __init__(self, call, is_right, until):
        super().__init__()
        self.call, self.is_right, self.until = call, is_right, until
        self.report = {"calls": 0, "longest": 0.0, "failed": [], "wrong": []}

    def run(self):
        while time.monotonic() < self.until:
            begin = time.monotonic()
            try:
                answer = self.call()
                if not self.is_right(answer):
                    self.report["wrong"].append(str(answer)[:300])
            except Exception as error:  # noqa: BLE001 - any exception is a failure
                self.report["failed"].append(str(error))
            self.report["calls"] += 1
            self.report["longest"] = max(self.report["longest"], time.monotonic() - begin)


class Connection:
    """A subscription on the bare socket."""

    def __init__(self, topic, kind, receive_buffer=None):
        uri = rospy.get_master().lookupNode("/franka_control")[2]
        _, _, (_, host, port) = xmlrpc.client.ServerProxy(uri).requestTopic(
            rospy.get_name(), topic, [["TCPROS"]]
        )
        self.socket = socket.socket()
        if receive_buffer:
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_buffer)
        self.socket.settimeout(30.0)
        self.socket.connect((host, port))
        fields = {"callerid": rospy.get_name(), "topic": topic, "type": kind._type, "md5sum": kind._md5sum}
        header = b"".join(
            struct.pack("<I", len(f)) + f
            for f in (f"{name}={value}".encode() for name, value in fields.items())
        )
        self.socket.sendall(struct.pack("<I", len(header)) + header)

    def message(self):
        """The next message; the first one is the publisher's header."""
        size = struct.unpack("<I", self._read(4))[0]
        return self._read(size)

    def _read(self, size):
        data = b""
        while len(data) < size:
            part = self.socket.recv(size - len(data))
            if not part:
                raise ConnectionError("The publisher has closed the connection.")
            data += part
        return data

    def is_held_up(self, reader):
        """Whether bytes wait at the publisher while it goes on sending to a reader."""
        for _ in range(5):
            if self.waiting_to_be_sent() == 0:
                return False
            before, end = reader.received, time.monotonic() + 5.0
            while reader.received < before + 20 and time.monotonic() < end:
                time.sleep(0.01)
        return self.waiting_to_be_sent() > 0

    def waiting_to_be_sent(self):
        """Unsent bytes on the publisher's side [B]."""
        here = self.socket.getsockname()[1]
        for line in Path("/proc/net/tcp").read_text().splitlines()[1:]:
            _, _, remote, _, queues = line.split()[:5]
            if int(remote.split(":")[1], 16) == here:
                return int(queues.split(":")[0], 16)
        return 0


class Reader(threading.Thread):
    """A subscriber that reads all: counts received and published messages."""

    def __init__(self):
        super().__init__(daemon=True)
        self.connection = Connection(STATES, FrankaState)
        self.connection.message()
        self.first, self.last, self.received = None, None, 0

    def run(self):
        while True:
            number = struct.unpack("<I", self.connection.message()[:4])[0]  # the header's seq comes first
            self.first = number if self.first is None else self.first
            self.last, self.received = number, self.received + 1


def has_error():
    """The latched message for a new subscriber."""
    connection = Connection("/franka_control/has_error", Bool)
    try:
        connection.message()
        return connection.message()
    finally:
        connection.socket.close()


def proxy(name, kind):
    return rospy.ServiceProxy(name, kind, persistent=True)


def storm(robot, until):
    """Callers of all services, with the expected answers of a node whose robot moves."""
    callers = {}

    def add(name, call, is_right):
        callers[name] = Caller(call, is_right, until)

    for name, kind in SETTERS.items():
        add(name, proxy(f"/franka_control/{name}", kind), lambda a: not a.success and "Stop that" in a.error)
    for name, sentence in (("connect", "Already connected"), ("disconnect", "Cannot disconnect")):
        add(name, proxy(f"/franka_control/{name}", Trigger), lambda a, s=sentence: s in a.message)
    manager = "/controller_manager"
    add(
        "list_controllers",
        proxy(f"{manager}/list_controllers", ListControllers),
        lambda a: MOVING in [c.name for c in a.controller if c.state == "running"],
    )
    add(
        "list_controller_types",
        proxy(f"{manager}/list_controller_types", ListControllerTypes),
        lambda a: "franka_control/FrankaStateController" in a.types,
    )
    load = proxy(f"{manager}/load_controller", LoadController)
    add("load_controller", lambda: load("there_is_no_such_controller"), lambda a: not a.ok)
    switch = proxy(f"{manager}/switch_controller", SwitchController)

    def start_and_stop():
        return [
            switch(**{f"{what}_controllers": [LOOKING]}, strictness=2, timeout=10.0).ok
            for what in ("stop", "start")
        ]

    add("switch_controller", start_and_stop, all)
    add("has_error", has_error, lambda a: a == b"\0")
    add("error_recovery", robot.recover, lambda a: a[0] == GoalStatus.SUCCEEDED)
    return callers


def main():
    rospy_connections.init_node("storm_client", anonymous=True)
    pid, seconds = int(sys.argv[1]), float(sys.argv[2])
    robot, errors, modes = Robot(), set(), set()
    rospy.Subscriber("/franka_control/has_error", Bool, lambda m: errors.add(m.data))
    report = {"moves": robot.shows(FrankaState.ROBOT_MODE_MOVE)}
    reader, never_read = Reader(), Connection(STATES, FrankaState, SMALL)
    reader.start()
    rospy.Subscriber(STATES, FrankaState, lambda m: modes.add(m.robot_mode))
    begin, robot_time = time.monotonic(), robot.state.time
    callers = storm(robot, begin + seconds)
    for caller in callers.values():
        caller.start()
    time.sleep(0.5 * seconds)
    memory = [memory_of(pid)]
    for caller in callers.values():
        caller.join()
    robot.waits(lambda: never_read.is_held_up(reader))
    before = reader.received
    robot.waits(lambda: reader.received > before + 20)
    memory.append(memory_of(pid))
    report["never_read"] = {"held_up": never_read.is_held_up(reader)}
    never_read.socket.setblocking(False)
    report["never_read"]["connected"] = len(never_read.socket.recv(16)) == 16
    report["reader"] = {"received": reader.received, "published": reader.last - reader.first + 1}
    report["memory"] = memory
    report["robot_time"] = robot.state.time - robot_time
    report["storm"] = {name: caller.report for name, caller in callers.items()}
    report["aborts"], report["errors"], report["modes"] = robot.aborts, sorted(errors), sorted(modes)
    switch = rospy.ServiceProxy("/controller_manager/switch_controller", SwitchController)
    report["stopped"] = switch(stop_controllers=[MOVING], strictness=2, timeout=10.0).ok
    answer = rospy.ServiceProxy("/franka_control/set_load", SETTERS["set_load"])(load_inertia=[0.0] * 9)
    report["set_afterwards"] = [answer.success, answer.error]
    print(json.dumps(report))


if __name__ == "__main__":
    main()
