# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Both nodes of franka_control survive the loss of a robot: silent, killed, restarted.

Sequences of losses and connections are in test_node_properties.py, and combined_test.cpp of franka_hw.
"""

import os
import signal

import pytest
import rospy
from control_nodes import OK, SUCCEEDED, ControlNode, Diagnosis, follow_pose, node_of, robots_of
from franka_msgs.msg import ErrorRecoveryGoal
from geometry_msgs.msg import PoseStamped
from pyfranka.franka_sim import FrankaSim
from pyfranka.sim import KINDS
from ros_client import set_example_parameters
from waiting import wait_for

AGAIN = pytest.mark.long_form("the same with automatic reconnection")
# Number of arms, and whether the node (with two arms: for the second) reconnects automatically.
SETUPS = [
    pytest.param((1, False), id="one arm"),
    pytest.param((1, True), id="one arm reconnects", marks=AGAIN),
]
PAIRS = [pytest.param((2, True), id="two arms")]
POSE, TRAJECTORY = "cartesian_impedance_example_controller", "effort_joint_trajectory_controller"

pytestmark = pytest.mark.own_process("setup")
one_arm = pytest.mark.parametrize("setup", SETUPS, indirect=True, scope="module")
two_arms = pytest.mark.parametrize("setup", PAIRS, indirect=True, scope="module")


@pytest.fixture(scope="module")
def setup(request):
    return request.param


class Node(ControlNode):
    """A node whose robots can be killed and started again."""

    def __init__(self, servers, process, reconnects):
        super().__init__({name: server.robot.address for name, server in servers.items()})
        self.robots, self._process, self.reconnects = servers, process, reconnects
        self.diagnosis = Diagnosis(self.name[1:])
        self.controller = POSE if self.alone else TRAJECTORY
        if self.alone:
            set_example_parameters("panda")
            self.target = rospy.Publisher(f"/{POSE}/equilibrium_pose", PoseStamped, queue_size=1)
        self.controllers.load(self.controller)

    @property
    def log(self):
        return self._process.output

    def start(self, arm):
        robot = KINDS["panda"](name=arm.name, hand=False, address=arm.operator.address)
        self.robots[arm.name] = FrankaSim(robot, pace="patient")
        arm.operator = self.robots[arm.name].robot.remote

    def signal(self, arm, number):
        os.kill(self.robots[arm.name].process.pid, number)

    def kill(self, arm):
        self.robots.pop(arm.name).kill()

    def follow(self, by=0.05):
        """The controller moves its arms: joint by joint, or the only one to a pose."""
        if self.alone:
            return follow_pose(self.arms[0], self.target)
        return self.move_joints(TRAJECTORY, by, 2.0)

    def connect(self):
        """Connects as soon as the robots accept connections."""

        def connected():
            success, message = self.trigger("connect")
            return success or "Already connected" in message

        wait_for(connected, "A connection")

    def answers(self):
        return len(self.controllers.states()) >= 2


@pytest.fixture(scope="module")
def node(setup, tmp_path_factory):
    count, reconnects = setup
    servers = {each.name: FrankaSim(each, pace="patient") for each in robots_of("panda", count)}
    own = {"reconnect": reconnects} if count == 1 else {"panda_2": {"reconnect": reconnects}}
    try:
        with node_of(list(servers.values()), tmp_path_factory.mktemp("lost"), **own) as process:
            yield Node(servers, process, reconnects)
    finally:
        for server in servers.values():
            server.kill()


@pytest.fixture
def moving(node):
    """All robots are there, connected and moving under one controller, whatever happened before."""
    for arm in node.arms:
        if arm.name not in node.robots:
            node.start(arm)
    node.connect()
    node.prepare(node.controller)
    return node


def check_comes_back(node):
    """After the robot's return: connection, recovery, and the controller continues."""
    arm, before = node.arms[0], node.arms[0].state
    if not node.reconnects:
        wait_for(lambda: node.trigger("connect")[0], "A connection")
    wait_for(lambda: arm.state.time != before.time and not arm.is_in("moving"), "A state of the connection")

    def outcome():
        """With the connection comes a new action server: goals are lost before this process is connected."""
        status, text = node.recovery.run(ErrorRecoveryGoal(), 5.0)
        return status is not None and (status, text)

    assert wait_for(outcome, "A result of the recovery") == SUCCEEDED
    node.wait_until_all_are("moving")
    node.follow()


@one_arm
def test_a_silent_robot_is_reported_and_comes_back(moving):
    arm = moving.arms[0]
    lost = moving.log.count("the robot is lost")
    moving.signal(arm, signal.SIGSTOP)
    try:
        wait_for(lambda: arm.has_error, "A report of the silence")
        wait_for(lambda: moving.log.count("the robot is lost") > lost, "Its line in the log")
        assert moving.answers()
    finally:
        moving.signal(arm, signal.SIGCONT)
    check_comes_back(moving)


@two_arms
def test_the_diagnostics_report_each_arm(moving):
    moving.follow()
    for name in (arm.name for arm in moving.arms):
        level, hardware, values = moving.diagnosis.shows(name, "Ready", Mode="Move")
        assert (level, hardware, values["Mode"]) == (OK, name, "Move")
        assert int(values["Commands since the last report"]) > 0
        mean = float(values["From a state to its command, mean [ms]"])
        assert 0.0 < mean <= float(values["From a state to its command, longest [ms]"])
        assert float(values["Latest state behind the promptest [ms]"]) > 0.0
    moving.diagnosis.status_when("Control loop", lambda _, v: int(v["Cycles since the last report"]) > 0)


@two_arms
def test_an_arm_that_reconnects_automatically_moves_on_command(moving):
    other, arm = moving.arms
    moving.kill(arm)
    wait_for(lambda: arm.has_error and other.has_error and other.is_in("idle"), "The report of the loss")
    moving.start(arm)
    shown = moving.diagnosis.status_when(arm.name, lambda _, values: values.get("Mode") == "Idle")
    assert shown[1] == arm.name
    wait_for(lambda: arm.is_in("idle"), "The connection")
    assert f"{arm.name}: the robot is lost." in moving.log
    assert "Trying to connect again every second." in moving.log
    begin = arm.state.time, other.state.time
    while arm.state.time < begin[0] + 1.0 or other.state.time < begin[1] + 1.0:
        assert arm.has_error and not arm.is_in("moving") and not other.is_in("moving"), (
            "It moved without a request."
        )
        wait_for(lambda states=arm.states: arm.states > states, "A new state")
    assert moving.recover() == SUCCEEDED
    moving.wait_until_all_are("moving")
    moving.follow(by=-0.05)
