# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The tasks: their worlds, their random beginnings, and what counts as success.

A goal is a vector: a position x, y, z in the world [m], and flags that are 0 or 1. A task has succeeded when
the position is nearer than its tolerance and all flags are as desired. With the dense reward, goals of a task
with an object have one number more, the distance of the end effectors from it (Task.reach), desired 0.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar

import numpy
from numpy.typing import NDArray

__all__ = ["TASKS", "HandOver", "PickAndPlace", "Push", "Reach", "Task"]

Vector = NDArray[Any]
FLAG_COST = 0.1  # in the dense reward, of a flag that is not as desired [m] (chosen here)
# Of worlds/stone.xml, push.xml and hand_over.xml [m].
TABLE = 0.419823
TRAY, TRAY_TOP = (0.004103, 0.219654), 0.443112
STONE_AT, STONE_HALF = (0.000286, -0.221972), (0.0125, 0.016, 0.032)
CUBE_HALF = 0.025
LYING_AT = (-0.3, 0.0, 0.4725)


def turned(axis: Sequence[float], angle: float) -> Vector:
    """The quaternion w, x, y, z of a turn about a unit axis [rad]."""
    return numpy.array([numpy.cos(angle / 2), *(numpy.sin(angle / 2) * numpy.asarray(axis))])


def length_of(vectors: Vector) -> Vector:
    """Of vectors x, y, z, ... x 3."""
    length: Vector = numpy.sqrt((vectors * vectors).sum(axis=-1))
    return length


class Task:
    """A task; it has no state. Positions are in the world."""

    name: ClassVar[str]
    world: ClassVar[str] = ""
    body: ClassVar[str] = ""  # the object, if there is one
    bases: ClassVar[tuple[tuple[float, ...], ...]] = ((0.0, 0.0, 0.0, 0.0),)  # a robot each: x, y, z, yaw
    uses_hand: ClassVar[bool] = False
    workspace: ClassVar[tuple[tuple[float, ...], tuple[float, ...]]]  # lowest, highest x, y, z of targets [m]
    flags: ClassVar[tuple[float, ...]] = ()  # the desired ones
    tolerance: ClassVar[float] = 0.02  # [m]
    seconds: ClassVar[float]  # of an episode

    def draw_goal(self, random: numpy.random.Generator, body: Vector) -> Vector:
        """A goal position, for an object at this position."""
        raise NotImplementedError

    def draw_body(self, random: numpy.random.Generator) -> Vector:
        """A pose of the object: x, y, z and w, x, y, z. Only for tasks with one."""
        raise NotImplementedError

    @classmethod
    def achieved(cls, place: Vector, tools: Sequence[Vector], touches: Vector) -> Vector:
        """The goals that are reached, ... x size. place: of the object; tools: of the end effectors, x, y, z
        each; touches: whether each robot, and anything else, touches the object, 0 or 1."""
        return place.copy()

    @classmethod
    def reach(cls, place: Vector, tools: Sequence[Vector]) -> Vector | float:
        """Mean distance of the end effectors from the object [m]."""
        return sum(length_of(place - tool) for tool in tools) / len(tools)

    @classmethod
    def success(cls, achieved: Vector, desired: Vector) -> Vector:
        """Whether goals are reached; both ... x size."""
        away = numpy.subtract(achieved, desired, dtype=float)
        near = length_of(away[..., :3]) < cls.tolerance
        flags = away[..., 3 : 3 + len(cls.flags)]
        success: Vector = near & (numpy.abs(flags) < 0.5).all(axis=-1) if cls.flags else near
        return success

    @classmethod
    def dense(cls, achieved: Vector, desired: Vector) -> Vector:
        """The dense reward of goals with the distance of the end effectors: minus all that is missing [m]."""
        away = numpy.subtract(achieved, desired, dtype=float)
        flags = numpy.abs(away[..., 3 : 3 + len(cls.flags)]).sum(axis=-1)
        reach = numpy.asarray(achieved, dtype=float)[..., 3 + len(cls.flags) :].sum(axis=-1)
        missing: Vector = length_of(away[..., :3]) + FLAG_COST * flags + reach
        return -missing


class Reach(Task):
    """The end effector goes to a point in the air."""

    name, seconds = "Reach", 2.5
    workspace = ((0.2, -0.5, 0.05), (0.75, 0.5, 0.8))

    def draw_goal(self, random: numpy.random.Generator, body: Vector) -> Vector:
        return random.uniform((0.3, -0.3, 0.15), (0.6, 0.3, 0.6))

    @classmethod
    def achieved(cls, place: Vector, tools: Sequence[Vector], touches: Vector) -> Vector:
        return tools[0].copy()

    @classmethod
    def reach(cls, place: Vector, tools: Sequence[Vector]) -> Vector | float:
        return numpy.zeros(place.shape[:-1])


class Push(Task):
    """The closed hand pushes a cube over a table to a point on it."""

    name, seconds = "Push", 10.0
    world, body, bases = "push.xml", "cube", ((-0.5, 0.0, 0.0, 0.0),)
    workspace = ((-0.25, -0.3, TABLE + 0.012), (0.25, 0.3, 0.7))

    def draw_body(self, random: numpy.random.Generator) -> Vector:
        x, y = random.uniform((-0.05, -0.15), (0.07, 0.15))
        return numpy.array([x, y, TABLE + CUBE_HALF, *turned((0, 0, 1), random.uniform(-0.3, 0.3))])

    def draw_goal(self, random: numpy.random.Generator, body: Vector) -> Vector:
        while True:  # one try in five is too near
            x, y = random.uniform((-0.05, -0.2), (0.15, 0.2))
            if numpy.hypot(x - body[0], y - body[1]) > 0.1:
                return numpy.array([x, y, TABLE + CUBE_HALF])


class PickAndPlace(Task):
    """The stone goes from the blue tray to the red one, where it rests, let go.

    Flag: whether the stone rests: something touches it, and no robot.
    """

    name, seconds = "PickAndPlace", 15.0
    world, body, bases = "stone.xml", "stone", ((-0.5, 0.0, 0.0, 0.0),)
    uses_hand, flags, tolerance = True, (1.0,), 0.05
    workspace = ((-0.25, -0.35, 0.44), (0.25, 0.35, 0.8))

    def draw_body(self, random: numpy.random.Generator) -> Vector:
        x, y = random.uniform((-0.05, -0.03), (0.05, 0.03)) + STONE_AT
        return numpy.array([x, y, TRAY_TOP + STONE_HALF[2], *turned((0, 0, 1), random.uniform(-0.4, 0.4))])

    def draw_goal(self, random: numpy.random.Generator, body: Vector) -> Vector:
        x, y = random.uniform((-0.03, -0.01), (0.03, 0.01)) + TRAY
        return numpy.array([x, y, TRAY_TOP + STONE_HALF[2]])

    @classmethod
    def achieved(cls, place: Vector, tools: Sequence[Vector], touches: Vector) -> Vector:
        held, lies = touches[..., :1], touches[..., 1:]
        return numpy.concatenate((place, lies * (1.0 - held)), axis=-1)


class HandOver(Task):
    """The first robot takes the stone, which the second one cannot reach, and hands it over to the second
    one, which holds it at a point in the air.

    Flags: whether the first robot touches the stone; the second; anything else.
    """

    name, seconds = "HandOver", 20.0
    world, body = "hand_over.xml", "stone"
    bases = ((-0.75, 0.0, 0.0, 0.0), (0.75, 0.0, 0.0, numpy.pi))
    uses_hand, flags, tolerance = True, (0.0, 1.0, 0.0), 0.05
    workspace = ((-0.4, -0.3, 0.44), (0.4, 0.3, 0.9))

    def draw_body(self, random: numpy.random.Generator) -> Vector:
        x, y = random.uniform((-0.008, -0.004), (0.008, 0.004))
        # It lies on one of its sides, along x.
        w, _, _, z = turned((0, 0, 1), random.uniform(-0.15, 0.15))
        half = numpy.sqrt(0.5)
        return numpy.array([LYING_AT[0] + x, y, LYING_AT[2], *(half * numpy.array([w, -z, w, z]))])

    def draw_goal(self, random: numpy.random.Generator, body: Vector) -> Vector:
        return random.uniform((0.2, -0.1, 0.55), (0.3, 0.1, 0.7))

    @classmethod
    def achieved(cls, place: Vector, tools: Sequence[Vector], touches: Vector) -> Vector:
        return numpy.concatenate((place, touches), axis=-1)


TASKS: dict[str, type[Task]] = {task.name: task for task in (Reach, Push, PickAndPlace, HandOver)}
