# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Joint motions of a client of fci_wire, cycle by cycle: nothing happens between two of its cycles."""

from collections.abc import Callable, Sequence

from fci_wire import JOINT_IMPEDANCE, JOINT_POSITION, MOVE, Client, State, command

Positions = Callable[[int], Sequence[float]]  # of the joints in a cycle [rad]


def begin(client: Client) -> tuple[State, tuple[float, ...]]:
    """The first state of a motion, and where it starts."""
    state = client.start(JOINT_IMPEDANCE, JOINT_POSITION)
    return state, state.joints("q_d")


def drive(client: Client, state: State, positions: Positions, cycles: int, finish=False) -> list[State]:
    """Commands positions for a number of cycles, while the robot moves. @returns the states that follow."""
    seen = []
    for k in range(cycles):
        if state.mode != MOVE:
            break
        last = finish and k == cycles - 1
        client.send(command(client.version, state.message_id, positions(k), finished=last))
        state = client.state()
        seen.append(state)
    return seen


def hold(first: Sequence[float]) -> Positions:
    """The same positions in all cycles."""
    return lambda k: first
