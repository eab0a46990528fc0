# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""docs/design/limits.md lists the motions of the limit tests."""

import re
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent.parent
PAGE = PACKAGE.parents[2] / "docs" / "design" / "limits.md"
NUMBER = re.compile(r"-?\d+(?:\.\d+)?")
ROW = re.compile(
    r"\{(\d+), k\w+, \{Part::k(\w+), \{\{([^}]*)\}\}(?:, \{([^}]*)\}([^}]*))?\}, ([\d.]+), (\d+)\}"
)
ROBOTS = {"5": "Panda", "10": "FR3"}


def numbers(text):
    return [float(number) for number in NUMBER.findall(text)]


def rows_of_the_tests():
    source = re.sub(r"\s+", " ", (PACKAGE / "test/robot/limit_ways.h").read_text())
    for protocol, part, start, axis, rod, taken, draws in ROW.findall(source):
        is_round = "true" in rod
        yield (
            ROBOTS[protocol],
            part.lower(),
            numbers(start),
            [] if is_round else numbers(axis),
            float(taken),
            int(draws),
        )


def rows_of_the_page():
    for line in PAGE.read_text().splitlines():
        if line.startswith(("| Panda", "| FR3")):
            robot, limit, start, axis, share, _, draws = (cell.strip() for cell in line.strip("|").split("|"))
            yield robot, limit.split(":")[0], numbers(start), numbers(axis), float(share), int(draws)


def test_the_page_shows_the_rows_of_the_tests():
    expected = list(rows_of_the_tests())
    assert len(expected) == 8
    assert list(rows_of_the_page()) == expected
