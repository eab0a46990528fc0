# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The simulated robots that the tests of pyfranka share."""

from contextlib import ExitStack

import pyfranka
import pytest
from fci_session import simulated

ADDRESSES = {"panda": "127.0.32.1", "fr3": "127.0.32.2"}


@pytest.fixture(scope="session")
def addresses():
    return ADDRESSES


@pytest.fixture(scope="session")
def robots():
    with ExitStack() as stack:
        for robot in ADDRESSES:
            stack.enter_context(simulated(robot, ADDRESSES[robot], "lockstep"))
        yield {
            name: pyfranka.Robot(address, pyfranka.RealtimeConfig.Ignore)
            for name, address in ADDRESSES.items()
        }


@pytest.fixture(params=["panda", "fr3"])
def name(request):
    return request.param


@pytest.fixture
def robot(robots, name):
    robots[name].automatic_error_recovery()
    yield robots[name]
    assert robots[name].read_once().robot_mode == pyfranka.RobotMode.Idle
