# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Joint positions, joint velocities and a leap that the robot refuses."""

import json
import math
import sys

import pylibfranka as franka

SECONDS = 0.3


def drive(control, value):
    """Runs a motion: value(first state, time [s]) gives a command."""
    time, first = 0.0, None
    while True:
        state, duration = control.readOnce()
        time += duration.to_sec()
        first = first or state
        command = value(first, time)
        if time >= SECONDS:
            command.motion_finished = True
            control.writeOnce(command)
            return
        control.writeOnce(command)


def angles(first, time):
    q = list(first.q_d)
    q[5] += 2e-3 * (1.0 - math.cos(math.pi * min(time / SECONDS, 1.0)))
    return franka.JointPositions(q)


def speeds(first, time):
    command = franka.JointVelocities([0.0] * 7)
    command.dq = [0.0] * 5 + [0.02 * math.sin(math.pi * min(time / SECONDS, 1.0)) ** 2, 0.0]
    return command


robot = franka.Robot(robot_ip_address=sys.argv[1], realtime_config=franka.RealtimeConfig.kIgnore)
drive(robot.start_joint_position_control(franka.ControllerMode.JointImpedance), angles)
drive(robot.start_joint_velocity_control(franka.ControllerMode.JointImpedance), speeds)
end = robot.read_once()
refusal = ""
try:
    control = robot.start_joint_position_control(franka.ControllerMode.CartesianImpedance)
    for _ in range(20):
        state, _ = control.readOnce()
        control.writeOnce(franka.JointPositions([q + 0.1 for q in state.q_d]))
except franka.ControlException as error:
    refusal = str(error)
del control
robot.automatic_error_recovery()
print(
    json.dumps(
        {"q": list(end.q), "refused": "start_pose_invalid" in refusal, "errors": str(end.current_errors)}
    )
)
