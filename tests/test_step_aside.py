# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Our packages step aside for installed originals: `./franka build` decides, catkin skips them."""

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

TOP = Path(__file__).resolve().parent.parent
SOURCES = TOP / "catkin_ws" / "src"
STAND_INS = SOURCES / "ros_control"


def package_name(folder: Path) -> str:
    return re.search(r"<name>(\w+)</name>", (folder / "package.xml").read_text()).group(1)


def dependencies(folder: Path) -> set[str]:
    """Packages in the depend tags for build and run."""
    text = (folder / "package.xml").read_text()
    return set(re.findall(r"<(?:build_|exec_|build_export_)?depend>(\w+)<", text))


def stand_ins() -> dict[str, Path]:
    return {package_name(path.parent): path.parent for path in STAND_INS.glob("*/package.xml")}


def pretend_installed(prefix: Path, *packages: str) -> None:
    """Creates the visible files of an installed catkin package: package.xml and a CMake config."""
    for package in packages:
        share = prefix / "share" / package
        (share / "cmake").mkdir(parents=True)
        (share / "package.xml").write_text(
            f"<package format='2'><name>{package}</name><version>0.20.0</version>"
            "<description>x</description><maintainer email='a@example.org'>x</maintainer>"
            "<license>BSD</license></package>"
        )
        (share / "cmake" / f"{package}Config.cmake").write_text(f"set({package}_FOUND_AT {prefix})\n")


def decided(prefix_path: str, workspace: Path = TOP / "catkin_ws") -> set[str]:
    """Packages that `./franka build` leaves out with this CMAKE_PREFIX_PATH."""
    result = subprocess.run(
        ["bash", "-c", f"source {TOP / 'franka'}; workspace={workspace}; stand_ins_to_leave_out"],
        env={**os.environ, "CMAKE_PREFIX_PATH": prefix_path},
        text=True,
        capture_output=True,
        timeout=60,
    )
    assert result.returncode == 0, result.stderr
    return set(result.stdout.split())


@pytest.fixture
def originals(tmp_path):
    prefix = tmp_path / "originals"
    pretend_installed(prefix, "hardware_interface")
    return prefix


def test_our_own_spaces_do_not_count_as_originals(tmp_path):
    pretend_installed(tmp_path / "install", "hardware_interface")
    assert decided(str(tmp_path / "install"), workspace=tmp_path) == set()


def test_everything_linked_to_hardware_interface_steps_aside_with_it(originals):
    """The group, found from the dependencies in the package files."""
    ours = stand_ins()
    group = {"hardware_interface"}
    while True:
        grown = group | {name for name, folder in ours.items() if dependencies(folder) & group}
        if grown == group:
            break
        group = grown
    left_out = decided(str(originals))
    assert group - left_out == set(), "these would be built against two hardware_interfaces"
    assert {"controller_manager", "combined_robot_hw", "effort_controllers"} <= left_out
    assert not {"realtime_tools", "control_toolbox", "control_msgs", "xacro"} & left_out
    assert not {package_name(path.parent) for path in SOURCES.glob("franka_*/package.xml")} & left_out


@pytest.mark.parametrize("name", ["realtime_tools", "control_msgs", "control_toolbox", "xacro"])
def test_other_packages_step_aside_one_by_one(tmp_path, name):
    pretend_installed(tmp_path, name)
    assert decided(str(tmp_path)) == {name}


def test_an_empty_folder_does_not_count_as_an_original(tmp_path):
    (tmp_path / "share" / "hardware_interface").mkdir(parents=True)
    assert decided(str(tmp_path)) == set()


def test_every_stand_in_can_step_aside(tmp_path):
    prefix = tmp_path / "originals"
    pretend_installed(prefix, *stand_ins())
    assert set(stand_ins()) - decided(str(prefix)) == set()


def test_the_build_prints_it_and_catkin_skips_the_packages(tmp_path, originals):
    """`configure_and_make` in a workspace of package files only: the message, and the packages in CMake."""
    project = tmp_path / "project"
    copied = project / "catkin_ws" / "src"
    copied.mkdir(parents=True)
    shutil.copy(TOP / "franka", project / "franka")
    for name in ("build_settings.cmake", "compile_commands.py"):
        shutil.copy(TOP / "catkin_ws" / name, copied.parent)
    (copied / "CMakeLists.txt").symlink_to("/usr/share/catkin/cmake/toplevel.cmake")
    for name in ("hardware_interface", "controller_interface", "controller_manager", "realtime_tools"):
        package = copied / name
        package.mkdir()
        shutil.copy(STAND_INS / name / "package.xml", package)
        (package / "CMakeLists.txt").write_text(
            f"cmake_minimum_required(VERSION 3.10)\nproject({name})\n"
            "find_package(catkin REQUIRED)\ncatkin_package()\n"
            f'message(STATUS "BUILT OURS: {name}")\n'
        )
    result = subprocess.run(
        ["bash", "-c", "source franka; configure_and_make OFF OFF --force-cmake"],
        cwd=project,
        env={**os.environ, "CMAKE_PREFIX_PATH": str(originals), "PATH": f"/usr/bin:{os.environ['PATH']}"},
        text=True,
        capture_output=True,
        timeout=240,
    )
    assert result.returncode == 0, result.stdout + result.stderr
    match = re.search(r"This machine has the originals of (.*): ours are left out", result.stdout)
    assert match, result.stdout
    assert {"hardware_interface", "controller_manager"} <= set(match.group(1).split(", "))
    assert re.findall(r"BUILT OURS: (\w+)", result.stdout) == ["realtime_tools"]
