# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Helpers of all benchmarks: the workspace's path, and printing of results."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from stalls import Stalls

TOP = Path(__file__).resolve().parent.parent
DEVEL = TOP / "catkin_ws" / "devel"

failures: list[str] = []


def executables() -> dict[str, Path]:
    return {path.name: path for path in DEVEL.glob("lib/*/*bench") if path.is_file()}


def figure(text: str, value: float, unit: str, goal: float | None = None, at_least: bool = False) -> None:
    """Prints one line, with the goal and whether it is met."""
    line = f"  {text:<66} {value:10.3f} {unit}"
    if goal is not None:
        met = value >= goal if at_least else value <= goal
        line += f"   (goal: at {'least' if at_least else 'most'} {goal:g}{'' if met else ', MISSED'})"
        if not met:
            failures.append(text)
    print(line, flush=True)


def print_stalls(stalls: Stalls) -> None:
    """Prints the machine's delays of a thread that only sleeps: the reference for real-time results."""
    figure("meanwhile a bare thread was woken up more than 1 ms late", stalls.late, "times")
    figure("its longest delay", 1e3 * stalls.worst, "ms")
