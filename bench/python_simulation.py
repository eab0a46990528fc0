# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""pyfranka.sim: what Python costs beside the tick in C++, whose speed is the reference."""

import time

import numpy
import pyfranka.sim
from report import figure

TICKS = 10000
POLICY = 50  # ticks between the commands of a slow program
TRIES = 5
STIFFNESS, DAMPING = numpy.array([600.0] * 4 + [250, 150, 50]), numpy.array([50.0] * 4 + [20, 15, 8])


def speed(run) -> float:
    """Times real time of the best try; `run` steps a simulation by TICKS."""
    best = 0.0
    for _ in range(TRIES):
        with pyfranka.sim.Simulation() as sim:
            robot = sim["panda"]
            sim.step(100)
            begin = time.perf_counter()
            run(sim, robot)
            best = max(best, 1e-3 * TICKS / (time.perf_counter() - begin))
            assert robot.moving, robot.state.last_motion_errors
    return best


def in_cpp(sim, robot) -> None:
    robot.joint_impedance(robot.state.q)
    sim.step(TICKS)


def below_a_policy(sim, robot) -> None:
    target = robot.state.q.copy()
    for _ in range(TICKS // POLICY):
        robot.joint_impedance(target, duration=1e-3 * POLICY)
        sim.step(POLICY)


def torques_in_python(sim, robot) -> None:
    state, target = robot.state, robot.state.q.copy()
    q, dq = state.q, state.dq
    for _ in range(TICKS):
        robot.command(torque=STIFFNESS * (target - q) - DAMPING * dq)
        sim.step()


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
