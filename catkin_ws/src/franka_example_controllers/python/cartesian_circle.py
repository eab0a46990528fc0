# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Moves the end effector on a circle in the yz plane with pose commands."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray


class CartesianCircle:
    """Commands cartesian_pose. Parameters: radius [m], round_trip [s], and ramp [s] to full speed."""

    def __init__(self, parameters: Mapping[str, Any]) -> None:
        self.radius = float(parameters.get("radius", 0.05))
        self.speed = 2.0 * np.pi / float(parameters.get("round_trip", 6.0))  # [rad/s]
        self.ramp = float(parameters.get("ramp", 2.0))

    def starting(self, state: Any, model: Any) -> None:
        self.begin = np.array(state.O_T_EE_d)
        self.time = 0.0

    def angle(self) -> float:
        """Angle along the circle; its speed rises as a cosine, without a jump of acceleration."""
        t = min(self.time, self.ramp)
        risen = t / 2.0 - self.ramp / (2.0 * np.pi) * np.sin(np.pi * t / self.ramp)
        return float(self.speed * (risen + self.time - t))

    def update(self, state: Any, model: Any, period: float) -> NDArray[np.float64]:
        self.time += period
        angle = self.angle()
        pose = self.begin.copy()
        pose[1, 3] += self.radius * (1.0 - np.cos(angle))
        pose[2, 3] += self.radius * np.sin(angle)
        return pose
