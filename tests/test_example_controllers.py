# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Every single-arm example controller on franka_control_node and a simulated robot.

The short form runs each controller with one of the robots, so that both are used.
"""

import pytest
from control_nodes import MODES, ControlNode, node_of, robots_of
from pyfranka.franka_sim import FrankaSim
from ros_client import set_example_parameters
from waiting import wait_for

RUNS = 2.5  # [s] of the robot: joint_impedance reaches its speed after 2 s
READS = 1.0  # [s] of a controller that does not move the arm
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
    with (
        FrankaSim(*robots_of(robot, 1), pace="patient") as server,
        node_of([server], tmp_path_factory.mktemp("examples")),
    ):
        set_example_parameters(robot)
        yield ControlNode({robot: server.robot.address})


@pytest.fixture
def arm(node, robot, name, long_run):
    """The arm, at rest at its first position. @param name of the controller"""
    if not long_run and robot != ("panda", "fr3")[list(CONTROLLERS).index(name) % 2]:
        pytest.skip("the same with the other robot: ./franka test --long")
    (arm,) = node.arms
    arm.operator.reset()
    count = arm.states
    wait_for(lambda: arm.states > count + 1 and arm.is_in("idle"), "Rest")
    return arm


@pytest.mark.parametrize("name", CONTROLLERS)
def test_runs_and_stops(node, arm, name):
    controller = name + "_example_controller"
    node.controllers.load(controller)
    arm.aborts.clear()
    begin = arm.state
    node.controllers.start(controller)
    end_time, farthest = arm.state.time + (RUNS if CONTROLLERS[name] else READS), 0.0

    def has_run():
        nonlocal farthest
        farthest = max(farthest, *(abs(a - b) for a, b in zip(begin.q, arm.state.q)))
        return arm.state.time > end_time and farthest >= (CONTROLLERS[name] or 0.0)

    wait_for(has_run, "The end of its time, and its motion,", WAIT)
    end = arm.state
    node.controllers.stop(controller)
    wait_for(lambda: arm.is_in("idle"), "Rest")
    node.controllers.unload(controller)
    assert arm.aborts == []
    assert end.robot_mode == MODES["idle" if name == "model" else "moving"]
    if CONTROLLERS[name] is None:
        assert abs(begin.O_T_EE[14] - end.O_T_EE[14]) < 0.005
