# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Handler, permissions and robots of each path."""

from __future__ import annotations

import enum
import json
import typing
import urllib.parse
from collections.abc import Awaitable, Callable, Iterable
from dataclasses import dataclass, field

from aiohttp import web

from pyfranka.desk.desk import Desk
from pyfranka.desk.errors import bad_request
from pyfranka.desk.profiles import Profile
from pyfranka.desk.sessions import User


class Login(enum.Enum):
    """Users that may use a path."""

    NONE = "all clients"
    USER = "any user"
    SAFETY = "users of the roles SafetyOperator and Admin"
    ADMIN = "users of the role Admin"


class Token(enum.Enum):
    """Whether a path needs control."""

    NONE = "no"
    HEADER = "the active token in the header X-Control-Token"
    HEADER_OR_FORM = "the same, or in the form's field token"
    HEADER_LOCKED = "as HEADER; a missing token is answered like a wrong one"


@dataclass
class Call:
    """One checked request with its user and its body. words: the variable parts of its path."""

    desk: Desk
    request: web.Request
    path: str
    body: bytes
    user: User | None = None
    words: tuple[str, ...] = ()

    def json(self, default: typing.Any = None) -> typing.Any:
        """The body as JSON, or the default if it is empty. Raises DeskError (400)."""
        if not self.body.strip():
            if default is not None:
                return default
            raise bad_request("The request needs a body in JSON.")
        try:
            return json.loads(self.body, parse_constant=_no_constant)
        except (ValueError, RecursionError):
            raise bad_request("The body is not valid JSON.") from None

    def object(self, default: typing.Any = None) -> dict[str, typing.Any]:
        """The body as a JSON object. Raises DeskError (400)."""
        value = self.json(default)
        if not isinstance(value, dict):
            raise bad_request("The body is not a JSON object, such as {}.")
        return value

    def form(self) -> dict[str, str]:
        """The body as a form. Raises DeskError (400)."""
        try:
            pairs = urllib.parse.parse_qsl(self.body.decode(), keep_blank_values=True, max_num_fields=100)
        except ValueError:
            raise bad_request("The body is not a valid form.") from None
        return dict(pairs)


Handler = Callable[[Call], Awaitable[typing.Any]]
Where = Callable[[Profile], bool]


def everywhere(profile: Profile) -> bool:
    """On all robots."""
    return True


def on_fr3(profile: Profile) -> bool:
    """On FR3s."""
    return profile.fr3


def on_panda(profile: Profile) -> bool:
    """On Pandas."""
    return not profile.fr3


def with_tokens(profile: Profile) -> bool:
    """On robots with control tokens."""
    return profile.tokens


def with_v1(profile: Profile) -> bool:
    """On robots with the newer interface."""
    return profile.v1


@dataclass(frozen=True)
class Route:
    """method and path of a request. A part of the path in angle brackets is variable. socket: a GET may
    become a WebSocket."""

    method: str
    path: str
    handler: Handler
    login: Login = Login.USER
    token: Token = Token.NONE
    where: Where = everywhere
    socket: bool = False


@dataclass
class Routes:
    """All routes, found by method and path."""

    routes: Iterable[Route]
    _fixed: dict[str, list[Route]] = field(default_factory=dict)
    _variable: list[tuple[list[str], Route]] = field(default_factory=list)

    def __post_init__(self) -> None:
        for route in self.routes:
            if "<" in route.path:
                self._variable.append((route.path.split("/"), route))
            else:
                self._fixed.setdefault(route.path, []).append(route)

    def find(self, path: str, profile: Profile) -> list[tuple[Route, tuple[str, ...]]]:
        """The routes of a path on that robot, with the variable parts."""
        found: list[tuple[Route, tuple[str, ...]]] = []
        found += ((route, ()) for route in self._fixed.get(path, ()) if route.where(profile))
        if found:
            return found
        parts = path.split("/")
        matches = ((route, _words(pattern, parts)) for pattern, route in self._variable)
        return [(route, words) for route, words in matches if words is not None and route.where(profile)]


def _words(pattern: list[str], parts: list[str]) -> tuple[str, ...] | None:
    if len(pattern) != len(parts):
        return None
    words = []
    for expected, part in zip(pattern, parts):
        if expected.startswith("<"):
            words.append(part)
        elif expected != part:
            return None
    return tuple(words)


def _no_constant(word: str) -> typing.NoReturn:
    raise ValueError(word)
