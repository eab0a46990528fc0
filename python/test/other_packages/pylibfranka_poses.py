# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A Cartesian motion: matrices are flat lists, column by column."""

import json
import math
import sys

import pylibfranka

SECONDS = 0.3


def settled():
    """A state after the arm has come to rest, or the last of a second."""
    for _ in range(1000):
        state = robot.read_once()
        if max(abs(v) for v in state.dq) < 1e-4:
            break
    return state


robot = pylibfranka.Robot(sys.argv[1], pylibfranka.RealtimeConfig.kIgnore)
control = robot.start_cartesian_pose_control(pylibfranka.ControllerMode.CartesianImpedance)
state, _ = control.readOnce()
start, time = state.O_T_EE_c, 0.0
pose = start.copy()
while True:
    command = pylibfranka.CartesianPose(pose)
    command.motion_finished = time >= SECONDS
    control.writeOnce(command)
    if command.motion_finished:
        break
    state, duration = control.readOnce()
    time += duration.to_sec()
    pose = start.copy()
    pose[13] += 1e-3 * (1.0 - math.cos(math.pi * min(time / SECONDS, 1.0)))
after = settled()
model = robot.load_model()
jacobian = model.zero_jacobian(after)
print(
    json.dumps(
        {
            "after": after.O_T_EE,
            "sideways": after.O_T_EE[13] - start[13],
            "row of z": jacobian[2::6],
            "mass": model.mass(after)[:8],
            "inertia": after.I_total,
        }
    )
)
