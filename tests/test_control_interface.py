# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Effects of franka_sim's control interface on a running motion: physics and protocol.

The client uses fci_wire in lock-step, so that each line acts between two of its cycles and results repeat.
"""

import subprocess

import pytest
from fci_motion import begin, drive, finish, hold
from fci_session import simulated
from fci_wire import IDLE, LAYOUTS, Client, connected
from genuine_clients import client_python
from pyfranka.remote import LineRefused

GUIDING, USER_STOPPED = 3, 5


@pytest.fixture(scope="module", params=["panda", "fr3"])
def sim(request):
    with simulated(request.param, "lockstep") as sim:
        yield sim


@pytest.fixture
def client(sim):
    sim.remote.reset()
    with Client(sim.address, sim.protocol) as client:
        assert client.connect() == (0, sim.protocol)
        yield client
    sim.remote.activate_fci()
    sim.remote.set_user_stop(False)
    sim.remote.set_guiding(False)
    sim.remote.loss(0)
    sim.remote.delay(0)


def test_loss_lowers_the_success_rate_and_repeats_with_its_seed(sim, client):
    """Each cycle's rate is the share of the last 100 commands that arrived."""
    runs = []
    for seed in (3, 3, 4):
        state, first = begin(client)
        state = drive(client, state, hold(first), 150)[-1]
        assert state.rate == 1.0
        with pytest.raises(LineRefused, match="The load was refused"):
            sim.remote.set_load(0.8)
        sim.remote.loss(0.2, seed)
        states = drive(client, state, hold(first), 2000)
        runs.append([round(100 * s.rate) for s in states])
        sim.remote.loss(0)
        state = drive(client, states[-1], hold(first), 101)[-1]
        assert state.rate == 1.0, "It is over, but the robot still counts it."
        finish(client, state, first)
    rates = runs[0][100:]
    # 1900 commands or more: five standard deviations of the binomial distribution are 0.046.
    assert sum(rates) / len(rates) == pytest.approx(80.0, abs=4.6)
    assert all(abs(a - b) <= 1 for a, b in zip(rates, rates[1:]))
    assert runs[0] == runs[1] and runs[0] != runs[2]


def ramp(first):
    """Joint 4 moves with a smooth velocity: 0.05 rad in half a second after 50 cycles at rest."""

    def positions(k):
        x = min(max((k - 50) / 500, 0.0), 1.0)
        q = list(first)
        q[3] += 0.05 * x**3 * (10 - 15 * x + 6 * x * x)
        return q

    return positions


def test_a_delay_shifts_commands_by_whole_cycles(sim, client):
    desired = {}
    for ticks in (0, 1, 2):
        sim.remote.reset()
        sim.remote.delay(ticks)
        state, first = begin(client)
        states = drive(client, state, ramp(first), 600)
        desired[ticks] = [s.joints("q_d")[3] - first[3] for s in states]
        finish(client, states[-1], ramp(first)(600))
    resolution = 1e-12 if client.version == 5 else 5e-7  # of the state's numbers
    for ticks in (1, 2):
        shifted = desired[ticks][ticks:]
        assert shifted == pytest.approx(desired[0][: len(shifted)], abs=resolution)
        assert max(abs(a - b) for a, b in zip(desired[ticks], desired[0])) > 1e-4 * ticks


def test_the_user_stop_aborts_and_the_brakes_hold(sim, client):
    state, first = begin(client)
    state = drive(client, state, ramp(first), 300)[-1]
    assert max(map(abs, state.joints("dq"))) > 0.1
    sim.remote.set_user_stop(True)
    state = drive(client, state, lambda k: ramp(first)(k + 300), 10)[-1]
    assert state.mode == USER_STOPPED
    status = client.reply()[1][0]
    assert status not in (0, LAYOUTS[client.version].reflex)
    stopped = client.state_until(lambda s: max(map(abs, s.joints("dq"))) < 1e-3)
    assert abs(stopped.joints("q")[3] - state.joints("q")[3]) < 0.02
    sim.remote.set_user_stop(False)
    client.state_until(lambda s: s.mode == IDLE)
    state, first = begin(client)
    finish(client, state, first)


def test_guiding_ends_a_motion_and_leaves_the_arm_free(sim, client):
    state, first = begin(client)
    state = drive(client, state, hold(first), 50)[-1]
    sim.remote.set_guiding(True)
    state = drive(client, state, hold(first), 10)[-1]
    assert state.mode == GUIDING
    assert client.reply()[1][0] not in (0, LAYOUTS[client.version].reflex)
    before = client.state_until(lambda s: s.mode == GUIDING).joints("q")
    sim.remote.push(f"{sim.name}_hand", (0, 5, 0), ticks=500)
    moved = client.state_until(lambda s: max(abs(a - b) for a, b in zip(s.joints("q"), before)) > 0.02)
    assert moved.mode == GUIDING
    sim.remote.set_guiding(False)
    client.state_until(lambda s: s.mode == IDLE)


GENUINE = {
    "panda": ("panda", "from panda_py import libfranka; libfranka.Robot('{}')"),
    "fr3": ("pylibfranka", "import pylibfranka as f; f.Robot('{}', f.RealtimeConfig.kIgnore)"),
}


def test_a_deactivated_interface_drops_its_client_and_refuses_others(sim, client):
    state, first = begin(client)
    drive(client, state, hold(first), 50)
    sim.remote.deactivate_fci()
    aborted = LAYOUTS[client.version].reflex + 3
    assert client.reply()[1][0] == aborted
    assert client.ended()
    library, program = GENUINE[sim.kind]
    refused = subprocess.run(
        [client_python(library), "-c", program.format(sim.address)],
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert (
        "libfranka: Connection to FCI refused. Please install FCI feature or enable FCI mode in Desk."
        in refused.stderr
    )
    sim.remote.activate_fci()
    with connected(sim) as again:
        again.state_until(lambda s: s.mode == IDLE)
        state, first = begin(again)
        finish(again, state, first)
