# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Limits for each address: connections, requests a second, wrong logins, open sockets."""

from __future__ import annotations

import asyncio
import contextlib
from collections import Counter, OrderedDict
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from aiohttp import web

from pyfranka.desk.errors import DeskError
from pyfranka.desk.settings import Limits

LOGIN_RATE = 1.0  # [1/s] of an address that has sent too many wrong passwords (chosen here)
MAX_ADDRESSES = 4096  # addresses (chosen here)


@dataclass
class _Bucket:
    tokens: float
    time: float
    waiting: int = 0


class Throttle:
    """Limits the rate of something for each address; early uses wait for their turn."""

    def __init__(self, rate: float, burst: float, waiting: int):
        self._rate, self._burst, self._waiting = rate, burst, waiting
        self._buckets: OrderedDict[str, _Bucket] = OrderedDict()

    def use(self, address: str) -> float:
        """Counts one use. Returns how long it has to wait [s]."""
        bucket = self._bucket(address)
        bucket.tokens -= 1.0
        return max(0.0, -bucket.tokens / self._rate)

    def delay(self, address: str) -> float:
        """The time that a use would have to wait [s], without counting it."""
        return max(0.0, (1.0 - self._bucket(address).tokens) / self._rate)

    async def wait(self, address: str, delay: float) -> None:
        """Waits for that time. Raises DeskError (429) if too many of that address wait already."""
        bucket = self._bucket(address)
        if bucket.waiting >= self._waiting:
            bucket.tokens += 1.0  # this use is not executed
            raise DeskError(
                429, "TooManyRequests", f"Too many requests of {address} wait already. Send fewer at a time."
            )
        bucket.waiting += 1
        try:
            await asyncio.sleep(delay)
        finally:
            bucket.waiting -= 1

    def _bucket(self, address: str) -> _Bucket:
        now = asyncio.get_running_loop().time()
        bucket = self._buckets.setdefault(address, _Bucket(self._burst, now))
        bucket.tokens = min(self._burst, bucket.tokens + (now - bucket.time) * self._rate)
        bucket.time = now
        self._buckets.move_to_end(address)
        while len(self._buckets) > MAX_ADDRESSES:
            self._buckets.popitem(last=False)
        return bucket


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
        self.wrong_logins = Throttle(LOGIN_RATE, limits.wrong_logins, limits.waiting)
        self.sockets = Counted(limits.sockets, limits.sockets_of_address, "WebSockets")
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
        self._address = _host(transport.get_extra_info("peername"))
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


def address_of(request: web.Request) -> str:
    """The client's address."""
    return _host(request.transport.get_extra_info("peername") if request.transport else None)


def _host(peer: Any) -> str:
    return str(peer[0]) if peer else "unknown"
