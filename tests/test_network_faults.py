# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Effects of a bad network on a motion, with genuine clients and the project's own.

Loss (faults 1), late replies (faults 4) and the client's silence (faults 6). Each test checks the robot's
mode at the end, the error and the client's exception.

The robots run in lock-step behind a proxy that counts ticks. The clients of one test run in parallel.
"""

import signal
import time
from contextlib import ExitStack

import pytest
from fci_proxy import losing, losing_from
from lock_step import begin_motion
from network_fixtures import check_lost, network_fixtures, run, survive
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
        reconnect_after_error(fixture)


def reconnect_after_error(fixture):
    """The old connection may still hold states of the motion, whatever ended it."""
    wait_for(lambda: fixture.sim.remote.state().mode != "Move", "The end of the motion")
    fixture.proxy.set()
    assert fixture.client.run_task("connect", address=fixture.proxy.address)["outcome"] == "ok"
    if fixture.sim.remote.state().mode == "Reflex":
        fixture.client.run_task("recover")


def test_uniform_loss_of_states_is_survived(stepped):
    for result in survive(stepped, states=lambda: losing(0.05)):
        assert result["longest"] > 0.0015, "The client's clock has not skipped the lost states."


@pytest.mark.parametrize("count", [19, 20])
def test_the_boundary_is_exact_in_lock_step(stepped, count):
    if count < 20:
        survive(stepped, commands=lambda: losing_from(200, count))
        assert all(min(fixture.proxy.rates) == pytest.approx(0.81, abs=1e-6) for fixture in stepped)
    else:
        results = run(stepped, commands=lambda: losing_from(200, count), amplitude=0.0)
        check_lost(stepped, results)
        assert all(result["cycles"] <= 225 for result in results), results


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


def test_lock_step_drops_a_frozen_client(stepped):
    for fixture in stepped:
        fixture.proxy.set()
        begin_motion(fixture.client, seconds=ENDLESS, amplitude=0.0)
        fixture.client.process.send_signal(signal.SIGSTOP)
    for fixture in stepped:
        wait_for(lambda fixture=fixture: fixture.sim.remote.state().mode == "Reflex", "The reflex")
        fixture.client.process.send_signal(signal.SIGCONT)
    check_lost(stepped, [fixture.client.result() for fixture in stepped])
