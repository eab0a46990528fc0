# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""`franka_sim --patience forever`: neither a debugger's stop nor a pause in a callback ends a lock-step
motion, and while the robot waits, its operator and its client's end are noticed.

The long form stops for longer than the default patience of 30 s.
"""

import os
import signal
import sys
from contextlib import contextmanager

import pytest
from fci_session import client_process, simulated
from genuine_clients import client_python
from lock_step import begin_motion, moved, stopped
from waiting import wait_for

LONG = bool(os.environ.get("FRANKA_TEST_LONG"))
STOP, PAUSE = (35.0, 31.0) if LONG else (1.5, 0.7)  # [s]; the genuine clients wait 1 s for a state


@pytest.mark.parametrize(
    ("library", "robot"),
    [("pyfranka", "fr3"), ("panda", "panda"), ("pylibfranka", "fr3")],
)
def test_a_stopped_client_finishes_its_motion_with_the_same_hash(library, robot):
    python = sys.executable if library == "pyfranka" else client_python(library)
    with simulated(robot, "lockstep", patience="forever") as sim, client_process(library, python) as client:
        assert client.run_task("connect", address=sim.address)["outcome"] == "ok"
        undisturbed = moved(sim, client)
        assert moved(sim, client, process=client.process, seconds=STOP) == undisturbed
        assert moved(sim, client, pause=PAUSE) == undisturbed


@contextmanager
def waiting():
    """A robot whose client is stopped in its motion."""
    server = simulated("panda", "lockstep", patience="forever")
    with server as sim, client_process("pyfranka") as client:
        assert client.run_task("connect", address=sim.address)["outcome"] == "ok"
        begin_motion(client, seconds=30.0, amplitude=0.0)
        with stopped(client.process):
            assert sim.remote.state().mode == "Move"
            yield client, sim


def test_the_user_stop_ends_the_wait():
    with waiting() as (client, sim):
        sim.remote.set_user_stop(True)
        wait_for(lambda: sim.remote.state().mode == "User stopped")
        os.kill(client.process.pid, signal.SIGCONT)
        assert "ControlException" in client.result()["outcome"]
        sim.remote.set_user_stop(False)
        assert client.run_task("recover")["mode"] == "Idle"
        assert client.run_task("move", seconds=0.1, amplitude=0.0)["outcome"] == "ok"


def test_disconnect_of_the_client_ends_the_wait():
    with waiting() as (client, sim), client_process("pyfranka") as successor:
        client.process.kill()
        wait_for(lambda: sim.remote.state().mode != "Move")
        assert successor.run_task("connect", address=sim.address)["outcome"] == "ok"
        assert successor.run_task("recover")["mode"] == "Idle"
        assert successor.run_task("move", seconds=0.1, amplitude=0.0)["outcome"] == "ok"


@pytest.mark.parametrize("end", [signal.SIGINT, "quit"])
def test_the_simulation_ends_while_it_waits(end):
    with waiting() as (client, sim):
        if end == "quit":
            sim.remote.quit()
        else:
            sim.server.process.send_signal(end)
        assert sim.server.process.wait(60) == 0
        os.kill(client.process.pid, signal.SIGCONT)
        assert "NetworkException" in client.result()["outcome"]
