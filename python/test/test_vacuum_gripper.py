# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""pyfranka.VacuumGripper with the test's own fake gripper."""

import socket
import struct
import threading
from datetime import timedelta

import pyfranka
import pytest

ADDRESS, PORT = "127.0.32.3", 1339
CONNECT, VACUUM, DROP_OFF, STOP = range(4)
SUCCESS, FAIL, UNSUCCESSFUL, ABORTED = range(4)
HEADER = struct.Struct("<HII")


class FakeGripper:
    """Answers requests with `status`, or keeps them waiting for a stop; sends states periodically."""

    def __init__(self):
        self.status, self.waits, self.requests = SUCCESS, False, []
        self.waiting = threading.Event()
        self._listener = socket.create_server((ADDRESS, PORT))
        self._thread = threading.Thread(target=self._serve, daemon=True)
        self._thread.start()

    def close(self):
        self._listener.shutdown(socket.SHUT_RDWR)
        self._listener.close()
        self._thread.join(60)

    def _serve(self):
        while True:
            try:
                client, peer = self._listener.accept()
            except OSError:
                return
            ended = threading.Event()
            with client:
                self._talk(client, peer, ended)
            ended.set()

    def _talk(self, client, peer, ended):
        stream = client.makefile("rb")
        client.settimeout(60)
        pending = []
        while True:
            head = stream.read(HEADER.size)
            if len(head) < HEADER.size:
                return
            command, number, size = HEADER.unpack(head)
            body = stream.read(size - HEADER.size)
            if command == CONNECT:
                version, port = struct.unpack("<HH", body)
                client.sendall(HEADER.pack(command, number, 14) + struct.pack("<HH", SUCCESS, version))
                states = threading.Thread(
                    target=self._send_states, args=((peer[0], port), ended), daemon=True
                )
                states.start()
                continue
            self.requests.append((command, body))
            if command == STOP:
                for waiting in pending:
                    self._reply(client, *waiting, ABORTED)
                pending.clear()
                self._reply(client, command, number, SUCCESS)
            elif self.waits:
                pending.append((command, number))
                self.waiting.set()
            else:
                self._reply(client, command, number, self.status)

    @staticmethod
    def _reply(client, command, number, status):
        client.sendall(HEADER.pack(command, number, 12) + struct.pack("<H", status))

    @staticmethod
    def _send_states(peer, ended):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            while not ended.wait(0.02):
                sender.sendto(struct.pack("<I???Bii", 2500, True, False, True, 2, 80, 600), peer)


@pytest.fixture
def fake():
    gripper = FakeGripper()
    yield gripper
    gripper.close()


def test_state(fake):
    gripper = pyfranka.VacuumGripper(ADDRESS)
    assert gripper.server_version == 1
    state = gripper.read_once()
    assert (state.in_control_range, state.part_detached, state.part_present) == (True, False, True)
    assert state.device_status == pyfranka.VacuumGripperDeviceStatus.Orange
    assert (state.actual_power, state.vacuum) == (80, 600)
    assert state.time == pytest.approx(2.5)


def test_commands_arrive_unchanged(fake):
    gripper = pyfranka.VacuumGripper(ADDRESS)
    profile = pyfranka.VacuumGripper.ProductionSetupProfile.P2
    assert gripper.vacuum(100, timedelta(seconds=1.5), profile)
    assert gripper.drop_off(timedelta(milliseconds=250))
    assert gripper.stop()
    assert fake.requests == [
        (VACUUM, struct.pack("<BBq", 100, 2, 1500)),
        (DROP_OFF, struct.pack("<q", 250)),
        (STOP, b""),
    ]


def test_failures_are_reported(fake):
    gripper = pyfranka.VacuumGripper(ADDRESS)
    fake.status = UNSUCCESSFUL
    assert not gripper.vacuum(100, timedelta(seconds=1))
    fake.status = FAIL
    with pytest.raises(pyfranka.CommandException, match="libfranka vacuum gripper: "):
        gripper.drop_off(timedelta(seconds=1))


def test_stop_from_another_thread(fake):
    """The fake runs in this process: a wait with the interpreter's lock held would never end."""
    gripper = pyfranka.VacuumGripper(ADDRESS)
    fake.waits = True
    stopper = threading.Thread(target=lambda: (fake.waiting.wait(60), gripper.stop()))
    stopper.start()
    with pytest.raises(pyfranka.CommandException, match="aborted"):
        gripper.vacuum(100, timedelta(seconds=60))
    stopper.join(60)
    assert not stopper.is_alive()
