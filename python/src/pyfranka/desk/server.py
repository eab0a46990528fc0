# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The web application: finds the route of a request, checks it, and answers."""

from __future__ import annotations

import asyncio
import logging
import re
import ssl
import urllib.parse
from collections.abc import Awaitable, Callable, Sequence
from typing import Any

from aiohttp import web

from pyfranka.desk import access, legacy, page_api, sockets, v1
from pyfranka.desk.desk import Desk
from pyfranka.desk.errors import DeskError, Refused, RobotGone, unavailable
from pyfranka.desk.limits import Gate
from pyfranka.desk.request_body import read_body
from pyfranka.desk.robot import DeskRobot
from pyfranka.desk.routes import Call, Route, Routes
from pyfranka.desk.sessions import Users
from pyfranka.desk.settings import Settings

Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]

# Newer versions of aiohttp require a key of their own type.
DESK = getattr(web, "AppKey", lambda name, kind: name)("desk", Desk)  # of the application's robot
ROUTES = Routes([*legacy.ROUTES, *v1.ROUTES, *sockets.ROUTES])
OTHER_ROBOT = re.compile(r"/robots/([0-9]{1,3})(/.*)")
HANDSHAKE_TIME = 10.0  # [s] for TLS (chosen here)
LINGER = 1.0  # [s] for the rest of a body after an early answer (chosen here)
TEMPORARY = {"SelfTestRunning", "NotReady"}  # refusals that end after some time: clients try again
log = logging.getLogger("franka_desk")


def make_desks(robots: Sequence[DeskRobot], settings: Settings) -> list[Desk]:
    """Desks of robots, with the same users. Needs a running event loop."""
    users, gate = Users(settings.user, settings.password), Gate(settings.limits)
    desks = [Desk(robot, settings, users, gate) for robot in robots]
    for desk in desks:
        desk.all = desks
    return desks


def make_app(robots: Sequence[DeskRobot], settings: Settings) -> web.Application:
    """The application of the first robot. The paths of the others are below /robots/N, counted from 0."""
    return app_of(make_desks(robots, settings), 0)


def app_of(desks: list[Desk], own: int) -> web.Application:
    """The application of one of the robots."""
    app = web.Application(middlewares=[_finish], client_max_size=desks[own].settings.limits.body)
    app[DESK] = desks[own]
    page_api.add_page(app, desks[own])
    app.router.add_route("*", "/{path:.*}", _dispatch)
    return app


class Site:
    """One robot's application at an address of its own, with TLS. It can close and open again."""

    def __init__(self, app: web.Application, address: str, port: int, context: ssl.SSLContext):
        self._app, self.address, self.port, self._context = app, address, port, context
        self._runner: web.AppRunner | None = None
        self._listening: asyncio.AbstractServer | None = None

    async def open(self) -> None:
        """Listens. Raises OSError if it cannot."""
        if self._runner is None:
            self._runner = web.AppRunner(self._app, access_log=None, lingering_time=LINGER)
            await self._runner.setup()
        assert self._runner.server is not None
        self._listening = await asyncio.get_running_loop().create_server(
            self._app[DESK].gate.factory(self._runner.server),
            self.address,
            self.port,
            ssl=self._context,
            ssl_handshake_timeout=HANDSHAKE_TIME,
        )
        self.port = self._listening.sockets[0].getsockname()[1]

    async def close(self) -> None:
        """Refuses new connections and ends the others."""
        if self._listening is not None:
            self._listening.close()
            self._listening = None
        if self._runner is not None and self._runner.server is not None:
            await self._runner.server.shutdown(0.1)

    async def cleanup(self) -> None:
        """Closes it permanently."""
        await self.close()
        if self._runner is not None:
            await self._runner.cleanup()


@web.middleware
async def _finish(request: web.Request, handler: Handler) -> web.StreamResponse:
    """Applies the limits and converts errors, for every request, also those of pages."""
    newer = _path_of(request).startswith("/api/")
    try:
        await request.app[DESK].gate.enter(request)
        answer = await handler(request)
    except ConnectionError:
        raise
    except Exception as error:
        if isinstance(error, web.HTTPException) and error.status < 400:
            raise
        answer = _error_answer(_desk_error(error, request), newer)
    if not answer.prepared:
        if "Upgrade" in request.headers:  # aiohttp reads no further request of this connection
            answer.force_close()
            request.protocol._message_tail = b""  # a body, which aiohttp 3.11 reads as a request
        answer.headers.setdefault("Server", "franka_desk")
        answer.headers.setdefault("Cache-Control", "no-store")
        answer.headers.setdefault("X-Content-Type-Options", "nosniff")
        answer.headers.setdefault("X-Frame-Options", "DENY")
    return answer


def _desk_error(error: Exception, request: web.Request) -> DeskError:
    if isinstance(error, DeskError):
        return error
    if isinstance(error, Refused):
        details = [error.code] if error.code else []
        return DeskError(
            503 if error.code in TEMPORARY else 424, "ActionUnavailable", error.sentence, details
        )
    if isinstance(error, RobotGone):
        return unavailable(str(error))
    if isinstance(error, web.HTTPException):
        return DeskError(error.status, (error.reason or "").replace(" ", ""), f"{error.text}.")
    log.error("%s %s", request.method, _path_of(request), exc_info=error)
    return DeskError(500, "InternalError", "Internal error; see the log of Desk.")


def _error_answer(error: DeskError, newer: bool) -> web.Response:
    """In the form of one of the interfaces; members of the older one come first."""
    body = {"code": error.code, "message": error.message, "details": error.details}
    if not newer:
        body = {"error": error.code, "reason": (error.details or [error.code])[0], **body}
    return web.json_response(body, status=error.status)


async def _dispatch(request: web.Request) -> web.StreamResponse:
    desk, path = _desk_and_path(request)
    desk.power.check()
    body = await read_body(request, desk.gate.limits)
    matches = ROUTES.find(path, desk.profile)
    if not matches:
        return _not_found(path, desk)
    method = "GET" if request.method == "HEAD" else request.method
    for route, words in matches:
        if route.method == method:
            return await _answer(route, Call(desk, request, path, body, None, words))
    allowed = ", ".join(sorted({route.method for route, _ in matches}))
    error = DeskError(
        405, "MethodNotAllowed", f"The path {path} has no {request.method[:20]}, only {allowed}."
    )
    answer = _error_answer(error, path.startswith("/api/"))
    answer.headers["Allow"] = allowed
    return answer


async def _answer(route: Route, call: Call) -> web.StreamResponse:
    access.check_origin(call.request, route.socket)
    call.user = await access.user_of(call.request, call.desk)
    access.check_login(call.user, route.login)
    access.check_token(call, route.token)
    if route.socket:
        return await _run(route, call)
    # An action completes if its client disconnects.
    work = asyncio.get_running_loop().create_task(_run(route, call))
    work.add_done_callback(_read_error)
    return await asyncio.shield(work)


async def _run(route: Route, call: Call) -> web.StreamResponse:
    value = await route.handler(call)
    if isinstance(value, web.StreamResponse):
        return value
    if value is None:
        # Without the type of JSON, which clients would try to read.
        return web.Response(status=204 if call.path.startswith("/api/") else 200)
    return web.json_response(value)


# Without its client an error has no receiver; reading it keeps asyncio from logging it.
def _read_error(work: asyncio.Task[Any]) -> None:
    if not work.cancelled():
        work.exception()


def _path_of(request: web.Request) -> str:
    """The path without its query, as it was sent; leading slashes may be repeated."""
    path = urllib.parse.unquote(request.raw_path.partition("?")[0], errors="replace")
    return "/" + path.lstrip("/")


def _desk_and_path(request: web.Request) -> tuple[Desk, str]:
    path = _path_of(request)
    match = OTHER_ROBOT.fullmatch(path)
    if match is None:
        return request.app[DESK], path
    desks = request.app[DESK].all
    number = int(match[1])
    if number >= len(desks):
        raise DeskError(404, "NotFound", f"There is no robot {number}; there are {len(desks)}.")
    return desks[number], match[2]


def _not_found(path: str, desk: Desk) -> web.Response:
    if path.startswith("/desk/"):
        shown = path.removeprefix("/desk")[:200]
        for sign, name in (("&", "&amp;"), ("<", "&lt;"), (">", "&gt;")):
            shown = shown.replace(sign, name)
        text = f'<!DOCTYPE html><title>404</title><p>No handler accepted "{shown}"</p>'
        return web.Response(text=text, status=404, content_type="text/html")
    if path.startswith("/api/") and desk.profile.v1:
        return _error_answer(DeskError(404, "NotFound", f"There is nothing at {path[:200]}."), True)
    return web.Response(text="File not found", status=404)
