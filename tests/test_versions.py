# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""One version per release, in every package of ours, in CMake and in the changelog."""

import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

TOP = Path(__file__).resolve().parent.parent
SOURCE = TOP / "catkin_ws" / "src"

# Packages that replace an original have the version of the original whose interface they have:
# CMake and package.xml of other packages may require it by find_package(Franka 0.9) or version_gte.
ORIGINALS = {
    "libfranka": "0.9.2",
    # franka_ros
    "franka_control": "0.10.2",
    "franka_description": "0.10.2",
    "franka_example_controllers": "0.10.2",
    "franka_gazebo": "0.10.2",
    "franka_gripper": "0.10.2",
    "franka_hw": "0.10.2",
    "franka_msgs": "0.10.2",
    "franka_ros": "0.10.2",
    "franka_visualization": "0.10.2",
    "xacro": "2.1.1",
    "control_msgs": "1.5.2",
    "control_toolbox": "1.19.0",
    "realtime_tools": "1.16.1",
    # Gazebo's ROS packages
    "gazebo_msgs": "2.9.2",
    "gazebo_ros": "2.9.2",
    # ros_control
    "combined_robot_hw": "0.20.0",
    "controller_interface": "0.20.0",
    "controller_manager": "0.20.0",
    "controller_manager_msgs": "0.20.0",
    "hardware_interface": "0.20.0",
    "joint_limits_interface": "0.20.0",
    "transmission_interface": "0.20.0",
    # ros_controllers
    "effort_controllers": "0.21.2",
    "forward_command_controller": "0.21.2",
    "gripper_action_controller": "0.21.2",
    "joint_state_controller": "0.21.2",
    "joint_trajectory_controller": "0.21.2",
    "position_controllers": "0.21.2",
    "velocity_controllers": "0.21.2",
}


def versions() -> dict[str, str]:
    """Version of each package of the workspace, without those that are test data."""
    files = [path for path in SOURCE.glob("**/package.xml") if "test" not in path.relative_to(SOURCE).parts]
    # A glob does not follow the link that brings this one into the workspace.
    roots = [ElementTree.parse(path).getroot() for path in [*files, TOP / "python" / "package.xml"]]
    return {root.findtext("name"): root.findtext("version") for root in roots}


RELEASE = versions()["franka_sim"]


@pytest.mark.parametrize("package, version", sorted(versions().items()))
def test_package_has_the_version_of_the_release_or_of_its_original(package, version):
    assert version == ORIGINALS.get(package, RELEASE)


@pytest.mark.parametrize("package", ["franka_sim", "libfranka"])
def test_cmake_project_has_the_version_of_its_package(package):
    text = (SOURCE / package / "CMakeLists.txt").read_text(encoding="utf-8")
    project = re.search(rf"^project\({package} VERSION (\S+)", text, re.MULTILINE)
    assert project.group(1) == versions()[package]


def test_changelog_begins_with_the_section_of_the_release():
    headings = re.findall(r"^## (.*)$", (TOP / "CHANGELOG.md").read_text(encoding="utf-8"), re.MULTILINE)
    assert headings[0].split()[0] == RELEASE
