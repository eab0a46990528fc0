# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Desk in a thread of this process, and a plain client of it."""

from __future__ import annotations

import asyncio
import base64
import concurrent.futures
import contextlib
import http.client
import json
import ssl
import threading
import typing
from dataclasses import dataclass, field

import aiohttp
from pyfranka.desk import DeskRobot, Limits, Options, Settings
from pyfranka.desk.certificate import tls_context
from pyfranka.desk.server import Site, app_of, make_desks
from pyfranka.desk.sessions import digest_of

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
    """A running Desk of one robot. profile: empty: by the robot."""

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
        settings = Settings(PASSWORD, USER, self.profile, self.options, self.limits)
        desks = make_desks([robot], settings)
        self.desk = desks[0]
        context = tls_context(self.address, self.folder)
        self.site = Site(app_of(desks, 0), self.address, self.port, context)
        self.desk.power.site = self.site
        await self.site.open()
        self.port = self.site.port

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

    def listens(self) -> bool:
        self.close_connection()
        try:
            return self.send("GET", "/admin/api/startup-phase").status == 200
        except OSError:
            return False
        finally:
            self.close_connection()

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
        rest = asyncio.all_tasks() - {asyncio.current_task()}
        for task in rest:  # as asyncio.run, with which the program ends
            task.cancel()
        await asyncio.gather(*rest, return_exceptions=True)

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

    def begin(
        self, method: str, path: str, body: typing.Any = None, **headers: str
    ) -> concurrent.futures.Future[Answer]:
        """A request on a connection of its own, whose answer may take its time. Canceling it closes the
        connection, as a client does that goes away."""

        async def answer() -> Answer:
            async with self._session(headers) as session:
                async with session.request(method, self._url + path, json=body) as response:
                    return Answer(response.status, dict(response.headers), await response.read())

        return asyncio.run_coroutine_threadsafe(answer(), self.loop)

    @contextlib.contextmanager
    def socket(self, path: str, headers: dict[str, str] | None = None, **options: typing.Any):
        """An open WebSocket, by default with a login. Raises aiohttp.WSServerHandshakeError if Desk refuses
        it. options: of aiohttp."""
        login = {"Authorization": basic()["Authorization"]}

        async def connect() -> tuple[aiohttp.ClientSession, aiohttp.ClientWebSocketResponse]:
            session = self._session(login if headers is None else headers)
            try:
                return session, await session.ws_connect(self._url + path, **options)
            except aiohttp.WSServerHandshakeError:
                await session.close()
                raise

        session, opened = self.call(connect())
        try:
            yield Socket(self, opened)
        finally:
            self.call(session.close())

    @property
    def _url(self) -> str:
        return f"https://{self.address}:{self.port}"

    def _session(self, headers: dict[str, str]) -> aiohttp.ClientSession:
        named = {name.replace("_", "-"): value for name, value in headers.items()}
        return aiohttp.ClientSession(headers=named, connector=aiohttp.TCPConnector(ssl=unverified()))

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


@dataclass
class Socket:
    """A WebSocket of a DeskServer; its work runs in the server's thread."""

    desk: DeskServer
    opened: aiohttp.ClientWebSocketResponse

    def receive(self) -> aiohttp.WSMessage:
        return self.desk.call(self.opened.receive())

    def next(self) -> typing.Any:
        """The value of the next message."""
        return json.loads(self.desk.call(self.opened.receive_str()))

    def send(self, message: str | bytes) -> None:
        send = self.opened.send_str if isinstance(message, str) else self.opened.send_bytes
        self.desk.call(send(message))
