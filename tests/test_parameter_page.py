# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""docs/franka_control.md names exactly the parameters that the sources of the hardware nodes read."""

import re
from pathlib import Path

import pytest

TOP = Path(__file__).resolve().parent.parent
SOURCE = TOP / "catkin_ws" / "src"

# Code that reads a parameter in C++ and Python: from a node handle, or with helpers that report errors.
READS = [
    re.compile(r'(?:nh_?|handle)\.(?:param|getParam|getParamCached|hasParam)(?:<[^>]*>)?\(\s*"([\w/]+)"'),
    re.compile(r'searchParam\(\s*"([\w/]+)"'),
    re.compile(r'require\(\w+,\s*"([\w/]+)"'),
    re.compile(r'readFlag\(\s*"([\w/]+)"'),
    re.compile(r'(?:required|number)\(\s*"([\w/]*\w)"'),
    re.compile(r'rospy\.get_param\("~([\w/]+)"'),
]
# Composed names: the literal in the source, and the parameter's full name.
PARTS = [
    (re.compile(r'readThresholds\(nh,\s*"(\w+)"'), "collision_config/"),
    (re.compile(r'tolerance\("(\w+)"\)'), "default_grasp_epsilon/"),
]
SECTIONS = {
    "Parameters of an arm": [
        "franka_hw/src/franka_hw_parameters.cpp",
        "franka_hw/src/reconnection.cpp",
        "franka_hw/src/abort_reporter.cpp",
    ],
    "franka_control_node": [
        "franka_control/src/control_node.cpp",
        "franka_control/src/end_in_time.cpp",
    ],
    "franka_combined_control_node": [
        "franka_control/src/franka_combined_control_node.cpp",
        "franka_control/src/end_in_time.cpp",
        "ros_control/combined_robot_hw/src/load_members.cpp",
    ],
    "franka_gripper_node": ["franka_gripper/src/franka_gripper/gripper_node.py"],
}
# Also read by another node, and explained in its section.
ELSEWHERE = {"franka_control_node": {"arm_id"}, "franka_gripper_node": {"default_grasp_epsilon"}}


def read_by(files) -> set[str]:
    text = "\n".join((SOURCE / file).read_text() for file in files)
    names = {name for pattern in READS for name in pattern.findall(text)}
    return names | {whole + name for pattern, whole in PARTS for name in pattern.findall(text)}


def documented(section: str) -> set[str]:
    page = (TOP / "docs" / "franka_control.md").read_text()
    text = re.search(rf"^## {section}\n(.*?)(?=^## |\Z)", page, re.M | re.S).group(1)
    table = re.search(r"^\| parameter \|.*?(?:\n\n|\Z)", text, re.M | re.S).group(0)
    return set(re.findall(r"^\| `([\w/]+)` \|", table, re.M))


@pytest.mark.parametrize("section", SECTIONS)
def test_the_page_lists_the_parameters_of_the_sources(section):
    assert documented(section) == read_by(SECTIONS[section]) - ELSEWHERE.get(section, set())
