# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Many environments of a task at once, whose worlds a SimulationBatch steps on all cores."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from copy import deepcopy
from typing import Any

import numpy
from gymnasium import spaces
from gymnasium.error import ClosedEnvironmentError, ResetNeeded
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space, concatenate, create_empty_array
from numpy.typing import NDArray

from pyfranka._native import _sim
from pyfranka.sim import SimulationBatch
from pyfranka.sim.arguments import mapping, seed_of, whole

from .actions import CONTROLS
from .environment import Options, checked_action, chosen, make_ready, new_episode, step_worlds
from .episode import Episode
from .randomization import Randomization

__all__ = ["VectorEnvironment"]

Values = NDArray[Any]


MAX_ENVIRONMENTS = 100_000  # each takes 3 to 6 MB (chosen here: above, it is another unit)


class VectorEnvironment(VectorEnv[dict[str, Any], Any, Any]):
    """Equals `num_envs` Environments with the same options: world i is seeded by `seed + i`, and gives the
    same numbers on any number of threads.

    max_episode_steps: after which an episode is truncated, if its time_limit is not over before. threads: as
    of SimulationBatch.
    autoreset_mode: NextStep (a step after an episode's end resets it, as Gymnasium does by default),
    SameStep (with info["final_obs"] and info["final_info"]) or Disabled (options["reset_mask"] of reset()).
    The rest as of Environment. With `randomize` each episode has a new simulation, which takes the place of
    the one before in the batch.

    Raises ValueError, TypeError or RuntimeError with a sentence. Called by one thread.

    >>> worlds = pyfranka.gym.VectorEnvironment(2, task="Reach")
    >>> observations, infos = worlds.reset(seed=1)
    >>> worlds.close()
    """

    single_observation_space: spaces.Dict
    single_action_space: spaces.Box

    def __init__(
        self,
        num_envs: int = 1,
        max_episode_steps: int | None = None,
        threads: int | None = None,
        autoreset_mode: str | AutoresetMode = AutoresetMode.NEXT_STEP,
        **arguments: Any,
    ):
        self.num_envs = whole(num_envs, "num_envs", 1, MAX_ENVIRONMENTS)
        if max_episode_steps is not None:
            max_episode_steps = whole(max_episode_steps, "max_episode_steps", 1)
        self.options = options = Options.of(**arguments)
        if options.render_mode is not None:
            chosen("The render_mode of many environments", options.render_mode, ("rgb_array",))
        modes = {mode.value: mode for mode in AutoresetMode}
        if not isinstance(autoreset_mode, AutoresetMode):
            autoreset_mode = modes[chosen("autoreset_mode", autoreset_mode, tuple(modes))]
        self.autoreset_mode = autoreset_mode
        self.metadata = {
            "render_modes": ["rgb_array"],
            "render_fps": options.frequency,
            "autoreset_mode": self.autoreset_mode,
        }
        limits = [limit for limit in (options.steps, max_episode_steps) if limit is not None]
        self.render_mode, self._limit = options.render_mode, min(limits, default=None)
        self.single_action_space = options.action_space()
        self.action_space = batch_space(self.single_action_space, self.num_envs)
        self.layout, self._parts = options.layout(), options.parts()
        self._unit = CONTROLS[options.control].unit
        self._randomization = Randomization.of(options.randomize, options.kind)
        if self._randomization:  # what cannot be simulated is refused now
            new_episode(options, self._randomization, numpy.random.default_rng(0)).sim.close()
        robots = options.setting().robots()
        self._batch = SimulationBatch(
            self.num_envs, options.kind.world, robots, threads=threads, observe=["time"]
        )
        first = options.new_episode(self._batch[0])
        make_ready([first], self._batch[0].step)
        self._episodes = [first, *(options.new_episode(sim, first) for sim in self._batch[1:])]
        make_ready(self._episodes[1:], self._batch.step)
        self._view = self._episodes[0].view
        self.single_observation_space = options.observation_space(self._view.bounds)
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)
        self._rows = numpy.zeros((self.num_envs, self._episodes[0].native.size))
        self._desired = numpy.zeros((self.num_envs, self._goal_size()), dtype=numpy.float32)
        self._randoms: list[numpy.random.Generator] = []
        self._steps = numpy.zeros(self.num_envs, dtype=int)
        self._ended: Values = numpy.zeros(self.num_envs, dtype=bool)
        # Of a dict of arrays.
        self._shared: Any = create_empty_array(self.single_observation_space, self.num_envs)

    def _goal_size(self) -> int:
        return int(self._view.bounds["desired_goal"].low.size)

    @property
    def episodes(self) -> Sequence[Episode]:
        """The present one of each environment. Others after a reset if anything is randomized."""
        return self._episodes

    def _require_open(self) -> None:
        if self.closed:
            raise ClosedEnvironmentError("The environment is closed; make another one.")

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: Mapping[str, Any] | None = None
    ) -> tuple[dict[str, Values], dict[str, Any]]:
        """Begins an episode in all environments, or in those of options["reset_mask"], an array of bools.
        seed: of the first one, then counted up; or one for each. Other options: as of Environment, the same
        for all.

        >>> worlds = pyfranka.gym.VectorEnvironment(2, task="Reach")
        >>> observations, infos = worlds.reset(seed=1)
        """
        self._require_open()
        options = dict(mapping(options, "options", "values by their names"))
        mask = options.pop("reset_mask", None)
        mask = self._checked_mask(mask) if mask is not None else numpy.ones(self.num_envs, dtype=bool)
        seeds = self._checked_seeds(seed)
        super().reset(seed=seeds[0])
        checked = self._episodes[mask.argmax()].checked(options)  # the others have equal robots
        self._seed(seeds, mask)
        infos: dict[str, Any] = {}
        observations: list[Any] = [None] * self.num_envs
        for i in map(int, numpy.flatnonzero(mask)):
            observations[i], info = self._reset_one(i, checked)
            infos = self._add_info(infos, info, i)
        for i in map(int, numpy.flatnonzero(~mask)):
            observations[i] = self._row(i)
        return self._together(observations), infos

    def _checked_mask(self, mask: Any) -> Values:
        checked: Values = numpy.asarray(mask)
        if checked.shape != (self.num_envs,) or checked.dtype != bool or not checked.any():
            raise ValueError(f"reset_mask needs {self.num_envs} bools, of which one is true.")
        if not self._randoms and not checked.all():
            raise ResetNeeded("The first reset() is that of all environments.")
        return checked

    def _checked_seeds(self, seed: int | Sequence[int | None] | None) -> list[int | None]:
        """One for each environment."""
        if seed is None:
            return [None] * self.num_envs
        if isinstance(seed, Sequence | numpy.ndarray) and not isinstance(seed, str):
            seeds = [None if one is None else seed_of(one) for one in seed]
        else:
            seeds = [seed_of(seed) + i for i in range(self.num_envs)]
        if len(seeds) != self.num_envs:
            raise ValueError(f"seed is one number, or {self.num_envs} of them, not {len(seeds)}.")
        return seeds

    def _seed(self, seeds: list[int | None], mask: Values) -> None:
        if not self._randoms:
            self._randoms = [numpy.random.default_rng(one) for one in seeds]
        for i in numpy.flatnonzero(mask):
            if seeds[i] is not None:
                self._randoms[i] = numpy.random.default_rng(seeds[i])

    def _reset_one(self, i: int, checked: Mapping[str, Values]) -> tuple[dict[str, Values], dict[str, Any]]:
        if self._randomization:
            episode = new_episode(self.options, self._randomization, self._randoms[i])
            self._batch.replace(i, episode.sim)
            self._episodes[i] = episode
        self._episodes[i].reset(self._randoms[i], checked)
        self._steps[i], self._ended[i] = 0, False
        return self._observed(i, 0.0)

    def step(self, actions: Any) -> tuple[dict[str, Values], Values, Values, Values, dict[str, Any]]:
        """Applies an action to each world: observations, rewards, terminated, truncated, infos, a row each.
        Raises ValueError for another shape and for numbers that are not finite. Where the physics diverges,
        the episode is truncated, "diverged" of infos is True, and a RuntimeWarning says why; the other worlds
        go on.

        >>> worlds = pyfranka.gym.VectorEnvironment(2, task="Reach")
        >>> observations, infos = worlds.reset(seed=1)
        >>> observations, rewards, terminated, truncated, infos = worlds.step(worlds.action_space.sample())
        >>> rewards.shape
        (2,)
        """
        self._require_open()
        if not self._randoms:
            raise ResetNeeded("Call reset() before the first step().")
        values = checked_action(actions, (self.num_envs, *self.single_action_space.shape), self._unit)
        if self.autoreset_mode == AutoresetMode.DISABLED and self._ended.any():
            which = ", ".join(map(str, numpy.flatnonzero(self._ended)))
            raise ResetNeeded(f"The episodes of the environments {which} have ended; reset them first.")
        resting = self._ended.copy()  # these are reset in place of a step
        self._advance(values, resting)
        natives = [episode.native for episode in self._episodes]
        _sim.observe_episodes(natives, resting.tolist(), 1e-3 * self.options.ticks, self._rows)
        seen = {**self._view.observation(self._rows), "desired_goal": self._desired.copy()}
        success = self.options.kind.success(seen["achieved_goal"], self._desired)
        infos = {
            "is_success": success,
            "reach": self._view.reach(self._rows),
            "reflexes": numpy.array([native.reflexes for native in natives]),
            "diverged": numpy.array([episode.diverged for episode in self._episodes]),
        }
        rewards = self.options.rewards(seen["achieved_goal"], self._desired)
        rewards[resting] = 0.0
        if "picture" in self.single_observation_space.spaces:
            before = self._shared["picture"]  # of resting worlds, which are drawn after their reset
            seen["picture"] = numpy.stack(
                [before[i] if resting[i] else self.options.picture(sim) for i, sim in enumerate(self._batch)]
            )
        self._steps += 1
        terminated, truncated = self._ends(success, infos["diverged"], resting)
        self._ended = terminated | truncated
        infos.update({f"_{name}": numpy.ones(self.num_envs, dtype=bool) for name in list(infos)})
        renewed = self._ended if self.autoreset_mode == AutoresetMode.SAME_STEP else resting
        for i in map(int, numpy.flatnonzero(renewed)):
            infos = self._renew(i, seen, infos)
        self._shared = {name: values.copy() for name, values in seen.items()}
        return seen, rewards, terminated, truncated, infos

    def _ends(self, success: Values, diverged: Values, resting: Values) -> tuple[Values, Values]:
        """Which episodes are terminated, and which are truncated by this step."""
        natives = [episode.native for episode in self._episodes]
        terminated = success.copy()
        if self.options.on_reflex == "terminate":
            terminated |= [native.stopped for native in natives]
        truncated = diverged | [native.stuck for native in natives]
        if self._limit is not None:
            truncated |= self._steps >= self._limit
        return terminated & ~resting, truncated & ~resting

    def _renew(self, i: int, seen: dict[str, Values], infos: dict[str, Any]) -> dict[str, Any]:
        """Begins another episode in environment i, and puts its observation and info in their places."""
        if self.autoreset_mode == AutoresetMode.SAME_STEP:
            final = {"final_obs": {name: values[i].copy() for name, values in seen.items()}}
            final["final_info"] = {
                name: infos[name][i].item() for name in ("is_success", "reach", "reflexes", "diverged")
            }
            infos = self._add_info(infos, final, i)
        observation, info = self._reset_one(i, {})
        for name, value in observation.items():
            seen[name][i] = value
        return self._add_info(infos, info, i)

    def _advance(self, values: Values, resting: Values) -> None:
        natives = [episode.native for episode in self._episodes]
        for ticks in self._parts:
            _sim.apply_actions(natives, resting.tolist(), values, 1e-3 * ticks)
            step_worlds(self._episodes, self._batch.step, ticks)

    def _observed(self, i: int, seconds: float) -> tuple[dict[str, Values], dict[str, Any]]:
        episode = self._episodes[i]
        observation = episode.observe(seconds)
        self._rows[i], self._desired[i] = episode.row, episode.desired
        if "picture" in self.single_observation_space.spaces:
            observation["picture"] = self.options.picture(episode.sim)
        return observation, episode.report(observation)

    def _row(self, i: int) -> dict[str, Values]:
        return {name: values[i].copy() for name, values in self._shared.items()}

    def _together(self, observations: Sequence[Mapping[str, Values]]) -> dict[str, Values]:
        space: spaces.Space[Any] = self.single_observation_space
        self._shared = concatenate(space, observations, self._shared)
        together: dict[str, Values] = deepcopy(self._shared)
        return together

    def render(self) -> tuple[NDArray[numpy.uint8], ...] | None:
        """A picture of each environment, with render_mode="rgb_array".

        >>> worlds = pyfranka.gym.VectorEnvironment(
        ...     2, task="Reach", render_mode="rgb_array", render_size=(64, 48)
        ... )
        >>> observations, infos = worlds.reset(seed=1)
        >>> len(worlds.render())
        2
        """
        self._require_open()
        return tuple(self.options.rendered(sim) for sim in self._batch) if self.render_mode else None

    def close_extras(self, **_: Any) -> None:
        """Ends the simulations; called by close().

        >>> pyfranka.gym.VectorEnvironment(2, task="Reach").close()
        """
        self._batch.close()
