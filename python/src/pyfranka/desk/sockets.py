# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""WebSockets. The path of each also answers a plain GET, with the first message of the WebSocket."""

from __future__ import annotations

import asyncio
import contextlib
import json
import typing
from collections.abc import Callable
from dataclasses import dataclass

from aiohttp import WSMsgType, web

from pyfranka.desk import status
from pyfranka.desk.access import check_handshake
from pyfranka.desk.addresses import address_of
from pyfranka.desk.desk import Desk
from pyfranka.desk.routes import Call, Handler, Login, Route, Where, everywhere, on_fr3, with_tokens, with_v1
from pyfranka.robot_report import Report

PING = 30.0  # [s] between two pings, which detect lost clients (chosen here)
MAX_MESSAGE_LENGTH = 4096  # [bytes] from a client, which need not send anything (chosen here)
WRITE_LIMIT = 10.0  # [s] for a client to take a message (chosen here)
UNREAD_EVENTS = 1000  # of a client that does not read (chosen here)
VOLATILE = {"sequenceNumber", "timeToTd2"}  # members that alone are not a change

Send = Callable[[typing.Any], typing.Awaitable[None]]


@dataclass(frozen=True)
class Topic:
    """The messages of a WebSocket: snapshots, with a period [s], or on changes and once a second."""

    path: str
    snapshot: Callable[[Desk], typing.Any]
    period: float = 1.0
    on_change: bool = True
    login: Login = Login.USER
    where: Where = everywhere


def _connected(desk: Desk) -> typing.Any:
    return {"connectionStatus": "connected"}


TOPICS = [
    Topic("/admin/api/control-token", status.control_token, login=Login.NONE, where=with_tokens),
    Topic("/admin/api/system-status", status.system_status, login=Login.NONE, where=on_fr3),
    Topic("/admin/api/safety/status", status.safety_status, login=Login.NONE, where=on_fr3),
    Topic("/admin/api/startup-phase", lambda desk: {"tag": desk.startup}, login=Login.NONE),
    Topic("/admin/api/processes", lambda desk: "Up", on_change=False),
    Topic("/admin/api/end-effector", lambda desk: desk.end_effectors.active()),
    Topic("/desk/api/robot/configuration", status.robot_configuration, 0.1, False),
    Topic("/desk/api/system/status", status.hardware_status, 0.5, False),
    Topic("/desk/api/robot/status", status.robot_status),
    Topic("/desk/api/robot/gripper_state", status.gripper_state, 1 / 15, False),
    Topic("/desk/api/events/gripper/hardware", status.gripper_hardware),
    Topic("/desk/api/pilot/hardware", _connected),
    Topic("/desk/api/base-leds/hardware", _connected),
    Topic("/desk/api/robot/guiding/mode", lambda desk: desk.report.guiding.mode),
    Topic("/desk/api/robot/guiding/configuration", status.guiding_configuration),
    Topic("/desk/api/navigation/mode", lambda desk: desk.report.navigation),
    Topic("/desk/api/notification", lambda desk: []),
    Topic("/desk/api/execution", status.execution),
    Topic("/desk/api/timelines", lambda desk: []),
    Topic("/desk/api/skills", lambda desk: []),
    Topic("/desk/api/groups", lambda desk: []),
]


def _handler(topic: Topic) -> Handler:
    async def handle(call: Call) -> typing.Any:
        if not _is_upgrade(call.request):
            return topic.snapshot(call.desk)
        topic.snapshot(call.desk)  # an error is an answer, not an end of the socket
        return await _serve(call, lambda send: send_snapshots(call.desk, topic, send))

    return handle


async def navigation_events(call: Call) -> dict[str, bool] | web.WebSocketResponse:
    """The Pilot's buttons: all of them first, then those that change."""
    if not _is_upgrade(call.request):
        return status.pressed_buttons(call.desk.report)
    queue: asyncio.Queue[dict[str, bool]] = asyncio.Queue(UNREAD_EVENTS)
    first = status.pressed_buttons(call.desk.report)

    def offer(before: Report | None, now: Report) -> None:
        changes = status.changed_buttons(before, now)
        if changes and not queue.full():  # otherwise sending takes too long, which ends the socket
            queue.put_nowait(changes)

    with call.desk.reports(offer):
        return await _serve(call, lambda send: _send_queue(first, queue, send))


async def server_sent_events(call: Call) -> web.StreamResponse:
    """The state of the newer interface as an event stream."""
    response = web.StreamResponse(headers={"Content-Type": "text/event-stream", "Cache-Control": "no-store"})
    topic = Topic(
        "", lambda desk: {"system": status.system(desk), "controlToken": status.control_token(desk)}
    )
    text = json.dumps(topic.snapshot(call.desk))
    with call.desk.gate.sockets_of(call.user).one(address_of(call.request)):
        await response.prepare(call.request)
        if call.request.method == "HEAD":
            return response
        await response.write(f"data: {text}\n\n".encode())

        async def send(value: typing.Any) -> None:
            data = f"data: {json.dumps(value)}\n\n".encode()
            async with asyncio.timeout(WRITE_LIMIT):
                await response.write(data)

        with contextlib.suppress(ConnectionError, asyncio.TimeoutError):
            await send_snapshots(call.desk, topic, send, lambda: call.request.transport is not None)
    return response


ROUTES = [
    *(
        Route("GET", topic.path, _handler(topic), login=topic.login, where=topic.where, socket=True)
        for topic in TOPICS
    ),
    Route("GET", "/desk/api/navigation/events", navigation_events, socket=True),
    Route("GET", "/api/system/sse", server_sent_events, login=Login.NONE, where=with_v1, socket=True),
]


def _is_upgrade(request: web.Request) -> bool:
    return request.headers.get("Upgrade", "").lower() == "websocket"


async def _serve(call: Call, work: Callable[[Send], typing.Awaitable[None]]) -> web.WebSocketResponse:
    """Runs the work, which sends, until the client closes."""
    check_handshake(call.request)
    socket = web.WebSocketResponse(heartbeat=PING, max_msg_size=MAX_MESSAGE_LENGTH, compress=False)
    with call.desk.gate.sockets_of(call.user).one(address_of(call.request)):
        await socket.prepare(call.request)

        async def send(value: typing.Any) -> None:
            async with asyncio.timeout(WRITE_LIMIT):
                await socket.send_str(json.dumps(value))

        sender = asyncio.get_running_loop().create_task(_until_disconnected(work(send)))
        with call.desk.open_socket(socket):
            try:
                await _read(socket, sender)
            finally:
                sender.cancel()
                await asyncio.gather(sender, return_exceptions=True)
    return socket


# Reading answers pings and detects the end.
async def _read(socket: web.WebSocketResponse, sender: asyncio.Task[None]) -> None:
    sender.add_done_callback(lambda _: asyncio.get_running_loop().create_task(socket.close()))
    async for message in socket:
        if message.type is WSMsgType.ERROR:
            return


async def _until_disconnected(work: typing.Awaitable[None]) -> None:
    with contextlib.suppress(ConnectionError, asyncio.TimeoutError, RuntimeError):
        await work


async def send_snapshots(
    desk: Desk, topic: Topic, send: Send, keep_sending: Callable[[], bool] = lambda: True
) -> None:
    """Sends snapshots of a topic: at once, at changes and after its period."""
    loop = asyncio.get_running_loop()
    last, due = None, loop.time()
    with desk.watch() as event:
        while keep_sending():
            event.clear()  # before the snapshot: a change while it is sent comes next
            if desk.robot.report is not None:
                value = topic.snapshot(desk)
                key = _without_volatile(value) if topic.on_change else None
                if loop.time() >= due or key != last:
                    await send(value)
                    last, due = key, max(due + topic.period, loop.time() + 0.5 * topic.period)
            with contextlib.suppress(asyncio.TimeoutError):
                async with asyncio.timeout(topic.period):
                    if topic.on_change:
                        await event.wait()
                    else:
                        await asyncio.sleep(max(0.0, due - loop.time()))


async def _send_queue(first: dict[str, bool], queue: asyncio.Queue[dict[str, bool]], send: Send) -> None:
    await send(first)
    while True:
        await send(await queue.get())


def _without_volatile(value: typing.Any) -> typing.Any:
    if not isinstance(value, dict):
        return value
    return {key: _without_volatile(each) for key, each in value.items() if key not in VOLATILE}
