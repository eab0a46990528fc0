# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Cartesian motions: matrices are flat lists, column by column.

Commands are not filtered (1000 Hz): the filters of two libraries differ by one rounding, 5e-16 m.
"""

import json
import math
import sys

from panda_py import libfranka

SECONDS = 0.3
time, start = 0.0, None


def sideways(state, period):
    global time, start
    time += period.to_sec()
    if start is None:
        start = state.O_T_EE_c
    pose = start.copy()
    pose[13] += 1e-3 * (1.0 - math.cos(math.pi * min(time / SECONDS, 1.0)))
    command = libfranka.CartesianPose(pose)
    command.motion_finished = time >= SECONDS
    return command


def up(state, period):
    global time
    time += period.to_sec()
    twist = libfranka.CartesianVelocities([0.0] * 6)
    values = twist.O_dP_EE
    values[2] = 0.02 * math.sin(math.pi * min(time / SECONDS, 1.0)) ** 2
    twist.O_dP_EE = values
    twist.motion_finished = time >= SECONDS
    return twist


def settled():
    """A state after the arm has come to rest, or the last of a second."""
    for _ in range(1000):
        state = robot.read_once()
        if max(abs(v) for v in state.dq) < 1e-4:
            break
    return state


robot = libfranka.Robot(sys.argv[1])
before = robot.read_once()
robot.control_cartesian_pose(sideways, libfranka.ControllerMode.kCartesianImpedance, False, 1000.0)
time = 0.0
robot.control_cartesian_velocity(up, libfranka.ControllerMode.kCartesianImpedance, False, 1000.0)
after = settled()
model = robot.load_model()
jacobian = model.zero_jacobian(libfranka.Frame.kEndEffector, after)
print(
    json.dumps(
        {
            "before": before.O_T_EE,
            "after": after.O_T_EE,
            "lifted": after.O_T_EE[14] - before.O_T_EE[14],
            "row of z": jacobian[2::6],
            "flange": model.pose(libfranka.Frame.kFlange, robot_state=after)[12:15],
            "mass": model.mass(after)[:8],
            "is pose": libfranka.is_homogeneous_transformation(after.F_T_EE),
        }
    )
)
