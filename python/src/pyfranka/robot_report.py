# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""What the line `report` of the control interface says about a robot (pyfranka.remote.Remote.report)."""

from __future__ import annotations

import json
from dataclasses import dataclass, fields

import numpy
from numpy.typing import NDArray

__all__ = ["EndEffector", "Hand", "RobotReport"]

Array = NDArray[numpy.float64]


@dataclass(frozen=True)
class Hand:
    """kind: "gripper", "vacuum" or "none"; widths [m]. homed: it has been homed since the start."""

    kind: str
    homed: bool
    width: float
    max_width: float
    grasped: bool
    busy: bool


@dataclass(frozen=True, eq=False)
class EndEffector:
    """mass [kg], center of mass 3 [m], inertia 9 [kg m^2], F_T_NE 4x4 as 16 numbers, column by column.
    power: whether the hand is reachable."""

    mass: float
    center: Array
    inertia: Array
    F_T_NE: Array
    power: bool


@dataclass(frozen=True, eq=False)
class RobotReport:
    """time [s] is that of the simulation. q, dq, q_d [rad], tau_J, tau_ext [Nm], O_T_EE (16, column by
    column), O_F_ext [N, Nm] as in franka::RobotState.

    rules: "desk" or "open". brakes: joint by joint, True is closed. inputs, buttons: by name, True is
    pressed. recoverable: errors of the safety controller that must be acknowledged. motion: a motion of Desk
    runs. fault: why the whole world stands still. The names are those of docs/franka_sim.md.
    """

    time: float
    type: str
    arm_id: str
    protocol: list[int]
    client: int
    rules: str
    mode: str
    errors: list[str]
    details: dict[str, str]
    fault: str
    q: Array
    dq: Array
    q_d: Array
    tau_J: Array
    tau_ext: Array
    O_T_EE: Array
    O_F_ext: Array
    success_rate: float
    power: bool
    brakes: list[bool]
    brakes_moving: bool
    operating_mode: str
    fci: bool
    inputs: dict[str, bool]
    conflicting_inputs: bool
    buttons: dict[str, bool]
    guiding: dict[str, object]
    navigation: str
    self_test: dict[str, object]
    recoverable: list[str]
    joint_limit_violation: list[bool]
    joint_position_error: list[bool]
    light: dict[str, object]
    hand: Hand
    end_effector: EndEffector
    motion: bool

    @classmethod
    def read(cls, text: str) -> RobotReport:
        """From the answer to the line. Raises ValueError if members are missing."""
        members = json.loads(text)
        try:
            values = {field.name: members[field.name] for field in fields(cls)}
            values["hand"] = Hand(**values["hand"])
            values["end_effector"] = EndEffector(**_arrays(values["end_effector"], EndEffector))
        except (KeyError, TypeError) as error:
            raise ValueError(f"The report of the robot is incomplete: {error}.") from None
        return cls(**_arrays(values, cls))


def _arrays(values: dict, kind: type) -> dict:
    arrays = {field.name for field in fields(kind) if field.type == "Array"}
    return {name: numpy.array(value, float) if name in arrays else value for name, value in values.items()}
