# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Every single-arm example controller on franka_control_node and a simulated robot, Panda and FR3."""

import numpy as np
import pytest
import rospy
from control_nodes import MODES, ControlNode
from franka_msgs.msg import FrankaState
from ros_client import follow, launched, set_example_parameters
from waiting import wait_for

FIRST_POSITION = (0.3069, 0.0, 0.4869)  # [m] of a simulated arm's hand
RUNS = 2.5  # [s] of the robot
RETURNS = "effort_joint_trajectory_controller"
AT_HOME = 0.02  # [rad]
# Minimum motion of the arm while it runs [rad]; None: it only reads, or holds the arm.
CONTROLLERS = {
    "joint_velocity": 0.03,
    "joint_position": 0.02,
    "cartesian_pose": 0.1,
    "cartesian_velocity": 0.05,
    "elbow": 0.1,
    "joint_impedance": 0.05,
    "model": None,
    "force": None,
    "cartesian_impedance": None,
}
RADIUS, CIRCLE = 0.05, 4.0  # [m] python_controllers.yaml, [s]
WAIT = 300.0  # [s] of wall time, for a few seconds of the robot

pytestmark = pytest.mark.own_process("robot")


@pytest.fixture(scope="module", params=["panda", "fr3"])
def robot(request):
    return request.param


@pytest.fixture(scope="module")
def node(robot, tmp_path_factory):
    launch = ["franka_control", "franka_control.launch", "sim:=true", f"robot:={robot}"]
    log = tmp_path_factory.mktemp("examples") / "launch.log"
    with launched(*launch, "robot_ip:=127.0.7.2", log=log):
        set_example_parameters(robot)
        node = ControlNode({robot: "127.0.7.2"})
        node.controllers.load(RETURNS)
        node.home = node.arms[0].state.q
        yield node


@pytest.fixture
def arm(node):
    """The arm, at rest at its first position."""
    arm = node.arms[0]

    def away():
        return max(abs(a - b) for a, b in zip(arm.state.q, node.home))

    if away() > AT_HOME:
        node.controllers.start(RETURNS)
        follow(f"/{RETURNS}", {f"{arm.name}_joint{i + 1}": q for i, q in enumerate(node.home)}, 1.5)
        wait_for(lambda: away() < AT_HOME, "The first position")
        node.controllers.stop(RETURNS)
    wait_for(lambda: arm.is_in("idle"), "Rest")
    return arm


@pytest.mark.parametrize("name", CONTROLLERS)
def test_runs_and_stops(node, arm, name):
    controller = name + "_example_controller"
    node.controllers.load(controller)
    arm.aborts.clear()
    begin = arm.state
    node.controllers.start(controller)
    end_time, farthest = arm.state.time + RUNS, 0.0

    def has_run():
        nonlocal farthest
        farthest = max(farthest, *(abs(a - b) for a, b in zip(begin.q, arm.state.q)))
        return arm.state.time > end_time and farthest >= (CONTROLLERS[name] or 0.0)

    wait_for(has_run, f"{RUNS} s of the robot, and its motion,", WAIT)
    end = arm.state
    node.controllers.stop(controller)
    wait_for(lambda: arm.is_in("idle"), "Rest")
    node.controllers.unload(controller)
    assert arm.aborts == []
    assert end.robot_mode == MODES["idle" if name == "model" else "moving"]
    if CONTROLLERS[name] is None:
        assert abs(begin.O_T_EE[14] - end.O_T_EE[14]) < 0.005


@pytest.mark.own_process
def test_the_launch_file_of_a_python_example_moves_the_robot(tmp_path):
    launch = ["franka_example_controllers", "python_cartesian_circle_example_controller.launch", "sim:=true"]
    launch += ["robot_ip:=127.0.7.3", "rviz:=false", "max_update_time:=30.0", "max_starting_time:=60.0"]
    states = []

    def moving():
        return [state for state in list(states) if state.robot_mode == FrankaState.ROBOT_MODE_MOVE]

    with launched(*launch, log=tmp_path / "launch.log"):
        topic = "/franka_state_controller/franka_states"
        rospy.Subscriber(topic, FrankaState, states.append, queue_size=1000)
        wait_for(lambda: moving() and moving()[-1].time - moving()[0].time >= CIRCLE, "The circle", WAIT)
    x, y, z = np.array([state.O_T_EE_d[12:15] for state in moving()]).T
    # The circle through the points, by least squares: the first states of the motion may have been missed.
    coefficients, *_ = np.linalg.lstsq(np.c_[2 * y, 2 * z, np.ones_like(y)], y**2 + z**2, rcond=None)
    centre_y, centre_z = coefficients[:2]
    np.testing.assert_allclose(np.hypot(y - centre_y, z - centre_z), RADIUS, atol=1e-4)
    np.testing.assert_allclose(x, x[0], atol=1e-4)
    # It starts at the arm's first position, and moves around a point beside it.
    np.testing.assert_allclose([x[0], centre_y - RADIUS, centre_z], FIRST_POSITION, atol=2e-3)
    assert np.ptp(np.unwrap(np.arctan2(z - centre_z, y - centre_y))) > 0.85 * np.pi
