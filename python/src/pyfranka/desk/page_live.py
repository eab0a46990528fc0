# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The stream of the page: reports and poses of all robots, made once and sent to all pages."""

from __future__ import annotations

import asyncio
import base64
import contextlib
import json
import struct
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from aiohttp import web

from pyfranka.desk.desk import Desk
from pyfranka.desk.errors import Refused, RobotGone
from pyfranka.desk.robot import Connection

PERIOD = 0.05  # [s] between two frames (chosen here: motions look smooth)
PAUSE = 1.0  # [s] before a scene that was refused is requested again (chosen here)
LINE_LIMIT = 10.0  # [s] for an answer (chosen here: a busy machine)
CHECK_PERIOD = 1.0  # [s] between two checks of the logins (chosen here)
LOGIN_ENDED = 4401  # close code: this login is no longer valid
GOING_AWAY = 1001
MAX_MESH_SIZE = 64 << 20  # [bytes] (chosen here)


@dataclass
class World:
    """One simulated world. robots: numbers of the robots in it. text: the value of `scene`. version: counts
    its changes, so that pages know when to load it again."""

    robots: list[int]
    text: str
    version: int
    bodies: int
    meshes: dict[str, bytes] = field(default_factory=dict)
    connection: Connection | None = None

    def mesh_names(self) -> set[str]:
        """Meshes that the scene names."""
        return {shape["mesh"] for shape in json.loads(self.text).get("shapes", []) if shape.get("mesh")}


@dataclass(eq=False)
class Page:
    """One page's WebSocket. token: of its login."""

    socket: web.WebSocketResponse
    desk: Desk
    token: str
    sending: asyncio.Task[None] | None = None


class Live:
    """Sends frames while pages are connected. Everything runs in one event loop."""

    def __init__(self, desks: Sequence[Desk]):
        self.desks = desks
        self.worlds: dict[int, World] = {}  # by the number of a robot
        self._pages: set[Page] = set()
        self._task: asyncio.Task[None] | None = None
        self._finding: asyncio.Task[None] | None = None
        self._version = 0
        self._checked = 0.0

    async def serve(self, page: Page) -> None:
        """Sends frames to a page until it closes."""
        self._pages.add(page)
        if self._task is None or self._task.done():
            self._task = asyncio.get_running_loop().create_task(self._run())
        try:
            async for _ in page.socket:  # pages send nothing
                pass
        finally:
            self._pages.discard(page)

    def has_page(self, token: str) -> bool:
        """Whether a page of this login is open."""
        return any(page.token == token for page in self._pages)

    async def close(self) -> None:
        """Ends the stream."""
        for page in list(self._pages):
            await page.socket.close(code=GOING_AWAY)
        tasks = [task for task in (self._task, self._finding) if task is not None]
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        self._drop_worlds(list(self.worlds.values()))

    async def world_of(self, number: int) -> World:
        """The world of a robot. Raises Refused or RobotGone."""
        if number not in self.worlds:
            robot = self.desks[number].robot
            async with Connection(robot.address, robot.port) as connection:
                text = await connection.exchange("scene", LINE_LIMIT)
            if number not in self.worlds:  # another request may have been faster
                self._add_to_world(number, text)
        return self.worlds[number]

    async def mesh(self, number: int, name: str) -> bytes | None:
        """A mesh of the scene: the numbers of vertices and faces as 32-bit integers, then the vertices as
        32-bit floats and the faces as 32-bit integers. None if the scene has no such mesh."""
        world = await self.world_of(number)
        if name not in world.meshes:
            if name not in world.mesh_names():
                return None
            robot = self.desks[number].robot
            async with Connection(robot.address, robot.port) as connection:
                world.meshes[name] = await _read_mesh(connection, name)
        return world.meshes[name]

    # ---- worlds ------------------------------------------------------------------------------------------

    # Robots of one franka_sim see the same scene and have different names in it.
    def _add_to_world(self, number: int, text: str) -> None:
        for world in self.worlds.values():
            if world.text == text and self._name(number) not in {self._name(each) for each in world.robots}:
                world.robots.append(number)
                world.robots.sort()
                self.worlds[number] = world
                return
        self._version += 1
        self.worlds[number] = World([number], text, self._version, len(json.loads(text)["bodies"]))

    def _name(self, number: int) -> str:
        report = self.desks[number].robot.report
        return report.arm_id if report else ""

    def _drop_worlds(self, worlds: list[World]) -> None:
        for world in worlds:
            for number in world.robots:
                self.worlds.pop(number, None)
            if world.connection is not None:
                world.connection.close()

    def _drop_lost_worlds(self) -> None:
        lost = [world for number, world in self.worlds.items() if self.desks[number].robot.report is None]
        self._drop_worlds(lost)

    # ---- frames ------------------------------------------------------------------------------------------

    async def _run(self) -> None:
        loop = asyncio.get_running_loop()
        due = loop.time()
        while self._pages:
            await self._check_logins()
            self._drop_lost_worlds()
            if self._finding is None or self._finding.done():
                self._finding = loop.create_task(self._find_worlds())
            self._send(await self._frame())
            due = max(due + PERIOD, loop.time())
            await asyncio.sleep(due - loop.time())
        self._drop_worlds(list(self.worlds.values()))

    # In parallel to the frames, because the robot may need seconds to describe its world.
    async def _find_worlds(self) -> None:
        for number, desk in enumerate(self.desks):
            if desk.robot.report is not None and number not in self.worlds:
                try:
                    await self.world_of(number)
                except (Refused, RobotGone):
                    await asyncio.sleep(PAUSE)

    async def _frame(self) -> str:
        worlds = list({id(world): world for world in self.worlds.values()}.values())
        poses = await asyncio.gather(*(self._poses(world) for world in worlds))
        parts = ",".join(
            f'{{"robots":{json.dumps(world.robots)},"version":{world.version},"poses":{text}}}'
            for world, text in zip(worlds, poses)
        )
        robots = ",".join(_robot_text(desk) for desk in self.desks)
        return f'{{"robots":[{robots}],"worlds":[{parts}]}}'

    async def _poses(self, world: World) -> str:
        try:
            if world.connection is None:
                robot = self.desks[world.robots[0]].robot
                connection = Connection(robot.address, robot.port)
                await connection.open()
                world.connection = connection
            text = await world.connection.exchange("poses", LINE_LIMIT)
        except (Refused, RobotGone):
            if world.connection is not None:
                world.connection.close()
            world.connection = None
            return "null"
        if text.count("[") - 1 != world.bodies:  # objects were added or removed
            self._drop_worlds([world])
        return text

    # A page that reads too slowly misses frames.
    def _send(self, frame: str) -> None:
        for page in self._pages:
            if page.sending is None or page.sending.done():
                page.sending = asyncio.get_running_loop().create_task(_send_to(page, frame))

    async def _check_logins(self) -> None:
        time = asyncio.get_running_loop().time()
        if time < self._checked + CHECK_PERIOD:
            return
        self._checked = time
        for page in list(self._pages):
            if page.desk.sessions.name(page.token) is None:
                await page.socket.close(code=LOGIN_ENDED)


async def _send_to(page: Page, frame: str) -> None:
    with contextlib.suppress(ConnectionError, RuntimeError):
        await page.socket.send_str(frame)


def _robot_text(desk: Desk) -> str:
    robot = desk.robot
    control = json.dumps(control_of(desk))
    if robot.report is None:
        return f'{{"report":null,"problem":{json.dumps(robot.problem)},"control":{control}}}'
    return f'{{"report":{robot.text},"control":{control}}}'


def control_of(desk: Desk) -> dict[str, Any]:
    """The user who controls a robot, for the page; without secrets."""
    if desk.robot.report is not None and not desk.profile.tokens:
        return {"tokens": False, "owner": None, "id": None, "request": None}
    active, pending = desk.tokens.active, desk.tokens.pending
    request = None
    if pending is not None:
        request = {"owner": pending.owner, "id": pending.id, "force": pending.force}
        if pending.force:
            request["left"] = round(desk.tokens.time_left(), 1)
    owner = (active.owner, active.id) if active else (None, None)
    return {"tokens": True, "owner": owner[0], "id": owner[1], "request": request}


async def _read_mesh(connection: Connection, name: str) -> bytes:
    parts: list[bytes] = []
    offset, size = 0, 0
    while offset is not None:
        chunk = json.loads(await connection.exchange(f"mesh {name} {offset}", LINE_LIMIT))
        if not parts:
            parts.append(struct.pack("<II", chunk["vertices"], chunk["faces"]))
        parts.append(base64.b64decode(chunk["data"]))
        size += len(parts[-1])
        if size > MAX_MESH_SIZE:
            raise RobotGone(f"The mesh '{name}' has more than {MAX_MESH_SIZE >> 20} MB.")
        offset = chunk["next"]
    return b"".join(parts)
