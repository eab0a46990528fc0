# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""What all benchmarks share: where the workspace is, and how a figure is printed."""

from pathlib import Path

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


def print_stalls(stalls) -> None:
    """What the machine did to a thread that only sleeps: the reference of what goes by the clock."""
    figure("meanwhile a bare thread was woken up more than 1 ms late", stalls.late, "times")
    figure("its longest delay", 1e3 * stalls.worst, "ms")
