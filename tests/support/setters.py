# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The seven services that configure a robot."""

from franka_msgs.srv import (
    SetCartesianImpedance,
    SetEEFrame,
    SetForceTorqueCollisionBehavior,
    SetFullCollisionBehavior,
    SetJointImpedance,
    SetKFrame,
    SetLoad,
)

SETTERS = {
    "set_joint_impedance": SetJointImpedance,
    "set_cartesian_impedance": SetCartesianImpedance,
    "set_EE_frame": SetEEFrame,
    "set_K_frame": SetKFrame,
    "set_force_torque_collision_behavior": SetForceTorqueCollisionBehavior,
    "set_full_collision_behavior": SetFullCollisionBehavior,
    "set_load": SetLoad,
}
