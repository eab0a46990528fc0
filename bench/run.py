#!/usr/bin/env python3
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Runs the benchmarks; each prints its figure as a ratio to a reference measured in the same run.

`./franka bench` runs all, `./franka bench NAME...` some of: fci, hardware, micro, tick, arms, cameras,
memory, start, growth, python. Exit status 1 if a figure misses its goal. Needs the environment of the built
workspace, which `./franka bench` provides.
"""

# ruff: noqa: E402
import os
import sys
import time
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1] / "tests"
sys.path[:0] = [str(TESTS), str(TESTS / "support")]  # simulated robots are described once

import growth
import hardware
import lock_step_pairs
import micro
import network
import python_simulation
import python_sweep
import simulation
from report import failures
from stalls import Stalls


def conditions() -> None:
    """Prints what else the machine does before a benchmark."""
    with Stalls() as stalls:
        time.sleep(2.0)
    late = f"a bare thread was woken up late {stalls.late} times in 2 s, by up to {1e3 * stalls.worst:.1f} ms"
    print(f"\nLoad {os.getloadavg()[0]:.1f}; {late}")


def python() -> None:
    python_simulation.python()
    lock_step_pairs.pairs()
    python_sweep.sweep()


BENCHMARKS = {
    "fci": network.fci,
    "hardware": hardware.hardware,
    "micro": micro.micro,
    "tick": simulation.tick,
    "arms": simulation.arms,
    "cameras": simulation.cameras,
    "memory": simulation.memory,
    "start": simulation.start,
    "growth": growth.growth,
    "python": python,
}


def main() -> int:
    names = sys.argv[1:] or list(BENCHMARKS)
    unknown = [name for name in names if name not in BENCHMARKS]
    if unknown:
        print(
            f"There is no benchmark {', '.join(unknown)}. There are: {', '.join(BENCHMARKS)}.",
            file=sys.stderr,
        )
        return 2
    for name in names:
        conditions()
        BENCHMARKS[name]()
    for text in failures:
        print(f"MISSED: {text}")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
