# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The properties find faults that are put back: data/seeded_faults holds one patch each.

Prints how many sequences each one took.
"""

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

TOP = Path(__file__).resolve().parent.parent
UNIT = "catkin_ws/src/franka_sim/src/robot"
PROGRAM = "franka_sim_robot_properties_test"
# Sources of a fault, and the file whose sequences find it; that of the unit is a program of its own.
MACHINES = {
    "catkin_ws/src/franka_hw": "tests/test_node_properties.py",
    "catkin_ws/src/ros_control": "tests/test_cell_properties.py",
    "catkin_ws/src/franka_sim_mujoco": "tests/test_cell_properties.py",
}

# Variables of this run's workspace, and of its pytest.
OF_THIS_RUN = re.compile(
    r"PYTEST_|ROS_|CMAKE_PREFIX_PATH|PYTHONPATH|LD_LIBRARY_PATH|PKG_CONFIG_PATH|FRANKA_TEST_"
)

builds = pytest.mark.long_form("builds what has a fault once for each of them")
pytestmark = pytest.mark.timeout(7200)


def patches(*sources: str) -> list:
    """Those that change one of these folders."""
    found = sorted((TOP / "tests" / "data" / "seeded_faults").glob("*.patch"))
    return [
        pytest.param(path, id=path.stem)
        for path in found
        if any(f"+++ b/{source}/" in path.read_text(encoding="utf-8") for source in sources)
    ]


@pytest.mark.parametrize("patch", patches(UNIT, *MACHINES))
def test_a_fault_fits_the_sources(patch):
    run("patch", "--dry-run", "--force", "-p1", "-i", patch, cwd=TOP)


def run(*command, check=True, **options):
    return subprocess.run(
        list(map(str, command)),
        **{"text": True, "check": check, "timeout": 3600, "stdout": subprocess.PIPE} | options,
    ).stdout


def seeded(copy: Path, patch: Path, build, search) -> str:
    """What the search prints in sources with this fault."""
    run("patch", "-p1", "-i", patch, cwd=copy)
    try:
        build()
        return search()
    finally:
        run("patch", "-R", "-p1", "-i", patch, cwd=copy)


@pytest.fixture(scope="module")
def unit(tmp_path_factory):
    """Sources of the control unit, and their tests configured."""
    top = tmp_path_factory.mktemp("unit")
    for folder in ("catkin_ws/src/franka_sim", "catkin_ws/src/libfranka", "tests"):
        shutil.copytree(TOP / folder, top / folder, symlinks=True)
    run("cmake", "-S", top / "catkin_ws/src/franka_sim", "-B", top / "build", "-DFRANKA_BUILD_TESTS=ON")
    return top


@builds
@pytest.mark.parametrize("patch", patches(UNIT))
def test_a_fault_of_the_control_unit_is_found(unit, patch, monkeypatch):
    monkeypatch.setenv("RC_PARAMS", "seed=1 max_success=2000 max_size=40")  # those of the gate
    printed = seeded(
        unit,
        patch,
        build=lambda: run("cmake", "--build", unit / "build", "--target", PROGRAM, "-j2"),
        search=lambda: run(unit / "build" / PROGRAM, check=False),
    )
    found = re.findall(r"Falsifiable after (\d+) tests?", printed)
    print(f"{patch.stem}: found after {found} sequences")
    assert found, printed[-3000:]


def environment() -> dict[str, str]:
    """That of a terminal in which no workspace is set up."""
    return {name: value for name, value in os.environ.items() if not OF_THIS_RUN.match(name)}


@pytest.fixture(scope="module")
def workspace(tmp_path_factory):
    """A copy of the project, built."""
    top = tmp_path_factory.mktemp("workspace") / "main"
    for name in run("git", "ls-files", "-z", cwd=TOP).rstrip("\0").split("\0"):
        (top / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(TOP / name, top / name, follow_symlinks=False)
    run(top / "franka", "build", cwd=top, env=environment())
    return top


@builds
@pytest.mark.parametrize("patch", patches(*MACHINES))
def test_a_fault_of_the_workspace_is_found(workspace, patch):
    text = patch.read_text(encoding="utf-8")
    machine = next(file for source, file in MACHINES.items() if f"+++ b/{source}/" in text)
    pytest_of_this_run = [TOP / ".venv/bin/python3", "-m", "pytest", "-q", "-k", "not random", machine]
    printed = seeded(
        workspace,
        patch,
        build=lambda: run(workspace / "franka", "build", cwd=workspace, env=environment()),
        search=lambda: run(
            workspace / "franka", "shell", *pytest_of_this_run, cwd=workspace, env=environment(), check=False
        ),
    )
    found = re.findall(r"Found in sequence \d+ after \d+ steps in all", printed)
    print(f"{patch.stem}: {found}")
    assert found, printed[-3000:]
