# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Every program of the workspace answers --help: at once, without a ROS master."""

import os
import re
import subprocess
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

TOP = Path(__file__).resolve().parent.parent
SOURCE, DEVEL = TOP / "catkin_ws" / "src", TOP / "catkin_ws" / "devel"
AT_ONCE = 5.0  # [s]
NO_MASTER = "http://127.0.0.1:9"  # the discard port: nothing listens there

# Programs of the build's tests, in the same folders as the others.
OF_TESTS = re.compile(r"_test(_node)?$|^test_")
PACKAGES = {path.parent.name for path in SOURCE.glob("**/package.xml")}


def is_program(path: Path) -> bool:
    return path.is_file() and os.access(path, os.X_OK) and not OF_TESTS.search(path.name)


def programs() -> list[Path]:
    """Built programs in the folders of rosrun and the shell, and scripts in the sources."""
    built = [path for path in DEVEL.glob("lib/*/*") if path.parent.name in PACKAGES]
    scripts = [path for path in SOURCE.glob("**/scripts/*") if path.parent.parent.name in PACKAGES]
    return sorted(path for path in [*built, *DEVEL.glob("bin/*"), *scripts] if is_program(path))


def asked(path: Path) -> tuple[int | None, str, float]:
    """Its status, its output, and its run time [s]."""
    begin = time.monotonic()
    try:
        result = subprocess.run(
            [str(path), "--help"],
            env={**os.environ, "ROS_MASTER_URI": NO_MASTER},
            text=True,
            capture_output=True,
            stdin=subprocess.DEVNULL,
            timeout=60,
        )
    except subprocess.TimeoutExpired:
        return None, "", time.monotonic() - begin
    return result.returncode, result.stdout, time.monotonic() - begin


@pytest.fixture(scope="module")
def answers():
    with ThreadPoolExecutor(2) as pool:
        found = programs()
        return dict(zip(found, pool.map(asked, found)))


def test_there_are_programs_of_every_kind(answers):
    names = {path.name for path in answers}
    assert {"franka_control_node", "franka_sim", "franka_gripper_node", "spawner", "roslaunch"} <= names


def test_every_program_answers_help(answers):
    wrong = {
        str(path.relative_to(TOP)): (status, text[:200])
        for path, (status, text, _) in answers.items()
        if status != 0 or not re.search("usage", text, re.IGNORECASE)
    }
    assert not wrong


def test_every_program_answers_at_once(answers):
    late = [path for path, (_, _, took) in answers.items() if took > AT_ONCE]
    # A busy machine takes seconds to start Python: late programs are called again, alone.
    assert not [str(path.relative_to(TOP)) for path in late if asked(path)[2] > AT_ONCE]
