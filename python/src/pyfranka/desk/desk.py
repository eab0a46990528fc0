# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Desk of one robot: logins of its users, control, and reactions to the robot's state."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Callable, Coroutine, Iterator
from typing import Any

from aiohttp import WSCloseCode, web

from pyfranka.desk.configuration import Configuration
from pyfranka.desk.end_effectors import EndEffectors
from pyfranka.desk.errors import Refused, RobotGone
from pyfranka.desk.fci import FciActivation
from pyfranka.desk.limits import Gate
from pyfranka.desk.power import Power
from pyfranka.desk.profiles import PROFILES, Profile, profile_of
from pyfranka.desk.robot import DeskRobot
from pyfranka.desk.sessions import Sessions, User, Users
from pyfranka.desk.settings import Settings
from pyfranka.desk.tokens import Tokens
from pyfranka.robot_report import Report

RESTART = 2.0  # [s] that a restart of the software takes (chosen here)


class Desk:
    """robot: its control interface. users: of all robots of this process. tokens: control and requests for
    it."""

    def __init__(self, robot: DeskRobot, settings: Settings, users: Users, gate: Gate):
        self.robot, self.settings, self.users, self.gate = robot, settings, users, gate
        self.options = settings.options
        self.all = [self]  # the Desks of this process
        self.sessions = Sessions(settings.limits.sessions)
        self.tokens = Tokens(self.options.force_timeout, self.changed, self._control_lost)
        self._profile = PROFILES.get(settings.profile)
        self._watchers: set[asyncio.Event] = set()
        self._tasks: set[asyncio.Task[None]] = set()
        self._switching_off: asyncio.Task[None] | None = None
        self._last = robot.report
        self._on_report: set[Callable[[Report | None, Report], None]] = set()
        self._sockets: set[web.WebSocketResponse] = set()
        self.power = Power(robot, self.begin, self._clear, self._boot_time)
        self.end_effectors = EndEffectors(robot)
        self.configuration = Configuration(robot.address, users, self.end_effectors, self._close_sessions)
        self.fci = FciActivation(robot, self.options, self.begin)
        self.last_task: str | None = None
        self._restarted = 0.0
        robot.listen(self._follow)

    @property
    def report(self) -> Report:
        """The newest report. Raises RobotGone without one."""
        return self.robot.current_report()

    @property
    def profile(self) -> Profile:
        """The generation. Raises RobotGone before the robot's first report, unless it is set."""
        if self._profile is None:
            self._profile = profile_of(self.report)
        return self._profile

    def open_session(self, user: User) -> str:
        """A new login, which is valid for all robots of this process. Returns its token."""
        token = self.sessions.open(user.name)
        for desk in self.all:
            desk.sessions.add(token, user.name)
        return token

    def _close_sessions(self, name: str) -> None:
        for desk in self.all:
            desk.sessions.close_of(name)

    def _boot_time(self) -> float:
        return self.options.boot_time or self.profile.boot

    @property
    def startup(self) -> str:
        """Phase of the software's start."""
        return "Started" if asyncio.get_running_loop().time() >= self._restarted else "Starting"

    def restart(self) -> None:
        """Starts the robot's software again, as a Panda can."""
        self._restarted = asyncio.get_running_loop().time() + RESTART

    # ---- changes -----------------------------------------------------------------------------------------

    def changed(self) -> None:
        """Wakes all watchers: a report has arrived, or control has changed."""
        for event in self._watchers:
            event.set()

    @contextlib.contextmanager
    def watch(self) -> Iterator[asyncio.Event]:
        """An event that is set at each change; the watcher clears it."""
        event = asyncio.Event()
        self._watchers.add(event)
        try:
            yield event
        finally:
            self._watchers.discard(event)

    @contextlib.contextmanager
    def reports(self, listener: Callable[[Report | None, Report], None]) -> Iterator[None]:
        """Calls the listener with the previous report and the new one."""
        self._on_report.add(listener)
        try:
            yield
        finally:
            self._on_report.discard(listener)

    @contextlib.contextmanager
    def open_socket(self, socket: web.WebSocketResponse) -> Iterator[None]:
        """A WebSocket that is closed when the robot goes down."""
        self._sockets.add(socket)
        try:
            yield
        finally:
            self._sockets.discard(socket)

    # The robot goes down.
    async def _clear(self) -> None:
        self.sessions.clear()
        self.tokens.clear()
        self.fci.desired = False
        closing = [socket.close(code=WSCloseCode.GOING_AWAY) for socket in self._sockets]
        await asyncio.gather(*closing, return_exceptions=True)

    # Control first, then notifications: a client that sees the button has control already.
    def _follow(self) -> None:
        before, now = self._last, self.robot.report
        self._last = now
        if now is not None:
            if not self.settings.profile:
                self._profile = profile_of(now)
            if now.buttons.circle and not (before and before.buttons.circle):
                self.tokens.confirm_at_robot()
            self.power.follow(now)
            self.fci.follow(before, now, always_on=not self.profile.tokens)
            for listener in list(self._on_report):
                listener(before, now)
        self.changed()

    # ---- work between requests ---------------------------------------------------------------------------

    def begin(self, work: Coroutine[Any, Any, object]) -> asyncio.Task[None]:
        """Runs it in parallel to the requests; refusals of the robot are ignored."""
        task = asyncio.get_running_loop().create_task(_quietly(work))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
        return task

    async def settle(self) -> None:
        """Waits until the effects of a loss of control have ended."""
        if self._switching_off is not None:
            await self._switching_off

    async def close(self) -> None:
        """Ends all work."""
        for task in list(self._tasks):
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)

    def _control_lost(self) -> None:
        if self.options.fci_after_release or self.robot.report is None or not self.robot.report.fci:
            return
        self._switching_off = self.begin(self.robot.send("fci off", urgent=True))


async def _quietly(work: Coroutine[Any, Any, object]) -> None:
    with contextlib.suppress(Refused, RobotGone):
        await work
