# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The tables of docs/limits.md, from franka_core/limits.h.

`python3 docs/site/write_limits.py` writes them into the page; tests/test_robot_limits.py compares them.
"""

import math
import re
from pathlib import Path

from docsite.markdown import table
from docsite.paths import DOCS, WORKSPACE

HEADER = WORKSPACE / "libfranka" / "include" / "franka_core" / "limits.h"
PAGE = DOCS / "limits.md"
BEGIN, END = "<!-- begin of the table {} -->", "<!-- end of the table -->"
# Tables of the header, and the robots that have these limits.
ROBOTS = {"kFerLimits": "Panda", "kFr3Limits": "FR3", "kFr3LimitsBefore59": "FR3 before system 5.9"}
VELOCITY_LIMITS = {
    "kFr3PositionVelocityLimitsFrom59": "FR3",
    "kFr3PositionVelocityLimits": "FR3 before system 5.9",
}
JOINT_ROWS = {
    "q_min": "lowest position [rad]",
    "q_max": "highest position [rad]",
    "dq": "velocity [rad/s]",
    "ddq": "acceleration [rad/s²]",
    "dddq": "jerk [rad/s³]",
    "tau": "torque [Nm]",
    "dtau": "torque rate [Nm/s]",
}
CARTESIAN_ROWS = {
    "translation": ("translation of EE", "m"),
    "rotation": ("rotation of EE", "rad"),
    "elbow": ("elbow, that is joint 3", "rad"),
}
VELOCITY_ROWS = {
    "velocity": "V [rad/s]",
    "offset": "o [rad/s]",
    "deceleration": "c [rad/s²]",
    "q_min": "q_min [rad]",
    "q_max": "q_max [rad]",
}
# Distances from the end of a joint for which a table gives the velocity limit [rad].
DISTANCES = (0.0, 0.05, 0.1, 0.2, 0.3, 0.5, 0.8, 1.0, 1.5)

# The function that makes a table: ferLimits() that of kFerLimits.
TABLE = re.compile(r"constexpr (\w+) (\w+)\(\) \{\s*\1 \w+(?: = (k\w+)|\{\});(.*?)return \w+;", re.S)
FIELD = re.compile(r"\b\w+\.(\w+) = (?:(k\w+)\.(\w+)|\{+([^}]*)\}+|([-\d.]+));")


def read_tables(header: str) -> dict[str, dict[str, list[float]]]:
    """The tables of named fields in the header's text; a number is a list of one."""
    tables: dict[str, dict[str, list[float]]] = {}
    for _, function, base, body in TABLE.findall(header):
        fields = dict(tables[base]) if base else {}
        for field, other, of_other, numbers, number in FIELD.findall(body):
            values = [float(each) for each in (numbers or number).split(",")] if not other else []
            fields[field] = tables[other][of_other] if other else values
        tables["k" + function[0].upper() + function[1:]] = fields
    return tables


def shown(number: float) -> str:
    """A number as the header writes it, or with up to four digits after the point."""
    return f"{number:.5f}".rstrip("0").rstrip(".").replace("-", "−")


def joint_table(limits: dict[str, list[float]], rows: dict[str, str]) -> str:
    head = ("joint", *map(str, range(1, 8)))
    return table(head, [(title, *map(shown, limits[field])) for field, title in rows.items()])


def cartesian_table(tables: dict[str, dict[str, list[float]]]) -> str:
    rows = []
    for field, (what, unit) in CARTESIAN_ROWS.items():
        for name in ("kFerLimits", "kFr3Limits"):
            units = (f"{unit}/s", f"{unit}/s²", f"{unit}/s³")
            velocity, *others = tables[name][field]
            if field == "elbow":  # the field's own velocity is that of the client's rate limiter
                velocity = max(velocity, *tables[name]["documented_elbow_velocity"])
            numbers = [f"{shown(number)} {each}" for number, each in zip((velocity, *others), units)]
            rows.append((what, ROBOTS[name], *numbers))
    return table(("quantity", "robot", "velocity", "acceleration", "jerk"), rows)


def upper_velocity(limits: dict[str, list[float]], joint: int, q: float) -> float:
    """The highest velocity of a joint (0 to 6) of an FR3 at a position."""
    room = max(0.0, limits["deceleration"][joint] * (limits["q_max"][joint] - q))
    return min(limits["velocity"][joint], max(0.0, math.sqrt(room) - limits["offset"][joint]))


def near_the_end(limits: dict[str, list[float]]) -> str:
    """Velocity limits at distances from the upper end of each joint."""
    rows = []
    for distance in DISTANCES:
        values = [upper_velocity(limits, joint, limits["q_max"][joint] - distance) for joint in range(7)]
        rows.append((f"{shown(distance)} rad", *(f"{value:.2f}" for value in values)))
    return table(("distance from the end", *(f"joint {joint}" for joint in range(1, 8))), rows)


def all_tables(header: str) -> dict[str, str]:
    """The tables of the page by their names."""
    tables = read_tables(header)
    found = {
        f"joints of the {robot}": joint_table(tables[name], JOINT_ROWS)
        for name, robot in ROBOTS.items()
        if name != "kFr3LimitsBefore59"
    }
    ends = {field: JOINT_ROWS[field] for field in ("q_min", "q_max")}
    found["positions of an FR3 before system 5.9"] = joint_table(tables["kFr3LimitsBefore59"], ends)
    found["Cartesian limits"] = cartesian_table(tables)
    for name, robot in VELOCITY_LIMITS.items():
        found[f"parameters of the {robot}"] = joint_table(tables[name], VELOCITY_ROWS)
    found["velocities near the end"] = near_the_end(tables["kFr3PositionVelocityLimitsFrom59"])
    return found


def with_tables(page: str, tables: dict[str, str]) -> str:
    """The page's text with these tables between their marks.

    Raises ValueError for a table without a place, or a place without a table.
    """
    places = re.findall(re.escape(BEGIN).replace(r"\{\}", "(.*?)"), page)
    if sorted(places) != sorted(tables):
        raise ValueError(f"The page has places for {sorted(places)}, the tables are {sorted(tables)}.")
    for name, text in tables.items():
        mark = BEGIN.format(name)
        pattern = re.escape(mark) + r"\n.*?" + re.escape(END)
        (now,) = re.findall(pattern, page, flags=re.S)
        page = page.replace(now, f"{mark}\n{text}{END}")
    return page


def expected_page(page: Path = PAGE) -> str:
    return with_tables(page.read_text(), all_tables(HEADER.read_text()))
