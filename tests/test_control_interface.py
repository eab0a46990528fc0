# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Effects of franka_sim's control interface on a running motion: physics and protocol.

The client uses fci_wire in lock-step, so that each line acts between two of its cycles and results repeat.
"""

import struct
import subprocess

import pytest
from fci_motion import begin, drive, finish, hold
from fci_session import simulated
from fci_wire import COMMUNICATION, IDLE, LAYOUTS, MOVE, REFLEX, Client, connected
from genuine_clients import client_python
from pyfranka.remote import LineRefused

GRAVITY = 9.81
GUIDING, USER_STOPPED = 3, 5
CARTESIAN_REFLEX = 7  # the error's index


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
    sim.remote.fci(True)
    sim.remote.user_stop(False)
    sim.remote.guiding(False)
    sim.remote.loss(0)
    sim.remote.delay(0)
    sim.remote.load(0)


def force(state):
    """The force of O_F_ext_hat_K [N]."""
    number, offset = ("d", 1728) if state.layout is LAYOUTS[5] else ("f", 868)
    return struct.unpack_from("<3" + number, state.data, offset)


def set_load(client):
    """Sets a zero load. The reply comes when the world is at rest."""
    client.request({5: 10, 10: 9}[client.version], struct.pack("<13d", *[0.0] * 13))
    assert client.reply()[1][0] == 0


def test_loss_lowers_the_success_rate_and_repeats_with_its_seed(sim, client):
    """Each cycle's rate is the share of the last 100 commands that arrived."""
    runs = []
    for seed in (3, 3, 4):
        state, first = begin(client)
        state = drive(client, state, hold(first), 150)[-1]
        assert state.rate == 1.0
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


@pytest.mark.parametrize("count", [19, 20])
def test_consecutive_losses_lower_the_rate_until_the_motion_ends(sim, client, count):
    state, first = begin(client)
    state = drive(client, state, hold(first), 150)[-1]
    sim.remote.lose(count)
    states = drive(client, state, hold(first), 60)
    lowest = [round(100 * s.rate) for s in states if s.mode == MOVE][: count - 1]
    assert lowest == [100 - i for i in range(1, count)]
    if count == 19:
        assert states[-1].mode == MOVE
        finish(client, states[-1], first)
    else:
        assert states[-1].mode == REFLEX and states[-1].reasons == [COMMUNICATION]
        assert len(states) == 20
        assert client.reply()[1][0] == LAYOUTS[client.version].reflex
        client.recover()


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


def test_a_wrong_load_appears_as_an_upward_force(sim, client):
    """The arm carries nothing; a robot with a load of 0.8 kg estimates an upward force."""
    sim.remote.load(0.8, (0, 0, 0.05))
    state, first = begin(client)
    states = drive(client, state, hold(first), 1500)
    # The header's sign: forces from the robot on its environment are positive.
    assert force(states[-1]) == pytest.approx([0, 0, -0.8 * GRAVITY], abs=0.05)
    with pytest.raises(LineRefused, match="The load was refused"):
        sim.remote.load(0)
    state = drive(client, states[-1], hold(first), 50)[-1]
    assert force(state)[2] == pytest.approx(-0.8 * GRAVITY, abs=0.05)
    finish(client, state, first)


@pytest.mark.parametrize("axis, newtons", [(0, 8.0), (1, -8.0), (2, 8.0)])
def test_a_push_is_estimated_with_its_true_force(sim, client, axis, newtons):
    state, first = begin(client)
    state = drive(client, state, hold(first), 50)[-1]
    push = [0.0, 0.0, 0.0]
    push[axis] = newtons
    sim.remote.push(f"{sim.arm_id}_hand", push, 1500)
    pressed = drive(client, state, hold(first), 1490)
    felt = force(pressed[-1])
    assert felt == pytest.approx([-f for f in push], abs=0.08)
    bent = max(abs(a - b) for a, b in zip(pressed[-1].joints("q"), first))
    assert bent > 1e-4, "The arm has not given way."
    free = drive(client, pressed[-1], hold(first), 1500)[-1]
    assert force(free) == pytest.approx([0, 0, 0], abs=0.02)
    assert max(abs(a - b) for a, b in zip(free.joints("q"), first)) < 0.1 * bent
    finish(client, free, first)


def test_a_push_above_the_threshold_triggers_a_reflex(sim, client):
    state, first = begin(client)
    state = drive(client, state, hold(first), 50)[-1]
    sim.remote.push(f"{sim.arm_id}_hand", (0, 60, 0), 100)
    states = drive(client, state, hold(first), 100)
    assert states[-1].mode == REFLEX and CARTESIAN_REFLEX in states[-1].reasons
    assert len(states) < 50
    assert client.reply()[1][0] == LAYOUTS[client.version].reflex
    client.recover()


def test_the_user_stop_aborts_and_the_brakes_hold(sim, client):
    state, first = begin(client)
    state = drive(client, state, ramp(first), 300)[-1]
    assert max(map(abs, state.joints("dq"))) > 0.1
    sim.remote.user_stop(True)
    state = drive(client, state, lambda k: ramp(first)(k + 300), 10)[-1]
    assert state.mode == USER_STOPPED
    status = client.reply()[1][0]
    assert status not in (0, LAYOUTS[client.version].reflex)
    stopped = client.state_until(lambda s: max(map(abs, s.joints("dq"))) < 1e-3)
    assert abs(stopped.joints("q")[3] - state.joints("q")[3]) < 0.02
    sim.remote.user_stop(False)
    client.state_until(lambda s: s.mode == IDLE)
    state, first = begin(client)
    finish(client, state, first)


def test_guiding_ends_a_motion_and_leaves_the_arm_free(sim, client):
    state, first = begin(client)
    state = drive(client, state, hold(first), 50)[-1]
    sim.remote.guiding(True)
    state = drive(client, state, hold(first), 10)[-1]
    assert state.mode == GUIDING
    assert client.reply()[1][0] not in (0, LAYOUTS[client.version].reflex)
    before = client.state_until(lambda s: s.mode == GUIDING).joints("q")
    sim.remote.push(f"{sim.arm_id}_hand", (0, 5, 0), 500)
    moved = client.state_until(lambda s: max(abs(a - b) for a, b in zip(s.joints("q"), before)) > 0.02)
    assert moved.mode == GUIDING
    sim.remote.guiding(False)
    client.state_until(lambda s: s.mode == IDLE)


def test_guiding_does_not_delay_setters(sim, client):
    """No joint is braked then: the pushed arm coasts, so setters must not wait for rest."""
    sim.remote.guiding(True)
    sim.remote.push(f"{sim.arm_id}_link5", (0, 8, 0), 100)
    set_load(client)
    assert client.state_until(lambda s: s.mode == GUIDING).mode == GUIDING


GENUINE = {
    "panda": ("panda", "from panda_py import libfranka; libfranka.Robot('{}')"),
    "fr3": ("pylibfranka", "import pylibfranka as f; f.Robot('{}', f.RealtimeConfig.kIgnore)"),
}


def test_a_deactivated_interface_drops_its_client_and_refuses_others(sim, client):
    state, first = begin(client)
    drive(client, state, hold(first), 50)
    sim.remote.fci(False)
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
    sim.remote.fci(True)
    with connected(sim) as again:
        again.state_until(lambda s: s.mode == IDLE)
        state, first = begin(again)
        finish(again, state, first)


def test_losses_repeat_after_a_reset(sim):
    """The loss is set once; each run after a `reset` then loses the same commands."""
    sim.remote.loss(0.2, 3)
    hashes = set()
    for _ in range(2):
        sim.remote.reset()
        with connected(sim) as client:
            state, first = begin(client)
            state = drive(client, state, hold(first), 300)[-1]
            assert state.rate < 1.0
            finish(client, state, first)
            set_load(client)
        hashes.add(sim.remote.hash())
    sim.remote.loss(0)
    assert len(hashes) == 1
