# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Valid bodies of requests to Desk: an end effector."""

INERTIA = {"x11": 0.01, "x12": 0.001, "x13": 0.0, "x22": 0.02, "x23": 0.0, "x33": 0.03}
INERTIAL = {"mass": 0.5, "centerOfMass": {"x": 0.0, "y": 0.01, "z": 0.05}, "inertia": INERTIA}
TCP = {"translation": {"x": 0.0, "y": 0.0, "z": 0.1}, "rotation": {"roll": 0.1, "pitch": 0.2, "yaw": 0.3}}
PROFILE = {"name": "tool", "deviceId": "ee-no-gripper", "modelUri": "", "inertial": INERTIAL, "tcp": TCP}
# In the configuration of the newer interface, and in the settings of a Panda.
PARAMETERS = {**INERTIAL, "transformation": TCP}
CONFIGURATION = {"endEffectorConfiguration": {"endEffector": {"name": "Other", "params": PARAMETERS}}}
SETTINGS = {
    "mass": 0.5,
    "centerOfMass": [0.0, 0.0, 0.05],
    "inertia": [0.001, 0, 0, 0, 0.001, 0, 0, 0, 0.001],
    "transformation": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0.1, 1],
}
