# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Many environments of a task at once, whose worlds a SimulationBatch steps on all cores."""

from __future__ import annotations

import operator
from collections.abc import Mapping, Sequence
from copy import deepcopy
from typing import Any

import numpy
from gymnasium import spaces
from gymnasium.error import ClosedEnvironmentError, ResetNeeded
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space, concatenate, create_empty_array

from pyfranka.sim import SimulationBatch

from .actions import CONTROLS
from .environment import Options, checked_action, make_ready
from .episode import Episode
from .randomization import Randomization

__all__ = ["VectorEnvironment"]


class VectorEnvironment(VectorEnv):
    """Equals `num_envs` Environments with the same options: world i is seeded by `seed + i`, and gives the
    same numbers on any number of threads.

    max_episode_steps: after which an episode is truncated; None: never. threads: as of SimulationBatch.
    autoreset_mode: NextStep (a step after an episode's end resets it, as Gymnasium does by default),
    SameStep (with info["final_obs"] and info["final_info"]) or Disabled (options["reset_mask"] of reset()).
    The rest as of Environment, except `randomize`: the robots of a batch stay, so of it only `realism` can
    be chosen. One profile; each world has a robot of its own with it.

    Raises ValueError or RuntimeError with a sentence. One thread.
    """

    def __init__(
        self,
        num_envs: int = 1,
        max_episode_steps: int | None = None,
        threads: int | None = None,
        autoreset_mode: str | AutoresetMode = AutoresetMode.NEXT_STEP,
        **options: Any,
    ):
        self.num_envs = operator.index(num_envs)
        if self.num_envs < 1:
            raise ValueError(f"num_envs is 1 or more, not {num_envs}.")
        self.options = options = Options(**options)
        self.autoreset_mode = AutoresetMode(autoreset_mode)
        self.metadata = {
            "render_modes": ["rgb_array"],
            "render_fps": options.frequency,
            "autoreset_mode": self.autoreset_mode,
        }
        self.render_mode, self._limit = options.render_mode, max_episode_steps
        self.single_action_space = options.action_space()
        self.single_observation_space = options.observation_space()
        self.action_space = batch_space(self.single_action_space, self.num_envs)
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)
        self.layout, self._parts = options.layout(), options.parts()
        self._unit = CONTROLS[options.control].unit
        self._batch = self._make_batch(threads)
        self._episodes = [Episode(options.kind(), sim, options.control) for sim in self._batch]
        make_ready(self._episodes, self._batch.step)
        self._randoms: list[numpy.random.Generator] = []
        self._steps = numpy.zeros(self.num_envs, dtype=int)
        self._ended = numpy.zeros(self.num_envs, dtype=bool)
        self._shared = create_empty_array(self.single_observation_space, self.num_envs)

    def _make_batch(self, threads: int | None) -> SimulationBatch:
        options = self.options
        randomization = Randomization.of(options.randomize, options.kind)
        if randomization.ranges or len(randomization.realism) > 1:
            raise ValueError(
                "Worlds of a batch cannot be made anew, so randomize takes one realism only here; for the "
                "rest use gymnasium.make_vec(..., vectorization_mode='async')."
            )
        robots = options.setting().robots(*randomization.realism)
        batch = SimulationBatch(self.num_envs, options.kind.world, robots, threads=threads, observe=["time"])
        if options.camera and options.camera not in batch[0].cameras():
            known = ", ".join(batch[0].cameras()) or "none"
            raise ValueError(f"There is no camera '{options.camera}'; there are: {known}.")
        return batch

    @property
    def episodes(self) -> Sequence[Episode]:
        """Of each environment."""
        return self._episodes

    def _require_open(self) -> None:
        if self.closed:
            raise ClosedEnvironmentError("The environment is closed; make another one.")

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: Mapping[str, Any] | None = None
    ):
        """Begins an episode in all environments, or in those of options["reset_mask"], an array of bools.
        seed: of the first one, then counted up; or one for each. Other options: as of Environment, the same
        for all."""
        self._require_open()
        options = dict(options or {})
        mask = options.pop("reset_mask", None)
        mask = self._checked_mask(mask) if mask is not None else numpy.ones(self.num_envs, dtype=bool)
        self._seed(seed, mask)
        infos: dict[str, Any] = {}
        observations: list[Any] = [None] * self.num_envs
        for i in numpy.flatnonzero(mask):
            observations[i], info = self._reset_one(i, options)
            infos = self._add_info(infos, info, i)
        for i in numpy.flatnonzero(~mask):
            observations[i] = self._row(i)
        return self._together(observations), infos

    def _checked_mask(self, mask: Any) -> numpy.ndarray:
        mask = numpy.asarray(mask)
        if mask.shape != (self.num_envs,) or mask.dtype != bool or not mask.any():
            raise ValueError(f"reset_mask needs {self.num_envs} bools, of which one is true.")
        if not self._randoms and not mask.all():
            raise ResetNeeded("The first reset() is that of all environments.")
        return mask

    def _seed(self, seed: int | Sequence[int | None] | None, mask: numpy.ndarray) -> None:
        seeds = [seed] * self.num_envs if seed is None else seed
        if isinstance(seed, int | numpy.integer):
            seeds = [int(seed) + i for i in range(self.num_envs)]
        if len(seeds) != self.num_envs:
            raise ValueError(f"seed is one number, or {self.num_envs} of them, not {len(seeds)}.")
        if not self._randoms:
            self._randoms = [numpy.random.default_rng(one) for one in seeds]
        for i in numpy.flatnonzero(mask):
            if seeds[i] is not None:
                self._randoms[i] = numpy.random.default_rng(seeds[i])

    def _reset_one(self, i: int, options: Mapping[str, Any]):
        self._episodes[i].reset(self._randoms[i], options)
        self._steps[i], self._ended[i] = 0, False
        return self._observed(i, 0.0)

    def step(self, actions: Any):
        self._require_open()
        if not self._randoms:
            raise ResetNeeded("Call reset() before the first step().")
        values = checked_action(actions, self.action_space.shape, self._unit)
        if self.autoreset_mode == AutoresetMode.DISABLED and self._ended.any():
            which = ", ".join(map(str, numpy.flatnonzero(self._ended)))
            raise ResetNeeded(f"The episodes of the environments {which} have ended; reset them first.")
        resting = self._ended.copy()  # these are reset in place of a step
        self._advance(values, ~resting)
        seconds = 1e-3 * self.options.ticks
        rewards = numpy.zeros(self.num_envs)
        terminated, truncated = numpy.zeros((2, self.num_envs), dtype=bool)
        infos: dict[str, Any] = {}
        observations: list[Any] = [None] * self.num_envs
        for i, episode in enumerate(self._episodes):
            if resting[i]:
                observations[i], info = self._reset_one(i, {})
            else:
                stopped = episode.recover(seconds)
                observations[i], info = self._observed(i, seconds)
                self._steps[i] += 1
                goal = observations[i]["achieved_goal"]
                rewards[i] = self.options.reward_of(goal, episode.desired, info)
                terminated[i] = info["is_success"] or (stopped and self.options.on_reflex == "terminate")
                late = self._limit is not None and self._steps[i] >= self._limit
                truncated[i] = late or episode.stuck
                self._ended[i] = terminated[i] or truncated[i]
            if self._ended[i] and self.autoreset_mode == AutoresetMode.SAME_STEP:
                final = {"final_obs": observations[i], "final_info": info}
                infos = self._add_info(infos, final, i)
                observations[i], info = self._reset_one(i, {})
            infos = self._add_info(infos, info, i)
        return self._together(observations), rewards, terminated, truncated, infos

    def _advance(self, values: numpy.ndarray, moving: numpy.ndarray) -> None:
        for ticks in self._parts:
            for i in numpy.flatnonzero(moving):
                self._episodes[i].apply(values[i], 1e-3 * ticks)
            self._batch.step(ticks)

    def _observed(self, i: int, seconds: float):
        episode = self._episodes[i]
        observation = episode.observe(seconds)
        if "picture" in self.single_observation_space.spaces:
            observation["picture"] = self.options.picture(episode.sim)
        return observation, episode.report(observation)

    def _row(self, i: int) -> dict[str, numpy.ndarray]:
        return {name: values[i].copy() for name, values in self._shared.items()}

    def _together(self, observations: Sequence[Mapping[str, numpy.ndarray]]) -> dict[str, numpy.ndarray]:
        space: spaces.Space = self.single_observation_space
        self._shared = concatenate(space, observations, self._shared)
        return deepcopy(self._shared)

    def render(self):
        """A picture of each environment, with render_mode="rgb_array"."""
        self._require_open()
        return tuple(self.options.picture(sim) for sim in self._batch) if self.render_mode else None

    def close_extras(self, **_: Any) -> None:
        """Ends the simulations; called by close()."""
        self._batch.close()
