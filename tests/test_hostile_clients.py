# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Attacks on one robot of the real program franka_sim, beside a client in motion of its other robot
(faults 19).

The robots are patient, because here programs compete for the machine. hostile_clients_test.cpp has the same
attacks within one process, and measures how long they delay the robots.
"""

import json
import subprocess
import sys
from contextlib import ExitStack, contextmanager
from pathlib import Path

import pyfranka
import pytest
from fci_session import memory_of
from lines import Lines
from pyfranka.franka_sim import FrankaSim
from pyfranka.sim import FR3, Panda
from waiting import wait_for

SUPPORT = Path(__file__).resolve().parent / "support"
NEWCOMERS = 20  # during each attack, one after the other
LIMIT = 60.0  # [s] of each wait
MAX_MEMORY = 100.0  # [MB] of the whole program


@pytest.fixture(scope="module")
def sim():
    attacked, other = Panda(base=[0, 0, 0]), FR3(base=[0, 2, 0])
    with FrankaSim(attacked, other, pace="patient") as sim:
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
        assert lines.next(LIMIT) is not None, f"{words} does not begin."
        yield process, lines
    finally:
        process.kill()
        process.wait()
        process.stdin.close()


def gets_in(robot) -> bool:
    """Whether a genuine client can connect and read a state."""
    try:
        robot.connect().read_once()
    except pyfranka.NetworkException:
        return False
    return True


@pytest.mark.parametrize("kind, attackers", [("models", 1), ("limits", 1), ("silent", 1), ("reconnect", 3)])
def test_an_attack_on_one_robot_stops_neither_the_other_ones_client_nor_new_clients(
    sim, reconnect, kind, attackers
):
    attack = [reconnect] if kind == "reconnect" else [sys.executable, SUPPORT / "attack.py", kind]
    target, other = sim.robots
    steady = sys.executable, SUPPORT / "steady_client.py", other.address, other.protocol
    with program(*steady) as (client, lines):
        with ExitStack() as stack:
            begun = [stack.enter_context(program(*attack, target.address)) for _ in range(attackers)]
            for _ in range(NEWCOMERS):
                if kind in ("models", "limits"):
                    # The attacker is the client of the robot: another one is refused, as by a real robot.
                    assert not gets_in(target)
                else:
                    wait_for(lambda: gets_in(target), "A new client")
                other.gripper().read_once()
                assert memory_of(sim.process.pid) < MAX_MEMORY
            assert all(process.poll() is None for process, _ in begun), "An attacker has given up."
        client.stdin.close()
        report = lines.next(LIMIT)
        assert report is not None, "The client in motion was lost."
    seen = json.loads(report)
    assert (seen["status"], seen["step"]) == (0, 1), seen
    wait_for(lambda: gets_in(target), "A client after the attack")
