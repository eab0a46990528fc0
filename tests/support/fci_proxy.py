# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A worse network between a client and a robot in lock-step, the same for the same seed.

A `Proxy` has its own address and looks like the robot: it forwards the TCP stream (with the UDP port of
`Connect` replaced by its own), states and commands. A `Channel` decides about each datagram, from the
datagram's number within the motion. It needs no root and no tc.

Its clock is the robot's ticks, so that the machine's speed changes nothing. A robot in lock-step waits for
the answer to each state. If the answer, or the state, is lost, the proxy answers itself, and tells the
robot's own link to lose that answer: the robot counts it as lost, and continues.
"""

import random
import select
import socket
import struct
import threading
from contextlib import ExitStack
from dataclasses import dataclass, field

from fci_wire import HEADER, LAYOUTS, LIMIT, MOVE, PORT, State
from pyfranka.remote import Remote


@dataclass
class Channel:
    """Changes the datagrams of one direction; each may become several, or none.

    `rule(number, datagram, random)` returns a list of datagrams; number counts from the motion's first
    command on, from 0. All datagrams before it pass.
    """

    rule: object = None
    seed: int = 0
    seen: int = 0
    chance: random.Random = field(default_factory=random.Random)

    def restart(self):
        self.chance.seed(self.seed)
        self.seen = 0

    def apply(self, data: bytes) -> list[bytes]:
        number, self.seen = self.seen, self.seen + 1
        return [data] if self.rule is None else self.rule(number, data, self.chance)


def worst_share(passed: list[bool], window: int = 100) -> float:
    """The smallest share of `True` in a window of consecutive ones."""
    windows = [passed[i : i + window] for i in range(max(1, len(passed) - window + 1))]
    return min(sum(each) / len(each) for each in windows) if passed else 1.0


def losing(probability: float):
    """Loses each datagram independently."""
    return lambda number, data, chance: [] if chance.random() < probability else [data]


def losing_from(first: int, count: int):
    """Loses exactly these, counted from the motion's first."""
    return lambda number, data, chance: [] if first <= number < first + count else [data]


class Proxy:
    """Serves one client at a time, until it is closed."""

    def __init__(self, address: str, robot: str, version: int):
        self.address, self.robot, self.version = address, robot, version
        self.commands, self.states = Channel(), Channel()
        self.passed: list[bool] = []  # whether a tick of the last motion had its command
        self.rates: list[float] = []  # control_command_success_rate of each of its states
        self._holds, self._held = False, []  # the robot's replies
        self._stack = ExitStack()

    def __enter__(self):
        self._remote = self._stack.enter_context(Remote(self.robot))
        self._listener = self._stack.enter_context(socket.create_server((self.address, PORT), backlog=4))
        self._wake_out, self._wake_in = map(self._stack.enter_context, socket.socketpair())
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._wake_in.send(b"x")
        self._thread.join(LIMIT)
        assert not self._thread.is_alive(), "The proxy does not end."
        self._stack.close()

    def set(self, commands=None, states=None, seed: int = 1):
        """Sets the rules for the next motions; call it between motions."""
        self.commands = Channel(commands, seed)
        self.states = Channel(states, seed + 1)

    def hold_replies(self):
        """Keeps the robot's replies until `release_replies`."""
        self._holds = True

    @property
    def holds_a_reply(self) -> bool:
        return bool(self._held)

    def release_replies(self):
        self._holds, held = False, self._held
        self._held = []
        for sink, data in held:
            sink.sendall(data)

    def _run(self):
        while True:
            ready, _, _ = select.select([self._listener, self._wake_out], [], [])
            if self._wake_out in ready:
                return
            client, _ = self._listener.accept()
            try:
                if not self._serve(client):
                    return
            except OSError:
                pass  # one side has disconnected
            finally:
                client.close()

    # One connection. @returns whether to accept the next one.
    def _serve(self, client: socket.socket) -> bool:
        here = self.address
        with (
            socket.create_connection((self.robot, PORT), source_address=(here, 0), timeout=LIMIT) as robot,
            socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as to_robot,
            socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as to_client,
        ):
            for each in (client, robot):
                each.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            to_robot.bind((here, 0))
            to_client.bind((here, 0))
            return _Link(self, client, robot, to_client, to_robot).run()


class _Link:
    def __init__(self, proxy, client, robot, to_client, to_robot):
        self.proxy, self.client, self.robot = proxy, client, robot
        self.to_client, self.to_robot = to_client, to_robot
        self.client_udp = self.robot_udp = None
        self.due = None  # message_id of the state that has no answer yet
        self.command = b""  # the motion's last one; empty before the first

    def run(self) -> bool:
        sockets = [self.client, self.robot, self.to_client, self.to_robot, self.proxy._wake_out]
        while True:
            ready, _, _ = select.select(sockets, [], [])
            if self.proxy._wake_out in ready:
                return False
            if self.to_robot in ready:
                self._state()
            if self.to_client in ready:
                self._command()
            for source, sink in ((self.client, self.robot), (self.robot, self.client)):
                if source in ready and not self._stream(source, sink):
                    return True

    def _stream(self, source, sink) -> bool:
        data = source.recv(65536)
        if source is self.client and self.client_udp is None and data:
            while len(data) < HEADER.size + 4:
                data += source.recv(65536)
            version, port = struct.unpack_from("<HH", data, HEADER.size)
            self.client_udp = (self.client.getpeername()[0], port)
            own = struct.pack("<HH", version, self.to_robot.getsockname()[1])
            data = data[: HEADER.size] + own + data[HEADER.size + 4 :]
        if source is self.robot and self.proxy._holds:
            self.proxy._held.append((sink, data))
        else:
            sink.sendall(data)
        return bool(data)

    def _state(self):
        data, self.robot_udp = self.to_robot.recvfrom(65536)
        proxy = self.proxy
        is_state = len(data) == LAYOUTS[proxy.version].state_size
        if not is_state or State(proxy.version, data).mode != MOVE:
            self.due, self.command = None, b""
            self._send([data], self.to_client, self.client_udp)
            return
        state = State(proxy.version, data)
        self.due = state.message_id
        if not self.command:  # before the first command the robot repeats its state
            self._send([data], self.to_client, self.client_udp)
            return
        proxy.rates.append(state.rate)
        sent = proxy.states.apply(data)
        self._send(sent, self.to_client, self.client_udp)
        if data not in sent:
            self._lose()

    def _command(self):
        data, _ = self.to_client.recvfrom(65536)
        proxy = self.proxy
        if self.due is None or struct.unpack_from("<Q", data)[0] != self.due:
            self._send([data], self.to_robot, self.robot_udp)  # the robot ignores it
            return
        if not self.command:
            proxy.states.restart()
            proxy.commands.restart()
            proxy.passed, proxy.rates = [], []
        self.command = data
        sent = proxy.commands.apply(data)
        self._send(sent, self.to_robot, self.robot_udp)
        if data in sent:
            self._answered(True)
        else:
            self._lose()

    # The robot loses its next command, which it gets now: it has waited for one.
    def _lose(self):
        self.proxy._remote.lose(1)
        answer = struct.pack("<Q", self.due) + self.command[8:]
        self._send([answer], self.to_robot, self.robot_udp)
        self._answered(False)

    def _answered(self, passed: bool):
        self.proxy.passed.append(passed)
        self.due = None

    @staticmethod
    def _send(datagrams, sink, address):
        for data in datagrams:
            sink.sendto(data, address)
