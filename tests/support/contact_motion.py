# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Ten seconds in which an arm presses twice on a table: the scenario whose hashes are compared."""

import math
import struct

from fci_wire import JOINT_IMPEDANCE, JOINT_POSITION, Client, command

TICKS = 10000
# The table is under this arm's hand; the motion's target is a few millimeters below its top.
WORLD, BASE = "stone.xml", (-0.5, 0, 0.149)
SCENE = {"world": WORLD, "base": BASE}


def down_and_back(first, k):
    """The k-th joint positions: joints 2 and 4 move the hand down onto the table and back, twice."""
    x = math.sin(2 * math.pi * k / TICKS) ** 4
    q = list(first)
    q[1] += 0.5 * x
    q[3] -= 0.2 * x
    q[0] += 0.05 * math.sin(2 * math.pi * k / TICKS) ** 3
    return q


def press(address, protocol, first=None):
    """The motion by a client of a robot at an address. first: joint positions at its start; without them,
    those of the state in which it begins, which rounding makes differ from those before it (FR3).

    As libfranka's clients, it answers a state once, also if the robot sends it again while no time passes."""
    with Client(address, protocol) as client:
        assert client.connect()[0] == 0
        set_collision_behavior = 4 if protocol <= 5 else 3
        client.request(set_collision_behavior, struct.pack("<52d", *[100.0] * 28, *[300.0] * 24))
        assert client.reply()[1][0] == 0
        state = client.start(JOINT_IMPEDANCE, JOINT_POSITION)
        first = state.joints("q_d") if first is None else first
        for k in range(TICKS + 1):
            positions = down_and_back(first, k)
            client.send(command(protocol, state.message_id, positions, finished=k == TICKS))
            state = client.state_until(lambda new, last=state: new.message_id > last.message_id)
        assert client.reply()[1][0] == 0


def follow(sim, name, step):
    """The motion by the robot of a simulation of this process; step: ends a tick. Yields the hashes of the
    robot's states and of the world after each tick."""
    robot = sim[name]
    robot.set_collision_behavior([100.0] * 7, [100.0] * 7, [300.0] * 6, [300.0] * 6)
    first = robot.state.q_d.copy()
    for k in range(TICKS):
        robot.command(joint_positions=down_and_back(first, k))
        step()
        yield robot.state_hash(), sim.state_hash()
