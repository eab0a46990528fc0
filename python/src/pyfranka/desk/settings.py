# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Settings of Desk: users, options where sources disagree, and limits."""

from __future__ import annotations

import dataclasses
import math
import typing
from dataclasses import dataclass, field

USER = "franka"


@dataclass(frozen=True)
class Options:
    """Options for details in which robots or their descriptions differ (docs/desk.md). On the command line
    the names have hyphens: --option release-status=204."""

    release_status: int = 200  #: of DELETE control-token: 200 or 204
    no_acknowledge_status: int = 424  #: of an acknowledgment without a matching error: 424 or 404
    token_id: bool = True  #: v1 answers have tokenId (5.3.1 had none)
    recovery_type_on_top: bool = False  #: GET /api/safety/recovery also has the type at its top level
    time_to_td2_in_system: bool = False  #: GET /api/system has safety.timeToTd2
    fci_before_unlock: bool = False  #: the FCI may be activated with closed brakes and follows their opening
    fci_after_release: bool = False  #: releasing control leaves the FCI on
    fci_after_stop: bool = False  #: the FCI comes back with the brakes after an FR3's stop
    power_without_login: bool = False  #: reboot and shutdown need no login
    force_timeout: float = 30.0  #: [s] to confirm a forced take-over of control
    boot_time: float = 0.0  #: [s] that a reboot takes; 0: 40 s (FR3) or 100 s (Panda)
    version: str = ""  #: of the robot's software; empty: the profile's
    serial_number: str = "295341-1325480"  #: of the control unit

    @classmethod
    def of(cls, words: typing.Iterable[str]) -> Options:
        """Options from words NAME=VALUE. Raises ValueError with a sentence."""
        kinds = typing.get_type_hints(cls)
        values: dict[str, typing.Any] = {}
        for word in words:
            name, equals, value = word.partition("=")
            key = name.strip().replace("-", "_")
            if not equals or key not in kinds:
                names = ", ".join(each.name.replace("_", "-") for each in dataclasses.fields(cls))
                raise ValueError(f"'{word}' is not an option NAME=VALUE of Desk. Names: {names}.")
            values[key] = _value(kinds[key], name, value.strip())
        options = cls(**values)
        options.check()
        return options

    def check(self) -> None:
        """Raises ValueError with a sentence for invalid values."""
        if self.release_status not in (200, 204):
            raise ValueError(f"release-status must be 200 or 204, not {self.release_status}.")
        if self.no_acknowledge_status not in (404, 424):
            raise ValueError(f"no-acknowledge-status must be 404 or 424, not {self.no_acknowledge_status}.")
        if not 0.0 < self.force_timeout <= 3600.0:
            raise ValueError(f"force-timeout must be a time up to 3600 s, not {self.force_timeout:g}.")
        if not 0.0 <= self.boot_time <= 3600.0:
            raise ValueError(f"boot-time must be a time up to 3600 s, not {self.boot_time:g}.")


@dataclass(frozen=True)
class Limits:
    """Limits for one program (chosen here; docs/desk.md)."""

    body: int = 1 << 16  #: [bytes] of a request
    body_time: float = 10.0  #: [s] for a whole body
    request_time: float = 10.0  #: [s] for the first request of a connection
    rate: float = 500.0  #: requests a second of one address (IPv6: of 64 bits); more of them wait
    waiting: int = 200  #: requests of one address that wait; more are refused
    wrong_logins: int = 20  #: of one address at once; further logins wait for one second each
    wrong_logins_of_user: int = 20  #: the same for one user name
    wrong_logins_of_all: int = 100  #: the same of all addresses
    connections: int = 256  #: connections of all addresses
    connections_of_address: int = 128  #: the same of one address
    sockets: int = 96  #: WebSockets and event streams of users
    sockets_of_address: int = 48  #: the same of one address
    sockets_without_login: int = 32  #: WebSockets and event streams without a login, in addition
    sockets_without_login_of_address: int = 16  #: the same of one address
    sessions: int = 1000  #: logins; the oldest one ends


@dataclass(frozen=True)
class Settings:
    """user, password: the first user; without a password there is no Desk. profile: empty: by the robot.
    options, limits: see these classes."""

    password: str
    user: str = USER
    profile: str = ""
    options: Options = field(default_factory=Options)
    limits: Limits = field(default_factory=Limits)

    def __post_init__(self) -> None:
        if not self.password:
            raise ValueError("Desk needs a password.")
        if not self.user or len(self.user) > 100 or not self.user.isprintable() or ":" in self.user:
            raise ValueError("A user's name must have 1 to 100 printable characters without a colon.")
        self.options.check()


def _value(kind: type, name: str, word: str) -> bool | str | int | float:
    if kind is bool:
        switches = {"on": True, "true": True, "yes": True, "1": True}
        switches |= {"off": False, "false": False, "no": False, "0": False}
        if word.lower() not in switches:
            raise ValueError(f"{name} must be on or off, not '{word}'.")
        return switches[word.lower()]
    if kind is str:
        return word
    try:
        number: int | float = kind(word)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise ValueError(f"{name} must be a number, not '{word}'.")
    return number
