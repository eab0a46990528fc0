# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Kinds of the arguments of pyfranka's simulations and clients, by the arguments' names."""

from datetime import timedelta

import numpy as np
import pyfranka
from pyfranka.sim import Panda, Simulation
from wrong_calls import EYE, INF, NAN, Kind, bound, number, numbers, pose, switch, text, whole

START = (0, -0.785, 0, -2.356, 0, 1.571, 0.785)  # [rad]
FAR = 1e4  # [m], [N]: beyond what a world takes
QUATERNION_0 = (0, 0, 1, 0, 0, 0, 0)
FLAT = [0.0] * 7

BODIES = ([1], {3: [0, 0, 1]}, {"brick": [0, 0, 1]}, {"stone": [0, 0]}, {"stone": [NAN, 0, 0]})
BODIES += ({"table": [0, 0, 1]}, {"stone": QUATERNION_0}, {"stone": [FAR, 0, 0]})
POSITIONS = ("anywhere", [1, 2], [NAN] * 7, ["a"], np.ones(7), {"ur5": "random"}, object())
IN_A_WORLD = {
    "world": Kind("stone.xml", (5,), unknown=("moon.xml", "<mujoco/>")),
    "robots": Kind(None, (Panda(), "panda", 5, [5], ["ur5"]), word="robot"),
    "seed": whole(1, -1),
    "ticks": whole(1, -1),
    "q": Kind(START, unnamed=POSITIONS),
    "objects": Kind({"stone": [0, 0, 1]}, unnamed=BODIES),
}
SIMULATION = {
    **IN_A_WORLD,
    "name": Kind("panda", ([1], 5), word="robot", unknown=("ur5",)),
    "ip": text("127.0.34.1"),
    "robot": Kind("panda", (5,), unknown=("ur5",)),
    "pace": text("lockstep", "fast"),
    "patience": Kind(30.0, ("long", 0, -1, NAN, [1])),
    "wait": text("auto", "sleep"),
    "snapshot": Kind(None, (None, 5, Simulation().snapshot())),
    "body": text("stone", "nothing", word="bod"),
    "place_body.body": text("stone", "nothing", "table", word="bod"),
    "position": numbers([0, 0, 1], [0, 0, -FAR]),
    "orientation": numbers([1, 0, 0, 0], [0, 0, 0, 0]),
    "force": numbers([1, 0, 0], [FAR, 0, 0], [0, -1001, 0]),
    "torque": numbers([0, 0, 0], [0, 0, FAR]),
    "push.ticks": whole(1, 0, -5),
    "camera": text("", "nowhere"),
    "width": whole(64, 0, 5000, 64.0),
    "height": whole(64, -1, 5000),
}
COMMANDED = {"cartesian_velocities": [0.0] * 6}
DAMPING = numbers(FLAT, [-1.0] * 7)
ROBOT = {
    "torque": numbers(FLAT),
    "joint_positions": numbers(FLAT),
    "joint_velocities": numbers(FLAT, np.zeros((2, 7))),
    "cartesian_pose": pose(),
    "cartesian_velocities": numbers([0.0] * 6),
    "elbow": numbers([0.0, 1.0], given=COMMANDED),
    "controller": text("joint_impedance", "soft", given={"joint_positions": FLAT}),
    "limit_rate": switch(given={"torque": FLAT}),
    "command.damping": Kind(FLAT, DAMPING.wrong, given={"torque": FLAT}),
    "damping": DAMPING,
    "joint_impedance.target": Kind(
        START, unnamed=(*numbers(START).wrong, np.degrees(START), [*START[:6], 3.1])
    ),
    "target": pose(np.zeros((4, 4)), EYE + 3 * np.eye(4, k=3)),
    "duration": number(0.0, -1.0, INF, 1e7),
    "joint_impedance.stiffness": numbers([100.0] * 7, [-1.0] * 7),
    "stiffness": numbers([100.0] * 6, [-1.0] * 6),
    "nullspace_stiffness": number(1.0, INF, -1.0),
    "linear": switch(),
    "pressed": switch(),
    "active": switch(),
    "K_theta": Kind([1000.0] * 7, unnamed=numbers([1000.0] * 7, [1e9] * 7).wrong),
    "K_x": Kind([1000.0] * 6, unnamed=numbers([100.0] * 6, [-5.0] * 6).wrong),
    "lower_torque": numbers([10.0] * 7),
    "upper_torque": numbers([10.0] * 7),
    "lower_force": numbers([10.0] * 6),
    "upper_force": numbers([10.0] * 6),
    "NE_T_EE": pose(2 * EYE),
    "EE_T_K": pose(2 * EYE),
    "mass": number(0.1, 100.0, -1.0, INF),
    "F_x_Cload": Kind([0.0] * 3, unnamed=numbers([0.0] * 3, [5.0] * 3).wrong),
    "load_inertia": Kind([0.0] * 9, unnamed=numbers([0.0] * 9, [-1.0] * 9).wrong),
}
EPSILON = number(0.005, INF)
HAND = {
    "width": number(0.05, INF, 5.0, -0.03),
    "speed": number(0.1, INF, -1, 100),
    "force": number(10.0, INF, -1, FAR),
    "epsilon_inner": EPSILON,
    "epsilon_outer": EPSILON,
}

STATE = pyfranka.RobotState()


def never_called(*arguments):
    raise AssertionError("The motion has begun.")


# Right values of the client's arguments by their names.
RIGHT = {
    **dict.fromkeys(("callback", "control_callback", "motion_generator_callback"), never_called),
    "torque_callback": never_called,
    "controller_mode": pyfranka.ControllerMode.JointImpedance,
    "callback_order": pyfranka.CallbackOrder.MotionFirst,
    "first_cycle_reference": pyfranka.FirstCycleReference.Command,
    **dict.fromkeys(("limit_rate", "elbow"), True),
    "id": 0,
    **dict.fromkeys(("q", "dq", "K_theta", "maximum_velocities", "maximum_joint_velocities"), [1.0] * 7),
    "K_x": [300.0] * 6,
    "guiding_mode": [True] * 6,
    **dict.fromkeys(("NE_T_EE", "EE_T_K", "F_T_EE"), np.eye(4).tolist()),
    **dict.fromkeys(("mass", "m_total"), 0.1),
    **dict.fromkeys(("F_x_Cload", "F_x_Ctotal"), [0.0] * 3),
    "gravity_earth": [0.0, 0.0, -9.81],
    **dict.fromkeys(("load_inertia", "I_total"), [0.0] * 9),
    "frame": pyfranka.Frame.Flange,
    **dict.fromkeys(("state", "robot_state"), STATE),
    **dict.fromkeys(("width", "epsilon_inner", "epsilon_outer"), 0.04),
    "speed": 0.1,
    "force": 10.0,
    "vacuum": 5,
    "timeout": timedelta(seconds=1),
    "profile": pyfranka.VacuumGripper.ProductionSetupProfile.P0,
    **{
        f"{end}_{what}{phase}": [20.0] * (7 if what == "torque" else 6)
        for end in ("lower", "upper")
        for what in ("torque", "force")
        for phase in ("", "_acceleration", "_nominal")
    },
    **{
        f"{what}_frequency": 100.0
        for what in (
            *("cutoff", "joint_position_filter", "joint_velocity_filter"),
            *("cartesian_position_filter", "cartesian_velocity_filter", "controller_filter"),
        )
    },
}
ADDRESSES = {"address": text("a"), "realtime_config": bound("config", pyfranka.RealtimeConfig.Ignore)}
CLIENT = {
    **{name: bound(name, right) for name, right in RIGHT.items()},
    **ADDRESSES,
    "log_size": Kind(50, (object(), "big", -1)),
}
