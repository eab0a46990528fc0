# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A torque controller as a callback: joint 1 follows a swing by a spring and a damper."""

import json
import math
import sys

from panda_py import libfranka

STIFFNESS, DAMPING, SECONDS = 200.0, 20.0, 0.4


class Swing:
    def __init__(self, start):
        self.start = list(start)
        self.time = 0.0

    def __call__(self, state, period):
        self.time += period.to_sec()
        target = list(self.start)
        target[0] += 0.01 * (1.0 - math.cos(math.pi * self.time / SECONDS))
        torques = [STIFFNESS * (t - q) - DAMPING * dq for t, q, dq in zip(target, state.q, state.dq)]
        command = libfranka.Torques(torques)
        if self.time >= SECONDS:
            command.motion_finished = True
        return command


robot = libfranka.Robot(sys.argv[1], libfranka.RealtimeConfig.kIgnore)
robot.set_collision_behavior([80.0] * 7, [80.0] * 7, [80.0] * 6, [80.0] * 6)
swing = Swing(robot.read_once().q)
robot.control(swing)
state = robot.read_once()
print(
    json.dumps(
        {"time": swing.time, "q": list(state.q), "idle": state.robot_mode == libfranka.RobotMode.kIdle}
    )
)
