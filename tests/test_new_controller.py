# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A package from new_controller builds, loads, and its rostest passes; invalid arguments are refused."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from overlay import Overlay
from tutorial import read

TOP = Path(__file__).resolve().parent.parent
DEVEL = TOP / "catkin_ws" / "devel"
PROGRAM = DEVEL.parent / "src/franka_example_controllers/scripts/new_controller"
NEW = "rosrun franka_example_controllers new_controller"

PACKAGES = {"my_pose_and_torque": "MyController --interfaces cartesian_pose effort"}
if os.environ.get("FRANKA_TEST_LONG"):
    PACKAGES["my_torques"] = "MyTorques --interfaces effort"
    PACKAGES["my_velocities"] = "MyVelocities --interfaces joint_velocity"
    PACKAGES["my_torque_script"] = "MyTorqueLaw --interfaces effort --python"


@pytest.mark.parametrize("name", PACKAGES)
def test_package_builds_and_its_test_passes(name, tmp_path):
    overlay = Overlay(DEVEL, tmp_path / name, tmp_path)
    created = overlay.shell(f"{NEW} {name} {PACKAGES[name]} --folder {tmp_path}", DEVEL, 60)
    assert created.returncode == 0, created.stderr
    overlay.build()
    (test,) = (tmp_path / name / "test").glob("*.test")
    result = overlay.shell(f"rostest --text {name} {test.name}", tmp_path / "devel", 300)
    assert result.returncode == 0, result.stdout[-4000:] + result.stderr[-2000:]


def test_the_printed_command_succeeds_and_fails_with_the_test(tmp_path):
    sources = tmp_path / "src"
    sources.mkdir()
    overlay = Overlay(DEVEL, sources / "my_script", tmp_path)
    create = f"{NEW} my_script MyLaw --interfaces joint_velocity --python --folder {sources}"
    created = overlay.shell(create, DEVEL, 60)
    assert created.returncode == 0, created.stderr
    printed = created.stdout.strip().splitlines()[-1]
    on_page = read(TOP / "docs/how_to/shell.md").block_with("catkin_test_results").strip()
    assert printed.endswith(on_page.replace("my_package", "my_script"))
    command = f"cd {tmp_path} && {printed}"
    green = overlay.shell(command, DEVEL, 300)
    assert green.returncode == 0, green.stdout[-4000:] + green.stderr[-2000:]
    (test,) = (sources / "my_script" / "test").glob("*.test")
    test.write_text('<launch><test test-name="fails" pkg="my_script" type="no_such_test.py"/></launch>')
    red = overlay.shell(command, DEVEL, 120)
    assert red.returncode != 0, red.stdout[-4000:] + red.stderr[-2000:]
    assert "1 failures" in red.stdout + red.stderr or "1 errors" in red.stdout + red.stderr


@pytest.mark.parametrize(
    "arguments, why",
    [
        ("two MyController --interfaces joint_position joint_velocity", "one motion"),
        ("Bad-Name MyController --interfaces effort", "package"),
        ("fine notAClass! --interfaces effort", "class"),
        ("fine MyController --interfaces hover", "hover"),
    ],
)
def test_invalid_arguments_are_refused(arguments, why, tmp_path):
    command = [sys.executable, PROGRAM, *arguments.split(), "--folder", tmp_path]
    result = subprocess.run(command, text=True, capture_output=True, timeout=60)
    assert result.returncode != 0
    assert why in result.stderr.lower(), result.stderr
    assert "Traceback" not in result.stderr
    assert not list(tmp_path.glob("*/package.xml"))
