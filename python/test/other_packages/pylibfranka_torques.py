# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A torque controller in its own loop: joint 1 follows a swing by a spring and a damper."""

import json
import math
import sys

from pylibfranka import RealtimeConfig, Robot, RobotMode, Torques

STIFFNESS, DAMPING, SECONDS = 200.0, 20.0, 0.4

robot = Robot(sys.argv[1], RealtimeConfig.kIgnore)
robot.set_collision_behavior([80.0] * 7, [80.0] * 7, [80.0] * 6, [80.0] * 6)
control = robot.start_torque_control()
time, start, finished = 0.0, None, False
while not finished:
    state, duration = control.readOnce()
    time += duration.to_sec()
    start = start or list(state.q)
    target = list(start)
    target[0] += 0.01 * (1.0 - math.cos(math.pi * time / SECONDS))
    tau = Torques([STIFFNESS * (t - q) - DAMPING * dq for t, q, dq in zip(target, state.q, state.dq)])
    if time >= SECONDS:
        tau.motion_finished = finished = True
    control.writeOnce(tau)
state = robot.read_once()
print(json.dumps({"time": time, "q": list(state.q), "idle": state.robot_mode == RobotMode.Idle}))
