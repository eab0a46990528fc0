# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Single point of control: one user at a time may act on the robot. One store for both interfaces."""

from __future__ import annotations

import asyncio
import hmac
import secrets
from collections.abc import Callable
from dataclasses import dataclass, field


@dataclass
class Request:
    """A granted or pending request for control. is_waiting: whether its client is still there to get control.
    answer: `granted`, `replaced`, `denied` or `withdrawn`, when it is decided."""

    id: int
    token: str
    owner: str
    force: bool = False
    is_waiting: Callable[[], bool] = lambda: True
    answer: asyncio.Future[str] = field(default_factory=lambda: asyncio.get_running_loop().create_future())

    def decide(self, answer: str) -> None:
        if not self.answer.done():
            self.answer.set_result(answer)


class Tokens:
    """active: the request of the holder, or None. pending: the pending request; a newer one replaces it.

    on_change: called after each change. on_loss: called when the holder has lost or released control.
    force_time: time limit for the confirmation of a forced request at the robot [s].
    """

    def __init__(self, force_time: float, on_change: Callable[[], None], on_loss: Callable[[], None]):
        self.active: Request | None = None
        self.pending: Request | None = None
        self.force_time = force_time
        self._on_change, self._on_loss = on_change, on_loss
        # The first id is random, so that ids of another run differ: clients keep tokens with their ids.
        self._next = 1 + secrets.randbelow(1 << 30)
        self._timer: asyncio.TimerHandle | None = None

    def request(
        self, owner: str, force: bool = False, is_waiting: Callable[[], bool] = lambda: True
    ) -> Request:
        """Requests control; granted at once if no user has control. A pending request gets it only if its
        client is waiting then."""
        request = Request(self._next, secrets.token_urlsafe(24), owner, force, is_waiting)
        self._next += 1
        if self.active is None:
            self._grant(request)
        else:
            self._set_pending(request, "replaced")
            if force:
                self._timer = asyncio.get_running_loop().call_later(self.force_time, self._expire, request)
        self._on_change()
        return request

    def is_active(self, token: str) -> bool:
        """Whether it is the token of the holder."""
        return self.active is not None and _equal(self.active.token, token)

    def is_pending(self, token: str) -> bool:
        """Whether it is the token of the pending request."""
        return self.pending is not None and _equal(self.pending.token, token)

    def release(self, token: str) -> bool:
        """Releases control, or withdraws the pending request. Returns whether the token was known."""
        if self.is_active(token):
            self._lose_active()
        elif self.is_pending(token):
            self._set_pending(None, "withdrawn")
        else:
            return False
        self._on_change()
        return True

    def withdraw(self, request: Request) -> None:
        """Takes back a request that is still pending."""
        if self.pending is request:
            self._set_pending(None, "withdrawn")
            self._on_change()

    def time_left(self) -> float:
        """Remaining time for confirming the forced request [s]; 0 without one."""
        if self._timer is None:
            return 0.0
        return max(0.0, self._timer.when() - asyncio.get_running_loop().time())

    def confirm_at_robot(self) -> None:
        """Confirms a forced request at the robot: the circle button was pressed."""
        if self.pending is not None and self.pending.force:
            self.accept()

    def accept(self) -> None:
        """Gives control to the pending request; the holder keeps it if that one's client has gone."""
        if self.pending is not None:
            if self.pending.is_waiting():
                self._lose_active()
            else:
                self._set_pending(None, "withdrawn")
            self._on_change()

    def deny(self) -> None:
        """Refuses the pending request."""
        if self.pending is not None:
            self._set_pending(None, "denied")
            self._on_change()

    def clear(self) -> None:
        """Clears all requests, as a reboot does."""
        self._set_pending(None, "withdrawn")
        self.active = None
        self._on_change()

    def _expire(self, request: Request) -> None:
        if self.pending is request:
            self._set_pending(None, "denied")
            self._on_change()

    # Grants the pending request, unless its client has gone.
    def _lose_active(self) -> None:
        lost, self.active = self.active, None
        if self.pending is not None and self.pending.is_waiting():
            request, self.pending = self.pending, None
            self._grant(request)
        self._set_pending(None, "withdrawn")
        if lost is not None:
            self._on_loss()

    def _grant(self, request: Request) -> None:
        self.active = request
        request.decide("granted")

    def _set_pending(self, request: Request | None, answer: str) -> None:
        self._stop_timer()
        if self.pending is not None:
            self.pending.decide(answer)
        self.pending = request

    def _stop_timer(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None


def _equal(token: str, sent: str) -> bool:
    return hmac.compare_digest(token.encode(), sent.encode(errors="surrogatepass"))
