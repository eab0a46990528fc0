# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Installed packages are complete, and work without the source tree's environment: the demo runs."""

import json
import os
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest
from docsite.packages import Package, packages
from docsite.paths import WORKSPACE

DATA = [f"{folder}/*.*" for folder in ("launch", "config", "worlds", "msg", "srv", "action", "templates")]
DATA += ["robots/**/*.*", "python/*.py", "*plugin*.xml"]
installs = pytest.mark.long_form("builds the install space")


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


@installs
def test_demo_runs_from_the_install_space(installed, tmp_path):
    result = in_install_space(
        installed,
        f"rosrun franka_sim_mujoco pick_and_place --start --speed 0 --output {tmp_path}/demo",
        tmp_path,
    )
    assert result.returncode == 0, result.stdout + result.stderr
    assert json.loads((tmp_path / "demo" / "report.json").read_text())[0]["in_tray"]


def places(package: Package, prefix: Path) -> Iterator[tuple[Path, list[Path]]]:
    """The files of a package that users and programs use, and where they may be installed."""
    share, programs = prefix / "share" / package.name, prefix / "lib" / package.name
    for pattern, folder in [*((pattern, share) for pattern in DATA), ("include/**/*.h", prefix)]:
        for file in package.files(pattern):
            yield file, [folder / file.relative_to(package.folder)]
    for file in filter(Path.is_file, package.files("scripts/*")):
        if file.name != "install_page_libraries":  # a step of ./franka install
            yield file, [programs / file.name, prefix / "bin" / file.name]


def test_the_install_rules_have_every_file_of_the_packages(tmp_path):
    """Runs the rules below another root; nothing is built."""
    workspace = WORKSPACE.resolve().parent
    environment = {**os.environ, "DESTDIR": str(tmp_path), "PATH": f"/usr/bin:{os.environ['PATH']}"}
    rules = ["cmake", "-P", workspace / "build" / "cmake_install.cmake"]
    subprocess.run(rules, env=environment, check=True, capture_output=True, timeout=600)
    prefix = tmp_path / (workspace / "install").relative_to("/")
    found = [each for package in packages() for each in places(package, prefix) if each[0].suffix != ".in"]
    assert {"franka_hw_sim.h", "panda.launch", "new_controller"} <= {file.name for file, _ in found}
    assert not [file for file, installed in found if not any(path.exists() for path in installed)]
