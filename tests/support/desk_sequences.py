# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Requests of Desk clients that no registry has: their order, headers and bodies, as they send them.

In paths, headers and bodies, {token}, {id}, {login}, {user} and {digest} stand for what earlier steps kept.
"""

import base64
import hashlib
from collections.abc import Callable
from dataclasses import dataclass

JSON, FORM = "application/json", "application/x-www-form-urlencoded"
BOUNDARY = "6a3e0f1c5d2b48979b1f00c2d4e6a8b0"
HeaderLines = list[tuple[str, str]]


def digest_of(user: str, password: str, *, unbroken: bool = False) -> str:
    """The password as clients send it; MIME's line breaks are part of it for most of them."""
    digest = hashlib.sha256(f"{password}#{user}@franka".encode()).digest()
    encode = base64.b64encode if unbroken else base64.encodebytes
    return encode(",".join(map(str, digest)).encode()).decode()


@dataclass(frozen=True)
class Step:
    """One request. keep: fields of the JSON answer to keep, or "login" for the whole body. until: repeats the
    request until the JSON answer fulfils it. press: the operator presses that button meanwhile."""

    method: str
    path: str
    body: str | None = None
    kind: str = ""
    status: int = 200
    with_token: bool = False
    keep: tuple[str, ...] = ()
    until: Callable[[dict, dict], bool] | None = None
    press: str = ""
    text: str = ""  # that the answer contains


@dataclass(frozen=True)
class Stream:
    """A WebSocket that a client opens: until a message that fulfils `until`."""

    path: str
    until: Callable[[dict], bool]
    press: str = ""


# ---- how each client's library writes a request -----------------------------------------------------------


def by_requests(step: Step, kept: dict) -> HeaderLines:
    """Python's requests."""
    lines = [
        ("User-Agent", "python-requests/2.31.0"),
        ("Accept-Encoding", "gzip, deflate"),
        ("Accept", "*/*"),
        ("Connection", "keep-alive"),
    ]
    if step.with_token:
        lines.append(("X-Control-Token", kept["token"]))
    if "login" in kept:
        lines.append(("Cookie", f"authorization={kept['login']}"))
    return lines + _body_lines(step)


def by_http_client(step: Step, kept: dict) -> HeaderLines:
    """Python's http.client. frankx sends the cookie from the first request on."""
    lines = [("Accept-Encoding", "identity")]
    if step.method != "GET":
        lines.append(("Content-Length", str(len(step.body or ""))))
    lines.append(("Cookie", f"authorization={kept.get('login')}"))
    return [*lines, ("content-type", step.kind)] if step.kind else lines


def by_cpp(step: Step, kept: dict) -> HeaderLines:
    """A C++ library with few headers."""
    lines = [("Connection", "Keep-Alive")]
    if "login" in kept:
        lines.append(("Cookie", f"authorization={kept['login']}"))
    if step.with_token:
        lines.append(("X-Control-Token", kept["token"]))
    return lines + _body_lines(step)


def by_aiohttp(step: Step, kept: dict) -> HeaderLines:
    """Python's aiohttp."""
    lines = [("X-Control-Token", kept["token"])] if step.with_token else []
    lines += [
        ("Accept", "*/*"),
        ("Accept-Encoding", "gzip, deflate"),
        ("User-Agent", "Python/3.10 aiohttp/3.9.1"),
    ]
    if "login" in kept:
        lines.append(("Cookie", f'authorization="{kept["login"]}"'))  # aiohttp puts quotes around some values
    return lines + _body_lines(step)


def _body_lines(step: Step) -> HeaderLines:
    if step.method == "GET":
        return []
    lines = [("Content-Length", str(len(step.body or "")))]
    return [*lines, ("Content-Type", step.kind)] if step.kind else lines


# ---- the clients ------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Sequence:
    """A client's way to a robot whose FCI is ready, and the way back."""

    client: str
    profiles: tuple[str, ...]
    headers: Callable[[Step, dict], HeaderLines]
    start: list[Step | Stream]
    end: list[Step | Stream]
    options: tuple[str, ...] = ()  # of Desk that are on
    held: bool = False  # whether another user has control at first
    unbroken: bool = False  # whether the password's digest has no line breaks
    closed: bool = False  # whether the brakes stay closed at the end

    @property
    def name(self) -> str:
        return self.client.replace(" ", "_")


def multipart(value: str) -> tuple[str, str]:
    """The field `force` as a file, which several clients make of it."""
    head = f'--{BOUNDARY}\r\nContent-Disposition: form-data; name="force"; filename="force"\r\n\r\n'
    return f"{head}{value}\r\n--{BOUNDARY}--\r\n", f"multipart/form-data; boundary={BOUNDARY}"


def login() -> Step:
    return Step(
        "POST", "/admin/api/login", '{"login": "{user}", "password": "{digest}"}', JSON, keep=("login",)
    )


def request_control(query: str = "") -> Step:
    body = '{"requestedBy": "{user}"}'
    return Step("POST", f"/admin/api/control-token/request{query}", body, JSON, keep=("token", "id"))


def is_active(answer: dict, kept: dict) -> bool:
    active = answer["activeToken"]
    return active is not None and active["id"] == kept["id"]


def all_are(value: str) -> Callable[[dict], bool]:
    return lambda message: message["brakeState"] == [value] * 7


def open_brakes(value: str, *, path: str = "/desk/api/robot/open-brakes", with_token: bool = True) -> Step:
    return Step("POST", path, *multipart(value), with_token=with_token)


TOKEN_STATE = Step("GET", "/admin/api/control-token")
WITH_TOKEN = ('{"token": "{token}"}', JSON)
ACTIVATE = Step("POST", "/admin/api/control-token/fci", *WITH_TOKEN)
RELEASE = Step("DELETE", "/admin/api/control-token", *WITH_TOKEN)
HOMING = Step("POST", "/desk/api/gripper/homing", with_token=True)
LOGOUT = Step("POST", "/admin/api/logout")
SAFETY = Step("GET", "/admin/api/safety", text="tokenForceTimeout")
OPEN, CLOSE = "/desk/api/robot/open-brakes", "/desk/api/robot/close-brakes"
UNLOCK, LOCK = "/desk/api/joints/unlock", "/desk/api/joints/lock"
CIRCLE = Stream("/desk/api/navigation/events", lambda event: event.get("circle", False), press="circle")

SEQUENCES = [
    Sequence(
        "frankx",
        ("fer-old",),
        by_http_client,
        [login(), Step("POST", OPEN, None, FORM), Step("POST", "/desk/api/execution", "id=pick", FORM)],
        [Step("DELETE", "/desk/api/execution", None, FORM), Step("POST", CLOSE, None, FORM)],
        closed=True,
    ),
    Sequence(
        "DVK",
        ("fer-old",),
        by_requests,
        [login(), Step("POST", OPEN)],
        [Step("POST", CLOSE), LOGOUT],
        unbroken=True,
        closed=True,
    ),
    Sequence(
        "franka_lock_unlock with a physical request",
        ("fer-spoc",),
        by_requests,
        [
            login(),
            request_control("?force"),
            Step("GET", "/admin/api/control-token", until=is_active, press="circle"),
            open_brakes("false"),
            ACTIVATE,
        ],
        [open_brakes("false", path=CLOSE), RELEASE, LOGOUT],
        held=True,
        closed=True,
    ),
    Sequence(
        "franka_lock_unlock of an FR3",
        ("fr3-early", "fr3-v1"),
        by_requests,
        [
            login(),
            TOKEN_STATE,
            request_control(),
            open_brakes("true", path=UNLOCK),
            Step("POST", "/admin/api/control-token/fci", *WITH_TOKEN, with_token=True),
        ],
        [open_brakes("true", path=LOCK), RELEASE, LOGOUT],
        closed=True,
    ),
    Sequence(
        "PandaConnector",
        ("fer-spoc",),
        by_cpp,
        [
            login(),
            Step("GET", "/admin/api/system-version", text="4.2"),
            SAFETY,
            request_control("?force="),
            Step("GET", "/admin/api/control-token", until=is_active, press="circle"),
            Step("POST", OPEN, '{"force":"true"}', JSON, with_token=True),
            Step("POST", OPEN, '{"force":"true"}', JSON, with_token=True),
            HOMING,
            ACTIVATE,
        ],
        [RELEASE],
        held=True,
        unbroken=True,
    ),
    Sequence(
        "PandaConnector without control",
        ("fer-old",),
        by_cpp,
        [
            login(),
            Step("GET", "/admin/api/system-version", text="4.0"),
            Step("POST", OPEN, "force=false", FORM),
        ],
        [],
        unbroken=True,
    ),
    Sequence(
        "panda_desk",
        ("fr3-early", "fr3-v1"),
        by_aiohttp,
        [
            login(),
            TOKEN_STATE,
            request_control("?force"),
            SAFETY,
            CIRCLE,
            Step("GET", "//desk/api/robot/configuration", text="jointAngles"),
            ACTIVATE,
            Step("POST", "/desk/api/operating-mode/execution", with_token=True),
            open_brakes("True", path=UNLOCK),
            Stream("/admin/api/safety/status", all_are("Unlocked")),
        ],
        [open_brakes("True", path=LOCK, with_token=False), RELEASE, LOGOUT],
        options=("fci_before_unlock",),
        closed=True,
    ),
    Sequence(
        "panda-py 0.8",
        ("fer-spoc",),
        by_requests,
        [login(), TOKEN_STATE, request_control(), open_brakes("True"), ACTIVATE],
        [
            open_brakes("True", path=CLOSE, with_token=False),
            Step("DELETE", "/admin/api/control-token/fci", *WITH_TOKEN),
            RELEASE,
            Step("DELETE", "/admin/api/control-token", *WITH_TOKEN, status=404, text="ControlTokenUnknown"),
        ],
        closed=True,
    ),
]
