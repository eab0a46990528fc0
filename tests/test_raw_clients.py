# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Effects of faulty clients on a robot: wrong bytes, incomplete connections, crashes, late answers.

They use fci_wire: damage (faults 3), TCP (faults 4), timing (faults 5).
"""

import os
import struct

import pytest
from fci_session import descriptors_of, memory_of, simulated
from fci_wire import (
    COMMUNICATION,
    CONNECT,
    EXTERNAL,
    IDLE,
    JOINT_IMPEDANCE,
    JOINT_POSITION,
    LAYOUTS,
    MOVE,
    REFLEX,
    STOP,
    Client,
    command,
    connected,
    move_request,
)
from network_fixtures import LOST
from waiting import wait_for

LONG = bool(os.environ.get("FRANKA_TEST_LONG"))


@pytest.fixture(autouse=True)
def idle(request):
    """A failed test must not cause failures of the next ones."""
    yield
    sim = request.node.funcargs.get("raw")
    if sim is not None and sim.remote.state().mode == "Reflex":
        with connected(sim) as client:
            client.recover()


@pytest.fixture(scope="module", params=["panda", "fr3"])
def raw(request):
    """A robot in lock-step for clients of fci_wire."""
    with simulated(request.param, "lockstep") as sim:
        yield sim


def steps(client, state, count, q, finish=False):
    """Answers `count` states with the same positions. @returns the last state."""
    for i in range(count):
        last = finish and i == count - 1
        client.send(command(client.version, state.message_id, q, finished=last))
        state = client.state()
    return state


DAMAGE = {
    # The command's numbers, and the errors of a Panda and of an FR3 (whose system has its own range error):
    # a jump out of the range violates the limits of position, velocity, acceleration and jerk.
    "NaN": (float("nan"), [13], [13]),
    "infinite": (float("inf"), [13], [13]),
    "huge": (1e300, [12, 13, 14, 15], [0, 13, 14, 15]),
    "flipped exponent": (
        struct.unpack("<d", struct.pack("<Q", 1 << 62 | 1 << 55))[0],
        [12, 13, 14, 15],
        [0, 13, 14, 15],
    ),
}


@pytest.mark.parametrize("kind", DAMAGE)
def test_damaged_numbers_end_the_motion_with_the_generators_error(raw, kind):
    value, *expected = DAMAGE[kind]
    with connected(raw) as client:
        state = client.start(JOINT_IMPEDANCE, JOINT_POSITION)
        q = state.joints("q_d")
        state = steps(client, state, 50, q)
        client.send(command(raw.protocol, state.message_id, (*q[:3], value, *q[4:])))
        state = client.state_until(lambda state: state.mode != MOVE)
        assert state.mode == REFLEX
        assert state.reasons == expected[raw.protocol == 10]
        assert client.reply()[1][0] == LAYOUTS[raw.protocol].reflex
        resting = client.recover()
        assert resting.errors == []
        # No part of it has reached the arm.
        assert max(abs(a - b) for a, b in zip(resting.joints("q"), q)) < 1e-4


def test_denormal_numbers_are_accepted(raw):
    with connected(raw) as client:
        state = client.start(EXTERNAL, 1 if raw.protocol < 10 else 4)
        for i in range(100):
            client.send(
                command(raw.protocol, state.message_id, (5e-324,) * 7, (-5e-324,) * 7, finished=i == 99)
            )
            state = client.state()
        assert state.mode == IDLE, state.reasons
        assert client.reply()[1][0] == 0


def test_commands_of_another_version_are_ignored(raw):
    other = 5 if raw.protocol == 10 else 10
    with connected(raw) as client:
        state = client.start(JOINT_IMPEDANCE, JOINT_POSITION)
        q = state.joints("q_d")
        state = steps(client, state, 20, q)
        wrong = list(q)
        wrong[0] += 0.5
        for i in range(30):
            client.send(command(other, state.message_id, wrong))
            client.send(command(raw.protocol, state.message_id, q, finished=i == 29))
            state = client.state()
        assert state.mode == IDLE, state.reasons


def test_other_versions_are_refused_with_the_robots_version(raw):
    foreign = {5: (0, 1, 2, 6, 11, 65535), 10: (0, 1, 2, 4, 5, 11, 65535)}
    for version in foreign[raw.protocol]:
        with Client(raw.address, raw.protocol) as client:
            assert client.connect(version) == (1, raw.protocol), version


def test_requests_may_arrive_byte_by_byte(raw):
    with Client(raw.address, raw.protocol) as client:
        port = struct.pack("<HH", raw.protocol, client.udp.getsockname()[1])
        for message in (
            client.message(CONNECT, port),
            client.message(1, move_request(raw.protocol, JOINT_IMPEDANCE, JOINT_POSITION)),
        ):
            for i in range(len(message)):
                client.tcp.sendall(message[i : i + 1])
            _, reply = client.reply()
        assert reply[0] == 1
        client.state_until(lambda state: state.mode == MOVE)
        state = client.state()
        steps(client, state, 10, state.joints("q_d"), finish=True)
        assert client.reply()[1][0] == 0


def test_replies_carry_the_number_of_their_request(raw):
    with connected(raw) as client:
        for identity in (7, 0, 4294967295, 7):
            client.next_id = identity
            client.request(STOP)
            assert client.reply()[0] == identity


@pytest.mark.parametrize("header", [(99, 0, 12), (1, 0, 11), (1, 0, 4294967295), (2, 0, 4000), (2, 0, 13)])
def test_invalid_requests_end_the_connection_but_not_the_robot(raw, header):
    with connected(raw) as client:
        client.tcp.sendall(struct.pack("<III", *header) + bytes(max(0, min(header[2], 4000) - 12)))
        assert client.ended()
    connected(raw).close()


def test_a_crash_during_a_reply_frees_the_robot(raw):
    for _ in range(20):
        client = Client(raw.address, raw.protocol)
        client.request(CONNECT, struct.pack("<HH", raw.protocol, client.udp.getsockname()[1]))
        client.reset()
    with connected(raw) as client:
        assert client.state().mode == IDLE


def test_a_crash_in_a_motion_ends_it(raw):
    client = connected(raw)
    state = client.start(JOINT_IMPEDANCE, JOINT_POSITION)
    steps(client, state, 50, state.joints("q_d"))
    client.reset()
    wait_for(lambda: raw.remote.state().mode == "Reflex", "The end of the motion")
    assert LOST in raw.remote.state().errors
    with connected(raw) as client:
        assert client.state_until(lambda state: True).reasons == [COMMUNICATION]
        client.recover()


def test_a_second_client_is_refused_without_side_effects(raw):
    with connected(raw) as client:
        state = client.start(JOINT_IMPEDANCE, JOINT_POSITION)
        q = state.joints("q_d")
        for _ in range(10):
            state = steps(client, state, 20, q)
            try:
                with Client(raw.address, raw.protocol) as second:
                    second.request(CONNECT, struct.pack("<HH", raw.protocol, 1))
                    assert second.ended()
            except ConnectionError:
                pass  # refused even earlier
        state = steps(client, state, 2, q, finish=True)
        assert state.mode == IDLE


@pytest.mark.parametrize(
    "raw",
    ["panda", pytest.param("fr3", marks=pytest.mark.long_form("the same for every robot"))],
    indirect=True,
)
def test_a_silent_connection_frees_the_robot(raw):
    with Client(raw.address, raw.protocol) as silent:
        assert silent.ended()
    connected(raw).close()


def test_connecting_again_and_again_leaks_nothing(raw):
    for _ in range(20):
        connected(raw).close()
    pid = raw.server.process.pid
    descriptors, memory = descriptors_of(pid), memory_of(pid)
    for _ in range(1000 if LONG else 200):
        with connected(raw) as client:
            client.state()
    with connected(raw):
        pass
    wait_for(lambda: descriptors_of(pid) <= descriptors, "The close of all descriptors")
    assert memory_of(pid) - memory < 0.5


def test_a_client_that_is_always_one_cycle_late_is_stopped():
    """The robot waits for the answer to its newest state until its patience ends, then for a millisecond."""
    with simulated("panda", "lockstep", patience=0.5) as sim, connected(sim) as client:
        before = client.start(JOINT_IMPEDANCE, JOINT_POSITION)
        q = before.joints("q_d")
        before = steps(client, before, 20, q)
        while (state := client.state()).mode == MOVE:
            client.send(command(5, before.message_id, q))
            before = state
        assert state.mode == REFLEX and state.reasons == [COMMUNICATION]
        assert client.reply()[1][0] == LAYOUTS[5].reflex


@pytest.mark.parametrize("own", [True, False])
def test_resuming_after_a_pause(raw, own):
    """Resuming from the own last command causes a jump; resuming from q_d and dq_d does not."""
    speed, ramp, pause = 0.2, 100, 10
    with connected(raw) as client:
        state = client.start(JOINT_IMPEDANCE, JOINT_POSITION)
        q, v = list(state.joints("q_d")), 0.0

        def step():
            q[5] += v * 1e-3
            client.send(command(raw.protocol, state.message_id, q))
            return client.state()

        for i in range(ramp + 5):
            v = speed * min(1.0, (i + 1) / ramp)  # 2 rad/s^2
            state = step()
        raw.remote.lose(pause)
        for _ in range(pause):
            client.send(command(raw.protocol, state.message_id, q))
            state = client.state()
        for _ in range(20):
            if not own:
                q = list(state.joints("q_d"))  # the robot's extrapolated position, at the same speed
            state = step()
            if state.mode != MOVE:
                break
        if own:
            assert state.mode == REFLEX and set(state.reasons) <= {13, 14, 15}, state.reasons
            assert client.reply()[1][0] == LAYOUTS[raw.protocol].reflex
            client.recover()
        else:
            assert state.mode == MOVE, state.reasons
            client.request(STOP)
            client.state_until(lambda state: state.mode == IDLE)
