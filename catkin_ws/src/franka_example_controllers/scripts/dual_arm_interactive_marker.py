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

from __future__ import annotations

import argparse
import os
import sys

import rospy
import rospy_connections
from franka_msgs.msg import FrankaState
from geometry_msgs.msg import Pose, PoseStamped
from interactive_markers.interactive_marker_server import InteractiveMarkerServer

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from interactive_marker import PoseMarker  # noqa: E402

CONTROLLER = "dual_arm_cartesian_impedance_example_controller"
FRAME_TOPIC = CONTROLLER + "/centering_frame"
TARGET_TOPIC = CONTROLLER + "/centering_frame_target_pose"
PUBLISH_PERIOD = 0.1  # [s]


class CenteringFrameMarker(PoseMarker):
    """The marker of the dual-arm controller; it follows the frame while an arm is not controlled."""

    def __init__(self, frame_id: str, pose: Pose) -> None:
        self._moving: dict[str, bool] = {}  # arm -> whether a controller moves it
        super().__init__(
            frame_id,
            pose,
            name="target_pose",
            description="Centering frame\nBoth arms follow it and keep their relative pose",
            server=InteractiveMarkerServer("target_pose_marker"),
            publisher=rospy.Publisher(TARGET_TOPIC, PoseStamped, queue_size=1),
            period=PUBLISH_PERIOD,
        )
        self._frames = rospy.Subscriber(FRAME_TOPIC, PoseStamped, self._frame, queue_size=1)

    def watch(self, arm: str) -> rospy.Subscriber:
        """Subscribes to the state of this arm."""
        topic = f"{arm}_state_controller/franka_states"
        self._moving[arm] = False
        return rospy.Subscriber(topic, FrankaState, self._state, callback_args=arm, queue_size=1)

    def _state(self, state: FrankaState, arm: str) -> None:
        self._moving[arm] = state.robot_mode == FrankaState.ROBOT_MODE_MOVE

    def _all_moving(self) -> bool:
        return all(self._moving.values())

    def _frame(self, message: PoseStamped) -> None:
        if not self._all_moving():
            self._set_pose(message.pose)

    def _publish(self, event: rospy.timer.TimerEvent) -> None:
        if self._all_moving():
            super()._publish(event)


def wait_for_frame() -> PoseStamped | None:
    """The controller's first frame; None if the node exits before it arrives."""
    while not rospy.is_shutdown():
        try:
            return rospy.wait_for_message(FRAME_TOPIC, PoseStamped)
        except rospy.ROSInterruptException:
            return None
        except rospy.ROSException:
            continue
    return None


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
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
