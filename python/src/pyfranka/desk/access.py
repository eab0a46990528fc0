# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Whether a request is permitted: checks its login, its control token and its origin."""

from __future__ import annotations

import base64
import binascii
import typing
import urllib.parse

from aiohttp import web

from pyfranka.desk.addresses import address_of
from pyfranka.desk.desk import Desk
from pyfranka.desk.errors import DeskError
from pyfranka.desk.routes import Call, Login, Token
from pyfranka.desk.sessions import User

COOKIE = "authorization"
SAFE_METHODS = {"GET", "HEAD", "OPTIONS"}
OWN_SITES = {"same-origin", "none"}  # of the header Sec-Fetch-Site
ROLES = {Login.SAFETY: {"Admin", "SafetyOperator"}, Login.ADMIN: {"Admin"}}


def is_connected(request: web.Request) -> bool:
    """Whether the client of a request still has its connection."""
    return request.transport is not None and not request.transport.is_closing()


def check_connection(request: web.Request) -> None:
    """Raises DeskError (424), which nobody receives, if the client has gone: it cannot hold control."""
    if not is_connected(request):
        raise DeskError(424, "Withdrawn", "The client has gone.")


def check_origin(request: web.Request, changes: bool) -> None:
    """Refuses requests that a page of another origin makes a browser send; other clients send neither
    header. changes: whether the request may change something, or opens a WebSocket."""
    if not changes and request.method in SAFE_METHODS:
        return
    site = request.headers.get("Sec-Fetch-Site", "none")
    origin = request.headers.get("Origin")
    foreign = origin is not None and _host_of(origin) != request.host.lower()
    if foreign or site not in OWN_SITES:
        raise DeskError(403, "Forbidden", "Requests from pages of another origin are refused.")


def _host_of(origin: str) -> str:
    try:
        return urllib.parse.urlsplit(origin).netloc.lower()
    except ValueError:
        return ""


def check_handshake(request: web.Request) -> None:
    """Raises DeskError (400) if a WebSocket's key has characters for which aiohttp raises other errors."""
    if not request.headers.get("Sec-WebSocket-Key", "").isascii():
        raise DeskError(400, "BadRequest", "The header Sec-WebSocket-Key is not valid.")


def cookies_of(request: web.Request) -> list[str]:
    """The values of the cookie of a login. Not with aiohttp, which raises errors for some cookies that pages
    of other programs at this host have set."""
    pairs = (part.partition("=") for line in request.headers.getall("Cookie", []) for part in line.split(";"))
    return [value.strip().strip('"') for name, _, value in pairs if name.strip() == COOKIE]


def session_of(request: web.Request, desk: Desk) -> str | None:
    """The token of the login in the cookies; None without a valid one."""
    valid = (token for token in cookies_of(request) if desk.sessions.name(token) is not None)
    return next(valid, None)


async def user_of(request: web.Request, desk: Desk) -> User | None:
    """The user that sends the request: by a login (cookie or header), or by name and password. None without
    either. Raises DeskError (401) for a wrong name or password."""
    header = request.headers.get("Authorization", "")
    if header.startswith("Basic "):
        return await _user_of_basic(request, desk, header.removeprefix("Basic "))
    for token in (*cookies_of(request), header):
        name = desk.sessions.name(token) if token else None
        user = desk.users.get(name) if name is not None else None
        if user is not None:
            return user
    return None


async def check_password(
    request: web.Request, desk: Desk, name: str, compare: typing.Callable[[], User | None]
) -> User:
    """Compares a password and returns its user. After many wrong passwords it waits first (LoginThrottle).
    Raises DeskError (401)."""
    found = await desk.gate.logins.compare(address_of(request), name, compare)
    if found is None:
        raise DeskError(401, "WrongCredentials", "User or password is wrong.")
    return found


async def _user_of_basic(request: web.Request, desk: Desk, word: str) -> User:
    try:
        name, _, password = base64.b64decode(word, validate=True).decode().partition(":")
    except (binascii.Error, ValueError):
        name = password = ""
    return await check_password(request, desk, name, lambda: desk.users.by_password(name, password))


def check_login(user: User | None, login: Login) -> None:
    """Raises DeskError: 401 without a login, 403 if the role is too low."""
    if login is Login.NONE:
        return
    if user is None:
        raise DeskError(401, "Unauthorized", "Log in first.")
    if login in ROLES and user.role not in ROLES[login]:
        raise DeskError(403, "Forbidden", f"The role {user.role} may not do this; it needs {login.value}.")


def check_token(call: Call, rule: Token) -> None:
    """Raises DeskError: 400 without a control token, 423 with one that is not the active one."""
    if rule is Token.NONE or not call.desk.profile.tokens:
        return
    sent = call.request.headers.get("X-Control-Token", "")
    candidates = [sent] if sent else []
    if rule is Token.HEADER_OR_FORM and not sent:
        candidates = form_tokens(call)
    if not candidates and rule is not Token.HEADER_LOCKED:
        raise DeskError(
            400,
            "MissingControlToken",
            "The header X-Control-Token is missing. Request control first and send its token.",
        )
    if not any(call.desk.tokens.is_active(token) for token in candidates):
        raise not_in_control()


def not_in_control() -> DeskError:
    """The token does not hold control."""
    return DeskError(423, "Locked", "This token does not have control of the robot. Request control first.")


def form_tokens(call: Call) -> list[str]:
    """The possible tokens in the field `token` of a form: clients send the token in base64."""
    word = call.form().get("token", "")
    if not word:
        return []
    try:
        return [word, base64.b64decode(word, validate=True).decode()]
    except (binascii.Error, ValueError):
        return [word]
