# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""franka_control.launch as a user starts it, against simulated robots over the control interface."""

from pathlib import Path

import pytest
import rospy
from actionlib_msgs.msg import GoalStatus
from control_nodes import ControlNode
from franka_gripper.msg import MoveAction, MoveActionResult, MoveGoal
from ros_client import Action, latest, launched
from sensor_msgs.msg import JointState
from waiting import wait_for

HERE = Path(__file__).resolve().parent

ADDRESS = "127.0.7.1"
CONTROLLERS = ["effort_joint_trajectory_controller", "position_joint_trajectory_controller"]
LAUNCHES = {
    "fr3": ["franka_control", "franka_control.launch", "sim:=true", "robot:=fr3"],
    "panda in a ROS world": [str(HERE / "data/hardware_in_a_world.launch"), "robot:=panda"],
}

pytestmark = pytest.mark.own_process("launch")


# Over the network, a robot of a ROS world is one like the others: test_served_robots.py.
IN_A_WORLD = pytest.param("panda in a ROS world", marks=pytest.mark.long_form("a further robot"))


@pytest.fixture(scope="module", params=["fr3", IN_A_WORLD])
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


def test_trajectories_are_followed(node, controller):
    node.move_joints(controller, 0.1, 2.0)
    assert node.arms[0].is_in("moving")


def test_the_hand_moves_and_refuses_invalid_goals(node, launch):
    results = []
    rospy.Subscriber("/franka_gripper/move/result", MoveActionResult, results.append)
    move = Action("/franka_gripper/move", MoveAction)
    assert move.run(MoveGoal(width=0.05, speed=0.1))[0] == GoalStatus.SUCCEEDED
    width = sum(latest("/franka_gripper/joint_states", JointState).position)
    assert width == pytest.approx(0.05, abs=0.002)
    if launch == "fr3":
        # It is a real hand by default, whose moves take a second. By wall time, with which this robot may
        # catch up after a stall, half a second shows that.
        took = wait_for(lambda: results, "The result")[0].header.stamp - results[0].status.goal_id.stamp
        assert took.to_sec() >= 0.5
    status, text = move.run(MoveGoal(width=0.5, speed=0.1))
    assert status == GoalStatus.ABORTED and "must lie between" in text
