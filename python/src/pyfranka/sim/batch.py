# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Many simulations at once, on all cores."""

from __future__ import annotations

import os
import typing
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor

import numpy
from numpy.typing import ArrayLike

from pyfranka import _copies
from pyfranka._native import _sim

from .arguments import items, seed_of, text, whole
from .robot import Array
from .setups import _Setup
from .simulation import Simulation

MOST_WORLDS = 100_000  # chosen here: some hundred gigabytes


def _worlds(
    world: str | os.PathLike[str], robots: Sequence[_Setup | str] | None, seeds: Sequence[int], threads: int
) -> list[Simulation]:
    """Simulations with these seeds. What cannot be simulated is refused after the first one."""

    def made(seed: int) -> Simulation:
        simulation = Simulation.__new__(Simulation)
        simulation._make(world, robots, seed)
        return simulation

    first = made(seeds[0])
    if threads == 1 or len(seeds) == 1:
        return [first, *map(made, seeds[1:])]
    with ThreadPoolExecutor(min(threads, len(seeds) - 1)) as pool:
        return [first, *pool.map(made, seeds[1:])]


class SimulationBatch(Sequence[Simulation]):
    """Worlds of the same robots, stepped together by threads in C++. `batch[i]` is a Simulation.

    number: of worlds. world, robots: as of Simulation. seed: of the batch; world i equals, bit for bit,
    `Simulation(world, robots, seed=batch.seeds[i])` run alone, whatever the number of threads. threads: that
    make worlds and step them at once; without one, as many as there are cores. observe: what `observations`
    shows: "time", "<robot>.<field>" (q, dq, O_T_EE, tau_J, width, robot_mode, ...), "<body>.pose" (x, y, z
    [m] and the quaternion w, x, y, z) and "<body>.twist" [m/s, rad/s]; without it, what is usual.

    Raises FileNotFoundError, ValueError and RuntimeError with a sentence.

    >>> with pyfranka.sim.SimulationBatch(2, robots=[pyfranka.sim.FR3()], observe=["time"]) as batch:
    ...     batch.step(100)
    ...     batch.observations.tolist()
    [[0.1], [0.1]]
    """

    def __init__(
        self,
        number: int,
        world: str | os.PathLike[str] = "",
        robots: Sequence[_Setup | str] | None = None,
        seed: int = 1,
        threads: int | None = None,
        observe: Iterable[str] | None = None,
    ):
        number = whole(number, "number", 1, MOST_WORLDS)
        threads = len(os.sched_getaffinity(0)) if threads is None else whole(threads, "threads", 1, 1024)
        if observe is not None:
            observe = [text(name, "A name of observe") for name in items(observe, "observe", "names")]
        sequence = numpy.random.SeedSequence(seed_of(seed))
        self.seeds = tuple(int(s) for s in sequence.generate_state(number))
        robots = robots if robots is None else items(robots, "robots", "Panda(...), FR3(...) and their kinds")
        self._worlds = _worlds(world, robots, self.seeds, threads)
        self._worlds[0]._warn(3)  # all have the same robots at the same places
        for one in self._worlds[1:]:
            one._native.take_warnings()
        self._native = _sim.Batch([one._native for one in self._worlds], threads, observe)
        self._observations: Array = self._native.observations

    __reduce__ = _copies.refused(
        "A SimulationBatch can be neither pickled nor copied: make one with the same arguments where it is "
        "used."
    )

    @typing.overload
    def __getitem__(self, index: int) -> Simulation: ...
    @typing.overload
    def __getitem__(self, index: slice) -> list[Simulation]: ...
    def __getitem__(self, index: int | slice) -> Simulation | list[Simulation]:
        return self._worlds[index if isinstance(index, slice) else self._checked(index)]

    def _checked(self, number: int) -> int:
        """The number of a world, from 0 on; negative ones count from the end."""
        try:
            return range(len(self))[whole(number, "The number of a world")]
        except IndexError:
            raise IndexError(f"There is no world {number}; the batch has {len(self)}.") from None

    def __len__(self) -> int:
        return len(self._worlds)

    def __repr__(self) -> str:
        return f"<SimulationBatch of {len(self)} worlds, the first: {self[0]!r}>"

    def __enter__(self) -> SimulationBatch:
        for one in self._worlds:
            one.__enter__()
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def close(self) -> None:
        """Ends all simulations: further calls raise RuntimeError, and so does a step() of another thread,
        which ends within about 0.1 s.

        >>> pyfranka.sim.SimulationBatch(2).close()
        """
        for one in self._worlds:
            one.close()

    @property
    def layout(self) -> dict[str, slice]:
        """The position of each observed value in a row of `observations`. 4x4 poses are stored column by
        column."""
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
        thread. Warns once of a world (RuntimeWarning) when there are more contacts than the limit
        (nconmax). Ctrl-C ends a long step; all worlds have then advanced by as many ticks.

        >>> batch.step(10)
        >>> batch[1].ticks
        10
        """
        self._native.step(ticks)

    def observe(self) -> Array:
        """Brings `observations` up to date after worlds were changed one by one, and returns this view.

        >>> batch[0].step(10)
        >>> batch.observe()[:, batch.layout["time"]].tolist()
        [[0.01], [0.0]]
        """
        self._native.observe()
        return self._observations

    def reset(
        self,
        q: ArrayLike | str | Mapping[str, ArrayLike | str] | None = None,
        objects: Mapping[str, ArrayLike] | None = None,
        worlds: Iterable[int] | None = None,
    ) -> Array:
        """Resets all worlds, or those with these numbers, as Simulation.reset() does, and returns
        `observations`, a view. Random poses continue with the random numbers of each world.

        Raises as Simulation.reset(), and no world has changed; if no random pose of a world is free, those
        before it have been reset.

        >>> batch.reset(q="random")[:, batch.layout["panda.q"]].shape
        (2, 7)
        """
        which = range(len(self)) if worlds is None else items(worlds, "worlds", "numbers of worlds")
        chosen = [self._worlds[self._checked(i)] for i in which]
        plans = [one._plan(q, objects) for one in chosen]
        for one, plan in zip(chosen, plans):
            one._carry_out(plan)
        return self.observe()

    def replace(self, number: int, simulation: Simulation) -> None:
        """Puts another simulation, with other robots or another world, in the place of world `number`,
        which is closed, and observes it. From then on the batch steps it, and close() ends it.

        Raises ValueError if it does not have what `observations` shows, or is in the batch already, and
        IndexError without such a world; nothing has changed then.

        >>> batch.replace(0, pyfranka.sim.Simulation(seed=5))
        >>> batch[0].ticks
        0
        """
        number = self._checked(number)
        if not isinstance(simulation, Simulation):
            raise TypeError(f"simulation must be a Simulation, not {simulation!r}.")
        self._native.replace(number, simulation._native)
        self._worlds[number].close()
        self._worlds[number] = simulation
