# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The configuration of the newer interface: end effector, network, users, mounting."""

from __future__ import annotations

import math
import typing
from collections.abc import Callable

from pyfranka.desk import checks
from pyfranka.desk.end_effectors import ANGLES, EndEffectors, Load, load_of_objects
from pyfranka.desk.errors import bad_request
from pyfranka.desk.sessions import User, Users, digest_of

Json = dict[str, typing.Any]
END_EFFECTORS = ("None", "FrankaHand", "CobotPump", "GenericCan", "Other")
ROLES = ("Admin", "SafetyOperator", "Operator")
END_EFFECTOR, NETWORK, USERS = "endEffectorConfiguration", "networkConfiguration", "userConfiguration"
MAX_USERS = 50  # (chosen here)


class Configuration:
    """Kept while the program runs. The part about the network is only stored: the command line sets the real
    address. close_sessions: ends all logins of the user of that name."""

    def __init__(
        self,
        address: str,
        users: Users,
        end_effectors: EndEffectors,
        close_sessions: Callable[[str], None],
    ):
        self._known_users, self._end_effectors, self._close_sessions = users, end_effectors, close_sessions
        self._end_effector: Json | None = None
        self._network: Json = {
            "robot": {"network": {"address": address, "netmask": "255.255.255.0"}},
            "shopFloor": {"type": "Dhcp", "address": "", "netmask": ""},
        }
        self.mounting: Json = {"orientation": dict.fromkeys(ANGLES, 0.0)}

    def get(self) -> Json:
        """All of it; passwords are never shown."""
        users = [{"name": user.name, "role": user.role} for user in self._known_users]
        return {
            END_EFFECTOR: {"endEffector": self._end_effector or self._present_end_effector()},
            NETWORK: self._network,
            USERS: {"users": users},
        }

    async def patch(self, value: Json) -> None:
        """Replaces the parts that are given, all of them or none."""
        checks.known(value, (END_EFFECTOR, NETWORK, USERS), "The configuration")
        effector = _end_effector(value[END_EFFECTOR]) if END_EFFECTOR in value else None
        network = _network(value[NETWORK], self._network) if NETWORK in value else None
        users = self._users(value[USERS]) if USERS in value else None
        if effector is not None:
            await self._end_effectors.set_load(effector[1])
            self._end_effector = effector[0]
        if network is not None:
            self._network = network
        if users is not None:
            self._set_users(users)

    def set_mounting(self, value: Json) -> None:
        """The base's orientation; the simulated world's gravity stays."""
        angles = checks.members(value.get("orientation"), ANGLES, "orientation", 2 * math.pi)
        self.mounting = {"orientation": dict(zip(ANGLES, angles))}

    def _present_end_effector(self) -> Json:
        active = self._end_effectors.active()
        inertial, name = active["inertial"], "Other"
        if inertial["mass"] == 0.0:
            name = "None"
        elif active["deviceId"] == "ee-gripper":
            name = "FrankaHand"
        return {"name": name, "params": {**inertial, "transformation": active["tcp"]}}

    # A password that is not given stays.
    def _users(self, value: typing.Any) -> list[User]:
        entries = value.get("users") if isinstance(value, dict) else None
        if not isinstance(entries, list) or not 0 < len(entries) <= MAX_USERS:
            raise bad_request(f"The field users must be a list of 1 to {MAX_USERS} users.")
        users = [self._user(entry) for entry in entries]
        if len({user.name for user in users}) < len(users):
            raise bad_request("Two users have the same name.")
        if not any(user.role == "Admin" for user in users):
            raise bad_request("One user at least must have the role Admin.")
        return users

    def _user(self, entry: typing.Any) -> User:
        if not isinstance(entry, dict):
            raise bad_request("A user must be an object with name, password and role.")
        name = checks.text(entry.get("name"), "name")
        if ":" in name or not name.isprintable():
            raise bad_request("A user's name must have printable characters without a colon.")
        role = entry.get("role")
        if role not in ROLES:
            raise bad_request(f"The field role must be one of {', '.join(ROLES)}.")
        known = self._known_users.get(name)
        if known is not None and entry.get("password") is None:
            return User(name, known.digest, role)
        return User(name, digest_of(name, checks.text(entry.get("password"), "password")), role)

    def _set_users(self, users: list[User]) -> None:
        digests = {user.name: user.digest for user in users}
        for user in self._known_users:
            if digests.get(user.name) != user.digest:
                self._close_sessions(user.name)
        self._known_users.replace(users)


def _end_effector(value: typing.Any) -> tuple[Json, Load]:
    entry = value.get("endEffector") if isinstance(value, dict) else None
    if not isinstance(entry, dict) or entry.get("name") not in END_EFFECTORS:
        raise bad_request(f"The field endEffector needs a name: {', '.join(END_EFFECTORS)}.")
    params = entry.get("params")
    if entry["name"] == "None" and params is None:
        return {"name": "None", "params": None}, Load()
    if not isinstance(params, dict):
        raise bad_request("The field endEffector needs params: mass, centerOfMass, inertia, transformation.")
    return {"name": entry["name"], "params": params}, load_of_objects(params, params.get("transformation"))


def _network(value: typing.Any, present: Json) -> Json:
    if not isinstance(value, dict):
        raise bad_request("The field networkConfiguration must be an object.")
    checks.known(value, present, "networkConfiguration")
    for part in value.values():
        if not isinstance(part, dict):
            raise bad_request("The parts of networkConfiguration must be objects.")
    network = {**present, **value}
    if network["shopFloor"].get("type") not in ("Static", "Dhcp"):
        raise bad_request("The field shopFloor.type must be Static or Dhcp.")
    return network
