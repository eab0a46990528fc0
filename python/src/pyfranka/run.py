# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Runs a command, such as the tests of a project, with a simulated robot that lives as long as the command.

    pyfranka-run --robot fr3 -- pytest tests
    pyfranka-run --robot panda -- rostest my_package my.test
    pyfranka-run --launch "franka_gazebo panda.launch headless:=true" -- python3 my_test.py

With --robot, the program franka_sim serves a robot at an address of its own, which the command finds in the
variable FRANKA_ROBOT_IP. With --launch, roslaunch starts the robot with a ROS master of its own, to which
ROS_MASTER_URI leads. The robot's log is printed if something fails.

Exit status: that of the command; 128 + N if signal N has ended it; 124 after --timeout; 125 if the robot does
not start or ends before the command; 126 and 127 if the command cannot be run; 2 for wrong arguments.
"""

from __future__ import annotations

import argparse
import os
import shlex
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import types
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

from pyfranka.command_line import Parser
from pyfranka.franka_sim import FrankaSim, FrankaSimError, last_lines
from pyfranka.sim.setups import KINDS, described

__all__ = ["main"]

TIMED_OUT, NO_ROBOT, NOT_RUN, NOT_FOUND = 124, 125, 126, 127  # as those of timeout(1)
SIGNALED = 128
TO_START, TO_END = 120.0, 20.0  # [s], on a busy machine (chosen here)
TO_REAP = 1.0  # [s] for init to reap killed children; some containers have no init that does (chosen here)
PAUSE = 0.05  # [s] between two looks (chosen here)
MARK = "PYFRANKA_RUN"  # a variable of roslaunch and of all that it starts
TOPIC = "/franka_state_controller/franka_states"
ENDING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class RobotError(RuntimeError):
    """The robot did not start or has ended; the text is the reason."""


class Interrupted(Exception):
    """A signal ended this program. number: of the signal."""

    def __init__(self, number: int):
        super().__init__(number)
        self.number = number


@contextmanager
def held() -> Iterator[None]:
    """Signals that end this program wait for the end of the block: what it starts is known by then."""
    received: list[int] = []
    before = {each: signal.signal(each, lambda number, _: received.append(number)) for each in ENDING}
    try:
        yield
    finally:
        for each, handler in before.items():
            signal.signal(each, handler)
    if received and callable(handler := before[signal.Signals(received[0])]):
        handler(received[0], None)


class ServedRobot:
    """franka_sim at an address of its own."""

    def __init__(self, options: argparse.Namespace):
        try:
            robot = described(
                options.robot,
                realism=options.realism,
                address=options.address,
                arguments=options.option,
            )
            self._sim = FrankaSim(robot, world=options.world, pace=options.pace or "patient")
        except (FrankaSimError, ValueError) as error:
            raise RobotError(str(error)) from None
        self.variables = {"FRANKA_ROBOT_IP": self._sim.robot.address}
        self.name = f"{options.robot} at {self._sim.robot.address}"

    def log(self) -> str:
        return self._sim.log()

    def ended(self) -> str:
        """A sentence if it has ended, or nothing."""
        return self._sim.status()

    def stop(self) -> None:
        if self.ended():
            self._sim.kill()
            return
        try:
            self._sim.stop()
        except FrankaSimError as error:
            raise RobotError(str(error)) from None


class LaunchedRobot:
    """roslaunch with a ROS master of its own. It is ready when a topic has its first message."""

    def __init__(self, options: argparse.Namespace):
        for program in ("roslaunch", "rostopic"):
            if shutil.which(program) is None:
                raise RobotError(
                    f"There is no program {program} on PATH: source the setup.bash of a workspace or of "
                    "the installed packages."
                )
        self._reserved = reserve_port()
        port = self._reserved.getsockname()[1]
        self.variables = {
            "ROS_MASTER_URI": f"http://localhost:{port}",
            "ROS_HOSTNAME": os.environ.get("ROS_HOSTNAME", "localhost"),
        }
        self.name = options.launch
        self._mark = f"{os.getpid()}.{port}"
        self._log = tempfile.TemporaryFile(prefix="roslaunch.")
        started = None
        try:
            with held():
                started = self._process = subprocess.Popen(
                    ["roslaunch", f"--port={port}", *shlex.split(options.launch)],
                    env={**os.environ, **self.variables, MARK: self._mark},
                    stdin=subprocess.DEVNULL,
                    stdout=self._log,
                    stderr=subprocess.STDOUT,
                    process_group=0,
                )
            self._wait_for(options.ready_topic, options.start_timeout)
        except BaseException:
            if started is not None:
                self.stop()
            raise

    def log(self) -> str:
        return os.pread(self._log.fileno(), os.fstat(self._log.fileno()).st_size, 0).decode(errors="replace")

    def ended(self) -> str:
        code = self._process.poll()
        return "" if code is None else f"roslaunch has ended with status {code}."

    def stop(self) -> None:
        # Its own way to end its nodes. Those that it starts meanwhile can remain, in groups of their own.
        end_group(self._process, signal.SIGINT)
        end_marked(f"{MARK}={self._mark}")
        self._reserved.close()

    def _wait_for(self, topic: str, seconds: float) -> None:
        deadline = time.monotonic() + seconds
        listener = None
        try:
            while time.monotonic() < deadline:
                if message := self.ended():
                    raise RobotError(f"{last_lines(self.log())}\n{message}")
                # Ends at once while there is no master yet.
                if listener is None or listener.poll() not in (None, 0):
                    with held():
                        listener = self._listener(topic)
                elif listener.poll() == 0:
                    return
                time.sleep(PAUSE)
        finally:
            if listener is not None:
                end_group(listener, signal.SIGKILL)
        raise RobotError(
            f"{last_lines(self.log())}\nThe topic {topic} had no message within {seconds:g} s; "
            "--ready-topic names another one."
        )

    def _listener(self, topic: str) -> subprocess.Popen[bytes]:
        return subprocess.Popen(
            ["rostopic", "echo", "-n", "1", topic],
            env={**os.environ, **self.variables},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            process_group=0,
        )


def reserve_port() -> socket.socket:
    """A socket with a port that the system gives to no other program while it is open. The ROS master listens
    there nevertheless: its server has SO_REUSEADDR, too, and this socket does not listen."""
    reserved = socket.socket()
    reserved.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    reserved.bind(("", 0))
    return reserved


@contextmanager
def terminal_of(group: int) -> Iterator[None]:
    """Inside, the process group of a child has the terminal of our standard input, if we have it: it reads
    what is typed, Ctrl-C ends it, and Ctrl-Z stops it and us. Our own group gets the terminal back."""
    ours = os.getpgrp()
    if not os.isatty(0) or os.tcgetpgrp(0) != ours:
        yield
        return

    def give(other: int) -> None:
        with suppress(OSError):  # the group has ended already, or the terminal has gone
            os.tcsetpgrp(0, other)

    def resume() -> None:
        if os.tcgetpgrp(0) == ours:  # not after `bg` of the shell
            give(group)
        with suppress(ProcessLookupError):
            os.killpg(group, signal.SIGCONT)  # it may have read too early

    def child_changed(*_: object) -> None:
        with suppress(ChildProcessError):  # it has been waited for
            if os.waitid(os.P_PID, group, os.WSTOPPED | os.WNOHANG):
                give(ours)
                os.kill(os.getpid(), signal.SIGSTOP)
                resume()

    # Otherwise the system would stop us when we take the terminal back.
    before = signal.signal(signal.SIGTTOU, signal.SIG_IGN)
    children = signal.signal(signal.SIGCHLD, child_changed)
    try:
        resume()
        yield
    finally:
        signal.signal(signal.SIGCHLD, children)
        give(ours)
        signal.signal(signal.SIGTTOU, before)


def end_group(process: subprocess.Popen[bytes], number: int) -> None:
    """Ends a process and its child processes, and waits for their end."""
    with suppress(ProcessLookupError):
        for each in (number, signal.SIGKILL):
            os.killpg(process.pid, each)
            with suppress(subprocess.TimeoutExpired):
                process.wait(TO_END)
        # Killed children are reaped by init: they stay in the group until then.
        deadline = time.monotonic() + TO_REAP
        while time.monotonic() < deadline:
            os.killpg(process.pid, 0)
            time.sleep(PAUSE)
    process.wait()


def end_marked(variable: str) -> None:
    """Ends all processes with this variable, and waits for their end."""
    for number in (signal.SIGINT, signal.SIGKILL):
        deadline = time.monotonic() + TO_END
        for pid in marked(variable):
            with suppress(ProcessLookupError):
                os.kill(pid, number)
        while time.monotonic() < deadline and marked(variable):
            time.sleep(PAUSE)


def marked(variable: str) -> list[int]:
    """The processes with this variable."""
    found = []
    for folder in Path("/proc").glob("[0-9]*"):
        with suppress(OSError):  # it has ended, or is another user's
            if variable.encode() in (folder / "environ").read_bytes().split(b"\0"):
                found.append(int(folder.name))
    return found


def run_command(words: Sequence[str], variables: dict[str, str], seconds: float) -> int:
    """Runs the user's command; returns the status for our own exit."""
    process = None
    try:
        with held():
            process = subprocess.Popen(words, env={**os.environ, **variables}, process_group=0)
        with terminal_of(process.pid):
            code = process.wait(seconds or None)
    except FileNotFoundError:
        print_line(f"there is no program {words[0]}.")
        return NOT_FOUND
    except OSError as error:
        print_line(f"{words[0]} cannot be run: {error.strerror}.")
        return NOT_RUN
    except subprocess.TimeoutExpired:
        print_line(f"the command did not end within {seconds:g} s.")
        return TIMED_OUT
    finally:
        if process is not None:  # also what the command has left running
            end_group(process, signal.SIGTERM)
    return code if code >= 0 else SIGNALED - code


def print_line(sentence: str) -> None:
    print(f"pyfranka-run: {sentence}", file=sys.stderr, flush=True)


def with_robot(options: argparse.Namespace) -> int:
    """Starts the robot, runs the command, ends the robot; returns the exit status."""
    robot: ServedRobot | LaunchedRobot | None = None
    status = NO_ROBOT
    try:
        if options.launch:
            robot = LaunchedRobot(options)
        else:
            with held():
                robot = ServedRobot(options)
        print_line(f"the robot is ready: {robot.name}")
        status = run_command(options.command, robot.variables, options.timeout)
        if message := robot.ended():
            print_line(f"the robot ended before the command. {message}")
            status = status or NO_ROBOT
    except RobotError as error:
        print_line(f"the robot did not start:\n{error}")
    except Interrupted as error:
        print_line(f"ended by {signal.Signals(error.number).name}.")
        status = SIGNALED + error.number
    if robot is not None:
        status = stop(robot, status)
        report(robot, status, options.log)
    return status


def stop(robot: ServedRobot | LaunchedRobot, status: int) -> int:
    """Ends the robot; a robot that ends badly makes the run fail."""
    try:
        robot.stop()
    except RobotError as error:
        print_line(str(error))
        return status or NO_ROBOT
    return status


def report(robot: ServedRobot | LaunchedRobot, status: int, file: Path | None) -> None:
    if file is not None:
        try:
            file.write_text(robot.log(), encoding="utf-8")
        except OSError as error:
            print_line(f"the log cannot be written to {file}: {error.strerror}.")
    if status != 0:
        print_line(f"status {status}; the robot's last lines:\n{last_lines(robot.log())}")


def seconds(text: str) -> float:
    value = float(text)
    if not 0 <= value < 1e6:
        raise ValueError
    return value


def parse_arguments(words: Sequence[str] | None) -> argparse.Namespace:
    parser = Parser(
        prog="pyfranka-run",
        usage="%(prog)s [OPTIONS] -- COMMAND [ARGUMENTS]",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add = parser.add_argument
    # Forms for continuous integration pass every option, an empty one if the user has given none.
    add("--robot", default="", metavar="|".join(KINDS), help="the robot that franka_sim serves (panda)")
    add("--launch", default="", metavar="WORDS", help="package, launch file and arguments for roslaunch")
    add("--address", default="", help="of the served robot (one of its own)")
    add("--pace", default="", help="of the served robot, as in franka_sim --help (patient)")
    add("--realism", default="", help="of the served robot, as in franka_sim --help")
    add("--world", default="", help="of the served robot, as in franka_sim --help")
    add("--option", action="append", default=[], metavar="WORD", help="a further option for franka_sim")
    add("--ready-topic", default=TOPIC, help="with --launch: has a message when it is ready (%(default)s)")
    add(
        "--start-timeout",
        type=seconds,
        default=TO_START,
        metavar="SECONDS",
        help="with --launch: time to get ready (%(default)g)",
    )
    add("--timeout", type=seconds, default=0.0, metavar="SECONDS", help="time for the command; 0: no limit")
    add("--log", type=Path, help="write the robot's whole log to this file")
    add("command", nargs="*", metavar="COMMAND", help="what to run, and its arguments")
    options = parser.parse_args(words)
    if not options.command:
        parser.error("a command is missing: pyfranka-run --robot panda -- pytest tests")
    if options.launch and options.robot:
        parser.error("--robot and --launch exclude each other.")
    options.robot = options.robot or "panda"
    if options.robot not in KINDS:
        parser.error(f'there is no robot "{options.robot}"; there are {", ".join(KINDS)}.')
    return options


def main(words: Sequence[str] | None = None) -> int:
    options = parse_arguments(words)

    def interrupt(number: int, _: types.FrameType | None) -> None:
        for each in ENDING:  # what is ended now is not interrupted again
            signal.signal(each, signal.SIG_IGN)
        raise Interrupted(number)

    for each in ENDING:
        signal.signal(each, interrupt)
    return with_robot(options)


if __name__ == "__main__":
    sys.exit(main())
