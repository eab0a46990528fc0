# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Joint motions of every kind that panda-python has, then one that is refused."""

import json
import math
import sys

from panda_py import libfranka

IMPEDANCE = libfranka.ControllerMode.kJointImpedance
SECONDS = 0.3


def motion(kind, value):
    """A callback: value(first state, time [s]) gives the numbers of a command."""
    passed, first = [0.0], []

    def callback(state, period):
        passed[0] += period.to_sec()
        if not first:
            first.append(state)
        command = kind(value(first[0], passed[0]))
        if passed[0] >= SECONDS:
            command = libfranka.motion_finished(command)
        return command

    return callback


def angles(first, time):
    q = list(first.q_d)
    q[5] += 2e-3 * (1.0 - math.cos(math.pi * min(time / SECONDS, 1.0)))
    return q


def speeds(first, time):
    return [0.0, 0.0, 0.0, 0.0, 0.0, 0.02 * math.sin(math.pi * min(time / SECONDS, 1.0)) ** 2, 0.0]


def spring(state, period):
    return libfranka.Torques([300.0 * (a - b) - 20.0 * v for a, b, v in zip(state.q_d, state.q, state.dq)])


robot = libfranka.Robot(sys.argv[1])
robot.control_joint_position(motion(libfranka.JointPositions, angles), IMPEDANCE, False)
robot.control_joint_position(motion(libfranka.JointPositions, angles))
robot.control_joint_velocity(
    motion_generator_callback=motion(libfranka.JointVelocities, speeds), limit_rate=False
)
robot.control_torque_joint_position(spring, motion(libfranka.JointPositions, angles), False, 1000.0)
end = robot.read_once()


def leap(state, period):
    return libfranka.JointPositions([q + 0.1 for q in state.q_d])


try:
    robot.control_joint_position(leap, IMPEDANCE, False, 1000.0)
    refusal = ""
except RuntimeError as error:
    refusal = str(error)
after = robot.read_once()
errors = after.last_motion_errors
print(
    json.dumps(
        {
            "q": list(end.q),
            "success": end.control_command_success_rate,
            "refused": "joint_position_motion_generator_start_pose_invalid" in refusal,
            "reflex": after.robot_mode == libfranka.RobotMode.kReflex,
            "start invalid": errors.joint_position_motion_generator_start_pose_invalid,
            "collision": errors.joint_reflex or errors.cartesian_reflex,
            "flags": [name for name in sorted(dir(errors)) if name[0] != "_" and getattr(errors, name)],
            "any": bool(errors),
        }
    )
)
robot.automatic_error_recovery()
