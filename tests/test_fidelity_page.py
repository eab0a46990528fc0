# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""docs/fidelity.md: each line has its kind and names existing tests."""

import re
from pathlib import Path

import pytest

TOP = Path(__file__).resolve().parent.parent
SOURCES = TOP / "catkin_ws/src"
TEST = re.compile(r"`((?:[A-Z]\w*\.[A-Za-z]\w*)|(?:test_\w+(?:\.py)?))`")
KINDS = {"physics", "exact", "approximation"}


def lines():
    """Table rows and list items, the latter joined."""
    found = []
    for line in (TOP / "docs/fidelity.md").read_text().splitlines():
        if line.startswith(("| ", "* ")) and not line.endswith("held by |"):
            found.append(line)
        elif line.startswith("  ") and found:
            found[-1] += " " + line.strip()
    return found


@pytest.fixture(scope="module")
def known():
    """The names of all tests."""
    names = set()
    for file in SOURCES.rglob("*_test.cpp"):
        cases = re.findall(r"^TEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\)", file.read_text(), re.MULTILINE)
        names.update(f"{suite}.{case}" for suite, case in cases)
    for folder in (SOURCES, TOP / "python", TOP / "tests"):
        for file in folder.rglob("*test*.py"):
            names.add(file.name)
            names.update(re.findall(r"^ *def (test_\w+)\(", file.read_text(), re.MULTILINE))
    return names


@pytest.mark.parametrize("line", lines(), ids=lambda line: line[2:34])
def test_each_line_cites_existing_tests(line, known):
    named = TEST.findall(line)
    assert named, "No test holds it."
    assert [name for name in named if name not in known] == []


def test_rows_have_a_known_kind():
    for line in lines():
        cells = [cell.strip() for cell in line.strip("|").split(" | ")]
        if len(cells) == 4:
            assert cells[1] in KINDS, line
