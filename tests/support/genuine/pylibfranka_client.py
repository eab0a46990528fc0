# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A session of pylibfranka (protocol 10) with a robot; prints a report as JSON."""

import json
import sys

import pylibfranka as franka
from session_parts import LOOSE, SENSITIVE, attempt, down, joints, pose, rise, torques

IMPEDANCE = franka.ControllerMode.JointImpedance
FRAME = [1.0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0.05, 1]


def fresh(robot):
    """A current state: during a blocking call older ones have filled the socket's buffer."""
    robot.read_once()
    return robot.read_once()


def drive(control, seconds, command):
    """Runs one motion. @returns cycles and the robot's seconds."""
    passed, cycles, first = 0.0, 0, None
    while True:
        state, period = control.readOnce()
        passed += period.to_sec() if cycles else 0.0
        cycles += 1
        first = first or {"q": list(state.q_d), "pose": list(state.O_T_EE_c)}
        value = command(first, passed / seconds)
        value.motion_finished = passed >= seconds
        control.writeOnce(value)
        if passed >= seconds:
            return cycles, passed


def meet_a_block(robot):
    """Moves down at 0.1 m/s until it hits something, and back up."""
    seen = {"thresholds": attempt(lambda: robot.set_collision_behavior(*SENSITIVE))}
    seen["contact"] = attempt(
        lambda: drive(robot.start_cartesian_velocity_control(IMPEDANCE), 5.0, down(franka, 0.1))
    )
    state = fresh(robot)
    seen["mode after contact"] = state.robot_mode.name
    seen["height"] = state.O_T_EE[14]
    seen["recovery after contact"] = attempt(robot.automatic_error_recovery)
    seen["retreat"] = attempt(
        lambda: drive(robot.start_cartesian_pose_control(IMPEDANCE), 2.0, rise(franka, 0.05))
    )
    seen["height after retreat"] = fresh(robot).O_T_EE[14]
    return seen


def session(address):
    robot = franka.Robot(address, franka.RealtimeConfig.kIgnore)
    state = robot.read_once()
    seen = {"mode": state.robot_mode.name, "m_ee": state.m_ee}
    model = robot.load_model()
    seen["gravity_error"] = max(abs(a - b) for a, b in zip(model.gravity(state), state.tau_J))
    seen["setters"] = {
        "load": attempt(lambda: robot.set_load(0.5, [0, 0, 0.1], [0.001, 0, 0, 0, 0.001, 0, 0, 0, 0.001])),
        "m_load": robot.read_once().m_load,
        "no load": attempt(lambda: robot.set_load(0.0, [0.0] * 3, [0.0] * 9)),
        "ee": attempt(lambda: robot.set_EE(FRAME)),
        "k": attempt(lambda: robot.set_K(FRAME)),
        "F_T_EE": fresh(robot).F_T_EE[14],
        "EE_T_K": fresh(robot).EE_T_K[14],
        "joint impedance": attempt(lambda: robot.set_joint_impedance([2000.0] * 7)),
        "cartesian impedance": attempt(lambda: robot.set_cartesian_impedance([1000.0] * 3 + [100.0] * 3)),
        "collision behavior": attempt(lambda: robot.set_collision_behavior(*LOOSE)),
        "bad impedance": attempt(lambda: robot.set_joint_impedance([1e6] * 7)),
        "bad cartesian impedance": attempt(lambda: robot.set_cartesian_impedance([1e6] * 6)),
    }
    starts = {
        "torque": (robot.start_torque_control, (), torques(franka), 1.0),
        "joint position": (robot.start_joint_position_control, (IMPEDANCE,), joints(franka, 0.2), 2.0),
        "pose": (robot.start_cartesian_pose_control, (IMPEDANCE,), pose(franka, -0.03), 2.0),
    }
    seen["motions"] = {}
    for name, (start, arguments, command, seconds) in starts.items():
        counted = []

        def run(start=start, arguments=arguments, command=command, seconds=seconds, counted=counted):
            counted.extend(drive(start(*arguments), seconds, command))

        outcome = attempt(run)
        state = robot.read_once()
        seen["motions"][name] = {
            "outcome": outcome,
            "cycles": counted[0] if counted else 0,
            "robot seconds": counted[1] if counted else 0.0,
            "q": list(state.q),
            "mode": state.robot_mode.name,
        }

    def leap():
        control = robot.start_joint_position_control(IMPEDANCE)
        state, _ = control.readOnce()
        for _ in range(10):
            control.writeOnce(franka.JointPositions([q + 0.05 for q in state.q_d]))
            state, _ = control.readOnce()

    seen["leap"] = attempt(leap)
    seen["mode after leap"] = fresh(robot).robot_mode.name
    seen["recovery"] = attempt(robot.automatic_error_recovery)
    seen["mode after recovery"] = fresh(robot).robot_mode.name
    seen["again"] = attempt(
        lambda: drive(robot.start_joint_position_control(IMPEDANCE), 1.0, joints(franka, -0.1))
    )
    seen["second client"] = attempt(lambda: franka.Robot(address, franka.RealtimeConfig.kIgnore))
    seen.update(meet_a_block(robot))
    gripper = franka.Gripper(address)
    seen["gripper"] = {
        "homing": gripper.homing(),
        "move": gripper.move(0.02, 0.1),
        "width": gripper.read_once().width,
        "empty grasp": gripper.grasp(0.01, 0.1, 20.0, 0.001, 0.001),
        "is grasped": gripper.read_once().is_grasped,
        "stop": gripper.stop(),
    }
    return seen


print(json.dumps(session(sys.argv[1])))
