# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Actions of the robot for both interfaces."""

from __future__ import annotations

import asyncio

from pyfranka.desk.desk import Desk
from pyfranka.desk.errors import DeskError, Refused

SELF_TEST_LIMIT = 300.0  # [s] to wait for its end (chosen here: the longest wait of a client)


async def lock(desk: Desk) -> None:
    """Ends motions, switches the FCI off and closes the brakes. An FCI that is always on pauses."""
    with desk.fci.paused():
        await deactivate_fci(desk)
        await desk.robot.send("joints lock", urgent=True)


async def activate_fci(desk: Desk) -> None:
    """Lets FCI clients connect. Raises Refused by the robot's rules."""
    if desk.options.fci_before_unlock and not desk.report.brakes_open:
        desk.fci.desired = True
        return
    await desk.robot.send("fci on")


async def deactivate_fci(desk: Desk) -> None:
    """Ends the client's motion and its connection."""
    desk.fci.desired = False
    await desk.robot.send("fci off", urgent=True)


async def acknowledge(desk: Desk, name: str) -> None:
    """Confirms a recoverable error. Raises DeskError if it is not present."""
    try:
        await desk.robot.send(f"acknowledge {name}")
    except Refused as refused:
        if refused.code != "NoAckRequired":
            raise
        status = desk.options.no_acknowledge_status
        raise DeskError(status, "ActionUnavailable", refused.sentence, [refused.code]) from None


async def self_test(desk: Desk, wait: bool) -> None:
    """Starts the self-test; returns at once or when it has ended."""
    await desk.robot.send("self_test")
    if wait:
        async with asyncio.timeout(SELF_TEST_LIMIT):
            await _until_tested(desk)


async def move_to_pack_pose(desk: Desk) -> None:
    """Returns when the robot has reached the pose; raises Refused. An FCI that is always on pauses, unless a
    client moves the robot."""
    if desk.profile.tokens:
        await desk.robot.send("move pack")
        return
    if desk.report.mode == "Move":
        raise Refused("MotionActive", "A client of the FCI moves the robot.")
    with desk.fci.paused():
        await desk.robot.send("fci off")
        await desk.robot.send("move pack")


async def _until_tested(desk: Desk) -> None:
    with desk.watch() as event:
        while desk.report.self_test.running:
            event.clear()
            await event.wait()
