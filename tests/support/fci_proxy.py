# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A worse network between a client and a simulated robot, the same for the same seed.

A `Proxy` has its own address and looks like the robot: it forwards the TCP stream (with the UDP port of
`Connect` replaced by its own), states and commands. A `Channel` decides about each datagram, from the
datagram's number within the motion. It needs no root and no tc.
"""

import heapq
import random
import select
import socket
import struct
import threading
import time
from dataclasses import dataclass, field

from fci_session import go_first
from fci_wire import HEADER, LAYOUTS, MOVE, PORT, State


@dataclass
class Channel:
    """Changes the datagrams of one direction; each may become several, or none.

    `rule(number, datagram, random)` returns a list of (delay [s], datagram); number counts the datagrams
    since the motion's start, from 0. Outside of motions all pass.
    """

    rule: object = None
    seed: int = 0
    seen: int = 0
    lost: int = 0
    in_a_row: int = 0
    longest: int = 0
    passed: list[bool] = field(default_factory=list)
    chance: random.Random = field(default_factory=random.Random)

    def restart(self):
        self.chance.seed(self.seed)
        self.seen = self.lost = self.in_a_row = self.longest = 0
        self.passed = []

    def apply(self, data: bytes) -> list[tuple[float, bytes]]:
        number, self.seen = self.seen, self.seen + 1
        result = [(0.0, data)] if self.rule is None else self.rule(number, data, self.chance)
        self.passed.append(bool(result))
        self.in_a_row = 0 if result else self.in_a_row + 1
        self.lost += not result
        self.longest = max(self.longest, self.in_a_row)
        return result

    def worst_share(self, window: int = 100) -> float:
        """The smallest share that passed in a window of consecutive datagrams."""
        windows = [self.passed[i : i + window] for i in range(max(1, len(self.passed) - window + 1))]
        return min(sum(each) / len(each) for each in windows) if self.passed else 1.0


def losing(probability: float):
    """Loses each datagram independently."""
    return lambda number, data, chance: [] if chance.random() < probability else [(0.0, data)]


def losing_from(first: int, count: int):
    """Loses exactly these, counted from the motion's first."""
    return lambda number, data, chance: [] if first <= number < first + count else [(0.0, data)]


def bursts(begin: float, end: float, longest: int):
    """Gilbert's two-state loss: bursts start and end with these probabilities and lose at most `longest`.

    At least one datagram passes between two bursts.
    """
    burst = [0]

    def rule(number, data, chance):
        begins, ends = chance.random() < begin, chance.random() < end
        if number == 0:
            burst[0] = 0
        goes_on = not ends and burst[0] < longest if burst[0] else begins
        burst[0] = burst[0] + 1 if goes_on else 0
        return [] if goes_on else [(0.0, data)]

    return rule


def delaying(seconds):
    """Delays by a constant, or by `seconds(random)`; later datagrams may overtake earlier ones."""
    if callable(seconds):
        return lambda number, data, chance: [(max(0.0, seconds(chance)), data)]
    return lambda number, data, chance: [(seconds, data)]


def stalling(first: int, seconds: float):
    """From this number on all datagrams wait, then are sent together."""
    until = [0.0]

    def rule(number, data, chance):
        now = time.monotonic()
        if number == first:
            until[0] = now + seconds
        return [(max(0.0, until[0] - now) if number >= first else 0.0, data)]

    return rule


def duplicating(number, data, chance):
    return [(0.0, data)] * chance.randint(1, 3)


def every(period: int, change):
    """Each datagram passes; `change(data, random)` of each `period`-th is sent before it."""

    def rule(number, data, chance):
        before = [(0.0, change(data, chance))] if number % period == period - 1 else []
        return [*before, (0.0, data)]

    return rule


def renumbered(by: int):
    """The datagram with an earlier or later message_id."""

    def change(data, chance):
        identity = struct.unpack_from("<Q", data)[0]
        return struct.pack("<Q", max(0, identity + by)) + data[8:]

    return change


def truncated(data, chance):
    return data[: chance.randrange(len(data))]


def oversized(data, chance):
    return data + bytes(chance.randrange(1, 3000))


class Proxy:
    """Serves one client at a time, until it is closed."""

    def __init__(self, address: str, robot: str, version: int):
        self.address, self.robot, self.version = address, robot, version
        self.commands, self.states = Channel(), Channel()
        self.reply_delay = 0.0  # of the robot's replies [s]
        self.rates: list[float] = []  # control_command_success_rate of each state of the last motion
        self._moving = False
        self._listener = socket.create_server((address, PORT), backlog=4)
        self._wake_out, self._wake_in = socket.socketpair()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._wake_in.send(b"x")
        self._thread.join(10)
        assert not self._thread.is_alive(), "The proxy does not end."
        for each in (self._listener, self._wake_in, self._wake_out):
            each.close()

    def set(self, commands=None, states=None, seed: int = 1):
        """Sets the rules for the next motions; call it between motions."""
        self.commands = Channel(commands, seed)
        self.states = Channel(states, seed + 1)
        self.commands.restart()
        self.states.restart()

    def _run(self):
        go_first()
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
            socket.create_connection((self.robot, PORT), source_address=(here, 0), timeout=20) as robot,
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
        self.waiting: list = []  # heap of (due, order, socket, datagram, address)
        self.order = 0

    def run(self) -> bool:
        sockets = [self.client, self.robot, self.to_client, self.to_robot, self.proxy._wake_out]
        while True:
            timeout = max(0.0, self.waiting[0][0] - time.monotonic()) if self.waiting else None
            ready, _, _ = select.select(sockets, [], [], timeout)
            if self.proxy._wake_out in ready:
                return False
            if self.to_robot in ready:
                self._state()
            if self.to_client in ready:
                self._command()
            self._flush()
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
        if source is self.robot and self.proxy.reply_delay > 0.0 and data:
            self._later(self.proxy.reply_delay, sink, data, None)
        else:
            sink.sendall(data)
        return bool(data)

    def _state(self):
        data, self.robot_udp = self.to_robot.recvfrom(65536)
        proxy = self.proxy
        moving = len(data) == LAYOUTS[proxy.version].state_size and State(proxy.version, data).mode == MOVE
        if moving and not proxy._moving:
            proxy.states.restart()
            proxy.commands.restart()
            proxy.rates = []
        proxy._moving = moving
        if moving:
            proxy.rates.append(State(proxy.version, data).rate)
        items = proxy.states.apply(data) if moving else [(0.0, data)]
        self._schedule(items, self.to_client, self.client_udp)

    def _command(self):
        data, _ = self.to_client.recvfrom(65536)
        items = self.proxy.commands.apply(data) if self.proxy._moving else [(0.0, data)]
        self._schedule(items, self.to_robot, self.robot_udp)

    def _schedule(self, items, sink, address):
        for delay, data in items:
            if delay == 0.0:
                sink.sendto(data, address)
            else:
                self._later(delay, sink, data, address)

    def _later(self, delay, sink, data, address):
        self.order += 1
        heapq.heappush(self.waiting, (time.monotonic() + delay, self.order, sink, data, address))

    def _flush(self):
        while self.waiting and self.waiting[0][0] <= time.monotonic():
            _, _, sink, data, address = heapq.heappop(self.waiting)
            if address is None:
                sink.sendall(data)
            else:
                sink.sendto(data, address)
