# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Reboot and shutdown: Desk is unreachable while the robot is off."""

from __future__ import annotations

import asyncio
import logging
import typing

from pyfranka.desk.answers import unavailable
from pyfranka.desk.robot import Refused, RobotGone
from pyfranka.robot_report import Report

if typing.TYPE_CHECKING:
    from pyfranka.desk.desk import Desk
    from pyfranka.desk.server import Site

LAST_ANSWERS = 0.3  # [s] for which Desk still answers (chosen here)
PAUSE = 0.5  # [s] between two attempts to switch the robot on, or to listen (chosen here)
log = logging.getLogger("franka_desk")


class Power:
    """down: whether the robot is off or boots. site: the web server of its Desk, which is closed while the
    robot is off."""

    def __init__(self, desk: Desk):
        self.down = False
        self.site: Site | None = None
        self._desk = desk
        self._task: asyncio.Task | None = None
        desk.on_report(self._follow)

    def check(self) -> None:
        """Raises DeskError (503) while the robot is off."""
        if self.down:
            raise unavailable("The robot is off or boots.")

    def reboot(self) -> None:
        """Switches the robot off and on again."""
        self._begin(self._reboot())

    def shut_down(self) -> None:
        """Switches the robot off; the line `power on` of the control interface switches it on."""
        self._begin(self._shut_down())

    def _begin(self, work: typing.Coroutine) -> None:
        if self._task is None or self._task.done():
            self._task = self._desk.begin(work)
        else:
            work.close()

    async def _reboot(self) -> None:
        await asyncio.sleep(LAST_ANSWERS)
        loop = asyncio.get_running_loop()
        begin = loop.time()
        await self._take_down()
        await self._send("power off")
        duration = self._desk.options.boot_time or self._desk.profile.boot
        await asyncio.sleep(max(0.0, begin + duration - loop.time()))
        await self._send("power on")
        await self._bring_up()

    async def _shut_down(self) -> None:
        await asyncio.sleep(LAST_ANSWERS)
        await self._take_down()
        await self._send("power off")
        await self._wait_and_bring_up()

    # Switched off at the control interface.
    def _follow(self, before: Report | None, now: Report) -> None:
        if not now.power and (self._task is None or self._task.done()):
            self._begin(self._was_switched_off())

    async def _was_switched_off(self) -> None:
        await self._take_down()
        await self._wait_and_bring_up()

    async def _wait_and_bring_up(self) -> None:
        with self._desk.watch() as event:
            while self._desk.robot.report is None or not self._desk.robot.report.power:
                event.clear()
                await event.wait()
        await self._bring_up()

    async def _take_down(self) -> None:
        self.down = True
        self._desk.sessions.clear()
        self._desk.tokens.clear()
        self._desk.fci.desired = False
        await self._desk.close_sockets()
        if self.site is not None:
            await self.site.close()

    async def _bring_up(self) -> None:
        self.down = False
        while self.site is not None:
            try:
                await self.site.open()
                return
            except OSError as error:  # another program has its port
                log.warning("Desk cannot listen again, and goes on trying: %s", error)
                await asyncio.sleep(PAUSE)

    async def _send(self, line: str) -> None:
        while True:
            try:
                await self._desk.robot.send(line, urgent=True)
                return
            except Refused:
                return  # already in that state
            except RobotGone:
                await asyncio.sleep(PAUSE)
