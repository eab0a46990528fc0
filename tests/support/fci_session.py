# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Simulated robots without ROS, their control interface, and client processes that execute tasks."""

import json
import os
import select
import subprocess
import sys
from contextlib import contextmanager, suppress
from pathlib import Path

from control_interface import ask
from lines import Lines

HERE = Path(__file__).resolve().parent
VERSIONS = {"panda": 5, "fr3": 10}


def program() -> str:
    for prefix in os.environ.get("CMAKE_PREFIX_PATH", "").split(":"):
        found = Path(prefix) / "bin" / "franka_sim"
        if found.exists():
            return str(found)
    raise FileNotFoundError("There is no franka_sim in the workspace; build it with ./franka build.")


def start(*arguments: str) -> subprocess.Popen:
    """Starts franka_sim and waits until it has opened its ports."""
    process = subprocess.Popen(
        [program(), *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    ready, _, _ = select.select([process.stdout], [], [], 60)
    line = process.stdout.readline() if ready else ""
    if "waits for clients" not in line:
        process.kill()
        process.wait()
        raise AssertionError(line or "franka_sim says nothing.")
    return process


def stop(process: subprocess.Popen) -> None:
    """Ends a program as Ctrl-C does; fails if it does not end."""
    process.terminate()
    try:
        process.wait(20)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
        raise


def memory_of(pid: int) -> float:
    """Resident memory of a process [MB]."""
    lines = Path(f"/proc/{pid}/status").read_text().splitlines()
    return float(next(line for line in lines if line.startswith("VmRSS")).split()[1]) / 1024


class Simulation:
    """A running franka_sim."""

    def __init__(self, process: subprocess.Popen, robot: str, address: str):
        self.process, self.robot, self.address = process, robot, address
        self.version = VERSIONS[robot]

    def ask(self, line: str) -> str:
        """Sends one line to the control interface; returns the text after `ok`."""
        return ask(self.address, line)

    def memory(self) -> float:
        """Resident [MB]."""
        return memory_of(self.process.pid)

    def descriptors(self) -> int:
        return len(os.listdir(f"/proc/{self.process.pid}/fd"))


@contextmanager
def running(*arguments: str):
    """Yields a franka_sim that has opened its ports; fails if it ends by itself or does not end."""
    process = start(*arguments)
    try:
        yield process
        assert process.poll() is None, "The simulation has ended by itself: " + process.stdout.read()
    finally:
        stop(process)


@contextmanager
def simulated(robot: str, address: str, pace: str, *arguments: str):
    """The same for one robot: an ideal one unless the arguments say otherwise, so that no result depends on
    friction or on the hand's latency."""
    ideal = ["--realism", "ideal"]
    with running("--robot", robot, "--ip", address, "--pace", pace, *ideal, *arguments) as process:
        yield Simulation(process, robot, address)


def go_first(pid: int = 0) -> None:
    """Gives a process (0: this thread) the real-time priority of a robot's client, if the system allows it,
    so that the machine's load does not disturb the test."""
    with suppress(PermissionError, ProcessLookupError):
        os.sched_setscheduler(pid, os.SCHED_FIFO | os.SCHED_RESET_ON_FORK, os.sched_param(50))


def go_with_all(pid: int = 0) -> None:
    """Restores the priority before `go_first`."""
    with suppress(PermissionError, ProcessLookupError):
        os.sched_setscheduler(pid, os.SCHED_OTHER, os.sched_param(0))


class ClientProcess:
    """A genuine or own client in its own process; `tell` sends it one task and returns the result."""

    def __init__(self, library: str, python: str):
        script = HERE / "genuine" / "network_client.py"
        self.process = subprocess.Popen(
            [python, str(script), library], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        go_first(self.process.pid)
        self._lines = Lines(self.process.stdout)
        self._due = False  # a result

    def run_task(self, do: str, **task) -> dict:
        self.give(do, **task)
        return self.result()

    def give(self, do: str, **task) -> None:
        while self._due:  # left by a failed test
            self.result()
        self._due = True
        self.process.stdin.write(json.dumps({"do": do, **task}) + "\n")
        self.process.stdin.flush()

    def line(self, timeout: float = 60.0) -> str:
        line = self._lines.next(timeout)
        assert line is not None, f"The client has ended, or has written nothing for {timeout} s."
        return line

    def result(self, timeout: float = 60.0) -> dict:
        line = self.line(timeout)
        while line == "moving":
            line = self.line(timeout)
        self._due = False
        return json.loads(line)


@contextmanager
def client_process(library: str, python: str = sys.executable):
    client = ClientProcess(library, str(python))
    try:
        yield client
    finally:
        client.process.kill()
        client.process.wait()
        client.process.stdin.close()
