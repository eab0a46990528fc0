# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Robots in lock-step take turns when there are more of them than processors (decision 65)."""

import os
import re
from contextlib import ExitStack
from pathlib import Path

import pytest
from fci_session import client_process, simulated
from lock_step import begin_motion, moved, stopped
from waiting import wait_for


@pytest.fixture
def one_processor():
    """Lets all programs that the test starts run on one processor."""
    all_of_them = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {min(all_of_them)})
    yield
    os.sched_setaffinity(0, all_of_them)


def turns() -> int:
    """How many robots on one processor have a turn; those of other tests run on all."""
    digit = "0" * (min(os.sched_getaffinity(0)) // 4) + f"{1 << min(os.sched_getaffinity(0)) % 4:x}"
    user = os.geteuid()
    folders = Path(f"/run/user/{user}/franka_sim"), Path(f"/tmp/franka_sim-{user}")
    places = {place.stat().st_ino for folder in folders for place in folder.glob(f"lock-step-{digit}.[0-9]*")}
    locks = Path("/proc/locks").read_text(encoding="utf-8")
    locked = re.findall(r"^\d+: FLOCK .*:(\d+) 0 EOF$", locks, re.MULTILINE)
    return len(places & set(map(int, locked)))


def test_three_pairs_on_one_processor_end_with_the_same_hash(one_processor):
    with ExitStack() as stack:
        sims = [stack.enter_context(simulated("panda", "lockstep")) for _ in range(3)]
        clients = [stack.enter_context(client_process("pyfranka")) for _ in sims]
        for sim, client in zip(sims, clients, strict=True):
            assert client.run_task("connect", address=sim.address)["outcome"] == "ok"
        alone = moved(sims[0], clients[0], motion=1.0)
        for sim, client in zip(sims, clients, strict=True):
            sim.remote.reset()
            client.give("move", seconds=1.0, amplitude=0.1)
        for sim, client in zip(sims, clients, strict=True):
            result = client.result(timeout=120.0)
            assert result["outcome"] == "ok", result
            assert client.run_task("set_load")["outcome"] == "ok"
            assert sim.remote.state_hash() == alone
        wait_for(lambda: turns() == 0)


def test_a_robot_that_is_stopped_in_its_turn_does_not_stop_the_others(one_processor):
    with (
        simulated("panda", "lockstep") as sim,
        simulated("fr3", "lockstep") as other,
        client_process("pyfranka") as client,
        client_process("pyfranka") as second,
    ):
        assert client.run_task("connect", address=sim.address)["outcome"] == "ok"
        assert second.run_task("connect", address=other.address)["outcome"] == "ok"
        begin_motion(client, seconds=1000.0, amplitude=0.0)
        wait_for(lambda: turns() == 1)
        with stopped(sim.server.process):
            assert second.run_task("move", seconds=2.0, amplitude=0.1)["outcome"] == "ok"
