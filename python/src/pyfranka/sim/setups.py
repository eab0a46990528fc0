# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Robots as they are described before they are simulated, in process or on the network."""

from __future__ import annotations

import os
import re
import typing
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy
from numpy.typing import ArrayLike

from pyfranka._native import _sim

from .arguments import inertia, items, no_robot, numbers, path, text, whole

MAX_POSITION = 100.0  # [m] of a base along an axis (chosen here: a hall)
MAX_TURN = 2.0 * numpy.pi  # [rad]
NOT_IN_NAMES = re.compile(r"[\s\"'<>&/:]")  # of XML, and of names in names


@dataclass(frozen=True)
class _Setup:
    """A robot to simulate, in this process (Simulation) or on the network (FrankaSim).

    name: prefix of its joints and links (its kind). base: x, y, z [m], each at most 100 m from the origin,
    and, optionally, the turn about the vertical [rad], at most a whole one. hand: True (or "gripper"): the
    Franka Hand; False (or "none"): an arm without one, whose urdf may have one that is not driven; "vacuum":
    the vacuum gripper, on the network only. load: mass [kg], center of mass in the flange's frame [m] and,
    optionally, inertia 3x3 [kg m^2], as entered in Desk; it is not simulated. realism: a profile of
    docs/sim_to_real.md, such as "real,friction=off"; empty: "ideal" in this process, where programs learn,
    tune and test against exact physics, and "real" on the network, where programs for a real robot must meet
    its friction and delays. urdf: another description of this kind of robot.

    On the network only: protocol: the only version that it speaks; 0: all of its kind. address: where it is
    served; empty: an address of its own. arguments: further options of the program franka_sim.

    All values are checked here. Raises ValueError, TypeError or FileNotFoundError with a sentence.

    >>> robots = [pyfranka.sim.Panda(base=(0, 0.5, 0)), pyfranka.sim.FR3(base=(0, -0.5, 0))]
    >>> [robot.kind for robot in robots]
    ['panda', 'fr3']
    """

    name: str = ""
    base: Sequence[float] = (0.0, 0.0, 0.0)
    hand: bool | str = True
    load: Sequence[ArrayLike] | None = None
    realism: str = ""
    urdf: str | os.PathLike[str] = ""
    protocol: int = field(default=0, kw_only=True)
    address: str = field(default="", kw_only=True)
    arguments: Sequence[str] = field(default=(), kw_only=True)

    kind: typing.ClassVar[str] = ""
    _protocols: typing.ClassVar[range] = range(0)

    def __post_init__(self) -> None:
        if NOT_IN_NAMES.search(text(self.name, "name")):
            raise ValueError(f"name is the prefix of joints and links; it cannot be {self.name!r}.")
        base = numbers(self.base, "base (x, y, z [m] and, optionally, the turn [rad])", 3, 4)
        self._set("base", _base(tuple(map(float, base))))
        self._set("hand", _hand(self.hand))
        self._set("load", _load(self.load))
        _sim.check_realism(text(self.realism, "realism"))
        self._set("urdf", path(self.urdf, "urdf"))
        if self.urdf and not os.path.isfile(self.urdf):
            raise FileNotFoundError(f"urdf: there is no file '{self.urdf}'.")
        if whole(self.protocol, "protocol") and self.protocol not in self._protocols:
            known = f"{self._protocols[0]} to {self._protocols[-1]}"
            raise ValueError(f"protocol of a {self.kind} must be {known}, or 0 for all, not {self.protocol}.")
        text(self.address, "address")
        self._set("arguments", tuple(map(str, items(self.arguments, "arguments", "options"))))

    def _set(self, name: str, value: typing.Any) -> None:
        object.__setattr__(self, name, value)  # it is frozen for its users

    def _require_in_process(self) -> None:
        """Raises ValueError for what only robots on the network have."""
        for name in ("protocol", "address", "arguments"):
            if getattr(self, name):
                raise ValueError(f"{name} of {self.kind} is for robots on the network: use FrankaSim.")
        if self.hand == "vacuum":
            raise ValueError("The vacuum gripper is served on the network only: use FrankaSim.")

    def options(self) -> list[str]:
        """The words of franka_sim's command line.

        >>> pyfranka.sim.Panda(hand=False, address="127.0.0.2").options()
        ['--robot=panda', '--ip=127.0.0.2', '--hand=none']
        """
        words = [f"--robot={self.kind}", f"--ip={self.address}"]
        given = {
            "base": ",".join(map(repr, self.base)) if any(self.base) else "",
            "hand": "" if self.hand is True else self.hand or "none",
            "arm-id": self.name,
            "realism": self.realism,
            "protocol": self.protocol,
            "urdf": self.urdf,
        }
        words += [f"--{option}={value}" for option, value in given.items() if value]
        return [*words, *self.arguments]

    def _named(self, taken: set[str]) -> _Setup:
        """This, with a name of its own."""
        name, number = self.name or self.kind, 2
        while not self.name and name in taken:
            name, number = f"{self.kind}_{number}", number + 1
        if name in taken:
            raise ValueError(f"Two robots have the name '{name}'; each needs one of its own.")
        taken.add(name)
        return replace(self, name=name)

    def _seeded(self, seed: int | None) -> _Setup:
        """This, with a seed where its realism names none."""
        words = [word for word in self.realism.split(",") if word]
        if seed is None or any(word.startswith("seed=") for word in words):
            return self
        return replace(self, realism=",".join([*words, f"seed={seed}"]))

    def _native(self) -> _sim.RobotSetup:
        return _sim.RobotSetup(
            robot=self.kind,
            name=self.name,
            urdf=os.fspath(self.urdf),
            base=self.base[:3],
            yaw=self.base[3] if len(self.base) == 4 else 0.0,
            realism=self.realism,
            hand=self.hand is True,
        )


def _base(base: tuple[float, ...]) -> tuple[float, ...]:
    """The base; other units than meters and radians show by their size."""
    position, turn = base[:3], abs(base[3]) if len(base) == 4 else 0.0
    if max(map(abs, position)) > MAX_POSITION:
        raise ValueError(
            f"base must be at most {MAX_POSITION:g} m from the origin along each axis, not {position} m."
        )
    if turn > MAX_TURN:
        raise ValueError(f"The turn of base must be -6.283 to 6.283 rad, not {base[3]:g} rad.")
    return base


def _hand(hand: typing.Any) -> bool | str:
    """True, False or "vacuum"."""
    if isinstance(hand, (bool, numpy.bool_)):
        return bool(hand)
    words: dict[str, bool | str] = {"gripper": True, "none": False, "vacuum": "vacuum"}
    if not isinstance(hand, str):
        raise TypeError(f"hand must be True, False or 'vacuum', not {hand!r}.")
    if hand not in words:
        raise ValueError(f"hand must be True, False or 'vacuum', not {hand!r}.")
    return words[hand]


def _load(load: typing.Any) -> tuple[float, tuple[float, ...], tuple[float, ...]] | None:
    """Mass, center of mass and inertia."""
    if load is None:
        return None
    try:
        mass, center, *rest = load
        (turning,) = rest or [numpy.zeros(9)]
    except (TypeError, ValueError):
        raise ValueError(
            f"load must be mass, center of mass and, optionally, inertia, not {load!r}."
        ) from None
    return (
        float(numbers(mass, "The mass of load [kg]", 1)[0]),
        tuple(map(float, numbers(center, "The center of mass of load [m]", 3))),
        tuple(map(float, inertia(turning, "The inertia of load [kg m^2]"))),
    )


@dataclass(frozen=True)
class Panda(_Setup):
    """A Panda to simulate."""

    __doc__ = (__doc__ or "") + (_Setup.__doc__ or "").partition("\n")[2]  # none under python -OO
    kind: typing.ClassVar[str] = "panda"
    _protocols: typing.ClassVar[range] = range(3, 6)


@dataclass(frozen=True)
class FR3(_Setup):
    """An FR3 to simulate."""

    __doc__ = (__doc__ or "") + (_Setup.__doc__ or "").partition("\n")[2]  # none under python -OO
    kind: typing.ClassVar[str] = "fr3"
    _protocols: typing.ClassVar[range] = range(6, 11)


# The kinds of robots by their names.
KINDS: dict[str, type[Panda] | type[FR3]] = {Panda.kind: Panda, FR3.kind: FR3}


def described(robot: Panda | FR3 | str, **options: typing.Any) -> Panda | FR3:
    """A robot as it is given: described, or by its kind, "panda" or "fr3", and the options of its class."""
    if isinstance(robot, str):
        if robot not in KINDS:
            raise ValueError(no_robot(robot, KINDS))
        return KINDS[robot](**options)
    if not isinstance(robot, (Panda, FR3)):
        raise TypeError(f"robots are Panda(...), FR3(...) and their kinds, not {robot!r}.")
    return robot
