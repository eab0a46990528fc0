# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Moves the marker or leader of a two-arm example and prints the arms' motions as JSON.

Run by test_two_arm_controllers.py with the interpreter that ROS uses. Arguments: the robot type, then
dual, or teleop and the address of the leader.
"""

import json
import sys
import time

import numpy as np
import rospy
import rospy_connections
from franka_msgs.msg import FrankaState
from geometry_msgs.msg import PoseStamped
from pyfranka.remote import Remote
from visualization_msgs.msg import InteractiveMarkerFeedback

LEFT_FROM_RIGHT = np.array([0.0, 1.0, 0.0])  # [m] base of the left arm in the right one's: dual_panda_example
DRAG, STEPS, DRAG_PERIOD = np.array([0.03, 0.0, 0.04]), 20, 0.1  # [m], [s]


class Arms:
    """Stores the last states of two arms, and every pair of states with the same time."""

    def __init__(self, namespace, names):
        self.last, self.pairs, self.names = {}, [], names
        for name in names:
            topic = f"{namespace}/{name}_state_controller/franka_states"
            rospy.Subscriber(topic, FrankaState, self._take, callback_args=name)

    def _take(self, state, name):
        self.last[name] = state
        states = [self.last.get(name) for name in self.names]
        if all(states) and abs((states[0].header.stamp - states[1].header.stamp).to_sec()) < 0.0015:
            self.pairs.append(states)

    def moving(self):
        modes = [self.last[name].robot_mode for name in self.names if name in self.last]
        return modes == [FrankaState.ROBOT_MODE_MOVE] * 2

    def wait(self, seconds):
        """Waits for a duration of the robots' time, because a busy machine may be slower."""
        first = self.names[0]
        end = self.last[first].time + seconds
        wait_for(lambda: self.last[first].time >= end, f"The passing of {seconds} s")

    def speed(self):
        return max(abs(v) for name in self.names for v in self.last[name].dq)


def wait_for(condition, what, limit=60.0):
    deadline = time.monotonic() + limit
    while not condition():
        if time.monotonic() > deadline:
            raise SystemExit(f"{what} did not happen within {limit} s")
        time.sleep(0.05)


def relative(states):
    """Pose of the left end effector in the right one's."""
    right, left = (np.array(state.O_T_EE).reshape(4, 4).T for state in states)
    left = left.copy()
    left[:3, 3] += LEFT_FROM_RIGHT
    return np.linalg.inv(right) @ left


def dual(robot):
    namespace, right, left = f"/{robot}_dual", f"{robot}_1", f"{robot}_2"
    frames = []
    controller = namespace + "/dual_arm_cartesian_impedance_example_controller"
    rospy.Subscriber(controller + "/centering_frame", PoseStamped, frames.append)
    hand = rospy.Publisher(
        namespace + "/target_pose_marker/feedback", InteractiveMarkerFeedback, queue_size=10
    )
    arms = Arms(namespace, [right, left])
    wait_for(lambda: arms.moving() and frames and hand.get_num_connections(), "The controller's start")
    wait_for(lambda: arms.speed() < 1e-3, "Rest")
    begin, first = frames[-1].pose, relative([arms.last[name] for name in arms.names])
    start = np.array([begin.position.x, begin.position.y, begin.position.z])
    arms.pairs.clear()
    for step in range(1, STEPS + 1):
        feedback = InteractiveMarkerFeedback(client_id="test", marker_name="target_pose")
        feedback.header.frame_id = left + "_link0"
        feedback.event_type = InteractiveMarkerFeedback.POSE_UPDATE
        x, y, z = start + DRAG * step / STEPS
        feedback.pose.position.x, feedback.pose.position.y, feedback.pose.position.z = x, y, z
        feedback.pose.orientation = begin.orientation
        hand.publish(feedback)
        arms.wait(DRAG_PERIOD)

    def offset():
        at = frames[-1].pose.position
        return np.array([at.x, at.y, at.z]) - start

    wait_for(lambda: np.linalg.norm(offset() - DRAG) < 5e-3, "The motion to the marker")
    wait_for(lambda: arms.speed() < 1e-3, "Rest at the marker")
    changes = [relative(pair) - first for pair in list(arms.pairs)]
    return {
        "pairs": len(changes),
        "worst": max(float(np.linalg.norm(change[:3, 3])) for change in changes),
        "worst_rotation": max(float(np.abs(change[:3, :3]).max()) for change in changes),
        "left": float(np.linalg.norm(offset() - DRAG)),
        "still_moving_under_control": arms.moving(),
    }


def teleop(robot, leader_address):
    arms = Arms(f"/{robot}_teleop", ["leader", "follower"])
    wait_for(arms.moving, "The controller's start")

    def error():
        leader, follower = (np.array(arms.last[name].q) for name in arms.names)
        return float(np.abs(leader - follower).max())

    wait_for(lambda: error() < 0.01 and arms.speed() < 1e-2, "Alignment")
    begin = [np.array(arms.last[name].q) for name in arms.names]
    Remote(leader_address).push("leader_link7", (0, 12, 0), 300)
    moved = lambda: [  # noqa: E731
        float(np.abs(np.array(arms.last[name].q) - q).max()) for name, q in zip(arms.names, begin)
    ]
    wait_for(lambda: moved()[0] > 0.05, "A motion of the pushed leader")
    arms.wait(0.5)
    wait_for(lambda: moved()[1] > 0.05, "A motion of the follower")
    wait_for(lambda: error() < 1e-3 and arms.speed() < 0.05, "The follower's coming to the leader")
    leader, follower = moved()
    return {
        "leader": leader,
        "follower": follower,
        "error": error(),
        "still_moving_under_control": arms.moving(),
    }


def main():
    rospy_connections.init_node("two_arm_controllers_client", anonymous=True)
    robot, example, *rest = sys.argv[1:]
    print(json.dumps({"dual": dual, "teleop": teleop}[example](robot, *rest)))


if __name__ == "__main__":
    main()
