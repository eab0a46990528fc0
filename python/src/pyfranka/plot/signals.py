# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Signals to plot: fields of the state, commands, values computed from them, and the limits of each."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

import pyfranka
from pyfranka.plot.recording import FIELDS, TICK, Array, Recording

JOINTS = tuple(f"joint {i}" for i in range(1, 8))
AXES = ("x", "y", "z")
TWIST = ("x", "y", "z", "about x", "about y", "about z")
WRENCH = ("F x", "F y", "F z", "M x", "M y", "M z")
MOTION = ("translation", "rotation")

Range = tuple[Array, Array]  # lower and upper limits, (size,) or (rows, size)
Limits = Callable[[Recording, pyfranka.ArmLimits], Range]


@dataclass(frozen=True)
class Signal:
    """One quantity, and how it follows from a recording."""

    text: str
    unit: str
    parts: tuple[str, ...]
    value: Callable[[Recording], Array | None]  # None: the recording does not have it
    limits: Limits | None = None
    is_position: bool = False  # limits are a range of positions, not bounds of a derivative


def _field(name: str) -> Callable[[Recording], Array | None]:
    return lambda recording: recording.values.get(name)


def _all_nan(values: Array) -> bool:
    return bool(np.all(np.isnan(values)))


def _command(recording: Recording, name: str) -> Array | None:
    values = recording.values.get(name)
    return None if values is None or _all_nan(values) else values


def _before(recording: Recording, name: str) -> Array | None:
    """The rows before, NaN for the first one: what a robot had accepted last."""
    values = recording.values.get(name)
    return None if values is None else _shifted(values)


def _shifted(values: Array) -> Array:
    shifted = np.full_like(values, np.nan)
    shifted[1:] = values[:-1]
    return shifted


def _rate(recording: Recording, values: Array | None) -> Array | None:
    """Backward differences, by the robot's clock."""
    if values is None or len(values) < 2:
        return None
    rate = np.full_like(values, np.nan)
    period = np.diff(recording.time)
    period[period <= 0] = np.nan
    rate[1:] = np.diff(values, axis=0) / period[:, None]
    return rate


# ---- commands: backward Euler from the state that they answer, as the robot computes -------------------


def _commanded_velocity(recording: Recording) -> Array | None:
    q, q_d = _command(recording, "cmd.q_d"), recording.values.get("q_d")
    if q is not None and q_d is not None:
        return (q - q_d) / TICK
    return _command(recording, "cmd.dq_d")


def _commanded_acceleration(recording: Recording) -> Array | None:
    velocity, dq_d = _commanded_velocity(recording), recording.values.get("dq_d")
    return None if velocity is None or dq_d is None else (velocity - dq_d) / TICK


def _desired_acceleration(recording: Recording) -> Array | None:
    """Of the state, or from its velocities, which is what the robot computes too."""
    values = recording.values.get("ddq_d")
    return values if values is not None else _rate(recording, recording.values.get("dq_d"))


def _commanded_jerk(recording: Recording) -> Array | None:
    acceleration, before = _commanded_acceleration(recording), _desired_acceleration(recording)
    return None if acceleration is None or before is None else (acceleration - before) / TICK


def _commanded_torque_rate(recording: Recording) -> Array | None:
    torque = _command(recording, "cmd.tau_J_d")
    before = recording.values.get("tau_J_d")
    if torque is None:
        return None
    return (torque - (before if before is not None else _shifted(torque))) / TICK


def _twist(recording: Recording) -> Array | None:
    pose = _command(recording, "cmd.O_T_EE_d")
    if pose is None:
        return _command(recording, "cmd.O_dP_EE_d")
    before = recording.values.get("O_T_EE_c")
    if before is None:
        before = _shifted(pose)
    twist = np.full((len(pose), 6), np.nan)
    known = ~(np.isnan(pose).any(axis=1) | np.isnan(before).any(axis=1))
    if known.any():
        to, origin = _matrices(pose[known]), _matrices(before[known])
        turn = Rotation.from_matrix(to[:, :3, :3]) * Rotation.from_matrix(origin[:, :3, :3]).inv()
        twist[known, :3] = (to[:, :3, 3] - origin[:, :3, 3]) / TICK
        twist[known, 3:] = turn.as_rotvec() / TICK
    return twist


def _twist_rate(recording: Recording, twist: Array | None, name: str) -> Array | None:
    if twist is None:
        return None
    before = recording.values.get(name)
    rate: Array = (twist - (before if before is not None else _shifted(twist))) / TICK
    return rate


def _twist_acceleration(recording: Recording) -> Array | None:
    return _twist_rate(recording, _twist(recording), "O_dP_EE_c")


def _twist_jerk(recording: Recording) -> Array | None:
    return _twist_rate(recording, _twist_acceleration(recording), "O_ddP_EE_c")


def _norms(twist: Array | None) -> Array | None:
    if twist is None:
        return None
    parts = (twist[:, :3], twist[:, 3:])
    norms: Array = np.stack([np.linalg.norm(part, axis=1) for part in parts], axis=1)
    return norms


# ---- poses ---------------------------------------------------------------------------------------------


def _matrices(rows: Array) -> Array:
    return rows.reshape(-1, 4, 4).transpose(0, 2, 1)


def _position(name: str) -> Callable[[Recording], Array | None]:
    def value(recording: Recording) -> Array | None:
        rows = _command(recording, name)
        return None if rows is None else rows[:, 12:15]

    return value


def _angles(name: str) -> Callable[[Recording], Array | None]:
    """Roll, pitch and yaw, without jumps by a whole turn."""

    def value(recording: Recording) -> Array | None:
        rows = _command(recording, name)
        if rows is None:
            return None
        angles = np.full((len(rows), 3), np.nan)
        known = ~np.isnan(rows).any(axis=1)
        turns = Rotation.from_matrix(_matrices(rows[known])[:, :3, :3])
        angles[known] = np.unwrap(turns.as_euler("xyz"), axis=0)
        return angles

    return value


# ---- limits --------------------------------------------------------------------------------------------


def _positions(_: Recording, limits: pyfranka.ArmLimits) -> Range:
    return limits.q_min, limits.q_max


def _bounds(name: str) -> Limits:
    return lambda _, limits: (-getattr(limits, name), getattr(limits, name))


def _velocities(recording: Recording, limits: pyfranka.ArmLimits) -> Range:
    """Of an FR3 they follow the position."""
    q = recording.values.get("q_d")
    if q is None:
        return -limits.dq, limits.dq
    return limits.velocity_range(q)


def _motion(order: int) -> Limits:
    def bounds(_: Recording, limits: pyfranka.ArmLimits) -> Range:
        upper = np.array([limits.translation[order], limits.rotation[order]])
        return -upper, upper

    return bounds


def _state(
    text: str,
    unit: str,
    name: str,
    limits: Limits | None = None,
    parts: tuple[str, ...] = JOINTS,
    is_position: bool = False,
) -> Signal:
    return Signal(text, unit, parts, _field(name), limits, is_position)


# The signals that can be plotted, by their names.
SIGNALS: dict[str, Signal] = {
    "q": _state("measured joint positions", "rad", "q", _positions, is_position=True),
    "q_d": _state("desired joint positions", "rad", "q_d", _positions, is_position=True),
    "dq": _state("measured joint velocities", "rad/s", "dq", _bounds("dq")),
    "dq_d": _state("desired joint velocities", "rad/s", "dq_d", _velocities),
    "ddq_d": Signal("desired joint accelerations", "rad/s²", JOINTS, _desired_acceleration, _bounds("ddq")),
    "dddq_d": Signal(
        "desired joint jerks",
        "rad/s³",
        JOINTS,
        lambda recording: _rate(recording, _desired_acceleration(recording)),
        _bounds("dddq"),
    ),
    "theta": _state("motor positions", "rad", "theta"),
    "dtheta": _state("motor velocities", "rad/s", "dtheta"),
    "tau_J": _state("measured torques, gravity included", "Nm", "tau_J", _bounds("tau")),
    "tau_J_d": _state("desired torques, without gravity", "Nm", "tau_J_d", _bounds("tau")),
    "dtau_J": _state("derivatives of the measured torques", "Nm/s", "dtau_J"),
    "tau_ext_hat_filtered": _state("estimated external torques", "Nm", "tau_ext_hat_filtered"),
    "tracking": Signal(
        "desired minus measured joint positions",
        "rad",
        JOINTS,
        lambda recording: (
            recording.values["q_d"] - recording.values["q"] if {"q", "q_d"} <= {*recording.values} else None
        ),
    ),
    "O_T_EE": Signal("position of the end effector", "m", AXES, _position("O_T_EE")),
    "O_T_EE_d": Signal("desired position of the end effector", "m", AXES, _position("O_T_EE_d")),
    "O_T_EE_c": Signal("last commanded position of the end effector", "m", AXES, _position("O_T_EE_c")),
    "rpy": Signal("roll, pitch and yaw of the end effector", "rad", ("R", "P", "Y"), _angles("O_T_EE")),
    "rpy_d": Signal("the desired ones", "rad", ("R", "P", "Y"), _angles("O_T_EE_d")),
    "O_dP_EE_d": _state("desired twist of the end effector", "m/s, rad/s", "O_dP_EE_d", parts=TWIST),
    "O_dP_EE_c": _state("last commanded twist", "m/s, rad/s", "O_dP_EE_c", parts=TWIST),
    "O_F_ext_hat_K": _state("estimated external wrench at K, in O", "N, Nm", "O_F_ext_hat_K", parts=WRENCH),
    "K_F_ext_hat_K": _state("the same in K", "N, Nm", "K_F_ext_hat_K", parts=WRENCH),
    "elbow": _state("joint 3 and the sign of joint 4", "rad", "elbow", parts=("joint 3", "sign")),
    "joint_contact": _state("contacts of joints", "0 or 1", "joint_contact"),
    "joint_collision": _state("collisions of joints", "0 or 1", "joint_collision"),
    "cartesian_contact": _state("contacts along axes", "0 or 1", "cartesian_contact", parts=WRENCH),
    "cartesian_collision": _state("collisions along axes", "0 or 1", "cartesian_collision", parts=WRENCH),
    "success_rate": _state(
        "share of the last 100 commands that arrived",
        "0 to 1",
        "control_command_success_rate",
        parts=("success rate",),
    ),
    "cmd.q_d": Signal(
        "commanded joint positions",
        "rad",
        JOINTS,
        lambda recording: _command(recording, "cmd.q_d"),
        _positions,
        is_position=True,
    ),
    "cmd.dq_d": Signal("commanded joint velocities", "rad/s", JOINTS, _commanded_velocity, _velocities),
    "cmd.ddq_d": Signal(
        "commanded joint accelerations", "rad/s²", JOINTS, _commanded_acceleration, _bounds("ddq")
    ),
    "cmd.dddq_d": Signal("commanded joint jerks", "rad/s³", JOINTS, _commanded_jerk, _bounds("dddq")),
    "cmd.tau_J_d": Signal(
        "commanded torques",
        "Nm",
        JOINTS,
        lambda recording: _command(recording, "cmd.tau_J_d"),
        _bounds("tau"),
    ),
    "cmd.dtau_J_d": Signal(
        "changes of the commanded torques", "Nm/s", JOINTS, _commanded_torque_rate, _bounds("dtau")
    ),
    "cmd.O_T_EE_d": Signal("commanded position of the end effector", "m", AXES, _position("cmd.O_T_EE_d")),
    "cmd.speed": Signal(
        "commanded speed of the end effector", "m/s, rad/s", MOTION, lambda r: _norms(_twist(r)), _motion(0)
    ),
    "cmd.acceleration": Signal(
        "its commanded acceleration",
        "m/s², rad/s²",
        MOTION,
        lambda r: _norms(_twist_acceleration(r)),
        _motion(1),
    ),
    "cmd.jerk": Signal(
        "its commanded jerk", "m/s³, rad/s³", MOTION, lambda r: _norms(_twist_jerk(r)), _motion(2)
    ),
}

# Fields that must be recorded for a signal, if they are not of its name.
_NEEDS = {
    "ddq_d": ("dq_d", "ddq_d"),
    "dddq_d": ("dq_d", "ddq_d"),
    "dq_d": ("dq_d", "q_d"),
    "tracking": ("q", "q_d"),
    "rpy": ("O_T_EE",),
    "rpy_d": ("O_T_EE_d",),
    "success_rate": ("control_command_success_rate",),
}


def fields_of(signals: Iterable[str]) -> tuple[str, ...]:
    """Fields of the state that these signals need."""
    needed: dict[str, None] = {}
    for name in signals:
        needed.update(dict.fromkeys(_NEEDS.get(name, (name,) if name in FIELDS else ())))
    return tuple(needed)


def is_command(name: str) -> bool:
    """Whether only motion logs have it."""
    return name.startswith("cmd.")


# Signals in which an error shows: the first ones that the recording has are drawn, the worst value is marked.
EVIDENCE = {
    "joint_position_limits_violation": ("q", "cmd.q_d"),
    "joint_velocity_violation": ("dq",),
    "joint_reflex": ("tau_ext_hat_filtered",),
    "cartesian_reflex": ("O_F_ext_hat_K", "tau_ext_hat_filtered"),
    "max_goal_pose_deviation_violation": ("tracking",),
    "max_path_pose_deviation_violation": ("tracking",),
    "joint_position_motion_generator_start_pose_invalid": ("cmd.dq_d",),
    "joint_motion_generator_position_limits_violation": ("cmd.q_d",),
    "joint_motion_generator_velocity_limits_violation": ("cmd.dq_d",),
    "joint_motion_generator_velocity_discontinuity": ("cmd.ddq_d",),
    "joint_motion_generator_acceleration_discontinuity": ("cmd.dddq_d",),
    "cartesian_position_motion_generator_start_pose_invalid": ("cmd.speed",),
    "cartesian_motion_generator_velocity_limits_violation": ("cmd.speed",),
    "cartesian_motion_generator_velocity_discontinuity": ("cmd.acceleration",),
    "cartesian_motion_generator_acceleration_discontinuity": ("cmd.jerk",),
    "cartesian_motion_generator_joint_position_limits_violation": ("q_d",),
    "cartesian_motion_generator_joint_velocity_limits_violation": ("dq_d",),
    "cartesian_motion_generator_joint_velocity_discontinuity": ("ddq_d",),
    "cartesian_motion_generator_joint_acceleration_discontinuity": ("dddq_d",),
    "controller_torque_discontinuity": ("cmd.dtau_J_d",),
    "communication_constraints_violation": ("success_rate",),
    "tau_J_range_violation": ("tau_J",),
}


@dataclass(frozen=True)
class Excess:
    """The value of a signal that is farthest beyond its limit, or nearest to it."""

    part: int
    row: int
    value: float
    limit: float
    beyond: bool


def worst(name: str, recording: Recording) -> Excess | None:
    """None if the recording has no such values, or its robot's limits are not known."""
    signal, limits = SIGNALS[name], recording.limits
    values = signal.value(recording)
    if values is None or limits is None or signal.limits is None or _all_nan(values):
        return None
    lower, upper = (np.broadcast_to(bound, values.shape) for bound in signal.limits(recording, limits))
    nearest = np.where(values - lower < upper - values, lower, upper)
    if signal.is_position:
        excess = np.maximum(lower - values, values - upper)
    else:
        # A limit of 0: at the end of its range an FR3's joint may not move further at all.
        nearest = np.where(values < 0, lower, upper)
        with np.errstate(divide="ignore", invalid="ignore"):
            excess = np.abs(values) / np.abs(nearest)
        excess[(values == 0) & (nearest == 0)] = 0.0
    row, part = np.unravel_index(np.nanargmax(excess), excess.shape)
    limit, value = float(nearest[row, part]), float(values[row, part])
    return Excess(
        int(part), int(row), value, limit, bool(excess[row, part] > (0.0 if signal.is_position else 1.0))
    )
