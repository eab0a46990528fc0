# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Controllers and errors on both nodes of franka_control, and in the simulation.

A controller that throws, in starting() or in update(), ends none of them; and with
restart_controllers_after_recovery false no arm moves by itself after a recovery.
"""

from contextlib import ExitStack

import pytest
import rospy
from control_nodes import SUCCEEDED, ControlNode, node_of, robots_of
from pyfranka.franka_sim import FrankaSim
from ros_client import launched
from waiting import wait_for

PACKAGE = """<package format="2">
  <name>throwing_controllers</name> <version>0.0.0</version> <description>For a test.</description>
  <maintainer email="nobody@example.org">nobody</maintainer> <license>Apache-2.0</license>
  <depend>controller_interface</depend>
  <export><controller_interface plugin="${prefix}/plugins.xml"/></export>
</package>"""
PLUGINS = """<library path="lib/libfranka_control_throwing_controller">
  <class name="test/Throwing" type="franka_control_test::ThrowingController"
         base_class_type="controller_interface::ControllerBase"/>
</library>"""
SIMULATION = """<launch> <include file="$(find franka_sim_mujoco)/launch/panda.launch">
  <arg name="headless" value="true"/> </include> </launch>"""

SETUPS = {
    "one arm": ("fr3", 1),
    "two arms": ("panda", 2),
    "simulated": ("panda", 0),
}  # robot, number of robots
WORDS = {"starting": "I do not want to start", "update": "I have had enough"}
BEST_EFFORT = 1

pytestmark = pytest.mark.own_process("setup")


def with_setups(*names):
    return pytest.mark.parametrize("setup", names, indirect=True, scope="module")


class Node(ControlNode):
    """With two controllers of all joints, one of which throws."""

    def __init__(self, arms, process):
        super().__init__(arms)
        self._log = process.log
        joints = [f"{arm}_joint{i}" for arm in arms for i in range(1, 8)]
        for name in ("thrower", "good"):
            rospy.set_param(
                f"{self.controllers.namespace}/{name}", {"type": "test/Throwing", "joints": joints}
            )
            self.controllers.load(name)

    @property
    def log(self):
        return self._log.read_text(errors="replace")

    def start(self, controller, throws_in="none"):
        """@returns whether the controller manager started it."""
        rospy.set_param(f"{self.controllers.namespace}/{controller}/throws_in", throws_in)
        return self.controllers.switches([controller])

    def end(self, controller):
        self.controllers.switches(stop=[controller], strictness=BEST_EFFORT)
        assert controller not in self.controllers.running()

    def check_that_states_go_on(self):
        before = [arm.states for arm in self.arms]
        wait_for(
            lambda: all(arm.states > count + 20 for arm, count in zip(self.arms, before)), "Twenty states"
        )


@pytest.fixture(scope="module")
def setup(request):
    return SETUPS[request.param]


@pytest.fixture(scope="module")
def node(setup, tmp_path_factory):
    folder = tmp_path_factory.mktemp("throwing")
    (folder / "package.xml").write_text(PACKAGE)
    (folder / "plugins.xml").write_text(PLUGINS)
    with pytest.MonkeyPatch.context() as patch, ExitStack() as stack:
        patch.setenv("ROS_PACKAGE_PATH", str(folder), prepend=":")
        robot, count = setup
        if count:
            server = stack.enter_context(FrankaSim(*robots_of(robot, count), pace="patient"))
            process = node_of([server], folder, restart_controllers_after_recovery=False)
            arms = {robot.name: robot.address for robot in server.robots}
        else:  # the controllers run in the simulation's process
            (folder / "robot.launch").write_text(SIMULATION)
            process = launched(str(folder / "robot.launch"), log=folder / "log")
            arms = {robot: "nowhere"}
        yield Node(arms, stack.enter_context(process))


@pytest.fixture
def ready(node):
    """No controller runs, and no error is left, whatever happened before."""
    for controller in ("thrower", "good"):
        node.end(controller)
    node.recover()
    node.wait_until_all_are("idle")
    return node


@with_setups("one arm", "two arms")
@pytest.mark.parametrize("where", WORDS)
def test_the_node_survives_a_controller_that_throws(ready, where):
    ready.start("thrower", where)
    ready.wait_for(lambda arm: arm.has_error, "The error of all arms")
    ready.check_that_states_go_on()
    assert WORDS[where] in ready.log
    # Another controller moves the recovered robot.
    ready.end("thrower")
    assert ready.recover() == SUCCEEDED
    ready.wait_for(lambda arm: not arm.has_error, "The end of the error")
    ready.start("good")
    ready.wait_until_all_are("moving")


@with_setups("simulated")
@pytest.mark.parametrize("where", WORDS)
def test_the_simulation_continues_with_the_robot_at_rest(ready, where):
    ready.start("thrower", where)
    if where == "update":
        ready.wait_until_all_are("moving")
    ready.wait_until_all_are("idle")
    ready.check_that_states_go_on()
    assert WORDS[where] in ready.log
    ready.end("thrower")
    ready.start("good")
    ready.wait_until_all_are("moving")


def check_that_all_stay_at_rest(node):
    """After a cleared error."""
    node.wait_for(lambda arm: not arm.has_error, "The end of the error")
    node.wait_until_all_are("idle")
    assert "good" not in node.controllers.running()
    begin = {arm.name: arm.state.time for arm in node.arms}
    # In this time they would move.
    while any(arm.state.time < begin[arm.name] + 0.5 for arm in node.arms):
        assert all(arm.is_in("idle") for arm in node.arms)
        count = node.arms[0].states
        wait_for(lambda count=count: node.arms[0].states > count, "A new state")
    node.start("good")
    node.wait_until_all_are("moving")


@with_setups("one arm", "two arms")
def test_controllers_that_must_not_restart_are_stopped_before_a_recovery(ready):
    ready.start("good")
    ready.wait_until_all_are("moving")
    ready.arms[0].push()
    ready.wait_for(lambda arm: arm.has_error, "The error of all arms")
    assert ready.recover() == SUCCEEDED
    check_that_all_stay_at_rest(ready)


# Several arms wait for a recovery instead.
@with_setups("one arm")
def test_they_are_stopped_when_the_user_stop_is_released(ready):
    (arm,) = ready.arms
    ready.start("good")
    ready.wait_until_all_are("moving")
    arm.operator.set_user_stop(True)
    wait_for(lambda: arm.has_error, "The error of the user stop")
    arm.operator.set_user_stop(False)
    check_that_all_stay_at_rest(ready)
