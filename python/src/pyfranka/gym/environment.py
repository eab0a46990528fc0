# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A task as an environment of Gymnasium."""

from __future__ import annotations

import copy
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import MISSING, dataclass, fields
from importlib.util import find_spec
from typing import Any

import gymnasium
import numpy
from gymnasium import spaces
from gymnasium.envs.registration import EnvSpec
from gymnasium.error import ClosedEnvironmentError, ResetNeeded
from numpy.typing import NDArray

from pyfranka.sim import KINDS, Simulation
from pyfranka.sim.arguments import items, numbers, seed_of, text, whole

from .actions import CONTROLS
from .episode import MAX_OPENING_TICKS, OPENING, Bounds, Episode, layout_of, size_of_action
from .randomization import Randomization, Setting
from .tasks import TASKS, Task
from .window import Window

__all__ = ["Environment", "Options"]

Values = NDArray[Any]

MAX_ACTION_TICKS = 50  # ticks; a longer step repeats its action, so that targets move evenly
MAX_PICTURE_SIDE = 4096  # [pixel]
OBSERVATIONS = ("state", "state+pictures")
REWARDS = ("sparse", "dense")
REFLEXES = ("recover", "terminate")
RENDER_MODES = ("human", "rgb_array")


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
    time_limit: float | str | None = "task"
    camera: str = ""
    size: tuple[int, int] = (128, 96)
    render_mode: str | None = None
    render_size: tuple[int, int] = (640, 480)

    @classmethod
    def of(cls, task: str | None = None, /, **arguments: Any) -> Options:
        """From arguments by their names. Raises TypeError for unknown ones, ValueError and TypeError for
        values that cannot be used."""
        known = {each.name: each.default for each in fields(cls)}
        wrong = [f"'{name}'" for name in arguments if name not in known]
        if wrong:
            raise TypeError(
                f"An environment has no option {', '.join(wrong)}; its options are "
                f"{', '.join(name for name, default in known.items() if default is not MISSING)}."
            )
        return cls(**{"task": task, **arguments})

    def __post_init__(self) -> None:
        chosen("task", self.task, tuple(TASKS))
        chosen("robot", self.robot, tuple(KINDS))
        chosen("control", self.control, tuple(CONTROLS))
        chosen("observation", self.observation, OBSERVATIONS)
        chosen("reward", self.reward, REWARDS)
        chosen("on_reflex", self.on_reflex, REFLEXES)
        if self.render_mode is not None:
            chosen("render_mode", self.render_mode, RENDER_MODES)
        (frequency,) = numbers(self.frequency, "frequency", 1)
        if not 1.0 <= frequency <= 1000.0 or abs(1000.0 / frequency - self.ticks) > 1e-6:
            raise ValueError(
                f"frequency is 1 to 1000 Hz, with a whole number of milliseconds, not {self.frequency}."
            )
        if self.time_limit not in ("task", None):
            (limit,) = numbers(self.time_limit, "time_limit", 1)
            object.__setattr__(self, "time_limit", float(limit))  # also of a list or an array of one number
            if not limit > 0.0:
                raise ValueError(f"time_limit is a time in s, 'task' or None, not {self.time_limit}.")
        text(self.camera, "camera")
        text(self.realism, "realism")
        for name in ("size", "render_size"):
            size = getattr(self, name)
            sides = items(size, name, "width and height")
            if len(sides) != 2 or not all(1 <= whole(side, name) <= MAX_PICTURE_SIDE for side in sides):
                raise ValueError(f"{name} is width and height, 1 to {MAX_PICTURE_SIDE} pixels, not {size}.")

    @property
    def kind(self) -> type[Task]:
        """The task's class."""
        return TASKS[self.task]

    @property
    def ticks(self) -> int:
        """Of a step."""
        return round(1000.0 / self.frequency)

    @property
    def steps(self) -> int | None:
        """After which an episode is truncated; None: never."""
        if self.time_limit is None:
            return None
        seconds = self.kind.seconds if self.time_limit == "task" else float(self.time_limit)
        return max(1, round(1000.0 * seconds / self.ticks))

    def parts(self) -> list[int]:
        """The ticks for which a step's action is applied, one after the other; one part at 20 Hz or more."""
        count = -(-self.ticks // MAX_ACTION_TICKS)
        edges = numpy.linspace(0, self.ticks, count + 1).round().astype(int)
        return [int(part) for part in numpy.diff(edges)]

    def setting(self) -> Setting:
        return Setting(self.kind, self.robot, self.realism)

    def action_space(self) -> spaces.Box:
        return spaces.Box(-1.0, 1.0, (size_of_action(self.kind, self.control),), numpy.float32)

    def layout(self) -> dict[str, slice]:
        """The position of each part in the vector "observation"."""
        return layout_of(self.kind, self.setting().names())

    def observation_space(self, bounds: Mapping[str, Bounds]) -> spaces.Dict:
        """With these bounds of its vectors."""
        parts: dict[str, spaces.Space[Any]] = {
            name: spaces.Box(low, high, dtype=numpy.float32) for name, (low, high) in bounds.items()
        }
        if self.observation == "state+pictures":
            width, height = self.size
            parts["picture"] = spaces.Box(0, 255, (height, width, 3), numpy.uint8)
        return spaces.Dict(parts)

    def new_episode(self, sim: Simulation, like: Episode | None = None) -> Episode:
        """In a simulation that was just made, as Episode. Raises ValueError if it lacks the camera."""
        if self.camera and self.camera not in sim.cameras():
            known = ", ".join(sim.cameras()) or "none"
            raise ValueError(f"There is no camera '{self.camera}'; there are: {known}.")
        return Episode(self.kind(), sim, self.control, self.reward == "dense", like)

    def rewards(self, achieved: Values, desired: Values) -> Values:
        """Of goals, ... x size."""
        if self.reward == "dense":
            return self.kind.dense(achieved, desired)
        return self.kind.success(achieved, desired) - 1.0

    def picture(self, sim: Simulation) -> NDArray[numpy.uint8]:
        """The camera's picture for an observation, height x width x 3."""
        return sim.render(self.camera, *self.size).rgb

    def rendered(self, sim: Simulation) -> NDArray[numpy.uint8]:
        """The camera's picture for people, height x width x 3."""
        return sim.render(self.camera, *self.render_size).rgb


def checked_action(action: Any, shape: tuple[int, ...], unit: str) -> Values:
    """As numbers of this shape; raises ValueError. Applying them refuses those that are not finite, and clips
    what is beyond [-1, 1], as policies with noise expect."""
    try:
        values = numpy.asarray(action, dtype=float)
    except (TypeError, ValueError):
        raise ValueError("An action is an array of numbers.") from None
    if values.shape != shape:
        raise ValueError(f"An action has the shape {shape} here ({unit}), not {values.shape}.")
    return values


def checked_goals(goals: Any, size: int) -> Values:
    """As numbers, ... x size; raises ValueError."""
    try:
        values = numpy.asarray(goals, dtype=float)
    except (TypeError, ValueError):
        raise ValueError("A goal is an array of numbers.") from None
    if values.shape[-1:] != (size,):
        raise ValueError(f"A goal has {size} numbers here, not the shape {values.shape}.")
    return values


def step_worlds(episodes: Sequence[Episode], step: Callable[[int], None], ticks: int) -> None:
    """Steps the simulations of episodes and warns of those whose physics diverges. step: steps all of them,
    and raises RuntimeError if the physics of some has diverged."""
    before = [episode.diverged for episode in episodes]
    try:
        step(ticks)
    except RuntimeError as error:
        diverged = [episode.diverged for episode in episodes]
        if not any(diverged):
            raise
        if diverged != before:
            warnings.warn(f"{error} The episode is truncated.", RuntimeWarning, stacklevel=3)


def make_ready(episodes: Sequence[Episode], step: Callable[[int], None]) -> None:
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
    episode = options.new_episode(sim)
    make_ready([episode], sim.step)
    return episode


class Environment(gymnasium.Env[dict[str, Any], Any]):
    """A task with one robot, or two. docs/gym.md describes spaces, rewards and randomization.

    task: Reach, Push, PickAndPlace, HandOver. robot: panda, fr3. control: torque, joint_delta,
    cartesian_delta. observation: state, state+pictures. reward: sparse, dense. frequency: of the policy
    [Hz]. realism: a profile of docs/sim_to_real.md. randomize: what is drawn for each episode. on_reflex:
    recover (the arm is recovered, its actions have no effect meanwhile), terminate. time_limit: after which
    an episode is truncated [s]; task: that of the task, at any frequency; None: never. camera: name; empty: a
    view of the whole world. size: width and height of observed pictures. render_mode: human (a window, which
    needs pygame), rgb_array. render_size: width and height of what render() draws.

    Raises ValueError, TypeError, RuntimeError or ImportError with a sentence. Called by one thread.

    >>> env = pyfranka.gym.Environment("Reach", control="joint_delta")
    >>> observation, info = env.reset(seed=1)
    >>> observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
    >>> env.close()
    """

    metadata = {"render_modes": list(RENDER_MODES), "render_fps": 20}
    observation_space: spaces.Dict
    action_space: spaces.Box

    def __init__(self, task: str, **arguments: Any):
        self.options = options = Options.of(task, **arguments)
        self.action_space, self.layout = options.action_space(), options.layout()
        self.render_mode = options.render_mode
        # The checker of Gymnasium tries all modes.
        modes = [mode for mode in RENDER_MODES if mode != "human" or find_spec("pygame")]
        self.metadata = {"render_modes": modes, "render_fps": options.frequency}
        self._randomization = Randomization.of(options.randomize, options.kind)
        self._unit = CONTROLS[options.control].unit
        self._parts = options.parts()
        self._begun = self._closed = False
        self._steps = 0
        self._window: Window | None = None
        if self.render_mode == "human":
            title = f"pyfranka/{options.task}-v0"
            self._window = Window(title, options.render_size, options.frequency)
        # What cannot be simulated is refused now.
        self._episode = new_episode(options, self._randomization, numpy.random.default_rng(0))
        self.observation_space = options.observation_space(self._episode.view.bounds)

    @property
    def spec(self) -> EnvSpec | None:
        """How gymnasium.make() made it. Its max_episode_steps are those of time_limit."""
        return self._spec

    @spec.setter
    def spec(self, spec: EnvSpec | None) -> None:
        self._spec = copy.copy(spec)
        if self._spec is not None and self._spec.max_episode_steps is None:
            self._spec.max_episode_steps = self.options.steps

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
        self._episode.sim.close()
        self._episode = episode

    def _require_open(self) -> None:
        if self._closed:
            raise ClosedEnvironmentError("The environment is closed; make another one.")

    def reset(
        self, *, seed: int | None = None, options: Mapping[str, Any] | None = None
    ) -> tuple[dict[str, Any], dict[str, Any]]:
        """Begins an episode. options: q (joints of all robots [rad]), object (x, y, z [m] and, optionally,
        w, x, y, z), goal (x, y, z [m]), in place of what is drawn. Raises ValueError, TypeError or
        RuntimeError for a seed or options that cannot be used; nothing has changed then.

        >>> env = pyfranka.gym.Environment("Reach")
        >>> observation, info = env.reset(seed=1)
        """
        self._require_open()
        checked = self._episode.checked(options)
        super().reset(seed=None if seed is None else seed_of(seed))
        if self._randomization:
            self._renew(self.np_random)
        self._episode.reset(self.np_random, checked)
        self._begun, self._steps = True, 0
        observation = self._observe(0.0)
        return observation, self._episode.report(observation)

    def step(self, action: Any) -> tuple[dict[str, Any], float, bool, bool, dict[str, Any]]:
        """Applies an action for one step of the policy: observation, reward, terminated, truncated, info.
        Raises ValueError for another shape and for numbers that are not finite. If the physics diverges, the
        episode is truncated, info["diverged"] is True, and a RuntimeWarning says why.

        >>> env = pyfranka.gym.Environment("Reach")
        >>> observation, info = env.reset(seed=1)
        >>> observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
        """
        self._require_open()
        if not self._begun:
            raise ResetNeeded("Call reset() before the first step().")
        values = checked_action(action, self.action_space.shape, self._unit)
        episode = self._episode
        for ticks in self._parts:
            episode.apply(values, 1e-3 * ticks)
            step_worlds([episode], episode.sim.step, ticks)
        self._steps += 1
        observation = self._observe(1e-3 * self.options.ticks)
        info = episode.report(observation)
        reward = float(self.options.rewards(observation["achieved_goal"], episode.desired))
        terminated = info["is_success"] or (self.options.on_reflex == "terminate" and episode.stopped)
        truncated = episode.stuck or info["diverged"] or self._steps == self.options.steps
        return observation, reward, terminated, truncated, info

    def _observe(self, seconds: float) -> dict[str, Values]:
        observation = self._episode.observe(seconds)
        if "picture" in self.observation_space.spaces:
            observation["picture"] = self.options.picture(self._episode.sim)
        if self._window:
            self._window.show(self.options.rendered(self._episode.sim))
        return observation

    def compute_reward(self, achieved_goal: Values, desired_goal: Values, info: Any = None) -> float | Values:
        """The reward of goals, ... x size, for replay with other goals (HER). info: not used. Raises
        ValueError.

        >>> env = pyfranka.gym.Environment("Reach")
        >>> observation, info = env.reset(seed=1)
        >>> float(env.compute_reward(observation["achieved_goal"], observation["desired_goal"], info))
        -1.0
        """
        size = self._episode.view.bounds["desired_goal"].low.size
        achieved, desired = (checked_goals(goals, size) for goals in (achieved_goal, desired_goal))
        rewards = self.options.rewards(achieved, desired)
        return float(rewards) if rewards.ndim == 0 else rewards

    def render(self) -> NDArray[numpy.uint8] | None:
        """A picture, height x width x 3, with render_mode="rgb_array". With "human" reset() and step() show
        it.

        >>> env = pyfranka.gym.Environment("Reach", render_mode="rgb_array", render_size=(64, 48))
        >>> observation, info = env.reset(seed=1)
        >>> env.render().shape
        (48, 64, 3)
        """
        self._require_open()
        return self.options.rendered(self._episode.sim) if self.render_mode == "rgb_array" else None

    def close(self) -> None:
        """Ends the simulation; further calls raise ClosedEnvironmentError.

        >>> pyfranka.gym.Environment("Reach").close()
        """
        if not self._closed:
            self._episode.sim.close()
            if self._window:
                self._window.close()
        self._closed = True
