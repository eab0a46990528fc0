# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""`franka_sim --patience forever`: neither a debugger's stop nor a pause in a callback ends a lock-step
motion, and while the robot waits, everything else works.

The long form stops for longer than the default patience of 30 s.
"""

import os
import signal
import sys
import time
from contextlib import ExitStack, contextmanager

import pyfranka
import pytest
from fci_session import client_process, simulated
from genuine_clients import client_python
from lock_step import begin_motion, moved, stopped
from pyfranka.franka_sim import FrankaSim
from pyfranka.sim import FR3, LineRefused, Panda
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
    """Two robots in a world; the client of the first is stopped in its motion."""
    robots = Panda(realism="ideal"), FR3(base=(1, 0, 0), realism="ideal")
    with ExitStack() as stack:
        server = stack.enter_context(FrankaSim(*robots, pace="lockstep", patience="forever"))
        client = stack.enter_context(client_process("pyfranka"))
        assert client.run_task("connect", address=server["panda"].address)["outcome"] == "ok"
        begin_motion(client, seconds=30.0, amplitude=0.0)
        stack.enter_context(stopped(client.process))
        assert server["panda"].remote.state().mode == "Move"
        yield client, server["panda"], server["fr3"]


def test_a_second_robot_and_the_control_ports_work_meanwhile():
    with waiting() as (client, one, other), client_process("pyfranka") as second:
        robot = other.connect()
        assert robot.read_once().robot_mode == pyfranka.RobotMode.Idle
        del robot
        assert one.gripper().read_once().max_width > 0.0
        assert other.gripper().read_once().max_width > 0.0
        with pytest.raises(LineRefused, match="A motion runs"):
            one.remote.reset()
        assert other.remote.state().mode == "Idle"
        # The other one's motion waits as well, and its client does not give up.
        assert second.run_task("connect", address=other.address)["outcome"] == "ok"
        assert second.run_task("set_load")["outcome"] == "ok"
        second.give("move", seconds=0.2, amplitude=0.0)
        wait_for(lambda: other.remote.state().mode == "Move")
        time.sleep(2.0)  # longer than a client waits for a state: the fault itself
        os.kill(client.process.pid, signal.SIGCONT)
        assert client.result()["outcome"] == "ok"
        assert second.result()["outcome"] == "ok"


def test_the_user_stop_ends_the_wait():
    with waiting() as (client, one, _):
        one.remote.set_user_stop(True)
        wait_for(lambda: one.remote.state().mode == "User stopped")
        os.kill(client.process.pid, signal.SIGCONT)
        assert "ControlException" in client.result()["outcome"]
        one.remote.set_user_stop(False)
        assert client.run_task("recover")["mode"] == "Idle"
        assert client.run_task("move", seconds=0.1, amplitude=0.0)["outcome"] == "ok"


def test_disconnect_of_the_client_ends_the_wait():
    with waiting() as (client, one, _), client_process("pyfranka") as successor:
        client.process.kill()
        wait_for(lambda: one.remote.state().mode != "Move")
        assert successor.run_task("connect", address=one.address)["outcome"] == "ok"
        assert successor.run_task("recover")["mode"] == "Idle"
        assert successor.run_task("move", seconds=0.1, amplitude=0.0)["outcome"] == "ok"


@pytest.mark.parametrize("end", [signal.SIGINT, signal.SIGTERM, "quit"])
def test_the_simulation_ends_while_it_waits(end):
    with simulated("panda", "lockstep", patience="forever") as sim, client_process("pyfranka") as client:
        process = sim.server.process
        assert client.run_task("connect", address=sim.address)["outcome"] == "ok"
        begin_motion(client, seconds=30.0, amplitude=0.0)
        with stopped(client.process):
            if end == "quit":
                sim.remote.quit()
            else:
                process.send_signal(end)
            assert process.wait(60) == 0
        assert "NetworkException" in client.result()["outcome"]


WAITS = ["spin", "block", "auto"]


def test_no_way_to_wait_changes_a_result(monkeypatch):
    hashes = set()
    for number, wait in enumerate(WAITS):
        monkeypatch.setenv("FRANKA_WAIT", WAITS[number - 1])  # of the client
        with (
            simulated("panda", "lockstep", wait=wait) as sim,
            client_process("pyfranka") as client,
        ):
            assert client.run_task("connect", address=sim.address)["outcome"] == "ok"
            hashes.add(moved(sim, client))
    assert len(hashes) == 1, hashes


def test_an_unknown_way_to_wait_is_refused(monkeypatch):
    monkeypatch.setenv("FRANKA_WAIT", "sometimes")
    with (
        simulated("panda", "lockstep") as sim,
        pytest.raises(pyfranka.InvalidOperationException, match="must be spin, block or auto"),
    ):
        pyfranka.Robot(sim.address, pyfranka.RealtimeConfig.Ignore)
