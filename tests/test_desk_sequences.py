# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Desk answers the requests of clients that no registry has, as they write them; then the robot moves."""

import pytest
from desk_sequences import SEQUENCES
from desk_session import move, robot_with_desk
from desk_wire import Player

CASES = [(sequence, profile) for sequence in SEQUENCES for profile in sequence.profiles]
NAMES = [f"{sequence.name}-{profile}" for sequence, profile in CASES]


def hold_control(desk, sequence) -> None:
    """Another user's page takes control."""
    other = Player(sequence, desk)
    other.play([step for step in sequence.start if step.method == "POST"][:2])
    other.wire.close()


@pytest.mark.parametrize("sequence, profile", CASES, ids=NAMES)
def test_client_starts_the_robot_and_ends(sequence, profile, tmp_path):
    with robot_with_desk(tmp_path, profile, options=sequence.options) as desk:
        if sequence.held:
            hold_control(desk, sequence)
        player = Player(sequence, desk)
        player.play(sequence.start)
        desk.wait(lambda report: report["fci"] and not any(report["brakes"]))
        move(desk.robot)
        player.play(sequence.end)
        active = profile == "fer-old" and not sequence.closed
        desk.wait(lambda report: report["fci"] == active and all(report["brakes"]) == sequence.closed)
