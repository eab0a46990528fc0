#!/usr/bin/env python3
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The interactive marker with a simulated arm and the user dragging it, on the test's clock."""

import itertools
import math
import statistics
import sys
import unittest
from pathlib import Path

import rospy
import rospy_connections
from franka_msgs.msg import FrankaState
from geometry_msgs.msg import PoseStamped
from rosgraph_msgs.msg import Clock
from visualization_msgs.msg import InteractiveMarkerFeedback, InteractiveMarkerInit

sys.path.insert(0, str(Path(__file__).resolve().parents[4] / "tests" / "support"))
from waiting import holds, wait_for  # noqa: E402

PERIOD = rospy.Duration(nsecs=5000000)  # of the poses


class Subscribers(rospy.SubscribeListener):
    """Counts those that have come."""

    count = 0

    def peer_subscribe(self, *_):
        self.count += 1


class InteractiveMarkerTest(unittest.TestCase):
    def setUp(self):
        self.poses = []
        self.markers = []
        self.subscribers = Subscribers()
        self.clock = rospy.Publisher("/clock", Clock, queue_size=10)
        self.states = rospy.Publisher(
            "franka_state_controller/franka_states", FrankaState, self.subscribers, latch=True, queue_size=1
        )
        self.feedback = rospy.Publisher(
            "equilibrium_pose_marker/feedback", InteractiveMarkerFeedback, queue_size=10
        )
        rospy.Subscriber("equilibrium_pose", PoseStamped, self.poses.append)
        rospy.Subscriber("equilibrium_pose_marker/update_full", InteractiveMarkerInit, self.markers.append)

    def run_clock(self, condition, what):
        """Sets the clock forwards by a period when a pose has come, until the condition holds."""

        def tick():
            poses = len(self.poses)
            self.clock.publish(Clock(clock=self.now))
            self.now += PERIOD
            holds(lambda: len(self.poses) > poses, 1.0, 0.001)  # at the start none comes
            return condition()

        wait_for(tick, what, pause=0.0)

    def poses_at(self, expected):
        """Received poses at the expected position."""
        return [
            pose
            for pose in self.poses
            if math.dist((pose.pose.position.x, pose.pose.position.y, pose.pose.position.z), expected) < 1e-7
        ]

    def updates_with_markers(self):
        """Its first update, from before it has a marker, is empty: a subscriber may see it or not."""
        return [update for update in self.markers if update.markers]

    def state(self, x=0.3, y=0.1, z=0.5):
        message = FrankaState()
        # Half a turn about x, the hand pointing down, typed with four digits.
        message.O_T_EE = [1, 0, 0, 0, 0, -0.9999, 0, 0, 0, 0, -0.9999, 0, x, y, z, 1]
        return message

    def drag(self, x, y, z):
        message = InteractiveMarkerFeedback()
        message.client_id = "test"
        message.marker_name = "equilibrium_pose"
        message.event_type = InteractiveMarkerFeedback.POSE_UPDATE
        message.pose.position.x, message.pose.position.y, message.pose.position.z = x, y, z
        message.pose.orientation.w = 1.0
        self.feedback.publish(message)

    def test_marker_follows_the_arm_and_then_the_user(self):
        wait_for(lambda: self.states.get_num_connections() > 0, "The node")
        self.assertEqual([], self.poses)

        # The marker does not follow a robot without a pose, and time still stands still.
        self.states.publish(FrankaState())
        before = self.subscribers.count
        wait_for(lambda: self.subscribers.count > before + 1, "Another subscription")
        self.assertEqual([], self.updates_with_markers())
        self.states.publish(self.state())
        wait_for(self.updates_with_markers, "A marker")
        marker = self.updates_with_markers()[-1].markers[0]
        self.assertEqual("equilibrium_pose", marker.name)
        self.assertEqual("panda_link0", marker.header.frame_id)
        self.assertAlmostEqual(0.3, marker.scale)
        self.assertEqual(
            {"rotate_x", "move_x", "rotate_y", "move_y", "rotate_z", "move_z"},
            {control.name for control in marker.controls},
        )

        # Now the simulation starts.
        wait_for(lambda: self.clock.get_num_connections() > 0, "A subscriber of the clock")
        self.now = rospy.Time(10)
        self.run_clock(lambda: len(self.poses) > 100, "A hundred poses")
        pose = self.poses[-1]
        self.assertEqual("panda_link0", pose.header.frame_id)
        self.assertAlmostEqual(0.3, pose.pose.position.x)
        self.assertAlmostEqual(0.1, pose.pose.position.y)
        self.assertAlmostEqual(0.5, pose.pose.position.z)
        q = pose.pose.orientation
        self.assertAlmostEqual(1.0, q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w, places=12)
        self.assertAlmostEqual(1.0, abs(q.x), places=4)
        stamps = [pose.header.stamp for pose in self.poses]
        self.assertEqual(PERIOD, statistics.median_low(b - a for a, b in zip(stamps, stamps[1:])))

        # Dragged inside and outside of the marker's range.
        drags = [
            ((0.2, -0.2, 0.3), (0.2, -0.2, 0.3)),
            ((9.0, 9.0, 9.0), (0.6, 0.6, 0.9)),
            ((-9.0, -9.0, -9.0), (-0.6, -0.6, 0.05)),
        ]
        for target, expected in drags:
            self.drag(*target)
            self.run_clock(lambda expected=expected: self.poses_at(expected), f"The pose {expected}")

        # The simulation restarts: time goes back, and the marker continues to publish.
        self.now = rospy.Time(1)
        self.run_clock(
            lambda: sum(pose.header.stamp.secs < 9 for pose in self.poses) > 20, "A pose of that time"
        )


class DualArmMarkerTest(unittest.TestCase):
    def test_uses_the_topics_of_the_controller(self):
        controller = "/dual_arm_cartesian_impedance_example_controller/"
        clock = rospy.Publisher("/clock", Clock, queue_size=10)
        frames = rospy.Publisher(controller + "centering_frame", PoseStamped, queue_size=1, latch=True)
        targets = []
        rospy.Subscriber(controller + "centering_frame_target_pose", PoseStamped, targets.append)
        frame = PoseStamped()
        frame.pose.position.x, frame.pose.orientation.w = 0.4, 1.0
        frames.publish(frame)
        moving = FrankaState(robot_mode=FrankaState.ROBOT_MODE_MOVE)
        arms = []
        for arm in ("left", "right"):
            topic = f"/{arm}_state_controller/franka_states"
            arms.append(rospy.Publisher(topic, FrankaState, queue_size=1, latch=True))
            arms[-1].publish(moving)
        tenths = itertools.count(10000)
        wait_for(
            lambda: clock.publish(Clock(clock=rospy.Time.from_sec(next(tenths) / 10))) or targets,
            "A target",
            pause=0.01,
        )
        self.assertEqual(targets[0].header.frame_id, "left_link0")
        self.assertEqual(targets[0].pose, frame.pose)


class QuaternionTest(unittest.TestCase):
    def test_all_four_branches_of_the_quaternion(self):
        import interactive_marker

        half = math.sqrt(0.5)
        for quaternion in [
            (0, 0, 0, 1),
            (1, 0, 0, 0),
            (0, 1, 0, 0),
            (0, 0, 1, 0),
            (half, half, 0, 0),
            (0.5, 0.5, 0.5, 0.5),
            (0.1, -0.7, 0.3, math.sqrt(1 - 0.59)),
        ]:
            x, y, z, w = quaternion
            rows = [
                [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
            ]
            state = FrankaState()
            for column in range(3):
                for row in range(3):
                    state.O_T_EE[4 * column + row] = rows[row][column]
            state.O_T_EE[15] = 1.0
            result = interactive_marker.pose_from_state(state).orientation
            dot = x * result.x + y * result.y + z * result.z + w * result.w
            self.assertAlmostEqual(1.0, abs(dot), places=12)


class Suite(unittest.TestSuite):
    """All, in one run: rostest.rosrun() takes one suite."""

    def __init__(self):
        super().__init__()
        loader = unittest.TestLoader()
        for case in (QuaternionTest, InteractiveMarkerTest, DualArmMarkerTest):
            self.addTest(loader.loadTestsFromTestCase(case))


if __name__ == "__main__":
    import os

    import rospkg
    import rostest

    package = rospkg.RosPack().get_path("franka_example_controllers")
    sys.path.insert(0, os.path.join(package, "scripts"))
    rospy_connections.init_node("interactive_marker_test", disable_rostime=True)
    rostest.rosrun("franka_example_controllers", "interactive_marker", "interactive_marker_test.Suite")
