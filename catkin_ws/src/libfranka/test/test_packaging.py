# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""find_package(Franka) under catkin_make, catkin build and plain CMake (decision 30).

The short form builds under catkin_make, and beside another libfranka.
"""

import pathlib
import subprocess

import pytest

SCRIPT = pathlib.Path(__file__).with_name("packaging_test.sh")


OF_LONG = [
    pytest.param(name, marks=pytest.mark.long_form("builds the library again"))
    for name in ("catkin_build", "plain")
]


@pytest.mark.parametrize("build", ["catkin_make", "vendor", *OF_LONG])
def test_consumer_finds_franka(build):
    result = subprocess.run([str(SCRIPT), build], capture_output=True, text=True, timeout=600)
    assert result.returncode == 0, result.stdout + result.stderr
