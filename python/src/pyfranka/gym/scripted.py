# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Policies that solve the tasks by a written sequence of steps, for demonstrations and as a check.

env = gymnasium.make("pyfranka/PickAndPlace-v0")
observation, info = env.reset(seed=1)
policy = pyfranka.gym.scripted_policy(env)
done = False
while not done:
    observation, reward, terminated, truncated, info = env.step(policy(observation))
    done = terminated or truncated
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Mapping
from typing import Any

import gymnasium
import numpy
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from .actions import SPEED, TURN_SPEED, shortened
from .environment import Environment, Options

__all__ = ["scripted_policy"]

Vector = NDArray[Any]
GAIN = 0.3  # share of the remaining way in GAIN_TIME (chosen here: no overshoot at 20 Hz)
GAIN_TIME = 0.05  # [s]
DOWN = numpy.diag([1.0, -1.0, -1.0])  # the hand points down, its x axis along the world's
NEAR, AT = 0.015, 0.006  # of a point on the way and of one to grasp or let go at [m] (chosen here)
TURNED = 0.05  # [rad]
PATIENCE = 3.0  # before a point counts as reached although friction holds the arm off it [s]
GRASPING = 2.0  # longest time that the hand has to close or open [s]
Steps = Generator[None, None, None]


class Arm:
    """An arm's measured state and target for a script. One iteration of `go` is one step of the policy."""

    def __init__(self, script: Script, robot: str):
        self._script, self._robot = script, robot
        self.target_position = self.position
        self.target_rotation = self.rotation
        self.grip = 1.0

    def _part(self, name: str) -> Vector:
        return self._script.part(f"{self._robot}.{name}")

    @property
    def position(self) -> Vector:
        return self._part("position").copy()

    @property
    def rotation(self) -> Vector:
        x, y = self._part("rotation").reshape(2, 3)
        return numpy.stack([x, y, numpy.cross(x, y)], axis=1)

    @property
    def width(self) -> float:
        return float(self._part("width")[0])

    def action(self, seconds: float) -> Vector:
        """The Cartesian step towards the target."""
        gain = 1.0 - (1.0 - GAIN) ** (seconds / GAIN_TIME)
        way = gain * (self.target_position - self.position) / (SPEED * seconds)
        turn = Rotation.from_matrix(self.target_rotation @ self.rotation.T).as_rotvec()
        return numpy.concatenate([shortened(way, 1.0), shortened(gain * turn / (TURN_SPEED * seconds), 1.0)])

    def go(self, position: Vector, rotation: Vector | None = None, near: float = NEAR) -> Steps:
        """Goes to a pose."""
        self.target_position = numpy.asarray(position, dtype=float)
        self.target_rotation = self.target_rotation if rotation is None else rotation
        for _ in range(max(1, round(PATIENCE / self._script.seconds))):
            away = float(numpy.linalg.norm(self.target_position - self.position))
            turn = Rotation.from_matrix(self.target_rotation @ self.rotation.T).magnitude()
            if away < near and turn < TURNED:
                return
            yield

    def close(self) -> Steps:
        """Grasps: until the fingers have stopped."""
        yield from self._drive(-1.0)

    def open(self) -> Steps:
        """Lets go."""
        yield from self._drive(1.0)

    def _drive(self, grip: float) -> Steps:
        self.grip = grip
        width, still = self.width, 0
        for k in range(round(GRASPING / self._script.seconds)):
            yield
            still = still + 1 if abs(self.width - width) < 1e-4 else 0
            width = self.width
            if still * self._script.seconds > 0.15 and k * self._script.seconds > 0.3:
                return


class Script:
    """A policy: observation -> action."""

    def __init__(self, options: Options, write: Callable[[Script], Steps]):
        self.seconds, self._layout = 1e-3 * options.ticks, options.layout()
        self._robots, self._body = options.setting().names(), options.kind.body
        self._hand = options.kind.uses_hand
        self._write = write
        self._steps: Steps | None = None

    def part(self, name: str) -> Vector:
        return self._observation["observation"][self._layout[name]].astype(float)

    @property
    def goal(self) -> Vector:
        return self._observation["desired_goal"][:3].astype(float)

    @property
    def place(self) -> Vector:
        return self.part(f"{self._body}.position").copy()

    @property
    def turn(self) -> Vector:
        """Orientation of the object, 3x3."""
        w, x, y, z = self.part(f"{self._body}.quaternion")
        turn: Vector = Rotation.from_quat([x, y, z, w]).as_matrix()
        return turn

    def __call__(self, observation: Mapping[str, Vector]) -> Vector:
        """The action, float32; the first call is for the observation of a reset."""
        self._observation = observation
        if self._steps is None:
            self.arms = [Arm(self, robot) for robot in self._robots]
            self._steps = self._write(self)
        next(self._steps, None)
        parts = [[*arm.action(self.seconds), *([arm.grip] if self._hand else [])] for arm in self.arms]
        action: Vector = numpy.concatenate(parts).astype(numpy.float32)
        return action


def above(point: Vector, height: float) -> Vector:
    """A point over another one."""
    higher: Vector = point + [0.0, 0.0, height]
    return higher


def turned_down(turn: Vector) -> Vector:
    """The hand points down, turned as an object."""
    yaw = numpy.arctan2(turn[1, 0], turn[0, 0])
    down: Vector = Rotation.from_rotvec([0.0, 0.0, yaw]).as_matrix() @ DOWN
    return down


def tilted(angle: float, towards: float) -> Vector:
    """The hand points down and by an angle forwards. towards: 1 along the world's x axis, -1 against it."""
    facing = Rotation.from_rotvec([0.0, 0.0, 0.0 if towards > 0 else numpy.pi]).as_matrix() @ DOWN
    tilt: Vector = Rotation.from_rotvec([0.0, -towards * angle, 0.0]).as_matrix() @ facing
    return tilt


def reach(script: Script) -> Steps:
    yield from script.arms[0].go(script.goal, near=0.0)


def push(script: Script) -> Steps:
    """Goes behind the cube, seen from the goal, and pushes; and again if it loses the cube."""
    arm, low, high = script.arms[0], 0.005, 0.08
    while True:
        behind = above(script.place - 0.07 * ahead_of(script), low)
        yield from arm.go(above(arm.position, max(0.0, behind[2] + high - arm.position[2])))
        yield from arm.go(above(behind, high))
        yield from arm.go(behind, near=AT)
        while True:
            ahead, offset = ahead_of(script), arm.position - script.place
            aside: Vector = offset - (offset @ ahead) * ahead
            aside[2] = 0.0
            if offset @ ahead > -0.01 or numpy.linalg.norm(aside) > 0.02:
                break
            arm.target_position = arm.position + 0.02 * ahead - aside
            arm.target_position[2] = behind[2]
            yield


def ahead_of(script: Script) -> Vector:
    """The horizontal direction from the object to the goal."""
    way = (script.goal - script.place) * [1.0, 1.0, 0.0]
    return way / max(float(numpy.linalg.norm(way)), 1e-3)


def pick_and_place(script: Script) -> Steps:
    arm, lift = script.arms[0], 0.1
    stone, down = script.place, turned_down(script.turn)
    yield from arm.go(above(stone, lift), down)
    yield from arm.go(stone, near=AT)
    yield from arm.close()
    yield from arm.go(above(stone, lift))
    yield from arm.go(above(script.goal, lift))
    yield from arm.go(above(script.goal, 0.003), near=AT)
    yield from arm.open()
    yield from arm.go(above(script.goal, lift))


def hand_over(script: Script) -> Steps:
    """Both hold the stone at its ends, with tilted hands, so that these do not touch each other."""
    first, second = script.arms
    angle, grip = 0.75, 0.018  # [rad]; from the middle of the stone [m]
    stone, middle = script.place, numpy.array([0.0, 0.0, 0.6])
    end = numpy.array([grip, 0.0, 0.004])
    toward, back = tilted(angle, 1.0), tilted(angle, -1.0)
    away = numpy.array([0.08, 0.0, 0.08])  # along a tilted hand
    second.target_position, second.target_rotation = middle + [0.2, 0.0, 0.1], back
    yield from first.go(stone - end * [1, 0, -1] - away * [1, 0, -1], toward)
    yield from first.go(stone - end * [1, 0, -1], near=AT)
    yield from first.close()
    yield from first.go(above(stone, 0.1))
    yield from first.go(middle - end * [1, 0, 0])
    yield from second.go(script.place + end + away, back)
    yield from second.go(script.place + end, near=AT)
    yield from second.close()
    yield from first.open()
    yield from first.go(first.position - away * [1, 0, -1])
    held = second.position - script.place
    yield from second.go(script.goal + held, near=0.0)


SCRIPTS = {"Reach": reach, "Push": push, "PickAndPlace": pick_and_place, "HandOver": hand_over}


def scripted_policy(env: gymnasium.Env[Any, Any]) -> Script:
    """A policy for one episode of an environment with control="cartesian_delta": observation -> action.

    Make one after each reset. Raises ValueError for another control.

    >>> env = gymnasium.make("pyfranka/Reach-v0", control="cartesian_delta")
    >>> observation, info = env.reset(seed=1)
    >>> policy = pyfranka.gym.scripted_policy(env)
    >>> env.step(policy(observation))[3]  # whether the episode was truncated
    False
    """
    unwrapped = env.unwrapped
    if not isinstance(unwrapped, Environment):
        raise ValueError("Scripted policies are for the environments of pyfranka.gym.")
    if unwrapped.options.control != "cartesian_delta":
        raise ValueError(f"Scripted policies need cartesian_delta, not {unwrapped.options.control}.")
    return Script(unwrapped.options, SCRIPTS[unwrapped.options.task])
