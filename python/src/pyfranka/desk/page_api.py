# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The web page, and the small interface that it uses: /page/..."""

from __future__ import annotations

import base64
import functools
import hashlib
import json
import os
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

from aiohttp import web

from pyfranka.desk import access
from pyfranka.desk.addresses import address_of
from pyfranka.desk.desk import Desk
from pyfranka.desk.errors import DeskError, Refused, bad_request, unavailable
from pyfranka.desk.page_lines import line_of
from pyfranka.desk.page_live import Live, Page, control_of
from pyfranka.desk.request_body import read_body
from pyfranka.desk.sessions import User

FOLDER = Path(__file__).resolve().parent / "page"
TYPES = {
    ".html": "text/html",
    ".js": "text/javascript",
    ".css": "text/css",
    ".svg": "image/svg+xml",
    ".dae": "model/vnd.collada+xml",
}
# Folders of the robots' meshes below franka_description/meshes.
MESH_FOLDERS = {"panda": "visual", "fr3": "visual/fr3"}
MESH_PARTS = [*(f"link{i}" for i in range(8)), "hand", "finger"]
IMPORT_MAP = re.compile(r'<script type="importmap">(.*?)</script>', re.DOTALL)
MAX_NAME_LENGTH = 200


def add_page(app: web.Application, desk: Desk) -> None:
    """Adds the page to the application of a robot."""
    api = PageApi(desk)
    app.on_shutdown.append(api.close)
    add = app.router
    for path in ("/", "/desk", "/desk/", "/page", "/page/"):
        add.add_get(path, api.index)
    add.add_get("/page/files/{name:.+}", api.file)
    add.add_post("/page/login", api.login)
    add.add_post("/page/logout", api.logout)
    add.add_get("/page/session", api.session)
    add.add_get("/page/robots", api.robots)
    add.add_get("/page/scene", api.scene)
    add.add_get("/page/mesh", api.mesh)
    add.add_get("/page/robot-mesh/{type}/{part}", api.robot_mesh)
    add.add_get("/page/live", api.live)
    add.add_post("/page/command", api.command)
    add.add_post("/page/control", api.control)


class PageApi:
    """The handlers of one application. desk: of its robot."""

    def __init__(self, desk: Desk):
        self.desk = desk
        self.stream = Live(desk.all)
        self.files = files_of(FOLDER)
        self.meshes = robot_meshes(mesh_folder())

    async def close(self, app: web.Application) -> None:
        """Ends the stream."""
        await self.stream.close()

    # ---- files -------------------------------------------------------------------------------------------

    async def index(self, request: web.Request) -> web.Response:
        """The page. Its sources are all in this folder, and its policy allows no others."""
        text = (FOLDER / "index.html").read_text(encoding="utf-8")
        headers = {"Content-Security-Policy": policy_of(text), "Referrer-Policy": "no-referrer"}
        headers["Cross-Origin-Opener-Policy"] = "same-origin"
        return web.Response(text=text, content_type="text/html", headers=headers)

    async def file(self, request: web.Request) -> web.StreamResponse:
        """A file of the page."""
        path = self.files.get(request.match_info["name"])
        if path is None:
            raise DeskError(404, "NotFound", "The page has no such file.")
        return file_answer(request, path)

    async def robot_mesh(self, request: web.Request) -> web.StreamResponse:
        """A mesh of the robots, as ./franka install or pyfranka-meshes has installed it."""
        await self._user(request)
        path = self.meshes.get((request.match_info["type"], request.match_info["part"]))
        if path is None:
            raise DeskError(404, "NotFound", "This mesh is not installed.")
        return file_answer(request, path)

    # ---- logins ------------------------------------------------------------------------------------------

    async def login(self, request: web.Request) -> web.Response:
        """Opens a session and sets its cookie, which scripts cannot read and other sites cannot send."""
        access.check_origin(request, True)
        body = await self._body(request)
        name, password = body.get("user"), body.get("password")
        if not isinstance(name, str) or not isinstance(password, str):
            raise bad_request("The login needs the texts 'user' and 'password'.")
        desk = self.desk
        user = await access.check_password(
            request, desk, name, lambda: desk.users.by_password(name, password)
        )
        answer = web.json_response({"user": user.name})
        token = desk.open_session(user)
        answer.set_cookie(access.COOKIE, token, httponly=True, secure=True, samesite="Strict", path="/")
        return answer

    async def logout(self, request: web.Request) -> web.Response:
        """Ends the session."""
        access.check_origin(request, True)
        for token in access.cookies_of(request):
            for desk in self.desk.all:
                desk.sessions.close(token)
        answer = web.json_response({})
        answer.del_cookie(access.COOKIE, path="/")
        return answer

    async def session(self, request: web.Request) -> web.Response:
        """The user that is logged in; null without a login."""
        user = await access.user_of(request, self.desk)
        return web.json_response({"user": user.name if user else None})

    # ---- data for the page -------------------------------------------------------------------------------

    async def robots(self, request: web.Request) -> web.Response:
        """The user, the robots, and the meshes that are installed for them."""
        user = await self._user(request)
        robots = [self._listed(number, desk) for number, desk in enumerate(self.desk.all)]
        return web.json_response({"user": user.name, "robots": robots, "meshes": self._mesh_names()})

    def _listed(self, number: int, desk: Desk) -> dict[str, Any]:
        report = desk.robot.report
        name = report.arm_id if report else f"robot {number + 1}"
        return {
            "index": number,
            "name": name,
            "type": report.type if report else "",
            "address": desk.robot.address,
            "profile": desk.profile.name if report else "",
        }

    def _mesh_names(self) -> dict[str, list[str]]:
        return {kind: [part for each, part in self.meshes if each == kind] for kind in MESH_FOLDERS}

    async def scene(self, request: web.Request) -> web.Response:
        """The world of a robot, in the words of the control interface."""
        await self._user(request)
        world = await self.stream.world_of(self._number(request.query.get("robot", "0")))
        text = f'{{"robots":{json.dumps(world.robots)},"version":{world.version},"scene":{world.text}}}'
        return web.Response(text=text, content_type="application/json")

    async def mesh(self, request: web.Request) -> web.Response:
        """A mesh of the world, in binary."""
        await self._user(request)
        number, name = self._number(request.query.get("robot", "0")), request.query.get("name", "")
        content = await self.stream.mesh(number, name[:MAX_NAME_LENGTH])
        if content is None:
            raise DeskError(404, "NotFound", "The world has no such mesh.")
        return web.Response(body=content, content_type="application/octet-stream")

    async def live(self, request: web.Request) -> web.StreamResponse:
        """The stream of states."""
        access.check_origin(request, True)
        access.check_handshake(request)
        token = access.session_of(request, self.desk)
        if token is None:
            raise DeskError(401, "Unauthorized", "Log in first.")
        with self.desk.gate.sockets.one(address_of(request)):
            socket = web.WebSocketResponse(heartbeat=20.0, max_msg_size=1024, compress=False)
            await socket.prepare(request)
            with self.desk.open_socket(socket):
                await self.stream.serve(Page(socket, self.desk, token))
        return socket

    # ---- commands of the page ----------------------------------------------------------------------------

    async def command(self, request: web.Request) -> web.Response:
        """Sends a line to a robot, if its table permits that; or `reboot`, which is not a line."""
        body, desk = await self._checked(request)
        if body.get("action") == "reboot":
            _check_control(request, desk)
            desk.power.reboot()
            return web.json_response({"value": ""})
        desk.robot.current_report()  # or: it is lost
        line, text = line_of(desk.robot.commands, body.get("action"), body.get("words", []))
        if line.control:
            _check_control(request, desk)
        try:
            value = await desk.robot.send(text, urgent=line.urgent)
        except Refused as refused:
            # Not an HTTP error, which browsers would write to their console.
            return web.json_response({"refused": {"code": refused.code, "message": refused.sentence}})
        return web.json_response({"value": value})

    async def control(self, request: web.Request) -> web.Response:
        """Requests, releases, grants or denies control of a robot."""
        body, desk = await self._checked(request)
        user, token = await self._user(request), token_of(request)
        what = body.get("what")
        answer: dict[str, Any] = {}
        if what in ("take", "force"):
            access.check_connection(request)
            granted = desk.tokens.request(user.name, what == "force", self._is_waiting(request))
            answer = {"id": granted.id, "token": granted.token}
        elif what in ("release", "withdraw"):
            desk.tokens.release(token)  # an unknown one has nothing to release
        elif what in ("accept", "deny"):
            if not desk.tokens.is_active(token):
                raise access.not_in_control()
            (desk.tokens.accept if what == "accept" else desk.tokens.deny)()
        else:
            raise bad_request("'what' must be take, force, release, withdraw, accept or deny.")
        return web.json_response({**answer, "control": control_of(desk)})

    # A page that has been closed does not get control; other clients of this interface have no stream.
    def _is_waiting(self, request: web.Request) -> Callable[[], bool]:
        token = access.session_of(request, self.desk)
        if token is None or not self.stream.has_page(token):
            return lambda: True
        return lambda: self.stream.has_page(token)

    # ---- checks ------------------------------------------------------------------------------------------

    async def _user(self, request: web.Request) -> User:
        user = await access.user_of(request, self.desk)
        if user is None:
            raise DeskError(401, "Unauthorized", "Log in first.")
        return user

    async def _checked(self, request: web.Request) -> tuple[dict[str, Any], Desk]:
        access.check_origin(request, True)
        await self._user(request)
        body = await self._body(request)
        return body, self.desk.all[self._number(body.get("robot", 0))]

    async def _body(self, request: web.Request) -> dict[str, Any]:
        """A JSON object; other types are refused, because forms of other sites could send them."""
        kind, charset = _content_type(request)
        if kind != "application/json":
            raise DeskError(415, "UnsupportedMediaType", "The body must be of the type application/json.")
        if charset not in ("", "utf-8"):
            raise DeskError(415, "UnsupportedMediaType", "The body must be in UTF-8.")
        content = await read_body(request, self.desk.gate.limits)
        try:
            body = json.loads(content)
        except (ValueError, RecursionError):
            raise bad_request("The body is not valid JSON.") from None
        if not isinstance(body, dict):
            raise bad_request("The body is not a JSON object, such as {}.")
        return body

    def _number(self, word: object) -> int:
        names = [str(number) for number in range(len(self.desk.all))]
        if isinstance(word, bool) or str(word) not in names:
            raise DeskError(404, "NotFound", f"There is no such robot; there are {len(names)}, from 0.")
        return names.index(str(word))


def _check_control(request: web.Request, desk: Desk) -> None:
    if desk.profile.tokens and not desk.tokens.is_active(token_of(request)):
        raise access.not_in_control()


def token_of(request: web.Request) -> str:
    """The control token of a request."""
    return request.headers.get("X-Control-Token", "")


def _content_type(request: web.Request) -> tuple[str, str]:
    """The type of the body and its charset, in lower case; aiohttp raises errors for some values."""
    kind, *parameters = request.headers.get("Content-Type", "").lower().split(";")
    named = dict(parameter.strip().partition("=")[::2] for parameter in parameters)
    return kind.strip(), named.get("charset", "").strip('"')


def file_answer(request: web.Request, path: Path) -> web.FileResponse:
    """A file, which browsers cache and revalidate. Raises DeskError (400) for headers that are not valid."""
    try:
        for name in ("if_modified_since", "if_unmodified_since", "if_range", "http_range"):
            getattr(request, name)
    except (ValueError, OverflowError):
        raise bad_request("A date or a range in the headers of the request is not valid.") from None
    if not path.is_file():
        raise unavailable(f"The file {path.name} is no longer there.")
    headers = {"Content-Type": TYPES[path.suffix], "Cache-Control": "no-cache"}
    return web.FileResponse(path, headers=headers)


def files_of(folder: Path) -> dict[str, Path]:
    """The files that the page may load, by their names below the folder."""
    paths = (path for path in sorted(folder.rglob("*")) if path.suffix in TYPES and path.is_file())
    return {path.relative_to(folder).as_posix(): path for path in paths}


def policy_of(page: str) -> str:
    """The Content-Security-Policy: nothing but this host's files, and the page's own import map."""
    match = IMPORT_MAP.search(page)
    digest = hashlib.sha256((match[1] if match else "").encode()).digest()
    return "; ".join(
        [
            "default-src 'none'",
            f"script-src 'self' 'sha256-{base64.b64encode(digest).decode()}'",
            "style-src 'self'",
            "img-src 'self' data:",
            "connect-src 'self'",
            "base-uri 'none'",
            "form-action 'none'",
            "frame-ancestors 'none'",
        ]
    )


@functools.cache
def mesh_folder() -> Path | None:
    """meshes/ of franka_description: of the wheel, of the workspace that this file belongs to, or of a
    sourced one."""
    here = Path(__file__).resolve()
    folders = [
        here.parents[1] / "share" / "franka_description" / "meshes",
        here.parents[4] / "catkin_ws" / "src" / "franka_description" / "meshes",
    ]
    for prefix in os.environ.get("CMAKE_PREFIX_PATH", "").split(":"):
        if prefix:
            folders.append(Path(prefix) / "share" / "franka_description" / "meshes")
    return next((folder for folder in folders if (folder / "visual").is_dir()), None)


def robot_meshes(folder: Path | None) -> dict[tuple[str, str], Path]:
    """Files of the robots' meshes by type and part."""
    if folder is None:
        return {}
    paths = {
        (kind, part): folder / below / f"{part}.dae"
        for kind, below in MESH_FOLDERS.items()
        for part in MESH_PARTS
    }
    return {key: path for key, path in paths.items() if path.is_file()}
