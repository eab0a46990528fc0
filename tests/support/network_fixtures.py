# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Robots in lock-step with clients behind a proxy, all in motion at the same time."""

import sys
import warnings
from contextlib import ExitStack

import pytest
from fci_proxy import Proxy, worst_share
from fci_session import client_process, simulated
from genuine_clients import client_python, missing

SECONDS = 0.6  # a motion's, of the robot's time
# So slow that nineteen extrapolated cycles stay within the jerk limit: their error is
# 2 n^3 / 6 times the jerk of 1.1 rad/s^3, at most 2600 of 5000 rad/s^3.
AMPLITUDE = 0.0005
LOST = "communication_constraints_violation"


class NetworkFixture:
    """A robot, its proxy, and a client that knows only the proxy."""

    def __init__(self, sim, proxy, client):
        self.sim, self.proxy, self.client = sim, proxy, client


def network_fixtures(stack: ExitStack, network: str, kinds, **options) -> list[NetworkFixture]:
    """One fixture for each library and robot of `kinds`, except for clients that PyPI lacks.
    options: those of simulated()."""
    made = []
    for i, (library, robot) in enumerate(kinds):
        reason = None if library == "pyfranka" else missing(library)
        if reason:
            warnings.warn(f"{reason}: tested without this client", stacklevel=2)
            continue
        python = sys.executable if library == "pyfranka" else client_python(library)
        client = stack.enter_context(client_process(library, python))
        sim = stack.enter_context(simulated(robot, "lockstep", **options))
        proxy = stack.enter_context(Proxy(f"{network}.{2 * i + 2}", sim.address, sim.protocol))
        made.append(NetworkFixture(sim, proxy, client))
    for fixture in made:
        fixture.client.give("connect", address=fixture.proxy.address)
    for fixture in made:
        assert fixture.client.result()["outcome"] == "ok"
    return made


def run(group, commands=None, states=None, seconds=SECONDS, amplitude=AMPLITUDE):
    """One motion of each client at the same time. `commands` and `states` make a rule."""
    for fixture in group:
        fixture.proxy.set(commands and commands(), states and states())
        fixture.client.give("move", seconds=seconds, amplitude=amplitude)
    return [fixture.client.result() for fixture in group]


def recover(group):
    for fixture in group:
        answer = fixture.client.run_task("recover")
        assert answer["outcome"] == "ok" and answer["mode"] == "Idle", answer


def check_lost(group, results):
    """Checks that the robots ended their motions with the reason, and continue after a recovery."""
    try:
        for fixture, result in zip(group, results):
            assert LOST in result["outcome"], result
            assert "motion aborted by reflex!" in result["outcome"], result
            state = fixture.sim.remote.state()
            assert state.mode == "Reflex", state
    finally:
        recover([fixture for fixture in group if fixture.sim.remote.state().mode == "Reflex"])
    for result in run(group, seconds=0.2, amplitude=0.0):
        assert result["outcome"] == "ok", result


def survive(group, commands=None, states=None):
    """Checks that every motion succeeds, and that the robots' success rate is the share that the proxy
    forwarded."""
    results = run(group, commands, states)
    for fixture, result in zip(group, results):
        assert result["outcome"] == "ok", result
        passed = fixture.proxy.passed
        assert not all(passed), "Nothing was lost."
        # One command of a hundred: the last state may show one tick less than the proxy has counted.
        assert min(fixture.proxy.rates[101:]) == pytest.approx(worst_share(passed), abs=0.0101)
    return results
