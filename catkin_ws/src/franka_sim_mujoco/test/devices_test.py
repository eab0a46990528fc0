#!/usr/bin/env python3
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Joints of other devices, driven beside the arm as by Gazebo's default hardware."""

import time
import unittest
import xml.etree.ElementTree as ElementTree

import numpy as np
import rospy
import rospy_connections
import rostest
from controller_manager_msgs.srv import ListControllers, LoadController, SwitchController
from franka_msgs.msg import FrankaState
from franka_sim_mujoco.srv import GetBodyPose
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64

WAIT = 40  # wall seconds
MOVE = 2
ARM = [f"panda_joint{i}" for i in range(1, 8)]
FINGERS = ["panda_finger_joint1", "panda_finger_joint2"]


def call(name, kind, *arguments, **fields):
    rospy.wait_for_service(name, WAIT)
    return rospy.ServiceProxy(name, kind)(*arguments, **fields)


class Joints:
    """All joint states of one robot."""

    def __init__(self, namespace):
        self.namespace, self.seen = namespace, []
        rospy.Subscriber(namespace + "/joint_states", JointState, self._take, queue_size=1000)

    def _take(self, message):
        values = zip(message.name, message.position, message.velocity, message.effort)
        self.seen.append({name: rest for name, *rest in values})

    def when(self, condition, what):
        """The states from now to the first that meets a condition."""
        begin = at = len(self.seen)
        end = time.monotonic() + WAIT
        while time.monotonic() < end:
            for i in range(at, len(self.seen)):
                if condition(self.seen[i]):
                    return self.seen[begin : i + 1]
                at = i + 1
            time.sleep(0.002)
        raise AssertionError(f"{what} did not happen; the last state: {self.seen[-1:]}")

    def running(self, *names):
        end = time.monotonic() + WAIT
        while time.monotonic() < end:
            listed = call(self.namespace + "/controller_manager/list_controllers", ListControllers)
            if set(names) <= {c.name for c in listed.controller if c.state == "running"}:
                return True
            time.sleep(0.05)
        return False

    def switch(self, start=(), stop=()):
        for name in start:
            call(self.namespace + "/controller_manager/load_controller", LoadController, name)
        return call(
            self.namespace + "/controller_manager/switch_controller",
            SwitchController,
            start_controllers=start,
            stop_controllers=stop,
            strictness=2,
            timeout=20.0,
        ).ok

    def command(self, controller, value):
        """Latched, so that it arrives."""
        name = f"{self.namespace}/{controller}/command"
        publisher = rospy.Publisher(name, Float64, queue_size=1, latch=True)
        publisher.publish(value)
        return publisher


def masses():
    """Mass of the lift and of everything above it [kg]."""
    links = ElementTree.fromstring(rospy.get_param("robot_description")).iter("mass")
    return [float(mass.get("value")) for mass in links]


class DevicesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy_connections.init_node("devices_test")
        cls.robot, cls.machine = Joints(""), Joints("/machine")
        cls.arm = []
        topic = "/franka_state_controller/franka_states"
        rospy.Subscriber(topic, FrankaState, cls.arm.append, queue_size=1000)
        assert cls.robot.running("lift_position", "head_velocity", "tilt_position", "fan_effort")
        assert cls.machine.running("slide", "joint_state_controller")

    def lift_to(self, height):
        self.robot.command("lift_position", height)
        return self.robot.when(
            lambda state: abs(state["lift"][0] - height) < 1e-4 and abs(state["lift"][1]) < 1e-4,
            f"The lift's motion to {height} m",
        )

    def test_all_joints_are_published(self):
        state = self.robot.when(lambda _: True, "A state")[-1]
        self.assertEqual({*ARM, *FINGERS, "lift", "head", "tilt", "fan"}, set(state))

    def test_the_lift_raises_the_arm_within_its_speed_limit(self):
        self.lift_to(0.0)
        # The arm controller of another test may only just have been stopped.
        self.robot.when(
            lambda _: self.arm[-1].robot_mode != MOVE and max(map(abs, self.arm[-1].dq)) < 1e-5,
            "The arm to rest",
        )
        before = self.arm[-1]
        states = self.lift_to(0.3)
        speeds = [state["lift"][1] for state in states]
        self.assertAlmostEqual(max(speeds), 0.2, delta=1e-3)  # the URDF's limit
        base = call("/gazebo/get_body_pose", GetBodyPose, body="panda_link0").pose
        self.assertAlmostEqual(base.position.z, 0.2 + 0.3, delta=2e-4)
        # When the lift starts and stops, the joints, held by springs, yield: at most until the springs hold
        # the kinetic energy of the whole load at that speed. Then they return to their positions.
        weakest = 2000.0  # [Nm/rad], of the joints' default stiffness
        gives = np.sqrt(sum(masses()) * max(speeds) ** 2 / weakest)
        for state in self.arm[self.arm.index(before) :]:
            self.assertLess(np.abs(np.array(state.q) - before.q).max(), gives)
            self.assertEqual(state.current_errors, type(state.current_errors)())
        self.robot.when(
            lambda _: np.abs(np.array(self.arm[-1].q) - before.q).max() < 1e-3, "The arm to stand again"
        )

    def test_the_lift_effort_is_the_weight_above_it(self):
        self.lift_to(0.3)
        weight = 9.81 * sum(masses())
        states = self.robot.when(
            lambda state: (
                max(abs(value[1]) for value in state.values()) < 1e-3 and abs(state["lift"][2] - weight) < 0.5
            ),
            f"An effort of {weight} N at rest",
        )
        self.assertAlmostEqual(states[-1]["lift"][2], weight, delta=0.5)

    def test_an_arm_controller_runs_beside_the_lift(self):
        self.assertTrue(self.robot.switch(start=["joint_position_example_controller"]))
        begin = len(self.arm)
        self.lift_to(0.1)
        self.lift_to(0.2)
        states = [state for state in self.arm[begin:] if state.robot_mode == MOVE]
        self.assertTrue(self.robot.switch(stop=["joint_position_example_controller"]))
        self.assertGreater(len(states), 10)
        for state in states:
            # The control unit does not know the lift's accelerations at start and stop.
            self.assertLess(np.abs(np.array(state.q) - state.q_d).max(), 5e-3)
        self.assertGreater(np.ptp([state.q_d[0] for state in states]), 0.01)
        # It reports them as external forces, at least at the end; at rest it reports 1e-6 N.
        self.assertGreater(max(abs(state.O_F_ext_hat_K[2]) for state in states), 1e-3)

    def test_velocities(self):
        self.robot.command("head_velocity", 0.5)
        self.robot.when(lambda state: abs(state["head"][1] - 0.5) < 1e-3, "A velocity of 0.5 rad/s")
        self.robot.command("head_velocity", 5.0)
        self.robot.when(lambda state: abs(state["head"][1] - 1.0) < 1e-3, "The limit of 1 rad/s")
        self.assertTrue(self.robot.switch(stop=["head_velocity"]))
        at = self.robot.when(lambda state: abs(state["head"][1]) < 1e-5, "Rest without a controller")
        self.robot.when(lambda state: abs(state["head"][0] - at[-1]["head"][0]) < 1e-4, "Standing there")
        self.assertTrue(self.robot.switch(start=["head_velocity"]))

    def test_one_joint_accepts_either_interface(self):
        self.lift_to(0.1)
        self.assertFalse(self.robot.switch(start=["lift_velocity"]), "it is claimed")
        self.assertTrue(self.robot.switch(start=["lift_velocity"], stop=["lift_position"]))
        self.robot.command("lift_velocity", 0.05)
        states = self.robot.when(lambda state: state["lift"][0] > 0.2, "A motion by velocity")
        self.assertAlmostEqual(states[-1]["lift"][1], 0.05, delta=1e-3)
        self.assertTrue(self.robot.switch(start=["lift_position"], stop=["lift_velocity"]))
        self.lift_to(0.2)

    def test_gains_make_a_compliant_drive(self):
        self.robot.command("tilt_position", 0.2)
        # A proportional drive of 20 Nm/rad; the camera's centre of mass is on the axis.
        self.robot.when(lambda state: abs(state["tilt"][0] - 0.2) < 1e-3, "A tilt of 0.2 rad")

    def test_efforts(self):
        self.robot.command("fan_effort", 0.7)
        speed = (0.7 - 0.2) / 0.5  # at which friction and damping of the URDF use the whole effort
        self.robot.when(lambda state: abs(state["fan"][1] - speed) < 1e-3, f"A speed of {speed} rad/s")
        self.robot.command("fan_effort", 100.0)
        speed = (1.2 - 0.2) / 0.5  # the URDF's limit of the effort
        self.robot.when(lambda state: abs(state["fan"][1] - speed) < 1e-3, f"A speed of {speed} rad/s")
        self.assertTrue(self.robot.switch(stop=["fan_effort"]))
        self.robot.when(lambda state: abs(state["fan"][1]) < 1e-2, "Running out without a controller")
        self.assertTrue(self.robot.switch(start=["fan_effort"]))

    def test_a_machine_without_an_arm(self):
        self.machine.command("slide", 0.25)
        states = self.machine.when(lambda state: abs(state["slide"][0] - 0.25) < 1e-4, "The slide's motion")
        self.assertLess(max(state["slide"][1] for state in states), 1.01)
        self.machine.when(lambda state: abs(state["follower"][0] + 0.25) < 1e-3, "Its mirror's")


if __name__ == "__main__":
    rostest.rosrun("franka_sim_mujoco", "devices", DevicesTest)
