# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""package.xml names every dependency that CMake requires, by rosdep's key where there is one."""

import re
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from pathlib import Path

import pytest
from docsite.packages import Package, packages

# rosdep's keys of what is not a ROS package. None: rosdep has no key; a comment of package.xml names it.
KEYS = {
    "ASSIMP": "assimp-dev",
    "CLI11": "cli11",
    "Eigen3": "eigen",
    "Franka": "libfranka",
    "FrankaCore": "libfranka",
    "FrankaSim": "franka_sim",
    "GL/osmesa.h": "libosmesa6-dev",
    "GLFW": "libglfw3-dev",
    "PkgConfig": "pkg-config",
    "Python": "python3-dev",
    "TBB": "tbb",
    "TINYXML2": "tinyxml2",
    "TinyXML": "tinyxml",
    "meshoptimizer": None,
    "mujoco": None,
    "mujoco/mujoco.h": None,
    "orocos_kdl": "liborocos-kdl-dev",
    "pybind11": "pybind11-dev",
    "tinyxml": "tinyxml",
    "tinyxml.h": "tinyxml",
    "tinyxml2": "tinyxml2",
    "urdfdom": "liburdfdom-dev",
    "urdfdom_headers": "liburdfdom-headers-dev",
    "yaml-cpp": "yaml-cpp",
}
OF_COMPILERS = {"Threads"}
OPTIONAL = re.compile(r"CATKIN_ENABLE_TESTING|FRANKA_BUILD_(BENCH|TESTS)")
CALL = re.compile(
    r"\b(?:(if|endif)\s*(\(.*)|(find_package|pkg_check_modules|find_path|find_library)\s*\(([^()]*)\))"
)
FOR_BUILDS = ("build_depend", "buildtool_depend", "depend")


def required(text: str) -> Iterator[str]:
    """What a CMakeLists.txt requires, but for tests and benchmarks: catkin's components and other names."""
    conditions: list[bool] = []
    for block, condition, command, arguments in CALL.findall(re.sub(r"#.*", "", text)):
        words = arguments.split()
        if block == "if":
            conditions.append(bool(OPTIONAL.search(condition)))
        elif block == "endif":
            conditions.pop()
        elif "REQUIRED" not in words or any(conditions):
            continue
        elif words[0] == "catkin":
            yield from ("catkin", *words[words.index("REQUIRED") + 1 :])
        else:
            yield words[1] if command in ("find_path", "find_library") else words[0]


def missing(package: Package) -> list[str]:
    """What CMake requires and package.xml does not name."""
    text = (package.folder / "package.xml").read_text(encoding="utf-8")
    root = ET.fromstring(text)
    keys = {element.text for kind in FOR_BUILDS for element in root.findall(kind)}
    found = []
    for name in required((package.folder / "CMakeLists.txt").read_text(encoding="utf-8")):
        key = KEYS.get(name, name)
        in_comment = key is None and re.search(rf"<!--[^>]*\b{name.partition('/')[0]}\b", text, re.I)
        if name not in OF_COMPILERS | {"COMPONENTS"} and key not in keys and not in_comment:
            found.append(f"{name}: {key}")
    return found


@pytest.mark.parametrize("package", packages(), ids=lambda package: package.name)
def test_package_xml_names_what_cmake_requires(package):
    assert not missing(package)


def test_a_missing_dependency_is_found(tmp_path):
    (tmp_path / "CMakeLists.txt").write_text(
        "find_package(catkin REQUIRED COMPONENTS roscpp\n  tf)  # find_package(Other REQUIRED)\n"
        "find_package(Eigen3 REQUIRED)\nfind_library(MUJOCO_LIBRARY mujoco REQUIRED)\n"
        "if(CATKIN_ENABLE_TESTING)\n  find_package(rostest REQUIRED)\nendif()\n"
    )
    (tmp_path / "package.xml").write_text("<package><depend>roscpp</depend><depend>catkin</depend></package>")
    assert missing(Package("arm", Path(tmp_path), "")) == ["tf: tf", "Eigen3: eigen", "mujoco: None"]
