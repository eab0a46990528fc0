# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Single point of control in the older interface: requests, take-over, release, and activation of the FCI."""

from __future__ import annotations

from pyfranka.desk import actions, checks
from pyfranka.desk.access import not_in_control
from pyfranka.desk.answers import DeskError, bad_request, empty_answer
from pyfranka.desk.routes import Call, Route, with_tokens

PATH = "/admin/api/control-token"


async def request_control(call: Call):
    """Granted at once if no user has control, else pending. With `force`, a press of the circle button at the
    robot grants it."""
    owner = call.object({}).get("requestedBy", call.user.name if call.user else "")
    checks.text(owner, "requestedBy")
    force = call.request.query.get("force", "false").lower() not in ("false", "0")
    request = call.desk.tokens.request(owner, force)
    return {"id": request.id, "token": request.token}


async def cancel_request(call: Call):
    """Withdraws a request that is still pending."""
    token, pending = _token(call), call.desk.tokens.pending
    if pending is None or not call.desk.tokens.is_pending(token) or str(pending.id) != call.words[0]:
        raise unknown_token()
    call.desk.tokens.withdraw(pending)


async def release_control(call: Call):
    """Ends control, or withdraws the pending request of this token. Switches the FCI off."""
    if not call.desk.tokens.release(_token(call)):
        raise unknown_token()
    await call.desk.settle()
    return empty_answer(call.desk.options.release_status)


async def activate_fci(call: Call):
    """With the token in the body."""
    _check_token(call)
    await actions.activate_fci(call.desk)


async def deactivate_fci(call: Call):
    """With the token in the body."""
    _check_token(call)
    await actions.deactivate_fci(call.desk)


async def safety(call: Call):
    """Time limit for the circle button in a forced take-over [s]."""
    time = call.desk.options.force_timeout
    return {"tokenForceTimeout": int(time) if time.is_integer() else time}


def unknown_token() -> DeskError:
    """The token is unknown or expired."""
    return DeskError(404, "ControlTokenUnknown", "This control token is not known. Request control again.")


def _token(call: Call) -> str:
    token = call.object({}).get("token", call.request.headers.get("X-Control-Token"))
    if not isinstance(token, str):
        raise bad_request('The body needs the Control-Token: {"token": "..."}.')
    return token  # clients that have released control send an empty one


def _check_token(call: Call) -> None:
    token = _token(call)
    if call.desk.tokens.is_pending(token):
        raise not_in_control()
    if not call.desk.tokens.is_active(token):
        raise unknown_token()


ROUTES = [
    Route("POST", f"{PATH}/request", request_control, where=with_tokens),
    Route("DELETE", f"{PATH}/request/<id>", cancel_request, where=with_tokens),
    Route("DELETE", PATH, release_control, where=with_tokens),
    Route("POST", f"{PATH}/fci", activate_fci, where=with_tokens),
    Route("DELETE", f"{PATH}/fci", deactivate_fci, where=with_tokens),
    Route("GET", "/admin/api/safety", safety, where=with_tokens),
]
