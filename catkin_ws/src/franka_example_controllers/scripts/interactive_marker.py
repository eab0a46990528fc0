#!/usr/bin/env python3
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Lets the user drag the equilibrium pose of an impedance controller in rviz.

Reads the arm's pose from franka_state_controller/franka_states, shows a marker there and publishes the
marker's pose on equilibrium_pose, every 5 ms of ROS time. The marker's frame is the private parameter
link_name, the base of the arm (<arm_id>_link0).
"""

from __future__ import annotations

import math
import sys
import threading

import numpy as np
import rospy
import rospy_connections
from franka_msgs.msg import FrankaState
from geometry_msgs.msg import Point, Pose, PoseStamped, Quaternion
from interactive_markers.interactive_marker_server import InteractiveMarkerServer
from tf.transformations import quaternion_from_matrix, unit_vector
from visualization_msgs.msg import (
    InteractiveMarker,
    InteractiveMarkerControl,
    InteractiveMarkerFeedback,
)

# Range of the marker [m]: about the arm's reach, and above the table.
POSITION_LIMITS = {"x": (-0.6, 0.6), "y": (-0.6, 0.6), "z": (0.05, 0.9)}
PUBLISH_PERIOD = 0.005  # [s]
MARKER_SCALE = 0.3  # [m]


def clamp(value: float, limits: tuple[float, float]) -> float:
    """The closest number to value within (lowest, highest)."""
    return min(max(value, limits[0]), limits[1])


def clamp_position(position: Point) -> None:
    """Moves a geometry_msgs/Point, in place, into the marker's range."""
    for axis, limits in POSITION_LIMITS.items():
        setattr(position, axis, clamp(getattr(position, axis), limits))


def pose_from_state(state: FrankaState) -> Pose | None:
    """Measured pose of the end effector in O, from a FrankaState; None if it has none."""
    matrix = state.O_T_EE  # 4x4 column-major
    if not all(math.isfinite(value) for value in matrix) or matrix[15] != 1.0:
        return None
    pose = Pose()
    pose.position.x, pose.position.y, pose.position.z = matrix[12:15]
    pose.orientation = Quaternion(*unit_vector(quaternion_from_matrix(np.reshape(matrix, (4, 4)).T)))
    return pose


def axis_controls() -> list[InteractiveMarkerControl]:
    """Six handles: rotation about and motion along each axis."""
    half = math.sqrt(0.5)
    axes = {"x": (half, 0.0, 0.0), "y": (0.0, 0.0, half), "z": (0.0, half, 0.0)}
    modes = {
        "rotate": InteractiveMarkerControl.ROTATE_AXIS,
        "move": InteractiveMarkerControl.MOVE_AXIS,
    }
    controls = []
    for axis, (x, y, z) in axes.items():
        for verb, mode in modes.items():
            control = InteractiveMarkerControl()
            control.name = verb + "_" + axis
            control.interaction_mode = mode
            control.orientation.x = x
            control.orientation.y = y
            control.orientation.z = z
            control.orientation.w = half
            controls.append(control)
    return controls


class PoseMarker:
    """A marker in rviz whose pose is published once per period [s] of ROS time.

    A callback of rviz moves the marker, a timer's thread publishes.
    """

    def __init__(
        self,
        frame_id: str,
        pose: Pose,
        *,
        name: str,
        description: str,
        server: InteractiveMarkerServer,
        publisher: rospy.Publisher,
        period: float,
    ):
        self._frame_id = frame_id
        self._pose = pose
        self._name = name
        self._lock = threading.Lock()
        self._publisher = publisher
        self._server = server
        marker = InteractiveMarker()
        marker.header.frame_id = frame_id
        marker.name = name
        marker.description = description
        marker.scale = MARKER_SCALE
        marker.pose = pose
        marker.controls = axis_controls()
        self._server.insert(marker, self._feedback)
        self._server.applyChanges()
        self._timer = rospy.Timer(rospy.Duration(period), self._publish)

    def _dragged(self, pose: Pose) -> None:
        """The user has dragged the marker here."""
        self._set_pose(pose)

    def _set_pose(self, pose: Pose) -> None:
        with self._lock:
            self._pose = pose
        self._server.setPose(self._name, pose)
        self._server.applyChanges()

    def _feedback(self, feedback: InteractiveMarkerFeedback) -> None:
        if feedback.event_type == InteractiveMarkerFeedback.POSE_UPDATE:
            self._dragged(feedback.pose)

    def _publish(self, _event: rospy.timer.TimerEvent) -> None:
        message = PoseStamped()
        message.header.frame_id = self._frame_id
        message.header.stamp = rospy.Time.now()
        with self._lock:
            message.pose = self._pose
        try:
            self._publisher.publish(message)
        except rospy.ROSException:  # the node exits while the timer still runs
            pass


class EquilibriumPoseMarker(PoseMarker):
    """The marker of the impedance controller, which stays within POSITION_LIMITS."""

    def __init__(self, link_name: str, pose: Pose):
        super().__init__(
            link_name,
            pose,
            name="equilibrium_pose",
            description="Equilibrium pose\nThe impedance controller draws the end effector here",
            server=InteractiveMarkerServer("equilibrium_pose_marker"),
            publisher=rospy.Publisher("equilibrium_pose", PoseStamped, queue_size=10),
            period=PUBLISH_PERIOD,
        )

    def _dragged(self, pose: Pose) -> None:
        clamp_position(pose.position)
        self._set_pose(pose)


def wait_for_pose() -> Pose | None:
    """The arm's pose from the first valid state; None if the node exits before it arrives."""
    topic = "franka_state_controller/franka_states"
    while not rospy.is_shutdown():
        try:
            # A timeout would run on ROS time, which stands still until a simulation starts:
            # without one the wait works at any time.
            pose = pose_from_state(rospy.wait_for_message(topic, FrankaState))
        except rospy.ROSInterruptException:
            return None
        except rospy.ROSException:
            continue
        if pose is not None:
            return pose
    return None


def main() -> int:
    rospy_connections.answer_help("rosrun franka_example_controllers interactive_marker.py", __doc__ or "")
    rospy_connections.init_node("equilibrium_pose_node")
    link_name = rospy.get_param("~link_name", None)
    if not isinstance(link_name, str) or not link_name:
        rospy.logfatal(
            "interactive_marker.py: set the parameter %s to the base link of the arm, such as 'panda_link0'.",
            rospy.resolve_name("~link_name"),
        )
        return 1
    rospy.loginfo(
        "Waiting for the arm's pose on %s.",
        rospy.resolve_name("franka_state_controller/franka_states"),
    )
    pose = wait_for_pose()
    if pose is None:
        return 0
    _marker = EquilibriumPoseMarker(link_name, pose)
    rospy.spin()
    return 0


if __name__ == "__main__":
    sys.exit(main())
