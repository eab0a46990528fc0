# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Desk answers the requests of clients that no registry has, with the headers and bodies that they write.

In headers and bodies, {token}, {id}, {login} and {digest} stand for what earlier answers gave.
"""

import base64
import hashlib
import re
from dataclasses import dataclass

import pytest
from desk_server import PASSWORD, USER
from scripted_desk import desk_with_robot
from waiting import wait_for

JSON, FORM = "application/json", "application/x-www-form-urlencoded"
BOUNDARY = "6a3e0f1c5d2b48979b1f00c2d4e6a8b0"
TOKEN = "/admin/api/control-token"
# What each library writes: Python's requests, http.client and aiohttp, and one in C++.
REQUESTS = {
    "User_Agent": "python-requests/2.31.0",
    "Accept_Encoding": "gzip, deflate",
    "Accept": "*/*",
    "Connection": "keep-alive",
    "Cookie": "authorization={login}",
}
HTTP_CLIENT = {"Accept_Encoding": "identity", "Cookie": "authorization={login}"}
AIOHTTP = {"Accept": "*/*", "User_Agent": "Python/3.10 aiohttp/3.9.1", "Cookie": 'authorization="{login}"'}
CPP = {"Connection": "Keep-Alive", "Cookie": "authorization={login}"}


@dataclass(frozen=True)
class Step:
    """A request. token: whether its header is sent. has: what the answer contains."""

    request: str  # method and path
    body: str | None = None
    kind: str = ""
    token: bool = False
    has: str = ""
    status: int = 200


def multipart(request, value, token=True):
    """The field `force` as a file, which several clients make of it."""
    head = f'--{BOUNDARY}\r\nContent-Disposition: form-data; name="force"; filename="force"\r\n\r\n'
    kind = f"multipart/form-data; boundary={BOUNDARY}"
    return Step(request, f"{head}{value}\r\n--{BOUNDARY}--\r\n", kind, token)


def request_control(query=""):
    return Step(f"POST {TOKEN}/request{query}", f'{{"requestedBy": "{USER}"}}', JSON)


LOGIN = Step("POST /admin/api/login", f'{{"login": "{USER}", "password": "{{digest}}"}}', JSON)
LOGOUT = Step("POST /admin/api/logout")
STATE, SAFETY = Step(f"GET {TOKEN}"), Step("GET /admin/api/safety", has="tokenForceTimeout")
ACTIVATE = Step(f"POST {TOKEN}/fci", '{"token": "{token}"}', JSON)
RELEASE = Step(f"DELETE {TOKEN}", '{"token": "{token}"}', JSON)
RELEASED = Step(f"DELETE {TOKEN}", '{"token": "{token}"}', JSON, has="ControlTokenUnknown", status=404)
OPEN, CLOSE = "POST /desk/api/robot/open-brakes", "POST /desk/api/robot/close-brakes"
UNLOCK, LOCK = "POST /desk/api/joints/unlock", "POST /desk/api/joints/lock"
CIRCLE = "the operator presses the circle button, which grants control that another user has"
READY = "the FCI is active and the brakes are open"

# By client and profile: headers, options of Desk, and the way to a robot that is ready and back.
SEQUENCES = {
    "frankx, fer-old": (
        HTTP_CLIENT,
        [],
        [LOGIN, Step(OPEN, None, FORM), Step("POST /desk/api/execution", "id=pick", FORM), READY]
        + [Step("DELETE /desk/api/execution", None, FORM), Step(CLOSE, None, FORM)],
    ),
    "DVK, fer-old": (REQUESTS, [], [LOGIN, Step(OPEN), READY, Step(CLOSE), LOGOUT]),
    "franka_lock_unlock with a physical request, fer-spoc": (
        REQUESTS,
        [],
        [LOGIN, request_control("?force"), CIRCLE, multipart(OPEN, "false"), ACTIVATE, READY]
        + [multipart(CLOSE, "false"), RELEASE, LOGOUT],
    ),
    "franka_lock_unlock, fr3-early": (
        REQUESTS,
        [],
        [LOGIN, STATE, request_control(), multipart(UNLOCK, "true")]
        + [Step(f"POST {TOKEN}/fci", '{"token": "{token}"}', JSON, token=True), READY]
        + [multipart(LOCK, "true"), RELEASE, LOGOUT],
    ),
    "PandaConnector, fer-spoc": (
        CPP,
        [],
        [LOGIN, Step("GET /admin/api/system-version", has="4.2"), SAFETY, request_control("?force="), CIRCLE]
        + [Step(OPEN, '{"force":"true"}', JSON, token=True)] * 2
        + [Step("POST /desk/api/gripper/homing", token=True), ACTIVATE, READY, RELEASE],
    ),
    "PandaConnector without control, fer-old": (
        CPP,
        [],
        [LOGIN, Step("GET /admin/api/system-version", has="4.0"), Step(OPEN, "force=false", FORM), READY],
    ),
    "panda_desk, fr3-v1": (
        AIOHTTP,
        ["fci_before_unlock"],
        [LOGIN, STATE, request_control("?force"), SAFETY, CIRCLE]
        + [Step("GET //desk/api/robot/configuration", has="jointAngles"), ACTIVATE]
        + [Step("POST /desk/api/operating-mode/execution", token=True), multipart(UNLOCK, "True"), READY]
        + [multipart(LOCK, "True", token=False), RELEASE, LOGOUT],
    ),
    "panda-py 0.8, fer-spoc": (
        REQUESTS,
        [],
        [LOGIN, STATE, request_control(), multipart(OPEN, "True"), ACTIVATE, READY]
        + [multipart(CLOSE, "True", token=False), Step(f"DELETE {TOKEN}/fci", '{"token": "{token}"}', JSON)]
        + [RELEASE, RELEASED],
    ),
}


class Player:
    """Sends the requests of one client, and keeps what the answers give."""

    def __init__(self, robot, desk, headers, unbroken):
        self._robot, self._desk, self._headers = robot, desk, headers
        encode = base64.b64encode if unbroken else base64.encodebytes  # MIME's line breaks are part of it
        digest = hashlib.sha256(f"{PASSWORD}#{USER}@franka".encode()).digest()
        text = encode(",".join(map(str, digest)).encode()).decode()
        self._given = {"digest": text.replace("\n", "\\n"), "login": "None"}

    def play(self, step):
        if step is CIRCLE:
            self._robot.report["buttons"]["circle"] = True
            wait_for(self._has_control, "Control")
            self._robot.report["buttons"]["circle"] = False
        elif step is READY:
            report = self._robot.report
            wait_for(lambda: report["fci"] and not any(report["brakes"]), "The active FCI")
        else:
            self._send(step)

    def _has_control(self):
        active = self._desk.send("GET", TOKEN).json()["activeToken"]
        return active and active["id"] == self._given["id"]

    def _send(self, step):
        headers = {name: self._filled(value) for name, value in self._headers.items()}
        if step is LOGIN and self._headers is not HTTP_CLIENT:  # which sends it from the first request on
            del headers["Cookie"]
        if step.kind:
            headers["Content_Type"] = step.kind
        if step.token:
            headers["X_Control_Token"] = self._given["token"]
        method, path = step.request.split()
        body = None if step.body is None else self._filled(step.body).encode()
        answer = self._desk.send(method, path, body, **headers)
        assert answer.status == step.status and step.has in answer.text, (step, answer)
        if step is LOGIN:
            assert re.fullmatch(r"[\w.-]+", answer.text) and "Set-Cookie" not in answer.headers
            self._given["login"] = answer.text
        elif "/request" in path:
            self._given.update(answer.json())

    def _filled(self, text):
        for name, value in self._given.items():
            text = text.replace("{" + name + "}", str(value))
        return text


@pytest.mark.parametrize("name", SEQUENCES)
def test_client_starts_the_robot_and_ends(name, tmp_path):
    headers, options, steps = SEQUENCES[name]
    client, _, profile = name.rpartition(", ")
    with desk_with_robot(tmp_path, profile, **dict.fromkeys(options, True)) as (robot, desk):
        if CIRCLE in steps:
            desk.take_control("another user")
        player = Player(robot, desk, headers, unbroken=headers is CPP or client == "DVK")
        for step in steps:
            player.play(step)
        closed = not client.startswith("PandaConnector")
        active = name == "PandaConnector without control, fer-old"
        assert robot.report["fci"] == active and all(robot.report["brakes"]) == closed
