# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The tables of docs/limits.md are those of franka_core/limits.h, which the programs are compiled with."""

import numpy as np
import pyfranka
import pytest
from docsite import robot_limits

VERSIONS = {"kFerLimits": 5, "kFr3LimitsBefore59": 9, "kFr3Limits": 10}
VELOCITY_LIMITS = {"kFr3PositionVelocityLimits": 9, "kFr3PositionVelocityLimitsFrom59": 10}
HEADER = robot_limits.HEADER.read_text()


def test_the_page_has_the_tables_of_the_header():
    expected = robot_limits.expected_page()
    assert robot_limits.PAGE.read_text() == expected, "run python3 docs/site/write_limits.py"


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
