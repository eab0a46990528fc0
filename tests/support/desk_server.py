# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Desk in a thread of this process, and a plain client of it."""

from __future__ import annotations

import asyncio
import base64
import contextlib
import http.client
import json
import ssl
import threading
import typing
from dataclasses import dataclass, field

from pyfranka.desk import DeskRobot, Limits, Options, Settings
from pyfranka.desk.certificate import tls_context
from pyfranka.desk.server import Site, app_of, make_desks
from pyfranka.desk.sessions import digest_of
from waiting import wait_for

USER, PASSWORD = "franka", "open-sesame"
# Tests send wrong passwords and many requests.
MANY = 100000
LIMITS = Limits(rate=20000.0, wrong_logins=MANY, wrong_logins_of_user=MANY, wrong_logins_of_all=MANY)
START_LIMIT = 60.0  # [s] for one call, on a busy machine
STEP = 1.0  # [s] by which the clock is put forward at once: less than a report of the robot may take


@dataclass
class Answer:
    status: int
    headers: dict[str, str]
    body: bytes

    @property
    def text(self) -> str:
        return self.body.decode()

    def json(self) -> typing.Any:
        return json.loads(self.body)


def unverified() -> ssl.SSLContext:
    """As clients of robots do it."""
    context = ssl.create_default_context()
    context.check_hostname = False
    context.verify_mode = ssl.CERT_NONE
    return context


def basic(user: str = USER, password: str = PASSWORD) -> dict[str, str]:
    """Header of the newer interface."""
    return {"Authorization": "Basic " + base64.b64encode(f"{user}:{password}".encode()).decode()}


class SteppedLoop(asyncio.SelectorEventLoop):
    """An event loop whose clock can be stopped and put forward; all time limits of Desk follow it."""

    ahead = 0.0  # [s]
    stopped_at: float | None = None

    def time(self) -> float:
        return self.ahead + (super().time() if self.stopped_at is None else self.stopped_at)

    def stop_clock(self) -> None:
        self.stopped_at = super().time()

    def start_clock(self) -> None:
        self.ahead -= super().time() - self.stopped_at
        self.stopped_at = None


@dataclass
class DeskServer:
    """A running Desk of one robot. profile: empty: by the robot. lines: those that it has sent."""

    robot_address: str
    robot_port: int
    folder: typing.Any  # of the certificate
    profile: str = ""
    options: Options = field(default_factory=Options)
    limits: Limits = LIMITS
    address: str = "127.0.0.1"  # where it listens
    port: int = 0

    def __enter__(self) -> DeskServer:
        self.loop = SteppedLoop()
        self._thread = threading.Thread(target=self.loop.run_forever, daemon=True)
        self._thread.start()
        self.call(self._start())
        self._connection: http.client.HTTPSConnection | None = None
        return self

    def __exit__(self, *error) -> None:
        self.close_connection()
        self.call(self._stop())
        self.loop.call_soon_threadsafe(self.loop.stop)
        self._thread.join(START_LIMIT)
        self.loop.close()

    def call(self, work: typing.Coroutine) -> typing.Any:
        """Runs it in Desk's thread."""
        return asyncio.run_coroutine_threadsafe(work, self.loop).result(START_LIMIT)

    async def _start(self) -> None:
        robot = DeskRobot(self.robot_address, self.robot_port)
        await robot.start(30.0)
        self.lines: list[str] = []
        self._record(robot)
        settings = Settings(PASSWORD, USER, self.profile, self.options, self.limits)
        desks = make_desks([robot], settings)
        self.desk = desks[0]
        context = tls_context(self.address, self.folder)
        self.site = Site(app_of(desks, 0), self.address, self.port, context)
        self.desk.power.site = self.site
        await self.site.open()
        self.port = self.site.port

    def _record(self, robot: DeskRobot) -> None:
        send = robot.send

        def recorded(line: str, urgent: bool = False):
            self.lines.append(line)
            return send(line, urgent)

        robot.send = recorded

    def prepare(self, lines: typing.Iterable[str]) -> None:
        """Sends lines to the robot when its self-test, if there is one, has ended."""
        wait_for(lambda: not self.call(self.desk.robot.refresh()).self_test.running, "The self-test's end")
        for line in lines:
            self.call(self.desk.robot.send(line))

    @contextlib.contextmanager
    def stopped_clock(self):
        """Within it, Desk's clock moves by advance() only, and reports come by it and by refresh() only."""

        async def call(change: typing.Callable[[], None]) -> None:
            change()

        self.call(call(self.loop.stop_clock))
        try:
            yield
        finally:
            self.call(call(self.loop.start_clock))

    def advance(self, seconds: float) -> None:
        """Puts Desk's clock forward. The robot answers after each step, so none of its reports is late."""

        async def step() -> None:
            end = self.loop.ahead + seconds
            while self.loop.ahead < end:
                self.loop.ahead = min(self.loop.ahead + STEP, end)
                await self.desk.robot.refresh()

        self.close_connection()  # which Desk ends after a while without requests
        self.call(step())

    async def _stop(self) -> None:
        await self.site.cleanup()
        await self.desk.close()
        await self.desk.robot.stop()

    # ---- requests ----------------------------------------------------------------------------------------

    def send(self, method: str, path: str, body: typing.Any = None, **headers: str) -> Answer:
        """One request on the connection that is kept. body: bytes, or a value for JSON; names of headers with
        underscores."""
        if body is not None and not isinstance(body, bytes):
            body = json.dumps(body).encode()
        named = {name.replace("_", "-"): value for name, value in headers.items()}
        if self._connection is None:
            self._connection = self.connection()
        self._connection.request(method, path, body, named)
        with self._connection.getresponse() as response:
            return Answer(response.status, dict(response.getheaders()), response.read())

    def connection(self) -> http.client.HTTPSConnection:
        """A new one."""
        options = {"timeout": START_LIMIT, "context": unverified()}
        return http.client.HTTPSConnection(self.address, self.port, **options)

    def close_connection(self) -> None:
        if self._connection is not None:
            self._connection.close()
            self._connection = None

    def log_in(self) -> dict[str, str]:
        """@returns the cookie."""
        answer = self.send("POST", "/admin/api/login", {"login": USER, "password": digest_of(USER, PASSWORD)})
        assert answer.status == 200, answer
        return {"Cookie": f"authorization={answer.text}"}

    def take_control(self, owner: str = USER, query: str = "", **headers: str) -> dict[str, typing.Any]:
        """@returns id and token."""
        answer = self.send(
            "POST",
            f"/admin/api/control-token/request{query}",
            {"requestedBy": owner},
            **(headers or self.log_in()),
        )
        assert answer.status == 200, answer
        return answer.json()

    def clear(self) -> None:
        """No user has control, no user is logged in."""

        async def forget() -> None:
            self.desk.tokens.clear()
            self.desk.sessions.clear()

        self.call(forget())

    def refresh(self) -> None:
        """What follows shows what the robot is now."""
        self.call(self.desk.robot.refresh())
