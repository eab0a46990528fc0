# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Runs of a simulated robot repeat bit for bit in lock-step, and agree with those in real time.

The client hashes the bytes of every received state without its message_id, and the robot hashes every state
itself, so that no difference is missed.
"""

import hashlib
import math
import os
import random
import struct
import time

import pytest
from contact_motion import SCENE, TICKS, down_and_back
from fci_session import go_first, go_with_all, simulated
from fci_wire import IDLE, JOINT_IMPEDANCE, JOINT_POSITION, MOVE, REFLEX, Client, command

LONG = bool(os.environ.get("FRANKA_TEST_LONG"))
RUNS = 100 if LONG else 5


def at_rest(client):
    """In lock-step a setter is answered when the world is at rest and time stands still again."""
    client.request(10 if client.version <= 5 else 9, bytes(104))  # SetLoad with zero mass
    assert client.reply()[1][0] == 0


class CommandsLost(AssertionError):
    """The robot lost commands and ended the motion, as on a machine that stalls."""


def smallest_rate(states):
    """Smallest success rate; the first two states are from before the motion."""
    return min((state.rate for state in states[2:]), default=1.0)


def drive(client, ticks, positions, pause=None):
    """One motion. `positions(first, k)` gives the k-th command. @returns states and their hash."""
    state = client.start(JOINT_IMPEDANCE, JOINT_POSITION)
    first = state.joints("q_d")
    seen, states = hashlib.sha256(), []
    for k in range(ticks + 1):
        seen.update(state.data[8:])
        states.append(state)
        if state.mode == REFLEX and smallest_rate(states) < 1.0:
            raise CommandsLost(k, state.reasons)
        assert state.mode == MOVE, (k, state.reasons)
        if pause is not None:
            pause(k)
        client.send(command(client.version, state.message_id, positions(first, k), finished=k == ticks))
        state = client.state()
    assert state.mode == IDLE, state.reasons
    assert client.reply()[1][0] == 0
    return states, seen.hexdigest()


@pytest.mark.parametrize("robot", ["panda", "fr3"] if LONG else ["panda"])
def test_lock_step_repeats_bit_for_bit_with_contact(robot):
    """Ten seconds, each time from a reset world; some runs have a slow client."""
    hashes = set()
    with simulated(robot, "lockstep", *SCENE) as sim, Client(sim.address, sim.protocol) as client:
        assert client.connect()[0] == 0
        loose = [100.0] * 28 + [300.0] * 24
        client.request(4 if sim.protocol <= 5 else 3, doubles(loose))
        assert client.reply()[1][0] == 0
        for run in range(RUNS):
            sim.remote.reset()
            chance = random.Random(run)

            def dawdle(k, run=run, chance=chance):
                if run % 2 == 1 and chance.random() < 0.01:
                    time.sleep(chance.random() * 2e-3)

            states, client_hash = drive(client, TICKS, down_and_back, dawdle)
            at_rest(client)
            hashes.add((client_hash, sim.remote.hash()))
            pressed = max(abs(state.joints("tau_ext")[1]) for state in states)
            assert states[-1].errors == []
            assert pressed > 10.0, f"The arm has touched nothing: {pressed:.1f} Nm at joint 2."
    assert len(hashes) == 1, hashes


@pytest.fixture(autouse=True)
def before_other_work():
    """The client is in this process; in lock-step it must not be silent for half a second."""
    go_first()
    yield
    go_with_all()


def doubles(values) -> bytes:
    return struct.pack(f"<{len(values)}d", *values)


def test_another_command_gives_another_hash():
    """The hash must differ between different runs."""
    with simulated("panda", "lockstep") as sim, Client(sim.address, 5) as client:
        assert client.connect()[0] == 0
        hashes = []
        for change in (0.0, 0.0, 1e-12):
            sim.remote.reset()

            def hold(first, k, change=change):
                return [q + (change if k == 299 else 0.0) for q in first]

            _, seen = drive(client, 300, hold)
            at_rest(client)
            hashes.append((seen, sim.remote.hash()))
    assert hashes[0] == hashes[1]
    assert hashes[0][0] != hashes[2][0] and hashes[0][1] != hashes[2][1]


def swing(first, k):
    q = list(first)
    q[3] += 0.1 * math.sin(math.pi * min(k, 1000) / 1000) ** 4
    q[5] -= 0.1 * math.sin(math.pi * min(k, 1000) / 1000) ** 4
    return q


def trajectory(robot, pace, dawdle=None):
    """@returns q of each cycle, the smallest success rate, and the motion's wall time [s].

    No positions, and a rate of 0, if lost commands have ended the motion.
    """
    with simulated(robot, pace) as sim, Client(sim.address, sim.protocol) as client:
        assert client.connect()[0] == 0
        # Both must be at rest first; in real time that takes wall time, in lock-step none.
        client.state_until(lambda state: state.mode == IDLE and max(map(abs, state.joints("dq"))) < 1e-12)
        begin = time.monotonic()
        try:
            states, _ = drive(client, 1000, swing, dawdle)
        except CommandsLost:
            return [], 0.0, 0.0
        wall = time.monotonic() - begin
    return [state.joints("q") for state in states], smallest_rate(states), wall


def difference(one, other):
    assert len(one) == len(other)
    return max(abs(a - b) for p, q in zip(one, other) for a, b in zip(p, q))


@pytest.mark.parametrize("robot, within", [("panda", 1e-9), ("fr3", 1e-6)] if LONG else [("panda", 1e-9)])
def test_the_wall_clock_gives_the_same_trajectory(robot, within):
    """Within 1e-9 rad; an FR3's states are single precision, which is 1e-7 rad of resolution."""
    stepped, rate, _ = trajectory(robot, "lockstep")
    assert rate == 1.0
    for pace in (["realtime"] if LONG else []) + ["0.25", "0.1", "0.05"]:
        by_clock, rate, _ = trajectory(robot, pace)
        if rate == 1.0:
            break  # A busy machine loses commands of a robot in real time.
    assert rate == 1.0, "The robot lost commands at each pace."
    assert difference(by_clock, stepped) <= within


@pytest.mark.parametrize("robot, within", [("panda", 1e-9), ("fr3", 1e-6)])
def test_a_patient_robot_keeps_real_time_and_waits_for_a_late_client(robot, within):
    stepped, _, _ = trajectory(robot, "lockstep")

    def dawdle(k):
        if k % 100 == 99:
            time.sleep(0.06)  # far more than twenty cycles

    by_clock, rate, wall = trajectory(robot, "patient", dawdle)
    assert rate == 1.0
    assert difference(by_clock, stepped) <= within
    assert 1.0 < wall < 2.5
