# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""What must be recovered after an error, and its confirmation (newer interface)."""

from __future__ import annotations

import typing

from pyfranka.desk.actions import acknowledge
from pyfranka.desk.answers import DeskError, bad_request
from pyfranka.robot_report import Report

if typing.TYPE_CHECKING:
    from pyfranka.desk.desk import Desk

Json = dict[str, typing.Any]
SAFETY_ERRORS = ("fsoeConnectionError", "environmentDataTimeout")
SAFE_INPUTS = {
    "safeInputErrorX31": "x31",
    "safeInputErrorX32": "x32",
    "safeInputErrorX33": "x33",
    "safeInputErrorX4": "x4",
    "guidingEnablingDevice": "guidingEnableButton",
}
# These need the operator with the enabling device (X4).
LIMITS, POSITIONS = "jointLimitViolation", "jointPositionErrorDemand"
TYPES = (
    "SafetyError",
    "GenericJointError",
    "SafeInputUnacknowledged",
    "SelfTestsElapsed",
    "LifetimeStatusExceeded",
    "SafetyRuleViolation",
    "JointPositionError",
    "JointLimitViolation",
)


def recovery(report: Report) -> Json | None:
    """The first recovery that is needed; None if there is none."""
    found = report.recoverable
    if errors := [name for name in SAFETY_ERRORS if name in found]:
        return {"type": "SafetyError", "safetyErrors": errors}
    if "genericJointError" in found:
        return {"type": "GenericJointError"}
    if inputs := [word for name, word in SAFE_INPUTS.items() if name in found]:
        return {"type": "SafeInputUnacknowledged", "safeInputs": inputs}
    if "td2Timeout" in found:
        return {"type": "SelfTestsElapsed"}
    if "jointPositionError" in found or any(report.joint_position_error):
        return {"type": "JointPositionError"}
    if any(report.joint_limit_violation):
        return {"type": "JointLimitViolation"}
    return None


async def confirm(desk: Desk, value: Json) -> None:
    """Acknowledges the errors of a type; without a type, those of the first needed recovery."""
    present = recovery(desk.report) or {}
    kind = value.get("type", present.get("type", ""))
    if kind != "" and kind not in TYPES:
        raise bad_request(f"The field type must be one of {', '.join(TYPES)}.")
    names = [name for name in _names(kind) if name in _present(desk.report)]
    if not names:
        raise DeskError(
            424, "ActionUnavailable", "Nothing of this type has to be confirmed.", ["NoAckRequired"]
        )
    for name in names:
        await acknowledge(desk, name)


def _present(report: Report) -> list[str]:
    demanded = {LIMITS: report.joint_limit_violation, POSITIONS: report.joint_position_error}
    return [*report.recoverable, *(name for name, joints in demanded.items() if any(joints))]


def _names(kind: str) -> typing.Sequence[str]:
    return {
        "SafetyError": SAFETY_ERRORS,
        "GenericJointError": ("genericJointError",),
        "SafeInputUnacknowledged": tuple(SAFE_INPUTS),
        "SelfTestsElapsed": ("td2Timeout",),
        "JointPositionError": ("jointPositionError", POSITIONS),
        "JointLimitViolation": (LIMITS,),
    }.get(kind, ())
