#!/usr/bin/env python3
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Lets the user drag the frame between two arms, which a dual-arm controller makes them follow.

dual_arm_interactive_marker.py --left_arm_id ARM --right_arm_id ARM

Shows a marker in the base of the left arm where the controller's topic centering_frame says the frame is,
and publishes on its centering_frame_target_pose where it has been dragged, ten times a second of ROS time.
While one of the arms does not move under a controller (stopped by a reflex, say), the marker goes with the
frame, so that nothing jumps when the controller starts again.
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
    """The marker in rviz, and the topic that says where it is."""

    def __init__(self, frame_id, pose):
        self._frame_id = frame_id
        self._pose = pose  # where the marker is
        self._lock = threading.Lock()
        self._moving = {}  # arm -> is it under a controller?
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
        """Takes the mode of this arm into account from now on."""
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
        except rospy.ROSException:  # the node shuts down while the timer still runs
            pass


def wait_for_frame():
    """Where the controller's frame is at first; None when the node is shut down before it says so."""
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
