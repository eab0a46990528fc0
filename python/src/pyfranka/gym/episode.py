# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""One task in one Simulation: what an action does to it, what is observed, and what is reported of it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy
from scipy.spatial.transform import Rotation

from pyfranka import RobotMode
from pyfranka.sim import RequestRefused, Robot, Simulation

from .actions import CONTROLS, HandControl
from .tasks import Task

__all__ = ["Episode", "layout_of", "size_of_action"]

OPENING = 100  # ticks between two looks at hands that open (chosen here)
LONGEST_OPENING = 5000  # ticks; the slowest hand needs 2000
LONGEST_RECOVERY = 1.0  # [s]; one that succeeds takes less than half of it
START_SPREAD = 0.02  # of the joints at the start of an episode [rad] (chosen here)
LOOSE_TORQUE, LOOSE_FORCE = 100.0, 300.0  # [Nm], [N]: beyond what a task needs (chosen here)
ARM_FIELDS = (("q", 7), ("dq", 7), ("position", 3), ("rotation", 6))
BODY_FIELDS = (("position", 3), ("quaternion", 4), ("velocity", 3))


def size_of_action(task: type[Task], control: str) -> int:
    """How many numbers an action has: those of an arm and its hand, robot by robot."""
    return len(task.bases) * (CONTROLS[control].size + task.uses_hand)


def layout_of(task: type[Task], robots: list[str]) -> dict[str, slice]:
    """Where each part of the vector "observation" stands."""
    fields = [(f"{robot}.{name}", size) for robot in robots for name, size in _arm_fields(task)]
    fields += [(f"{task.body}.{name}", size) for name, size in BODY_FIELDS if task.body]
    layout, begin = {}, 0
    for name, size in fields:
        layout[name] = slice(begin, begin + size)
        begin += size
    return layout


def _arm_fields(task: type[Task]):
    return (*ARM_FIELDS, ("width", 1)) if task.uses_hand else ARM_FIELDS


class Episode:
    """Episodes of a task in a simulation, one after the other. The caller steps the simulation."""

    def __init__(self, task: Task, sim: Simulation, control: str):
        """sim: of the task's world and robots, just made; step it while hands are opening, then keep()."""
        self.task, self.sim = task, sim
        self.robots: list[Robot] = list(sim.values())
        self._bases = [_base_of(robot) for robot in self.robots]
        workspace = numpy.array(task.workspace)
        self._arms = [CONTROLS[control](r, base, workspace) for r, base in zip(self.robots, self._bases)]
        self._hands = [HandControl(robot) for robot in self.robots] if task.uses_hand else []
        self._share = CONTROLS[control].size + task.uses_hand
        self._layout = layout_of(type(task), list(sim))
        self._size = max(part.stop for part in self._layout.values())
        self.reflexes: int = 0  # of this episode
        self._stopped: set[str] = set()
        self._waited = 0.0  # [s] in a reflex
        self._openings = [robot.gripper.move(robot.gripper.max_width, 0.1) for robot in self._opening()]
        for robot in self.robots:
            robot.set_collision_behavior(*[[LOOSE_TORQUE] * 7] * 2, *[[LOOSE_FORCE] * 6] * 2)
        self._start = [robot.state.q.copy() for robot in self.robots]

    def _opening(self) -> list[Robot]:
        return self.robots if self.task.uses_hand else []

    @property
    def opening(self) -> bool:
        """Whether the hands still open; step the simulation until they do not."""
        return not all(action.done for action in self._openings)

    def keep(self) -> None:
        """Keeps the present state, hands open, as the one that each episode begins with."""
        self._beginning = self.sim.snapshot()

    def reset(self, random: numpy.random.Generator, options: Mapping[str, Any]) -> None:
        """Begins an episode. All that is random is drawn here, always in the same order."""
        chosen = self._checked(options)
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
        self.desired = numpy.array([*chosen.get("goal", goal), *self.task.flags])
        self.reflexes, self._stopped, self._waited = 0, set(), 0.0
        for part in (*self._arms, *self._hands):
            part.restart()
        self._before = place[:3]

    def _checked(self, options: Mapping[str, Any]) -> dict[str, numpy.ndarray]:
        """The options of reset() as arrays; raises ValueError, and nothing has changed."""
        sizes = {"q": (7 * len(self.robots),), "goal": (3,)}
        if self.task.body:
            sizes["object"] = (3, 7)
        chosen = {}
        for name, value in options.items():
            if name not in sizes:
                raise ValueError(f"reset() has the options {', '.join(sizes)} in this task, not '{name}'.")
            values = numpy.asarray(value, dtype=float).ravel()
            if values.size not in sizes[name] or not numpy.isfinite(values).all():
                count = " or ".join(map(str, sizes[name]))
                raise ValueError(f"The option {name} needs {count} finite numbers.")
            chosen[name] = values
        if chosen.get("object", numpy.zeros(3)).size == 7:
            if abs(numpy.linalg.norm(chosen["object"][3:]) - 1.0) > 1e-3:
                raise ValueError("The quaternion of the option object must have the length 1.")
        if "q" in chosen:
            chosen["q"] = chosen["q"].reshape(-1, 7)
            for robot, q in zip(self.robots, chosen["q"]):
                robot._native.check_positions(q)
        return chosen

    def apply(self, action: numpy.ndarray, seconds: float) -> None:
        """An action of finite numbers in [-1, 1], for so long; then the simulation is stepped."""
        for i, arm in enumerate(self._arms):
            part = action[i * self._share : (i + 1) * self._share]
            arm.apply(part[: arm.size], seconds)
            if self._hands:
                self._hands[i].apply(part[-1])

    def recover(self, seconds: float) -> bool:
        """Starts the recovery of robots that a reflex has stopped; whether there are any. seconds: since the
        last call."""
        stopped = {robot.name for robot in self.robots if robot.state.robot_mode == RobotMode.Reflex}
        if not stopped and not self._stopped:
            return False
        self.reflexes += len(stopped - self._stopped)
        self._stopped = stopped
        self._waited = self._waited + seconds if stopped else 0.0
        for name in sorted(stopped):
            try:
                self.sim[name].recover()
            except RequestRefused:  # it still brakes: the next step tries again
                pass
        return bool(stopped)

    @property
    def stuck(self) -> bool:
        """Whether recovery fails, as for a joint beyond its limits, which people guide back by hand."""
        return self._waited > LONGEST_RECOVERY

    def observe(self, seconds: float) -> dict[str, numpy.ndarray]:
        """The observation after so long a step; 0 at the start."""
        vector, at = numpy.empty(self._size), 0
        self._tools = []
        for robot, base in zip(self.robots, self._bases):
            state = robot.state
            tool = base @ state.O_T_EE
            self._tools.append(tool[:3, 3])
            vector[at : at + 7], vector[at + 7 : at + 14] = state.q, state.dq
            vector[at + 14 : at + 17] = tool[:3, 3]
            vector[at + 17 : at + 20], vector[at + 20 : at + 23] = tool[:3, 0], tool[:3, 1]
            at += 23
            if self._hands:
                vector[at] = robot.gripper.width
                at += 1
        place = numpy.zeros(3)
        if self.task.body:
            place, quaternion = self.sim.body_pose(self.task.body)
            vector[at : at + 3] = place
            vector[at + 3 : at + 7] = quaternion if quaternion[0] >= 0.0 else -quaternion
            vector[at + 7 : at + 10] = (place - self._before) / seconds if seconds else 0.0
            self._before = place
        self._reach = self.task.reach(place, self._tools)
        achieved = self.task.achieved(self.sim, place, self._tools)
        return {"observation": vector, "achieved_goal": achieved, "desired_goal": self.desired.copy()}

    def report(self, observation: Mapping[str, numpy.ndarray]) -> dict[str, Any]:
        """The info of an observation."""
        success = self.task.success(observation["achieved_goal"], self.desired)
        return {"is_success": bool(success), "reach": self._reach, "reflexes": self.reflexes}


def _base_of(robot: Robot) -> numpy.ndarray:
    base = numpy.asarray(robot.setup.base, dtype=float)
    pose = numpy.eye(4)
    pose[:3, 3] = base[:3]
    pose[:3, :3] = Rotation.from_rotvec([0.0, 0.0, base[3] if base.size == 4 else 0.0]).as_matrix()
    return pose
