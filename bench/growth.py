# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""How the time of a tick grows with arms, bodies and worlds: tables, and the exponent of the growth."""

import tempfile
import time
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

import numpy
import pyfranka.sim
from pyfranka.gym import VectorEnvironment
from report import figure

ARMS = (1, 2, 4, 8, 16)
BODIES = (1, 10, 30, 100, 300, 1000)
WORLDS = (1, 2, 4, 8, 16, 32, 64)
ENVIRONMENTS = (1, 4, 16, 64)
SPENT = 1.0  # [s] on each row
TRIES = 3
SPACING = 2.0  # [m] between arms, which do not reach each other
GRID = 0.1  # [m] between boxes that rest on the floor
BOX = (
    "<body name='box_{0}' pos='{1} {2} 0.02'><freejoint/>"
    "<geom type='box' size='0.02 0.02 0.02' mass='0.05'/></body>"
)


def microseconds(step: Callable[[int], object], *sims: pyfranka.sim.Simulation) -> float:
    """The shortest time of a tick in which each arm holds its pose by an impedance law [us]. step: advances
    all of `sims` by a number of ticks."""
    for sim in sims:
        for name in sim:
            sim[name].joint_impedance(sim[name].state.q)
    step(300)  # objects come to rest
    best, ticks = numpy.inf, 20
    for _ in range(TRIES):
        count, begin = 0, time.perf_counter()
        while time.perf_counter() - begin < SPENT / TRIES:
            step(ticks)
            count += ticks
        best = min(best, 1e6 * (time.perf_counter() - begin) / count)
    return float(best)


def arms(count: int) -> float:
    robots = [pyfranka.sim.Panda(f"arm_{i}", base=(SPACING * i, 0, 0)) for i in range(count)]
    with pyfranka.sim.Simulation(robots=robots) as sim:
        return microseconds(sim.step, sim)


def bodies(count: int) -> float:
    boxes = (BOX.format(i, 1.5 + GRID * (i % 40), GRID * (i // 40)) for i in range(count))
    floor = "<geom name='floor' type='plane' size='50 50 1'/>"
    with tempfile.TemporaryDirectory() as folder:
        world = Path(folder) / "boxes.xml"
        world.write_text(f"<mujoco><worldbody>{floor}{''.join(boxes)}</worldbody></mujoco>")
        with pyfranka.sim.Simulation(world=str(world)) as sim:
            spent = microseconds(sim.step, sim)
            heights = [sim.body_pose(f"box_{i}")[0][2] for i in range(count)]
            assert max(abs(height - 0.02) for height in heights) < 0.001, "boxes rest on the floor"
            return spent


def worlds(count: int) -> float:
    with pyfranka.sim.SimulationBatch(count, threads=1) as batch:
        return microseconds(batch.step, *batch)


def environments(count: int) -> float:
    """A step of pick-and-place environments with random actions, new episodes among them [us]."""
    with closing(VectorEnvironment(count, 100, threads=1, task="PickAndPlace")) as vector:
        vector.reset(seed=1)
        vector.action_space.seed(1)
        steps, begin = 0, time.perf_counter()
        while time.perf_counter() - begin < SPENT or steps < 100:
            vector.step(vector.action_space.sample())
            steps += 1
        return 1e6 * (time.perf_counter() - begin) / steps


def table(
    what: str, counts: tuple[int, ...], measure: Callable[[int], float], unit_of_work: str = "tick"
) -> None:
    times = []
    for count in counts:
        times.append(measure(count))
        figure(f"{count} {what}: {unit_of_work}", times[-1], "us")
        figure(f"{count} {what}: {unit_of_work} of each", times[-1] / count, "us")
    exponent, _ = numpy.polyfit(numpy.log(counts), numpy.log(times), 1)
    figure(f"exponent of the growth with {what}", exponent, "")


def growth() -> None:
    print("Growth of a tick on one thread")
    table("arms with impedance laws", ARMS, arms)
    table("boxes on the floor beside an arm", BODIES, bodies)
    table("worlds of a batch, with an arm, a hand and an impedance law each", WORLDS, worlds)
    table("environments of Gymnasium", ENVIRONMENTS, environments, "step")
