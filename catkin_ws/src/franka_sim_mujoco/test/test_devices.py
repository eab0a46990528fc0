# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Joints of other devices, driven in addition to the arm as by Gazebo's default hardware."""

import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import actionlib
import numpy as np
import pytest
import rospy
from control_msgs.msg import GripperCommand, GripperCommandAction, GripperCommandGoal
from franka_msgs.msg import FrankaState
from franka_sim_mujoco.srv import DeleteRobot, GetBodyPose, SpawnRobot
from geometry_msgs.msg import Pose, Quaternion
from ros_client import Controllers, call, launched
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64
from waiting import wait_for

HERE = Path(__file__).resolve().parent
WAIT = 120.0  # wall seconds
MOVE = 2
ARM = [f"panda_joint{i}" for i in range(1, 8)]
FINGERS = ["panda_finger_joint1", "panda_finger_joint2"]

pytestmark = pytest.mark.own_process


class Joints:
    """All joint states of one robot."""

    def __init__(self, namespace):
        self.namespace, self.controllers, self.seen = namespace, Controllers(namespace), []
        rospy.Subscriber(namespace + "/joint_states", JointState, self._take, queue_size=1000)

    def _take(self, message):
        values = zip(message.name, message.position, message.velocity, message.effort)
        self.seen.append({name: rest for name, *rest in values})

    def when(self, condition, what):
        """The states from now to the first that meets a condition."""
        begin = at = len(self.seen)

        def look():
            nonlocal at
            for state in self.seen[at:]:
                at += 1
                if condition(state):
                    return self.seen[begin:at]
            return []

        return wait_for(look, what, WAIT)

    def when_at_rest(self, joint):
        """Waits for 30 states in one place: a joint that brakes swings back, with a velocity of 0 between."""
        begin = len(self.seen)

        def rests():
            places = [state[joint][0] for state in self.seen[begin:][-30:]]
            return len(places) == 30 and np.ptp(places) < 1e-4

        wait_for(rests, f"The {joint} to rest", WAIT)

    def switch(self, start=(), stop=()):
        self.controllers.load(*(name for name in start if name not in self.controllers.states()))
        return self.controllers.switches(start, stop)

    def command(self, controller, value):
        """Latched, so that it arrives."""
        name = f"{self.namespace}/{controller}/command"
        publisher = rospy.Publisher(name, Float64, queue_size=1, latch=True)
        publisher.publish(value)
        return publisher


def masses():
    """Mass of the lift and of everything above it [kg]."""
    links = ElementTree.fromstring(rospy.get_param("robot_description")).iter("mass")
    return [float(mass.get("value")) for mass in links]


@pytest.fixture(scope="module")
def devices(tmp_path_factory):
    """A robot on a lift, its arm's states, and a machine without an arm."""
    with launched(str(HERE / "devices.launch"), log=tmp_path_factory.mktemp("devices") / "launch.log"):
        robot, machine, arm = Joints(""), Joints("/machine"), []
        rospy.Subscriber("/franka_state_controller/franka_states", FrankaState, arm.append, queue_size=1000)
        robot.controllers.wait_for("lift_position", "head_velocity", "tilt_position", "fan_effort")
        machine.controllers.wait_for("slide", "joint_state_controller")
        yield robot, arm, machine


@pytest.fixture
def robot(devices):
    return devices[0]


@pytest.fixture
def arm(devices):
    return devices[1]


@pytest.fixture
def machine(devices):
    return devices[2]


def lift_to(robot, height):
    robot.command("lift_position", height)
    return robot.when(
        lambda state: abs(state["lift"][0] - height) < 1e-4 and abs(state["lift"][1]) < 1e-4,
        f"The lift's motion to {height} m",
    )


def largest_yield(states):
    """How far the arm's joints, held by springs, yield at most when the lift starts and stops [rad]: until
    the springs hold the kinetic energy of the whole load at the lift's speed. Then they return."""
    weakest = 2000.0  # [Nm/rad], of the joints' default stiffness
    return np.sqrt(sum(masses()) * max(state["lift"][1] for state in states) ** 2 / weakest)


def test_all_joints_are_published(robot):
    state = robot.when(lambda _: True, "A state")[-1]
    assert {*ARM, *FINGERS, "lift", "head", "tilt", "fan"} == set(state)


def test_the_lift_raises_the_arm_within_its_speed_limit(robot, arm):
    lift_to(robot, 0.0)
    # The arm controller of another test may only just have been stopped.
    robot.when(
        lambda _: arm[-1].robot_mode != MOVE and max(map(abs, arm[-1].dq)) < 1e-5,
        "The arm to rest",
    )
    before = arm[-1]
    states = lift_to(robot, 0.3)
    speeds = [state["lift"][1] for state in states]
    assert max(speeds) == pytest.approx(0.2, abs=1e-3)  # the URDF's limit
    base = call("/gazebo/get_body_pose", GetBodyPose, body="panda_link0").pose
    assert base.position.z == pytest.approx(0.2 + 0.3, abs=2e-4)
    for state in arm[arm.index(before) :]:
        assert np.abs(np.array(state.q) - before.q).max() < largest_yield(states)
        assert state.current_errors == type(state.current_errors)()
    robot.when(lambda _: np.abs(np.array(arm[-1].q) - before.q).max() < 1e-3, "The arm to stand again")


def test_an_arm_controller_runs_beside_the_lift(robot, arm):
    assert robot.switch(start=["joint_position_example_controller"])
    begin, at = len(arm), arm[-1].q_d[0]
    moves = lift_to(robot, 0.1) + lift_to(robot, 0.2)
    robot.when(lambda _: abs(arm[-1].q_d[0] - at) > 0.01, "The motion of joint 1 by its controller")
    states = [state for state in arm[begin:] if state.robot_mode == MOVE]
    assert robot.switch(stop=["joint_position_example_controller"])
    assert len(states) > 10
    # The control unit does not know the lift's accelerations at start and stop.
    deviations = [np.abs(np.array(state.q) - state.q_d).max() for state in states]
    assert max(deviations) < largest_yield(moves) and np.median(deviations) < 1e-3
    # It reports them as external forces, at least at the end; at rest it reports 1e-6 N.
    assert max(abs(state.O_F_ext_hat_K[2]) for state in states) > 1e-3


def test_velocities(robot):
    robot.command("head_velocity", 0.5)
    robot.when(lambda state: abs(state["head"][1] - 0.5) < 1e-3, "A velocity of 0.5 rad/s")
    robot.command("head_velocity", 5.0)
    robot.when(lambda state: abs(state["head"][1] - 1.0) < 1e-3, "The limit of 1 rad/s")
    assert robot.switch(stop=["head_velocity"])
    robot.when_at_rest("head")
    assert robot.switch(start=["head_velocity"])


def test_one_joint_accepts_either_interface(robot):
    lift_to(robot, 0.1)
    assert not robot.switch(start=["lift_velocity"]), "it is claimed"
    assert robot.switch(start=["lift_velocity"], stop=["lift_position"])
    robot.command("lift_velocity", 0.05)
    states = robot.when(lambda state: state["lift"][0] > 0.2, "A motion by velocity")
    assert states[-1]["lift"][1] == pytest.approx(0.05, abs=1e-3)
    assert robot.switch(start=["lift_position"], stop=["lift_velocity"])
    lift_to(robot, 0.2)


def test_gains_make_a_compliant_drive(robot):
    robot.command("tilt_position", 0.2)
    # A proportional drive of 20 Nm/rad, which an effort of 0 in the URDF does not limit; the camera's center
    # of mass is on the axis.
    robot.when(lambda state: abs(state["tilt"][0] - 0.2) < 1e-3, "A tilt of 0.2 rad")


def test_efforts(robot):
    robot.command("fan_effort", 0.7)
    speed = (0.7 - 0.2) / 0.5  # at which friction and damping of the URDF use the whole effort
    robot.when(lambda state: abs(state["fan"][1] - speed) < 1e-3, f"A speed of {speed} rad/s")
    robot.command("fan_effort", 100.0)
    speed = (1.2 - 0.2) / 0.5  # the URDF's limit of the effort
    robot.when(lambda state: abs(state["fan"][1] - speed) < 1e-3, f"A speed of {speed} rad/s")
    assert robot.switch(stop=["fan_effort"])
    robot.when(lambda state: abs(state["fan"][1]) < 1e-2, "Running out without a controller")
    assert robot.switch(start=["fan_effort"])


def test_a_machine_without_an_arm(machine):
    machine.command("slide", 0.25)
    states = machine.when(lambda state: abs(state["slide"][0] - 0.25) < 1e-4, "The slide's motion")
    assert max(state["slide"][1] for state in states) < 1.01
    machine.when(lambda state: abs(state["follower"][0] + 0.25) < 1e-3, "Its mirror's")


@pytest.mark.parametrize(("max_effort", "effort"), [(5.0, 5.0), (0.0, 10.0), (50.0, 10.0)])
def test_a_position_drive_presses_with_the_lower_of_its_limits(devices, max_effort, effort):
    press = Joints("/press")
    press.controllers.wait_for("grip", "joint_state_controller")
    client = actionlib.SimpleActionClient("/press/grip/gripper_cmd", GripperCommandAction)
    assert client.wait_for_server(rospy.Duration(WAIT))
    client.send_goal(GripperCommandGoal(GripperCommand(0.08, max_effort)))
    press.when(lambda state: abs(state["press"][2] - effort) < 1e-3, f"A force of {effort} N")
    assert client.wait_for_result(rospy.Duration(WAIT))
    result = client.get_result()
    assert result.stalled and not result.reached_goal
    assert result.position == pytest.approx(0.05, abs=1e-3)  # the ground
    client.send_goal(GripperCommandGoal(GripperCommand(0.02, 0.0)))
    press.when(lambda state: abs(state["press"][0] - 0.02) < 1e-4, "The way back")


def test_fingers_with_position_interfaces_are_joints_as_others(machine):
    """Descriptions of 2018 give them those."""
    before, fingers, after = re.split(
        r"(<transmission name=\"old_finger_joint1.*?</transmission>)",
        rospy.get_param("/old/robot_description"),
        flags=re.S,
    )
    urdf = before + fingers.replace("EffortJointInterface", "PositionJointInterface") + after
    names = [f"old_joint{i}" for i in range(1, 8)]
    answer = call(
        "/gazebo/spawn_robot",
        SpawnRobot,
        name="old",
        urdf=urdf,
        robot_namespace="/old",
        pose=Pose(orientation=Quaternion(w=1)),
        joint_names=names,
        joint_positions=[0, -0.785, 0, -2.356, 0, 1.571, 0.785],
    )
    assert answer.success, answer.error
    old = Joints("/old")
    assert old.switch(start=["joint_state_controller", "finger"])
    old.command("finger", 0.03)
    old.when(
        lambda state: all(abs(state[f"old_finger_joint{i}"][0] - 0.03) < 1e-3 for i in (1, 2)), "Both fingers"
    )
    assert call("/gazebo/delete_robot", DeleteRobot, name="old").success
