# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The hand, the settings, and the model."""

import json
import sys

import pylibfranka

address = sys.argv[1]
robot = pylibfranka.Robot(address, pylibfranka.RealtimeConfig.kIgnore)
robot.set_load(0.3, [0.0, 0.0, 0.05], [1e-3, 0, 0, 0, 1e-3, 0, 0, 0, 1e-3])
robot.set_K([1.0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])
robot.set_cartesian_impedance([2000.0] * 3 + [200.0] * 3)
state = robot.read_once()
state = robot.read_once()
model = robot.load_model()
seen = {
    "load": [state.m_load, list(state.F_x_Cload)],
    "gravity": list(model.gravity(state)),
    "coriolis": list(model.coriolis(state)),
    "time": state.time.to_sec() > 0.0,
}
state.q = [0.0, -0.5, 0.0, -2.0, 0.0, 1.5, 0.5]
state.m_total = 2.0
seen["other gravity"] = list(model.gravity(state))
robot.set_load(0.0, [0.0] * 3, [0.0] * 9)
try:
    robot.set_joint_impedance([1e6] * 7)
except pylibfranka.CommandException as error:
    seen["refusal"] = str(error)

gripper = pylibfranka.Gripper(address)
seen["hand"] = {
    "homing": gripper.homing(),
    "move": gripper.move(0.03, 0.1),
    "grasp": gripper.grasp(0.01, 0.1, 20.0, epsilon_inner=0.002, epsilon_outer=0.002),
    "stop": gripper.stop(),
}
seen["width"] = gripper.read_once().width
print(json.dumps(seen))
