# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Effects of a bad network on a motion, with genuine clients and the project's own.

Loss (faults 1), delay (faults 2), damage (faults 3), TCP (faults 4), the client's silence and its death
(faults 6). Each test checks the robot's mode at the end, the error and the client's exception. Clients that
send single bytes are in test_raw_clients.

The robots run in lock-step behind a proxy that counts ticks. The clients of one test run in parallel.
"""

import signal
import struct
import time
from contextlib import ExitStack

import pytest
from fci_proxy import (
    bursts,
    duplicating,
    every,
    late_from,
    losing,
    losing_from,
    oversized,
    renumbered,
    stalling,
    truncated,
)
from fci_wire import COMMUNICATION, connected
from lock_step import begin_motion
from network_fixtures import AMPLITUDE, LOST, check_lost, network_fixtures, run, survive
from waiting import wait_for

PATIENCE = 5.0  # [s] of the robots
ENDLESS = 600.0  # [s] of the robot's time: longer than any motion that a fault ends


@pytest.fixture(scope="module")
def stepped():
    """Both genuine clients and our own."""
    with ExitStack() as stack:
        kinds = [("panda", "panda"), ("pylibfranka", "fr3"), ("pyfranka", "panda")]
        yield network_fixtures(stack, "127.0.24", kinds, patience=PATIENCE)


@pytest.fixture(autouse=True)
def all_idle(stepped):
    """A failed test must not cause failures of the next ones."""
    yield
    for fixture in stepped:
        if fixture.client.process.poll() is None:
            reconnect_after_error(fixture)


def wait_for_mode(fixture, mode: str) -> None:
    wait_for(lambda: fixture.sim.remote.state().mode == mode, f"Mode {mode}")


def reconnect_after_error(fixture):
    """The old connection may still hold states of the motion, whatever ended it."""
    wait_for(lambda: fixture.sim.remote.state().mode != "Move", "The end of the motion")
    fixture.proxy.set()
    assert fixture.client.run_task("connect", address=fixture.proxy.address)["outcome"] == "ok"
    if fixture.sim.remote.state().mode == "Reflex":
        fixture.client.run_task("recover")


# ---- 1: loss -----------------------------------------------------------------------------------------------


def test_uniform_loss_of_commands_is_survived_and_counted(stepped):
    survive(stepped, commands=lambda: losing(0.2))
    assert all(fixture.client.run_task("mode")["mode"] == "Idle" for fixture in stepped)


def test_uniform_loss_of_states_is_survived(stepped):
    for result in survive(stepped, states=lambda: losing(0.05)):
        assert result["longest"] > 0.0015, "The client's clock has not skipped the lost states."


def test_bursts_below_the_limit_are_survived(stepped):
    survive(stepped, commands=lambda: bursts(0.03, 0.1, 18))


@pytest.mark.parametrize("count", [19, 20])
def test_the_boundary_is_exact_in_lock_step(stepped, count):
    if count < 20:
        survive(stepped, commands=lambda: losing_from(200, count))
        assert all(min(fixture.proxy.rates) == pytest.approx(0.81, abs=1e-6) for fixture in stepped)
    else:
        results = run(stepped, commands=lambda: losing_from(200, count), amplitude=0.0)
        check_lost(stepped, results)
        assert all(result["cycles"] <= 225 for result in results), results


# ---- 2: delay ----------------------------------------------------------------------------------------------


def test_a_constantly_late_network_ends_the_motion_at_once(stepped):
    results = run(stepped, commands=lambda: late_from(150))
    check_lost(stepped, results)
    assert all(result["cycles"] <= 175 for result in results), results


def test_a_short_stall_with_its_backlog_is_survived(stepped):
    survive(stepped, states=lambda: stalling(150, 10))


# ---- 3: damage ---------------------------------------------------------------------------------------------


def flipped_id(data, chance):
    bit = chance.randrange(20, 64)  # not the newest state's message_id
    return struct.pack("<Q", struct.unpack_from("<Q", data)[0] ^ (1 << bit)) + data[8:]


NOISE = [
    duplicating,
    every(3, renumbered(-2)),
    every(3, renumbered(+3)),
    every(3, truncated),
    every(3, oversized),
    every(3, flipped_id),
]


def all_noise(number, data, chance):
    """Each kind in turn."""
    return NOISE[number // 10 % len(NOISE)](number, data, chance)


def check_undisturbed(group, results):
    for fixture, result in zip(group, results):
        assert result["outcome"] == "ok", result
        assert min(fixture.proxy.rates[101:]) == 1.0
        assert result["cycles"] <= 603


def test_invalid_answers_are_ignored(stepped):
    check_undisturbed(stepped, run(stepped, commands=lambda: all_noise))


def old_again():
    """Each state comes twice, then the one before it."""
    kept = []

    def rule(number, data, chance):
        kept[:] = [data, data, *kept[:1]]
        return list(kept)

    return rule


def test_duplicate_and_late_states_are_delivered_once(stepped):
    check_undisturbed(stepped, run(stepped, states=old_again))


def test_our_client_reports_invalid_states(stepped):
    """The client drops a state of the wrong size; the robot then misses its answers and stops."""
    own = stepped[-1:]  # the last one: genuine clients may be left out
    (result,) = run(own, states=lambda: lambda number, data, chance: [data[:-1]])
    assert result["outcome"].startswith("ProtocolException"), result
    reconnect_after_error(own[0])
    assert run(own, seconds=0.2, amplitude=0.0)[0]["outcome"] == "ok"


# ---- 4: TCP ------------------------------------------------------------------------------------------------


def test_replies_may_take_longer_than_a_second(stepped):
    for fixture in stepped:
        fixture.proxy.hold_replies()
        fixture.client.give("set_load")
    for fixture in stepped:
        wait_for(lambda fixture=fixture: fixture.proxy.holds_a_reply, "The robot's reply")
    time.sleep(1.2)  # the fault itself
    for fixture in stepped:
        fixture.proxy.release_replies()
    assert [fixture.client.result()["outcome"] for fixture in stepped] == ["ok"] * len(stepped)


# ---- 6: signals and death ---------------------------------------------------------------------------------


def test_lock_step_drops_a_frozen_client(stepped):
    for fixture in stepped:
        fixture.proxy.set()
        begin_motion(fixture.client, seconds=ENDLESS, amplitude=0.0)
        fixture.client.process.send_signal(signal.SIGSTOP)
    for fixture in stepped:
        wait_for_mode(fixture, "Reflex")
        fixture.client.process.send_signal(signal.SIGCONT)
    check_lost(stepped, [fixture.client.result() for fixture in stepped])


def test_a_killed_client_ends_its_motion_and_frees_the_robot(stepped):
    """Must be last: it kills the clients."""
    for fixture in stepped:
        fixture.proxy.set()
        begin_motion(fixture.client, seconds=ENDLESS, amplitude=AMPLITUDE)
        fixture.client.process.kill()
    for fixture in stepped:
        wait_for_mode(fixture, "Reflex")
        assert LOST in fixture.sim.remote.state().errors
        with connected(fixture.sim) as client:
            assert client.state().reasons == [COMMUNICATION]
            client.recover()
