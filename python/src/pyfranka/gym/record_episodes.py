# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Episodes of an environment as a data set of LeRobot."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

import gymnasium
import numpy

from pyfranka.lerobot import Dataset
from pyfranka.sim.arguments import text

__all__ = ["RecordEpisodes"]


def features(observation: Any) -> dict[str, Any]:
    """The observation by LeRobot's names: its vector is observation.state, pictures are
    observation.images.NAME."""
    if not isinstance(observation, Mapping):
        observation = {"observation": observation}
    named = {}
    for name, value in observation.items():
        picture = numpy.ndim(value) == 3
        own = "state" if name == "observation" and not picture else name
        named[f"observation.images.{name}" if picture else f"observation.{own}"] = value
    return named


class RecordEpisodes(gymnasium.Wrapper[Any, Any, Any, Any]):
    """Writes each episode that ends into a data set of LeRobot (docs/gym.md): a frame for each step, with the
    observation before it, the action, next.reward, next.done and next.success.

    env: any environment whose observation is a vector, a picture, or a dict of such. folder: of the data set,
    a new one. task: what is to be done, in words; without it, the name of the environment. only_success:
    whether episodes without info["is_success"] are left out.

    Raises as Dataset. close() ends it; an episode that has not ended is not written.

    >>> env = gymnasium.make("pyfranka/Reach-v0")
    >>> recorded = pyfranka.gym.RecordEpisodes(env, folder / "episodes", "Reach the point.")
    >>> recorded.close()
    """

    def __init__(
        self,
        env: gymnasium.Env[Any, Any],
        folder: str | os.PathLike[str],
        task: str = "",
        only_success: bool = False,
    ):
        super().__init__(env)
        fps = env.metadata.get("render_fps", 20)
        if fps != int(fps):
            raise ValueError(f"LeRobot's data sets have a whole number of frames a second, not {fps}.")
        options = getattr(env.unwrapped, "options", None)
        layout: Mapping[str, slice] = getattr(env.unwrapped, "layout", {})
        names = [
            f"{part}.{number}" if where.stop - where.start > 1 else part
            for part, where in layout.items()
            for number in range(where.stop - where.start)
        ]
        self._task = text(task, "task") or (env.spec.id if env.spec else type(env.unwrapped).__name__)
        if not isinstance(only_success, bool):
            raise TypeError(f"only_success must be True or False, not {only_success!r}.")
        self._only_success = only_success
        self._observation: Any = None
        self._ended = False
        self.dataset = Dataset(folder, int(fps), getattr(options, "robot", ""), {"observation.state": names})

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """As of the environment. An episode that has not ended is not written.

        >>> env = gymnasium.make("pyfranka/Reach-v0")
        >>> recorded = pyfranka.gym.RecordEpisodes(env, folder / "episodes")
        >>> observation, info = recorded.reset(seed=1)
        """
        observation, info = super().reset(seed=seed, options=options)
        self.dataset.discard_episode()
        self._observation, self._ended = observation, False
        return observation, info

    def step(self, action: Any) -> tuple[Any, Any, bool, bool, dict[str, Any]]:
        """As of the environment. The end of an episode writes it. The step after it, without reset(), is not
        a frame: in it gymnasium.wrappers.Autoreset begins the next episode.

        >>> env = gymnasium.make("pyfranka/Reach-v0")
        >>> recorded = pyfranka.gym.RecordEpisodes(env, folder / "episodes")
        >>> observation, info = recorded.reset(seed=1)
        >>> observation, *others = recorded.step(recorded.action_space.sample())
        """
        observation, reward, terminated, truncated, info = super().step(action)
        if self._ended:  # the action had no effect
            self._observation, self._ended = observation, terminated or truncated
            return observation, reward, terminated, truncated, info
        over, success = terminated or truncated, bool(info.get("is_success", terminated))
        self.dataset.add_frame(
            {
                **features(self._observation),
                "action": action,
                "next.reward": float(reward),
                "next.done": over,
                "next.success": success,
            }
        )
        self._observation, self._ended = observation, over
        if over and (success or not self._only_success):
            self.dataset.save_episode(self._task)
        elif over:
            self.dataset.discard_episode()
        return observation, reward, terminated, truncated, info

    def close(self) -> None:
        """Ends the environment.

        >>> env = gymnasium.make("pyfranka/Reach-v0")
        >>> recorded = pyfranka.gym.RecordEpisodes(env, folder / "episodes")
        >>> observation, info = recorded.reset(seed=1)
        >>> recorded.close()
        """
        self.dataset.discard_episode()
        super().close()
