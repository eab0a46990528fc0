# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The tables of docs/limits.md are those of franka_core/limits.h, which the programs are compiled with."""

import re

import numpy as np
import pyfranka
import pytest
from docsite import robot_limits
from docsite.paths import TOP

VERSIONS = {"kFerLimits": 5, "kFr3LimitsBefore59": 9, "kFr3Limits": 10}
VELOCITY_LIMITS = {"kFr3PositionVelocityLimits": 9, "kFr3PositionVelocityLimitsFrom59": 10}
HEADER = robot_limits.HEADER.read_text()


def test_the_page_has_the_tables_of_the_header():
    expected = robot_limits.expected_page()
    assert robot_limits.PAGE.read_text() == expected, "run python3 docs/site/write_limits.py"


def test_a_changed_limit_changes_the_page():
    page = robot_limits.PAGE.read_text()
    for old, new in (
        ("arm.dtau = {{1000.0", "arm.dtau = {{900.0"),
        ("limits.offset = {{0.30", "limits.offset = {{0.31"),
    ):
        assert old in HEADER
        assert robot_limits.with_tables(page, robot_limits.all_tables(HEADER.replace(old, new))) != page


def test_a_table_without_a_place_is_refused():
    page = robot_limits.PAGE.read_text().replace("table Cartesian limits", "table other limits")
    with pytest.raises(ValueError, match="other limits"):
        robot_limits.with_tables(page, robot_limits.all_tables(HEADER))


@pytest.mark.parametrize("name", VERSIONS)
def test_the_tables_are_those_of_the_compiled_programs(name):
    read, compiled = robot_limits.read_tables(HEADER)[name], pyfranka.ArmLimits(VERSIONS[name])
    for field in (*robot_limits.JOINT_ROWS, "translation", "rotation"):
        assert list(getattr(compiled, field)) == read[field], field


@pytest.mark.parametrize("name", VELOCITY_LIMITS)
def test_the_formula_of_the_page_is_that_of_the_compiled_programs(name):
    limits = robot_limits.read_tables(HEADER)[name]
    compiled = pyfranka.ArmLimits(VELOCITY_LIMITS[name])
    for share in np.linspace(-0.1, 1.1, 50):
        q = np.array(limits["q_min"]) + share * (np.array(limits["q_max"]) - limits["q_min"])
        lower, upper = compiled.velocity_range(q)
        expected = [robot_limits.upper_velocity(limits, joint, q[joint]) for joint in range(7)]
        assert upper == pytest.approx(expected, rel=1e-12, abs=1e-12)
        mirrored = np.array(limits["q_max"]) + limits["q_min"] - q
        assert -lower == pytest.approx(
            [robot_limits.upper_velocity(limits, joint, mirrored[joint]) for joint in range(7)],
            rel=1e-9,
            abs=1e-9,
        )


def test_the_page_shows_every_limit_of_the_header():
    """Each field of the tables is shown, or is for programs only."""
    shown = {*robot_limits.JOINT_ROWS, *robot_limits.CARTESIAN_ROWS, *robot_limits.VELOCITY_ROWS}
    # Velocities of a data sheet (shown where the robot checks them), and of an old rate limiter.
    for_programs = {"documented_translation_velocity", "documented_elbow_velocity", "rate_limiter_dq"}
    tables = robot_limits.read_tables(HEADER)
    assert len(tables) == len(re.findall(r"= \[\] \{", HEADER))
    assert {field for fields in tables.values() for field in fields} == shown | for_programs


@pytest.mark.parametrize(
    "page",
    [
        "README.md",
        "docs/tutorials/libfranka_programs.md",
        "docs/tutorials/real_robot.md",
        "docs/how_to/plots.md",
    ],
)
def test_pages_that_promise_the_limits_link_them(page):
    assert re.search(r"\]\([^)]*(?<!design/)limits\.md\)", (TOP / page).read_text())
