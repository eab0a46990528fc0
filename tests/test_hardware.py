# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""franka_control.launch as a user starts it, against simulated robots over the control interface."""

from pathlib import Path

import pytest
from actionlib_msgs.msg import GoalStatus
from control_nodes import SUCCEEDED, ControlNode
from franka_gripper.msg import MoveAction, MoveGoal
from franka_msgs.srv import SetJointImpedance, SetLoad
from ros_client import Action, call, latest, launched
from sensor_msgs.msg import JointState
from waiting import wait_for

HERE = Path(__file__).resolve().parent

ADDRESS = "127.0.7.1"
CONTROLLERS = ["effort_joint_trajectory_controller", "position_joint_trajectory_controller"]
LAUNCHES = {
    "panda": ["franka_control", "franka_control.launch", "sim:=true", "robot:=panda"],
    "fr3": ["franka_control", "franka_control.launch", "sim:=true", "robot:=fr3"],
    "panda in a ROS world": [str(HERE / "data/hardware_in_a_world.launch"), "robot:=panda"],
}

pytestmark = pytest.mark.own_process("launch")


@pytest.fixture(scope="module", params=LAUNCHES)
def launch(request):
    return request.param


@pytest.fixture(scope="module")
def node(launch, tmp_path_factory):
    log = tmp_path_factory.mktemp("hardware") / "launch.log"
    with launched(*LAUNCHES[launch], f"robot_ip:={ADDRESS}", log=log):
        node = ControlNode({launch.split()[0]: ADDRESS})
        node.controllers.load(*CONTROLLERS)
        yield node


@pytest.fixture(params=CONTROLLERS)
def controller(request, node):
    """A controller that runs during the test."""
    node.controllers.start(request.param)
    yield request.param
    node.controllers.stop(request.param)


def test_the_robot_is_connected(node):
    wait_for(lambda: "franka_state_controller" in node.controllers.running(), "The state controller")
    node.wait_until_all_are("idle")


def test_setters_return_the_robots_answer(node):
    def set_load(mass, z=0.0):
        answer = call(
            "/franka_control/set_load",
            SetLoad,
            mass=mass,
            F_x_center_load=[0, 0, z],
            load_inertia=[0.0] * 9,
        )
        return answer.success, answer.error

    assert set_load(0.5, 0.05) == (True, "")
    success, error = set_load(-1.0)
    assert not success and "invalid argument" in error
    wait_for(lambda: node.arms[0].state.m_load == 0.5, "The load")
    assert set_load(0.0) == (True, "")


def test_trajectories_are_followed(node, controller):
    node.move_joints(controller, 0.1, 2.0)
    assert node.arms[0].is_in("moving")


def test_a_moving_robot_refuses_setters_with_a_reason(node, controller):
    answer = call("/franka_control/set_joint_impedance", SetJointImpedance, [1000.0] * 7)
    assert not answer.success and "Stop that controller" in answer.error
    success, message = node.trigger("disconnect")
    assert not success and "Cannot disconnect" in message


def test_recovery_without_error_succeeds(node):
    assert node.recover() == SUCCEEDED


def test_the_hand_moves_and_refuses_invalid_goals(node):
    move = Action("/franka_gripper/move", MoveAction)
    assert move.run(MoveGoal(width=0.05, speed=0.1))[0] == GoalStatus.SUCCEEDED
    width = sum(latest("/franka_gripper/joint_states", JointState).position)
    assert width == pytest.approx(0.05, abs=0.002)
    status, text = move.run(MoveGoal(width=0.5, speed=0.1))
    assert status == GoalStatus.ABORTED and "must lie between" in text


def test_the_robot_can_be_disconnected_and_connected_again(node):
    assert node.trigger("disconnect")[0]
    assert node.trigger("connect")[0]
    assert node.trigger("connect")[1] == "Already connected to robot. Cannot connect twice."
    node.wait_until_all_are("idle")
