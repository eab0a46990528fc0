# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The older interface: paths below /admin/api and /desk/api. Success is 200, mostly without a body."""

from __future__ import annotations

import hashlib

from aiohttp import web

from pyfranka.desk import actions, checks
from pyfranka.desk.access import (
    check_connection,
    check_login,
    check_password,
    check_token,
    cookies_of,
    not_in_control,
)
from pyfranka.desk.end_effectors import GENERIC, GRIPPER, PUMP, load_of_lists
from pyfranka.desk.errors import DeskError, bad_request
from pyfranka.desk.routes import Call, Handler, Login, Route, Token, on_fr3, on_panda, with_tokens
from pyfranka.desk.status import JOINTS, RECOVERABLE, Json, end_effector

CONTROL = "/admin/api/control-token"
PROFILES = "/admin/api/end-effector/profiles"
ERROR_IDS = {
    **{name.lower(): name for name in RECOVERABLE},
    "jointposition": "jointPositionError",
}
GUIDING_MODES = ("translation", "rotation", "free", "user")
PILOT_MODES = {"one": "desk", "desk": "desk", "robot": "robot"}

# ---- login -----------------------------------------------------------------------------------------------


async def login(call: Call) -> web.Response:
    """Answers with the bare token. Not as a cookie, because clients create the cookie themselves, and two
    of one name would conflict."""
    body = call.object()
    name, digest = body.get("login"), body.get("password")
    if not isinstance(name, str) or not isinstance(digest, str):
        raise bad_request("The login needs the texts 'login' and 'password'.")
    desk = call.desk
    user = await check_password(call.request, desk, name, lambda: desk.users.by_digest(name, digest))
    return web.Response(text=desk.open_session(user))


async def logout(call: Call) -> None:
    """Ends the session; control does not change."""
    request = call.request
    for token in (*cookies_of(request), request.headers.get("Authorization", "")):
        if token:
            call.desk.sessions.close(token)


async def login_page(call: Call) -> web.Response:
    """Redirects browsers to Desk's page."""
    refresh = '<meta http-equiv="refresh" content="0; url=/">'
    text = f'<!DOCTYPE html><title>Desk</title>{refresh}<p><a href="/">Desk</a></p>'
    return web.Response(text=text, content_type="text/html")


async def first_start(call: Call) -> bool:
    """Whether the robot has never been set up."""
    return False


# ---- control ---------------------------------------------------------------------------------------------


async def request_control(call: Call) -> Json:
    """Granted at once if no user has control, else pending. With `force`, a press of the circle button at the
    robot grants it."""
    owner = call.object({}).get("requestedBy", call.user.name if call.user else "")
    checks.text(owner, "requestedBy")
    force = call.request.query.get("force", "false").lower() not in ("false", "0")
    check_connection(call.request)
    request = call.desk.tokens.request(owner, force)
    return {"id": request.id, "token": request.token}


async def cancel_request(call: Call) -> None:
    """Withdraws a request that is still pending."""
    token, pending = _body_token(call), call.desk.tokens.pending
    if pending is None or not call.desk.tokens.is_pending(token) or str(pending.id) != call.words[0]:
        raise unknown_token()
    call.desk.tokens.withdraw(pending)


async def release_control(call: Call) -> web.Response:
    """Ends control, or withdraws the pending request of this token. Switches the FCI off."""
    if not call.desk.tokens.release(_body_token(call)):
        raise unknown_token()
    await call.desk.settle()
    return web.Response(status=call.desk.options.release_status)


async def activate_fci_by_body(call: Call) -> None:
    """With the token in the body."""
    _check_body_token(call)
    await actions.activate_fci(call.desk)


async def deactivate_fci_by_body(call: Call) -> None:
    """With the token in the body."""
    _check_body_token(call)
    await actions.deactivate_fci(call.desk)


async def safety(call: Call) -> Json:
    """Time limit for the circle button in a forced take-over [s]."""
    time = call.desk.options.force_timeout
    return {"tokenForceTimeout": int(time) if time.is_integer() else time}


def unknown_token() -> DeskError:
    """The token is unknown or expired."""
    return DeskError(404, "ControlTokenUnknown", "This control token is not known. Request control again.")


def _body_token(call: Call) -> str:
    token = call.object({}).get("token", call.request.headers.get("X-Control-Token"))
    if not isinstance(token, str):
        raise bad_request('The body needs the Control-Token: {"token": "..."}.')
    return token  # clients that have released control send an empty one


def _check_body_token(call: Call) -> None:
    token = _body_token(call)
    if call.desk.tokens.is_pending(token):
        raise not_in_control()
    if not call.desk.tokens.is_active(token):
        raise unknown_token()


# ---- brakes, FCI, modes ----------------------------------------------------------------------------------


async def unlock(call: Call) -> None:
    """Opens the brakes, one joint after the other."""
    await call.desk.robot.send("joints unlock")


async def lock(call: Call) -> None:
    """Closes the brakes. It needs no control, because it is safe."""
    await actions.lock(call.desk)


async def activate_fci(call: Call) -> None:
    """With the token as header or in the form."""
    await actions.activate_fci(call.desk)


async def deactivate_fci(call: Call) -> None:
    """With the token as header or in the form."""
    await actions.deactivate_fci(call.desk)


async def execution_mode(call: Call) -> None:
    """For tasks and the FCI."""
    await call.desk.robot.send("operating_mode execution")


async def programming_mode(call: Call) -> None:
    """For guiding by hand; switches the FCI off."""
    await call.desk.robot.send("operating_mode programming")


async def guiding_mode(call: Call) -> None:
    """Sets the free directions of guiding."""
    mode = _mode(call)
    if mode not in GUIDING_MODES:
        raise bad_request(f"The field mode must be one of {', '.join(GUIDING_MODES)}.")
    line = f"guiding_mode {mode}"
    if mode == "user":
        line += "".join(" on" if free else " off" for free in call.desk.report.guiding.axes)
    await call.desk.robot.send(line)


async def pilot_mode(call: Call) -> None:
    """Sets the target of the Pilot's arrow keys."""
    mode = _mode(call)
    if mode not in PILOT_MODES:
        raise bad_request(f"The field mode must be one of {', '.join(PILOT_MODES)}.")
    await call.desk.robot.send(f"navigation {PILOT_MODES[mode]}")


# ---- the arm ---------------------------------------------------------------------------------------------


async def homing(call: Call) -> None:
    """Homes the hand; returns when it has ended."""
    await call.desk.robot.send("hand homing")


async def start_task(call: Call) -> None:
    """The simulated robot has no tasks: each ends at once."""
    call.desk.last_task = checks.text(call.form().get("id"), "id")


async def stop_task(call: Call) -> None:
    """There is no task to stop."""


async def reset_errors(call: Call) -> None:
    """Automatic error recovery."""
    if call.desk.report.errors:
        await call.desk.robot.send("recover")


async def fold(call: Call) -> None:
    """Moves to the pose for transport; returns when it has ended."""
    await actions.move_to_pack_pose(call.desk)


async def restart(call: Call) -> None:
    """Closes the brakes and starts the software again."""
    await actions.lock(call.desk)
    call.desk.restart()


async def position_errors(call: Call) -> list[bool]:
    """Joints that have lost their position while the robot was off."""
    return list(call.desk.report.joint_position_error)


async def reset_position_error(call: Call) -> None:
    """Accepts a joint's present position as correct."""
    word = call.words[0]
    if word not in map(str, range(JOINTS)):
        raise bad_request(f"A joint's number must be 0 to {JOINTS - 1}.")
    if call.desk.report.joint_position_error[int(word)]:
        await call.desk.robot.send(f"inject jointPositionErrorDemand {int(word) + 1} off")


# ---- the system ------------------------------------------------------------------------------------------


async def reboot(call: Call) -> None:
    """Answers first."""
    call.desk.power.reboot()


async def shut_down(call: Call) -> None:
    """Answers first."""
    call.desk.power.shut_down()


async def system_version(call: Call) -> str:
    """The version, and two lines that name its source."""
    version = version_of(call)
    return "\n".join([version, *(hashlib.sha1((version + part).encode()).hexdigest() for part in "ab")])


def version_of(call: Call) -> str:
    """Of the robot's software."""
    return call.desk.options.version or call.desk.profile.version


async def nameplate(call: Call) -> Json:
    """Identification of the robot."""
    return {"serialNumber": call.desk.options.serial_number, "armId": call.desk.report.arm_id}


async def features(call: Call) -> Json:
    """The installed features."""
    return {"fci": True}


async def acknowledge(call: Call) -> None:
    """Confirms a recoverable error."""
    word = call.request.query.get("error_id", "")
    name = ERROR_IDS.get(word.lower())
    if name is None:
        raise bad_request(f"The field error_id must be one of {', '.join(ERROR_IDS.values())}.")
    await actions.acknowledge(call.desk, name)


async def self_test(call: Call) -> Json:
    """Starts the test; the states show its end."""
    await call.desk.robot.send("self_test")
    return {"code": "SuccessResponse"}


# ---- end effectors ---------------------------------------------------------------------------------------


async def selection(call: Call) -> str:
    """A Panda's device."""
    return call.desk.end_effectors.selection


async def select(call: Call) -> None:
    """A Panda's device."""
    name = call.json()
    if name not in (GENERIC, GRIPPER, PUMP):
        raise bad_request(f"The end effector must be {GENERIC}, {GRIPPER} or {PUMP}.")
    call.desk.end_effectors.selection = name


async def get_end_effector(call: Call) -> Json:
    """The end effector that a Panda assumes."""
    return end_effector(call.desk.report)


async def set_end_effector(call: Call) -> None:
    """Sets the end effector that a Panda assumes."""
    await call.desk.end_effectors.set_load(load_of_lists(call.object()))


async def profiles(call: Call) -> list[Json]:
    """All profiles of an FR3."""
    return call.desk.end_effectors.list()


async def active_profile(call: Call) -> Json:
    """The active profile of an FR3."""
    return call.desk.end_effectors.active()


async def add_profile(call: Call) -> Json:
    """Adds a profile, which is not active."""
    return {"id": call.desk.end_effectors.add(call.object())}


async def change_profile(call: Call) -> None:
    """Only the holder can change the active profile."""
    if call.desk.end_effectors.is_active(call.words[0]):
        check_token(call, Token.HEADER_LOCKED)
    await call.desk.end_effectors.change(call.words[0], call.object())


async def delete_profile(call: Call) -> None:
    """Deletes a profile that is not active."""
    call.desk.end_effectors.delete(call.words[0])


async def activate_profile(call: Call) -> None:
    """The body is its id, as a JSON string."""
    await call.desk.end_effectors.activate(checks.text(call.json(), "The body"))


async def _power_without_login(call: Call, action: Handler) -> None:
    if not call.desk.options.power_without_login:
        check_login(call.user, Login.USER)
    await action(call)


def _mode(call: Call) -> str:
    return call.form().get("mode", "").strip('"')


def _power(path: str, action: Handler) -> Route:
    return Route("POST", path, lambda call: _power_without_login(call, action), login=Login.NONE)


def _shutdown_errors(prefix: str) -> list[Route]:
    path = f"{prefix}/robot/shutdown-position-error"
    return [
        Route("GET", path, position_errors, where=on_panda),
        Route("DELETE", f"{path}/<joint>", reset_position_error, token=Token.HEADER, where=on_panda),
    ]


ROUTES = [
    Route("POST", "/admin/api/login", login, login=Login.NONE),
    Route("POST", "/admin/api/logout", logout),
    Route("GET", "/admin/login", login_page, login=Login.NONE),
    Route("GET", "/admin/api/first-start", first_start, login=Login.NONE),
    Route("POST", f"{CONTROL}/request", request_control, where=with_tokens),
    Route("DELETE", f"{CONTROL}/request/<id>", cancel_request, where=with_tokens),
    Route("DELETE", CONTROL, release_control, where=with_tokens),
    Route("POST", f"{CONTROL}/fci", activate_fci_by_body, where=with_tokens),
    Route("DELETE", f"{CONTROL}/fci", deactivate_fci_by_body, where=with_tokens),
    Route("GET", "/admin/api/safety", safety, where=with_tokens),
    Route("POST", "/desk/api/robot/open-brakes", unlock, token=Token.HEADER, where=on_panda),
    Route("POST", "/desk/api/robot/close-brakes", lock, where=on_panda),
    Route("POST", "/desk/api/joints/unlock", unlock, token=Token.HEADER, where=on_fr3),
    Route("POST", "/desk/api/joints/lock", lock, where=on_fr3),
    Route("POST", "/desk/api/system/fci", activate_fci, token=Token.HEADER_OR_FORM, where=on_fr3),
    Route("DELETE", "/desk/api/system/fci", deactivate_fci, token=Token.HEADER_OR_FORM, where=on_fr3),
    Route("POST", "/desk/api/operating-mode/execution", execution_mode, token=Token.HEADER, where=on_fr3),
    Route("POST", "/desk/api/operating-mode/programming", programming_mode, token=Token.HEADER, where=on_fr3),
    Route("PUT", "/desk/api/robot/guiding/mode", guiding_mode, token=Token.HEADER),
    Route("PUT", "/desk/api/navigation/mode", pilot_mode, token=Token.HEADER),
    Route("POST", "/desk/api/gripper/homing", homing, token=Token.HEADER),
    Route("POST", "/desk/api/execution", start_task),
    Route("DELETE", "/desk/api/execution", stop_task),
    Route("POST", "/desk/api/robot/reset-errors", reset_errors, token=Token.HEADER),
    Route("POST", "/desk/api/robot/fold", fold, token=Token.HEADER),
    Route("POST", "/desk/api/robot/restart", restart, where=on_panda),
    *_shutdown_errors("/desk/api"),
    *_shutdown_errors("/admin/api"),
    _power("/admin/api/reboot", reboot),
    _power("/desk/api/reboot", reboot),
    _power("/admin/api/shutdown", shut_down),
    Route("GET", "/admin/api/system-version", system_version, login=Login.NONE),
    Route("GET", "/admin/api/robot/nameplate", nameplate),
    Route("GET", "/admin/api/features", features),
    Route(
        "POST",
        "/admin/api/safety/recoverable-safety-errors/acknowledge",
        acknowledge,
        token=Token.HEADER,
        where=on_fr3,
    ),
    Route("POST", "/admin/api/safety/td2-tests/execute", self_test, token=Token.HEADER, where=on_fr3),
    Route("GET", "/admin/api/end-effectors/selection", selection, where=on_panda),
    Route("PUT", "/admin/api/end-effectors/selection", select, token=Token.HEADER, where=on_panda),
    Route("GET", "/admin/api/end-effector-configuration", get_end_effector, where=on_panda),
    Route(
        "POST", "/admin/api/end-effector-configuration", set_end_effector, token=Token.HEADER, where=on_panda
    ),
    Route("GET", PROFILES, profiles, where=on_fr3),
    Route("POST", PROFILES, add_profile, where=on_fr3),
    Route("GET", f"{PROFILES}/active", active_profile, where=on_fr3),
    Route("PUT", f"{PROFILES}/active", activate_profile, token=Token.HEADER_LOCKED, where=on_fr3),
    Route("PUT", f"{PROFILES}/<id>", change_profile, where=on_fr3),
    Route("DELETE", f"{PROFILES}/<id>", delete_profile, where=on_fr3),
]
