# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""End effectors: profiles of the FR3, settings of the Panda."""

from __future__ import annotations

import math
import typing
from dataclasses import dataclass, field

from pyfranka.desk import checks
from pyfranka.desk.errors import DeskError, bad_request
from pyfranka.desk.robot import DeskRobot
from pyfranka.robot_report import EndEffector

Json = dict[str, typing.Any]
NONE, HAND = "ee-no-profile", "ee-franka-hand"  # built in
GENERIC, GRIPPER, PUMP = "ee-no-gripper", "ee-gripper", "ee-cobot-pump"  # kinds of devices
INERTIA = ("x11", "x12", "x13", "x22", "x23", "x33")
PLACES = (0, 1, 2, 1, 3, 4, 2, 4, 5)  # of these in a matrix of nine
XYZ, ANGLES = ("x", "y", "z"), ("roll", "pitch", "yaw")
IDENTITY = (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0)
# Limits of a profile: mass [kg], lengths [m], inertia [kg m^2].
MAX_MASS, MAX_DISTANCE, MAX_INERTIA = 3.0, 0.3, 1.0
MAX_PROFILES = 100  # profiles (chosen here)
NOTHING: Json = {
    "inertial": {
        "mass": 0.0,
        "centerOfMass": dict.fromkeys(XYZ, 0.0),
        "inertia": dict.fromkeys(INERTIA, 0.0),
    },
    "tcp": {"translation": dict.fromkeys(XYZ, 0.0), "rotation": dict.fromkeys(ANGLES, 0.0)},
}


@dataclass(frozen=True)
class Load:
    """Mass [kg], center of mass [m] and inertia [kg m^2] (9 numbers) at the flange; pose of the tool (16
    numbers)."""

    mass: float = 0.0
    center: typing.Sequence[float] = (0.0, 0.0, 0.0)
    inertia: typing.Sequence[float] = (0.0,) * 9
    transformation: typing.Sequence[float] = IDENTITY

    def line(self) -> str:
        """For the control interface."""
        values = [self.mass, *self.center, *self.inertia, *self.transformation]
        return "end_effector " + " ".join(map(repr, values))


@dataclass
class Profile:
    """One entry of the list. shape: its members `inertial` and `tcp`."""

    id: str
    name: str
    device: str
    shape: Json
    load: Load
    model: str | None = None
    built_in: bool = False


@dataclass
class EndEffectors:
    """Profiles of one robot; exactly one of them is active. selection: the device of a Panda."""

    robot: DeskRobot
    selection: str = GRIPPER
    _profiles: dict[str, Profile] = field(default_factory=dict)
    _active: str = ""
    _next: int = 1

    def list(self) -> list[Json]:
        """All profiles."""
        return [self._json(profile) for profile in self._known().values()]

    def active(self) -> Json:
        """The active one."""
        return self._json(self._known()[self._active])

    def add(self, value: Json) -> str:
        """A new profile. Returns its id."""
        if len(self._known()) >= MAX_PROFILES:
            raise DeskError(
                409, "Conflict", f"There are {MAX_PROFILES} profiles already. Delete one of them."
            )
        profile = _profile(f"ee-profile-{self._next}", value)
        self._next += 1
        self._profiles[profile.id] = profile
        return profile.id

    async def change(self, id: str, value: Json) -> None:
        """Replaces one; if it is active, its values are set in the robot at once."""
        self._editable(id)
        profile = _profile(id, value)
        if id == self._active:
            await self.robot.send(profile.load.line())
        self._profiles[id] = profile

    def delete(self, id: str) -> None:
        """Removes one that is not active."""
        self._editable(id)
        if id == self._active:
            raise DeskError(409, "Conflict", f"The profile '{id}' is active. Activate another one first.")
        del self._profiles[id]

    def is_active(self, id: str) -> bool:
        """Whether it is the active one."""
        self._find(id)
        return id == self._active

    async def activate(self, id: str) -> None:
        """Sets its values in the robot."""
        profile = self._find(id)
        await self.robot.send(profile.load.line())
        self._active = id

    async def set_load(self, load: Load) -> None:
        """Sets values in the robot that belong to no profile."""
        await self.robot.send(load.line())

    def _find(self, id: str) -> Profile:
        profile = self._known().get(id)
        if profile is None:
            raise DeskError(404, "NotFound", f"There is no end-effector profile '{id[:50]}'.")
        return profile

    def _editable(self, id: str) -> None:
        if self._find(id).built_in:
            raise DeskError(409, "Conflict", f"The profile '{id}' is built in.")

    # The robot starts with its hand, or with nothing.
    def _known(self) -> dict[str, Profile]:
        if not self._profiles:
            self._add_built_in(self.robot.current_report().end_effector)
        return self._profiles

    def _add_built_in(self, now: EndEffector) -> None:
        nothing = Profile(NONE, "None", GENERIC, NOTHING, Load(), None, True)
        self._profiles[NONE] = nothing
        self._active = NONE
        if now.mass > 0.0:
            load = Load(now.mass, now.center, now.inertia, now.F_T_NE)
            self._profiles[HAND] = Profile(HAND, "Franka Hand", GRIPPER, _shape(load), load, None, True)
            self._active = HAND

    def _json(self, profile: Profile) -> Json:
        return {
            "id": profile.id,
            "name": profile.name,
            "deviceId": profile.device,
            "active": profile.id == self._active,
            "modelUri": profile.model,
            **profile.shape,
        }


def load_of_lists(value: Json) -> Load:
    """From a Panda's settings: lists."""
    load = Load(
        checks.number(value.get("mass"), "mass", MAX_MASS),
        checks.numbers(value.get("centerOfMass"), 3, "centerOfMass", MAX_DISTANCE),
        checks.numbers(value.get("inertia"), 9, "inertia", MAX_INERTIA),
        checks.numbers(value.get("transformation"), 16, "transformation"),
    )
    _check(load)
    return load


def load_of_objects(inertial: typing.Any, tcp: typing.Any) -> Load:
    """From objects with named members."""
    if not isinstance(inertial, dict) or not isinstance(tcp, dict):
        raise bad_request("An end effector needs the objects for its mass and for its tool.")
    inertia = checks.members(inertial.get("inertia"), INERTIA, "inertia", MAX_INERTIA)
    translation = checks.members(tcp.get("translation"), XYZ, "translation", MAX_DISTANCE)
    rotation = checks.members(tcp.get("rotation"), ANGLES, "rotation", math.pi + 1e-6)
    load = Load(
        checks.number(inertial.get("mass"), "mass", MAX_MASS),
        checks.members(inertial.get("centerOfMass"), XYZ, "centerOfMass", MAX_DISTANCE),
        [inertia[place] for place in PLACES],
        pose_of(translation, rotation),
    )
    _check(load)
    return load


def pose_of(translation: typing.Sequence[float], rotation: typing.Sequence[float]) -> list[float]:
    """A pose, 16, column-major, from roll, pitch and yaw about fixed axes [rad]."""
    (a, b, c), (sa, sb, sc) = map(math.cos, rotation), map(math.sin, rotation)
    x_axis = [b * c, b * sc, -sb, 0.0]
    y_axis = [sa * sb * c - a * sc, sa * sb * sc + a * c, sa * b, 0.0]
    z_axis = [a * sb * c + sa * sc, a * sb * sc - sa * c, a * b, 0.0]
    return [*x_axis, *y_axis, *z_axis, *translation, 1.0]


def angles_of(pose: typing.Sequence[float]) -> list[float]:
    """Roll, pitch and yaw of a pose."""
    pitch = math.atan2(-pose[2], math.hypot(pose[0], pose[1]))
    if math.hypot(pose[0], pose[1]) < 1e-9:
        return [math.atan2(-pose[9], pose[5]), pitch, 0.0]
    return [math.atan2(pose[6], pose[10]), pitch, math.atan2(pose[1], pose[0])]


def _profile(id: str, value: Json) -> Profile:
    name = checks.text(value.get("name"), "name")
    device = value.get("deviceId", GENERIC)
    if device not in (GENERIC, GRIPPER):
        raise bad_request(f"The field deviceId must be {GENERIC} or {GRIPPER}.")
    model = value.get("modelUri")
    if model is not None and model != "":
        model = checks.text(model, "modelUri")
    load = load_of_objects(value.get("inertial"), value.get("tcp"))
    return Profile(id, name, device, _shape(load), load, model)


def _shape(load: Load) -> Json:
    return {
        "inertial": {
            "mass": load.mass,
            "centerOfMass": dict(zip(XYZ, load.center)),
            "inertia": {name: load.inertia[PLACES.index(place)] for place, name in enumerate(INERTIA)},
        },
        "tcp": {
            "translation": dict(zip(XYZ, load.transformation[12:15])),
            "rotation": dict(zip(ANGLES, angles_of(load.transformation))),
        },
    }


def _check(load: Load) -> None:
    if load.mass < 0.0:
        raise bad_request("The mass must not be negative.")
    if load.mass > 0.0 and not _is_positive_definite(load.inertia):
        raise bad_request("The inertia must be positive definite if there is a mass.")


# By its leading minors.
def _is_positive_definite(m: typing.Sequence[float]) -> bool:
    second = m[0] * m[4] - m[1] * m[3]
    third = m[6] * (m[1] * m[5] - m[2] * m[4]) - m[7] * (m[0] * m[5] - m[2] * m[3]) + m[8] * second
    return m[0] > 0.0 and second > 0.0 and third > 0.0
