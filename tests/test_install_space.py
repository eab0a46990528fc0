# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Installed packages work without the source tree's environment: the demo from the install space."""

import json
import subprocess
from pathlib import Path

import pytest


def in_install_space(
    prefix: Path, command: str, folder: Path, timeout: float = 300
) -> subprocess.CompletedProcess:
    """Runs a shell command with nothing but the install space sourced."""
    clean = {
        "HOME": str(folder),
        "PATH": "/usr/bin:/bin",
        "LANG": "C.UTF-8",
        "ROS_HOSTNAME": "localhost",
        "ROS_HOME": str(folder),
    }
    return subprocess.run(
        ["bash", "-c", f"source {prefix}/setup.bash && {command}"],
        env=clean,
        text=True,
        capture_output=True,
        timeout=timeout,
        stdin=subprocess.DEVNULL,
    )


def test_demo_runs_from_the_install_space(installed, tmp_path):
    result = in_install_space(
        installed,
        f"rosrun franka_sim_mujoco pick_and_place --start --speed 0 --output {tmp_path}/demo",
        tmp_path,
    )
    assert result.returncode == 0, result.stdout + result.stderr
    assert json.loads((tmp_path / "demo" / "report.json").read_text())[0]["in_tray"]


def test_the_sweep_program_runs_from_the_install_space(installed, tmp_path):
    result = in_install_space(installed, "pyfranka-sweep --help", tmp_path)
    assert result.returncode == 0 and "case(index, seed)" in result.stdout, result.stderr


@pytest.mark.parametrize("robot", ["panda", "fr3"])
def test_xacro_runs_from_the_install_space(installed, robot, tmp_path):
    result = in_install_space(
        installed,
        f"xacro $(rospack find franka_description)/robots/{robot}/{robot}.urdf.xacro gazebo:=true hand:=true",
        tmp_path,
    )
    assert result.returncode == 0, result.stderr
    assert f'<link name="{robot}_hand_tcp"' in result.stdout


@pytest.mark.parametrize(
    "header",
    [
        "hardware_interface/robot_hw.h",
        "franka_hw/model_kdl.h",
        "franka_sim/physics/world.h",
        "franka_sim_mujoco/robot_hw_sim.h",
        "franka_gazebo/franka_hw_sim.h",
        "gazebo_msgs/ModelStates.h",
        "pluginlib/class_list_macros.h",
        "controller_manager/controller_manager.h",
        "franka/robot_state.h",
        "franka_msgs/FrankaState.h",
        "control_toolbox/pid.h",
    ],
)
def test_headers_are_installed(installed, header):
    assert (installed / "include" / header).exists()
