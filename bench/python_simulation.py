# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""pyfranka.sim: what Python costs in addition to the tick in C++, whose speed is the reference."""

import os
import time
from collections.abc import Callable

import numpy
from environments import environments
from pyfranka.sim import SimulatedRobot, Simulation, SimulationBatch
from report import figure

TICKS = 10000
POLICY = 50  # ticks between the commands of a slow program
TRIES = 5
WORLDS, BATCH_STEPS = 16, 20
STIFFNESS, DAMPING = numpy.array([600.0] * 4 + [250, 150, 50]), numpy.array([50.0] * 4 + [20, 15, 8])


def speed(run: Callable[[Simulation, SimulatedRobot], None]) -> float:
    """Times real time of the best try; `run` steps a simulation by TICKS."""
    best = 0.0
    for _ in range(TRIES):
        with Simulation() as sim:
            robot = sim["panda"]
            sim.step(100)
            begin = time.perf_counter()
            run(sim, robot)
            best = max(best, 1e-3 * TICKS / (time.perf_counter() - begin))
            assert robot.moving, robot.state.last_motion_errors
    return best


def in_cpp(sim: Simulation, robot: SimulatedRobot) -> None:
    robot.joint_impedance(robot.state.q)
    sim.step(TICKS)


def below_a_policy(sim: Simulation, robot: SimulatedRobot) -> None:
    target = robot.state.q
    for _ in range(TICKS // POLICY):
        robot.joint_impedance(target, duration=1e-3 * POLICY)
        sim.step(POLICY)


def torques_in_python(sim: Simulation, robot: SimulatedRobot) -> None:
    state, target = robot.live_state, robot.state.q
    q, dq = state.q, state.dq
    for _ in range(TICKS):
        robot.command(torque=STIFFNESS * (target - q) - DAMPING * dq)
        sim.step()


def move_all(batch: SimulationBatch) -> None:
    for sim in batch:
        robot = sim["panda"]
        robot.joint_impedance(robot.state.q, duration=1e-3 * POLICY)
    batch.step(POLICY)


def batch_speed(batch: SimulationBatch) -> float:
    """Simulated over real seconds of all worlds together."""
    begin = time.perf_counter()
    for _ in range(BATCH_STEPS):
        move_all(batch)
    return 1e-3 * len(batch) * POLICY * BATCH_STEPS / (time.perf_counter() - begin)


def batches() -> None:
    """One thread and two in turns, so that other work on the machine slows both."""
    with (
        SimulationBatch(WORLDS, threads=1) as alone,
        SimulationBatch(WORLDS, threads=2) as both,
    ):
        best = {alone: 0.0, both: 0.0}
        for _ in range(TRIES):
            for batch in best:
                best[batch] = max(best[batch], batch_speed(batch))
    figure(f"batch of {WORLDS} worlds on one thread: sum of times real time", best[alone], "x")
    figure("on two threads, over one", best[both] / best[alone], "", 1.8, at_least=True)


def resident() -> float:
    """[MB]"""
    with open("/proc/self/statm") as statm:
        return int(statm.read().split()[1]) * os.sysconf("SC_PAGESIZE") / 1e6


def memory() -> None:
    with SimulationBatch(1) as first:
        move_all(first)
        before = resident()
        with SimulationBatch(WORLDS) as more:
            move_all(more)
            figure("memory of a world more", (resident() - before) / WORLDS, "MB", 8.0)


def python() -> None:
    print("Simulated robots in a Python program (pyfranka.sim), arm and hand")
    reference = speed(in_cpp)
    figure("times real time, all ticks in C++ (reference)", reference, "x")
    figure(
        "joint impedance in C++ below a policy of 20 Hz, over the reference",
        speed(below_a_policy) / reference,
        "",
        0.85,
        at_least=True,
    )
    own = speed(torques_in_python)
    figure("torque law in Python (numpy, 1 kHz), over the reference", own / reference, "")
    figure("torque law in Python: times real time", own, "x", 35, at_least=True)
    memory()
    batches()
    environments()
