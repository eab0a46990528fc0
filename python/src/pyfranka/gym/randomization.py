# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Domain randomization: what differs from one episode to the next.

A Simulation's robots and world are fixed, and making one takes about 15 ms of a processor, less than a tenth
of an episode. So each episode has a new one if anything of `randomize` asks for it.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy

from pyfranka._native import _sim
from pyfranka.sim import KINDS, Simulation
from pyfranka.sim.arguments import items, mapping
from pyfranka.sim.setups import _Setup

from .tasks import Task

__all__ = ["Randomization", "Setting"]

RANGES = {  # name -> lowest and highest value that makes sense (chosen here)
    "mass": (0.1, 20.0),  # of the object, a factor
    "friction": (0.1, 10.0),  # of the object and what it lies on, a factor
    "base_height": (-0.1, 0.1),  # of the robots, added to that of the task [m]
    "load": (0.0, 3.0),  # that the robots assume although they do not carry it [kg]
}
LOAD_AT = (0.0, 0.0, 0.1)  # in the flange's frame [m]


@dataclass(frozen=True)
class Setting:
    """The task, robot and realism of an environment."""

    task: type[Task]
    robot: str
    realism: str

    def names(self) -> list[str]:
        """Of the robots."""
        several = len(self.task.bases) > 1
        return [f"{self.robot}_{i + 1}" if several else self.robot for i in range(len(self.task.bases))]

    def robots(self, realism: str | None = None, higher: float = 0.0, load: float = 0.0) -> list[_Setup]:
        """For Simulation(robots=...)."""
        return [
            KINDS[self.robot](
                name=name,
                base=(x, y, z + higher, yaw),
                realism=self.realism if realism is None else realism,
                load=(load, LOAD_AT) if load > 0.0 else None,
            )
            for name, (x, y, z, yaw) in zip(self.names(), self.task.bases)
        ]


@dataclass(frozen=True)
class Randomization:
    """Values drawn for each episode. Raises ValueError for unknown names and values out of range."""

    realism: Sequence[str] = ()
    ranges: Mapping[str, tuple[float, float]] = field(default_factory=dict)

    @classmethod
    def of(cls, randomize: Mapping[str, Any] | None, task: type[Task]) -> Randomization:
        """From the argument `randomize` of an environment."""
        values = dict(mapping(randomize, "randomize", "what is drawn, by its names"))
        realism = values.pop("realism", ())
        realism = (realism,) if isinstance(realism, str) else items(realism, "randomize: realism", "profiles")
        if not all(isinstance(profile, str) for profile in realism):
            raise ValueError("randomize: realism is a profile such as 'recorded', or several of them.")
        for name in values:
            if name not in RANGES:
                known = ", ".join(["realism", *RANGES])
                raise ValueError(f"randomize: '{name}' is not known; there are {known}.")
            if name in ("mass", "friction") and not task.body:
                raise ValueError(f"randomize: {name} is that of an object, and {task.name} has none.")
        return cls(tuple(realism), {name: _range(name, value) for name, value in values.items()})

    def __bool__(self) -> bool:
        return bool(self.realism or self.ranges)

    def make(self, setting: Setting, random: numpy.random.Generator) -> Simulation:
        """The simulation of one episode."""
        drawn = {name: random.uniform(*self.ranges[name]) for name in RANGES if name in self.ranges}
        realism = self.realism[int(random.integers(len(self.realism)))] if self.realism else None
        robots = setting.robots(realism, drawn.get("base_height", 0.0), drawn.get("load", 0.0))
        seed = int(random.integers(2**31)) if self else 1
        mass, friction = drawn.get("mass", 1.0), drawn.get("friction", 1.0)
        if mass == friction == 1.0:
            return Simulation(setting.task.world, robots, seed=seed)
        text = changed_world(setting.task.world, setting.task.body, mass, friction)
        handle, name = tempfile.mkstemp(suffix=".xml")
        try:
            with os.fdopen(handle, "w") as file:
                file.write(text)
            return Simulation(name, robots, seed=seed)
        finally:
            os.remove(name)


def _range(name: str, value: Any) -> tuple[float, float]:
    try:
        low, high = (float(number) for number in value)
    except (TypeError, ValueError):
        raise ValueError(f"randomize: {name} needs a lowest and a highest value.") from None
    lowest, highest = RANGES[name]
    if not lowest <= low <= high <= highest:
        raise ValueError(f"randomize: {name} can be from {lowest:g} to {highest:g}, not {low:g} to {high:g}.")
    return low, high


def changed_world(world: str, body: str, mass: float, friction: float) -> str:
    """The text of a world, with factors for the mass of a body and for the friction of all sceneries.

    MuJoCo takes the larger friction of two that touch, so that of the body alone would not count.
    """
    path = Path(_sim.world_file(world))
    root = ElementTree.parse(path).getroot()
    for include in root.iter("include"):
        include.set("file", str(path.parent / include.attrib["file"]))
    inertial = root.find(f".//body[@name='{body}']/inertial")
    if inertial is None:
        raise ValueError(f"The body '{body}' of {path} has no inertial, whose mass could be changed.")
    for attribute in ("mass", "diaginertia"):
        inertial.set(attribute, _scaled(inertial.attrib[attribute], mass))
    for geom in root.iterfind("worldbody//geom[@friction]"):
        sliding, rest = geom.attrib["friction"].split(maxsplit=1)
        geom.set("friction", f"{_scaled(sliding, friction)} {rest}")
    return ElementTree.tostring(root, encoding="unicode")


def _scaled(numbers: str, factor: float) -> str:
    return " ".join(repr(factor * float(number)) for number in numbers.split())
