#!/usr/bin/python3
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Sends goals to a trajectory controller of a simulated Panda and prints the results as JSON."""

import json
import math
import sys
import time

import actionlib
import rospy
import rospy_connections
from actionlib_msgs.msg import GoalStatus
from control_msgs.msg import FollowJointTrajectoryAction, FollowJointTrajectoryGoal, JointTolerance
from controller_manager_msgs.srv import SwitchController
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectoryPoint

CONTROLLER = "{}_joint_trajectory_controller"
JOINTS = [f"panda_joint{i}" for i in range(1, 8)]
TARGET = [0.4, -0.5, 0.3, -2.0, 0.2, 1.8, 1.0]
WAIT = 60  # wall seconds


def positions():
    while True:
        message = rospy.wait_for_message("/franka_state_controller/joint_states", JointState, WAIT)
        if JOINTS[0] in message.name:
            return [message.position[message.name.index(joint)] for joint in JOINTS]


def goal_to(target, duration, count=100):
    start = positions()
    goal = FollowJointTrajectoryGoal()
    goal.trajectory.joint_names = JOINTS
    for k in range(1, count + 1):
        phase = math.pi * k / count
        omega = math.pi / duration
        ways = [b - a for a, b in zip(start, target)]
        goal.trajectory.points.append(
            JointTrajectoryPoint(
                positions=[a + way * (1 - math.cos(phase)) / 2 for a, way in zip(start, ways)],
                velocities=[way * omega * math.sin(phase) / 2 for way in ways],
                accelerations=[way * omega**2 * math.cos(phase) / 2 for way in ways],
                time_from_start=rospy.Duration(duration * k / count),
            )
        )
    return goal


def wait_for(condition, what):
    end = time.monotonic() + WAIT
    while not condition():
        if time.monotonic() > end:
            sys.exit(f"In vain: waited for {what}.")
        time.sleep(0.01)


def outcome(handle, target):
    wait_for(lambda: handle.get_comm_state() == actionlib.CommState.DONE, "the end of a goal")
    error = max(abs(a - b) for a, b in zip(positions(), target))
    result = handle.get_result()
    return {
        "status": GoalStatus.to_string(handle.get_goal_status()),
        "code": result.error_code,
        "text": result.error_string,
        "error": error,
    }


def action_of(interface):
    name = f"/{CONTROLLER.format(interface)}/follow_joint_trajectory"
    client = actionlib.ActionClient(name, FollowJointTrajectoryAction)
    if not client.wait_for_server(rospy.Duration(WAIT)):
        sys.exit(f"In vain: waited for {name}.")
    return client


def other_interfaces(home):
    """The same motion there and back, with positions and with velocities."""
    switch = rospy.ServiceProxy("/controller_manager/switch_controller", SwitchController)
    report, running = {}, "effort"
    for interface, target in (("position", TARGET), ("velocity", home)):
        started = switch(
            start_controllers=[CONTROLLER.format(interface)],
            stop_controllers=[CONTROLLER.format(running)],
            strictness=2,
            timeout=10.0,
        )
        report[interface] = {"started": started.ok}
        report[interface].update(outcome(action_of(interface).send_goal(goal_to(target, 4.0)), target))
        running = interface
    return report


def main():
    rospy_connections.init_node("joint_trajectory_client")
    client = action_of("effort")
    report = {}
    report["reached"] = outcome(client.send_goal(goal_to(TARGET, 4.0)), TARGET)

    back = [0.0, -math.pi / 4, 0.0, -3 * math.pi / 4, 0.0, math.pi / 2, math.pi / 4]
    strict = goal_to(back, 4.0)
    strict.path_tolerance = [JointTolerance(name=joint, position=1e-4) for joint in JOINTS]
    report["strict"] = outcome(client.send_goal(strict), back)

    cancelled = client.send_goal(goal_to(back, 4.0))
    wait_for(lambda: cancelled.get_comm_state() == actionlib.CommState.ACTIVE, "a goal to be accepted")
    cancelled.cancel()
    report["cancelled"] = outcome(cancelled, back)

    unknown = goal_to(back, 4.0)
    unknown.trajectory.joint_names = ["other"] + JOINTS[1:]
    report["unknown"] = outcome(client.send_goal(unknown), back)
    report.update(other_interfaces(back))
    print(json.dumps(report))


if __name__ == "__main__":
    main()
