#!/usr/bin/env python3
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""teleop_gripper_node between two hands simulated by the test."""

import os
import subprocess
import threading
import time
import unittest

import actionlib
import rospy
import rospy_connections
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
from sensor_msgs.msg import JointState

DEADLINE = 60.0  # [s]
WIDEST = 0.08  # [m] of the leader's hand


class Hands:
    """The leader's and the follower's actions; `orders` are the goals in the order they came."""

    def __init__(self):
        self.orders, self.homing_error, self.grasp_lasts = [], "", 0.0
        self._servers = []
        for hand in ("leader", "follower"):
            self._serve(f"{hand}/homing", HomingAction, HomingResult)
        self._serve("follower/grasp", GraspAction, GraspResult)
        self._serve("follower/move", MoveAction, MoveResult)
        self._serve("follower/stop", StopAction, StopResult)

    def _serve(self, name, action, result):
        def carry_out(goal):
            self.orders.append((name, goal))
            end = time.monotonic() + (self.grasp_lasts if name == "follower/grasp" else 0.0)
            while time.monotonic() < end and not server.is_preempt_requested():
                time.sleep(0.01)
            failed = name.endswith("homing") and self.homing_error
            server.set_succeeded(result(success=not failed, error=self.homing_error if failed else ""))

        server = actionlib.SimpleActionServer(name, action, carry_out, auto_start=False)
        server.start()
        self._servers.append(server)

    def names(self):
        return [name for name, _ in self.orders]


class TeleopGripperTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.hands = Hands()
        cls.fingers = rospy.Publisher("teleop_gripper_node/leader/joint_states", JointState, queue_size=1)
        cls.width = WIDEST
        cls.ended = threading.Event()
        threading.Thread(target=cls.publish, daemon=True).start()

    @classmethod
    def tearDownClass(cls):
        cls.ended.set()

    @classmethod
    def publish(cls):
        while not cls.ended.wait(0.02):
            cls.fingers.publish(JointState(position=[cls.width / 2.0] * 2))

    def setUp(self):
        type(self).width = WIDEST
        self.hands.orders.clear()
        self.hands.homing_error, self.hands.grasp_lasts = "", 0.0
        # Parameters from the command line of an earlier test's node stay on the server.
        if rospy.has_param("teleop_gripper_node"):
            rospy.delete_param("teleop_gripper_node")
        self.node = None

    def tearDown(self):
        if self.node is not None and self.node.poll() is None:
            self.node.terminate()
            self.node.wait(DEADLINE)

    def start(self, *arguments):
        command = ["rosrun", "franka_example_controllers", "teleop_gripper_node", *arguments]
        self.node = subprocess.Popen(
            command,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            env=dict(os.environ, PYTHONUNBUFFERED="1"),
        )

    def wait_to_follow(self):
        """Waits until the node reports that it follows the leader's width."""
        said = ""
        for line in self.node.stdout:
            said += line
            if "follows the leader's" in line:
                return
        self.fail(f"The node has ended: {said}")

    def wait_for(self, condition, what):
        end = time.monotonic() + DEADLINE
        while not condition():
            self.assertLess(time.monotonic(), end, f"{what}: {self.hands.orders}")
            if self.node.poll() is not None:
                self.fail(f"The node has ended: {self.node.stdout.read()}")
            time.sleep(0.01)

    def follow(self, width, orders, what):
        type(self).width = width
        self.wait_for(lambda: len(self.hands.orders) == orders, what)

    def test_follows_with_hysteresis(self):
        self.start()
        self.wait_for(lambda: len(self.hands.orders) == 2, "Homing of both")
        self.assertEqual({"leader/homing", "follower/homing"}, set(self.hands.names()))
        self.wait_to_follow()
        # The largest width is the one seen after homing, 0.08: grasps below 0.04, opens above 0.048.
        self.follow(0.039, 3, "A grasp")
        name, grasp = self.hands.orders[-1]
        self.assertEqual("follower/grasp", name)
        self.assertEqual(
            (0.0, 0.001, 40.0, 0.3), (grasp.width, grasp.epsilon.inner, grasp.force, grasp.speed)
        )
        self.assertAlmostEqual(8.0, grasp.epsilon.outer, places=9)
        client = Client("dyn_reconf_teleop_gripper_param_node", timeout=DEADLINE)
        client.update_configuration({"grasp_force": 12.0, "move_speed": 0.1})
        self.follow(0.049, 4, "The opening")
        name, move = self.hands.orders[-1]
        self.assertEqual("follower/move", name)
        self.assertAlmostEqual(WIDEST, move.width, places=9)
        self.assertEqual(0.1, move.speed)
        # Between the two widths no order is sent: the next order must belong to the next width.
        type(self).width = 0.041
        time.sleep(0.3)
        self.follow(0.0, 5, "The second grasp")
        self.assertEqual("follower/grasp", self.hands.names()[-1])
        self.assertEqual(12.0, self.hands.orders[-1][1].force)

    def test_homed_hands_are_not_homed_again_and_an_endless_grasp_is_stopped(self):
        self.hands.grasp_lasts = 60.0
        self.start("_gripper_homed:=true")
        # The largest width is taken for 0.07: grasps below 0.035.
        self.follow(0.034, 2, "A grasp, and its end")
        self.assertEqual(["follower/grasp", "follower/stop"], self.hands.names())
        self.assertLess(0.0, self.hands.orders[0][1].force)
        self.hands.grasp_lasts = 0.0
        self.follow(0.043, 3, "The opening")
        self.assertAlmostEqual(0.07, self.hands.orders[-1][1].width, places=9)

    def test_reports_failed_homing_and_exits(self):
        self.hands.homing_error = "a finger is blocked"
        self.start()
        self.assertEqual(1, self.node.wait(DEADLINE))
        said = self.node.stdout.read()
        self.assertIn("homing failed: a finger is blocked. Clear the fingers", said)

    def test_reports_missing_hands_and_exits(self):
        self.start("leader/homing:=nobody/homing", "_server_timeout:=0.5")
        self.assertEqual(1, self.node.wait(DEADLINE))
        self.assertIn("no action /nobody/homing after 0.5 s", self.node.stdout.read())


if __name__ == "__main__":
    import rostest

    rospy_connections.init_node("teleop_gripper_test")
    rostest.rosrun("franka_example_controllers", "teleop_gripper", TeleopGripperTest)
