# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Every program of the workspace answers --help: at once, without a ROS master."""

import os
import re
import subprocess
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

TOP = Path(__file__).resolve().parent.parent
SOURCE, DEVEL = TOP / "catkin_ws" / "src", TOP / "catkin_ws" / "devel"
AT_ONCE, PATIENCE = 5.0, 60.0  # [s]
NO_MASTER = "http://127.0.0.1:9"  # the discard port: nothing listens there

# Programs of tests and benchmarks, in the same folders as the others.
NOT_FOR_USERS = re.compile(r"_test(_node)?$|^test_|_bench$")
PACKAGES = {path.parent.name for path in SOURCE.glob("**/package.xml")}


def is_program(path: Path) -> bool:
    return path.is_file() and os.access(path, os.X_OK) and not NOT_FOR_USERS.search(path.name)


def programs() -> list[Path]:
    """Built programs in the folders of rosrun and the shell, and scripts in the sources."""
    built = [path for path in DEVEL.glob("lib/*/*") if path.parent.name in PACKAGES]
    scripts = [path for path in SOURCE.glob("**/scripts/*") if path.parent.parent.name in PACKAGES]
    return sorted(path for path in [*built, *DEVEL.glob("bin/*"), *scripts] if is_program(path))


def help_of(path: Path) -> tuple[int | None, str, float]:
    """Its status, its output, and how long it took without waiting for a processor [s]."""
    with tempfile.TemporaryFile("w+") as output:
        begin = time.monotonic()
        process = subprocess.Popen(
            [str(path), "--help"],
            env={**os.environ, "ROS_MASTER_URI": NO_MASTER},
            text=True,
            stdout=output,
            stderr=subprocess.DEVNULL,
            stdin=subprocess.DEVNULL,
        )
        while not has_ended(process.pid) and time.monotonic() - begin < PATIENCE:
            time.sleep(0.005)
        took = time.monotonic() - begin - waited_for_a_processor(process.pid)
        ended = has_ended(process.pid)
        process.kill()
        process.wait()
        output.seek(0)
        return process.returncode if ended else None, output.read(), took


def has_ended(pid: int) -> bool:
    """Whether a child has ended; it is not reaped, so that the system still knows its times."""
    return os.waitid(os.P_PID, pid, os.WEXITED | os.WNOWAIT | os.WNOHANG) is not None


def waited_for_a_processor(pid: int) -> float:
    """The process's main thread was ready to run, but others had the processors [s]."""
    return 1e-9 * int(Path(f"/proc/{pid}/schedstat").read_text().split()[1])


@pytest.fixture(scope="module")
def answers():
    with ThreadPoolExecutor(2) as pool:
        found = programs()
        return dict(zip(found, pool.map(help_of, found)))


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
    # A busy disk takes seconds to start Python, too: late programs are called again, alone.
    assert not [str(path.relative_to(TOP)) for path in late if help_of(path)[2] > AT_ONCE]
