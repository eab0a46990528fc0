# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Many simulations at once, on all cores."""

from __future__ import annotations

import operator
import os
from collections.abc import Iterable, Mapping, Sequence

import numpy
from _pyfranka import _sim
from numpy.typing import ArrayLike

from .robot import Array
from .setups import _Setup
from .simulation import Simulation


class SimulationBatch(Sequence):
    """Worlds of the same robots, stepped together by threads in C++. `batch[i]` is a Simulation.

    number: of worlds. world, robots: as of Simulation. seed: of the batch; world i equals, bit for bit,
    `Simulation(world, robots, seed=batch.seeds[i])` run alone, whatever the number of threads. threads: that
    step at once; without one, as many as there are cores. observe: what `observations` shows: "time",
    "<robot>.<field>" (q, dq, O_T_EE, tau_J, width, robot_mode, ...), "<body>.pose" (x, y, z [m] and the
    quaternion w, x, y, z) and "<body>.twist" [m/s, rad/s]; without it, what is usual.

    Raises ValueError and RuntimeError with a sentence.
    """

    def __init__(
        self,
        number: int,
        world: str = "",
        robots: Sequence[_Setup] | None = None,
        seed: int = 1,
        threads: int | None = None,
        observe: Iterable[str] | None = None,
    ):
        number = operator.index(number)
        if number < 1:
            raise ValueError(f"A batch needs at least one world, not {number}.")
        if isinstance(observe, str):
            raise TypeError("observe is a list of names, not one string.")
        self.seeds = tuple(int(s) for s in numpy.random.SeedSequence(seed).generate_state(number))
        self._worlds = [Simulation(world, robots, seed=one) for one in self.seeds]
        self._native = _sim.Batch(
            [one._native for one in self._worlds],
            len(os.sched_getaffinity(0)) if threads is None else threads,
            None if observe is None else list(observe),
        )
        self._observations = self._native.observations

    def __getitem__(self, index):
        return self._worlds[index]

    def __len__(self) -> int:
        return len(self._worlds)

    def __enter__(self) -> SimulationBatch:
        return self

    def __exit__(self, *error) -> None:
        self.close()

    def close(self) -> None:
        """Ends all simulations: further calls raise RuntimeError."""
        for one in self._worlds:
            one.close()

    @property
    def layout(self) -> dict[str, slice]:
        """Where each observed value stands in a row of `observations`. 4x4 poses stand column by column."""
        return {name: slice(begin, end) for name, begin, end in self._native.layout}

    @property
    def observations(self) -> Array:
        """One row a world, as of the last step(), reset() or observe(). A view that cannot be written and
        shows each new step; copy what is to stay."""
        return self._observations

    def step(self, ticks: int = 1) -> None:
        """Advances all worlds by so many milliseconds; other Python threads run meanwhile.

        Raises RuntimeError, after all other worlds have been stepped, if the physics of some has diverged;
        resetting these ends that. Raises RuntimeError and steps none if one is closed or in use by another
        thread.
        """
        self._native.step(ticks)

    def observe(self) -> Array:
        """Brings `observations` up to date after worlds were changed one by one, and returns them."""
        self._native.observe()
        return self._observations

    def reset(
        self,
        q: ArrayLike | str | Mapping[str, ArrayLike | str] | None = None,
        objects: Mapping[str, ArrayLike] | None = None,
        worlds: Iterable[int] | None = None,
    ) -> Array:
        """Resets all worlds, or those with these numbers, as Simulation.reset() does, and returns the
        observations. Random poses go on with the random numbers of each world."""
        chosen = self._worlds if worlds is None else [self._worlds[i] for i in worlds]
        for one in chosen:
            one.reset(q, objects)
        return self.observe()
