#!/usr/bin/env python3
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Valid and invalid values of every parameter of a simulated robot, and the spawner's own errors."""

import subprocess
import sys
import unittest
from functools import partial
from pathlib import Path
from xmlrpc.client import ServerProxy

import rospy
import rospy_connections
import rostest
from franka_sim_mujoco.srv import (
    DeleteRobot,
    GetBodyPose,
    GetJointStates,
    PushBody,
    PushBodyRequest,
    SpawnRobot,
    SpawnRobotRequest,
    Step,
)
from rosgraph_msgs.msg import Log
from std_srvs.srv import Empty

sys.path.insert(0, str(Path(__file__).resolve().parents[4] / "tests" / "support"))
from ros_client import Controllers, call  # noqa: E402
from waiting import wait_for  # noqa: E402

WAIT = 60
WRONG = [
    # parameter, value, text that the error must contain
    ("arm_id", "left", "left_joint1"),
    ("arm_id", 3, "arm_id"),
    ("tau_ext_lowpass_filter", 1.5, "tau_ext_lowpass_filter"),
    ("tau_ext_lowpass_filter", "much", "tau_ext_lowpass_filter"),
    ("singularity_warning_threshold", [1], "singularity_warning_threshold"),
    ("m_ee", -0.1, "m_ee"),
    ("m_ee", "heavy", "m_ee"),
    ("I_ee", "1 0 0 0 1 0 0 0", "9 finite numbers"),
    ("F_x_Cee", [0.0, 0.0], "3 finite numbers"),
    ("F_T_NE", "1 2 3", "16 finite numbers"),
    ("F_T_NE", [2.0] + [0.0] * 15, "F_T_NE"),
    ("NE_T_EE", "x" * 16, "NE_T_EE"),
    ("EE_T_K", [0.0] * 16, "EE_T_K"),
    ("m_load", -1, "m_load"),
    ("m_load", 730.0, "730 kg; it must lie between 0 and 10 kg"),
    ("F_x_Cload", "0 0 1000", "1000 m from the flange"),
    ("m_ee", 11, "11 kg"),
    ("NE_T_EE", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 1e11 1", "must be within 10 m"),
    ("gravity_vector", "0 0 -9810", "100 m/s^2"),
    ("I_load", "nan 0 0 0 1 0 0 0 1", "I_load"),
    ("F_x_Cload", "0 0 0 0", "F_x_Cload"),
    ("gravity_vector", "0 -9.81", "gravity_vector"),
    (
        "collision_config/lower_torque_thresholds_nominal",
        [20.0] * 6,
        "lower_torque_thresholds_nominal",
    ),
    ("collision_config/upper_torque_thresholds_nominal", [-1.0] * 7, "torque threshold"),
    ("collision_config/lower_force_thresholds_nominal", [-1.0] * 6, "force threshold"),
    (
        "collision_config/upper_force_thresholds_nominal",
        "a b c d e f",
        "upper_force_thresholds_nominal",
    ),
    ("restart_controllers_after_recovery", "yes", "restart_controllers_after_recovery"),
    ("realism", "ice", "realism 'ice': 'ice' is not known there"),
    ("rate_limiting", 1, "rate_limiting"),
    ("cutoff_frequency", 0, "cutoff_frequency"),
    ("internal_controller", "soft", "joint_impedance or cartesian_impedance"),
    ("reflexes", "on", "reflexes"),
    ("robot_type", "ur5", "robot_type is 'ur5'; it must be panda or fr3"),
    ("robot_type", 3, "robot_type"),
    ("motion_generators/position/gains/panda_joint3/p", -1, "stiffnesses"),
    ("joint_state_rate", 0, "above 0 and at most 1000 Hz"),
    ("publish_transforms", "yes", "publish_transforms"),
    ("awaited_controllers", 3, "awaited_controllers"),
]

"""

"""


class ParametersTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy_connections.init_node("parameters_test")

    def setUp(self):
        self.spawn_service = partial(call, "/gazebo/spawn_robot", SpawnRobot)
        self.delete = partial(call, "/gazebo/delete_robot", DeleteRobot)
        self.push = partial(call, "/gazebo/push_body", PushBody)
        self.step = partial(call, "/gazebo/step", Step)
        self.joints = partial(call, "/gazebo/get_joint_states", GetJointStates)
        self.pose = partial(call, "/gazebo/get_body_pose", GetBodyPose)
        self.pause = partial(call, "/gazebo/pause_physics", Empty)
        self.unpause = partial(call, "/gazebo/unpause_physics", Empty)
        self.panda = rospy.get_param("/panda_description")

    def spawn(self, name, namespace, urdf=None, joints=()):
        order = SpawnRobotRequest(
            name=name, urdf=self.panda if urdf is None else urdf, robot_namespace=namespace
        )
        order.pose.orientation.w = 1
        order.joint_names = [joint for joint, _ in joints]
        order.joint_positions = [position for _, position in joints]
        return self.spawn_service(order)

    def test_wrong_parameters_are_reported_and_leave_no_robot(self):
        for number, (name, value, expected) in enumerate(WRONG):
            namespace = f"/wrong{number}"
            rospy.set_param(namespace + "/arm_id", "panda")
            rospy.set_param(f"{namespace}/{name}", value)
            answer = self.spawn("panda", namespace)
            self.assertFalse(answer.success, f"{name}={value!r} was taken")
            self.assertIn(expected, answer.error)
            self.assertNotIn("\n", answer.error.strip())
        answer = self.delete("panda")
        self.assertFalse(answer.success)

    def test_right_parameters_are_accepted_as_lists_and_strings(self):
        for name, value in {
            "arm_id": "panda",
            "m_ee": 0.5,
            "F_x_Cee": "0.01 0 0.03",
            "I_ee": [0.001, 0, 0, 0, 0.002, 0, 0, 0, 0.003],
            "m_load": 1,
            "F_x_Cload": [0.0, 0.0, 0.1],
            "EE_T_K": "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0.02 1",
            "tau_ext_lowpass_filter": 0.5,
            "realism": "real",
        }.items():
            rospy.set_param("/right/" + name, value)
        answer = self.spawn("panda", "/right")
        self.assertTrue(answer.success, answer.error)
        twice = self.spawn("panda", "/right")
        self.assertFalse(twice.success)
        self.assertIn("panda", twice.error)
        # A second robot with another type, name and namespace.
        rospy.set_param("/second/arm_id", "right")
        answer = self.spawn("right", "/second", rospy.get_param("/fr3_description"))
        self.assertTrue(answer.success, answer.error)
        self.assertTrue(self.delete("panda").success)
        self.assertTrue(self.delete("right").success)

    def test_robot_type_overrides_urdf_and_warns_on_mismatch(self):
        messages, log = self.listen_to_log()
        rospy.set_param("/believed", {"robot_type": "panda", "arm_id": "right"})
        # Joint 6 is in the range of an FR3, outside that of a Panda.
        bent = [("right_joint2", -0.8), ("right_joint4", -2.4), ("right_joint6", 4.3)]
        answer = self.spawn("machine", "/believed", rospy.get_param("/fr3_description"), bent)
        self.assertFalse(answer.success)
        self.assertIn("its stops are at -0.0375 and 3.7725", answer.error)
        self.expect_warning(
            messages,
            "'machine' is simulated as panda, as the parameter /believed/robot_type says, although it",
        )
        log.unregister()

    @staticmethod
    def publishers_of(topic):
        _, _, (publishers, _, _) = rospy.get_master().getSystemState()
        return dict(publishers)[topic]

    def listen_to_log(self):
        """@returns a list that all further messages of the log are added to, and its subscriber."""
        messages, master = [], rospy.get_master()
        log = rospy.Subscriber("/rosout", Log, messages.append)

        def heard():
            """Their number would not do: a node of the test before this one may still be among them."""
            addresses = {master.lookupNode(node)[2] for node in self.publishers_of("/rosout")}
            connections = ServerProxy(rospy.get_node_uri()).getBusInfo(rospy.get_name())[2]
            return addresses <= {address for _, address, _, _, topic, *_ in connections if topic == "/rosout"}

        wait_for(heard, "Every node's log")
        return messages, log

    def expect_warning(self, messages, text):
        """The first warning of the log that contains the text. @param messages of listen_to_log"""

        def found():
            return [message.msg for message in messages if text in message.msg and message.level == Log.WARN]

        return wait_for(found, lambda: f"'{text}' in {[message.msg for message in messages]}")[0]

    def test_positions_of_unknown_joints_are_ignored_with_a_warning(self):
        messages, log = self.listen_to_log()
        rospy.set_param("/handless/arm_id", "right")
        fingers = [(f"right_finger_joint{i}", 0.001) for i in (1, 2)]
        joints = [("right_joint1", 0.25), ("right_joint4", -1.5), ("right_joint6", 1.5), *fingers]
        answer = self.spawn("right", "/handless", rospy.get_param("/fr3_description"), joints)
        self.assertTrue(answer.success, answer.error)
        self.assertAlmostEqual(self.joints(["right_joint1"]).state.position[0], 0.25)
        self.expect_warning(messages, "right_finger_joint1, right_finger_joint2. They are ignored")
        log.unregister()
        self.assertTrue(self.delete("right").success)

    def test_a_robot_that_begins_within_another_one_is_reported(self):
        messages, log = self.listen_to_log()
        rospy.set_param("/first/arm_id", "panda")
        rospy.set_param("/within/arm_id", "right")
        self.assertTrue(self.spawn("panda", "/first").success)
        answer = self.spawn("right", "/within", rospy.get_param("/fr3_description"))
        self.assertTrue(answer.success, answer.error)
        warning = self.expect_warning(messages, "The robot 'right' begins within other bodies")
        self.assertIn("right_link1 and panda_link1", warning)
        self.assertIn("Give it another place (x, y, z)", warning)
        self.assertFalse([m.msg for m in messages if "The robot 'panda' begins" in m.msg])
        log.unregister()
        self.assertTrue(self.delete("right").success)
        self.assertTrue(self.delete("panda").success)

    def test_the_namespace_of_the_description_is_used(self):
        # The manual's own snippet of the plugin.
        messages, log = self.listen_to_log()
        end = "</robotSimType>"
        urdf = self.panda.replace(end, end + "<robotNamespace>own_name</robotNamespace>")
        self.assertNotEqual(urdf, self.panda)
        rospy.set_param("/own_name/arm_id", "panda")
        answer = self.spawn("panda", "/ordered", urdf)
        self.assertTrue(answer.success, answer.error)
        Controllers("/own_name").states()
        self.assertFalse([topic for topic, _ in rospy.get_published_topics() if topic.startswith("/ordered")])
        self.expect_warning(messages, "uses the namespace /own_name")
        log.unregister()
        self.assertTrue(self.delete("panda").success)

    def test_gains_without_effect_are_named_in_one_warning(self):
        messages, log = self.listen_to_log()
        gains = {f"panda_joint{i}": {"p": 600, "i": 0, "d": 30} for i in range(1, 8)}
        rospy.set_param("/gains/arm_id", "panda")
        rospy.set_param("/gains/motion_generators/position/gains", gains)
        rospy.set_param("/gains/motion_generators/velocity/gains", gains)
        self.assertTrue(self.spawn("panda", "/gains").success)
        warning = self.expect_warning(messages, "have no effect")
        log.unregister()
        self.assertIn("/gains/motion_generators/velocity/gains, ", warning)
        self.assertIn("/gains/motion_generators/position/gains/*/d.", warning)
        self.assertNotIn("/i", warning)
        self.assertTrue(self.delete("panda").success)

    def test_a_position_gain_is_the_stiffness_of_its_joint(self):
        stiffness, force = 500.0, 5.0
        joints = [f"panda_joint{i}" for i in range(1, 8)]
        rospy.set_param("/soft/arm_id", "panda")
        rospy.set_param("/soft/motion_generators/position/gains/panda_joint1/p", stiffness)
        kind = "position_controllers/JointGroupPositionController"
        rospy.set_param("/soft/hold", {"type": kind, "joints": joints})
        bent = [("panda_joint2", -0.8), ("panda_joint4", -2.4), ("panda_joint6", 1.6)]
        self.assertTrue(self.spawn("panda", "/soft", joints=bent).success)
        try:
            self.unpause()
            Controllers("/soft").load("hold")
            Controllers("/soft").start("hold")
            self.pause()
            before = self.joints(joints).state.position[0]
            push = PushBodyRequest(body="panda_link7", ticks=3000)
            push.force.y = force
            self.assertTrue(self.push(push).success)
            self.assertTrue(self.step(2999).success)
            deflection = self.joints(joints).state.position[0] - before
            lever = self.pose("panda_link7").pose.position.x
            self.assertAlmostEqual(deflection, force * lever / stiffness, delta=2e-5)
        finally:
            self.pause()
            self.assertTrue(self.delete("panda").success)

    def test_a_control_period_without_whole_ticks_is_refused(self):
        rospy.set_param("/period/arm_id", "panda")
        for period in ("0", "0.0001", "0.0015", "1.001", "-0.001", "nan", "fast"):
            urdf = self.panda.replace("<controlPeriod>0.001<", f"<controlPeriod>{period}<")
            answer = self.spawn("panda", "/period", urdf)
            self.assertFalse(answer.success, period)
            self.assertIn("controlPeriod", answer.error)

    def test_wrong_spawn_requests_are_refused(self):
        rospy.set_param("/order/arm_id", "panda")
        for expected, answer in (
            ("name", self.spawn("", "/order")),
            ("not a URDF", self.spawn("panda", "/order", "not a URDF")),
            (
                "panda_joint1",
                self.spawn("panda", "/order", joints=[("panda_joint1", float("nan"))]),
            ),
            ("namespace", self.spawn("panda", "/no good")),
            (
                "no/Such",
                self.spawn("panda", "/order", self.panda.replace("franka_gazebo/FrankaHWSim", "no/Such")),
            ),
            (
                "gazebo:=true",
                self.spawn(
                    "panda",
                    "/order",
                    self.panda.replace(
                        "hardware_interface/EffortJointInterface",
                        "hardware_interface/VelocityJointInterface",
                    ),
                ),
            ),
        ):
            self.assertFalse(answer.success, expected)
            self.assertIn(expected, answer.error)

    def run_spawner(self, *arguments):
        done = subprocess.run(
            ["rosrun", "franka_sim_mujoco", "spawn_robot", *arguments],
            capture_output=True,
            text=True,
            timeout=WAIT,
        )
        return done.returncode, done.stdout + done.stderr

    def test_spawner_reports_errors_and_exits_with_a_status(self):
        status, text = self.run_spawner("-param", "nothing_here", "-model", "panda")
        self.assertEqual(status, 1, text)
        self.assertIn("/nothing_here", text)
        status, text = self.run_spawner(
            "-param", "panda_description", "-model", "panda", "-J", "panda_joint1", "x"
        )
        self.assertEqual(status, 1, text)
        self.assertIn("not a number", text)
        status, text = self.run_spawner(
            "-param",
            "panda_description",
            "-model",
            "panda",
            "-timeout",
            "1",
            "-gazebo_namespace",
            "/nobody",
        )
        self.assertEqual(status, 1, text)
        self.assertIn("/nobody/spawn_robot", text)
        rospy.set_param("/script/arm_id", "panda")
        status, text = self.run_spawner(
            "-param",
            "panda_description",
            "-model",
            "panda",
            "-robot_namespace",
            "/script",
            "-J",
            "panda_joint2",
            "-0.5",
        )
        self.assertEqual(status, 0, text)
        self.assertTrue(self.delete("panda").success)

    def test_the_node_reports_errors_and_exits_with_a_status(self):
        for wrong, expected in (
            ("_world:=/nowhere/moon.sdf", "moon"),
            ("_real_time_factor:=-1", "real time factor"),
            ("_pub_clock_frequency:=1001", "at most 1000 Hz"),
            ("_pub_clock_frequency:=-1", "at most 1000 Hz"),
            ("_real_time_factor:=fast", "real_time_factor"),
            ("_paused:=3", "paused"),
        ):
            if rospy.has_param("/other"):
                rospy.delete_param("/other")
            done = subprocess.run(
                ["rosrun", "franka_sim_mujoco", "franka_sim_mujoco_node", "__name:=other", wrong],
                capture_output=True,
                text=True,
                timeout=WAIT,
            )
            text = done.stdout + done.stderr
            self.assertEqual(done.returncode, 1, text)
            self.assertEqual(text.count("FATAL"), 1, text)
            self.assertIn(expected, text)


if __name__ == "__main__":
    rostest.rosrun("franka_sim_mujoco", "parameters", ParametersTest, sys.argv)
