# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""One task in one Simulation: its actions, observations and reports."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy
from _pyfranka import ArmLimits
from numpy.typing import NDArray

from pyfranka._native import _sim
from pyfranka.sim import Action, SimulatedRobot, Simulation
from pyfranka.sim.arguments import mapping, numbers
from pyfranka.sim.simulation import NO_TURN

from .actions import CONTROLS
from .tasks import Task

__all__ = ["Bounds", "Episode", "View", "layout_of", "size_of_action"]

Values = NDArray[Any]

OPENING = 100  # ticks between two checks of hands that open (chosen here)
MAX_OPENING_TICKS = 5000  # ticks; the slowest hand needs 2000
START_SPREAD = 0.02  # of the joints at the start of an episode [rad] (chosen here)
LOOSE_TORQUE, LOOSE_FORCE = 100.0, 300.0  # [Nm], [N]: beyond what a task needs (chosen here)
ARM_FIELDS = (("q", 7), ("dq", 7), ("position", 3), ("rotation", 6))
BODY_FIELDS = (("position", 3), ("quaternion", 4), ("velocity", 3))
PROTOCOLS = {"panda": 5, "fr3": 9}  # whose limits of velocity hold
TOOL_RANGE = (
    1.4  # of end effectors along each axis from a base of the task [m]: an arm's reach, and base_height
)
PLACES = ((-2.5, -2.5, -0.5), (2.5, 2.5, 2.5))  # of objects and goals: x, y, z in the world [m] (chosen here)
BODY_SPEED = 5.0  # along each axis [m/s] (chosen here: a fall of 1 m)
MAX_REACH = 5.0  # mean distance of the end effectors from the object [m] (chosen here)


def size_of_action(task: type[Task], control: str) -> int:
    """Number of values of an action: those of an arm and its hand, robot by robot."""
    return len(task.bases) * (CONTROLS[control].size + task.uses_hand)


def layout_of(task: type[Task], robots: list[str]) -> dict[str, slice]:
    """The position of each part in the vector "observation"."""
    fields = [(f"{robot}.{name}", size) for robot in robots for name, size in _arm_fields(task)]
    fields += [(f"{task.body}.{name}", size) for name, size in BODY_FIELDS if task.body]
    layout: dict[str, slice] = {}
    begin = 0
    for name, size in fields:
        layout[name] = slice(begin, begin + size)
        begin += size
    return layout


def _arm_fields(task: type[Task]) -> tuple[tuple[str, int], ...]:
    return (*ARM_FIELDS, ("width", 1)) if task.uses_hand else ARM_FIELDS


class Bounds(NamedTuple):
    """Lowest and highest values of a vector, float32. docs/gym.md has the table."""

    low: Values
    high: Values

    @classmethod
    def of(cls, *parts: tuple[Any, Any]) -> Bounds:
        """Of a vector that consists of parts, each with its lowest and its highest values."""
        return cls(*(numpy.concatenate(ends, dtype=numpy.float32) for ends in zip(*parts, strict=True)))

    def applied(self, values: Values) -> Values:
        """The values, ... x size, as float32; what is beyond is clipped."""
        return numpy.clip(values.astype(numpy.float32), self.low, self.high)


def bounds_of(task: type[Task], robots: list[SimulatedRobot], dense: bool) -> dict[str, Bounds]:
    """Of the vectors of an observation."""
    parts: list[tuple[Any, Any]] = []
    for robot, (x, y, z, _) in zip(robots, task.bases, strict=True):
        dq, base = numpy.asarray(ArmLimits(PROTOCOLS[robot.setup.kind]).dq), numpy.array([x, y, z])
        parts += [robot.limits, (-dq, dq), (base - TOOL_RANGE, base + TOOL_RANGE), ([-1.0] * 6, [1.0] * 6)]
        if task.uses_hand:
            parts.append(([0.0], [robot.gripper.max_width]))
    if task.body:
        parts += [PLACES, ([0.0, -1.0, -1.0, -1.0], [1.0] * 4), ([-BODY_SPEED] * 3, [BODY_SPEED] * 3)]
    flags, more = len(task.flags), size_of_goal(task, dense) - 3 - len(task.flags)
    goal = Bounds.of(PLACES, ([0.0] * flags, [1.0] * flags), ([0.0] * more, [MAX_REACH] * more))
    return {"observation": Bounds.of(*parts), "achieved_goal": goal, "desired_goal": goal}


def size_of_goal(task: type[Task], dense: bool) -> int:
    """Position, flags and, for the dense reward, the distance of the end effectors from the object."""
    return 3 + len(task.flags) + (1 if dense and task.body else 0)


class Episode:
    """Episodes of a task in a simulation, one after the other. The caller steps the simulation."""

    def __init__(self, task: Task, sim: Simulation, control: str, dense: bool, like: Episode | None = None):
        """sim: of the task's world and robots, just made; step it while hands are opening, then keep().
        dense: whether goals are those of the dense reward. like: one that is ready; if its robots are equal,
        its state is taken over."""
        self.task, self.sim = task, sim
        self.robots: list[SimulatedRobot] = list(sim.values())
        self.native = _sim.Episode(
            sim._native, control, task.body, task.uses_hand, numpy.array(task.workspace)
        )
        layout = layout_of(type(task), list(sim))
        self.view = View(type(task), layout, bounds_of(type(task), self.robots, dense))
        self.row = numpy.zeros(self.native.size)  # of the last observation
        self._start = [robot.state.q for robot in self.robots]
        self._openings: list[Action] = []
        if not (like and self._takes_over(like)):
            self._prepare()

    def _prepare(self) -> None:
        self._openings = [robot.gripper.move(robot.gripper.max_width, 0.1) for robot in self._opening()]
        for robot in self.robots:
            robot.set_collision_behavior(*[[LOOSE_TORQUE] * 7] * 2, *[[LOOSE_FORCE] * 6] * 2)

    def _takes_over(self, like: Episode) -> bool:
        try:
            self.sim.restore(like._beginning)
        except RuntimeError:  # robots with another noise or friction
            return False
        return True

    def _opening(self) -> list[SimulatedRobot]:
        return self.robots if self.task.uses_hand else []

    @property
    def opening(self) -> bool:
        """Whether the hands still open; step the simulation until they do not."""
        return not all(action.done for action in self._openings)

    def keep(self) -> None:
        """Keeps the present state, hands open, as the one that each episode begins with."""
        self._beginning = self.sim.snapshot()

    def reset(self, random: numpy.random.Generator, chosen: Mapping[str, Values]) -> None:
        """Begins an episode. chosen: options that were checked. All that is random is drawn here, always in
        the same order."""
        poses = [q + random.uniform(-START_SPREAD, START_SPREAD, 7) for q in self._start]
        place = self.task.draw_body(random) if self.task.body else numpy.zeros(0)
        if "object" in chosen:
            place[: chosen["object"].size] = chosen["object"]
        goal = self.task.draw_goal(random, place)
        self.sim.restore(self._beginning)
        for robot, q in zip(self.robots, chosen.get("q", poses)):
            robot._native.place(q)
        if self.task.body:
            self.sim.place_body(self.task.body, place[:3], place[3:])
        desired = numpy.zeros(self.view.bounds["desired_goal"].low.size, dtype=numpy.float32)
        desired[:3] = chosen.get("goal", goal)
        desired[3 : 3 + len(self.task.flags)] = self.task.flags
        self.desired = desired
        self.native.restart()

    def checked(self, options: Mapping[str, Any] | None) -> dict[str, Values]:
        """The options of an environment's reset() as arrays; raises ValueError or RuntimeError, and nothing
        has changed."""
        sizes: dict[str, tuple[int, ...]] = {"q": (7 * len(self.robots),), "goal": (3,)}
        if self.task.body:
            sizes["object"] = (3, 7)
        chosen = {}
        for name, value in mapping(options, "options", "values by their names").items():
            if name not in sizes:
                raise ValueError(f"reset() has the options {', '.join(sizes)} in this task, not '{name}'.")
            chosen[name] = numbers(value, f"The option {name}", *sizes[name])
        if "goal" in chosen and not all(
            low <= value <= high for low, value, high in zip(PLACES[0], chosen["goal"], PLACES[1])
        ):
            raise ValueError(
                "The option goal must lie within the bounds of goals, "
                f"{list(PLACES[0])} to {list(PLACES[1])} m, not {chosen['goal'].tolist()}."
            )
        if "object" in chosen:
            place = chosen["object"]
            self.sim._native.check_body_pose(
                self.task.body, place[:3], place[3:] if place.size == 7 else NO_TURN
            )
        if "q" in chosen:
            chosen["q"] = chosen["q"].reshape(-1, 7)
            for robot, q in zip(self.robots, chosen["q"]):
                robot._native.check_positions(q)
        return chosen

    def apply(self, action: Values, seconds: float) -> None:
        """An action of finite numbers in [-1, 1], for so long; then the simulation is stepped."""
        self.native.apply(action, seconds)

    @property
    def reflexes(self) -> int:
        """Of this episode."""
        return int(self.native.reflexes)

    @property
    def stopped(self) -> bool:
        """Whether a reflex had stopped a robot at the last observation; it is being recovered."""
        return bool(self.native.stopped)

    @property
    def stuck(self) -> bool:
        """Whether recovery fails, as for a joint beyond its limits, which a user must guide back by hand."""
        return bool(self.native.stuck)

    @property
    def diverged(self) -> bool:
        """Whether the world stands still because its physics has diverged; reset() ends that."""
        return bool(self.sim._native.stopped())

    def observe(self, seconds: float) -> dict[str, Values]:
        """The observation after so long a step; 0 at the start. Starts the recovery of robots that a reflex
        has stopped."""
        self.native.observe(seconds, self.row)
        return {**self.view.observation(self.row), "desired_goal": self.desired.copy()}

    def report(self, observation: Mapping[str, Values]) -> dict[str, Any]:
        """The info of an observation."""
        success = self.task.success(observation["achieved_goal"], self.desired)
        return {
            "is_success": bool(success),
            "reach": float(self.view.reach(self.row)),
            "reflexes": self.native.reflexes,
            "diverged": self.diverged,
        }


class View:
    """The meaning of the rows of native episodes for a task: one row, or several as ... x size."""

    def __init__(self, task: type[Task], layout: Mapping[str, slice], bounds: Mapping[str, Bounds]):
        self._task, self.bounds = task, bounds
        self._size = max(part.stop for part in layout.values())
        self._place = layout.get(f"{task.body}.position", slice(0))
        self._tools = [
            part
            for name, part in layout.items()
            if name.endswith(".position") and part.start != self._place.start
        ]

    def observation(self, rows: Values) -> dict[str, Values]:
        """The vectors within their bounds, and the goals that are reached."""
        achieved = self._task.achieved(rows[..., self._place], self.tools(rows), rows[..., self._size :])
        goal = self.bounds["achieved_goal"]
        if achieved.shape[-1] < goal.low.size:
            achieved = numpy.concatenate((achieved, self.reach(rows)[..., None]), axis=-1)
        observation = self.bounds["observation"].applied(rows[..., : self._size])
        return {"observation": observation, "achieved_goal": goal.applied(achieved)}

    def reach(self, rows: Values) -> Values:
        """Mean distance of the end effectors from the object [m]."""
        return numpy.asarray(self._task.reach(rows[..., self._place], self.tools(rows)))

    def tools(self, rows: Values) -> list[Values]:
        """Positions of the end effectors."""
        return [rows[..., part] for part in self._tools]
