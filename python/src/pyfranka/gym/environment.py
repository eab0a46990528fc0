# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A task as an environment of Gymnasium."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import gymnasium
import numpy
from gymnasium import spaces
from gymnasium.error import ClosedEnvironmentError, ResetNeeded

from pyfranka.sim import KINDS, Simulation
from pyfranka.sim.arguments import items, numbers, seed_of, text, whole

from .actions import CONTROLS
from .episode import MAX_OPENING_TICKS, OPENING, Episode, layout_of, size_of_action
from .randomization import Randomization, Setting
from .tasks import TASKS, Task

__all__ = ["Environment", "Options"]

MAX_ACTION_TICKS = 50  # ticks; a longer step repeats its action, so that targets move evenly
MAX_PICTURE_SIDE = 4096  # [pixel]
OBSERVATIONS = ("state", "state+pictures")
REWARDS = ("sparse", "dense")
REFLEXES = ("recover", "terminate")


def chosen(name: str, value: Any, known: Sequence[str]) -> Any:
    """The value, if it is one of those that are known; raises ValueError."""
    if not isinstance(value, str) or value not in known:
        raise ValueError(f"{name} is one of {', '.join(known)}, not {value!r}.")
    return value


@dataclass(frozen=True)
class Options:
    """The arguments of an environment, checked; see Environment."""

    task: str
    robot: str = "panda"
    control: str = "cartesian_delta"
    observation: str = "state"
    reward: str = "sparse"
    frequency: float = 20.0
    realism: str = "ideal"
    randomize: Mapping[str, Any] | None = None
    on_reflex: str = "recover"
    camera: str = ""
    size: tuple[int, int] = (128, 96)
    render_mode: str | None = None

    def __post_init__(self):
        chosen("task", self.task, tuple(TASKS))
        chosen("robot", self.robot, tuple(KINDS))
        chosen("control", self.control, tuple(CONTROLS))
        chosen("observation", self.observation, OBSERVATIONS)
        chosen("reward", self.reward, REWARDS)
        chosen("on_reflex", self.on_reflex, REFLEXES)
        if self.render_mode is not None:
            chosen("render_mode", self.render_mode, ("rgb_array",))
        (frequency,) = numbers(self.frequency, "frequency", 1)
        if not (1.0 <= frequency <= 1000.0 and abs(1000.0 / frequency % 1.0) < 1e-9):
            raise ValueError(
                f"frequency is 1 to 1000 Hz, with a whole number of milliseconds, not {self.frequency}."
            )
        text(self.camera, "camera")
        text(self.realism, "realism")
        sides = items(self.size, "size", "width and height")
        if len(sides) != 2 or not all(1 <= whole(side, "size") <= MAX_PICTURE_SIDE for side in sides):
            raise ValueError(f"size is width and height, 1 to {MAX_PICTURE_SIDE} pixels, not {self.size}.")

    @property
    def kind(self) -> type[Task]:
        """The task's class."""
        return TASKS[self.task]

    @property
    def ticks(self) -> int:
        """Of a step."""
        return round(1000.0 / self.frequency)

    def parts(self) -> list[int]:
        """The ticks for which a step's action is applied, one after the other; one part at 20 Hz or more."""
        count = -(-self.ticks // MAX_ACTION_TICKS)
        edges = numpy.linspace(0, self.ticks, count + 1).round().astype(int)
        return numpy.diff(edges).tolist()

    def setting(self) -> Setting:
        return Setting(self.kind, self.robot, self.realism)

    def action_space(self) -> spaces.Box:
        return spaces.Box(-1.0, 1.0, (size_of_action(self.kind, self.control),), numpy.float32)

    def layout(self) -> dict[str, slice]:
        """The position of each part in the vector "observation"."""
        return layout_of(self.kind, self.setting().names())

    def observation_space(self) -> spaces.Dict:
        size = max(part.stop for part in self.layout().values())
        goal = 3 + len(self.kind.flags)
        parts: dict[str, spaces.Space] = {
            name: spaces.Box(-numpy.inf, numpy.inf, (count,), numpy.float64)
            for name, count in (("observation", size), ("achieved_goal", goal), ("desired_goal", goal))
        }
        if self.observation == "state+pictures":
            width, height = self.size
            parts["picture"] = spaces.Box(0, 255, (height, width, 3), numpy.uint8)
        return spaces.Dict(parts)

    def rewards(self, achieved: numpy.ndarray, desired: numpy.ndarray, reach: Any) -> numpy.ndarray:
        """Of goals, ... x size, and mean distances of end effectors from the object [m]."""
        if self.reward == "dense":
            return self.kind.dense(achieved, desired, reach)
        return self.kind.success(achieved, desired) - 1.0

    def reward_of(self, achieved: numpy.ndarray, desired: numpy.ndarray, info: Mapping[str, Any]) -> float:
        """The same of a step with this info."""
        if self.reward == "dense":
            return float(self.kind.dense(achieved, desired, info["reach"]))
        return 0.0 if info["is_success"] else -1.0

    def check_camera(self, sim: Simulation) -> None:
        """Raises ValueError if the world does not have the camera."""
        if self.camera and self.camera not in sim.cameras():
            known = ", ".join(sim.cameras()) or "none"
            raise ValueError(f"There is no camera '{self.camera}'; there are: {known}.")

    def picture(self, sim: Simulation) -> numpy.ndarray:
        """The camera's picture, height x width x 3."""
        return sim.render(self.camera, *self.size).rgb


def checked_action(action: Any, shape: tuple[int, ...], unit: str) -> numpy.ndarray:
    """As numbers of this shape; raises ValueError. Applying them refuses those that are not finite, and clips
    what is beyond [-1, 1], as policies with noise expect."""
    try:
        values = numpy.asarray(action, dtype=float)
    except (TypeError, ValueError):
        raise ValueError("An action is an array of numbers.") from None
    if values.shape != shape:
        raise ValueError(f"An action has the shape {shape} here ({unit}), not {values.shape}.")
    return values


def checked_goals(goals: Any, size: int) -> numpy.ndarray:
    """As numbers, ... x size; raises ValueError."""
    try:
        values = numpy.asarray(goals, dtype=float)
    except (TypeError, ValueError):
        raise ValueError("A goal is an array of numbers.") from None
    if values.shape[-1:] != (size,):
        raise ValueError(f"A goal has {size} numbers here, not the shape {values.shape}.")
    return values


def reach_of(info: Any) -> numpy.ndarray:
    """The distances in infos of steps; raises ValueError."""
    try:
        return numpy.asarray(info["reach"] if isinstance(info, Mapping) else [one["reach"] for one in info])
    except (TypeError, KeyError):
        raise ValueError(
            "The dense reward needs the info of a step, with 'reach', or a sequence of such."
        ) from None


def make_ready(episodes: Sequence[Episode], step) -> None:
    """Lets the hands of new episodes open. step: steps their simulations."""
    for _ in range(MAX_OPENING_TICKS // OPENING):
        if not any(episode.opening for episode in episodes):
            break
        step(OPENING)
    else:
        raise RuntimeError(f"A hand did not open within {MAX_OPENING_TICKS} ms.")
    for episode in episodes:
        episode.keep()


def new_episode(options: Options, randomization: Randomization, random: numpy.random.Generator) -> Episode:
    """In a simulation of its own, in which everything that is randomized is drawn."""
    sim = randomization.make(options.setting(), random)
    options.check_camera(sim)
    episode = Episode(options.kind(), sim, options.control)
    make_ready([episode], sim.step)
    return episode


class Environment(gymnasium.Env):
    """A task with one robot, or two. docs/gym.md describes spaces, rewards and randomization.

    task: Reach, Push, PickAndPlace, HandOver. robot: panda, fr3. control: torque, joint_delta,
    cartesian_delta. observation: state, state+pictures. reward: sparse, dense. frequency: of the policy
    [Hz]. realism: a profile of docs/sim_to_real.md. randomize: what is drawn for each episode. on_reflex:
    recover (the arm is recovered, its actions have no effect meanwhile), terminate. camera: name; empty: a
    view of the whole world. size: width and height of pictures.

    Raises ValueError or RuntimeError with a sentence. Called by one thread.
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 20}

    def __init__(self, task: str, **options: Any):
        self.options = options = Options(task, **options)
        self.action_space, self.observation_space = options.action_space(), options.observation_space()
        self.layout = options.layout()
        self.render_mode = options.render_mode
        self.metadata = {**self.metadata, "render_fps": options.frequency}
        self._randomization = Randomization.of(options.randomize, options.kind)
        self._unit = CONTROLS[options.control].unit
        self._parts = options.parts()
        self._episode: Episode | None = None
        self._begun = self._closed = False
        self._renew(numpy.random.default_rng(0))  # what cannot be simulated is refused now

    @property
    def episode(self) -> Episode:
        """The present one. Another one after a reset if anything is randomized."""
        self._require_open()
        return self._episode

    @property
    def simulation(self) -> Simulation:
        """The world; of the present episode, as `episode`."""
        return self.episode.sim

    def _renew(self, random: numpy.random.Generator) -> None:
        episode = new_episode(self.options, self._randomization, random)
        if self._episode:
            self._episode.sim.close()
        self._episode = episode

    def _require_open(self) -> None:
        if self._closed:
            raise ClosedEnvironmentError("The environment is closed; make another one.")

    def reset(self, *, seed: int | None = None, options: Mapping[str, Any] | None = None):
        """Begins an episode. options: q (joints of all robots [rad]), object (x, y, z [m] and, optionally,
        w, x, y, z), goal (x, y, z [m]), in place of what is drawn. Raises ValueError, TypeError or
        RuntimeError for a seed or options that cannot be used; nothing has changed then."""
        self._require_open()
        checked = self._episode.checked(options)
        super().reset(seed=None if seed is None else seed_of(seed))
        if self._randomization:
            self._renew(self.np_random)
        self._episode.reset(self.np_random, checked)
        self._begun = True
        observation = self._observe(0.0)
        return observation, self._episode.report(observation)

    def step(self, action: Any):
        self._require_open()
        if not self._begun:
            raise ResetNeeded("Call reset() before the first step().")
        values = checked_action(action, self.action_space.shape, self._unit)
        episode = self._episode
        for ticks in self._parts:
            episode.apply(values, 1e-3 * ticks)
            episode.sim.step(ticks)
        observation = self._observe(1e-3 * self.options.ticks)
        info = episode.report(observation)
        reward = self.options.reward_of(observation["achieved_goal"], episode.desired, info)
        terminated = info["is_success"] or (self.options.on_reflex == "terminate" and episode.stopped)
        return observation, reward, terminated, episode.stuck, info

    def _observe(self, seconds: float) -> dict[str, numpy.ndarray]:
        observation = self._episode.observe(seconds)
        if "picture" in self.observation_space.spaces:
            observation["picture"] = self.options.picture(self._episode.sim)
        return observation

    def compute_reward(self, achieved_goal: numpy.ndarray, desired_goal: numpy.ndarray, info: Any):
        """The reward of goals, ... x size, and of the infos that belong to them: one, or a sequence. For
        replay with other goals (HER). The sparse reward needs no info. Raises ValueError."""
        size = self.observation_space["desired_goal"].shape[0]
        achieved, desired = (checked_goals(goals, size) for goals in (achieved_goal, desired_goal))
        reach = reach_of(info) if self.options.reward == "dense" else 0.0
        rewards = self.options.rewards(achieved, desired, reach)
        return float(rewards) if achieved.ndim == 1 else rewards

    def render(self):
        """A picture, height x width x 3, with render_mode="rgb_array"."""
        self._require_open()
        return self.options.picture(self._episode.sim) if self.render_mode else None

    def close(self) -> None:
        """Ends the simulation; further calls raise ClosedEnvironmentError."""
        if not self._closed:
            self._episode.sim.close()
        self._closed = True
