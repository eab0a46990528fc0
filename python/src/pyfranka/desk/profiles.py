# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The generations of Desk: the interfaces of each version of the robot's software."""

from __future__ import annotations

from dataclasses import dataclass

from pyfranka.robot_report import Report


@dataclass(frozen=True)
class Profile:
    """One generation.

    fr3: paths and states of an FR3, otherwise of a Panda. tokens: one user has control and holds its token.
    v1: the newer interface (/api) exists too. version: the answer of `system-version`. boot: time that a
    reboot takes [s].
    """

    name: str
    fr3: bool
    tokens: bool
    v1: bool
    version: str
    boot: float


PROFILES = {
    profile.name: profile
    for profile in (
        Profile("fer-old", fr3=False, tokens=False, v1=False, version="4.0.2", boot=100.0),
        Profile("fer-spoc", fr3=False, tokens=True, v1=False, version="4.2.2", boot=100.0),
        Profile("fr3-early", fr3=True, tokens=True, v1=False, version="5.2.1", boot=40.0),
        Profile("fr3-v1", fr3=True, tokens=True, v1=True, version="5.10.0", boot=40.0),
    )
}
# The newest FCI protocol of the older generation of each type.
OLD_PANDA, EARLY_FR3 = 4, 7


def profile_of(report: Report) -> Profile:
    """The generation of a robot, from its type and its newest protocol."""
    newest = max(report.protocol, default=0)
    if report.type == "fr3":
        return PROFILES["fr3-early" if newest <= EARLY_FR3 else "fr3-v1"]
    return PROFILES["fer-old" if newest <= OLD_PANDA else "fer-spoc"]
