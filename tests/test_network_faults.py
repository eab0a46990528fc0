# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Effects of a bad network and a busy machine on a motion, with genuine clients and the project's own.

Loss (faults 1), delay (faults 2), damage (faults 3), TCP (faults 4), the client's timing (faults 5) and its
death (faults 6). Each test checks the robot's mode at the end, the error, the client's exception and the time
that this takes. Clients that send single bytes are in test_raw_clients.

Tests that depend on time run the robots at a tenth of real time, so that the proxy in Python and a busy
machine cause no faults; the others run in lock-step. The clients of one test run in parallel.
"""

import os
import signal
import struct
import subprocess
import sys
import time
from contextlib import ExitStack, contextmanager

import pytest
from fci_proxy import (
    bursts,
    delaying,
    duplicating,
    every,
    losing,
    losing_from,
    oversized,
    renumbered,
    stalling,
    truncated,
)
from fci_session import go_first, go_with_all
from fci_wire import COMMUNICATION, connected
from network_fixtures import (
    AMPLITUDE,
    LOST,
    PACE,
    SECONDS,
    TICK,
    check_lost,
    network_fixtures,
    recover,
    run,
    slowest,
    survive,
)
from stalls import TRIES, in_time

pytestmark = pytest.mark.alone  # counts lost commands

LONG = bool(os.environ.get("FRANKA_TEST_LONG"))
ENDLESS = 60.0  # [s] of the robot's time: longer than any motion that a fault ends


@pytest.fixture(autouse=True)
def all_idle(request):
    """A failed test must not cause failures of the next ones."""
    yield
    for name in ("slow", "stepped", "patient"):
        for fixture in request.node.funcargs.get(name, []):
            if fixture.client.process.poll() is None:
                end_motion(fixture)


def end_motion(fixture):
    """A client after a timeout leaves its robot in Move until the robot's patience ends."""
    deadline = time.monotonic() + 10.0
    while fixture.sim.remote.state().mode == "Move" and time.monotonic() < deadline:
        time.sleep(0.05)
    if fixture.sim.remote.state().mode == "Reflex":
        fixture.client.run_task("connect", address=fixture.proxy.address)
        fixture.client.run_task("recover")


@pytest.fixture(scope="module")
def slow():
    """Both genuine clients and our own, at a tenth of real time."""
    with ExitStack() as stack:
        kinds = [("panda", "panda"), ("pylibfranka", "fr3"), ("pyfranka", "fr3")]
        yield network_fixtures(stack, "127.0.23", str(PACE), kinds)


@pytest.fixture(scope="module")
def stepped():
    """The same in lock-step."""
    with ExitStack() as stack:
        kinds = [("panda", "panda"), ("pylibfranka", "fr3"), ("pyfranka", "panda")]
        yield network_fixtures(stack, "127.0.24", "lockstep", kinds, "--patience", "0.5")


@pytest.fixture(scope="module")
def patient():
    """In real time, but waiting for late clients."""
    with ExitStack() as stack:
        yield network_fixtures(stack, "127.0.27", "patient", [("panda", "panda"), ("pyfranka", "fr3")])


# ---- 1: loss -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("percent", [0, 0.1, 1, 5, 10, 20] if LONG else [20])
def test_uniform_loss_of_commands_is_survived_and_counted(slow, percent):
    survive(slow, commands=lambda: losing(percent / 100))
    assert all(fixture.client.run_task("mode")["mode"] == "Idle" for fixture in slow)


@pytest.mark.parametrize("percent", [1, 5, 20] if LONG else [5])
def test_uniform_loss_of_states_is_survived(slow, percent):
    for result in survive(slow, states=lambda: losing(percent / 100), least=0.95 - 2 * percent / 100):
        assert result["longest"] > 0.0015, "No state was lost."


@pytest.mark.parametrize("longest", [1, 5, 10, 18] if LONG else [18])
def test_bursts_below_the_limit_are_survived(slow, longest):
    survive(slow, commands=lambda: bursts(0.03, 0.1, longest))


@pytest.mark.parametrize("count", [19, 20, 21] if LONG else [19, 20])
def test_twenty_consecutive_lost_commands_end_the_motion(slow, count):
    if count < 20:
        survive(slow, commands=lambda: losing_from(200, count))
        assert all(min(fixture.proxy.rates[101:]) <= 0.81 + 1e-6 for fixture in slow)
    else:
        results = run(slow, commands=lambda: losing_from(200, count), amplitude=0.0)
        check_lost(slow, results, slowest(230))
        assert all(result["cycles"] <= 225 for result in results)


@pytest.mark.parametrize("count", [19, 20, 21])
def test_the_boundary_is_exact_in_lock_step(stepped, count):
    """The robot's own link loses them, so that neither wall time nor load matters."""
    seconds = SECONDS if count < 20 else ENDLESS  # in lock-step a short one may end before it loses them
    for fixture in stepped:
        fixture.client.give("move", seconds=seconds, amplitude=AMPLITUDE, announce=True)
    for fixture in stepped:
        assert fixture.client.line() == "moving"
        fixture.sim.remote.lose(count)
    results = [fixture.client.result() for fixture in stepped]
    if count < 20:
        assert all(result["outcome"] == "ok" for result in results), results
    else:
        check_lost(stepped, results, 10.0)


# ---- 2: delay ----------------------------------------------------------------------------------------------

DELAYS = {
    "half a cycle each way": lambda: delaying(0.25 * TICK),
    "normal jitter": lambda: delaying(lambda chance: chance.gauss(0.4, 0.2) * TICK),
    "Pareto jitter": lambda: delaying(lambda chance: 0.05 * chance.paretovariate(1.5) * TICK),
    "reordering": lambda: lambda number, data, chance: [(1.2 * TICK if number % 10 == 9 else 0.0, data)],
}


@pytest.mark.parametrize("kind", DELAYS if LONG else ["Pareto jitter"])
def test_delays_within_the_cycle_are_survived(slow, kind):
    states = DELAYS[kind] if "each way" in kind else None
    survive(slow, commands=DELAYS[kind], states=states, least=0.85)


def test_a_constantly_late_network_ends_the_motion_at_once(slow):
    late = delaying(1.5 * TICK)

    def rule(number, data, chance):
        return late(number, data, chance) if number >= 150 else [(0.0, data)]

    def attempt():
        results = run(slow, commands=lambda: rule)
        check_lost(slow, results, slowest(180))
        return [result["cycles"] for result in results]

    # A robot that stalls itself receives late answers in time.
    cycles = in_time(attempt, lambda cycles: max(cycles) <= 175)
    assert max(cycles) <= 175


@pytest.mark.parametrize("ticks", [1, 10, 15] if LONG else [10])
def test_a_short_stall_with_its_backlog_is_survived(slow, ticks):
    for result in survive(slow, states=lambda: stalling(150, ticks * TICK), least=0.8):
        # When the client wakes up it takes the newest state, and its clock jumps.
        assert result["longest"] >= 0.5e-3 * ticks


def test_a_long_stall_of_commands_ends_the_motion(slow):
    check_lost(slow, run(slow, commands=lambda: stalling(150, 60 * TICK), amplitude=0.0), slowest(230))


# ---- 3: damage ---------------------------------------------------------------------------------------------


def flipped_id(data, chance):
    bit = chance.randrange(20, 64)  # not the newest state's message_id
    return struct.pack("<Q", struct.unpack_from("<Q", data)[0] ^ (1 << bit)) + data[8:]


NOISE = {
    "duplicates": duplicating,
    "old ones again": every(3, renumbered(-2)),
    "from the future": every(3, renumbered(+3)),
    "truncated": every(3, truncated),
    "oversized": every(3, oversized),
    "flipped id": every(3, flipped_id),
}


def all_noise(number, data, chance):
    """Each kind in turn."""
    kinds = list(NOISE.values())
    return kinds[number // 10 % len(kinds)](number, data, chance)


@pytest.mark.parametrize("kind", ["all", *NOISE] if LONG else ["all"])
def test_invalid_answers_are_ignored(stepped, kind):
    rule = all_noise if kind == "all" else NOISE[kind]
    results = run(stepped, commands=lambda: rule)
    for fixture, result in zip(stepped, results):
        assert result["outcome"] == "ok", result
        assert min(fixture.proxy.rates[101:]) == 1.0
        assert result["cycles"] <= 603


def test_duplicate_and_late_states_are_delivered_once(stepped):
    repeated = {"sent": None}

    def old_again(number, data, chance):
        before, repeated["sent"] = repeated["sent"], data
        return [(0.0, data), (0.0, data), *([(0.0, before)] if before else [])]

    for fixture in stepped:  # the rule has a state: one after the other
        repeated["sent"] = None
        (result,) = run([fixture], states=lambda: old_again)
        assert result["outcome"] == "ok", result
        assert result["cycles"] <= 603
        assert min(fixture.proxy.rates[101:]) == 1.0


def test_our_client_reports_invalid_states(stepped):
    """The client drops a state of the wrong size; the robot then misses its answers and stops."""
    own = stepped[-1:]  # the last one: genuine clients may be left out
    (result,) = run(own, states=lambda: lambda number, data, chance: [(0.0, data[:-1])])
    try:
        assert result["outcome"].startswith("ProtocolException"), result
        assert result["wall"] < 5.0, result
    finally:
        begin = time.monotonic()
        while own[0].sim.remote.state().mode == "Move":
            assert time.monotonic() - begin < 5.0, "The motion continues without a client."
        own[0].client.run_task("connect", address=own[0].proxy.address)
        own[0].client.run_task("recover")
    assert run(own, seconds=0.2, amplitude=0.0)[0]["outcome"] == "ok"


# ---- 4: TCP ------------------------------------------------------------------------------------------------


def test_replies_may_take_longer_than_a_second(stepped):
    for fixture in stepped:
        fixture.proxy.reply_delay = 1.2
        fixture.client.give("set_load")
    try:
        for fixture in stepped:
            result = fixture.client.result()
            assert result["outcome"] == "ok" and 1.2 <= result["wall"] < 10.0, result
    finally:
        for fixture in stepped:
            fixture.proxy.reply_delay = 0.0


# ---- 5: the client's timing -------------------------------------------------------------------------------


@pytest.mark.parametrize("share", [0.1, 0.5, 0.8] if LONG else [0.6])
def test_a_program_may_compute_for_most_of_a_cycle(slow, share):
    survive(slow, compute=share * TICK, least=0.9)


def test_a_program_slower_than_a_cycle_is_stopped(slow):
    """Each answer arrives when its state is no longer the newest."""
    results = run(slow, compute=1.5 * TICK, amplitude=0.0)
    check_lost(slow, results, slowest(100))
    assert all(result["cycles"] <= 75 for result in results)


# ---- 6: signals and death ---------------------------------------------------------------------------------


def freeze(group, seconds, motion=SECONDS):
    """Sends SIGSTOP to each client in its motion, and SIGCONT after a number of seconds."""
    for fixture in group:
        fixture.proxy.set()
        fixture.client.give("move", seconds=motion, amplitude=0.0, announce=True)
    for fixture in group:
        assert fixture.client.line() == "moving"
    for fixture in group:
        fixture.client.process.send_signal(signal.SIGSTOP)
    time.sleep(seconds)  # the fault itself
    for fixture in group:
        fixture.client.process.send_signal(signal.SIGCONT)
    return [fixture.client.result() for fixture in group]


def test_five_cycles_frozen_are_survived(slow):
    for _ in range(TRIES):
        results = freeze(slow, 5 * TICK)
        # On a busy machine a client sleeps longer than requested.
        overslept = [s for s, r in zip(slow, results) if LOST in r["outcome"] and r["longest"] > 0.018]
        if not overslept:
            break
        recover(overslept)
    assert all(result["outcome"] == "ok" for result in results), results


@pytest.mark.parametrize("cycles", [50, 500] if LONG else [50])
def test_more_than_twenty_cycles_frozen_end_the_motion(slow, cycles):
    check_lost(slow, freeze(slow, cycles * TICK), slowest(300 + cycles))


# Programs that compute, and one that allocates and frees pages of memory.
HOGS = ["while True: pass"] * 2 * os.cpu_count() + ["while True: bytearray(1 << 26)"]


@contextmanager
def starved(group):
    """Clients without privileges on a busy machine."""
    hogs = [subprocess.Popen([sys.executable, "-c", program]) for program in HOGS]
    for fixture in group:
        go_with_all(fixture.client.process.pid)
    try:
        yield
    finally:
        for fixture in group:
            go_first(fixture.client.process.pid)
        for hog in hogs:
            hog.kill()
            hog.wait()


def test_a_starved_client_of_a_patient_robot_loses_nothing(patient):
    with starved(patient):
        results = run(patient)
    for fixture, result in zip(patient, results):
        assert result["outcome"] == "ok", result
        assert min(fixture.proxy.rates[101:]) == 1.0


def test_a_starved_client_continues_or_gets_the_reason(slow):
    """Twenty lost commands end the motion; fewer may already cause a discontinuity after extrapolation."""
    with starved(slow):
        results = run(slow)
    for fixture, result in zip(slow, results):
        if result["outcome"] != "ok":
            assert LOST in result["outcome"] or "discontinuity" in result["outcome"], result
            recover([fixture])
    assert all(result["outcome"] == "ok" for result in run(slow, seconds=0.2, amplitude=0.0))


def test_lock_step_waits_for_a_frozen_client(stepped):
    """For half of the robot's patience: nothing is lost, nothing moves meanwhile."""
    for fixture, result in zip(stepped, freeze(stepped, 0.2)):
        assert result["outcome"] == "ok", result
        assert result["longest"] < 0.0015
        assert min(fixture.proxy.rates[101:]) == 1.0


def test_lock_step_drops_a_frozen_client(stepped):
    check_lost(stepped, freeze(stepped, 0.9, ENDLESS), 10.0)


def test_a_killed_client_ends_its_motion_and_frees_the_robot(stepped):
    """Must be last: it kills the clients."""
    for fixture in stepped:
        fixture.proxy.set()
        fixture.client.give("move", seconds=ENDLESS, amplitude=AMPLITUDE, announce=True)
    for fixture in stepped:
        assert fixture.client.line() == "moving"
        fixture.client.process.kill()
    for fixture in stepped:
        begin = time.monotonic()
        while fixture.sim.remote.state().mode != "Reflex":
            assert time.monotonic() - begin < 5.0, fixture.sim.remote.state()
        assert LOST in fixture.sim.remote.state().errors
        with connected(fixture.sim) as client:
            assert client.state().reasons == [COMMUNICATION]
            client.recover()
