# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Controllers on both nodes of franka_control survive reflexes and the user stop, again and again."""

import pytest
import rospy
from actionlib_msgs.msg import GoalStatus
from control_msgs.msg import FollowJointTrajectoryAction
from control_nodes import SUCCEEDED, ControlNode, arms_and_launch, follow_pose, go_to
from franka_msgs.msg import ErrorRecoveryGoal
from geometry_msgs.msg import PoseStamped
from ros_client import Action, follow, launched, outcome, set_example_parameters, trajectory
from waiting import wait_for

# Robots, the number of arms, and how many reflexes follow each other.
SETUPS = {"panda": ("panda", 1, 5), "2 fr3": ("fr3", 2, 2)}
OTHERS = {"fr3": ("fr3", 1, 5), "2 panda": ("panda", 2, 2), "4 panda": ("panda", 4, 2)}
AGAIN = pytest.mark.long_form("the same with other robots")
MANY = 100  # reflexes in the long form
ANGLE = 0.05  # [rad]

pytestmark = pytest.mark.own_process("setup")


@pytest.fixture(scope="module", params=[*SETUPS, *(pytest.param(setup, marks=AGAIN) for setup in OTHERS)])
def setup(request):
    return (SETUPS | OTHERS)[request.param]


@pytest.fixture(scope="module")
def node(setup, tmp_path_factory):
    robot, count, _ = setup
    folder = tmp_path_factory.mktemp("recovery")
    arms, launch = arms_and_launch(robot, count, 5, folder)
    with launched(*launch, "sim:=true", log=folder / "launch.log"):
        node = ControlNode(arms)
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


def test_a_controller_survives_reflexes(moving, setup, long_run):
    arm, *others = moving.arms
    for _ in range(MANY if long_run and moving.alone else setup[2]):
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


def test_an_early_recovery_changes_nothing(moving):
    assert moving.recover() == SUCCEEDED
    assert moving.arms[0].recover() == SUCCEEDED
    assert all(arm.is_in("moving") for arm in moving.arms)
    moving.used.follow()
    hit(moving.arms[0])  # It does not clear a later error either.


def test_two_simultaneous_recoveries_are_both_answered(moving):
    hit(moving.arms[0])
    first, second = [moving.recovery.send(ErrorRecoveryGoal()) for _ in range(2)]
    # actionlib's simple server replaces a goal by a later one: it preempts an active goal and recalls
    # a pending one.
    assert outcome(first)[0] in (GoalStatus.SUCCEEDED, GoalStatus.PREEMPTED, GoalStatus.RECALLED)
    assert outcome(second)[0] == GoalStatus.SUCCEEDED
    check_goes_on(moving)


def test_all_arms_recover_at_once(moving):
    for arm in moving.arms:
        arm.push()
    moving.wait_for(lambda arm: arm.has_error, "The error of all arms")
    for arm in moving.arms:
        arm.wait_for_end_of_push()
    assert moving.recover() == SUCCEEDED
    check_goes_on(moving)


def test_states_go_on_while_the_arms_recover_one_after_another(moving):
    for arm in moving.arms:
        arm.push()
    moving.wait_for(lambda arm: arm.has_error, "The error of all arms")
    for arm in moving.arms:
        arm.wait_for_end_of_push()
        assert arm.recover() == SUCCEEDED
        counts = {arm: arm.states for arm in moving.arms}
        moving.wait_for(lambda arm, counts=counts: arm.states > counts[arm] + 10, "More states of all arms")
    check_goes_on(moving)


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


def test_controllers_stop_and_a_robot_hit_at_rest_recovers(moving):
    moving.controllers.stop(moving.used.CONTROLLER)
    moving.wait_until_all_are("idle")
    arm = moving.arms[0]
    arm.push()
    wait_for(lambda: arm.is_in("in reflex"), "The reflex of an arm at rest")
    arm.wait_for_end_of_push()
    assert moving.recover() == SUCCEEDED
    wait_for(lambda: arm.is_in("idle"), "The end of the reflex")
