# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A lock-step robot and its client on a starved machine: slower, but without failures or other results.

Either of the two is stopped in the middle of a motion, on a machine with as many busy processes as
processors (the long form: eight for each).
"""

import os
import signal
import threading
import time

import pyfranka
import pytest
from fci_session import client_process, simulated
from fci_wire import IDLE, LAYOUTS, MOVE, connected
from lock_step import moved
from starvation import busy

STOPPED = 0.7  # [s]; genuine clients give up after a second without a state
STARVED = 1.5  # [s]; our client waits 5 s for a robot on its own machine
AT_ONCE = 3.0  # [s]; less than these 5 s, on a busy machine too

LIBRARIES = [("pyfranka", "panda"), ("pyfranka", "fr3")]


@pytest.mark.parametrize("library, robot", LIBRARIES)
def test_lock_step_waits_for_a_starved_client_and_repeats(library, robot):
    with simulated(robot, "lockstep") as sim, client_process(library) as client, busy():
        assert client.run_task("connect", address=sim.address)["outcome"] == "ok"
        for torque in (False, True):
            hashes = [
                moved(sim, client, torque),
                moved(sim, client, torque, client.process, STOPPED),
                moved(sim, client, torque, sim.server.process, STOPPED),
            ]
            assert len(set(hashes)) == 1, hashes
        assert sim.remote.state().mode == "Idle"


def test_lock_step_waits_for_a_silent_client_but_not_for_a_dead_one():
    with simulated("panda", "lockstep", "--patience", "0.1") as sim:
        with connected(sim) as client:
            client.start(0, 0)
            client.state_until(lambda state: state.mode != MOVE)  # without an answer
            assert sim.remote.state().mode == "Reflex"
            assert client.reply()[1][0] == LAYOUTS[5].reflex
            client.recover()
    with simulated("panda", "lockstep", "--patience", "forever") as sim:
        client = connected(sim)
        client.start(0, 0)
        client.reset()
        begin = time.monotonic()
        while sim.remote.state().mode == "Move":
            assert time.monotonic() - begin < 20.0, sim.remote.state()
        with connected(sim) as client:
            client.recover()
            assert client.state().mode == IDLE


@pytest.fixture(params=["panda", "fr3"])
def robot_and_client(request):
    with simulated(request.param, "lockstep") as sim:
        yield sim, sim.connect()


def stop_for_a_while(process):
    """Stops a process now, and lets it go on after STARVED. @returns the timer, to be joined"""
    os.kill(process.pid, signal.SIGSTOP)
    timer = threading.Timer(STARVED, os.kill, (process.pid, signal.SIGCONT))
    timer.start()
    return timer


def test_reading_a_state_outlives_a_starved_robot(robot_and_client):
    sim, client = robot_and_client
    client.read_once()
    timer, begin = stop_for_a_while(sim.server.process), time.monotonic()
    try:
        # States that have arrived before are dropped.
        assert client.read_once().robot_mode == pyfranka.RobotMode.Idle
        assert time.monotonic() - begin >= STARVED
    finally:
        timer.join()


@pytest.mark.parametrize("cycle", [0, 2])
def test_the_start_of_a_motion_outlives_a_starved_robot(robot_and_client, cycle):
    """The robot is stopped before the motion (0), or in its second cycle: the client cannot see yet that
    this robot's time is not the clock's."""
    sim, client = robot_and_client
    timers, cycles = [], 0

    def hold(state, period):
        nonlocal cycles
        cycles += 1
        if cycles == cycle:
            timers.append(stop_for_a_while(sim.server.process))
        command = pyfranka.Torques([0.0] * 7)
        return pyfranka.motion_finished(command) if cycles == 50 else command

    begin = time.monotonic()
    if cycle == 0:
        timers.append(stop_for_a_while(sim.server.process))
    try:
        client.control_torques(hold)
    finally:
        timers[0].join()
    assert time.monotonic() - begin >= STARVED
    assert cycles == 50
    assert client.read_once().robot_mode == pyfranka.RobotMode.Idle


def test_a_hand_that_is_starved_is_waited_for(robot_and_client):
    sim, _ = robot_and_client
    hand = sim.gripper()
    hand.read_once()
    timer = stop_for_a_while(sim.server.process)
    try:
        for _ in range(3):
            assert hand.read_once().max_width == pytest.approx(0.08, abs=1e-3)
    finally:
        timer.join()


@pytest.mark.parametrize("in_motion", [False, True])
def test_a_dead_robot_is_noticed_at_once(in_motion):
    with simulated("panda", "lockstep") as sim:
        client, hand = sim.connect(), sim.gripper()
        died = []

        def die(*_):
            sim.server.kill()
            died.append(time.monotonic())
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
        assert time.monotonic() - died[0] < AT_ONCE, "Silence is waited for longer."
