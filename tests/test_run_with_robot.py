# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""pyfranka-run: a command runs with a robot."""

import os
import pty
import re
import select
import signal
import socket
import subprocess
import sys
from contextlib import suppress
from pathlib import Path
from xmlrpc.server import SimpleXMLRPCServer

import pyfranka.run
import pytest
from pyfranka.run import reserve_port

TOP = Path(__file__).resolve().parent.parent
DEVEL = TOP / "catkin_ws" / "devel"
RUN = DEVEL / "bin" / "pyfranka-run"
pytestmark = pytest.mark.usefixtures("leaves_no_process")
READ = """
import os, pyfranka
robot = pyfranka.Robot(os.environ["FRANKA_ROBOT_IP"], pyfranka.RealtimeConfig.Ignore)
print(robot.read_once().robot_mode)
"""


def run(*words: str | Path, **variables: str) -> subprocess.CompletedProcess:
    return subprocess.run(
        [RUN, *words],
        env={**os.environ, **variables},
        text=True,
        capture_output=True,
        timeout=200,
        stdin=subprocess.DEVNULL,
    )


def test_the_command_reads_its_robot():
    done = run("--robot", "panda", "--", "/usr/bin/python3", "-c", READ)
    assert (done.returncode, done.stdout) == (0, "RobotMode.Idle\n"), done.stderr
    assert re.search(r"the robot is ready: panda at 127\.\d+\.\d+\.\d+\n", done.stderr)
    assert "last lines" not in done.stderr


def test_options_reach_the_robot(tmp_path):
    log = tmp_path / "robot.log"
    done = run("--robot=fr3", "--address=127.0.63.1", "--option=--protocol=7", f"--log={log}", "--", "true")
    assert done.returncode == 0, done.stderr
    assert "waits for clients at 127.0.63.1" in log.read_text()


def test_a_failing_command_keeps_its_status_and_shows_the_robots_log():
    done = run("--", "bash", "-c", "echo mine; exit 3")
    assert (done.returncode, done.stdout) == (3, "mine\n")
    assert "status 3; the robot's last lines:\n" in done.stderr and "waits for clients at" in done.stderr


def test_a_command_that_a_signal_ends_has_its_number():
    assert run("--", "bash", "-c", "kill -SEGV $$").returncode == 128 + signal.SIGSEGV


def test_a_late_command_is_ended_with_its_children():
    done = run("--timeout=0.5", "--", "bash", "-c", "sleep 1000 & wait")
    assert done.returncode == 124 and "did not end within 0.5 s" in done.stderr


def test_a_robot_that_cannot_start_is_reported_before_the_command():
    done = run("--world=nowhere.xml", "--", "echo", "mine")
    assert (done.returncode, done.stdout) == (125, ""), done.stderr
    assert "the robot did not start:" in done.stderr and "nowhere.xml" in done.stderr


def test_a_robot_that_ends_before_the_command_is_a_failure():
    code = "import os; from pyfranka.remote import Remote; Remote(os.environ['FRANKA_ROBOT_IP']).send('quit')"
    wait = "until ps --ppid $PPID -o stat=,comm= | grep -q '^Z.*franka_sim'; do sleep 0.05; done"
    done = run("--timeout=60", "--", "bash", "-c", f'/usr/bin/python3 -c "{code}"; {wait}')
    assert done.returncode == 125, done.stderr
    assert "the robot ended before the command. franka_sim has ended with status 0." in done.stderr


@pytest.mark.parametrize(("command", "status"), [("/there/is/none", 127), (str(TOP / "README.md"), 126)])
def test_a_command_that_cannot_be_run_is_reported(command, status):
    done = run("--", command)
    assert done.returncode == status and command in done.stderr


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ([], "a command is missing"),
        (["--robot=ur5", "--", "true"], 'there is no robot "ur5"; there are panda, fr3'),
        (["--robot=fr3", "--launch=a b.launch", "--", "true"], "exclude each other"),
    ],
)
def test_wrong_arguments_are_refused(words, sentence):
    done = run(*words)
    assert done.returncode == 2 and sentence in done.stderr


def test_a_signal_ends_command_and_robot():
    process = subprocess.Popen(
        [RUN, "--", "bash", "-c", "echo started; sleep 1000"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stdout.readline() == "started\n"
    process.terminate()
    _, output = process.communicate(timeout=60)
    assert process.returncode == 128 + signal.SIGTERM and "ended by SIGTERM" in output


SIGNALLED_WHILE_STARTING = """
import os, signal, subprocess, sys
from pyfranka import run

class Popen(subprocess.Popen):
    def __init__(self, words, **options):
        super().__init__(words, **options)
        if words[0] == "sleep":
            os.kill(os.getpid(), signal.SIGTERM)

subprocess.Popen = Popen
sys.exit(run.main(["--", "sleep", "1000"]))
"""


def test_a_signal_while_the_command_starts_ends_it():
    done = subprocess.run([sys.executable, "-c", SIGNALLED_WHILE_STARTING], timeout=60, check=False)
    assert done.returncode == 128 + signal.SIGTERM


class Terminal:
    """pyfranka-run as the first program of a terminal of its own."""

    def __init__(self, *words: str | Path):
        self.pid, self._master = pty.fork()
        if self.pid == 0:
            os.execv(RUN, [RUN, *words])
        self.printed = ""

    def wait_for(self, text: str):
        while text not in self.printed:
            readable, _, _ = select.select([self._master], [], [], 120)
            assert readable, self.printed
            self.printed += os.read(self._master, 4096).decode(errors="replace")

    def type(self, text: str):
        os.write(self._master, text.encode())

    def status(self) -> int:
        with suppress(OSError):  # its other side is closed
            while part := os.read(self._master, 4096):
                self.printed += part.decode(errors="replace")
        os.close(self._master)
        return os.waitstatus_to_exitcode(os.waitpid(self.pid, 0)[1])


def test_a_debugger_reads_what_is_typed(tmp_path):
    file = tmp_path / "test_mine.py"
    file.write_text("def test_mine():\n    value = 6\n    assert value == 7\n")
    terminal = Terminal("--", sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "--pdb", file)
    terminal.wait_for("(Pdb)")
    terminal.type("p 1000 * value + 1\n")
    terminal.wait_for("6001")
    terminal.type("q\n")
    assert terminal.status() == 2, terminal.printed  # pytest's for an interruption


def test_ctrl_c_ends_the_command_and_nothing_is_left():
    terminal = Terminal("--", "bash", "-c", "sleep 1000 & echo started; read -r line")
    terminal.wait_for("started")
    terminal.type("\x03")
    assert terminal.status() == 128 + signal.SIGINT, terminal.printed


def test_the_command_reads_standard_input():
    done = subprocess.run([RUN, "--", "cat"], input="mine", text=True, capture_output=True, timeout=200)
    assert (done.returncode, done.stdout) == (0, "mine"), done.stderr


# ---- roslaunch -------------------------------------------------------------------------------------------


def test_a_launch_file_that_does_not_exist_is_reported():
    done = run("--launch=franka_gazebo robot_arm.launch", "--", "echo", "mine")
    assert (done.returncode, done.stdout) == (125, "")
    assert "robot_arm.launch" in done.stderr and "roslaunch has ended with status 1" in done.stderr


def test_a_launch_without_a_robot_is_reported(tmp_path):
    file = tmp_path / "empty.launch"
    file.write_text("<launch/>")
    done = run(f"--launch={file}", "--start-timeout=1", "--", "echo", "mine")
    assert (done.returncode, done.stdout) == (125, "")
    assert "states had no message within 1 s" in done.stderr


def test_nobody_but_the_master_gets_the_reserved_port():
    with reserve_port() as reserved:
        port = reserved.getsockname()[1]
        with socket.socket() as other, pytest.raises(OSError, match="in use"):
            other.bind(("localhost", port))
        with SimpleXMLRPCServer(("localhost", port)) as master:  # what rosmaster listens with
            assert master.server_address[1] == port


def test_nodes_that_roslaunch_leaves_are_ended(tmp_path):
    roslaunch = tmp_path / "roslaunch"
    roslaunch.write_text("#!/bin/sh\nsetsid --fork sleep 1000\nexec sleep 1000\n")
    roslaunch.chmod(0o755)
    (tmp_path / "rostopic").symlink_to("/bin/false")
    done = run("--launch=a b.launch", "--start-timeout=1", "--", "true", PATH=f"{tmp_path}:/usr/bin:/bin")
    assert done.returncode == 125 and "no message within 1 s" in done.stderr


def test_a_node_that_ignores_an_interrupt_is_killed(monkeypatch):
    monkeypatch.setattr(pyfranka.run, "TO_END", 0.3)
    with subprocess.Popen(["sh", "-c", "trap '' INT; echo; exec sleep 1000"], stdout=subprocess.PIPE) as node:
        node.stdout.readline()
        pyfranka.run.end_marked(f"MARK={os.environ['MARK']}")
        assert node.wait() == -signal.SIGKILL


def test_without_ros_a_launch_is_refused(tmp_path):
    done = run("--launch=franka_gazebo panda.launch", "--", "/bin/true", PATH=str(tmp_path))
    assert done.returncode == 125 and "no program roslaunch on PATH" in done.stderr
