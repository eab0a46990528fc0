# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Runs of a simulated robot repeat bit for bit in lock-step, and agree with those of a patient robot.

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
from fci_session import simulated
from fci_wire import IDLE, JOINT_IMPEDANCE, JOINT_POSITION, MOVE, Client, command

LONG = bool(os.environ.get("FRANKA_TEST_LONG"))
RUNS = 100 if LONG else 3


def at_rest(client):
    """In lock-step a setter is answered when the world is at rest and time stands still again."""
    client.request(10 if client.version <= 5 else 9, bytes(104))  # SetLoad with zero mass
    assert client.reply()[1][0] == 0


def drive(client, ticks, positions, pause=None):
    """One motion. `positions(first, k)` gives the k-th command. @returns states and their hash."""
    state = client.start(JOINT_IMPEDANCE, JOINT_POSITION)
    first = state.joints("q_d")
    seen, states = hashlib.sha256(), []
    for k in range(ticks + 1):
        seen.update(state.data[8:])
        states.append(state)
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
    with simulated(robot, "lockstep", **SCENE) as sim, Client(sim.address, sim.protocol) as client:
        assert client.connect()[0] == 0
        loose = [100.0] * 28 + [300.0] * 24
        client.request(4 if sim.protocol <= 5 else 3, doubles(loose))
        assert client.reply()[1][0] == 0
        for run in range(RUNS):
            sim.remote.reset()
            chance = random.Random(run)

            def dawdle(k, run=run, chance=chance):
                if run % 2 == 1 and chance.random() < 0.01:
                    time.sleep(chance.random() * 2e-3)  # the fault itself

            states, client_hash = drive(client, TICKS, down_and_back, dawdle)
            at_rest(client)
            hashes.add((client_hash, sim.remote.state_hash()))
            pressed = max(abs(state.joints("tau_ext")[1]) for state in states)
            assert states[-1].errors == []
            assert pressed > 10.0, f"The arm has touched nothing: {pressed:.1f} Nm at joint 2."
    assert len(hashes) == 1, hashes


def doubles(values) -> bytes:
    return struct.pack(f"<{len(values)}d", *values)


def swing(first, k):
    q = list(first)
    q[3] += 0.1 * math.sin(math.pi * min(k, 1000) / 1000) ** 4
    q[5] -= 0.1 * math.sin(math.pi * min(k, 1000) / 1000) ** 4
    return q


def trajectory(robot, pace, pause=None):
    """@returns q of each cycle."""
    with simulated(robot, pace) as sim, Client(sim.address, sim.protocol) as client:
        assert client.connect()[0] == 0
        # Both must be at rest first; in real time that takes wall time, in lock-step none.
        client.state_until(lambda state: state.mode == IDLE and max(map(abs, state.joints("dq"))) < 1e-12)
        states, _ = drive(client, 1000, swing, pause)
    assert min(state.rate for state in states[2:]) == 1.0  # the first two are from before the motion
    return [state.joints("q") for state in states]


@pytest.mark.parametrize("robot, within", [("panda", 1e-9), ("fr3", 1e-6)])
def test_a_patient_robot_waits_for_a_late_client_and_moves_as_in_lock_step(robot, within):
    """Within 1e-9 rad; an FR3's states are single precision, which is 1e-7 rad of resolution."""

    def dawdle(k):
        if k % 100 == 99:
            time.sleep(0.06)  # the fault itself

    stepped, patient = trajectory(robot, "lockstep"), trajectory(robot, "patient", dawdle)
    assert len(patient) == len(stepped)
    assert max(abs(a - b) for p, q in zip(patient, stepped) for a, b in zip(p, q)) <= within
