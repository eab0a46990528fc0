# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The meaning of the numbers of a policy's action. All values of an action lie in [-1, 1].

The actions are applied in C++ (franka_sim/simulation/policy_episode.h).
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from numpy.typing import NDArray

from pyfranka._native import _sim

__all__ = ["CONTROLS", "Control"]

SPEED, TURN_SPEED = _sim.CARTESIAN_SPEEDS  # of a cartesian_delta of length 1 [m/s], [rad/s]


def shortened(vector: NDArray[Any], longest: float) -> NDArray[Any]:
    """The vector, or one of the same direction with the largest length allowed."""
    length = math.sqrt(vector @ vector)
    return vector if length <= longest else vector * (longest / length)


class Control(NamedTuple):
    """A way in which actions move an arm."""

    size: int  # how many numbers of the action an arm takes
    unit: str  # what they mean, for error messages and documentation


CONTROLS = {
    "torque": Control(7, "torques of the joints"),
    "joint_delta": Control(7, "position steps of the joints"),
    "cartesian_delta": Control(6, "steps of the end effector's position and orientation"),
}
