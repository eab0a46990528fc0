# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A proxy between a client and a robot that can hold the robot's replies.

It has its own address and looks like the robot: it forwards the TCP stream (with the UDP port of `Connect`
replaced by its own), states and commands.
"""

import select
import socket
import struct
import threading
from contextlib import ExitStack

from fci_wire import HEADER, LIMIT, PORT


class Proxy:
    """Serves one client at a time, until it is closed."""

    def __init__(self, address: str, robot: str):
        self.address, self.robot = address, robot
        self._holds, self._held = False, []  # the robot's replies
        self._stack = ExitStack()

    def __enter__(self):
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

    def run(self) -> bool:
        sockets = [self.client, self.robot, self.to_client, self.to_robot, self.proxy._wake_out]
        while True:
            ready, _, _ = select.select(sockets, [], [])
            if self.proxy._wake_out in ready:
                return False
            if self.to_robot in ready:
                state, self.robot_udp = self.to_robot.recvfrom(65536)
                self.to_client.sendto(state, self.client_udp)
            if self.to_client in ready:
                self.to_robot.sendto(self.to_client.recv(65536), self.robot_udp)
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
