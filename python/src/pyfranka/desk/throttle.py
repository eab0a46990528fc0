# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Limits how often something is done."""

from __future__ import annotations

import asyncio
import contextlib
from collections import OrderedDict
from collections.abc import Iterator
from dataclasses import dataclass

from pyfranka.desk.errors import DeskError

MAX_ADDRESSES = 4096  # addresses (chosen here)


@dataclass
class _Bucket:
    tokens: float
    time: float
    waiting: int = 0


class Throttle:
    """Limits the rate of something for each address, or another name; early uses wait for their turn."""

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
        try:
            with self.place(address):
                await asyncio.sleep(delay)
        except DeskError:
            self._bucket(address).tokens += 1.0  # this use is not executed
            raise

    @contextlib.contextmanager
    def place(self, address: str) -> Iterator[None]:
        """A place to wait. Raises DeskError (429) if there is none."""
        bucket = self._bucket(address)
        if bucket.waiting >= self._waiting:
            raise DeskError(429, "TooManyRequests", "Too many requests wait already. Send fewer at a time.")
        bucket.waiting += 1
        try:
            yield
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
