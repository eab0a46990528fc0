# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Effects of faulty clients on the whole program: crashes, silence, many connections (faults 4, 6).

What a server does with wrong bytes is shown by robot_server_test.cpp, with wrong commands by
error_flags_test.cpp.
"""

import os
import time

import pytest
from fci_motion import begin, drive, hold
from fci_proxy import Proxy
from fci_session import client_process, descriptors_of, memory_of, simulated
from fci_wire import COMMUNICATION, Client, connected
from waiting import wait_for

LOST = "communication_constraints_violation"
LONG = bool(os.environ.get("FRANKA_TEST_LONG"))


@pytest.fixture(scope="module")
def raw():
    """A robot in lock-step for clients of fci_wire."""
    with simulated("panda", "lockstep") as sim:
        yield sim


def test_a_crash_in_a_motion_ends_it(raw):
    client = connected(raw)
    state, first = begin(client)
    drive(client, state, hold(first), 50)
    client.reset()
    wait_for(lambda: raw.remote.state().mode == "Reflex", "The end of the motion")
    assert LOST in raw.remote.state().errors
    with connected(raw) as client:
        assert client.state_until(lambda state: True).reasons == [COMMUNICATION]
        client.recover()


def test_a_silent_connection_frees_the_robot(raw):
    with Client(raw.address, raw.protocol) as silent:
        assert silent.ended()
    connected(raw).close()


def test_replies_may_take_longer_than_a_second(raw):
    with Proxy("127.0.24.2", raw.address) as proxy, client_process("pyfranka") as client:
        assert client.run_task("connect", address=proxy.address)["outcome"] == "ok"
        proxy.hold_replies()
        client.give("set_load")
        wait_for(lambda: proxy.holds_a_reply, "The robot's reply")
        time.sleep(1.2)  # the fault itself
        proxy.release_replies()
        assert client.result()["outcome"] == "ok"


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
