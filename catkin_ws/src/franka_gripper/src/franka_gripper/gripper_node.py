# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The node franka_gripper_node: actions and joint states of a Franka Hand."""

from __future__ import annotations

import logging
import math
import os
import threading
import time
from collections.abc import Callable
from types import ModuleType
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

import actionlib
import rospy
import rospy_connections
from control_msgs.msg import GripperCommandAction, GripperCommandResult
from sensor_msgs.msg import JointState

from franka_gripper.hand import Hand, Interrupted, Stopped
from franka_gripper.msg import (
    GraspAction,
    GraspResult,
    HomingAction,
    HomingResult,
    MoveAction,
    MoveResult,
    StopAction,
    StopResult,
)

if TYPE_CHECKING:
    import pyfranka

# Carries out a goal: goal, its result, whether it was canceled.
CarryOut = Callable[[Any, Any, Callable[[], bool]], None]
# Raises a Fault if a goal is impossible; may fill its result.
Check = Callable[[Any, Any], None]

NO_EFFORT = 1e-4  # [N] smaller efforts of gripper_action mean: move, do not grasp
ARRIVED = 1e-4  # [m] closer targets of gripper_action count as reached
RETRY = 0.2  # [s] between attempts to reach a hand that is starting
EPSILON = 0.005  # [m] libfranka's default tolerance of a grasp
SILENCE = 1.0  # [s] older states are no longer published

USAGE = """
Drives a Franka Hand: the actions ~homing, ~move, ~grasp, ~stop and ~gripper_action, and ~joint_states.
Parameters: ~robot_ip, ~joint_names (two) and others, which docs/franka_control.md lists.
franka_gripper.launch sets them.
"""
NO_HAND = (
    " Without a robot, start a simulated one: `franka_sim --robot panda --ip "
    "127.0.0.1` (or fr3, any loopback address)."
)


class Fault(Exception):
    """An invalid parameter or goal; the message names it and the reason."""


def number(name: str, default: float, least: float) -> float:
    value = rospy.get_param("~" + name, default)
    given = isinstance(value, (int, float)) and not isinstance(value, bool)
    if not given or not math.isfinite(value) or value < least:
        raise Fault(f"The parameter {rospy.resolve_name('~' + name)} must be a number not below {least:g}.")
    return float(value)


def tolerance(name: str) -> float:
    """One of the tolerances of gripper_action; a missing one is zero, as in the original."""
    epsilons = rospy.get_param("~default_grasp_epsilon", None)
    if epsilons is not None and not isinstance(epsilons, dict):
        where = rospy.resolve_name("~default_grasp_epsilon")
        raise Fault(f"The parameter {where} must be a map with the numbers inner and outer [m].")
    return number("default_grasp_epsilon/" + name, EPSILON if epsilons is None else 0.0, 0.0)


def required(name: str) -> Any:
    if not rospy.has_param("~" + name):
        raise Fault(f"The parameter {rospy.resolve_name('~' + name)} is missing.")
    return rospy.get_param("~" + name)


class Parameters:
    """Parameters from the parameter server, checked."""

    def __init__(self) -> None:
        self.robot_ip: str = required("robot_ip")
        self.joint_names: list[str] = required("joint_names")
        if not isinstance(self.joint_names, list) or len(self.joint_names) != 2:
            raise Fault(f"The parameter {rospy.resolve_name('~joint_names')} must hold two names.")
        self.default_speed = number("default_speed", 0.1, 0.0)
        self.publish_rate = number("publish_rate", 30.0, 1e-3)
        self.connect_timeout = number("connect_timeout", 0.0, 0.0)
        self.stop_at_shutdown = bool(rospy.get_param("~stop_at_shutdown", False))
        self.epsilon_inner = tolerance("inner")
        self.epsilon_outer = tolerance("outer")


def check(condition: bool, text: str) -> None:
    if not condition:
        raise Fault(text)


class GoalServer(actionlib.SimpleActionServer):
    """Aborts an impossible goal at its arrival, so that it ends no other one.

    Accepts goals also after the clock has jumped back. The base class cancels each goal whose stamp is
    before that of an earlier goal, which would then be all of them until the clock is there again.
    """

    # Aborts a goal that is impossible, and returns whether it was.
    refuse: Callable[[Any], bool]

    def internal_goal_callback(self, goal: Any) -> None:
        if self.refuse(goal):
            return
        now = rospy.Time.now()
        for earlier in (self.current_goal, self.next_goal):
            if earlier.get_goal() and earlier.get_goal_id().stamp > now:
                # Not `now`: the clock may have gone on since the goal was sent.
                earlier.get_goal_id().stamp = goal.get_goal_id().stamp
        super().internal_goal_callback(goal)


class GripperNode:
    """Five actions; a new goal on any of them ends the running one.

    As with the hand's own interface, a goal that the hand executed without success is SUCCEEDED with
    result.success = False and a message. A goal is ABORTED if it is impossible, if the hand refused it or if
    the action stop ended it, and PREEMPTED if a cancel or another goal ended it.
    """

    def __init__(self, parameters: Parameters, hand: Hand):
        self._parameters = parameters
        self._hand = hand
        self._publisher = rospy.Publisher("~joint_states", JointState, queue_size=1)
        self._servers = [
            self._serve("homing", HomingAction, HomingResult, self._homing),
            self._serve("stop", StopAction, StopResult, None),
            self._serve("move", MoveAction, MoveResult, self._move, self._check_move),
            self._serve("grasp", GraspAction, GraspResult, self._grasp, self._check_grasp),
            self._serve(
                "gripper_action",
                GripperCommandAction,
                GripperCommandResult,
                self._command,
                self._check_command,
            ),
        ]
        for server in self._servers:
            server.start()
        self._ended = threading.Event()
        self._publishing = threading.Thread(target=self._publish_states, daemon=True)
        self._publishing.start()

    def shutdown(self) -> None:
        self._ended.set()
        if self._parameters.stop_at_shutdown:
            try:
                self._hand.stop()
            except Exception as error:
                rospy.logerr("The gripper did not stop at shutdown: %s", error)
        self._hand.close()

    @property
    def busy(self) -> bool:
        """Whether the hand executes a command."""
        return self._hand.busy

    # --- actions ------------------------------------------------------------------------------------

    def _serve(
        self,
        name: str,
        action: Any,
        result_type: Any,
        carry_out: CarryOut | None,
        check_goal: Check | None = None,
    ) -> Any:
        def execute(goal: Any) -> None:
            result = result_type()
            try:
                if carry_out is None:
                    result.success = self._hand.stop()
                else:
                    carry_out(goal, result, server.is_preempt_requested)
            except Interrupted:
                text = "Another command, or a cancel, ended this one."
                self._explain(result, text)
                server.set_preempted(result, text)
            except Stopped:
                self._abort(server, name, result, "The action stop ended this one.")
            except Fault as error:
                self._abort(server, name, result, str(error))
            except Exception as error:
                self._abort(server, name, result, f"{name}: {error}")
            else:
                server.set_succeeded(result)

        def refuse(handle: Any) -> bool:
            result = result_type()
            try:
                if check_goal is not None:
                    check_goal(handle.get_goal(), result)
            except Fault as error:
                handle.set_accepted()
                self._report(name, result, str(error))
                handle.set_aborted(result, str(error))
                return True
            return False

        server = GoalServer("~" + name, action, execute, auto_start=False)
        server.refuse = refuse
        return server

    @staticmethod
    def _explain(result: Any, text: str) -> None:
        if hasattr(result, "error"):
            result.error = text

    def _abort(self, server: Any, name: str, result: Any, text: str) -> None:
        self._report(name, result, text)
        server.set_aborted(result, text)

    def _report(self, name: str, result: Any, text: str) -> None:
        rospy.logerr("franka_gripper, %s: %s", name, text)
        self._explain(result, text)

    def _check_width(self, width: float) -> None:
        most = self._hand.state.max_width
        check(
            math.isfinite(width) and 0.0 <= width <= most,
            f"The width {width:g} m is not possible: it must lie between 0 and {most:g} m.",
        )

    def _homing(self, _goal: Any, result: Any, canceled: Callable[[], bool]) -> None:
        result.success = self._hand.run(lambda gripper: gripper.homing(), canceled)
        if not result.success:
            result.error = "Homing did not reach the fingers' ends: something is in their way."

    def _check_move(self, goal: Any, _result: Any) -> None:
        self._check_width(goal.width)
        check(math.isfinite(goal.speed) and goal.speed > 0.0, "Only positive speeds allowed")

    def _move(self, goal: Any, result: Any, canceled: Callable[[], bool]) -> None:
        result.success = self._hand.run(lambda gripper: gripper.move(goal.width, goal.speed), canceled)
        if not result.success:
            result.error = (
                f"The fingers stopped at {1e3 * self._hand.next_state().width:.1f} mm instead of "
                f"{1e3 * goal.width:.1f} mm: something is in their way."
            )

    def _check_grasp(self, goal: Any, result: Any) -> None:
        self._check_move(goal, result)
        check(math.isfinite(goal.force) and goal.force >= 0.0, "The force must be a number not below zero.")
        inner, outer = goal.epsilon.inner, goal.epsilon.outer
        check(
            math.isfinite(inner) and math.isfinite(outer) and min(inner, outer) >= 0.0,
            "The epsilons must be numbers not below zero.",
        )

    def _grasp(self, goal: Any, result: Any, canceled: Callable[[], bool]) -> None:
        inner, outer = goal.epsilon.inner, goal.epsilon.outer
        result.success = self._hand.run(
            lambda gripper: gripper.grasp(goal.width, goal.speed, goal.force, inner, outer), canceled
        )
        if not result.success:
            result.error = (
                f"The fingers came to rest at {1e3 * self._hand.next_state().width:.1f} mm, outside the "
                f"expected {1e3 * (goal.width - inner):.1f} to {1e3 * (goal.width + outer):.1f} mm: there is "
                "no object between them, or another one than expected."
            )

    def _check_command(self, goal: Any, result: Any) -> None:
        result.position = self._hand.state.width
        self._check_width(2.0 * goal.command.position)
        check(math.isfinite(goal.command.max_effort), "max_effort must be a number.")

    def _command(self, goal: Any, result: Any, canceled: Callable[[], bool]) -> None:
        """control_msgs/GripperCommand: the position is one finger's, the result's the whole width."""
        parameters, state = self._parameters, self._hand.state
        width, effort = 2.0 * goal.command.position, goal.command.max_effort
        result.position = state.width
        result.reached_goal = True
        # Fingers that another command moves have not arrived, whatever their width.
        if self._hand.busy or abs(width - state.width) >= ARRIVED:
            if abs(effort) < NO_EFFORT or width >= state.width:

                def command(gripper: pyfranka.Gripper) -> bool:
                    return gripper.move(width, parameters.default_speed)
            else:

                def command(gripper: pyfranka.Gripper) -> bool:
                    return gripper.grasp(
                        width,
                        parameters.default_speed,
                        abs(effort),
                        parameters.epsilon_inner,
                        parameters.epsilon_outer,
                    )

            result.reached_goal = False
            try:
                result.reached_goal = self._hand.run(command, canceled)
            finally:
                state = self._hand.next_state()
                result.position = state.width
        # Fingers that hold an object, or that came to rest elsewhere.
        result.stalled = state.is_grasped or not result.reached_goal
        result.effort = abs(effort) if state.is_grasped else 0.0
        check(
            result.reached_goal,
            f"The fingers did not reach {1e3 * width:.1f} mm: something is in their way, or there is "
            "nothing to grasp.",
        )

    # --- joint states -------------------------------------------------------------------------------

    def _publish_states(self) -> None:
        message = JointState(
            name=self._parameters.joint_names, position=[0.0] * 2, velocity=[0.0] * 2, effort=[0.0] * 2
        )
        rate = rospy.Rate(self._parameters.publish_rate)
        while not self._ended.is_set() and not rospy.is_shutdown():
            try:
                # Old widths with a new time stamp would be wrong.
                if self._hand.age < SILENCE:
                    message.header.stamp = rospy.Time.now()
                    message.position = [0.5 * self._hand.state.width] * 2
                    self._publisher.publish(message)
                rate.sleep()
            except (rospy.ROSInterruptException, rospy.ROSException):
                return  # the node exits


def connect(parameters: Parameters, pyfranka: ModuleType) -> Hand:
    """Connects to the hand; retries until the timeout."""
    deadline = time.monotonic() + parameters.connect_timeout
    while True:
        try:
            return Hand(lambda: pyfranka.Gripper(parameters.robot_ip), rospy.logerr)
        except pyfranka.NetworkException:
            if time.monotonic() >= deadline or rospy.is_shutdown():
                raise
            time.sleep(RETRY)


def warn_of_unknown_joints(parameters: Parameters) -> None:
    """Warns about fingers that robot_description, if there is one, lacks."""
    name = rospy.search_param("robot_description")
    try:
        description = ElementTree.fromstring(rospy.get_param(name)) if name else None
    except (ElementTree.ParseError, TypeError):
        return  # the nodes that need the description report it
    known = set() if description is None else {joint.get("name") for joint in description.iter("joint")}
    unknown = [joint for joint in parameters.joint_names if joint not in known]
    if known and unknown:
        rospy.logwarn(
            "franka_gripper_node: the parameter %s holds '%s', which is not a joint of '%s': give both the "
            "same arm_id.",
            rospy.resolve_name("~joint_names"),
            unknown[0],
            name,
        )


def main() -> int:
    rospy_connections.answer_help("rosrun franka_gripper franka_gripper_node", USAGE)
    rospy_connections.init_node("franka_gripper_node")
    # Only here, after init_node: pyfranka exists only if libfranka was built.
    import pyfranka

    try:
        parameters = Parameters()
        warn_of_unknown_joints(parameters)
        hand = connect(parameters, pyfranka)
    except Fault as error:
        rospy.logfatal("franka_gripper_node: %s", error)
        return 255
    except Exception as error:
        hint = NO_HAND if isinstance(error, pyfranka.NetworkException) else ""
        address = rospy.get_param("~robot_ip")
        rospy.logfatal("franka_gripper_node: no gripper at %s. %s%s", address, error, hint)
        return 255
    node = GripperNode(parameters, hand)
    rospy.spin()
    node.shutdown()
    if node.busy:
        # The hand continues its command; the thread that waits for it must not return after the
        # interpreter's end.
        logging.shutdown()
        os._exit(0)
    return 0
