# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The answer to the line `report` of the control interface, with types (docs/franka_sim.md).

Only the standard library is needed.
"""

from __future__ import annotations

import dataclasses
import json
import types
import typing
from dataclasses import dataclass

__all__ = ["Report", "report_of"]

Numbers = tuple[float, ...]
Flags = tuple[bool, ...]


@dataclass(frozen=True)
class Inputs:
    """Safety inputs; True: pressed. x31, x32, x33: stops; x4: the activation or enabling device; guiding: the
    enable button at the hand."""

    x31: bool
    x32: bool
    x33: bool
    x4: bool
    guiding: bool


@dataclass(frozen=True)
class Buttons:
    """Buttons of the Pilot; True: pressed."""

    circle: bool
    cross: bool
    check: bool
    up: bool
    down: bool
    left: bool
    right: bool


@dataclass(frozen=True)
class Guiding:
    """Hand guiding. axes: x, y, z, rotations about them, elbow; True: free."""

    active: bool
    mode: str
    axes: Flags


@dataclass(frozen=True)
class SelfTest:
    """left: of the running test [s]; due: until the next one must have run [s]."""

    running: bool
    left: float
    due: float


@dataclass(frozen=True)
class Light:
    """The light of the robot's base."""

    color: str
    blinking: bool


@dataclass(frozen=True)
class Hand:
    """The end effector's drive: kind gripper, vacuum or none; widths [m]."""

    kind: str
    homed: bool
    width: float
    max_width: float
    grasped: bool
    busy: bool


@dataclass(frozen=True)
class EndEffector:
    """The end effector that the robot assumes: mass [kg], center of mass in the flange's frame, 3 [m],
    inertia about it, 9 [kg m^2], and the pose F_T_NE of its tool, 16, column-major."""

    mass: float
    center: Numbers
    inertia: Numbers
    F_T_NE: Numbers
    power: bool


@dataclass(frozen=True)
class Report:
    """A robot at one instant of its time [s]. Names and units of the FCI's state where it has them.

    rules: "desk" or "open". brakes: joint by joint, True is closed. recoverable: errors of the safety
    controller that must be acknowledged. motion: a motion of Desk runs. fault: why the whole world stands
    still.

    >>> remote.report().brakes_open
    True
    """

    time: float
    type: str
    arm_id: str
    protocol: tuple[int, ...]
    client: int
    rules: str
    mode: str
    errors: tuple[str, ...]
    details: dict[str, str]
    fault: str
    q: Numbers
    dq: Numbers
    q_d: Numbers
    tau_J: Numbers
    tau_ext: Numbers
    O_T_EE: Numbers
    O_F_ext: Numbers
    success_rate: float
    power: bool
    brakes: Flags
    brakes_moving: bool
    operating_mode: str
    fci: bool
    inputs: Inputs
    buttons: Buttons
    guiding: Guiding
    navigation: str
    self_test: SelfTest
    recoverable: tuple[str, ...]
    joint_limit_violation: Flags
    joint_position_error: Flags
    light: Light
    hand: Hand
    end_effector: EndEffector
    motion: bool

    @property
    def brakes_open(self) -> bool:
        """Whether all brakes are open."""
        return not any(self.brakes)


def report_of(text: str) -> Report:
    """Reads the value of an answer to `report`. Raises ValueError with the reason."""
    try:
        report: Report = _object(Report, json.loads(text), "the report")
        return report
    except RecursionError:
        raise ValueError("it is nested too deeply") from None


def _object(kind: type, value: typing.Any, name: str) -> typing.Any:
    if not isinstance(value, dict):
        raise ValueError(f"{name} is not an object")
    hints = _hints(kind)
    missing = [each for each in hints if each not in value]
    if missing:
        raise ValueError(f"{name} lacks '{missing[0]}'")
    return kind(**{each: _value(hint, value[each], f"'{each}'") for each, hint in hints.items()})


def _value(hint: typing.Any, value: typing.Any, name: str) -> typing.Any:
    if dataclasses.is_dataclass(hint):
        return _object(typing.cast(type, hint), value, name)
    origin = typing.get_origin(hint)
    if origin is tuple:
        if not isinstance(value, list):
            raise ValueError(f"{name} is not a list")
        return tuple(_value(typing.get_args(hint)[0], each, name) for each in value)
    if origin is dict:
        if not isinstance(value, dict):
            raise ValueError(f"{name} is not an object")
        return {str(key): str(each) for key, each in value.items()}
    return _plain(hint, value, name)


# JSON has one kind of numbers, and flags may come as 0 and 1.
def _plain(kind: type, value: typing.Any, name: str) -> typing.Any:
    accepted = {str: (str,), float: (int, float), int: (int,), bool: (bool, int, float)}[kind]
    if not isinstance(value, accepted):
        raise ValueError(f"{name} is not of the type {kind.__name__}")
    return kind(value)


_known: dict[type, types.MappingProxyType[str, typing.Any]] = {}


def _hints(kind: type) -> typing.Mapping[str, typing.Any]:
    if kind not in _known:
        _known[kind] = types.MappingProxyType(typing.get_type_hints(kind))
    return _known[kind]
