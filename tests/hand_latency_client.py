# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Moves the hand of a simulated robot, and prints how long each move took in simulated time, as JSON.

Run by test_hand_latency.py with the interpreter that ROS uses.
"""

import json

import actionlib
import rospy
import rospy_connections
from franka_gripper.msg import MoveAction, MoveGoal
from sensor_msgs.msg import JointState

WAIT = 120.0  # [s]


class Hand:
    def __init__(self):
        self.widths = []  # of all joint states: time [s], width [m]
        rospy.Subscriber("/franka_gripper/joint_states", JointState, self._take, queue_size=1000)
        self._move = actionlib.SimpleActionClient("/franka_gripper/move", MoveAction)
        assert self._move.wait_for_server(rospy.Duration(WAIT)), "there is no hand"

    def _take(self, state):
        self.widths.append((state.header.stamp.to_sec(), sum(state.position)))

    def move(self, width):
        """Moves the fingers [m]. @returns times [s] until the first motion and until the result."""
        while not self.widths:
            rospy.sleep(0.01)
        begin, before = rospy.Time.now().to_sec(), self.widths[-1][1]
        self._move.send_goal(MoveGoal(width=width, speed=0.1))
        assert self._move.wait_for_result(rospy.Duration(WAIT)), "no result"
        took = rospy.Time.now().to_sec() - begin
        assert self._move.get_result().success, self._move.get_result()
        moved = [time for time, value in list(self.widths) if time > begin and abs(value - before) > 2e-4]
        return {"first": moved[0] - begin if moved else None, "took": took}


def main():
    rospy_connections.init_node("hand_latency_client")
    hand = Hand()
    hand.move(0.04)
    print(json.dumps({"small": hand.move(0.041), "large": hand.move(0.08)}))


if __name__ == "__main__":
    main()
