# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Desk of one robot: its users' logins, who has control, and what follows the robot's state."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Callable, Coroutine

from pyfranka.desk.answers import unavailable
from pyfranka.desk.limits import Gate
from pyfranka.desk.profiles import PROFILES, Profile, profile_of
from pyfranka.desk.report import Report
from pyfranka.desk.robot import Refused, Robot, RobotGone
from pyfranka.desk.sessions import Sessions, User, Users
from pyfranka.desk.settings import Settings
from pyfranka.desk.tokens import Tokens


class Desk:
    """robot: its control interface. users: of all robots of this process. tokens: who has control."""

    def __init__(self, robot: Robot, settings: Settings, users: Users, gate: Gate):
        self.robot, self.settings, self.users, self.gate = robot, settings, users, gate
        self.options = settings.options
        self.all = [self]  # the Desks of this process
        self.sessions = Sessions(settings.limits.sessions)
        self.tokens = Tokens(self.options.force_timeout, self.changed, self._control_lost)
        self._profile = PROFILES.get(settings.profile)
        self._watchers: set[asyncio.Event] = set()
        self._tasks: set[asyncio.Task] = set()
        self._last: Report | None = None
        self._on_report: list[Callable[[Report | None, Report], None]] = []
        robot.listen(self._follow)

    @property
    def report(self) -> Report:
        """The newest report. Raises DeskError (503) without one."""
        if self.robot.report is None:
            raise unavailable(self.robot.problem)
        return self.robot.report

    @property
    def profile(self) -> Profile:
        """The generation. Raises DeskError (503) before the robot's first report, unless it is set."""
        if self._profile is None:
            self._profile = profile_of(self.report)
        return self._profile

    def open_session(self, user: User) -> str:
        """A new login, which is valid for all robots of this process. @returns its token."""
        token = self.sessions.open(user.name)
        for desk in self.all:
            desk.sessions.add(token, user.name)
        return token

    # ---- changes -----------------------------------------------------------------------------------------

    def on_report(self, listener: Callable[[Report | None, Report], None]) -> None:
        """Calls the listener with the report before and the new one."""
        self._on_report.append(listener)

    def changed(self) -> None:
        """Wakes all watchers: a report has come, or control has changed."""
        for event in self._watchers:
            event.set()

    @contextlib.contextmanager
    def watch(self):
        """An event that is set at each change; the watcher clears it."""
        event = asyncio.Event()
        self._watchers.add(event)
        try:
            yield event
        finally:
            self._watchers.discard(event)

    # Control first, then what is told to clients: who sees the circle button pressed has control already.
    def _follow(self) -> None:
        before, now = self._last, self.robot.report
        self._last = now
        if now is not None:
            if now.buttons.circle and not (before and before.buttons.circle):
                self.tokens.confirm_at_robot()
            for listener in self._on_report:
                listener(before, now)
        self.changed()

    # ---- work beside requests ----------------------------------------------------------------------------

    def begin(self, work: Coroutine) -> asyncio.Task:
        """Runs it beside the requests; the robot's refusals are ignored."""
        task = asyncio.get_running_loop().create_task(_quietly(work))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
        return task

    async def settle(self) -> None:
        """Waits for what a loss of control has begun."""
        await asyncio.gather(*self._tasks)

    async def close(self) -> None:
        """Ends all work."""
        for task in list(self._tasks):
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)

    def _control_lost(self) -> None:
        if self.options.fci_after_release or self.robot.report is None or not self.robot.report.fci:
            return
        self.begin(self.robot.send("fci off", urgent=True))


async def _quietly(work: Coroutine) -> None:
    with contextlib.suppress(Refused, RobotGone):
        await work
