# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A lock-step robot and its client on a starved machine: slower, but without failures or other results.

Either of the two is stopped in the middle of a motion, on a machine with as many busy processes as
processors (the long form: eight for each).
"""

import os
import subprocess
import sys
import time
from contextlib import contextmanager

import pytest
from fci_session import client_process, simulated
from fci_wire import IDLE, LAYOUTS, MOVE, connected
from lock_step import moved

LONG = bool(os.environ.get("FRANKA_TEST_LONG"))
SPINNERS = (8 if LONG else 1) * os.cpu_count()
STOPPED = 0.7  # [s]; genuine clients give up after a second without a state


@contextmanager
def busy():
    spinners = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(SPINNERS)]
    try:
        yield
    finally:
        for spinner in spinners:
            spinner.kill()
            spinner.wait()


LIBRARIES = [("pyfranka", "panda"), ("pyfranka", "fr3")]


@pytest.mark.parametrize("library, robot", LIBRARIES)
def test_lock_step_waits_for_a_starved_client_and_repeats(library, robot):
    with simulated(robot, "lockstep") as sim, client_process(library) as client, busy():
        assert client.run_task("connect", address=sim.address)["outcome"] == "ok"
        for torque in (False, True):
            hashes = [
                moved(sim, client, torque),
                moved(sim, client, torque, client.process, STOPPED),
                moved(sim, client, torque, sim.server.process, STOPPED),
            ]
            assert len(set(hashes)) == 1, hashes
        assert sim.remote.state().mode == "Idle"


def test_lock_step_waits_for_a_silent_client_but_not_for_a_dead_one():
    with simulated("panda", "lockstep", "--patience", "0.1") as sim:
        with connected(sim) as client:
            client.start(0, 0)
            client.state_until(lambda state: state.mode != MOVE)  # without an answer
            assert sim.remote.state().mode == "Reflex"
            assert client.reply()[1][0] == LAYOUTS[5].reflex
            client.recover()
    with simulated("panda", "lockstep", "--patience", "forever") as sim:
        client = connected(sim)
        client.start(0, 0)
        client.reset()
        begin = time.monotonic()
        while sim.remote.state().mode == "Move":
            assert time.monotonic() - begin < 20.0, sim.remote.state()
        with connected(sim) as client:
            client.recover()
            assert client.state().mode == IDLE
