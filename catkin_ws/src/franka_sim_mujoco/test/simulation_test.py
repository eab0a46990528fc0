#!/usr/bin/env python3
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A Panda with hand in the stone world, used through topics, services and actions only."""

import math
import sys
import time
import unittest

import actionlib
import rospy
import rospy_connections
import rostest
from actionlib_msgs.msg import GoalStatus
from control_msgs.msg import GripperCommandAction, GripperCommandGoal
from controller_manager_msgs.srv import ListControllers
from franka_gripper.msg import (
    GraspAction,
    GraspEpsilon,
    GraspGoal,
    HomingAction,
    HomingGoal,
    MoveAction,
    MoveGoal,
    StopAction,
    StopGoal,
)
from franka_msgs.msg import ErrorRecoveryAction, ErrorRecoveryGoal, FrankaState
from franka_msgs.srv import SetEEFrame, SetForceTorqueCollisionBehavior, SetKFrame, SetLoad
from franka_sim_mujoco.srv import (
    GetBodyPose,
    GetContacts,
    PushBody,
    RenderPicture,
    SetBodyPose,
    SetRealTimeFactor,
    Step,
)
from geometry_msgs.msg import Point, Pose, Quaternion, Vector3
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool
from std_srvs.srv import Empty, SetBool, Trigger

IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
WAIT = 20  # wall seconds


def service(name, kind):
    rospy.wait_for_service(name, WAIT)
    return rospy.ServiceProxy(name, kind)


def state():
    return rospy.wait_for_message("/franka_state_controller/franka_states", FrankaState, WAIT)


def state_when(condition, wait=WAIT):
    """The first state that meets a condition; fails if none does in time."""
    end = time.monotonic() + wait
    while time.monotonic() < end:
        now = state()
        if condition(now):
            return now
    raise AssertionError(f"no state met the condition; the last one has mode {now.robot_mode}")


def action(name, kind):
    # Not the simple client: it loses goals that end before its send_goal() returns, as they do here.
    client = actionlib.ActionClient(name, kind)
    client.wait_for_server()  # bounded by the time limit of the test
    return client


def finish(client, goal):
    return result(client.send_goal(goal))


def result(handle):
    """Waits in wall time: ROS time is many times faster here."""
    end = time.monotonic() + WAIT
    while handle.get_comm_state() != actionlib.CommState.DONE and time.monotonic() < end:
        time.sleep(0.01)
    return handle.get_goal_status(), handle.get_result(), handle.get_goal_status_text()


def pause(paused=True):
    service("/gazebo/pause_physics" if paused else "/gazebo/unpause_physics", Empty)()


class SimulationTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy_connections.init_node("simulation_test")
        end = time.monotonic() + 40
        running = set()
        expected = {
            "franka_state_controller",
            "cartesian_impedance_example_controller",
            "franka_gripper",
        }
        while not expected <= running and time.monotonic() < end:
            answer = service("/controller_manager/list_controllers", ListControllers)()
            running = {c.name for c in answer.controller if c.state == "running"}
            time.sleep(0.1)
        assert expected <= running, f"only {running} run"
        cls.step = staticmethod(service("/gazebo/step", Step))

    def tearDown(self):
        service("/franka_control/set_user_stop", SetBool)(False)
        pause(False)

    # the robot's state

    def test_state_is_that_of_a_moving_panda_at_rest(self):
        now = state_when(lambda s: s.robot_mode == FrankaState.ROBOT_MODE_MOVE)
        self.assertAlmostEqual(now.m_ee, 0.76, places=6)
        self.assertAlmostEqual(now.m_total, 0.76, places=6)
        self.assertAlmostEqual(now.F_T_NE[14], 0.1034)
        self.assertAlmostEqual(now.F_T_NE[0], math.cos(math.pi / 4), places=6)
        self.assertAlmostEqual(now.O_ddP_O[2], -9.81)
        self.assertAlmostEqual(now.control_command_success_rate, 1.0)
        self.assertLess(max(abs(f) for f in now.O_F_ext_hat_K[:3]), 1.0)
        for q, start in zip(now.q, (0, -0.785398163, 0, -2.35619449, 0, 1.57079632679, 0.785398163397)):
            self.assertAlmostEqual(q, start, delta=0.02)

    def test_joint_states_name_the_joints_of_the_arm_and_the_fingers(self):
        arm = rospy.wait_for_message("/franka_state_controller/joint_states", JointState, WAIT)
        self.assertEqual(list(arm.name), [f"panda_joint{i}" for i in range(1, 8)])
        hand = rospy.wait_for_message("/franka_gripper/joint_states", JointState, WAIT)
        self.assertEqual(list(hand.name), ["panda_finger_joint1", "panda_finger_joint2"])
        merged = rospy.wait_for_message("/joint_states", JointState, WAIT)
        self.assertTrue(set(arm.name) <= set(merged.name))

    def test_initialized_reaches_late_subscribers(self):
        self.assertTrue(rospy.wait_for_message("/initialized", Bool, WAIT).data)

    # services

    def test_load_and_frames_are_set_or_refused(self):
        set_load = service("/franka_control/set_load", SetLoad)
        self.assertTrue(set_load(0.1, [0, 0, 0.1], [0] * 9).success)
        now = state_when(lambda s: s.m_load > 0)
        self.assertAlmostEqual(now.m_total, 0.86)
        self.assertTrue(set_load(0.0, [0, 0, 0], [0] * 9).success)
        refused = set_load(-1.0, [0, 0, 0], [0] * 9)
        self.assertFalse(refused.success)
        self.assertIn("load", refused.error)

        frame = list(IDENTITY)
        frame[14] = 0.05
        for name, kind, field in (
            ("set_EE_frame", SetEEFrame, "NE_T_EE"),
            ("set_K_frame", SetKFrame, "EE_T_K"),
        ):
            setter = service("/franka_control/" + name, kind)
            self.assertTrue(setter(frame).success)
            state_when(lambda s, f=field: abs(getattr(s, f)[14] - 0.05) < 1e-9)
            self.assertTrue(setter(IDENTITY).success)
            refused = setter([0] * 16)
            self.assertFalse(refused.success)
            self.assertIn(field, refused.error)

    def test_a_push_is_reported_as_contact_and_collision_with_the_right_sign(self):
        set_behavior = service(
            "/franka_control/set_force_torque_collision_behavior", SetForceTorqueCollisionBehavior
        )
        push = service("/gazebo/push_body", PushBody)
        self.assertTrue(set_behavior([50] * 7, [60] * 7, [5] * 6, [50] * 6).success)
        pause()
        self.assertTrue(push("panda_hand", Vector3(10, 0, 0), Vector3(), False, Point(), 100000).success)
        pause(False)
        now = state_when(lambda s: any(s.cartesian_contact))
        self.assertFalse(any(now.cartesian_collision))
        now = state_when(lambda s: abs(s.O_F_ext_hat_K[0] + 10) < 0.2)
        self.assertTrue(set_behavior([1, 1, 1, 1, 1, 1, 1], [2] * 7, [5] * 6, [8] * 6).success)
        state_when(lambda s: any(s.cartesian_collision))
        self.assertTrue(
            set_behavior(
                [20, 20, 18, 18, 16, 14, 12],
                [20, 20, 18, 18, 16, 14, 12],
                [20, 20, 20, 25, 25, 25],
                [20, 20, 20, 25, 25, 25],
            ).success
        )
        bad = set_behavior([-5] * 7, [4] * 7, [5] * 6, [50] * 6)
        self.assertFalse(bad.success)
        self.assertIn("negative", bad.error)
        self.assertFalse(push("no_such_body", Vector3(), Vector3(), False, Point(), 1).success)
        # The push lasts 100 s of simulated time, which may take long on a busy machine.
        state_when(lambda s: abs(s.O_F_ext_hat_K[0]) < 0.5, wait=3 * WAIT)

    def test_user_stop_disconnects_until_recovery(self):
        stop = service("/franka_control/set_user_stop", SetBool)
        recovery = action("/franka_control/error_recovery", ErrorRecoveryAction)
        self.assertTrue(stop(True).success)
        held = state_when(lambda s: s.robot_mode == FrankaState.ROBOT_MODE_USER_STOPPED)
        status, _, text = finish(recovery, ErrorRecoveryGoal())
        self.assertEqual(status, GoalStatus.ABORTED)
        self.assertIn("user stop", text)
        stop(False)
        idle = state_when(lambda s: s.robot_mode == FrankaState.ROBOT_MODE_IDLE)
        self.assertEqual(list(idle.tau_J_d), [0.0] * 7)
        status, _, text = finish(recovery, ErrorRecoveryGoal())
        self.assertEqual(status, GoalStatus.SUCCEEDED, text)
        moving = state_when(lambda s: s.robot_mode == FrankaState.ROBOT_MODE_MOVE)
        for before, after in zip(held.q, moving.q):
            self.assertAlmostEqual(before, after, delta=0.02)

    # the gripper

    def test_gripper_moves_and_homes(self):
        move = action("/franka_gripper/move", MoveAction)
        status, answer, text = finish(move, MoveGoal(width=0.05, speed=0.1))
        self.assertEqual((status, answer.success), (GoalStatus.SUCCEEDED, True), text)
        fingers = rospy.wait_for_message("/franka_gripper/joint_states", JointState, WAIT)
        self.assertAlmostEqual(sum(fingers.position), 0.05, delta=0.005)
        status, answer, text = finish(action("/franka_gripper/homing", HomingAction), HomingGoal())
        self.assertEqual((status, answer.success), (GoalStatus.SUCCEEDED, True), text)

    def test_gripper_refuses_invalid_goals(self):
        move = action("/franka_gripper/move", MoveAction)
        grasp = action("/franka_gripper/grasp", GraspAction)
        command = action("/franka_gripper/gripper_action", GripperCommandAction)
        wide = GripperCommandGoal()
        wide.command.position = 0.05
        epsilon = GraspEpsilon(inner=0.005, outer=0.005)
        nan = float("nan")
        for client, goal in (
            (move, MoveGoal(width=0.09, speed=0.1)),
            (move, MoveGoal(width=-0.01, speed=0.1)),
            (move, MoveGoal(width=nan, speed=0.1)),
            (move, MoveGoal(width=0.04, speed=-0.1)),
            (grasp, GraspGoal(width=nan, epsilon=epsilon, speed=0.1, force=5)),
            (grasp, GraspGoal(width=0.02, epsilon=epsilon, speed=0.1, force=nan)),
            (grasp, GraspGoal(width=0.02, epsilon=epsilon, speed=-1, force=5)),
            (command, wide),
        ):
            status, _, text = finish(client, goal)
            self.assertEqual(status, GoalStatus.ABORTED, goal)
            self.assertTrue(text, goal)

    def test_gripper_reports_a_grasp_without_object(self):
        finish(action("/franka_gripper/move", MoveAction), MoveGoal(width=0.06, speed=0.1))
        grasp = action("/franka_gripper/grasp", GraspAction)
        goal = GraspGoal(width=0.03, epsilon=GraspEpsilon(inner=0.005, outer=0.005), speed=0.1, force=5)
        _, answer, text = finish(grasp, goal)
        self.assertFalse(answer.success)
        self.assertTrue(answer.error or text)

    def test_a_new_goal_preempts_and_a_cancel_ends_a_motion(self):
        move = action("/franka_gripper/move", MoveAction)
        stop = action("/franka_gripper/stop", StopAction)
        finish(move, MoveGoal(width=0.08, speed=0.1))
        pause()
        moving = move.send_goal(MoveGoal(width=0.0, speed=0.001))
        time.sleep(0.2)
        self.step(10)
        stopping = stop.send_goal(StopGoal())
        deadline = time.monotonic() + WAIT
        while stopping.get_comm_state() != actionlib.CommState.DONE:
            self.assertLess(time.monotonic(), deadline, "The gripper does not stop.")
            self.step(10)
            time.sleep(0.02)
        status, _, text = result(moving)
        self.assertEqual(status, GoalStatus.ABORTED)
        self.assertIn("interrupted", text)
        self.assertEqual(result(stopping)[0], GoalStatus.SUCCEEDED)
        moving = move.send_goal(MoveGoal(width=0.0, speed=0.001))
        time.sleep(0.2)
        moving.cancel()
        self.assertEqual(result(moving)[0], GoalStatus.PREEMPTED)

    def test_gripper_action_moves_and_reports(self):
        goal = GripperCommandGoal()
        goal.command.position = 0.03
        status, answer, text = finish(action("/franka_gripper/gripper_action", GripperCommandAction), goal)
        self.assertEqual((status, answer.reached_goal), (GoalStatus.SUCCEEDED, True), text)
        self.assertAlmostEqual(answer.position, 0.06, delta=0.005)

    # time and things

    def test_steps_are_exact_and_repeat_after_a_reset(self):
        pause()
        reset = service("/gazebo/reset", Trigger)
        hashes = []
        for _ in range(2):
            self.assertTrue(reset().success)
            before = self.step(0)
            after = self.step(500)
            self.assertTrue(after.success, after.error)
            self.assertEqual(after.tick - before.tick, 500)
            self.assertAlmostEqual((after.time - before.time).to_sec(), 0.5)
            hashes.append(after.state_hash)
        self.assertEqual(hashes[0], hashes[1])
        self.assertNotEqual(hashes[1], self.step(1).state_hash)
        pause(False)
        refused = self.step(1)
        self.assertFalse(refused.success)
        self.assertIn("pause", refused.error)

    def test_pace_follows_the_real_time_factor(self):
        set_factor = service("/gazebo/set_real_time_factor", SetRealTimeFactor)
        self.assertFalse(set_factor(-1).success)
        self.assertFalse(set_factor(float("nan")).success)
        try:
            self.assertTrue(set_factor(0.5).success)
            wall, ticks = time.monotonic(), self.step(0).tick
            time.sleep(1.0)
            pace = 1e-3 * (self.step(0).tick - ticks) / (time.monotonic() - wall)
            self.assertLess(pace, 0.55)
            self.assertGreater(pace, 0.2)  # the machine may be busy
        finally:
            self.assertTrue(set_factor(0).success)

    def test_bodies_can_be_read_and_placed(self):
        get_pose = service("/gazebo/get_body_pose", GetBodyPose)
        set_pose = service("/gazebo/set_body_pose", SetBodyPose)
        pause()
        stone = get_pose("stone")
        self.assertTrue(stone.success)
        stone.pose.position.z += 0.1
        self.assertTrue(set_pose("stone", stone.pose).success)
        self.assertAlmostEqual(get_pose("stone").pose.position.z, stone.pose.position.z)
        for answer in (
            get_pose("no_such_body"),
            set_pose("no_such_body", stone.pose),
            set_pose("panda_link3", stone.pose),
            set_pose("stone", Pose(orientation=Quaternion(w=3))),
        ):
            self.assertFalse(answer.success)
            self.assertTrue(answer.error)
        service("/gazebo/reset", Trigger)()

    def test_contact_forces_equal_the_weight_of_the_stone(self):
        service("/gazebo/reset", Trigger)()
        pause()
        self.step(1000)
        contacts = service("/gazebo/get_contacts", GetContacts)("pick_tray", "stone")
        self.assertTrue(contacts.success, contacts.error)
        self.assertAlmostEqual(sum(force.z for force in contacts.forces), 0.1024 * 9.81, delta=0.02)
        self.assertFalse(service("/gazebo/get_contacts", GetContacts)("moon", "").success)

    def test_a_picture_is_rendered_and_an_unknown_camera_is_refused(self):
        render = service("/gazebo/render_picture", RenderPicture)
        answer = render(Point(1.4, -1.2, 1.2), Point(0, 0, 0.4), 0, 160, 120)
        self.assertTrue(answer.success, answer.error)
        self.assertEqual(
            (answer.image.width, answer.image.height, len(answer.image.data)),
            (160, 120, 160 * 120 * 3),
        )
        self.assertGreater(len(set(answer.image.data)), 20)
        self.assertFalse(render(Point(1, 1, 1), Point(1, 1, 1), 0, 0, 0).success)


if __name__ == "__main__":
    rostest.rosrun("franka_sim_mujoco", "simulation", SimulationTest, sys.argv)
