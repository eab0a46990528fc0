# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Paths and names of the original that existing launch files, builds and programs use exist here."""

import os
import subprocess
from pathlib import Path

import pytest
import rospkg

FILES = {
    "franka_example_controllers": [
        "launch/robot.rviz",
        "launch/rviz/franka_description_with_marker.rviz",
        "launch/rviz/franka_dual_description_with_marker.rviz",
        "launch/rviz/teleop_joint_pd_example.rviz",
    ],
    "franka_gazebo": [
        "config/franka_hw_sim.yaml",
        "config/sim_controllers.yaml",
        "franka_gripper_sim_plugin.xml",
        "franka_hw_sim_plugin.xml",
        "include/franka_gazebo/controller_verifier.h",
        "include/franka_gazebo/franka_gripper_sim.h",
        "include/franka_gazebo/franka_hw_sim.h",
        "include/franka_gazebo/joint.h",
        "include/franka_gazebo/model_kdl.h",
        "include/franka_gazebo/statemachine.h",
        "launch/fr3.launch",
        "launch/panda.launch",
        "launch/robot.launch",
        *(
            f"models/{model}/{file}"
            for model in ("pick_tray", "place_tray", "stone", "table")
            for file in ("model.config", "model.sdf")
        ),
        "world/stone.sdf",
    ],
    "franka_visualization": [
        "config/gripper_settings.yaml",
        "config/robot_settings.yaml",
        "launch/franka_visualization.launch",
        "launch/franka_visualization.rviz",
        "splash.png",
    ],
}


@pytest.mark.parametrize("package", FILES)
def test_files_are_at_the_originals_paths(package):
    folder = rospkg.RosPack().get_path(package)
    assert [name for name in FILES[package] if not os.path.isfile(f"{folder}/{name}")] == []


def exported(package: str, attribute: str) -> set[str]:
    """Exports of packages for another one, as `package value`."""
    command = ["rospack", "plugins", f"--attrib={attribute}", package]
    return set(subprocess.run(command, text=True, capture_output=True, check=True).stdout.splitlines())


def test_franka_gazebo_exports_models_and_worlds():
    folder = rospkg.RosPack().get_path("franka_gazebo")
    assert f"franka_gazebo {folder}/models" in exported("gazebo_ros", "gazebo_model_path")
    assert f"franka_gazebo {folder}/world" in exported("gazebo_ros", "gazebo_resource_path")


@pytest.mark.parametrize(
    "package, file",
    [
        ("controller_interface", "franka_gripper_sim_plugin.xml"),
        ("gazebo_ros_control", "franka_hw_sim_plugin.xml"),
    ],
)
def test_franka_gazebo_exports_its_plugins_as_the_original(package, file):
    manifest = rospkg.RosPack().get_manifest("franka_gazebo")
    folder = rospkg.RosPack().get_path("franka_gazebo")
    assert manifest.get_export(package, "plugin") == [f"{folder}/{file}"]


def test_pkg_config_knows_every_package():
    """With all that they require: Debian's pluginlib and angles have no pkg-config files."""
    folder = Path(__file__).resolve().parent.parent / "catkin_ws" / "devel" / "lib" / "pkgconfig"
    names = sorted(path.stem for path in folder.glob("*.pc"))
    assert {"franka_hw", "joint_trajectory_controller"} <= set(names)
    command = ["pkg-config", "--print-errors", "--cflags", "--libs", *names]
    result = subprocess.run(command, text=True, capture_output=True)
    assert result.returncode == 0, result.stderr
    assert {"-lfranka_hw", "-lclass_loader"} <= set(result.stdout.split())


def test_packages_find_libraries_and_headers_of_franka_gazebo(tmp_path):
    (tmp_path / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.16)\nproject(consumer CXX)\nfind_package(franka_gazebo REQUIRED)\n"
        'message(STATUS "found ${franka_gazebo_LIBRARIES};${franka_gazebo_INCLUDE_DIRS}")\n'
    )
    command = ["cmake", "-S", str(tmp_path), "-B", str(tmp_path / "build")]
    result = subprocess.run(command, text=True, capture_output=True)
    assert result.returncode == 0, result.stderr
    found = next(line for line in result.stdout.splitlines() if line.startswith("-- found ")).split(";")
    for library in ("franka_gazebo", "franka_hw_sim", "franka_gripper_sim"):
        assert any(path.endswith(f"/lib{library}.so") for path in found), found
    assert any(os.path.isfile(f"{path}/franka_gazebo/joint.h") for path in found)
