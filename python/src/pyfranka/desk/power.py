# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Reboot and shutdown: Desk is unreachable while the robot is off."""

from __future__ import annotations

import asyncio
import logging
import typing
from collections.abc import Awaitable, Callable, Coroutine

from pyfranka.desk.errors import Refused, RobotGone, unavailable
from pyfranka.desk.robot import DeskRobot
from pyfranka.robot_report import Report

LAST_ANSWERS = 0.3  # [s] for which Desk still answers (chosen here)
PAUSE = 0.5  # [s] between two attempts to switch the robot on, or to listen (chosen here)
log = logging.getLogger("franka_desk")


class Site(typing.Protocol):
    """A web server that can close and open again."""

    async def open(self) -> None:
        """Raises OSError if it cannot listen."""

    async def close(self) -> None:
        """Ends all connections."""


class Power:
    """down: whether the robot is off or boots. site: the web server of its Desk, which is closed while the
    robot is off.

    begin: runs a coroutine in parallel to the requests. clear: ends logins, control and open sockets.
    boot_time: that a reboot takes [s].
    """

    def __init__(
        self,
        robot: DeskRobot,
        begin: Callable[[Coroutine[typing.Any, typing.Any, object]], asyncio.Task[None]],
        clear: Callable[[], Awaitable[None]],
        boot_time: Callable[[], float],
    ):
        self.down = False
        self.site: Site | None = None
        self._robot, self._run, self._clear, self._boot_time = robot, begin, clear, boot_time
        self._has_power = asyncio.Event()
        self._task: asyncio.Task[None] | None = None

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

    def _begin(self, work: Coroutine[typing.Any, typing.Any, object]) -> None:
        if self._task is None or self._task.done():
            self._task = self._run(work)
        else:
            work.close()

    async def _reboot(self) -> None:
        await asyncio.sleep(LAST_ANSWERS)
        loop = asyncio.get_running_loop()
        begin = loop.time()
        await self._take_down()
        await self._send("power off")
        await asyncio.sleep(max(0.0, begin + self._boot_time() - loop.time()))
        await self._send("power on")
        await self._bring_up()

    async def _shut_down(self) -> None:
        await asyncio.sleep(LAST_ANSWERS)
        await self._take_down()
        await self._send("power off")
        await self._wait_and_bring_up()

    def follow(self, now: Report) -> None:
        """Takes a new report: the robot may have been switched off at its control interface."""
        if now.power:
            self._has_power.set()
            return
        self._has_power.clear()
        if self._task is None or self._task.done():
            self._begin(self._was_switched_off())

    async def _was_switched_off(self) -> None:
        await self._take_down()
        await self._wait_and_bring_up()

    async def _wait_and_bring_up(self) -> None:
        await self._has_power.wait()
        await self._bring_up()

    async def _take_down(self) -> None:
        self.down = True
        await self._clear()
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
                await self._robot.send(line, urgent=True)
                return
            except Refused:
                return  # already in that state
            except RobotGone:
                await asyncio.sleep(PAUSE)
