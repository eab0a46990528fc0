# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Trajectories on the simulated Panda with torques, positions and velocities, as MoveIt sends them."""

import math
from pathlib import Path

import pytest
import rospy
import yaml
from actionlib_msgs.msg import GoalStatus
from control_msgs.msg import FollowJointTrajectoryAction, FollowJointTrajectoryGoal, JointTolerance
from franka_msgs.msg import ErrorRecoveryAction, ErrorRecoveryGoal
from ros_client import Action, Controllers, call, latest, launched, outcome
from sensor_msgs.msg import JointState
from std_srvs.srv import SetBool
from trajectory_msgs.msg import JointTrajectoryPoint
from waiting import wait_for

HERE = Path(__file__).resolve().parent

INTERFACES = ["effort", "position", "velocity"]
JOINTS = [f"panda_joint{i}" for i in range(1, 8)]
HOME = [0.0, -math.pi / 4, 0.0, -3 * math.pi / 4, 0.0, math.pi / 2, math.pi / 4]
TARGET = [0.4, -0.5, 0.3, -2.0, 0.2, 1.8, 1.0]
DURATION, POINTS = 4.0, 100  # [s] of a motion between these two
ARRIVED = 0.05  # [rad]

pytestmark = pytest.mark.own_process


def controller_of(interface):
    return f"{interface}_joint_trajectory_controller"


@pytest.fixture(scope="module")
def controllers(tmp_path_factory):
    launch = ["franka_sim_mujoco", "panda.launch", "headless:=true", "real_time_factor:=0"]
    with launched(*launch, log=tmp_path_factory.mktemp("trajectory") / "launch.log"):
        for name, value in yaml.safe_load((HERE / "joint_trajectory.yaml").read_text()).items():
            rospy.set_param(f"/{name}", value)
        controllers = Controllers()
        controllers.load(*map(controller_of, INTERFACES))
        yield controllers


@pytest.fixture
def running(request, controllers):
    """The action of a controller that runs during the test: of torques, or as the parameter says."""
    name = controller_of(getattr(request, "param", "effort"))
    controllers.start(name)
    yield Action(f"/{name}/follow_joint_trajectory", FollowJointTrajectoryAction)
    controllers.stop(name)


def positions():
    while True:
        message = latest("/franka_state_controller/joint_states", JointState)
        if JOINTS[0] in message.name:
            return [message.position[message.name.index(joint)] for joint in JOINTS]


def distance(target):
    return max(abs(a - b) for a, b in zip(positions(), target))


def goal_to(target, seconds=DURATION):
    start = positions()
    goal = FollowJointTrajectoryGoal()
    goal.trajectory.joint_names = JOINTS
    ways, omega = [b - a for a, b in zip(start, target)], math.pi / seconds
    for k in range(1, POINTS + 1):
        phase = math.pi * k / POINTS
        goal.trajectory.points.append(
            JointTrajectoryPoint(
                positions=[a + way * (1 - math.cos(phase)) / 2 for a, way in zip(start, ways)],
                velocities=[way * omega * math.sin(phase) / 2 for way in ways],
                accelerations=[way * omega**2 * math.cos(phase) / 2 for way in ways],
                time_from_start=rospy.Duration(seconds * k / POINTS),
            )
        )
    return goal


def goal_elsewhere(seconds=DURATION):
    """To the one of the two positions that is farther away."""
    return goal_to(max(HOME, TARGET, key=distance), seconds)


def result_of(handle):
    """Status, code and text of a goal's result."""
    status, _ = outcome(handle, 300.0)
    result = handle.get_result()
    return status, result.error_code, result.error_string


@pytest.mark.parametrize("running", INTERFACES, indirect=True)
def test_goal_of_hundred_points_is_reached(running):
    target = max(HOME, TARGET, key=distance)
    status, code, text = result_of(running.send(goal_to(target)))
    assert (status, code) == (GoalStatus.SUCCEEDED, 0), text
    assert distance(target) < ARRIVED


def test_violated_path_tolerance_is_reported(running):
    goal = goal_elsewhere()
    goal.path_tolerance = [JointTolerance(name=joint, position=1e-4) for joint in JOINTS]
    status, code, text = result_of(running.send(goal))
    assert (status, code) == (GoalStatus.ABORTED, -4), text
    assert " path error " in text


def test_cancelled_goal_ends(running):
    handle = running.send(goal_elsewhere(3600.0))
    wait_for(lambda: handle.get_goal_status() == GoalStatus.ACTIVE, "A goal's acceptance")
    handle.cancel()
    status, _, text = result_of(handle)
    assert status == GoalStatus.PREEMPTED and text


def test_goals_are_rejected_with_the_recovery_while_the_robot_is_stopped(running):
    stop = "/franka_control/set_user_stop"
    assert call(stop, SetBool, True).success
    status, code, text = result_of(running.send(goal_elsewhere()))
    assert (status, code) == (GoalStatus.REJECTED, -1) and "error_recovery" in text, text
    assert call(stop, SetBool, False).success
    recovery = Action("/franka_control/error_recovery", ErrorRecoveryAction)
    assert recovery.run(ErrorRecoveryGoal())[0] == GoalStatus.SUCCEEDED


def test_unknown_joint_is_refused(running):
    goal = goal_elsewhere()
    goal.trajectory.joint_names = ["other", *JOINTS[1:]]
    status, code, text = result_of(running.send(goal))
    assert (status, code) == (GoalStatus.REJECTED, -2), text
    assert "panda_joint1" in text
