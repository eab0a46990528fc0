# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Switches the FCI on automatically: if it is always on, and if it was requested too early."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Callable, Coroutine, Iterator
from typing import Any

from pyfranka.desk.robot import DeskRobot
from pyfranka.desk.settings import Options
from pyfranka.robot_report import Report

ATTEMPT = 0.5  # [s] between two attempts (chosen here)


class FciActivation:
    """desired: the FCI becomes active as soon as the robot's rules allow it. begin: runs a coroutine in
    parallel to the requests."""

    def __init__(
        self, robot: DeskRobot, options: Options, begin: Callable[[Coroutine[Any, Any, object]], object]
    ):
        self.desired = False
        self._robot, self._options, self._begin = robot, options, begin
        self._next_attempt = 0.0
        self._pauses = 0

    @contextlib.contextmanager
    def paused(self) -> Iterator[None]:
        """While it is active, an FCI that is always on is not switched on."""
        self._pauses += 1
        try:
            yield
        finally:
            self._pauses -= 1

    def follow(self, before: Report | None, now: Report, always_on: bool) -> None:
        """Takes the previous report and the new one. always_on: as on a robot without tokens."""
        if before is not None and _was_stopped(before, now) and self._options.fci_after_stop:
            self.desired = True
        if now.fci or not (self.desired or always_on) or not _is_possible(now):
            return
        time = asyncio.get_running_loop().time()
        if not self._pauses and time >= self._next_attempt:
            self.desired = False
            self._next_attempt = time + ATTEMPT
            self._begin(self._robot.send("fci on"))


def _was_stopped(before: Report, now: Report) -> bool:
    return before.fci and now.inputs.x31 and not before.inputs.x31


def _is_possible(now: Report) -> bool:
    return now.power and now.brakes_open and not now.brakes_moving and not now.inputs.x31
