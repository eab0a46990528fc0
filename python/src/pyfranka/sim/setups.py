# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Robots as they are described before a simulation begins."""

from __future__ import annotations

import os
import re
import typing
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy
from _pyfranka import _sim
from numpy.typing import ArrayLike

from .arguments import numbers, path, text

NOT_IN_NAMES = re.compile(r"[\s\"'<>&/:]")  # of XML, and of names in names


@dataclass(frozen=True)
class _Setup:
    """A robot to add to a world.

    name: prefix of its joints and links (its kind). base: x, y, z [m] and, optionally, the turn about the
    vertical [rad]. hand: False for an arm without one; that of a urdf of one's own stays then, but is not
    driven. load: mass [kg], center of mass in the flange's frame [m] and, optionally, inertia 3x3 [kg m^2],
    as entered in Desk; it is not simulated. realism: a profile of docs/sim_to_real.md, such as
    "real,friction=off". urdf: another description of this kind of robot.

    Raises ValueError or TypeError with a sentence.
    """

    name: str = ""
    base: Sequence[float] = (0.0, 0.0, 0.0)
    hand: bool = True
    load: Sequence[ArrayLike] | None = None
    realism: str = ""
    urdf: str | os.PathLike[str] = ""

    kind: typing.ClassVar[str] = ""

    def __post_init__(self):
        if NOT_IN_NAMES.search(text(self.name, "name")):
            raise ValueError(f"name is the prefix of joints and links; it cannot be {self.name!r}.")
        numbers(self.base, "base (x, y, z [m] and, optionally, the turn [rad])", 3, 4)
        if not isinstance(self.hand, (bool, numpy.bool_)):
            raise TypeError(f"hand must be True or False, not {self.hand!r}.")
        text(self.realism, "realism")
        path(self.urdf, "urdf")
        self._load()

    def _load(self) -> tuple[float, numpy.ndarray, numpy.ndarray] | None:
        """Mass, center of mass and inertia."""
        if self.load is None:
            return None
        try:
            mass, center, *inertia = self.load
            (inertia,) = inertia or [numpy.zeros(9)]
        except (TypeError, ValueError):
            raise ValueError(
                f"load must be mass, center of mass and, optionally, inertia, not {self.load!r}."
            ) from None
        return (
            float(numbers(mass, "The mass of load [kg]", 1)[0]),
            numbers(center, "The center of mass of load [m]", 3),
            numbers(inertia, "The inertia of load [kg m^2]", 9),
        )

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
        base = numpy.asarray(self.base, dtype=float).ravel()
        yaw = float(base[3]) if base.size == 4 else 0.0
        return _sim.RobotSetup(
            robot=self.kind,
            name=self.name,
            urdf=path(self.urdf, "urdf"),
            base=base[:3],
            yaw=yaw,
            realism=self.realism,
            hand=bool(self.hand),
        )


@dataclass(frozen=True)
class Panda(_Setup):
    """A Panda to add to a world."""

    __doc__ = (__doc__ or "") + _Setup.__doc__.partition("\n")[2]  # none under python -OO
    kind: typing.ClassVar[str] = "panda"


@dataclass(frozen=True)
class FR3(_Setup):
    """An FR3 to add to a world."""

    __doc__ = (__doc__ or "") + _Setup.__doc__.partition("\n")[2]  # none under python -OO
    kind: typing.ClassVar[str] = "fr3"


# The kinds of robots by their names.
KINDS: dict[str, type[_Setup]] = {kind.kind: kind for kind in (Panda, FR3)}
