# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Attacks on one robot of the real program franka_sim, beside a client in motion of its other robot
(faults 19).

hostile_clients_test.cpp has the same attacks within one process, where only the stepping thread's own time
counts. Here programs compete for the machine, too.
"""

import json
import subprocess
import sys
import time
from contextlib import ExitStack, contextmanager
from pathlib import Path

import pyfranka
import pytest
from fci_session import memory_of
from lines import Lines
from pyfranka.franka_sim import FrankaSim, SimRobot
from stalls import in_time

SUPPORT = Path(__file__).resolve().parent / "support"
ATTACK = 2.0  # [s] of each attack
MAX_STEP = 20  # [ms] between two states
MAX_WAIT = 1.0  # [s] for a new client to get in
MIN_COUNT = 20  # of new clients, one after the other; each takes some 10 ms
MAX_MEMORY = 100.0  # [MB] of the whole program

pytestmark = pytest.mark.alone


@pytest.fixture(scope="module")
def sim():
    attacked, other = SimRobot("panda", base=[0, 0, 0]), SimRobot("fr3", base=[0, 2, 0])
    with FrankaSim(attacked, other, pace="realtime") as sim:
        yield sim


@pytest.fixture(scope="module")
def reconnect(tmp_path_factory):
    """The program that connects as fast as it can."""
    path = tmp_path_factory.mktemp("reconnect") / "reconnect"
    subprocess.run(["c++", "-std=c++17", "-O2", "-o", path, SUPPORT / "reconnect.cpp"], check=True)
    return path


@contextmanager
def program(*words):
    """A program that has begun, as it says."""
    process = subprocess.Popen(
        [str(word) for word in words], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    lines = Lines(process.stdout)
    try:
        assert lines.next(60.0) is not None, f"{words} does not begin."
        yield process, lines
    finally:
        process.kill()
        process.wait()
        process.stdin.close()


class Newcomers:
    """Genuine clients that come during an attack: how long each takes, and what fails."""

    def __init__(self):
        self.count, self.longest, self.failures = 0, 0.0, []

    def come(self, act):
        begin = time.monotonic()
        try:
            act()
        except (pyfranka.Exception, AssertionError) as error:
            self.failures.append(f"{error}")
        self.count += 1
        self.longest = max(self.longest, time.monotonic() - begin)


def genuine_client(robot):
    """A genuine client connects, reads a state and goes."""
    robot.connect().read_once()


def refused_client(robot):
    """The attacker is the client of the robot: another one is refused, as by a real robot."""
    try:
        robot.connect()
    except pyfranka.NetworkException:
        return
    raise AssertionError("The attacker is not the client.")


def attacked(sim, kind, attack, attackers):
    """What the attacks do to the other robot's client and to new clients. @returns the measurements"""
    target, other = sim.robots
    as_owner = kind in ("models", "limits")
    newcomers, memory = Newcomers(), 0.0
    steady = sys.executable, SUPPORT / "steady_client.py", other.address, other.protocol
    with program(*steady) as (client, lines):
        with ExitStack() as stack:
            begun = [stack.enter_context(program(*attack, target.address)) for _ in range(attackers)]
            end = time.monotonic() + ATTACK
            while time.monotonic() < end:
                newcomers.come(lambda: (refused_client if as_owner else genuine_client)(target))
                newcomers.come(lambda: other.gripper().read_once())
                memory = max(memory, memory_of(sim.process.pid))
            assert all(process.poll() is None for process, _ in begun), "An attacker has given up."
        client.stdin.close()
        report = lines.next(20.0)
        assert report is not None, "The client in motion was lost."
        seen = json.loads(report)
    newcomers.come(lambda: genuine_client(target))
    seen.update(newcomers.__dict__, memory=memory)
    print(f"{kind}: {seen}")
    return seen


def is_undisturbed(seen):
    return (
        seen["status"] == 0
        and seen["step"] <= MAX_STEP
        and seen["longest_gap"] <= 1e-3 * MAX_STEP
        and seen["longest"] <= MAX_WAIT
        and seen["count"] >= MIN_COUNT
        and not seen["failures"]
    )


@pytest.mark.parametrize("kind, attackers", [("models", 1), ("limits", 1), ("silent", 1), ("reconnect", 3)])
def test_an_attack_on_one_robot_delays_neither_the_other_ones_client_nor_new_clients(
    sim, reconnect, kind, attackers
):
    attack = [reconnect] if kind == "reconnect" else [sys.executable, SUPPORT / "attack.py", kind]
    seen = in_time(lambda: attacked(sim, kind, attack, attackers), is_undisturbed)
    assert is_undisturbed(seen), seen
    assert seen["memory"] < MAX_MEMORY, seen
    assert seen["states"] > 0.8e3 * ATTACK, seen
