# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Simulated robots without ROS, and client processes that execute tasks."""

import json
import os
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

from lines import Lines
from pyfranka.franka_sim import FrankaSim
from pyfranka.sim import KINDS

HERE = Path(__file__).resolve().parent


def memory_of(pid: int) -> float:
    """Resident memory of a process [MB]."""
    lines = Path(f"/proc/{pid}/status").read_text().splitlines()
    return float(next(line for line in lines if line.startswith("VmRSS")).split()[1]) / 1024


def descriptors_of(pid: int) -> int:
    """How many descriptors a process has open."""
    return len(os.listdir(f"/proc/{pid}/fd"))


@contextmanager
def simulated(
    kind: str, pace: str, *, realism="ideal", address="", base=(0, 0, 0), hand=True, protocol=0, **options
):
    """A ServedRobot of pyfranka.franka_sim: an ideal one unless the arguments say otherwise, so that no
    result depends on friction or on the hand's latency. options: those of FrankaSim."""
    robot = KINDS[kind](address=address, realism=realism, base=base, hand=hand, protocol=protocol)
    with FrankaSim(robot, pace=pace, **options) as server:
        yield server.robot


class ClientProcess:
    """A genuine or own client in its own process; `run_task` sends it one task and returns the result."""

    def __init__(self, library: str, python: str):
        script = HERE / "genuine" / "network_client.py"
        self.process = subprocess.Popen(
            [python, str(script), library], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
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

    def go_on(self) -> None:
        """Ends the wait of a motion that is held."""
        self.process.stdin.write("\n")
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
