# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A lock-step robot and its client on a starved machine: slower, but without failures or other results.

Either of the two is stopped in the middle of a motion, on a machine with as many busy processes as
processors (the long form: eight for each).
"""

import os
import signal
import sys
import threading
from contextlib import ExitStack
from functools import partial

import pyfranka
import pytest
from fci_session import client_process, simulated
from fci_wire import IDLE, LAYOUTS, MOVE, connected
from genuine_clients import client_python
from lock_step import moved
from starvation import busy
from waiting import wait_for

STOPPED = 0.7  # [s]
ABORTS, ABORTS_IN_SHORT = 30, 3
STARVED = 1.5  # [s]; our client waits 5 s for a robot on its own machine


def test_lock_step_waits_for_a_starved_client_and_repeats():
    with simulated("panda", "lockstep") as sim, client_process("pyfranka") as client, busy():
        assert client.run_task("connect", address=sim.address)["outcome"] == "ok"
        for torque in (False, True):
            move = partial(moved, sim, client, torque, motion=3.0)
            hashes = [move(), move(client.process, STOPPED), move(sim.server.process, STOPPED)]
            assert len(set(hashes)) == 1, hashes
        assert sim.remote.state().mode == "Idle"


@pytest.mark.parametrize(
    "library, robot", [("pyfranka", "panda"), ("panda", "panda"), ("pylibfranka", "fr3")]
)
def test_an_abort_looks_the_same_to_its_client(library, robot, long_run):
    """Late clients would find states of the braking arm in place of the one that shows the abort."""
    python = sys.executable if library == "pyfranka" else client_python(library)
    with simulated(robot, "lockstep") as sim, client_process(library, python) as client, busy():
        assert client.run_task("connect", address=sim.address)["outcome"] == "ok"
        for jump_at in (2, 80):
            texts = set()
            for _ in range(ABORTS if long_run else ABORTS_IN_SHORT):
                sim.remote.reset()
                texts.add(client.run_task("move", amplitude=0.1, jump_at=jump_at)["outcome"])
                assert client.run_task("recover")["mode"].endswith("Idle")
            assert len(texts) == 1, texts
            assert "motion aborted by reflex" in min(texts)


def test_lock_step_waits_for_a_silent_client_but_not_for_a_dead_one():
    with simulated("panda", "lockstep", patience=0.1) as sim:
        with connected(sim) as client:
            client.start(0, 0)
            client.state_until(lambda state: state.mode != MOVE)  # without an answer
            assert sim.remote.state().mode == "Reflex"
            assert client.reply()[1][0] == LAYOUTS[5].reflex
            client.recover()
    with simulated("panda", "lockstep", patience="forever") as sim:
        client = connected(sim)
        client.start(0, 0)
        client.reset()
        wait_for(lambda: sim.remote.state().mode != "Move", "The end of the motion")
        with connected(sim) as client:
            client.recover()
            assert client.state().mode == IDLE


@pytest.fixture
def robot_and_client():
    with simulated("fr3", "lockstep") as sim:
        yield sim, sim.connect()


class Stop:
    """Stops a process until STARVED has passed."""

    def __init__(self, process):
        self.ended = False
        os.kill(process.pid, signal.SIGSTOP)
        self._timer = threading.Timer(STARVED, self._end, (process.pid,))
        self._timer.start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._timer.join()

    def _end(self, pid: int):
        self.ended = True
        os.kill(pid, signal.SIGCONT)


def test_reading_a_state_outlives_a_starved_robot(robot_and_client):
    sim, client = robot_and_client
    client.read_once()
    with Stop(sim.server.process) as stop:
        # States that have arrived before are dropped.
        assert client.read_once().robot_mode == pyfranka.RobotMode.Idle
        assert stop.ended


@pytest.mark.parametrize("cycle", [0, 2])
def test_the_start_of_a_motion_outlives_a_starved_robot(robot_and_client, cycle):
    """The robot is stopped before the motion (0), or in its second cycle: the client cannot see yet that
    this robot's time is not the clock's."""
    sim, client = robot_and_client
    stops, cycles = [], 0

    def hold(state, period):
        nonlocal cycles
        cycles += 1
        if cycles == cycle:
            stops.append(stack.enter_context(Stop(sim.server.process)))
        command = pyfranka.Torques([0.0] * 7)
        return pyfranka.motion_finished(command) if cycles == 50 else command

    with ExitStack() as stack:
        if cycle == 0:
            stops.append(stack.enter_context(Stop(sim.server.process)))
        client.control_torques(hold)
        assert stops[0].ended
    assert cycles == 50
    assert client.read_once().robot_mode == pyfranka.RobotMode.Idle


def test_a_hand_that_is_starved_is_waited_for(robot_and_client):
    sim, _ = robot_and_client
    hand = sim.gripper()
    hand.read_once()
    with Stop(sim.server.process):
        for _ in range(3):
            assert hand.read_once().max_width == pytest.approx(0.08, abs=1e-3)


@pytest.mark.parametrize("in_motion", [False, True])
def test_a_dead_robot_is_noticed_by_its_connection(in_motion):
    """After a silence, which is waited for longer, clients report a time limit."""
    with simulated("panda", "lockstep") as sim:
        client, hand = sim.connect(), sim.gripper()

        def die(*_):
            sim.server.kill()
            return pyfranka.Torques([0.0] * 7)

        with pytest.raises(pyfranka.NetworkException, match="server closed connection"):
            if in_motion:
                client.control_torques(die)
            else:
                die()
                while True:
                    client.read_once()
        with pytest.raises(pyfranka.NetworkException, match="server closed connection"):
            while True:
                hand.read_once()
