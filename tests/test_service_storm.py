# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Clients call franka_control_node as fast as possible while its robot moves; a subscriber never reads."""

import socket
import struct
import threading
import time
import xmlrpc.client
from pathlib import Path

import pytest
import ros_nodes
import rospy
from actionlib_msgs.msg import GoalStatus
from control_nodes import ControlNode
from controller_manager_msgs.srv import ListControllers, ListControllerTypes, LoadController, SwitchController
from fci_session import memory_of, simulated
from franka_msgs.msg import FrankaState
from ros_client import Controllers, call, join
from setters import SETTERS
from std_msgs.msg import Bool
from std_srvs.srv import Trigger
from test_node_start import configured
from waiting import wait_for

MOVING = "effort_joint_trajectory_controller"
LOOKING = "franka_state_controller"
STATES = "/franka_state_controller/franka_states"
SMALL = 2048  # receive buffer of the subscriber that never reads [B]
PUBLISHED = 300.0  # of franka_states [Hz]: soon more than the buffer of an unread connection
WITHIN = 10.0  # [s] for any answer: calls queue for four threads, on a busy machine
IN_TIME = 2.0  # [s]
SECONDS, SECONDS_IN_SHORT = 60.0, 8.0

pytestmark = [pytest.mark.own_process, pytest.mark.alone]  # counts lost commands


@pytest.fixture(scope="module")
def running(tmp_path_factory):
    """The node's process, its only arm in motion, and the simulated robot."""
    folder = tmp_path_factory.mktemp("storm")
    with simulated("panda", "lockstep", "--no-hand") as robot, ros_nodes.master(folder) as master:
        master.set("/robot_description", ros_nodes.robot_description("panda"))
        node_parameters = configured("franka_control_node.yaml", arm_id="panda")
        connection = {"robot_ip": robot.address, "realtime_config": "ignore"}
        master.set("/franka_control", dict(node_parameters, **connection))
        for name, values in configured("default_controllers.yaml", arm_id="panda").items():
            master.set(f"/{name}", values)
        master.set("/franka_state_controller/publish_rate", PUBLISHED)
        with master.node("franka_control", "franka_control_node", "franka_control") as process:
            assert process.prints("is ready"), process.output
            join(master.uri)
            controllers = Controllers()
            controllers.load(LOOKING, MOVING)
            controllers.start(LOOKING, MOVING)
            node = ControlNode({"panda": robot.address})
            node.wait_until_all_are("moving")
            yield process, node, robot
            print(process.output[-3000:])
            rospy.signal_shutdown("the test has ended")


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


def callers_of(node, until):
    """Callers of all services, by name, with the expected answers of a node whose robot moves."""
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
    add("error_recovery", node.recover, lambda a: a[0] == GoalStatus.SUCCEEDED)
    return callers


def test_every_call_is_answered_while_the_robot_moves(running, long_run):
    process, node, _ = running
    seconds, pid = SECONDS if long_run else SECONDS_IN_SHORT, process.process.pid
    (arm,) = node.arms
    errors, modes = set(), set()
    rospy.Subscriber("/franka_control/has_error", Bool, lambda m: errors.add(m.data))
    rospy.Subscriber(STATES, FrankaState, lambda m: modes.add(m.robot_mode))
    robot_time = arm.state.time
    callers = callers_of(node, time.monotonic() + seconds)
    for caller in callers.values():
        caller.start()
    time.sleep(0.5 * seconds)
    settled = memory_of(pid)
    for caller in callers.values():
        caller.join()
    end = memory_of(pid)
    reports = {name: caller.report for name, caller in callers.items()}
    print({name: [seen["calls"], round(seen["longest"], 3)] for name, seen in reports.items()})
    assert len(SETTERS) == 7 and len(reports) == len(SETTERS) + 8
    for name, seen in reports.items():
        assert seen["calls"] >= 3, name
        assert seen["failed"] == [] and seen["wrong"] == [], name
        assert seen["longest"] < WITHIN, name
    assert arm.aborts == [] and errors == {False}
    assert modes == {FrankaState.ROBOT_MODE_MOVE}, "The robot did not move all the time."
    assert arm.state.time - robot_time > 0.5
    assert end - settled < 3.0, f"{settled:.1f} MB have grown to {end:.1f} MB."
    assert end < 60.0


def test_a_client_that_never_reads_blocks_no_other(running):
    pid = running[0].process.pid
    reader, never_read = Reader(), Connection(STATES, FrankaState, SMALL)
    reader.start()
    wait_for(lambda: never_read.is_held_up(reader), "A message that waits to be sent")
    settled, before = memory_of(pid), reader.received
    wait_for(lambda: reader.received > before + 1000, "A thousand messages", 60.0)
    # The next message replaces one that is not fetched in time, on a busy machine also for a normal reader.
    assert reader.received > 0.5 * (reader.last - reader.first + 1) > 50
    assert never_read.is_held_up(reader), "All was still sent: nothing was tested."
    never_read.socket.setblocking(False)
    assert len(never_read.socket.recv(16)) == 16, "It is no longer connected."
    assert memory_of(pid) - settled < 3.0


def test_the_node_keeps_serving_and_exits(running):
    """The last test: it ends the node."""
    process, node, robot = running
    node.controllers.stop(MOVING)
    answer = call("/franka_control/set_load", SETTERS["set_load"], load_inertia=[0.0] * 9)
    assert (answer.success, answer.error) == (True, "")
    assert robot.remote.state().mode == "Idle"
    assert process.interrupt() < IN_TIME
