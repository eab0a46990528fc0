# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Interfaces, services and state of the simulated arm, as in the manual's tables."""

import math
import re
from functools import partial
from pathlib import Path

import numpy as np
import pytest
import rospy
from actionlib_msgs.msg import GoalStatus
from franka_msgs.msg import ErrorRecoveryAction, ErrorRecoveryGoal, FrankaState
from franka_msgs.srv import (
    SetCartesianImpedance,
    SetEEFrame,
    SetForceTorqueCollisionBehavior,
    SetFullCollisionBehavior,
    SetJointConfiguration,
    SetJointImpedance,
    SetKFrame,
    SetLoad,
)
from franka_sim_mujoco.srv import PushBody, Step
from geometry_msgs.msg import Point, Vector3
from ros_client import Action, Controllers, call, launched
from rosgraph_msgs.msg import Log
from std_srvs.srv import SetBool
from waiting import wait_for

HERE = Path(__file__).resolve().parent
IDLE, MOVE, REFLEX, USER_STOPPED = 1, 2, 4, 5
IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
START = [0, -math.pi / 4, 0, -3 * math.pi / 4, 0, math.pi / 2, math.pi / 4]
WAIT = 120.0  # wall seconds

pytestmark = pytest.mark.own_process("robot")


def matrix(values, rows):
    return np.array(values).reshape(-1, rows).T


class Arm:
    """One robot through its topics and services."""

    def __init__(self, namespace, arm_id):
        self.namespace, self.arm_id, self.states = namespace, arm_id, []
        self.controllers = Controllers(namespace)
        topic = namespace + "/franka_state_controller/franka_states"
        self.subscriber = rospy.Subscriber(topic, FrankaState, self.states.append, queue_size=1000)

    def service(self, name, kind, *arguments, **fields):
        return call(f"{self.namespace}/franka_control/{name}", kind, *arguments, **fields)

    def now(self):
        """The simulation's time, which states that lag behind services have not reached."""
        return call("/gazebo/step", Step, 0).time

    def when(self, condition, since=None):
        """The first state since then, or since now, that meets a condition."""
        begin = len(self.states) if since is None else 0
        now = self.now() if since is None else since

        def look():
            nonlocal begin
            states = self.states[begin:]
            begin += len(states)
            return next((state for state in states if state.header.stamp > now and condition(state)), None)

        return wait_for(look, "A state that is awaited", WAIT)

    def state(self):
        return self.when(lambda _: True)

    def after(self, seconds):
        begin = self.state().time
        return self.when(lambda state: state.time - begin >= seconds)

    def load(self, name):
        if name not in self.controllers.states():
            self.controllers.load(name)

    def switch(self, start=(), stop=()):
        for name in start:
            self.load(name)
        return self.controllers.switches(start, stop)

    def run(self, name, seconds, *extremes):
        """States of a controller from its start to its stop: after a time, and once each condition was met.

        Motions are periodic, and a state may be missing.
        """
        assert self.switch(start=[name]), name
        first = self.state()
        for is_met in (lambda state: state.time - first.time >= seconds, *extremes):
            self.when(is_met, first.header.stamp)
        states = self.states[self.states.index(first) :]
        assert self.switch(stop=[name]), name
        return states

    def recover(self):
        return Action(self.namespace + "/franka_control/error_recovery", ErrorRecoveryAction).run(
            ErrorRecoveryGoal()
        )

    def place(self, positions=START):
        names = [f"{self.arm_id}_joint{i}" for i in range(1, 8)]
        return call(
            self.namespace + "/set_franka_model_configuration",
            SetJointConfiguration,
            joint_names=names,
            joint_positions=positions,
        )

    def hand(self):
        x, y, z = matrix(self.state().O_T_EE, 4)[:3, 3]
        return Point(x, y, z)


PANDA = pytest.param("panda", marks=pytest.mark.long_form("the same for every robot"))


@pytest.fixture(scope="module", params=[PANDA, "fr3"])
def robot(request):
    return request.param


@pytest.fixture(scope="module")
def log_lines(robot, tmp_path_factory):
    """A launch with two arms, and what its nodes log from their start."""
    log = tmp_path_factory.mktemp("interfaces") / "launch.log"
    launch = [str(HERE / "interfaces.launch"), f"robot:={robot}", f"arm_id:=my_{robot}"]
    lines = []
    with launched(*launch, log=log):
        rospy.Subscriber("/rosout", Log, lambda message: lines.append(message.msg), queue_size=1000)
        yield lines


@pytest.fixture(scope="module")
def arms(robot, log_lines):
    """An arm with another name than its type, and one with reflexes."""
    both = Arm("", f"my_{robot}"), Arm("/strict", "strict")
    for arm, awaited in zip(both, ("franka_state_controller", "hold")):
        arm.controllers.wait_for(awaited)
    return both


@pytest.fixture
def log_line(log_lines):
    """A function that waits for a line of the log, and returns its match with a pattern."""

    def match(pattern):
        def found():
            return next((m for line in list(log_lines) if (m := re.search(pattern, line))), None)

        return wait_for(found, f"The line '{pattern}'", WAIT)

    return match


@pytest.fixture
def arm(arms):
    """The first arm: idle in its start pose."""
    arm = arms[0]
    arm.switch(stop=[name for name in arm.controllers.running() if name != "franka_state_controller"])
    arm.place()
    arm.when(lambda state: state.robot_mode == IDLE and max(map(abs, state.dq)) < 1e-4)
    return arm


@pytest.fixture
def strict(arms):
    return arms[1]


def follows(states, tolerance=1e-3):
    """Fails on errors in the states, or if the arm did not follow its desired positions."""
    for state in states:
        assert state.robot_mode == MOVE
        assert state.current_errors == type(state.current_errors)()
        assert state.control_command_success_rate == 1.0
        assert max(abs(a - b) for a, b in zip(state.q, state.q_d)) < tolerance


# ---- interfaces ----


@pytest.mark.parametrize(
    "motion", ["joint_position", "joint_velocity", "cartesian_pose", "cartesian_velocity", "joint_impedance"]
)
def test_the_arm_follows_each_command_interface(arm, motion):
    """tests/test_controller_formulas.py checks the motions themselves."""
    before = np.array(arm.state().q_d)
    states = arm.run(
        motion + "_example_controller", 1.0, lambda state: np.abs(np.array(state.q_d) - before).max() > 0.02
    )
    # A soft user controller of torques follows with the error of its gains.
    follows(states, 0.05 if motion == "joint_impedance" else 1e-3)


def test_elbow_of_the_pose_interface(arm):
    before = arm.state()
    states = arm.run(
        "elbow_example_controller",
        5.5,
        lambda state: state.elbow_c[0] - before.elbow_d[0] > math.pi / 5 - 1e-3,
    )
    follows(states)
    for state in states:
        assert np.abs(np.array(state.O_T_EE_d) - before.O_T_EE_d).max() < 1e-6
        assert state.elbow_d[0] == pytest.approx(state.q_d[2], abs=1e-9)
    assert max(state.elbow_c[0] - before.elbow_d[0] for state in states) < math.pi / 5 + 1e-3


def test_claims_conflict_as_on_the_robot(arm):
    assert arm.switch(start=["joint_position_example_controller"])
    for name in (
        "joint_velocity_example_controller",
        "cartesian_pose_example_controller",
        "joint_impedance_example_controller",
    ):
        arm.load(name)
        assert not arm.switch(start=[name]), name
    assert arm.controllers.states()["joint_position_example_controller"] == "running"
    assert arm.switch(start=["force_example_controller"])  # torques in addition to a motion
    assert arm.state().robot_mode == MOVE


# ---- state ----


def test_state_at_rest(arm):
    state = arm.state()
    np.testing.assert_allclose(state.q, START, atol=1e-3)
    np.testing.assert_allclose(state.q_d, state.q, atol=1e-3)
    np.testing.assert_allclose(state.O_T_EE_d, state.O_T_EE, atol=1e-3)
    np.testing.assert_allclose(state.O_T_EE_c, state.O_T_EE_d, atol=1e-12)
    np.testing.assert_allclose(state.theta, np.array(state.q) + np.array(state.tau_J) / 14250, atol=1e-9)
    for field in ("dq_d", "ddq_d", "tau_J_d", "O_dP_EE_d", "O_dP_EE_c", "O_ddP_EE_c", "delbow_c"):
        np.testing.assert_allclose(getattr(state, field), 0, atol=1e-9, err_msg=field)
    for field in ("dq", "dtheta", "tau_ext_hat_filtered", "O_F_ext_hat_K", "K_F_ext_hat_K"):
        np.testing.assert_allclose(getattr(state, field), 0, atol=0.05, err_msg=field)
    for field in ("joint_contact", "joint_collision", "cartesian_contact", "cartesian_collision"):
        np.testing.assert_allclose(getattr(state, field), 0, err_msg=field)
    assert state.elbow[0] == pytest.approx(state.q[2], abs=5e-8)
    assert state.elbow[1] == -1
    assert state.elbow_d[0] == pytest.approx(state.q_d[2], abs=5e-8)
    assert state.current_errors == type(state.current_errors)()
    assert state.time == pytest.approx(state.header.stamp.to_sec(), abs=2e-3)
    np.testing.assert_allclose(state.O_ddP_O, [0, 0, -9.81])
    # Gravity bends joint 2 and 4, not joint 1.
    assert abs(state.tau_J[0]) < 0.1
    assert abs(state.tau_J[3]) > 5


def test_pushes_are_reported_as_forces_contacts_and_collisions(arm):
    arm.service(
        "set_force_torque_collision_behavior",
        SetForceTorqueCollisionBehavior,
        [50.0] * 7,
        [80.0] * 7,
        [5.0] * 6,
        [12.0] * 6,
    )
    for force, collides in ((8.0, False), (24.0, True)):
        begin = arm.now()  # on a busy machine the push may have ended when this goes on
        answer = call(
            "/gazebo/push_body",
            PushBody,
            body=arm.arm_id + "_link7",
            point=arm.hand(),
            force=Vector3(0, force, 0),
            at_point=True,
            ticks=8000,
        )
        assert answer.success, answer.error
        # Forces that the robot exerts are positive: against the push.
        state = arm.when(
            lambda state, force=force: (
                abs(state.O_F_ext_hat_K[1] + force) < 0.3 and max(map(abs, state.dq)) < 1e-3
            ),
            since=begin,
        )
        world = matrix(state.O_T_EE, 4)[:3, :3] @ matrix(state.EE_T_K, 4)[:3, :3]
        np.testing.assert_allclose(world @ state.K_F_ext_hat_K[:3], state.O_F_ext_hat_K[:3], atol=1e-6)
        assert any(state.cartesian_contact)
        assert any(state.cartesian_collision) == collides
        assert state.robot_mode == IDLE  # reported, without a reaction
        arm.when(lambda state: abs(state.O_F_ext_hat_K[1]) < 0.3, since=state.header.stamp)
    # Without reflexes the flags follow the manual's formulas in each state: nothing is latched.
    arm.when(lambda state: not any(state.cartesian_collision) and not any(state.cartesian_contact))


# ---- services ----


def test_frames_and_loads(arm, request):
    request.addfinalizer(partial(arm.service, "set_load", SetLoad, 0, [0] * 3, [0] * 9))
    request.addfinalizer(partial(arm.service, "set_K_frame", SetKFrame, IDENTITY))
    request.addfinalizer(partial(arm.service, "set_EE_frame", SetEEFrame, IDENTITY))
    frame = list(IDENTITY)
    frame[14] = 0.1
    for moving in (False, True):
        if moving:
            arm.switch(start=["cartesian_impedance_example_controller"])
        for name, kind, good, bad in (
            ("set_EE_frame", SetEEFrame, [frame], [[2.0] + frame[1:]]),
            ("set_K_frame", SetKFrame, [frame], [[math.nan] * 16]),
            (
                "set_load",
                SetLoad,
                [0.5, [0, 0, 0.1], [0.01, 0, 0, 0, 0.02, 0, 0, 0, 0.03]],
                [-1, [0] * 3, [0] * 9],
            ),
        ):
            answer = arm.service(name, kind, *good)
            assert answer.success, answer.error
            answer = arm.service(name, kind, *bad)
            assert not answer.success
            assert len(answer.error) > 30
        state = arm.after(0.05)
        np.testing.assert_allclose(state.NE_T_EE, frame)
        np.testing.assert_allclose(state.EE_T_K, frame)
        np.testing.assert_allclose(matrix(state.F_T_EE, 4), matrix(state.F_T_NE, 4) @ matrix(frame, 4))
        assert state.m_load == pytest.approx(0.5, abs=5e-8)
        assert state.m_total == pytest.approx(state.m_ee + 0.5, abs=5e-8)
        center = (state.m_ee * np.array(state.F_x_Cee) + 0.5 * np.array([0, 0, 0.1])) / state.m_total
        np.testing.assert_allclose(state.F_x_Ctotal, center, atol=1e-12)


def test_the_end_effector_frame_is_fixed_during_a_motion(arm):
    arm.switch(start=["joint_position_example_controller"])
    answer = arm.service("set_EE_frame", SetEEFrame, IDENTITY)
    assert not answer.success
    assert "stop that controller" in answer.error


def test_impedances_and_thresholds(arm):
    lows, highs = [1.0] * 7, [2.0] * 7
    for name, kind, good, bad in (
        ("set_joint_impedance", SetJointImpedance, [[1000.0] * 7], [[-1.0] * 7]),
        ("set_cartesian_impedance", SetCartesianImpedance, [[500.0] * 3 + [50.0] * 3], [[5.0] * 6]),
        (
            "set_full_collision_behavior",
            SetFullCollisionBehavior,
            [lows, highs, lows, highs, lows[:6], highs[:6], lows[:6], highs[:6]],
            [[-1.0] * 7, highs, lows, highs, lows[:6], highs[:6], lows[:6], highs[:6]],
        ),
    ):
        answer = arm.service(name, kind, *good)
        assert answer.success, answer.error
        answer = arm.service(name, kind, *bad)
        assert not answer.success
        assert len(answer.error) > 30
    assert arm.service("set_joint_impedance", SetJointImpedance, [3000.0] * 4 + [2000.0] * 3).success
    high = [100.0] * 7
    arm.service(
        "set_force_torque_collision_behavior",
        SetForceTorqueCollisionBehavior,
        high,
        high,
        high[:6],
        high[:6],
    )
    arm.recover()


def test_lower_thresholds_above_the_upper_ones_are_taken_with_a_warning(arm, log_line):
    high, low = [31.0] * 7, [30.0] * 7
    name, kind = "set_force_torque_collision_behavior", SetForceTorqueCollisionBehavior
    answer = arm.service(name, kind, high, low, low[:6], high[:6])
    assert answer.success, answer.error
    log_line(r"^The lower torque threshold 1 \(31\) is above the upper one \(30\): collisions begin")
    name, kind = "set_full_collision_behavior", SetFullCollisionBehavior
    answer = arm.service(name, kind, low, high, low, high, high[:6], low[:6], low[:6], high[:6])
    assert answer.success, answer.error
    log_line(r"^Acceleration phase: The lower force threshold 1 \(31\) is above the upper one \(30\)")


def test_configuration_of_the_joints(arm):
    arm.load("joint_position_example_controller")  # only near the start pose
    assert arm.place([0.1, -0.7, 0.1, -2.2, 0.1, 1.6, 0.9]).success
    state = arm.after(0.2)
    np.testing.assert_allclose(state.q, [0.1, -0.7, 0.1, -2.2, 0.1, 1.6, 0.9], atol=1e-3)
    assert arm.switch(start=["joint_position_example_controller"])
    arm.when(lambda state: state.robot_mode == MOVE)
    refused = call(
        "/set_franka_model_configuration",
        SetJointConfiguration,
        joint_names=[arm.arm_id + "_joint1"],
        joint_positions=[9.0],
    )
    assert not refused.success and "stops" in refused.error
    # A running motion restarts at the arm's present position.
    assert arm.place().success
    state = arm.when(lambda state: state.robot_mode == MOVE)
    assert np.abs(np.array(state.q) - START).max() < 0.08  # the controller's amplitude


# ---- stops ----


def test_user_stop_disconnects_until_recovery(arm):
    arm.switch(start=["joint_position_example_controller"])
    assert arm.service("set_user_stop", SetBool, True).success
    stopped = arm.when(lambda state: state.robot_mode == USER_STOPPED)
    status, text = arm.recover()
    assert status == GoalStatus.ABORTED
    assert "set_user_stop" in text
    assert arm.service("set_user_stop", SetBool, False).success
    arm.when(lambda state: state.robot_mode == IDLE)
    later = arm.after(0.5)
    assert np.abs(np.array(later.q) - stopped.q).max() < 1e-3
    assert arm.recover()[0] == GoalStatus.SUCCEEDED
    arm.when(lambda state: state.robot_mode == MOVE)
    assert arm.controllers.states()["joint_position_example_controller"] == "running"


def test_reflexes_end_motions_if_configured(strict, log_line):
    strict.when(lambda state: state.robot_mode == MOVE)
    x, y, z = matrix(strict.state().O_T_EE, 4)[:3, 3]
    push = call(
        "/gazebo/push_body",
        PushBody,
        body="strict_link7",
        point=Point(x, y + 2, z),
        force=Vector3(0, 40, 0),
        at_point=True,
        ticks=100,
    )
    assert push.success, push.error
    state = strict.when(lambda state: state.robot_mode == REFLEX)
    assert state.current_errors.cartesian_reflex
    assert state.last_motion_errors.cartesian_reflex
    line = log_line(
        r"strict: the motion was ended by the robot: .*cartesian_reflex \((along|about) ([xyz]) of K: "
        r"external (force|torque) (\S+) (N|Nm), upper threshold (\S+) (N|Nm)\)"
    )
    way, axis, quantity, value, unit, threshold, unit_of_threshold = line.groups()
    assert (quantity, unit, unit_of_threshold) == ("force", "N", "N"), line.group()
    assert (way, float(threshold)) == ("along", 20.0), line.group()
    # The push of 40 N in O, in the axes of K: the wrench is the robot's, against the push.
    axes = matrix(state.O_T_EE, 4)[:3, :3] @ matrix(state.EE_T_K, 4)[:3, :3]
    full = -40 * axes[1, "xyz".index(axis)]
    assert abs(float(value)) > 20.0
    assert float(value) / full > 0.0
    strict.after(0.5)
    assert strict.recover()[0] == GoalStatus.SUCCEEDED
    state = strict.when(lambda state: state.robot_mode == MOVE)
    assert not state.current_errors.cartesian_reflex
    assert strict.controllers.states()["hold"] == "running"
