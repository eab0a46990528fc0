# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Slows down the guessing of passwords."""

from __future__ import annotations

import asyncio
import contextlib
import hashlib
from collections import OrderedDict
from collections.abc import Callable

from pyfranka.desk.sessions import User
from pyfranka.desk.settings import Limits
from pyfranka.desk.throttle import MAX_ADDRESSES, Throttle

LOGIN_RATE = 1.0  # [1/s] of logins after too many wrong passwords (chosen here)
ALL = "all"


class LoginThrottle:
    """After too many wrong passwords of one address, for one user name or in all, each further login waits
    before its password is compared.

    At an address where a user has logged in before, only the wrong passwords of that address count: those of
    others do not lock the user out.
    """

    def __init__(self, limits: Limits):
        self._of_address = Throttle(LOGIN_RATE, limits.wrong_logins, limits.waiting)
        self._of_user = Throttle(LOGIN_RATE, limits.wrong_logins_of_user, limits.waiting)
        self._of_all = Throttle(LOGIN_RATE, limits.wrong_logins_of_all, limits.waiting)
        self._known: OrderedDict[tuple[str, str], None] = OrderedDict()  # addresses and users

    async def compare(self, address: str, name: str, compare: Callable[[], User | None]) -> User | None:
        """Compares a password, after a time if there were many wrong ones. compare: returns the user if the
        password is right. Raises DeskError (429) if too many logins wait already."""
        user = hashlib.sha256(name.encode(errors="surrogatepass")).hexdigest()
        limits = [(self._of_address, address)]
        if (address, user) not in self._known:
            limits += [(self._of_user, user), (self._of_all, ALL)]
        waits = any(throttle.delay(key) > 0.0 for throttle, key in limits)
        if waits:
            with contextlib.ExitStack() as places:
                for throttle, key in limits:
                    places.enter_context(throttle.place(key))
                await asyncio.sleep(max(throttle.use(key) for throttle, key in limits))
        found = compare()
        if found is not None:
            self._remember(address, user)
        elif not waits:
            for throttle, key in limits:
                throttle.use(key)
        return found

    def _remember(self, address: str, user: str) -> None:
        self._known[address, user] = None
        self._known.move_to_end((address, user))
        while len(self._known) > MAX_ADDRESSES:
            self._known.popitem(last=False)
