# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Robots with clients behind a proxy, all in motion at the same time, for tests of a bad network."""

import sys
import warnings
from contextlib import ExitStack

from fci_proxy import Proxy
from fci_session import client_process, simulated
from genuine_clients import client_python, missing
from stalls import TRIES

PACE = 0.1
TICK = 1e-3 / PACE  # of the wall [s]
SECONDS = 0.6  # a motion's, of the robot's time
# So slow that nineteen extrapolated cycles stay within the jerk limit: their error is
# 2 n^3 / 6 times the jerk of 1.1 rad/s^3, at most 2600 of 5000 rad/s^3.
AMPLITUDE = 0.0005
LOST = "communication_constraints_violation"


class NetworkFixture:
    """A robot, its proxy, and a client that knows only the proxy."""

    def __init__(self, sim, proxy, client):
        self.sim, self.proxy, self.client = sim, proxy, client


def network_fixtures(
    stack: ExitStack, network: str, pace: str, kinds, *arguments: str
) -> list[NetworkFixture]:
    """One fixture for each library and robot of `kinds`, except for clients that PyPI lacks."""
    made = []
    for i, (library, robot) in enumerate(kinds):
        reason = None if library == "pyfranka" else missing(library)
        if reason:
            warnings.warn(f"{reason}: tested without this client", stacklevel=2)
            continue
        python = sys.executable if library == "pyfranka" else client_python(library)
        client = stack.enter_context(client_process(library, python))
        sim = stack.enter_context(simulated(robot, pace, *arguments))
        proxy = stack.enter_context(Proxy(f"{network}.{2 * i + 2}", sim.address, sim.protocol))
        made.append(NetworkFixture(sim, proxy, client))
    for fixture in made:
        fixture.client.give("connect", address=fixture.proxy.address)
    for fixture in made:
        assert fixture.client.result()["outcome"] == "ok"
    return made


def run(group, commands=None, states=None, seed=1, seconds=SECONDS, amplitude=AMPLITUDE, **task):
    """One motion of each client at the same time. `commands` and `states` make a rule."""
    for fixture in group:
        fixture.proxy.set(commands and commands(), states and states(), seed)
        fixture.client.give("move", seconds=seconds, amplitude=amplitude, **task)
    return [fixture.client.result() for fixture in group]


def recover(group):
    for fixture in group:
        answer = fixture.client.run_task("recover")
        assert answer["outcome"] == "ok" and answer["mode"] == "Idle", answer


def check_lost(group, results, most_wall):
    """Checks that the robots ended their motions with the reason, and continue after a recovery."""
    try:
        for fixture, result in zip(group, results):
            assert LOST in result["outcome"], result
            assert "motion aborted by reflex!" in result["outcome"], result
            assert result["wall"] < most_wall, result
            state = fixture.sim.remote.state()
            assert state.mode == "Reflex", state
    finally:
        recover([fixture for fixture in group if fixture.sim.remote.state().mode == "Reflex"])
    for result in run(group, seconds=0.2, amplitude=0.0):
        assert result["outcome"] == "ok", result


def slowest(ticks: float) -> float:
    """Limit for the end of a motion [s]: its ticks in wall time, and two seconds for a busy machine."""
    return ticks * TICK + 2.0


def survive(group, commands=None, states=None, least=None, **task):
    """Checks that every motion succeeds, and that the robots' success rate is the share that the proxy
    forwarded, or, if that is unknown, at least `least`.

    A busy machine loses additional cycles, which the same comparison shows: then the motions are repeated, at
    most `TRIES` times.
    """
    for seed in range(1, TRIES + 1):
        results = run(group, commands, states, seed, **task)
        quiet = True
        for fixture, result in zip(group, results):
            share, rates = fixture.proxy.commands.worst_share(), fixture.proxy.rates[101:]
            assert not rates or min(rates) <= share + 0.0101, "The robot counts commands that never came."
            undisturbed = rates and min(rates) > (share - 0.0101 if least is None else least)
            if result["outcome"] != "ok" and not undisturbed:
                recover([fixture])
            else:
                assert result["outcome"] == "ok", (result, fixture.proxy.commands.longest)
            quiet = quiet and undisturbed
        if quiet:
            return results
    raise AssertionError(f"The machine itself lost cycles in each of {TRIES} runs.")
