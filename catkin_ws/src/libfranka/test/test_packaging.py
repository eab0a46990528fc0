# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""find_package(Franka) under catkin_make, catkin build and plain CMake (decision 30)."""

import pathlib
import subprocess

import pytest

SCRIPT = pathlib.Path(__file__).with_name("packaging_test.sh")


@pytest.mark.parametrize("build", ["catkin_make", "catkin_build", "plain", "vendor"])
def test_consumer_finds_franka(build):
    result = subprocess.run([str(SCRIPT), build], capture_output=True, text=True, timeout=600)
    assert result.returncode == 0, result.stdout + result.stderr
