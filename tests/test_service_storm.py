# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Clients call franka_control_node as fast as possible while its robot moves; a subscriber never reads."""

import socket
import struct
import threading
import xmlrpc.client
from pathlib import Path

import pytest
import rospy
from actionlib_msgs.msg import GoalStatus
from control_nodes import ControlNode, node_of, robots_of
from controller_manager_msgs.srv import ListControllers, ListControllerTypes, LoadController, SwitchController
from fci_session import memory_of
from franka_msgs.msg import FrankaState
from pyfranka.franka_sim import FrankaSim
from ros_client import call
from setters import SETTERS
from std_msgs.msg import Bool
from std_srvs.srv import Trigger
from waiting import wait_for

MOVING = "effort_joint_trajectory_controller"
LOOKING = "franka_state_controller"
STATES = "/franka_state_controller/franka_states"
SMALL = 2048  # receive buffer of the subscriber that never reads [B]
PUBLISHED = 300.0  # of franka_states [Hz]: soon more than the buffer of an unread connection
CALLS, CALLS_IN_SHORT = 200, 20  # of each service at least
LONG = 600.0  # [s] for all of them, on a busy machine

pytestmark = pytest.mark.own_process


@pytest.fixture(scope="module")
def running(tmp_path_factory):
    """The node's process, its only arm in motion, and the simulated robot."""
    robots = robots_of("panda", 1, realism="ideal")
    with FrankaSim(*robots, pace="lockstep") as server:
        folder = tmp_path_factory.mktemp("storm")
        with node_of([server], folder, publish_rate=PUBLISHED, shutdown_timeout=40.0) as process:
            node = ControlNode({"panda": server.robot.address})
            node.controllers.load(MOVING)
            node.controllers.start(MOVING)
            node.wait_until_all_are("moving")
            yield process, node, server.robot


class Caller(threading.Thread):
    """Calls one service again and again."""

    def __init__(self, call, is_right, end):
        super().__init__(daemon=True)
        self.call, self.is_right, self.end = call, is_right, end
        self.calls, self.wrong = 0, []

    def run(self):
        while not self.end.is_set():
            try:
                answer = self.call()
                if not self.is_right(answer):
                    self.wrong.append(str(answer)[:300])
            except Exception as error:  # noqa: BLE001 - any exception is a failure
                self.wrong.append(repr(error))
            self.calls += 1


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
        self.socket.settimeout(60.0)
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
            before = reader.received
            wait_for(lambda before=before: reader.received >= before + 20, "Twenty messages for the reader")
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
    """A subscriber that reads all, and counts its messages."""

    def __init__(self):
        super().__init__(daemon=True)
        self.connection = Connection(STATES, FrankaState)
        self.connection.message()
        self.received = 0

    def run(self):
        while self.connection.message():
            self.received += 1


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


def callers_of(node, end):
    """Callers of all services, by name, with the expected answers of a node whose robot moves."""
    callers = {}

    def add(name, call, is_right):
        callers[name] = Caller(call, is_right, end)

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
            switch(**{f"{what}_controllers": [LOOKING]}, strictness=2, timeout=60.0).ok
            for what in ("stop", "start")
        ]

    add("switch_controller", start_and_stop, all)
    add("has_error", has_error, lambda a: a == b"\0")
    add("error_recovery", node.recover, lambda a: a[0] == GoalStatus.SUCCEEDED)
    return callers


def test_every_call_is_answered_while_the_robot_moves(running, long_run):
    process, node, _ = running
    count, pid = CALLS if long_run else CALLS_IN_SHORT, process.process.pid
    (arm,) = node.arms
    errors, modes = set(), set()
    rospy.Subscriber("/franka_control/has_error", Bool, lambda m: errors.add(m.data))
    rospy.Subscriber(STATES, FrankaState, lambda m: modes.add(m.robot_mode))
    begin = arm.state.time
    enough = threading.Event()
    callers = callers_of(node, enough)

    def calls():
        return {name: caller.calls for name, caller in callers.items()}

    def wait_for_calls(count):
        wait_for(
            lambda: min(calls().values()) >= count,
            lambda: f"{count} answers of each service, but {calls()},",
            LONG,
        )

    for caller in callers.values():
        caller.start()
    try:
        wait_for_calls(count // 2)
        settled = memory_of(pid)
        wait_for_calls(count)
        wait_for(lambda: arm.state.time > begin + 1.0, "A second of the motion", LONG)
        end = memory_of(pid)
    finally:
        enough.set()
    for caller in callers.values():
        caller.join()
    print(calls())
    assert {name: caller.wrong for name, caller in callers.items() if caller.wrong} == {}
    assert arm.aborts == [] and True not in errors
    assert modes == {FrankaState.ROBOT_MODE_MOVE}, "The robot did not move all the time."
    assert end - settled < 3.0, f"{settled:.1f} MB have grown to {end:.1f} MB."
    assert end < 60.0


def test_a_client_that_never_reads_blocks_no_other(running):
    pid = running[0].process.pid
    reader, never_read = Reader(), Connection(STATES, FrankaState, SMALL)
    reader.start()
    wait_for(lambda: never_read.is_held_up(reader), "A message that waits to be sent")
    settled, before = memory_of(pid), reader.received
    wait_for(lambda: reader.received > before + 1000, "A thousand messages", LONG)
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
    assert process.interrupt() == 0, process.output
