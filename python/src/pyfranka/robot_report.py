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

__all__ = [
    "Buttons",
    "EndEffector",
    "Guiding",
    "Hand",
    "Inputs",
    "Light",
    "Report",
    "SelfTest",
    "report_of",
]

Numbers = tuple[float, ...]
Flags = tuple[bool, ...]


@dataclass(frozen=True)
class Inputs:
    """Safety inputs as they act; True: pressed. x31, x32, x33: stops; x4: the activation or enabling device;
    guiding: the enable button at the hand. The operator's stop presses x31 of an FR3 and x4 of a Panda."""

    x31: bool
    x32: bool
    x33: bool
    x4: bool
    guiding: bool


@dataclass(frozen=True)
class Buttons:
    """Buttons of the Pilot: circle, cross, check, and the arrows up, down, left, right. True: pressed."""

    circle: bool
    cross: bool
    check: bool
    up: bool
    down: bool
    left: bool
    right: bool


@dataclass(frozen=True)
class Guiding:
    """Hand guiding. active: the arm is guided. mode: free, translation, rotation or user. axes: x, y, z,
    rotations about them, elbow; True: free."""

    active: bool
    mode: str
    axes: Flags


@dataclass(frozen=True)
class SelfTest:
    """The self-test. running: it runs. left: time to its end [s]. due: time until the next one must have run
    [s]."""

    running: bool
    left: float
    due: float


@dataclass(frozen=True)
class Light:
    """The light of the robot's base: its color, and whether it is blinking."""

    color: str
    blinking: bool


@dataclass(frozen=True)
class Hand:
    """The end effector's drive. kind: gripper, vacuum or none. homed: homing has ended. width, max_width: of
    the gripper [m]. grasped: it holds an object. busy: a command runs."""

    kind: str
    homed: bool
    width: float
    max_width: float
    grasped: bool
    busy: bool


@dataclass(frozen=True)
class EndEffector:
    """The end effector that the robot assumes: mass [kg], center of mass in the flange's frame, 3 [m],
    inertia about it, 9 [kg m^2], and the pose F_T_NE of its tool, 16, column-major. power: without it the
    hand is not reachable."""

    mass: float
    center: Numbers
    inertia: Numbers
    F_T_NE: Numbers
    power: bool


@dataclass(frozen=True)
class Report:
    """A robot at one instant of its time.

    >>> remote.report().brakes_open
    True
    """

    time: float  #: of the world [s]
    type: str  #: panda or fr3
    arm_id: str  #: prefix of its joints and links
    protocol: tuple[int, ...]  #: oldest and newest version that it speaks
    client: int  #: version of the connected client; 0: none
    rules: str  #: desk or open
    mode: str  #: robot_mode, such as Idle
    errors: tuple[str, ...]  #: present errors, such as joint_reflex
    details: dict[str, str]  #: more about an error, by its name
    fault: str  #: why the whole world stands still; empty: it does not
    q: Numbers  #: joint positions [rad]
    dq: Numbers  #: joint velocities [rad/s]
    q_d: Numbers  #: desired joint positions [rad]
    tau_J: Numbers  #: measured torques [Nm]
    tau_ext: Numbers  #: tau_ext_hat_filtered [Nm]
    O_T_EE: Numbers  #: pose of the end effector, 16, column-major
    O_F_ext: Numbers  #: O_F_ext_hat_K [N, Nm]
    success_rate: float  #: control_command_success_rate
    power: bool  #: without it the robot is not reachable
    brakes: Flags  #: joint by joint; True: closed
    brakes_moving: bool  #: they open or close
    operating_mode: str  #: execution or programming
    fci: bool  #: clients may connect
    inputs: Inputs  #: safety inputs
    user_stop: tuple[str, ...]  #: what presses it: user_stop, x31, x32, x33, x4, conflicting_inputs
    buttons: Buttons  #: of the Pilot
    guiding: Guiding  #: hand guiding
    navigation: str  #: target of the Pilot's arrows: desk or robot
    self_test: SelfTest  #: that of the safety controller
    recoverable: tuple[str, ...]  #: errors of the safety controller that must be acknowledged
    joint_limit_violation: Flags  #: joint by joint; True: its recovery is demanded
    joint_position_error: Flags  #: the same
    light: Light  #: at the base
    hand: Hand  #: the end effector's drive
    end_effector: EndEffector  #: the one that the robot assumes
    motion: bool  #: a motion of Desk runs

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
