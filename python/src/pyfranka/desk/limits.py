# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Limits for each address: connections, requests a second, open sockets."""

from __future__ import annotations

import asyncio
import contextlib
from collections import Counter
from collections.abc import Callable, Iterator

from aiohttp import web

from pyfranka.desk.addresses import address_of, network_of
from pyfranka.desk.errors import DeskError
from pyfranka.desk.login_throttle import LoginThrottle
from pyfranka.desk.sessions import User
from pyfranka.desk.settings import Limits
from pyfranka.desk.throttle import Throttle


class Counted:
    """Limits the number of simultaneous things, for each address and in total."""

    def __init__(self, limit: int, limit_of_address: int, what: str):
        self._limit, self._limit_of_address, self._what = limit, limit_of_address, what
        self._of: Counter[str] = Counter()

    @property
    def total(self) -> int:
        """How many are held."""
        return self._of.total()

    @contextlib.contextmanager
    def one(self, address: str) -> Iterator[None]:
        """Holds one. Raises DeskError (429) if there are too many."""
        if not self.add(address):
            raise DeskError(429, "TooManyRequests", f"Too many {self._what} are open. Close some of them.")
        try:
            yield
        finally:
            self.remove(address)

    def add(self, address: str) -> bool:
        """Counts one more. Returns False if there are too many."""
        if self._of.total() >= self._limit or self._of[address] >= self._limit_of_address:
            return False
        self._of[address] += 1
        return True

    def remove(self, address: str) -> None:
        """Counts one less."""
        self._of[address] -= 1
        if self._of[address] <= 0:
            del self._of[address]


class Gate:
    """All limits of one Desk."""

    def __init__(self, limits: Limits):
        self.limits = limits
        self.requests = Throttle(limits.rate, limits.rate, limits.waiting)
        self.logins = LoginThrottle(limits)
        self.sockets = Counted(limits.sockets, limits.sockets_of_address, "WebSockets")
        self.sockets_without_login = Counted(
            limits.sockets_without_login,
            limits.sockets_without_login_of_address,
            "WebSockets without a login",
        )
        self._connections = Counted(limits.connections, limits.connections_of_address, "connections")
        self._guards: dict[asyncio.BaseProtocol, _Guard] = {}

    async def enter(self, request: web.Request) -> None:
        """Begins a request: it may wait, or be refused."""
        guard = self._guards.get(request.protocol)
        if guard is not None:
            guard.has_begun()
        address = address_of(request)
        delay = self.requests.use(address)
        if delay > 0.0:
            await self.requests.wait(address, delay)

    def sockets_of(self, user: User | None) -> Counted:
        """Open sockets of logged-in users, or of clients without a login, which take no places of users."""
        return self.sockets if user is not None else self.sockets_without_login

    def factory(self, server: web.Server) -> Callable[[], asyncio.Protocol]:
        """Connections of that server, each with its limits: for loop.create_server."""

        def make() -> asyncio.Protocol:
            handler = server()
            return _Guard(handler, self._guards, self._connections, self.limits.request_time)

        return make


class _Guard(asyncio.Protocol):
    """Between one connection and its handler: refuses it if there are too many, and ends it if it sends no
    request."""

    def __init__(
        self,
        handler: asyncio.Protocol,
        guards: dict[asyncio.BaseProtocol, _Guard],
        connections: Counted,
        limit: float,
    ):
        self._handler, self._guards, self._connections, self._limit = handler, guards, connections, limit
        self._counted = False
        self._timer: asyncio.TimerHandle | None = None

    def has_begun(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        assert isinstance(transport, asyncio.Transport)
        self._address = network_of(transport.get_extra_info("peername"))
        self._counted = self._connections.add(self._address)
        self._guards[self._handler] = self
        self._handler.connection_made(transport)
        if self._counted:
            self._timer = asyncio.get_running_loop().call_later(self._limit, transport.abort)
        else:
            transport.abort()

    def connection_lost(self, error: Exception | None) -> None:
        self.has_begun()
        self._guards.pop(self._handler, None)
        if self._counted:
            self._connections.remove(self._address)
        self._handler.connection_lost(error)

    def data_received(self, data: bytes) -> None:
        self._handler.data_received(data)

    def eof_received(self) -> bool | None:
        return self._handler.eof_received()

    def pause_writing(self) -> None:
        self._handler.pause_writing()

    def resume_writing(self) -> None:
        self._handler.resume_writing()
