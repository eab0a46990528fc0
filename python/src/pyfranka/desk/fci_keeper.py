# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Switches the FCI on automatically: if it is always on, and if it was requested too early."""

from __future__ import annotations

import asyncio
import contextlib
import typing

from pyfranka.robot_report import Report

if typing.TYPE_CHECKING:
    from pyfranka.desk.desk import Desk

ATTEMPT = 0.5  # [s] between two attempts (chosen here)


class FciKeeper:
    """desired: the FCI becomes active as soon as the robot's rules allow it."""

    def __init__(self, desk: Desk):
        self.desired = False
        self._desk = desk
        self._next_attempt = 0.0
        self._pauses = 0
        desk.on_report(self._follow)

    @contextlib.contextmanager
    def paused(self):
        """While it is active, an FCI that is always on is not switched on."""
        self._pauses += 1
        try:
            yield
        finally:
            self._pauses -= 1

    def _follow(self, before: Report | None, now: Report) -> None:
        if before is not None and _was_stopped(before, now) and self._desk.options.fci_after_stop:
            self.desired = True
        if now.fci or not self._is_desired() or not _is_possible(now):
            return
        time = asyncio.get_running_loop().time()
        if not self._pauses and time >= self._next_attempt:
            self.desired = False
            self._next_attempt = time + ATTEMPT
            self._desk.begin(self._desk.robot.send("fci on"))

    # A robot without tokens has an FCI that is always on.
    def _is_desired(self) -> bool:
        return self.desired or not self._desk.profile.tokens


def _was_stopped(before: Report, now: Report) -> bool:
    return before.fci and now.inputs.x31 and not before.inputs.x31


def _is_possible(now: Report) -> bool:
    return now.power and now.brakes_open and not now.brakes_moving and not now.inputs.x31
