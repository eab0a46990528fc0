# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Joint impedance with torque commands: the desired position swings about the start."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

MAX_STEP = 1.0  # [Nm] per cycle, the robot's limit


class JointImpedance:
    """Commands effort. Parameters: k_gains [Nm/rad], d_gains [Nm s/rad], seven each; amplitude [rad] and
    frequency [Hz] of the swing of the fourth joint."""

    def __init__(self, parameters: Mapping[str, Any]) -> None:
        self.k = np.array(parameters["k_gains"], dtype=float)
        self.d = np.array(parameters["d_gains"], dtype=float)
        self.amplitude = float(parameters.get("amplitude", 0.1))
        self.omega = 2.0 * np.pi * float(parameters.get("frequency", 0.2))

    def starting(self, state: Any, model: Any) -> None:
        self.begin = np.array(state.q)
        self.time = 0.0

    def target(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Desired joint positions and velocities, at rest at the start."""
        q, dq = self.begin.copy(), np.zeros(7)
        q[3] += self.amplitude / 2.0 * (1.0 - np.cos(self.omega * self.time))
        dq[3] = self.amplitude / 2.0 * self.omega * np.sin(self.omega * self.time)
        return q, dq

    def update(self, state: Any, model: Any, period: float) -> NDArray[np.float64]:
        self.time += period
        q, dq = self.target()
        tau = self.k * (q - state.q) + self.d * (dq - state.dq) + model.coriolis()
        # For seven numbers, np.clip takes five times as long as these.
        step = np.maximum(np.minimum(tau - state.tau_J_d, MAX_STEP), -MAX_STEP)
        command: NDArray[np.float64] = state.tau_J_d + step
        return command
