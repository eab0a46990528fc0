# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A lock-step robot and its client on a starved machine: slower, but without failures or other results.

Either of the two is stopped in the middle of a motion, on a machine with as many busy processes as
processors (the long form: eight for each).
"""

from functools import partial

import pytest
from fci_session import client_process, simulated
from genuine_clients import client_python
from lock_step import moved
from starvation import busy

STOPPED = 0.7  # [s]
ABORTS, ABORTS_IN_SHORT = 30, 3


def test_lock_step_waits_for_a_starved_client_and_repeats():
    with simulated("panda", "lockstep") as sim, client_process("pyfranka") as client, busy():
        assert client.run_task("connect", address=sim.address)["outcome"] == "ok"
        for torque in (False, True):
            move = partial(moved, sim, client, torque, motion=3.0)
            hashes = [move(), move(client.process, STOPPED), move(sim.server.process, STOPPED)]
            assert len(set(hashes)) == 1, hashes
        assert sim.remote.state().mode == "Idle"


@pytest.mark.parametrize("library, robot", [("panda", "panda"), ("pylibfranka", "fr3")])
def test_an_abort_looks_the_same_to_a_genuine_client(library, robot, long_run):
    """Late clients would find states of the braking arm in place of the one that shows the abort."""
    process = client_process(library, client_python(library))
    with simulated(robot, "lockstep") as sim, process as client, busy():
        assert client.run_task("connect", address=sim.address)["outcome"] == "ok"
        for jump_at in (2, 80):
            texts = set()
            for _ in range(ABORTS if long_run else ABORTS_IN_SHORT):
                sim.remote.reset()
                texts.add(client.run_task("move", amplitude=0.1, jump_at=jump_at)["outcome"])
                assert client.run_task("recover")["mode"].endswith("Idle")
            assert len(texts) == 1, texts
            assert "motion aborted by reflex" in min(texts)
