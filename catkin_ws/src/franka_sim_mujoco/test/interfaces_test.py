#!/usr/bin/env python3
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Interfaces, services and state of the simulated arm, as in the manual's tables."""

import math
import sys
import time
import unittest

import actionlib
import numpy as np
import rospy
import rospy_connections
import rostest
from actionlib_msgs.msg import GoalStatus
from controller_manager_msgs.srv import ListControllers, LoadController, SwitchController
from franka_msgs.msg import ErrorRecoveryAction, ErrorRecoveryGoal, FrankaState
from franka_msgs.srv import (
    SetCartesianImpedance,
    SetEEFrame,
    SetForceTorqueCollisionBehavior,
    SetFullCollisionBehavior,
    SetJointConfiguration,
    SetJointImpedance,
    SetKFrame,
    SetLoad,
)
from franka_sim_mujoco.srv import PushBody, Step
from geometry_msgs.msg import Point, Vector3
from std_srvs.srv import SetBool, Trigger

IDLE, MOVE, REFLEX, USER_STOPPED = 1, 2, 4, 5
IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
START = [0, -math.pi / 4, 0, -3 * math.pi / 4, 0, math.pi / 2, math.pi / 4]
WAIT = 30  # wall seconds


def call(name, kind, *arguments, **fields):
    rospy.wait_for_service(name, WAIT)
    return rospy.ServiceProxy(name, kind)(*arguments, **fields)


def matrix(values, rows):
    return np.array(values).reshape(-1, rows).T


class Arm:
    """One robot through its topics and services."""

    def __init__(self, namespace, arm_id):
        self.namespace, self.arm_id, self.states = namespace, arm_id, []
        topic = namespace + "/franka_state_controller/franka_states"
        self.subscriber = rospy.Subscriber(topic, FrankaState, self.states.append, queue_size=1000)

    def service(self, name, kind, *arguments, **fields):
        return call(f"{self.namespace}/franka_control/{name}", kind, *arguments, **fields)

    def when(self, condition):
        """The next state that meets a condition; by its stamp, because states lag behind services."""
        now = call("/gazebo/step", Step, 0).time
        begin, end = len(self.states), time.monotonic() + WAIT
        while time.monotonic() < end:
            states = self.states[begin:]
            for state in states:
                if state.header.stamp > now and condition(state):
                    return state
            begin += len(states)
            time.sleep(0.002)
        raise AssertionError(f"no state met the condition; the last: {self.states[-1:]}")

    def state(self):
        return self.when(lambda _: True)

    def after(self, seconds):
        begin = self.state().time
        return self.when(lambda state: state.time - begin >= seconds)

    def controllers(self):
        listed = call(self.namespace + "/controller_manager/list_controllers", ListControllers)
        return {controller.name: controller.state for controller in listed.controller}

    def load(self, name):
        if name not in self.controllers():
            assert call(self.namespace + "/controller_manager/load_controller", LoadController, name).ok, name

    def switch(self, start=(), stop=()):
        for name in start:
            self.load(name)
        return call(
            self.namespace + "/controller_manager/switch_controller",
            SwitchController,
            start_controllers=start,
            stop_controllers=stop,
            strictness=2,
            timeout=20.0,
        ).ok

    def run(self, name, seconds):
        """States of a controller from its start to its stop."""
        assert self.switch(start=[name]), name
        first = self.state()
        self.when(lambda state: state.time - first.time >= seconds)
        states = self.states[self.states.index(first) :]
        assert self.switch(stop=[name]), name
        return states

    def recover(self):
        client = actionlib.ActionClient(
            self.namespace + "/franka_control/error_recovery", ErrorRecoveryAction
        )
        client.wait_for_server()
        handle = client.send_goal(ErrorRecoveryGoal())
        end = time.monotonic() + WAIT
        while handle.get_comm_state() != actionlib.CommState.DONE and time.monotonic() < end:
            time.sleep(0.005)
        return handle.get_goal_status(), handle.get_goal_status_text()

    def place(self, positions=START):
        names = [f"{self.arm_id}_joint{i}" for i in range(1, 8)]
        return call(
            self.namespace + "/set_franka_model_configuration",
            SetJointConfiguration,
            joint_names=names,
            joint_positions=positions,
        )


class InterfacesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy_connections.init_node("interfaces_test")
        cls.arm = Arm("", rospy.get_param("~arm_id", "panda"))
        cls.strict = Arm("/strict", "strict")
        for arm, desired in ((cls.arm, "franka_state_controller"), (cls.strict, "hold")):
            end = time.monotonic() + 60
            while arm.controllers().get(desired) != "running":
                assert time.monotonic() < end, f"{desired} does not run: {arm.controllers()}"
                time.sleep(0.05)

    def setUp(self):
        running = [name for name, state in self.arm.controllers().items() if state == "running"]
        self.arm.switch(stop=[name for name in running if name != "franka_state_controller"])
        self.arm.place()
        self.arm.when(lambda state: state.robot_mode == IDLE and max(map(abs, state.dq)) < 1e-4)

    def follows(self, states, tolerance=1e-3):
        """Fails on errors in the states, or if the arm did not follow its desired positions."""
        for state in states:
            self.assertEqual(state.robot_mode, MOVE)
            self.assertEqual(state.current_errors, type(state.current_errors)())
            self.assertEqual(state.control_command_success_rate, 1.0)
            self.assertLess(max(abs(a - b) for a, b in zip(state.q, state.q_d)), tolerance)

    # interfaces

    def test_position_joint_interface(self):
        before = self.arm.state().q_d
        states = self.arm.run("joint_position_example_controller", 10.5)
        self.follows(states)
        for state in states:
            delta = state.q_d[0] - before[0]
            for i in range(7):
                self.assertAlmostEqual(state.q_d[i] - before[i], -delta if i == 4 else delta, delta=1e-9)
        # A period of 10 s: the highest point is twice the amplitude.
        highest = max(state.q_d[0] - before[0] for state in states)
        self.assertAlmostEqual(highest, 2 * 0.2 * math.pi / 16, delta=1e-4)

    def test_velocity_joint_interface(self):
        before = self.arm.state().q_d
        states = self.arm.run("joint_velocity_example_controller", 9)
        self.follows(states)
        self.assertAlmostEqual(max(state.dq_d[3] for state in states), 0.1, delta=1e-4)
        moved = max(state.q_d[3] for state in states) - before[3]
        self.assertAlmostEqual(moved, 0.1 / 2 * 8, delta=2e-3)  # the mean velocity, 8 s long

    def test_pose_cartesian_interface(self):
        before = matrix(self.arm.state().O_T_EE_d, 4)
        states = self.arm.run("cartesian_pose_example_controller", 5.5)
        self.follows(states)
        reached = 0.0
        for state in states:
            here, desired = matrix(state.O_T_EE, 4), matrix(state.O_T_EE_d, 4)
            self.assertLess(np.linalg.norm(here[:3, 3] - desired[:3, 3]), 5e-4)
            # On a circle of 0.15 m about a point below (the formula), always of the same orientation.
            dx, dz = desired[[0, 2], 3] - before[[0, 2], 3]
            self.assertAlmostEqual(math.hypot(dx, dz - 0.15), 0.15, delta=2e-4)
            self.assertAlmostEqual(desired[1, 3], before[1, 3], delta=1e-6)
            self.assertLess(np.abs(desired[:3, :3] - before[:3, :3]).max(), 1e-6)
            reached = max(reached, math.atan2(-dx, 0.15 - dz))
        self.assertAlmostEqual(reached, math.pi / 2, delta=1e-3)

    def test_velocity_cartesian_interface(self):
        begin = matrix(self.arm.state().O_T_EE_d, 4)[:3, 3]
        states = self.arm.run("cartesian_velocity_example_controller", 4.5)
        self.follows(states)
        path = [matrix(state.O_T_EE_d, 4)[:3, 3] - begin for state in states]
        furthest = max(path, key=np.linalg.norm)
        desired = 0.05 / 2 * 4 / math.sqrt(2) * np.array([1, 0, -1])
        self.assertLess(np.linalg.norm(furthest - desired), 1e-3)
        speeds = [np.linalg.norm(state.O_dP_EE_c[:3]) for state in states]
        self.assertAlmostEqual(max(speeds), 0.05, delta=1e-4)

    def test_elbow_of_the_pose_interface(self):
        before = self.arm.state()
        states = self.arm.run("elbow_example_controller", 5.5)
        self.follows(states)
        for state in states:
            self.assertLess(np.abs(np.array(state.O_T_EE_d) - before.O_T_EE_d).max(), 1e-6)
            self.assertAlmostEqual(state.elbow_d[0], state.q_d[2], delta=1e-9)
        furthest = max(state.elbow_c[0] - before.elbow_d[0] for state in states)
        self.assertAlmostEqual(furthest, math.pi / 5, delta=1e-3)

    def test_model_interface_leaves_the_arm_alone(self):
        for state in self.arm.run("model_example_controller", 1.5):
            self.assertEqual(state.robot_mode, IDLE)

    def test_pose_with_torques(self):
        states = self.arm.run("joint_impedance_example_controller", 4)
        for state in states:
            self.assertEqual(state.robot_mode, MOVE)
            self.assertEqual(state.current_errors, type(state.current_errors)())
        moved = max(np.linalg.norm(np.array(s.q_d) - states[0].q_d) for s in states)
        self.assertGreater(moved, 0.05)
        # A soft user controller follows, with the error of its gains.
        self.assertLess(max(np.abs(np.array(s.q) - s.q_d).max() for s in states), 0.05)
        self.assertGreater(max(np.abs(s.tau_J_d).max() for s in states), 0.1)

    def test_claims_conflict_as_on_the_robot(self):
        self.assertTrue(self.arm.switch(start=["joint_position_example_controller"]))
        for name in (
            "joint_velocity_example_controller",
            "cartesian_pose_example_controller",
            "joint_impedance_example_controller",
        ):
            self.arm.load(name)
            self.assertFalse(self.arm.switch(start=[name]), name)
        self.assertEqual(self.arm.controllers()["joint_position_example_controller"], "running")
        self.assertTrue(self.arm.switch(start=["force_example_controller"]))  # torques beside a motion
        self.assertEqual(self.arm.state().robot_mode, MOVE)

    def test_controllers_are_switched_while_the_arm_moves(self):
        chain = [
            "joint_velocity_example_controller",
            "cartesian_impedance_example_controller",
            "joint_position_example_controller",
            "cartesian_velocity_example_controller",
        ]
        for name in chain:
            self.arm.load(name)  # some do so only near the start pose
        self.assertTrue(self.arm.switch(start=chain[:1]))
        self.arm.after(0.7)
        for last, following in zip(chain, chain[1:]):
            self.assertTrue(self.arm.switch(start=[following], stop=[last]), following)
            self.assertEqual(self.arm.controllers()[following], "running")
            state = self.arm.after(0.7)
            self.assertEqual(state.robot_mode, MOVE)
            self.assertEqual(state.current_errors, type(state.current_errors)())

    # state

    def test_state_at_rest(self):
        state = self.arm.state()
        np.testing.assert_allclose(state.q, START, atol=1e-3)
        np.testing.assert_allclose(state.q_d, state.q, atol=1e-3)
        np.testing.assert_allclose(state.O_T_EE_d, state.O_T_EE, atol=1e-3)
        np.testing.assert_allclose(state.O_T_EE_c, state.O_T_EE_d, atol=1e-12)
        np.testing.assert_allclose(state.theta, np.array(state.q) + np.array(state.tau_J) / 14250, atol=1e-9)
        for field in ("dq_d", "ddq_d", "tau_J_d", "O_dP_EE_d", "O_dP_EE_c", "O_ddP_EE_c", "delbow_c"):
            np.testing.assert_allclose(getattr(state, field), 0, atol=1e-9, err_msg=field)
        for field in ("dq", "dtheta", "tau_ext_hat_filtered", "O_F_ext_hat_K", "K_F_ext_hat_K"):
            np.testing.assert_allclose(getattr(state, field), 0, atol=0.05, err_msg=field)
        for field in ("joint_contact", "joint_collision", "cartesian_contact", "cartesian_collision"):
            np.testing.assert_allclose(getattr(state, field), 0, err_msg=field)
        self.assertAlmostEqual(state.elbow[0], state.q[2])
        self.assertEqual(state.elbow[1], -1)
        self.assertAlmostEqual(state.elbow_d[0], state.q_d[2])
        self.assertEqual(state.current_errors, type(state.current_errors)())
        self.assertAlmostEqual(state.time, state.header.stamp.to_sec(), delta=2e-3)
        np.testing.assert_allclose(state.O_ddP_O, [0, 0, -9.81])
        # Gravity bends joint 2 and 4, not joint 1.
        self.assertLess(abs(state.tau_J[0]), 0.1)
        self.assertGreater(abs(state.tau_J[3]), 5)

    def test_pushes_are_reported_as_forces_contacts_and_collisions(self):
        self.arm.service(
            "set_force_torque_collision_behavior",
            SetForceTorqueCollisionBehavior,
            [50.0] * 7,
            [80.0] * 7,
            [5.0] * 6,
            [12.0] * 6,
        )
        for force, collides in ((8.0, False), (24.0, True)):
            answer = call(
                "/gazebo/push_body",
                PushBody,
                body=self.arm.arm_id + "_link7",
                point=self.hand(),
                force=Vector3(0, force, 0),
                at_point=True,
                ticks=8000,
            )
            self.assertTrue(answer.success, answer.error)
            # Forces that the robot exerts are positive: against the push.
            state = self.arm.when(
                lambda state, force=force: (
                    abs(state.O_F_ext_hat_K[1] + force) < 0.3 and max(map(abs, state.dq)) < 1e-3
                )
            )
            world = matrix(state.O_T_EE, 4)[:3, :3] @ matrix(state.EE_T_K, 4)[:3, :3]
            np.testing.assert_allclose(world @ state.K_F_ext_hat_K[:3], state.O_F_ext_hat_K[:3], atol=1e-6)
            self.assertTrue(any(state.cartesian_contact))
            self.assertEqual(any(state.cartesian_collision), collides)
            self.assertEqual(state.robot_mode, IDLE)  # reported, without a reaction
            self.arm.when(lambda state: abs(state.O_F_ext_hat_K[1]) < 0.3)
        # Without reflexes the flags follow the manual's formulas in each state: nothing is latched.
        self.arm.when(lambda state: not any(state.cartesian_collision) and not any(state.cartesian_contact))

    def hand(self):
        x, y, z = matrix(self.arm.state().O_T_EE, 4)[:3, 3]
        return Point(x, y, z)

    # services

    def test_frames_and_loads(self):
        self.addCleanup(self.arm.service, "set_load", SetLoad, 0, [0] * 3, [0] * 9)
        self.addCleanup(self.arm.service, "set_K_frame", SetKFrame, IDENTITY)
        self.addCleanup(self.arm.service, "set_EE_frame", SetEEFrame, IDENTITY)
        frame = list(IDENTITY)
        frame[14] = 0.1
        for moving in (False, True):
            if moving:
                self.arm.switch(start=["cartesian_impedance_example_controller"])
            for name, kind, good, bad in (
                ("set_EE_frame", SetEEFrame, [frame], [[2.0] + frame[1:]]),
                ("set_K_frame", SetKFrame, [frame], [[math.nan] * 16]),
                (
                    "set_load",
                    SetLoad,
                    [0.5, [0, 0, 0.1], [0.01, 0, 0, 0, 0.02, 0, 0, 0, 0.03]],
                    [-1, [0] * 3, [0] * 9],
                ),
            ):
                answer = self.arm.service(name, kind, *good)
                self.assertTrue(answer.success, answer.error)
                answer = self.arm.service(name, kind, *bad)
                self.assertFalse(answer.success)
                self.assertGreater(len(answer.error), 30)
            state = self.arm.after(0.05)
            np.testing.assert_allclose(state.NE_T_EE, frame)
            np.testing.assert_allclose(state.EE_T_K, frame)
            np.testing.assert_allclose(matrix(state.F_T_EE, 4), matrix(state.F_T_NE, 4) @ matrix(frame, 4))
            self.assertAlmostEqual(state.m_load, 0.5)
            self.assertAlmostEqual(state.m_total, state.m_ee + 0.5)
            center = (state.m_ee * np.array(state.F_x_Cee) + 0.5 * np.array([0, 0, 0.1])) / state.m_total
            np.testing.assert_allclose(state.F_x_Ctotal, center, atol=1e-12)
            total = np.zeros((3, 3))
            for mass, com, inertia in (
                (state.m_ee, state.F_x_Cee, state.I_ee),
                (0.5, state.F_x_Cload, state.I_load),
            ):
                d = np.array(com) - center
                total += matrix(inertia, 3) + mass * (d @ d * np.eye(3) - np.outer(d, d))
            np.testing.assert_allclose(matrix(state.I_total, 3), total, atol=1e-12)

    def test_the_end_effector_frame_is_fixed_during_a_motion(self):
        self.arm.switch(start=["joint_position_example_controller"])
        answer = self.arm.service("set_EE_frame", SetEEFrame, IDENTITY)
        self.assertFalse(answer.success)
        self.assertIn("stop that controller", answer.error)

    def test_impedances_and_thresholds(self):
        lows, highs = [1.0] * 7, [2.0] * 7
        for name, kind, good, bad in (
            ("set_joint_impedance", SetJointImpedance, [[1000.0] * 7], [[-1.0] * 7]),
            ("set_cartesian_impedance", SetCartesianImpedance, [[500.0] * 3 + [50.0] * 3], [[5.0] * 6]),
            (
                "set_full_collision_behavior",
                SetFullCollisionBehavior,
                [lows, highs, lows, highs, lows[:6], highs[:6], lows[:6], highs[:6]],
                [[-1.0] * 7, highs, lows, highs, lows[:6], highs[:6], lows[:6], highs[:6]],
            ),
        ):
            answer = self.arm.service(name, kind, *good)
            self.assertTrue(answer.success, answer.error)
            answer = self.arm.service(name, kind, *bad)
            self.assertFalse(answer.success)
            self.assertGreater(len(answer.error), 30)
        self.assertTrue(
            self.arm.service("set_joint_impedance", SetJointImpedance, [3000.0] * 4 + [2000.0] * 3).success
        )
        high = [100.0] * 7
        self.arm.service(
            "set_force_torque_collision_behavior",
            SetForceTorqueCollisionBehavior,
            high,
            high,
            high[:6],
            high[:6],
        )
        self.arm.recover()

    def test_connect_and_disconnect(self):
        self.assertIn("already", self.arm.service("connect", Trigger).message)
        self.arm.switch(start=["joint_position_example_controller"])
        self.assertIn("stop it", self.arm.service("disconnect", Trigger).message)
        self.arm.switch(stop=["joint_position_example_controller"])
        self.assertTrue(self.arm.service("disconnect", Trigger).success)
        self.assertFalse(self.arm.switch(start=["joint_position_example_controller"]))
        self.assertTrue(self.arm.service("connect", Trigger).success)
        self.assertTrue(self.arm.switch(start=["joint_position_example_controller"]))
        self.assertEqual(self.arm.state().robot_mode, MOVE)

    def test_configuration_of_the_joints(self):
        self.assertTrue(self.arm.place([0.1, -0.7, 0.1, -2.2, 0.1, 1.6, 0.9]).success)
        state = self.arm.after(0.2)
        np.testing.assert_allclose(state.q, [0.1, -0.7, 0.1, -2.2, 0.1, 1.6, 0.9], atol=1e-3)
        name = "/set_franka_model_configuration"
        for names, positions, expected in (
            ([""], [], "No joints"),
            ([self.arm.arm_id + "_joint1"], [], "positions"),
            (["other_joint1"], [0.0], "other_joint1"),
            ([self.arm.arm_id + "_joint1"], [9.0], "stops"),
        ):
            answer = call(name, SetJointConfiguration, joint_names=names, joint_positions=positions)
            self.assertFalse(answer.success)
            self.assertIn(expected, answer.error)
        # A running motion restarts at the arm's present position.
        self.assertTrue(self.arm.switch(start=["joint_position_example_controller"]))
        self.assertTrue(self.arm.place().success)
        state = self.arm.when(lambda state: state.robot_mode == MOVE)
        self.assertLess(np.abs(np.array(state.q) - START).max(), 0.08)  # the controller's amplitude

    # stops

    def test_user_stop_disconnects_until_recovery(self):
        self.arm.switch(start=["joint_position_example_controller"])
        self.assertTrue(self.arm.service("set_user_stop", SetBool, True).success)
        stopped = self.arm.when(lambda state: state.robot_mode == USER_STOPPED)
        status, text = self.arm.recover()
        self.assertEqual(status, GoalStatus.ABORTED)
        self.assertIn("set_user_stop", text)
        self.assertTrue(self.arm.service("set_user_stop", SetBool, False).success)
        self.arm.when(lambda state: state.robot_mode == IDLE)
        later = self.arm.after(0.5)
        self.assertLess(np.abs(np.array(later.q) - stopped.q).max(), 1e-3)
        self.assertEqual(self.arm.recover()[0], GoalStatus.SUCCEEDED)
        self.arm.when(lambda state: state.robot_mode == MOVE)
        self.assertEqual(self.arm.controllers()["joint_position_example_controller"], "running")

    def test_reflexes_end_motions_if_configured(self):
        self.strict.when(lambda state: state.robot_mode == MOVE)
        x, y, z = matrix(self.strict.state().O_T_EE, 4)[:3, 3]
        push = call(
            "/gazebo/push_body",
            PushBody,
            body="strict_link7",
            point=Point(x, y + 2, z),
            force=Vector3(0, 40, 0),
            at_point=True,
            ticks=100,
        )
        self.assertTrue(push.success, push.error)
        state = self.strict.when(lambda state: state.robot_mode == REFLEX)
        self.assertTrue(state.current_errors.cartesian_reflex)
        self.assertTrue(state.last_motion_errors.cartesian_reflex)
        self.strict.after(0.5)
        self.assertEqual(self.strict.recover()[0], GoalStatus.SUCCEEDED)
        state = self.strict.when(lambda state: state.robot_mode == MOVE)
        self.assertFalse(state.current_errors.cartesian_reflex)
        self.assertEqual(self.strict.controllers()["hold"], "running")


if __name__ == "__main__":
    rostest.rosrun("franka_sim_mujoco", "interfaces", InterfacesTest, sys.argv)
