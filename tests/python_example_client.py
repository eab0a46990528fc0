# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Waits for the end of a circle and prints the desired positions of the end effector as JSON [m].

Run by test_example_controllers.py with the interpreter that ROS uses. Argument: seconds of the circle.
"""

import json
import sys
import time

import rospy
import rospy_connections
from franka_msgs.msg import FrankaState

WAIT = 90.0  # [s] of wall time, for a few seconds of the robot


def main():
    seconds, states = float(sys.argv[1]), []
    rospy_connections.init_node("python_example_client", anonymous=True)
    rospy.Subscriber("/franka_state_controller/franka_states", FrankaState, states.append, queue_size=1000)

    def moving():
        return [state for state in list(states) if state.robot_mode == FrankaState.ROBOT_MODE_MOVE]

    end = time.monotonic() + WAIT
    while not moving() or moving()[-1].time - moving()[0].time < seconds:
        if time.monotonic() > end:
            raise SystemExit(f"{len(states)} states in {WAIT} s, {len(moving())} of them in motion")
        time.sleep(0.1)
    print(json.dumps([state.O_T_EE_d[12:15] for state in moving()]))


if __name__ == "__main__":
    main()
