# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Prints how many steps a second an environment makes with random actions, resets included.

Run by environments.py, in the Python environment of each package: environment_steps.py NAME SECONDS. Steps
last 50 ms of simulated time in all.
"""

import sys
import time
from typing import Any

import numpy


def pyfranka() -> Any:
    import gymnasium
    import pyfranka.gym  # noqa: F401

    return gymnasium.make("pyfranka/PickAndPlace-v0")


def robosuite() -> Any:
    import robosuite

    return robosuite.make(
        "Lift",
        robots="Panda",
        has_renderer=False,
        has_offscreen_renderer=False,
        use_camera_obs=False,
        control_freq=20,
    )


def panda_gym() -> Any:
    import gymnasium
    import panda_gym  # noqa: F401

    env: Any = gymnasium.make("PandaPickAndPlace-v3")
    env.unwrapped.sim.n_substeps = 25  # of 2 ms; 20 is its default
    return env


def main() -> None:
    name, seconds = sys.argv[1], float(sys.argv[2])
    env = {"pyfranka": pyfranka, "robosuite": robosuite, "panda-gym": panda_gym}[name]()
    size = env.action_dim if name == "robosuite" else env.action_space.shape[0]
    random, steps = numpy.random.default_rng(1), 0
    env.reset()
    env.step(numpy.zeros(size, dtype=numpy.float32))  # what is done only once
    begin = time.perf_counter()
    while (duration := time.perf_counter() - begin) < seconds:
        result = env.step(random.uniform(-1.0, 1.0, size).astype(numpy.float32))
        steps += 1
        if any(result[2:-1]):
            env.reset()
    print(f"steps a second: {steps / duration}")


if __name__ == "__main__":
    main()
