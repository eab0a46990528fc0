# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The entry script: its help, its refusals, and the environment it makes."""

import os
import subprocess
from pathlib import Path

import pytest

TOP = Path(__file__).resolve().parent.parent
FRANKA = str(TOP / "franka")


def franka(*arguments: str, **environment: str) -> subprocess.CompletedProcess:
    return subprocess.run(
        [FRANKA, *arguments],
        env={**os.environ, **environment},
        text=True,
        capture_output=True,
        timeout=120,
        stdin=subprocess.DEVNULL,
    )


def in_script(code: str, **environment: str) -> str:
    """Output of shell code that runs with the script's functions."""
    result = subprocess.run(
        ["bash", "-c", f"source {FRANKA}; {code}"],
        env={**os.environ, **environment},
        text=True,
        capture_output=True,
        timeout=60,
    )
    assert result.returncode == 0, result.stderr
    return result.stdout


@pytest.fixture
def foreign_python(tmp_path):
    """A folder whose python3 is good for nothing, as a pyenv or conda without rospy is."""
    python = tmp_path / "python3"
    python.write_text("#!/bin/sh\necho 'the wrong python3 was run' >&2\nexit 1\n")
    python.chmod(0o755)
    return f"{tmp_path}:{os.environ['PATH']}"


@pytest.mark.parametrize("release", ["bookworm", "trixie"])
def test_packages_depend_on_the_release(release):
    names = in_script(f"debian_release() {{ echo {release}; }}; wanted_packages").splitlines()
    assert {"catkin", "libmujoco-dev"} <= set(names)
    assert {"libsdformat-dev", "python3-nose"} & set(names) == (
        {"libsdformat-dev", "python3-nose"} if release == "bookworm" else set()
    )
    assert all(" " not in name and "[" not in name for name in names)


@pytest.mark.parametrize("system", ["ID=ubuntu\nVERSION_CODENAME=noble\nPRETTY_NAME='Ubuntu 24.04'\n", None])
def test_another_system_is_refused_with_a_sentence(tmp_path, system):
    file = tmp_path / "os-release"
    if system:
        file.write_text(system)
    result = subprocess.run(
        ["bash", "-c", f"source {FRANKA}; debian_release {file}"], text=True, capture_output=True, timeout=60
    )
    assert result.returncode == 1 and result.stdout == ""
    assert ("Ubuntu 24.04" if system else "unknown") in result.stderr
    assert "Debian 12 (bookworm) and Debian 13 (trixie)" in result.stderr


def test_help_names_every_command():
    result = franka("--help")
    assert result.returncode == 0
    for command in ("install", "build", "demo", "test", "bench", "shell"):
        assert f"\n  {command} " in result.stdout


def test_unknown_command_is_refused_with_help():
    result = franka("dance")
    assert result.returncode == 2
    assert 'no command "dance"' in result.stderr
    assert "usage:" in result.stderr


def test_no_command_shows_usage_and_fails():
    result = franka()
    assert result.returncode == 2
    assert "usage:" in result.stderr


def test_unknown_package_is_refused_with_those_there_are():
    result = subprocess.run(
        [os.sys.executable, str(TOP / "tests" / "run.py"), "franka_hv"],
        text=True,
        capture_output=True,
        timeout=60,
    )
    assert result.returncode == 2
    assert "franka_hv" in result.stderr and "franka_hw" in result.stderr


def test_wanted_packages_are_names_only():
    names = in_script("wanted_packages").split()
    assert "libmujoco-dev" in names
    assert all(name.isascii() and "#" not in name for name in names)


@pytest.mark.parametrize(
    "command",
    [
        ["python3", "-c", "import rospy, tf2_ros"],
        ["xacro", "--help"],
        ["rosrun", "xacro", "xacro", "--help"],
        ["roslaunch", "--help"],
        ["rosrun", "franka_sim_mujoco", "pick_and_place", "--help"],
    ],
)
def test_shell_works_whatever_python_stands_first(command, foreign_python):
    result = franka("shell", *command, PATH=foreign_python)
    assert result.returncode == 0, result.stdout + result.stderr
    assert "wrong python3" not in result.stderr


def test_shell_keeps_the_status_of_its_command():
    assert franka("shell", "bash", "-c", "exit 7").returncode == 7


def test_originals_make_the_group_step_aside(tmp_path):
    package = tmp_path / "share" / "hardware_interface"
    package.mkdir(parents=True)
    (package / "package.xml").write_text("<package/>")
    left_out = in_script("stand_ins_to_leave_out", CMAKE_PREFIX_PATH=str(tmp_path)).split()
    assert {"hardware_interface", "controller_interface", "controller_manager"} <= set(left_out)
    assert "realtime_tools" not in left_out


def test_a_single_original_steps_aside_alone(tmp_path):
    package = tmp_path / "share" / "control_msgs"
    package.mkdir(parents=True)
    (package / "package.xml").write_text("<package/>")
    assert in_script("stand_ins_to_leave_out", CMAKE_PREFIX_PATH=str(tmp_path)).split() == ["control_msgs"]


def test_our_own_devel_space_is_no_original():
    assert (
        in_script("stand_ins_to_leave_out", CMAKE_PREFIX_PATH=str(TOP / "catkin_ws" / "devel")).split() == []
    )


def build_that_ends_with(message: str, tmp_path: Path) -> str:
    """What the script says of a build whose first attempt fails; its second one tells the number of jobs."""
    (tmp_path / "out").mkdir()
    return in_script(
        f"top={tmp_path}; jobs=2; once() {{"
        f" [ -e $top/failed ] && {{ echo $jobs >$top/jobs; return; }};"
        f" touch $top/failed; echo '{message}'; return 1; }};"
        "building once 2>&1 && cat $top/jobs || echo given up"
    )


def test_a_compiler_that_crashes_is_run_once_more(tmp_path):
    said = build_that_ends_with("a.h:919:5: internal compiler error: Segmentation fault", tmp_path)
    assert "going on with 2 at a time" in said and said.endswith("\n2\n")


def test_a_compiler_that_was_killed_is_given_all_memory(tmp_path):
    said = build_that_ends_with("g++: fatal error: Killed signal terminated program cc1plus", tmp_path)
    assert "going on with 1 at a time" in said and said.endswith("\n1\n")


def test_an_error_of_the_sources_is_not_tried_again(tmp_path):
    said = build_that_ends_with("a.cpp:3: error: expected a sentence", tmp_path)
    assert said.endswith("given up\n") and "expected a sentence" in said
