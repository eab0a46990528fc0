# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The robot's state in the words of both interfaces."""

from __future__ import annotations

import dataclasses
import typing

from pyfranka.desk.desk import Desk
from pyfranka.robot_report import Report

Json = dict[str, typing.Any]
JOINTS = 7
RECOVERABLE = (
    "environmentDataTimeout",
    "fsoeConnectionError",
    "genericJointError",
    "guidingEnablingDevice",
    "jointPositionError",
    "safeInputErrorX31",
    "safeInputErrorX32",
    "safeInputErrorX33",
    "safeInputErrorX4",
    "td2Timeout",
)
REASONS = (
    "conflictingInputs",
    "fsoeWatchdogError",
    "sacoVersionMismatch",
    "nonRecoverableSafetyError",
    "temperatureError",
    "connectionToSafetySettingsManagerLost",
    "environmentDataMissing",
    "safetyVersionMismatch",
)
# Errors that Desk of a Panda always shows, by their names in the FCI; others are added when they are present.
ROBOT_ERRORS = (
    "joint_position_limits_violation",
    "cartesian_position_limits_violation",
    "self_collision_avoidance_violation",
    "joint_velocity_violation",
    "cartesian_velocity_violation",
    "force_control_safety_violation",
    "joint_reflex",
    "cartesian_reflex",
    "power_limit_violation",
    "communication_constraints_violation",
    "tau_j_range_violation",
    "instability_detected",
)
SELF_TEST_SOON = 3600.0  # [s] before its time, from which on it is a warning (chosen here)
# [rad] elbow and wrist nearly stretched (chosen here)
STRETCHED_ELBOW, STRETCHED_WRIST = -0.15, 0.1


def words(flags: typing.Iterable[bool], yes: str, no: str) -> list[str]:
    """A word for each flag."""
    return [yes if flag else no for flag in flags]


def switch(flag: bool) -> str:
    """On or Off."""
    return "On" if flag else "Off"


def needs_recovery(report: Report) -> bool:
    """Whether an error must be acknowledged or a joint must be recovered."""
    return bool(report.recoverable) or needs_joint_recovery(report)


def needs_joint_recovery(report: Report) -> bool:
    """Whether a joint needs the operator: it must be moved back by hand."""
    return any(report.joint_limit_violation) or any(report.joint_position_error)


def operating_mode(report: Report) -> str:
    """In the newer interface's words."""
    if report.self_test.running:
        return "SelfTest"
    if report.inputs.x31 or needs_recovery(report):
        return "SafetyRecovery"
    return report.operating_mode.capitalize()


def controller_status(report: Report) -> str:
    """Of the safety controller."""
    if report.self_test.running:
        return "SelfTest"
    if needs_recovery(report):
        return "Recovery"
    return "Idle" if report.inputs.x31 else "Work"


def self_test_status(report: Report) -> str:
    """Of the newer interface's self-tests."""
    if report.self_test.running:
        return "Running"
    if report.self_test.due <= 0.0:
        return "Elapsed"
    return "Warning" if report.self_test.due < SELF_TEST_SOON else "OK"


def brakes(report: Report) -> list[str]:
    """Of each joint."""
    return words(report.brakes, "Locked", "Unlocked")


def close_to_singularity(report: Report) -> bool:
    """Whether elbow or wrist is nearly stretched."""
    return report.q[3] > STRETCHED_ELBOW or abs(report.q[5]) < STRETCHED_WRIST


def pressed_buttons(report: Report) -> dict[str, bool]:
    """Buttons as clients see them: those with arrows only in the Pilot's mode for Desk, and not while the
    FCI is active."""
    shown = dataclasses.asdict(report.buttons)
    if report.navigation != "desk" or report.fci:
        shown.update(dict.fromkeys(("up", "down", "left", "right"), False))
    return shown


def changed_buttons(before: Report | None, now: Report) -> dict[str, bool]:
    """Buttons that have been pressed or released."""
    shown = pressed_buttons(now)
    old = pressed_buttons(before) if before else dict.fromkeys(shown, False)
    return {name: pressed for name, pressed in shown.items() if pressed != old[name]}


def robot_errors(report: Report) -> dict[str, bool]:
    """Known errors, and others that are present, by names like cartesianReflex."""
    names = dict.fromkeys([*ROBOT_ERRORS, *report.errors])
    return {_camel(name): name in report.errors for name in names}


def control_token(desk: Desk) -> Json:
    """The holder, and a pending request."""
    active, pending = desk.tokens.active, desk.tokens.pending
    return {
        "activeToken": active and {"id": active.id, "ownedBy": active.owner},
        "fciActive": desk.report.fci,
        "tokenRequest": pending and {"id": pending.id, "requestedBy": pending.owner, "force": pending.force},
    }


def system(desk: Desk) -> Json:
    """Of the whole robot, in the newer interface."""
    report, options = desk.report, desk.options
    value = {
        "status": desk.startup,
        "operatingMode": {"status": operating_mode(report)},
        "controlSerialNumber": options.serial_number,
        "cloud": {"connected": False},
    }
    if options.time_to_td2_in_system:
        value["safety"] = {"timeToTd2": round(report.self_test.due, 3)}
    return value


def safety_status(desk: Desk) -> Json:
    """An FR3's safety controller."""
    report = desk.report
    reasons = dict.fromkeys(REASONS, False)
    reasons["conflictingInputs"] = report.light.color == "pink"
    return {
        "sequenceNumber": desk.robot.number,
        "safetyControllerStatus": controller_status(report),
        "safetyControllerStatusReason": {**reasons, "jointsSafetyError": [False] * JOINTS},
        "brakeState": brakes(report),
        "stoState": "SafeTorqueOff" if all(report.brakes) else "SafeTorqueOn",
        "timeToTd2": round(report.self_test.due, 3),
        "activeWarnings": {"safetySettingsInvalidated": False, "temperatureHigh": False},
        "demandedRecoveries": {
            "jointLimitViolation": list(report.joint_limit_violation),
            "jointPositionError": list(report.joint_position_error),
            "safetyRuleViolationsConfirmation": {},
            "safetyRuleViolationsRecovery": {},
        },
        "recoverableErrors": {name: name in report.recoverable for name in RECOVERABLE},
        "activeRecovery": None,
        "safeInputState": {
            "guidingEnableButton": _active(report.inputs.guiding),
            **{name: _active(getattr(report.inputs, name)) for name in ("x31", "x32", "x33", "x4")},
        },
        "powerState": {
            "endEffector": switch(report.end_effector.power),
            "robot": switch(report.power and not report.self_test.running),
        },
        "safetyConfigurationIndex": 1,
        "fsoeConnectionStatus": ["Data"] * JOINTS,
    }


def system_status(desk: Desk) -> Json:
    """Everything about an FR3."""
    report = desk.report
    return {
        "execution": execution(desk),
        "safety": safety_status(desk),
        "robot": {
            "closeToSingularity": close_to_singularity(report),
            "endEffectorConfiguration": end_effector(report),
            "robotErrors": list(report.errors),
        },
        "processes": "Up",
        "startup": {"tag": desk.startup},
        "controlToken": control_token(desk),
        "derived": {
            "operatingMode": operating_mode(report),
            "desiredColor": {
                "color": report.light.color.capitalize(),
                "mode": "Blinking" if report.light.blinking else "Constant",
            },
            "td2Tests": {
                "status": self_test_status(report),
                "canExecute": not report.self_test.running and not needs_recovery(report),
            },
            "lifetime": {"status": "OK", "lifetime": 0, "isConfirmationNeeded": False},
        },
        "firstStart": False,
    }


def execution(desk: Desk) -> Json:
    """Tasks: the simulated robot has none, and each ends as soon as it is started."""
    return {
        "aborted": False,
        "error": None,
        "errorHandling": False,
        "lastActivePath": desk.last_task,
        "remainingWaitTime": 0,
        "running": False,
        "state": {"active": False, "children": [], "exitPort": None, "id": desk.last_task, "result": None},
        "tracking": False,
    }


def end_effector(report: Report) -> Json:
    """The end effector that the robot assumes, as lists."""
    tool = report.end_effector
    return {
        "mass": tool.mass,
        "centerOfMass": list(tool.center),
        "inertia": list(tool.inertia),
        "transformation": list(tool.F_T_NE),
    }


def robot_configuration(desk: Desk) -> Json:
    """Joints, pose, external torques and force."""
    report = desk.report
    return {
        "jointAngles": list(report.q),
        "cartesianPose": list(report.O_T_EE),
        "estimatedTorques": list(report.tau_ext),
        "estimatedForces": list(report.O_F_ext),
    }


def hardware_status(desk: Desk) -> Json:
    """Of the joints and their connection."""
    report = desk.report
    common = {
        "ethernetConnected": True,
        "connectedSlaves": JOINTS,
        "firmwareVersion": ["1.0.0"] * JOINTS,
        "lifetimePercentages": [0] * JOINTS,
        "masterStatus": "OP",
        "slavesOperational": True,
        "startedWithEni": True,
        "jointsInError": [False] * JOINTS,
        "shutdownDataError": list(report.joint_position_error),
    }
    if desk.profile.fr3:
        healthy = {"jointStatus": ["Ok"] * JOINTS, "firmwareDownloadStatus": ["Done"] * JOINTS}
        return {**common, **healthy, "lifetimeConfirmationNeeded": False}
    stopped = report.inputs.x4 or report.inputs.x31 or not report.brakes_open
    return {
        **common,
        "brakesOpen": [not closed for closed in report.brakes],
        "operationalMode": "SS1" if stopped else "Operational",
        "operationalModeTransitionReason": "Stopped" if stopped else "Released",
        "x3Enabled": not report.inputs.x31,
        "x4Enabled": not report.inputs.x4,
    }


def robot_status(desk: Desk) -> Json:
    """Errors and the end effector."""
    report = desk.report
    recovering = report.mode == "Automatic error recovery"
    return {
        "robotErrors": robot_errors(report),
        "recoveryMode": {"automatic": recovering, "folded": False},
        "endEffectorConfiguration": end_effector(report),
    }


def gripper_state(desk: Desk) -> Json:
    """Widths of the hand [m]."""
    hand = desk.report.hand
    return {"width": hand.width, "maxWidth": hand.max_width}


def gripper_hardware(desk: Desk) -> Json:
    """Whether there is a hand, and whether it has been homed."""
    hand = desk.report.hand
    if hand.kind == "none":
        return {"connection_status": "disconnected"}
    return {"connection_status": "initialized" if hand.homed or hand.kind == "vacuum" else "uninitialized"}


def guiding_configuration(desk: Desk) -> Json:
    """Free directions of hand guiding."""
    names = [f"{kind}_{axis}" for kind in ("translation", "rotation") for axis in "xyz"]
    return dict(zip([*names, "elbow"], desk.report.guiding.axes))


def _active(flag: bool) -> str:
    return "Active" if flag else "Inactive"


def _camel(name: str) -> str:
    first, *rest = name.split("_")
    return first + "".join(word.capitalize() for word in rest)
