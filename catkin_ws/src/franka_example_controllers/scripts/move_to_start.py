#!/usr/bin/env python3
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Moves the arm to the start pose of the example controllers with a joint trajectory controller.

Parameters: ~joint_pose, which maps the joints' names to positions [rad], and ~max_dq [rad/s]. Remap
~follow_joint_trajectory and ~joint_states to the controller's action and the arm's states, as
move_to_start.launch does.
"""

from __future__ import annotations

import sys
import threading
from collections.abc import Mapping
from typing import Any

import actionlib
import rospy
import rospy_connections
from control_msgs.msg import (
    FollowJointTrajectoryAction,
    FollowJointTrajectoryGoal,
    FollowJointTrajectoryResult,
)
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectoryPoint

MIN_DURATION = 0.5  # [s]
WAIT = 30.0  # [s] for the controller and the joints


def fail(text: str) -> int:
    rospy.logerr("move_to_start: %s", text)
    return 1


def goal_for(
    pose: Mapping[str, float], present: Mapping[str, float], max_dq: float
) -> tuple[FollowJointTrajectoryGoal, rospy.Duration]:
    """A goal of one point at rest, no faster than max_dq [rad/s]."""
    farthest = max(abs(pose[name] - present[name]) for name in pose)
    point = JointTrajectoryPoint()
    point.time_from_start = rospy.Duration.from_sec(max(farthest / max_dq, MIN_DURATION))
    goal = FollowJointTrajectoryGoal()
    goal.trajectory.joint_names, point.positions = map(list, zip(*pose.items()))
    point.velocities = [0.0] * len(pose)
    goal.trajectory.points.append(point)
    goal.goal_time_tolerance = rospy.Duration.from_sec(0.5)
    return goal, point.time_from_start


def run(client: actionlib.ActionClient, goal: FollowJointTrajectoryGoal, timeout: float) -> Any:
    """Sends a goal and waits for its end. @returns its handle, also after the timeout [s]."""
    # A SimpleActionClient logs errors about goals that a controller accepts at once.
    ended = threading.Event()

    def follow(handle: Any) -> None:
        if handle.get_comm_state() == actionlib.CommState.DONE:
            ended.set()

    handle = client.send_goal(goal, transition_cb=follow)
    rospy_connections.wait(ended, timeout)
    return handle


def main() -> int:
    rospy_connections.answer_help("rosrun franka_example_controllers move_to_start.py", __doc__ or "")
    rospy_connections.init_node("move_to_start")
    pose = rospy.get_param("~joint_pose", None)
    max_dq = rospy.get_param("~max_dq", 0.5)
    if not isinstance(pose, dict) or not pose:
        return fail("the parameter joint_pose must map the joints' names to positions [rad].")
    if not isinstance(max_dq, (int, float)) or not max_dq > 0.0:
        return fail("the parameter max_dq must be a number above zero [rad/s].")

    client = actionlib.ActionClient("~follow_joint_trajectory", FollowJointTrajectoryAction)
    if not rospy_connections.wait_for_server(client, WAIT):
        return fail(
            "no trajectory controller answers at "
            + rospy.resolve_name("~follow_joint_trajectory")
            + ". Is it running?"
        )
    try:
        message = rospy.wait_for_message("~joint_states", JointState, WAIT)
    except rospy.ROSException:
        return fail(f"no joint states arrive at {rospy.resolve_name('~joint_states')}.")
    present = dict(zip(message.name, message.position))
    missing = sorted(set(pose) - set(present))
    if missing:
        return fail(f"the robot has no joint named {', '.join(missing)}.")

    goal, duration = goal_for(pose, present, max_dq)
    rospy.loginfo("move_to_start: on the way, for %.1f s.", duration.to_sec())
    handle = run(client, goal, duration.to_sec() + WAIT)
    if handle.get_comm_state() != actionlib.CommState.DONE:
        handle.cancel()
        return fail("the controller does not end; the goal was canceled.")
    result = handle.get_result()
    if result is None or result.error_code != FollowJointTrajectoryResult.SUCCESSFUL:
        reason = result.error_string if result else handle.get_goal_status_text()
        return fail(f"the pose was not reached. {reason}")
    rospy.loginfo("move_to_start: arrived.")
    return 0


if __name__ == "__main__":
    sys.exit(main())
