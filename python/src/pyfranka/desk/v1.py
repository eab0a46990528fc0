# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The newer interface: paths below /api. Actions answer 204 without a body."""

from __future__ import annotations

import asyncio
import typing

from pyfranka.desk import actions, checks, status
from pyfranka.desk.access import check_connection, is_connected, not_in_control
from pyfranka.desk.errors import DeskError, Refused, bad_request
from pyfranka.desk.routes import Call, Handler, Login, Route, Token, with_v1
from pyfranka.desk.status import Json
from pyfranka.desk.tokens import Request
from pyfranka.robot_report import Report

# Clients close their side after the timeout that they send; if it is long, the answer comes before that.
LONG_TIMEOUT, EARLY_ANSWER = 5.0, 0.5  # [s]
CHECK_PERIOD = 0.1  # [s] between two checks whether a waiting client is still connected (chosen here)
PACK_POSE = "MoveToPackPose"
OVERDUE = "td2Timeout"  # the error of overdue self-tests
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


async def get_system(call: Call) -> Json:
    return status.system(call.desk)


async def reboot(call: Call) -> None:
    call.desk.power.reboot()


async def shut_down(call: Call) -> None:
    call.desk.power.shut_down()


async def operating_mode(call: Call) -> Json:
    return {"status": status.operating_mode(call.desk.report)}


async def change_operating_mode(call: Call) -> None:
    desired = call.object().get("desiredOperatingMode")
    if desired != "Execution":
        raise bad_request("The field desiredOperatingMode must be Execution; Programming is set in Desk.")
    await call.desk.robot.send("operating_mode execution")


# ---- control ---------------------------------------------------------------------------------------------


async def control_token(call: Call) -> Json:
    active, pending = call.desk.tokens.active, call.desk.tokens.pending
    value: Json = {
        "owner": active and active.owner,
        "requester": pending and pending.owner,
    }
    if call.desk.options.token_id:
        value["tokenId"] = active and active.id
    return value


async def take_control(call: Call) -> Json:
    """Waits while another user has control."""
    body = call.object()
    owner = checks.text(body.get("owner"), "owner")
    timeout = body.get("timeout")
    if timeout is not None and not checks.number(timeout, "timeout") > 0.0:
        raise bad_request("The field timeout must be a positive number of seconds.")
    check_connection(call.request)
    request = call.desk.tokens.request(owner, is_waiting=lambda: is_connected(call.request))
    try:
        await _wait_for_control(call, request, timeout)
        check_connection(call.request)  # it may have gone just after control was granted
    except BaseException:
        call.desk.tokens.release(request.token)
        raise
    value: Json = {"token": request.token}
    if call.desk.options.token_id:
        value["tokenId"] = request.id
    return value


async def release_control(call: Call) -> None:
    token = call.request.headers.get("X-Control-Token", "")
    if not call.desk.tokens.is_active(token):
        raise not_in_control()
    call.desk.tokens.release(token)
    await call.desk.settle()


async def _wait_for_control(call: Call, request: Request, timeout: float | None) -> None:
    loop = asyncio.get_running_loop()
    end = (
        None
        if timeout is None
        else loop.time() + timeout - (EARLY_ANSWER if timeout >= LONG_TIMEOUT else 0.0)
    )
    while not request.answer.done():
        check_connection(call.request)
        left = CHECK_PERIOD if end is None else min(CHECK_PERIOD, end - loop.time())
        if left <= 0.0:
            break
        await asyncio.wait([request.answer], timeout=left)
    answer = request.answer.result() if request.answer.done() else "timeout"
    if answer == "replaced":
        raise DeskError(424, "RequestOverride", "A newer request for control has replaced this one.")
    if answer != "granted":
        why = "The holder has not given control in time." if answer == "timeout" else "Control was not given."
        raise DeskError(424, "Timeout", why)


# ---- FCI, arm, end effector ------------------------------------------------------------------------------


async def fci(call: Call) -> Json:
    return {"status": "Active" if call.desk.report.fci else "Inactive"}


async def activate_fci(call: Call) -> None:
    await actions.activate_fci(call.desk)


async def deactivate_fci(call: Call) -> None:
    await actions.deactivate_fci(call.desk)


async def arm(call: Call) -> Json:
    return {"status": "Connected", "armType": call.desk.report.type.upper()}


async def joints(call: Call) -> list[Json]:
    return [
        {"joint": number, "brakeStatus": word}
        for number, word in enumerate(status.brakes(call.desk.report), start=1)
    ]


async def unlock(call: Call) -> None:
    await call.desk.robot.send("joints unlock")


async def lock(call: Call) -> None:
    await actions.lock(call.desk)


async def warnings(call: Call) -> Json:
    return {"closeToSingularity": status.close_to_singularity(call.desk.report)}


async def start_motion(call: Call) -> None:
    if call.object().get("type") != PACK_POSE:
        raise bad_request(f"The field type must be {PACK_POSE}.")
    await actions.move_to_pack_pose(call.desk)


async def stop_motion(call: Call) -> None:
    await call.desk.robot.send("move stop", urgent=True)


async def end_effector_power(call: Call) -> Json:
    return {"status": status.switch(call.desk.report.end_effector.power)}


async def end_effector_on(call: Call) -> None:
    await call.desk.robot.send("end_effector_power on")


async def end_effector_off(call: Call) -> None:
    await call.desk.robot.send("end_effector_power off")


# ---- safety ----------------------------------------------------------------------------------------------


async def self_tests(call: Call) -> Json:
    report = call.desk.report
    remaining = report.self_test.left if report.self_test.running else report.self_test.due
    return {"status": status.self_test_status(report), "remaining": round(max(0.0, remaining), 3)}


async def execute_self_tests(call: Call) -> None:
    """Also acknowledges overdue tests: clients of this interface do not. They stay overdue if the test is
    refused."""
    overdue = OVERDUE in call.desk.report.recoverable
    if overdue:
        await actions.acknowledge(call.desk, OVERDUE)
    try:
        await call.desk.robot.send("self_test")
    except Refused:
        if overdue:
            await call.desk.robot.send(f"inject {OVERDUE} on")
        raise
    await actions.until_tested(call.desk)


async def get_recovery(call: Call) -> Json:
    value = recovery(call.desk.report)
    if value is None:
        return {}
    top = {"type": value["type"]} if call.desk.options.recovery_type_on_top else {}
    return {**top, "recovery": value}


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


async def confirm_recovery(call: Call) -> None:
    """Acknowledges the errors of a type; without a type, those of the first needed recovery."""
    value, first = call.object({}), recovery(call.desk.report) or {}
    kind = value.get("type", first.get("type", ""))
    if kind != "" and kind not in TYPES:
        raise bad_request(f"The field type must be one of {', '.join(TYPES)}.")
    names = [name for name in _names(kind) if name in _present(call.desk.report)]
    if not names:
        raise DeskError(
            424, "ActionUnavailable", "Nothing of this type has to be confirmed.", ["NoAckRequired"]
        )
    for name in names:
        await actions.acknowledge(call.desk, name)


def _present(report: Report) -> list[str]:
    demanded = {LIMITS: report.joint_limit_violation, POSITIONS: report.joint_position_error}
    return [*report.recoverable, *(name for name, joints in demanded.items() if any(joints))]


def _names(kind: str) -> typing.Sequence[str]:
    return {
        "SafetyError": SAFETY_ERRORS,
        "GenericJointError": ("genericJointError",),
        "SafeInputUnacknowledged": tuple(SAFE_INPUTS),
        "SelfTestsElapsed": ("td2Timeout",),
        # First that which can be refused: then nothing has been acknowledged.
        "JointPositionError": (POSITIONS, "jointPositionError"),
        "JointLimitViolation": (LIMITS,),
    }.get(kind, ())


# ---- configuration, system software ----------------------------------------------------------------------


async def configuration(call: Call) -> Json:
    return call.desk.configuration.get()


async def change_configuration(call: Call) -> None:
    await call.desk.configuration.patch(call.object())


async def mounting(call: Call) -> Json:
    return call.desk.configuration.mounting


async def set_mounting(call: Call) -> None:
    call.desk.configuration.set_mounting(call.object())


async def initial_configuration(call: Call) -> None:
    """The robot has been set up already."""
    call.object()


async def nothing(call: Call) -> Json:
    """For parts that the simulated robot does not have."""
    return {}


async def software(call: Call) -> Json:
    return {"version": call.desk.options.version or call.desk.profile.version, "status": "Current"}


async def no_update(call: Call) -> None:
    raise DeskError(424, "ActionUnavailable", "The simulated robot has no software to update.", ["NoUpdate"])


def _get(path: str, handler: Handler, login: Login = Login.USER) -> Route:
    return Route("GET", path, handler, login=login, where=with_v1)


def _do(
    path: str,
    handler: Handler,
    token: Token = Token.HEADER,
    login: Login = Login.USER,
    method: str = "POST",
) -> Route:
    return Route(method, path, handler, login=login, token=token, where=with_v1)


ROUTES = [
    _get("/api/system", get_system, Login.NONE),
    _get("/api/system/operating-mode", operating_mode, Login.NONE),
    _get("/api/system/control-token", control_token, Login.NONE),
    _get("/api/fci", fci, Login.NONE),
    _get("/api/arm", arm, Login.NONE),
    _get("/api/arm/joints", joints, Login.NONE),
    _get("/api/arm/warnings", warnings, Login.NONE),
    _get("/api/end-effector/power", end_effector_power, Login.NONE),
    _get("/api/safety/self-tests", self_tests),
    _get("/api/safety/recovery", get_recovery),
    _get("/api/configuration", configuration),
    _get("/api/configuration/arm-mounting", mounting),
    _get("/api/system/log", nothing),
    _get("/api/system/log/public/cyclic", nothing),
    _get("/api/system/log/public/events", nothing),
    _get("/api/system/software", software),
    _get("/api/system/software/status-token", nothing),
    _get("/api/system/software/update", nothing),
    _do("/api/system:reboot", reboot, Token.NONE),
    _do("/api/system:shutdown", shut_down, Token.NONE),
    _do("/api/system/operating-mode:change", change_operating_mode),
    _do("/api/system/control-token:take", take_control, Token.NONE),
    _do("/api/system/control-token:release", release_control),
    _do("/api/fci:activate", activate_fci),
    _do("/api/fci:deactivate", deactivate_fci),
    _do("/api/arm/joints:unlock", unlock),
    _do("/api/arm/joints:lock", lock, Token.NONE),
    _do("/api/arm/motion:start", start_motion),
    _do("/api/arm/motion:stop", stop_motion),
    _do("/api/end-effector/power:on", end_effector_on),
    _do("/api/end-effector/power:off", end_effector_off),
    _do("/api/safety/self-tests:execute", execute_self_tests),
    _do("/api/safety/recovery:confirm", confirm_recovery, Token.NONE, Login.SAFETY),
    _do("/api/safety/recovery:start", confirm_recovery, Token.NONE, Login.SAFETY),
    _do("/api/configuration", change_configuration, Token.NONE, Login.ADMIN, "PATCH"),
    _do("/api/configuration/arm-mounting", set_mounting, Token.HEADER, Login.ADMIN, "PUT"),
    _do("/api/configuration/initial", initial_configuration, Token.NONE, Login.ADMIN, "PUT"),
    _do("/api/system/software/update:prepare-online", no_update, Token.NONE, Login.ADMIN),
    _do("/api/system/software/update:prepare-offline", no_update, Token.NONE, Login.ADMIN),
    _do("/api/system/software/update:apply", no_update, Token.NONE, Login.ADMIN),
    _do("/api/system/software/update", nothing, Token.NONE, Login.ADMIN, "DELETE"),
]
