# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A client of one robot's control interface for asyncio: fetches its report 20 times per second, and sends
lines."""

from __future__ import annotations

import asyncio
import contextlib
import logging
from collections.abc import Callable

from pyfranka.desk.errors import Refused, RobotGone
from pyfranka.refusals import split_refusal
from pyfranka.robot_report import Report, report_of

PORT = 1340
PERIOD = 0.05  # [s] between two reports (chosen here: a press of a button lasts longer)
PAUSE = 0.5  # [s] before the next attempt to reach a lost robot (chosen here)
REPORT_LIMIT = 5.0  # [s] for the answer to one report (chosen here: a busy machine)
LINE_LIMIT = 120.0  # [s] for any other line (chosen here: the longest motion)
CONNECT_LIMIT = 5.0  # [s] (chosen here)
MAX_ANSWER_LENGTH = 8 << 20  # [bytes] (chosen here: a world of many shapes)
# Lines at a time; the control interface accepts eight clients.
LINES, URGENT_LINES = 3, 2
log = logging.getLogger("franka_desk")


class DeskRobot:
    """One robot's control interface. Everything runs in one event loop.

    report: the newest report, or None before the first one and while the robot is lost; text: the same in
    JSON; problem: why there is none. number: of the newest report, counted from one. commands: the robot's
    table of commands in JSON (its line `help json`); empty before the first report. start() begins to fetch
    reports; requests of Desk's clients are answered from the newest one, so that they never reach the robot
    (decision 55).
    """

    def __init__(self, address: str, port: int = PORT, period: float = PERIOD):
        self.address, self.port, self.period = address, port, period
        self.report: Report | None = None
        self.text = self.commands = ""
        self.problem = f"The robot at {self.place} has not answered yet."
        self.number = 0
        self._requested = self._published = 0
        self._listeners: list[Callable[[], None]] = []
        self._lines, self._urgent = asyncio.Semaphore(LINES), asyncio.Semaphore(URGENT_LINES)
        self._running: set[asyncio.Task[str]] = set()
        self._last: tuple[str, bool, asyncio.Task[str]] | None = None  # line, urgent, and its answer
        self._poller: asyncio.Task[None] | None = None
        self._first = asyncio.Event()

    def __repr__(self) -> str:
        return f"DeskRobot({self.address!r}, {self.port})"

    @property
    def place(self) -> str:
        """Its address and port, for messages."""
        return f"{self.address}, port {self.port}"

    def current_report(self) -> Report:
        """The newest report. Raises RobotGone without one."""
        if self.report is None:
            raise RobotGone(self.problem)
        return self.report

    def listen(self, listener: Callable[[], None]) -> None:
        """Calls the listener after each report, and when the robot is lost, in the order of these calls."""
        self._listeners.append(listener)

    async def start(self, limit: float = 0.0) -> None:
        """Begins to fetch reports; waits up to that many seconds for the first one."""
        self._poller = asyncio.get_running_loop().create_task(self._poll())
        if limit:
            with contextlib.suppress(asyncio.TimeoutError):
                async with asyncio.timeout(limit):
                    await self._first.wait()

    async def stop(self) -> None:
        """Cancels all running tasks."""
        tasks = [*self._running, *([self._poller] if self._poller else [])]
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    async def send(self, line: str, urgent: bool = False) -> str:
        """Sends a line; returns the text after `ok`. The report is then newer than the effect of the line.

        A line that equals the last one, which is not answered yet, is not sent again, unless only the new one
        is urgent. urgent: does not wait for other lines. If the caller is canceled, the line still runs to
        its end. Raises Refused or RobotGone.
        """
        if "\n" in line or "\r" in line:
            raise ValueError("A line has no line break.")
        last = self._last
        if last is None or last[0] != line or last[2].done() or (urgent and not last[1]):
            task = asyncio.get_running_loop().create_task(self._send(line, urgent))
            self._running.add(task)
            task.add_done_callback(self._ended)
            self._last = last = line, urgent, task
        return await asyncio.shield(last[2])

    async def refresh(self) -> Report:
        """A report of the robot after this call. Raises RobotGone."""
        async with Connection(self.address, self.port) as connection:
            await self._request_report(connection)
        return self.current_report()

    # ---- lines -------------------------------------------------------------------------------------------

    def _ended(self, task: asyncio.Task[str]) -> None:
        self._running.discard(task)
        if not task.cancelled():
            task.exception()  # no caller may await it

    async def _send(self, line: str, urgent: bool) -> str:
        async with self._urgent if urgent else self._lines:
            async with Connection(self.address, self.port) as connection:
                try:
                    return await connection.exchange(line, LINE_LIMIT)
                finally:
                    with contextlib.suppress(RobotGone):
                        await self._request_report(connection)

    # ---- reports -----------------------------------------------------------------------------------------

    async def _poll(self) -> None:
        while True:
            try:
                async with Connection(self.address, self.port) as connection:
                    self.commands = await connection.exchange("help json", REPORT_LIMIT)
                    while True:
                        await self._request_report(connection)
                        await asyncio.sleep(self.period)
            except RobotGone as error:
                self._lose(str(error))
            except Refused as refused:
                self._lose(
                    f"The robot at {self.place} has no table of commands: {refused.sentence} Use franka_sim "
                    "and franka_desk of the same version."
                )
            await asyncio.sleep(PAUSE)

    # An answer may overtake an older one on another connection: the older one is dropped.
    async def _request_report(self, connection: Connection) -> None:
        self._requested += 1
        number = self._requested
        try:
            text = await connection.exchange("report", REPORT_LIMIT)
        except Refused as refused:
            raise RobotGone(
                f"The robot at {self.place} gives no reports: {refused.sentence} Use franka_sim and "
                "franka_desk of the same version."
            ) from None
        if number < self._published:
            return
        self._published = number
        try:
            self.report, self.text = report_of(text), text
        except ValueError as error:
            raise RobotGone(
                f"The report of the robot at {self.place} cannot be read: {error}. Use franka_sim and "
                "franka_desk of the same version."
            ) from None
        self.number += 1
        self.problem = ""
        self._first.set()
        self._notify()

    def _lose(self, problem: str) -> None:
        if self.report is not None or self.problem != problem:
            self.report, self.text, self.problem = None, "", problem
            self._notify()

    def _notify(self) -> None:
        for listener in self._listeners:
            try:
                listener()
            except Exception:  # of one listener; the others still get reports
                log.exception("A listener of the robot at %s has failed.", self.place)


class Connection:
    """One TCP connection, on which lines are answered one after the other."""

    def __init__(self, address: str, port: int):
        self._address, self._port = address, port
        self._place = f"{address}, port {port}"

    async def __aenter__(self) -> Connection:
        await self.open()
        return self

    async def __aexit__(self, *error: object) -> None:
        self.close()

    async def open(self) -> None:
        """Connects. Raises RobotGone."""
        place = self._address, self._port
        try:
            async with asyncio.timeout(CONNECT_LIMIT):
                self._reader, self._writer = await asyncio.open_connection(*place, limit=MAX_ANSWER_LENGTH)
        except TimeoutError:
            raise RobotGone(f"The robot at {self._place} does not answer.") from None
        except OSError as error:
            raise RobotGone(
                f"There is no control interface at {self._place} ({error.strerror or error}). Start "
                "franka_sim there, without --control-port 0."
            ) from None

    def close(self) -> None:
        """Ends the connection."""
        self._writer.close()

    async def exchange(self, line: str, limit: float) -> str:
        """Sends a line; returns the text after `ok` in its answer, which must arrive within that time [s].
        Raises Refused or RobotGone; after the latter the connection cannot be used."""
        try:
            self._writer.write(line.encode() + b"\n")
            await self._writer.drain()
            async with asyncio.timeout(limit):
                data = await self._reader.readuntil(b"\n")
        except TimeoutError:
            raise RobotGone(
                f"The robot at {self._place} has not answered '{line[:80]}' within {limit:g} s."
            ) from None
        except (OSError, asyncio.IncompleteReadError):
            raise RobotGone(
                f"The robot at {self._place} went away before it answered '{line[:80]}'."
            ) from None
        except asyncio.LimitOverrunError:
            raise RobotGone(
                f"The answer of the robot at {self._place} to '{line[:80]}' is too long."
            ) from None
        return _value(data.decode(errors="replace").rstrip("\r\n"), self._place)


def _value(answer: str, place: str) -> str:
    word, _, rest = answer.partition(" ")
    if word == "ok":
        return rest
    if word != "error:":
        raise RobotGone(f"What answers at {place} is not a control interface of franka_sim: '{answer[:80]}'.")
    raise Refused(*split_refusal(rest))
