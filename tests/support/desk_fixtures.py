# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A plugin of pytest with fixtures: a scripted robot with its Desk in this process."""

import pytest
from scripted_desk import desk_with_robot


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    """A robot and its Desk, of the newest generation, for all tests of a file."""
    with desk_with_robot(tmp_path_factory.mktemp("certificates")) as (robot, desk):
        yield robot, desk


@pytest.fixture
def robot(place):
    """The robot as it was first: it is locked."""
    robot, _ = place
    robot.reset()
    return robot


@pytest.fixture
def desk(place, robot):
    """Its Desk without logins and without control."""
    _, desk = place
    desk.clear()
    desk.refresh()
    robot.lines.clear()
    return desk


@pytest.fixture
def cookie(desk):
    """The headers of a user who has logged in."""
    return desk.log_in()


@pytest.fixture
def control(desk, cookie):
    """The headers of a user who has control."""
    return {**cookie, "X_Control_Token": desk.take_control(**cookie)["token"]}
