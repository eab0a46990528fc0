# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Every program of the workspace and every example in Python answers --help, without a ROS master."""

import os
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

TOP = Path(__file__).resolve().parent.parent
SOURCE, DEVEL = TOP / "catkin_ws" / "src", TOP / "catkin_ws" / "devel"
EXAMPLES = [path for path in (TOP / "examples" / "python").glob("*.py") if path.name != "common.py"]
PATIENCE = 120.0  # [s]
NO_MASTER = "http://127.0.0.1:9"  # the discard port: nothing listens there

# Programs of tests and benchmarks, in the same folders as the others.
NOT_FOR_USERS = re.compile(r"_test(_node)?$|^test_|_bench$")
PACKAGES = {path.parent.name for path in SOURCE.glob("**/package.xml")}


def is_program(path: Path) -> bool:
    return path.is_file() and os.access(path, os.X_OK) and not NOT_FOR_USERS.search(path.name)


def programs() -> list[Path]:
    """Built programs in the folders of rosrun and the shell, scripts that are in neither, and examples."""
    built = [path for path in DEVEL.glob("lib/*/*") if path.parent.name in PACKAGES]
    scripts = [path for path in SOURCE.glob("**/scripts/*") if path.parent.parent.name in PACKAGES]
    found = {path.name: path for path in [*scripts, *DEVEL.glob("bin/*"), *built] if is_program(path)}
    return [*found.values(), *EXAMPLES]


def help_of(path: Path, **variables: str) -> tuple[int | None, str]:
    """Its status, and its output."""
    environment = {**os.environ, "ROS_MASTER_URI": NO_MASTER, **variables}
    options = {"text": True, "stdin": subprocess.DEVNULL, "capture_output": True, "timeout": PATIENCE}
    try:
        command = [sys.executable, str(path)] if path in EXAMPLES else [str(path)]
        result = subprocess.run([*command, "--help"], env=environment, check=False, **options)
    except subprocess.TimeoutExpired:
        return None, ""
    return result.returncode, result.stdout


def test_every_program_answers_help():
    found = programs()
    names = {path.name for path in found}
    assert {"franka_control_node", "franka_sim", "franka_gripper_node", "spawner", "roslaunch"} <= names
    with ThreadPoolExecutor(2) as pool:
        answers = dict(zip(found, pool.map(help_of, found)))
    wrong = {
        str(path.relative_to(TOP)): (status, text[:200])
        for path, (status, text) in answers.items()
        if status != 0 or not re.search("usage", text, re.IGNORECASE)
    }
    assert not wrong
    # An option with nothing beside it, nor below it.
    bare = re.compile(r"^( {1,4})(-\S+(?: \S+)*)\n(?!\1 )", re.MULTILINE)
    assert not {path.name: found for path, (_, text) in answers.items() if (found := bare.findall(text))}


@pytest.mark.parametrize(
    "name",
    [
        "catkin_ws/src/franka_description/scripts/install_meshes",
        "catkin_ws/src/franka_example_controllers/scripts/move_to_start.py",
        "examples/python/first_steps.py",
    ],
)
def test_programs_answer_help_without_docstrings(name):
    """As python -OO, and a machine with the variable PYTHONOPTIMIZE, run them."""
    status, text = help_of(TOP / name, PYTHONOPTIMIZE="2", PYTHONDONTWRITEBYTECODE="1")
    assert status == 0 and "usage" in text
