# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The hand, the settings, the model and the small functions of panda-python."""

import datetime
import json
import sys

from panda_py import libfranka

address = sys.argv[1]
robot = libfranka.Robot(franka_address=address, realtime_config=libfranka.RealtimeConfig.kIgnore, log_size=10)
robot.set_load(load_mass=0.3, F_x_Cload=[0.0, 0.0, 0.05], load_inertia=[1e-3, 0, 0, 0, 1e-3, 0, 0, 0, 1e-3])
robot.set_joint_impedance([2500.0] * 7)
robot.set_guiding_mode([True] * 6, elbow=False)
robot.set_ee([1.0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])
states = []


def take(state):
    states.append(state)
    return len(states) < 3


robot.read(take)
state = robot.read_once()
model = robot.load_model()
seen = {
    "version": robot.server_version(),
    "load": [state.m_load, list(state.F_x_Cload)],
    "total": state.m_total,
    "passed": states[-1].time.to_msec() > states[0].time.to_msec(),
    "gravity": list(model.gravity(state)),
    "coriolis": list(model.coriolis(state.q, [0.1] * 7, state.I_total, state.m_total, state.F_x_Ctotal)),
    "moon": list(model.gravity(state, [0.0, 0.0, -1.62])),
}
robot.set_load(0.0, [0.0] * 3, [0.0] * 9)
try:
    robot.set_joint_impedance([1e6] * 7)
except RuntimeError as error:
    seen["refusal"] = str(error)

seen["durations"] = [libfranka.Duration(1500).to_sec(), libfranka.Duration().to_msec()]
seen["durations"].append(libfranka.Duration(datetime.timedelta(milliseconds=250)).to_msec())
seen["limited"] = list(libfranka.limit_rate(libfranka.MAX_TORQUE_RATE, [5.0] * 7, [0.5] * 7))
seen["elbows"] = [libfranka.is_valid_elbow([0.1, sign]) for sign in (1.0, -1.0, 0.0)]
seen["no errors"] = [bool(libfranka.Errors()), libfranka.Errors().joint_reflex]

gripper = libfranka.Gripper(address)
seen["hand"] = {
    "version": gripper.server_version(),
    "homing": gripper.homing(),
    "move": gripper.move(0.03, 0.1),
    "grasp": gripper.grasp(0.01, 0.1, 20.0, epsilon_inner=0.002, epsilon_outer=0.002),
    "stop": gripper.stop(),
}
hand = gripper.read_once()
seen["width"] = hand.width
seen["hand state"] = [hand.is_grasped, hand.max_width > hand.width, hand.time.to_sec() > 0.0]
print(json.dumps(seen))
