# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Why the machine refuses a line of the control interface: the codes before the sentences."""

from __future__ import annotations

import re

__all__ = ["CODES", "split_refusal"]

CODES = {
    "NotReady",
    "BrakesClosed",
    "EmergencyStopPressed",
    "SelfTestRunning",
    "RecoverableErrorActive",
    "JointRecoveryRequired",
    "WrongOperatingMode",
    "MotionActive",
    "NoAckRequired",
    "NotHomed",
    "NoHand",
}
WITH_CODE = re.compile(r"(?P<code>[A-Z][A-Za-z]+): (?P<sentence>.+)")


def split_refusal(text: str) -> tuple[str, str]:
    """Code and sentence of what follows `error: `; other errors than the machine's rules have no code."""
    match = WITH_CODE.fullmatch(text)
    return (match["code"], match["sentence"]) if match and match["code"] in CODES else ("", text)
