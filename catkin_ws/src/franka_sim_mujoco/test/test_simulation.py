# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A Panda with hand in the stone world, used through topics, services and actions only."""

import time
from functools import partial
from pathlib import Path

import actionlib
import pytest
from actionlib_msgs.msg import GoalStatus
from control_msgs.msg import GripperCommandAction, GripperCommandGoal
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
from franka_sim_mujoco.srv import (
    GetBodyPose,
    GetContacts,
    RenderPicture,
    SetBodyPose,
    SetRealTimeFactor,
    Step,
)
from geometry_msgs.msg import Point
from ros_client import Action, Controllers, call, latest, launched, outcome
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool
from std_srvs.srv import Empty, Trigger
from waiting import wait_for

HERE = Path(__file__).resolve().parent

pytestmark = pytest.mark.own_process


@pytest.fixture(scope="module", autouse=True)
def simulation(tmp_path_factory):
    log = tmp_path_factory.mktemp("simulation") / "launch.log"
    with launched(str(HERE / "simulation.launch"), log=log):
        Controllers().wait_for(
            "franka_state_controller", "cartesian_impedance_example_controller", "franka_gripper"
        )
        yield


@pytest.fixture(autouse=True)
def running_again(simulation):
    yield
    pause(False)


def service(name, kind):
    return partial(call, name, kind)


step = service("/gazebo/step", Step)
set_factor = service("/gazebo/set_real_time_factor", SetRealTimeFactor)


def finish(name, kind, goal):
    """Status, result and text of a goal."""
    return result(Action(name, kind).send(goal))


def result(handle):
    """Waits in wall time: ROS time is many times faster here."""
    status, text = outcome(handle)
    return status, handle.get_result(), text


def pause(paused=True):
    service("/gazebo/pause_physics" if paused else "/gazebo/unpause_physics", Empty)()


# ---- the robot's state ----


def test_initialized_reaches_late_subscribers():
    assert latest("/initialized", Bool).data


# ---- the gripper ----


def test_gripper_moves_and_homes():
    move = "/franka_gripper/move", MoveAction
    status, answer, text = finish(*move, MoveGoal(width=0.05, speed=0.1))
    assert (status, answer.success) == (GoalStatus.SUCCEEDED, True), text
    fingers = latest("/franka_gripper/joint_states", JointState)
    assert sum(fingers.position) == pytest.approx(0.05, abs=0.005)
    status, answer, text = finish("/franka_gripper/homing", HomingAction, HomingGoal())
    assert (status, answer.success) == (GoalStatus.SUCCEEDED, True), text


def test_gripper_refuses_invalid_goals():
    move = "/franka_gripper/move", MoveAction
    grasp = "/franka_gripper/grasp", GraspAction
    command = "/franka_gripper/gripper_action", GripperCommandAction
    wide = GripperCommandGoal()
    wide.command.position = 0.05
    epsilon = GraspEpsilon(inner=0.005, outer=0.005)
    nan = float("nan")
    for client, goal in (
        (move, MoveGoal(width=0.09, speed=0.1)),
        (move, MoveGoal(width=nan, speed=0.1)),
        (grasp, GraspGoal(width=0.02, epsilon=epsilon, speed=0.1, force=nan)),
        (command, wide),
    ):
        status, _, text = finish(*client, goal)
        assert status == GoalStatus.ABORTED, goal
        assert text, goal


def test_gripper_reports_a_grasp_without_object():
    finish("/franka_gripper/move", MoveAction, MoveGoal(width=0.06, speed=0.1))
    grasp = "/franka_gripper/grasp", GraspAction
    goal = GraspGoal(width=0.03, epsilon=GraspEpsilon(inner=0.005, outer=0.005), speed=0.1, force=5)
    _, answer, text = finish(*grasp, goal)
    assert not answer.success
    assert answer.error or text


def test_a_new_goal_preempts_and_a_cancel_ends_a_motion():
    move = Action("/franka_gripper/move", MoveAction)
    stop = Action("/franka_gripper/stop", StopAction)
    slow = MoveGoal(width=0.0, speed=0.001)
    move.run(MoveGoal(width=0.08, speed=0.1))
    pause()

    def comes_to(handle, state):
        step(10)
        return handle.get_comm_state() == state

    moving = move.send(slow)
    wait_for(lambda: comes_to(moving, actionlib.CommState.ACTIVE), "The motion")
    stopping = stop.send(StopGoal())
    wait_for(lambda: comes_to(stopping, actionlib.CommState.DONE), "The stop")
    status, _, text = result(moving)
    assert status == GoalStatus.ABORTED
    assert "interrupted" in text
    assert result(stopping)[0] == GoalStatus.SUCCEEDED
    moving = move.send(slow)
    wait_for(lambda: comes_to(moving, actionlib.CommState.ACTIVE), "The second motion")
    assert move.run(MoveGoal(width=0.09, speed=0.1))[0] == GoalStatus.ABORTED  # is impossible
    assert moving.get_comm_state() == actionlib.CommState.ACTIVE
    moving.cancel()
    assert result(moving)[0] == GoalStatus.PREEMPTED
    command = Action("/franka_gripper/gripper_action", GripperCommandAction)
    closing = GripperCommandGoal()
    for other in (False, True):
        pause(False)
        move.run(MoveGoal(width=0.08, speed=0.1))
        pause()
        moving = command.send(closing)
        wait_for(lambda moving=moving: comes_to(moving, actionlib.CommState.ACTIVE), "The command")
        if other:
            command.send(closing)
            wait_for(lambda moving=moving: comes_to(moving, actionlib.CommState.DONE), "The command's end")
        else:
            moving.cancel()
        status, answer, _ = result(moving)
        assert status == GoalStatus.PREEMPTED
        assert answer.position == pytest.approx(0.08, abs=0.03), "the width"


def test_gripper_action_moves_and_reports():
    goal = GripperCommandGoal()
    goal.command.position = 0.03
    status, answer, text = finish("/franka_gripper/gripper_action", GripperCommandAction, goal)
    assert (status, answer.reached_goal, answer.stalled) == (GoalStatus.SUCCEEDED, True, False), text
    assert answer.position == pytest.approx(0.06, abs=0.005)
    goal.command.position, goal.command.max_effort = 0.02, 10.0  # there is nothing to grasp
    status, answer, text = finish("/franka_gripper/gripper_action", GripperCommandAction, goal)
    assert (status, answer.reached_goal, answer.stalled) == (GoalStatus.ABORTED, False, True)
    fingers = latest("/franka_gripper/joint_states", JointState)
    assert answer.position == pytest.approx(sum(fingers.position), abs=0.005)
    assert answer.effort == 0.0 and "nothing to grasp" in text
    goal.command.position = 0.05  # too wide
    width = answer.position
    status, answer, _ = finish("/franka_gripper/gripper_action", GripperCommandAction, goal)
    assert (status, answer.stalled) == (GoalStatus.ABORTED, False)
    assert answer.position == pytest.approx(width, abs=0.005)


# ---- time and things ----


def test_steps_are_exact_and_repeat_after_a_reset():
    pause()
    reset = service("/gazebo/reset", Trigger)
    hashes = []
    for _ in range(2):
        assert reset().success
        before = step(0)
        after = step(500)
        assert after.success, after.error
        assert after.tick - before.tick == 500
        assert (after.time - before.time).to_sec() == pytest.approx(0.5, abs=5e-8)
        hashes.append(after.state_hash)
    assert hashes[0] == hashes[1]
    assert hashes[1] != step(1).state_hash
    pause(False)
    refused = step(1)
    assert not refused.success
    assert "pause" in refused.error


def test_invalid_real_time_factors_are_refused():
    assert not set_factor(-1).success
    assert not set_factor(float("nan")).success


@pytest.mark.realtime("the pace of the simulation")
def test_pace_follows_the_real_time_factor():
    try:
        assert set_factor(0.5).success

        def pace():
            """Of a second. A busy machine makes it slower; 50 ms of delay at most are caught up."""
            wall, ticks = time.monotonic(), step(0).tick
            time.sleep(1.0)
            found = 1e-3 * (step(0).tick - ticks) / (time.monotonic() - wall)
            assert found < 0.55
            return found

        wait_for(lambda: pace() > 0.45, "The pace of 0.5")
    finally:
        assert set_factor(0).success


def test_bodies_can_be_read_and_placed():
    get_pose = service("/gazebo/get_body_pose", GetBodyPose)
    set_pose = service("/gazebo/set_body_pose", SetBodyPose)
    pause()
    stone = get_pose("stone")
    assert stone.success
    stone.pose.position.z += 0.1
    assert set_pose("stone", stone.pose).success
    assert get_pose("stone").pose.position.z == pytest.approx(stone.pose.position.z, abs=5e-8)
    refused = set_pose("panda_link3", stone.pose)
    assert not refused.success and refused.error
    service("/gazebo/reset", Trigger)()


def test_contact_forces_equal_the_weight_of_the_stone():
    service("/gazebo/reset", Trigger)()
    pause()
    step(1000)
    contacts = service("/gazebo/get_contacts", GetContacts)("pick_tray", "stone")
    assert contacts.success, contacts.error
    assert sum(force.z for force in contacts.forces) == pytest.approx(0.1024 * 9.81, abs=0.02)
    assert not service("/gazebo/get_contacts", GetContacts)("moon", "").success


def test_a_picture_is_rendered_and_an_unknown_camera_is_refused():
    render = service("/gazebo/render_picture", RenderPicture)
    answer = render(Point(1.4, -1.2, 1.2), Point(0, 0, 0.4), 0, 160, 120)
    assert answer.success, answer.error
    assert (answer.image.width, answer.image.height, len(answer.image.data)) == (160, 120, 160 * 120 * 3)
    assert len(set(answer.image.data)) > 20
    assert not render(Point(1, 1, 1), Point(1, 1, 1), 0, 0, 0).success
