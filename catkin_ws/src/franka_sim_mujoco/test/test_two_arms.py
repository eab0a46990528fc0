# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""One description with two arms, a Panda and an FR3: each has its state, model, hand and services."""

import threading
from pathlib import Path

import numpy as np
import pytest
import rospy
from actionlib_msgs.msg import GoalStatus
from control_msgs.msg import FollowJointTrajectoryAction
from franka_msgs.msg import FrankaState
from franka_sim_mujoco.pick_and_place import Arm, Gripper, PickAndPlace, Scene, wait_until
from franka_sim_mujoco.srv import DeleteRobot, SpawnRobot
from geometry_msgs.msg import Point, Pose, Quaternion
from ros_client import Action, Controllers, call, follow, launched, outcome, trajectory
from waiting import wait_for

HERE = Path(__file__).resolve().parent
SIDES = ("left", "right")
MOVE, USER_STOPPED = 2, 5
IMPEDANCE = "cartesian_impedance_example_controller"
START = [0.0, -0.785398163, 0.0, -2.35619449, 0.0, 1.57079632679, 0.785398163397]

pytestmark = [pytest.mark.own_process, pytest.mark.timeout(600)]


class Side(Arm):
    """One of the arms, with all modes and errors that it reported."""

    def __init__(self, arm_id: str):
        super().__init__(arm_id, f"/duo/{arm_id}/")
        self.modes, self.errors = [], set()

    def _store(self, state: FrankaState) -> None:
        super()._store(state)
        if not self.modes or self.modes[-1] != state.robot_mode:
            self.modes.append(state.robot_mode)
        errors = state.current_errors
        self.errors |= {name for name in errors.__slots__ if getattr(errors, name)}


@pytest.fixture(scope="module")
def arms(tmp_path_factory):
    with launched(str(HERE / "two_arms.launch"), log=tmp_path_factory.mktemp("two_arms") / "launch.log"):
        wait_until(lambda: rospy.get_time() > 0, "the simulation's clock")
        manager = Controllers("/duo")
        manager.wait_for(*(f"{side}/{name}" for side in SIDES for name in ("franka_gripper", IMPEDANCE)))
        yield manager, {side: Side(side) for side in SIDES}


def test_each_arm_places_its_stone(arms):
    _, sides = arms
    scene, placed, failed = Scene(), {}, {}

    def work(side):
        try:
            gripper = Gripper(f"/duo/{side}/")
            names = (f"{side}_stone", f"{side}_place_tray")
            task = PickAndPlace(sides[side], gripper, scene, lambda _: None, *names)
            for step in (task.prepare, task.pick, task.carry, task.place):
                step()
            placed[side] = task.placement()
        except Exception as error:  # is reported by the test
            failed[side] = error

    threads = [threading.Thread(target=work, args=[side]) for side in SIDES]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not failed
    assert all(placed[side].in_tray for side in SIDES), placed
    for side in SIDES:
        assert sides[side].modes == [MOVE] and sides[side].errors == set()


def test_a_switch_on_one_arm_leaves_the_motion_of_the_other_alone(arms):
    manager, sides = arms
    right = sides["right"]
    manager.load("right_alone")
    assert manager.switches(start=["right_alone"], stop=[f"right/{IMPEDANCE}"])
    target = START[:6] + [-2.6]
    goal = Action("/duo/right_alone/follow_joint_trajectory", FollowJointTrajectoryAction).send(
        trajectory(dict(zip([f"right_joint{i}" for i in range(1, 8)], target)), 8.0)
    )
    wait_for(lambda: max(map(abs, right.state.dq_d)) > 0.2, "The motion of the right arm")
    right.modes.clear()
    for name in (f"left/{IMPEDANCE}", "left/franka_gripper", "left/franka_state_controller"):
        assert manager.switches(stop=[name])
        assert manager.switches(start=[name])
        assert manager.switches(start=[name], stop=[name]), "a restart"
    assert outcome(goal)[0] == GoalStatus.SUCCEEDED
    assert right.modes == [MOVE] and right.errors == set()
    assert manager.switches(start=[f"right/{IMPEDANCE}"], stop=["right_alone"])


def test_one_controller_commands_both_arms_and_excludes_those_of_each(arms):
    manager, sides = arms
    manager.load("both", "left_alone")
    assert manager.switches(start=["both"], stop=[f"{side}/{IMPEDANCE}" for side in SIDES])
    assert not manager.switches(start=["left_alone"])
    names = [f"{side}_joint{i}" for side in SIDES for i in range(1, 8)]
    target = [q + 0.1 for q in START] + [q - 0.1 for q in START]
    follow("/duo/both", dict(zip(names, target)), 4.0)
    wait_for(
        lambda: np.allclose([q for side in SIDES for q in sides[side].state.q], target, atol=1e-3),
        "The pose of both arms",
    )
    assert all(sides[side].state.robot_mode == MOVE and sides[side].errors == set() for side in SIDES)


def test_arms_may_have_names_that_ros_cannot_have(arms):
    urdf = rospy.get_param("/duo/robot_description").replace("left_", "arm-1_").replace("right_", "arm-2_")
    answer = call(
        "/gazebo/spawn_robot",
        SpawnRobot,
        name="hyphens",
        robot_namespace="/hyphens",
        urdf=urdf,
        pose=Pose(position=Point(x=5), orientation=Quaternion(w=1)),
    )
    assert answer.success, answer.error
    rospy.wait_for_service("/hyphens/arm_1/franka_control/set_load", 30)
    assert call("/gazebo/delete_robot", DeleteRobot, name="hyphens").success
    answer = call(
        "/gazebo/spawn_robot",
        SpawnRobot,
        name="same",
        robot_namespace="/hyphens",
        urdf=urdf.replace("arm-2_", "arm_1_"),
        pose=Pose(position=Point(x=5), orientation=Quaternion(w=1)),
    )
    assert not answer.success
    assert "'arm-1' and 'arm_1'" in answer.error


def test_arms_of_one_description_are_not_served_at_one_address(arms):
    urdf = rospy.get_param("/duo/robot_description").replace("left_", "one_").replace("right_", "two_")
    rospy.set_param("/net/fci_ip", "127.0.0.9")
    answer = call(
        "/gazebo/spawn_robot",
        SpawnRobot,
        name="net",
        robot_namespace="/net",
        urdf=urdf,
        pose=Pose(orientation=Quaternion(w=1)),
    )
    assert not answer.success and "'one' and 'two'" in answer.error
