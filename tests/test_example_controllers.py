# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Every single-arm example controller on franka_control_node and a simulated robot.

The short form runs each controller with one of the robots, so that both are used.
"""

import pytest
from control_nodes import MODES, ControlNode
from ros_client import follow, launched, set_example_parameters
from waiting import wait_for

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
def arm(node, robot, name, long_run):
    """The arm, at rest at its first position. @param name of the controller"""
    if not long_run and robot != ("panda", "fr3")[list(CONTROLLERS).index(name) % 2]:
        pytest.skip("the same with the other robot: ./franka test --long")
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
