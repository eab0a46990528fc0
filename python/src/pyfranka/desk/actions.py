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


async def move_to_pack_pose(desk: Desk) -> None:
    """Returns when the robot has reached the pose; raises Refused. An FCI that is always on pauses if nothing
    else prevents the motion."""
    try:
        await desk.robot.send("move pack")
    except Refused as refused:
        only_fci = refused.code == "MotionActive" and desk.report.fci and desk.report.mode == "Idle"
        if desk.profile.tokens or not only_fci:
            raise
        with desk.fci.paused():
            await desk.robot.send("fci off")
            await desk.robot.send("move pack")


async def until_tested(desk: Desk) -> None:
    """Returns when the self-test has ended."""
    async with asyncio.timeout(SELF_TEST_LIMIT):
        with desk.watch() as event:
            while desk.report.self_test.running:
                event.clear()
                await event.wait()
