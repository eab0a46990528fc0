#!/usr/bin/env python3
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Lets the user drag the frame between two arms, which a dual-arm controller follows.

dual_arm_interactive_marker.py --left_arm_id ARM --right_arm_id ARM

Shows a marker, in the base of the left arm, at the pose from the controller's topic centering_frame, and
publishes the dragged pose on its centering_frame_target_pose, ten times per second of ROS time. While one of
the arms is not controlled (for example after a reflex), the marker follows the frame, so that nothing jumps
when the controller starts again.
"""

import argparse
import os
import sys
import threading

import rospy
import rospy_connections
from franka_msgs.msg import FrankaState
from geometry_msgs.msg import PoseStamped
from interactive_markers.interactive_marker_server import InteractiveMarkerServer
from visualization_msgs.msg import InteractiveMarker, InteractiveMarkerFeedback

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from interactive_marker import axis_controls  # noqa: E402

NAME = "target_pose"
CONTROLLER = "dual_arm_cartesian_impedance_example_controller"
FRAME_TOPIC = CONTROLLER + "/centering_frame"
TARGET_TOPIC = CONTROLLER + "/centering_frame_target_pose"
PUBLISH_PERIOD = 0.1  # [s]
MARKER_SCALE = 0.3  # [m]


class CenteringFrameMarker:
    """The marker in rviz, and the topic with its pose."""

    def __init__(self, frame_id, pose):
        self._frame_id = frame_id
        self._pose = pose  # of the marker
        self._lock = threading.Lock()
        self._moving = {}  # arm -> whether a controller moves it
        self._publisher = rospy.Publisher(TARGET_TOPIC, PoseStamped, queue_size=1)
        self._server = InteractiveMarkerServer("target_pose_marker")
        marker = InteractiveMarker()
        marker.header.frame_id = frame_id
        marker.name = NAME
        marker.description = "Centering frame\nBoth arms follow it and keep their relative pose"
        marker.scale = MARKER_SCALE
        marker.pose = pose
        marker.controls = axis_controls()
        self._server.insert(marker, self._feedback)
        self._server.applyChanges()
        self._frames = rospy.Subscriber(FRAME_TOPIC, PoseStamped, self._frame, queue_size=1)
        self._timer = rospy.Timer(rospy.Duration(PUBLISH_PERIOD), self._publish, reset=True)

    def watch(self, arm):
        """Subscribes to the state of this arm."""
        topic = f"{arm}_state_controller/franka_states"
        self._moving[arm] = False
        return rospy.Subscriber(topic, FrankaState, self._state, callback_args=arm, queue_size=1)

    def _state(self, state, arm):
        self._moving[arm] = state.robot_mode == FrankaState.ROBOT_MODE_MOVE

    def _all_moving(self):
        return all(self._moving.values())

    def _frame(self, message):
        if self._all_moving():
            return
        with self._lock:
            self._pose = message.pose
        self._server.setPose(NAME, message.pose)
        self._server.applyChanges()

    def _feedback(self, feedback):
        if feedback.event_type != InteractiveMarkerFeedback.POSE_UPDATE:
            return
        with self._lock:
            self._pose = feedback.pose
        self._server.applyChanges()

    def _publish(self, _event):
        if not self._all_moving():
            return
        message = PoseStamped()
        message.header.frame_id = self._frame_id
        message.header.stamp = rospy.Time.now()
        with self._lock:
            message.pose = self._pose
        try:
            self._publisher.publish(message)
        except rospy.ROSException:  # the node exits while the timer still runs
            pass


def wait_for_frame():
    """The controller's first frame; None if the node exits before it arrives."""
    while not rospy.is_shutdown():
        try:
            return rospy.wait_for_message(FRAME_TOPIC, PoseStamped)
        except rospy.ROSInterruptException:
            return None
        except rospy.ROSException:
            continue
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--left_arm_id", required=True, help="the arm in whose base the frame is given")
    parser.add_argument("--right_arm_id", required=True, help="the other arm")
    options = parser.parse_args(rospy.myargv(sys.argv)[1:])
    rospy_connections.init_node("target_pose_node")
    rospy.loginfo("Waiting for the controller's frame on %s.", rospy.resolve_name(FRAME_TOPIC))
    first = wait_for_frame()
    if first is None:
        return 0
    marker = CenteringFrameMarker(options.left_arm_id + "_link0", first.pose)
    _watched = [marker.watch(arm) for arm in (options.left_arm_id, options.right_arm_id)]
    rospy.spin()
    return 0


if __name__ == "__main__":
    sys.exit(main())
