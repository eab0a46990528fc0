# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Desk answers the requests of clients that no registry has, as they write them."""

from contextlib import contextmanager

import pytest
from desk_fixtures import desk_with_robot
from desk_sequences import SEQUENCES
from desk_server import PASSWORD, USER
from desk_wire import Player
from waiting import wait_for

CASES = [(sequence, profile) for sequence in SEQUENCES for profile in sequence.profiles]
NAMES = [f"{sequence.name}-{profile}" for sequence, profile in CASES]


class Place:
    """Where a player connects, and the robot whose buttons it presses."""

    address, user, password = "127.0.0.1", USER, PASSWORD

    def __init__(self, robot, port):
        self.robot, self.port = robot, port

    @contextmanager
    def held(self, name):
        button = name.removeprefix("button ")
        self.robot.report["buttons"][button] = True
        yield
        self.robot.report["buttons"][button] = False


@pytest.mark.parametrize("sequence, profile", CASES, ids=NAMES)
def test_client_starts_the_robot_and_ends(sequence, profile, tmp_path):
    with desk_with_robot(tmp_path, profile, **dict.fromkeys(sequence.options, True)) as (robot, desk):
        if sequence.held:
            desk.take_control("another user")
        player = Player(sequence, Place(robot, desk.port))
        player.play(sequence.start)
        wait_for(lambda: robot.report["fci"] and not any(robot.report["brakes"]), "The active FCI")
        player.play(sequence.end)
        active = profile == "fer-old" and not sequence.closed
        assert robot.report["fci"] == active and all(robot.report["brakes"]) == sequence.closed
