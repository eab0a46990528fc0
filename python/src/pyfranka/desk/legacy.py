# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The older interface: paths below /admin/api and /desk/api."""

from __future__ import annotations

from pyfranka.desk.access import COOKIE, check_password
from pyfranka.desk.answers import bad_request, text_answer
from pyfranka.desk.routes import Call, Login, Route


async def login(call: Call):
    """Answers with the bare token. It is no cookie: clients make one of it themselves, and two would be one
    too many."""
    body = call.object()
    name, digest = body.get("login"), body.get("password")
    if not isinstance(name, str) or not isinstance(digest, str):
        raise bad_request("The login needs the texts 'login' and 'password'.")
    desk = call.desk
    user = await check_password(call.request, desk, lambda: desk.users.by_digest(name, digest))
    return text_answer(desk.open_session(user))


async def logout(call: Call):
    """Ends the session; control stays where it is."""
    request = call.request
    for token in (request.cookies.get(COOKIE, ""), request.headers.get("Authorization", "")):
        if token:
            call.desk.sessions.close(token)


ROUTES = [
    Route("POST", "/admin/api/login", login, login=Login.NONE),
    Route("POST", "/admin/api/logout", logout),
]
