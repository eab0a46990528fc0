# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""teleop_gripper_node between two hands simulated by the test."""

import subprocess
import threading
import time

import actionlib
import pytest
import rospy
from dynamic_reconfigure.client import Client
from franka_gripper.msg import (
    GraspAction,
    GraspResult,
    HomingAction,
    HomingResult,
    MoveAction,
    MoveResult,
    StopAction,
    StopResult,
)
from ros_client import join
from ros_nodes import master
from sensor_msgs.msg import JointState
from waiting import wait_for

DEADLINE = 60.0  # [s]
LIMITS = ["_server_timeout:=50", "_homing_timeout:=50"]  # [s]
WIDEST = 0.08  # [m] of the leader's hand

pytestmark = pytest.mark.own_process


class Hands:
    """The leader's and the follower's actions; `orders` are the goals in the order they came."""

    def __init__(self):
        self.width, self.published = WIDEST, 0  # of the leader's hand [m], and its messages
        self.orders, self.homing_error, self.grasps_forever = [], "", False
        self._servers = []
        for hand in ("leader", "follower"):
            self._serve(f"{hand}/homing", HomingAction, HomingResult)
        self._serve("follower/grasp", GraspAction, GraspResult)
        self._serve("follower/move", MoveAction, MoveResult)
        self._serve("follower/stop", StopAction, StopResult)

    def _serve(self, name, action, result):
        def carry_out(goal):
            self.orders.append((name, goal))
            while name == "follower/grasp" and self.grasps_forever and not server.is_preempt_requested():
                time.sleep(0.01)  # the fault itself
            failed = name.endswith("homing") and self.homing_error
            server.set_succeeded(result(success=not failed, error=self.homing_error if failed else ""))

        server = actionlib.SimpleActionServer(name, action, carry_out, auto_start=False)
        server.start()
        self._servers.append(server)

    def names(self):
        return [name for name, _ in self.orders]

    def publish_until(self, ended):
        fingers = rospy.Publisher("teleop_gripper_node/leader/joint_states", JointState, queue_size=1)
        while not ended.wait(0.02):
            fingers.publish(JointState(position=[self.width / 2.0] * 2))
            self.published += 1


class Node:
    """teleop_gripper_node, and the hands that it moves."""

    def __init__(self, hands, environment, arguments):
        self.hands = hands
        self.process = subprocess.Popen(
            ["rosrun", "franka_example_controllers", "teleop_gripper_node", *LIMITS, *arguments],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            env=dict(environment, PYTHONUNBUFFERED="1"),
        )

    def wait_to_follow(self):
        """Waits until the node reports that it follows the leader's width."""
        printed = ""
        for line in self.process.stdout:
            printed += line
            if "follows the leader's" in line:
                return
        pytest.fail(f"The node has ended: {printed}")

    def wait_for_orders(self, count, what):
        def is_there():
            if self.process.poll() is not None:
                pytest.fail(f"The node has ended: {self.process.stdout.read()}")
            return len(self.hands.orders) >= count

        wait_for(is_there, what, DEADLINE)
        assert len(self.hands.orders) == count, self.hands.orders

    def follow(self, width, orders, what):
        self.hands.width = width
        self.wait_for_orders(orders, what)

    def ends_with(self, status):
        """What it has printed."""
        assert self.process.wait(DEADLINE) == status
        return self.process.stdout.read()


@pytest.fixture(scope="module")
def both_hands(tmp_path_factory):
    with master(tmp_path_factory.mktemp("teleop_gripper")) as started:
        join(started.uri)
        hands, ended = Hands(), threading.Event()
        leader = threading.Thread(target=hands.publish_until, args=[ended])
        leader.start()
        yield hands, started
        ended.set()
        leader.join()
        rospy.signal_shutdown("the test has ended")


@pytest.fixture
def hands(both_hands):
    hands, _ = both_hands
    hands.width = WIDEST
    hands.orders.clear()
    hands.homing_error, hands.grasps_forever = "", False
    return hands


@pytest.fixture
def start(hands, both_hands):
    """Starts the node with arguments."""
    started = []
    # Parameters from the command line of an earlier test's node stay on the server.
    both_hands[1].delete("/teleop_gripper_node")

    def start_node(*arguments):
        started.append(Node(hands, both_hands[1].environment, arguments))
        return started[-1]

    yield start_node
    for node in started:
        node.process.terminate()
        node.process.wait(DEADLINE)


def test_the_follower_follows_with_hysteresis(start, hands):
    node = start()
    node.wait_for_orders(2, "Homing of both")
    assert set(hands.names()) == {"leader/homing", "follower/homing"}
    node.wait_to_follow()
    # The largest width is the one seen after homing, 0.08: grasps below 0.04, opens above 0.048.
    node.follow(0.039, 3, "A grasp")
    name, grasp = hands.orders[-1]
    assert name == "follower/grasp"
    assert (grasp.width, grasp.epsilon.inner, grasp.force, grasp.speed) == (0.0, 0.001, 40.0, 0.3)
    assert grasp.epsilon.outer == pytest.approx(8.0, abs=5e-10)
    client = Client("dyn_reconf_teleop_gripper_param_node", timeout=DEADLINE)
    client.update_configuration({"grasp_force": 12.0, "move_speed": 0.1})
    node.follow(0.049, 4, "The opening")
    name, move = hands.orders[-1]
    assert name == "follower/move"
    assert move.width == pytest.approx(WIDEST, abs=5e-10)
    assert move.speed == 0.1
    # Between the two widths no order is sent: the next one has the next force.
    hands.width, end = 0.041, hands.published + 20
    wait_for(lambda: hands.published > end, "The leader's width", DEADLINE)
    client.update_configuration({"grasp_force": 13.0})
    node.follow(0.0, 5, "The second grasp")
    assert hands.names()[-1] == "follower/grasp"
    assert hands.orders[-1][1].force == 13.0


def test_homed_hands_are_not_homed_again_and_an_endless_grasp_is_stopped(start, hands):
    hands.grasps_forever = True
    node = start("_gripper_homed:=true")
    # The largest width is taken for 0.07: grasps below 0.035.
    node.follow(0.034, 2, "A grasp, and its end")
    assert hands.names() == ["follower/grasp", "follower/stop"]
    assert hands.orders[0][1].force > 0.0
    hands.grasps_forever = False
    node.follow(0.043, 3, "The opening")
    assert hands.orders[-1][1].width == pytest.approx(0.07, abs=5e-10)


def test_failed_homing_is_reported_and_ends_the_node(start, hands):
    hands.homing_error = "a finger is blocked"
    assert "homing failed: a finger is blocked. Clear the fingers" in start().ends_with(1)


def test_missing_hands_are_reported_and_end_the_node(start):
    node = start("leader/homing:=nobody/homing", "_server_timeout:=0.5")
    assert "no action /nobody/homing after 0.5 s" in node.ends_with(1)
