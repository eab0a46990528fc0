# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Controllers on both nodes of franka_control survive reflexes and the user stop.

Other sequences of errors, stops and recoveries are in test_node_properties.py.
"""

import pytest
import rospy
from actionlib_msgs.msg import GoalStatus
from control_msgs.msg import FollowJointTrajectoryAction
from control_nodes import SUCCEEDED, ControlNode, follow_pose, go_to, node_of, robots_of
from geometry_msgs.msg import PoseStamped
from pyfranka.franka_sim import FrankaSim
from ros_client import Action, follow, set_example_parameters, trajectory
from waiting import wait_for

SETUPS = {"panda": ("panda", 1), "2 fr3": ("fr3", 2)}  # robot, number of arms
REFLEXES, MANY = 2, 100  # in the short and in the long form
ANGLE = 0.05  # [rad]

pytestmark = pytest.mark.own_process("setup")


@pytest.fixture(scope="module", params=SETUPS)
def setup(request):
    return SETUPS[request.param]


@pytest.fixture(scope="module")
def node(setup, tmp_path_factory):
    with FrankaSim(*robots_of(*setup), pace="patient") as server:
        with node_of([server], tmp_path_factory.mktemp("recovery")):
            node = ControlNode({robot.name: robot.address for robot in server.robots})
            node.used = UsedByPose(node) if node.alone else UsedByTrajectory(node)
            node.controllers.load(node.used.CONTROLLER)
            yield node


class UsedByPose:
    """One arm follows a pose."""

    CONTROLLER = "cartesian_impedance_example_controller"

    def __init__(self, node):
        self._node = node
        self._home = node.arms[0].state.O_T_EE[12:15]
        set_example_parameters(node.arms[0].name)
        self._target = rospy.Publisher(f"/{self.CONTROLLER}/equilibrium_pose", PoseStamped, queue_size=1)

    def follow(self):
        follow_pose(self._node.arms[0], self._target)

    def go_home(self):
        go_to(self._node.arms[0], self._target, self._home)

    def check_refusal(self):
        """Its controller takes targets at any time."""


class UsedByTrajectory:
    """One controller moves all joints of all arms, back and forth."""

    CONTROLLER = "effort_joint_trajectory_controller"

    def __init__(self, node):
        self._node, self._by = node, 2 * ANGLE
        self._home = {f"{arm.name}_joint{i + 1}": arm.state.q[i] for arm in node.arms for i in range(7)}

    def follow(self):
        self._node.move_joints(self.CONTROLLER, self._by)
        self._by = -ANGLE if self._by > 0 else ANGLE

    def go_home(self):
        follow(f"{self._node.name}/{self.CONTROLLER}", self._home, 1.0)

    def check_refusal(self):
        name = f"{self._node.name}/{self.CONTROLLER}/follow_joint_trajectory"
        status, text = Action(name, FollowJointTrajectoryAction).run(trajectory(self._home, 1.0))
        assert status == GoalStatus.REJECTED and "error_recovery" in text, text


@pytest.fixture
def moving(node):
    """All arms, controlled within 2 cm of their first positions, whatever happened before."""
    node.prepare(node.used.CONTROLLER)
    node.used.go_home()
    return node


def hit(arm):
    """Pushes an arm until its reflex is reported."""
    arm.aborts.clear()
    arm.push()
    wait_for(lambda: arm.is_in("in reflex") and arm.has_error, f"The reflex of {arm.name}")
    wait_for(lambda: arm.aborts and "reflex" in arm.aborts[0], "A report of the reflex")
    arm.wait_for_end_of_push()


def check_goes_on(node):
    node.wait_until_all_are("moving")
    node.wait_for(lambda arm: not arm.has_error, "The end of the errors")
    assert node.used.CONTROLLER in node.controllers.running()
    node.used.follow()


def test_a_controller_survives_reflexes(moving, long_run):
    arm, *others = moving.arms
    for _ in range(MANY if long_run and moving.alone else REFLEXES):
        hit(arm)
        # One controller moves all arms: they wait.
        wait_for(lambda: all(o.is_in("idle") and o.has_error for o in others), "The stop of the other arms")
        before = [other.state.q for other in others]
        assert arm.recover() == SUCCEEDED
        moving.wait_until_all_are("moving")
        for other, q in zip(others, before):
            assert other.state.q == pytest.approx(q, abs=0.005)
        check_goes_on(moving)
        moving.used.go_home()  # otherwise a hundred pushes fold the arm up to its joints' limits


def test_the_user_has_to_release_the_user_stop(moving):
    arm, *others = moving.arms
    arm.operator.set_user_stop(True)
    wait_for(lambda: arm.is_in("user-stopped") and arm.has_error, "The user stop")
    status, text = moving.recover()
    assert status == GoalStatus.ABORTED
    assert ("user stop" if moving.alone else f"{arm.name}: ") in text.lower()
    moving.used.check_refusal()
    assert arm.is_in("user-stopped")
    arm.operator.set_user_stop(False)
    if others:  # Several arms wait for a recovery.
        wait_for(lambda: arm.is_in("idle"), "The release")
        assert moving.recover() == SUCCEEDED
    check_goes_on(moving)
