# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A session of panda-python (libfranka 0.9.2, protocol 5) with a robot; prints a report as JSON."""

import json
import math
import sys

from panda_py import libfranka
from session_parts import LOOSE, SENSITIVE, attempt, down, joints, pose, rise, torques

IMPEDANCE = libfranka.ControllerMode.kJointImpedance
CARTESIAN = libfranka.ControllerMode.kCartesianImpedance


class Motion:
    """A callback that counts its cycles and the robot's time."""

    def __init__(self, seconds, command):
        self.seconds, self.command = seconds, command
        self.time, self.cycles, self.first = 0.0, 0, None

    def __call__(self, state, period):
        self.time += period.to_sec()
        self.cycles += 1
        if self.first is None:
            self.first = {"q": list(state.q_d), "pose": list(state.O_T_EE_c)}
        command = self.command(self.first, self.time / self.seconds)
        if self.time >= self.seconds:
            command.motion_finished = True
        return command


def joint_velocities(amplitude):
    def command(_, x):
        return libfranka.JointVelocities([0, 0, 0, 0, amplitude * math.sin(math.pi * min(x, 1.0)) ** 2, 0, 0])

    return command


def mode(robot):
    return str(robot.read_once().robot_mode).split(".")[-1]


def session(address):
    robot = libfranka.Robot(address)
    state = robot.read_once()
    seen = {"version": robot.server_version(), "mode": mode(robot), "m_ee": state.m_ee}
    model = robot.load_model()
    seen["gravity_error"] = max(abs(a - b) for a, b in zip(model.gravity(state), state.tau_J))

    load = (0.5, [0.0, 0.0, 0.1], [0.001, 0, 0, 0, 0.001, 0, 0, 0, 0.001])
    frame = [1.0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0.05, 1]
    seen["setters"] = {
        "load": attempt(lambda: robot.set_load(*load)),
        "m_load": robot.read_once().m_load,
        "no load": attempt(lambda: robot.set_load(0.0, [0.0] * 3, [0.0] * 9)),
        "ee": attempt(lambda: robot.set_ee(frame)),
        "k": attempt(lambda: robot.set_k(frame)),
        "F_T_EE": robot.read_once().F_T_EE[14],
        "joint impedance": attempt(lambda: robot.set_joint_impedance([2000.0] * 7)),
        "cartesian impedance": attempt(lambda: robot.set_cartesian_impedance([1000.0] * 3 + [100.0] * 3)),
        "guiding mode": attempt(lambda: robot.set_guiding_mode([True] * 6, False)),
        "collision behavior": attempt(lambda: robot.set_collision_behavior(*LOOSE)),
        "bad impedance": attempt(lambda: robot.set_joint_impedance([1e6] * 7)),
    }

    motions = {
        "torque": (Motion(1.0, torques(libfranka)), lambda m: robot.control(m, False)),
        "joint position": (
            Motion(2.0, joints(libfranka, 0.2)),
            lambda m: robot.control_joint_position(m, IMPEDANCE, False),
        ),
        "joint velocity": (
            Motion(1.0, joint_velocities(0.2)),
            lambda m: robot.control_joint_velocity(m, IMPEDANCE, False),
        ),
        "pose": (
            Motion(2.0, pose(libfranka, -0.03)),
            lambda m: robot.control_cartesian_pose(m, CARTESIAN, False),
        ),
        "limited": (
            Motion(2.0, joints(libfranka, -0.2)),
            lambda m: robot.control_joint_position(m, IMPEDANCE, True),
        ),
    }
    seen["motions"] = {}
    for name, (motion, run) in motions.items():
        outcome = attempt(lambda run=run, motion=motion: run(motion))
        seen["motions"][name] = {
            "outcome": outcome,
            "cycles": motion.cycles,
            "robot seconds": motion.time,
            "q": list(robot.read_once().q),
            "mode": mode(robot),
        }

    def leap(state, _):
        return libfranka.JointPositions([q + 0.05 for q in state.q_d])

    seen["leap"] = attempt(lambda: robot.control_joint_position(leap, IMPEDANCE, False))
    seen["mode after leap"] = mode(robot)
    seen["motion in reflex"] = attempt(
        lambda: robot.control_joint_position(Motion(1.0, joints(libfranka, 0.1)), IMPEDANCE, False)
    )
    seen["recovery"] = attempt(robot.automatic_error_recovery)
    seen["mode after recovery"] = mode(robot)

    def throw(*_):
        raise ValueError("a mistake of the program")

    seen["callback throws"] = attempt(lambda: robot.control_joint_position(throw, IMPEDANCE, False))
    seen["second client"] = attempt(lambda: libfranka.Robot(address))

    seen["thresholds"] = attempt(lambda: robot.set_collision_behavior(*SENSITIVE))
    seen["contact"] = attempt(
        lambda: robot.control_cartesian_velocity(Motion(5.0, down(libfranka, 0.1)), IMPEDANCE, False)
    )
    seen["mode after contact"] = mode(robot)
    seen["height"] = robot.read_once().O_T_EE[14]
    seen["recovery after contact"] = attempt(robot.automatic_error_recovery)
    seen["retreat"] = attempt(
        lambda: robot.control_cartesian_pose(Motion(2.0, rise(libfranka, 0.05)), IMPEDANCE, False)
    )

    seen["height after retreat"] = robot.read_once().O_T_EE[14]

    gripper = libfranka.Gripper(address)
    seen["gripper"] = {
        "version": gripper.server_version(),
        "homing": gripper.homing(),
        "move": gripper.move(0.02, 0.1),
        "width": gripper.read_once().width,
        "empty grasp": gripper.grasp(0.01, 0.1, 20.0, 0.001, 0.001),
        "stop": gripper.stop(),
    }
    return seen


print(json.dumps(session(sys.argv[1])))
