# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The properties of a robot's units find faults that are put back: data/seeded_faults holds one patch each.

Prints how many sequences each one took.
"""

import re
import shutil
import subprocess
from pathlib import Path

import pytest

TOP = Path(__file__).resolve().parent.parent
SOURCES = "catkin_ws/src/franka_sim/src/robot"
PATCHES = [
    path
    for path in sorted((TOP / "tests" / "data" / "seeded_faults").glob("*.patch"))
    if f"+++ b/{SOURCES}" in path.read_text(encoding="utf-8")
]
PROGRAM = "franka_sim_robot_properties_test"

pytestmark = [
    pytest.mark.long_form("builds the control unit once for each fault"),
    pytest.mark.timeout(3600),
]


def run(*command, check=True, **options):
    return subprocess.run(
        list(map(str, command)), text=True, check=check, timeout=1800, stdout=subprocess.PIPE, **options
    ).stdout


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    """Sources of their own, and their tests configured."""
    top = tmp_path_factory.mktemp("sources")
    for folder in ("catkin_ws/src/franka_sim", "catkin_ws/src/libfranka", "tests"):
        shutil.copytree(TOP / folder, top / folder, symlinks=True)
    run("cmake", "-S", top / "catkin_ws/src/franka_sim", "-B", top / "build", "-DFRANKA_BUILD_TESTS=ON")
    return top


@pytest.mark.parametrize("patch", PATCHES, ids=lambda path: path.stem)
def test_a_seeded_fault_is_found(copy, patch, monkeypatch):
    monkeypatch.setenv("RC_PARAMS", "seed=1 max_success=2000 max_size=40")  # those of the gate
    run("patch", "-p1", "-i", patch, cwd=copy)
    try:
        run("cmake", "--build", copy / "build", "--target", PROGRAM, "-j2")
        printed = run(copy / "build" / PROGRAM, check=False)
    finally:
        run("patch", "-R", "-p1", "-i", patch, cwd=copy)
    found = re.findall(r"Falsifiable after (\d+) tests?", printed)
    print(f"{patch.stem}: found after {found} sequences")
    assert found, printed[-3000:]
