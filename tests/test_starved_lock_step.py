# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A lock-step robot and its client on a starved machine: slower, but without failures or other results."""

from functools import partial

import pytest
from fci_session import client_process, simulated
from lock_step import moved
from starvation import busy

STOPPED = 0.7  # [s]


@pytest.mark.long_form("starves the machine")
def test_lock_step_waits_for_a_starved_client_and_repeats():
    """Either of the two is stopped in the middle of a motion, among eight busy processes a processor."""
    with simulated("panda", "lockstep") as sim, client_process("pyfranka") as client, busy():
        assert client.run_task("connect", address=sim.address)["outcome"] == "ok"
        for torque in (False, True):
            move = partial(moved, sim, client, torque, motion=3.0)
            hashes = [move(), move(client.process, STOPPED), move(sim.server.process, STOPPED)]
            assert len(set(hashes)) == 1, hashes
        assert sim.remote.state().mode == "Idle"
