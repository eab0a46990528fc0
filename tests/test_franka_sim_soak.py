# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""franka_sim needs little memory, and its use does not grow: in a minute (long form: an hour) of the robot's
time in lock-step."""

import os

import pytest
from fci_session import client_process, descriptors_of, memory_of, simulated

LONG = bool(os.environ.get("FRANKA_TEST_LONG"))
MINUTES = 60 if LONG else 1


@pytest.mark.parametrize("robot", ["panda", "fr3"] if LONG else ["fr3"])
def test_memory_is_little_and_flat(robot):
    with simulated(robot, "lockstep") as sim, client_process("pyfranka") as client:
        pid = sim.server.process.pid
        assert client.run_task("connect", address=sim.address)["outcome"] == "ok"
        assert client.run_task("move", seconds=5.0, torque=True)["outcome"] == "ok"
        settled, descriptors = memory_of(pid), descriptors_of(pid)
        for _ in range(MINUTES):
            client.give("move", seconds=60.0, torque=True)
            result = client.result(timeout=300)
            assert result["outcome"] == "ok", result
        memory = memory_of(pid)
        assert memory <= 80.0, f"{memory:.1f} MB"
        assert memory - settled < 0.5, f"{settled:.1f} MB have grown to {memory:.1f} MB."
        assert descriptors_of(pid) == descriptors
