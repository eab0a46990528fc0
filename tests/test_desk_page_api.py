# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The page's own interface, without a browser: who may do what, and what reaches the robot."""

import asyncio
import json
import struct
from base64 import b64encode

import aiohttp
import pytest
from desk_robot import ScriptedRobot
from desk_server import PASSWORD, USER, DeskServer, unverified
from waiting import wait_for

JSON = "application/json"
SCENE = {
    "bodies": [{"name": "world"}, {"name": "fr3_link1"}],
    "shapes": [
        {"body": 1, "kind": "mesh", "size": [0, 0, 0], "pose": [0] * 7, "color": [1] * 4, "mesh": "a mesh"},
    ],
    "robots": [{"arm_id": "fr3", "type": "fr3"}],
}
POSES = [[0, 0, 0, 1, 0, 0, 0], [0.1, 0, 0.3, 1, 0, 0, 0]]
VERTICES, FACES = struct.pack("<9f", *range(9)), struct.pack("<3I", 0, 1, 2)


def mesh(*words):
    """The answer to `mesh`, in two parts. The name has a blank."""
    if words[-1] == "0":
        part = {"vertices": 3, "faces": 1, "next": 36, "data": b64encode(VERTICES).decode()}
    else:
        part = {"vertices": 3, "faces": 1, "next": None, "data": b64encode(FACES).decode()}
    return "ok " + json.dumps(part)


@pytest.fixture(scope="module")
def robot():
    with ScriptedRobot() as robot:
        robot.answers |= {"scene": "ok " + json.dumps(SCENE), "poses": "ok " + json.dumps(POSES)}
        robot.answers |= {"mesh": mesh, "state": "ok secret"}
        robot.answers["hand"] = "error: NotHomed: The hand is not homed."
        yield robot


@pytest.fixture(scope="module")
def server(robot, tmp_path_factory):
    with DeskServer("127.0.0.1", robot.port, tmp_path_factory.mktemp("certificate")) as server:
        yield server


@pytest.fixture
def desk(server):
    server.clear()
    return server


@pytest.fixture
def cookie(desk):
    """Of a login through the page."""
    answer = desk.send("POST", "/page/login", {"user": USER, "password": PASSWORD}, Content_Type=JSON)
    assert answer.status == 200 and answer.json() == {"user": USER}
    return {"Cookie": answer.headers["Set-Cookie"].partition(";")[0]}


def post(desk, path, body, **headers):
    return desk.send("POST", path, body, **{"Content_Type": JSON, **headers})


def control(desk, cookie, what="take", token=""):
    """@returns what the page gets: id, token and the state of control."""
    answer = post(desk, "/page/control", {"what": what}, X_Control_Token=token, **cookie)
    assert answer.status == 200, answer
    return answer.json()


def command(desk, cookie, action, *words, token="", **headers):
    body = {"robot": 0, "action": action, "words": list(words)}
    return post(desk, "/page/command", body, X_Control_Token=token, **cookie, **headers)


# ---- files -----------------------------------------------------------------------------------------------


def test_the_page_allows_no_other_hosts_and_no_inline_scripts(desk):
    answer = desk.send("GET", "/")
    policy = answer.headers["Content-Security-Policy"]
    assert answer.status == 200 and "default-src 'none'" in policy and "frame-ancestors 'none'" in policy
    assert "unsafe" not in policy and "http:" not in policy and "https:" not in policy
    assert "https://" not in answer.text.replace("https://www.w3.org", "")


def test_its_files_are_served_with_types_that_browsers_accept(desk):
    for name, kind in (("js/main.js", "text/javascript"), ("css/theme.css", "text/css")):
        answer = desk.send("GET", f"/page/files/{name}")
        assert answer.status == 200 and answer.headers["Content-Type"].startswith(kind)
        assert answer.headers["X-Content-Type-Options"] == "nosniff"


@pytest.mark.parametrize(
    "name", ["../desk.py", "..%2fdesk.py", "js", "js/../../desk.py", "%2fetc%2fpasswd", ""]
)
def test_no_other_files_are_served(desk, name):
    assert desk.send("GET", f"/page/files/{name}").status == 404


# ---- logins ----------------------------------------------------------------------------------------------


def test_the_cookie_is_out_of_reach_of_scripts_and_other_sites(desk):
    answer = post(desk, "/page/login", {"user": USER, "password": PASSWORD})
    attributes = {part.strip().lower() for part in answer.headers["Set-Cookie"].split(";")[1:]}
    assert {"httponly", "secure", "samesite=strict", "path=/"} <= attributes


def test_a_wrong_password_opens_nothing(desk):
    answer = post(desk, "/page/login", {"user": USER, "password": "wrong"})
    assert answer.status == 401 and "Set-Cookie" not in answer.headers
    assert answer.json()["message"] == "User or password is wrong."


def test_logging_out_ends_the_session(desk, cookie):
    assert desk.send("GET", "/page/session", **cookie).json() == {"user": USER}
    assert post(desk, "/page/logout", {}, **cookie).status == 200
    assert desk.send("GET", "/page/session", **cookie).json() == {"user": None}


READS = ["/page/robots", "/page/scene", "/page/mesh?name=x", "/page/robot-mesh/fr3/link0"]


@pytest.mark.parametrize("path", READS)
def test_pages_require_a_login(desk, path):
    assert desk.send("GET", path).status == 401


@pytest.mark.parametrize("path", ["/page/command", "/page/control"])
def test_commands_require_a_login(desk, robot, path):
    robot.lines.clear()
    assert post(desk, path, {"action": "user_stop", "words": ["on"], "what": "take"}).status == 401
    assert robot.lines == [] and desk.desk.tokens.active is None


# ---- commands --------------------------------------------------------------------------------------------


def test_form_of_another_site_is_refused(desk, cookie):
    body = json.dumps({"action": "user_stop", "words": ["on"]}).encode()
    answer = desk.send("POST", "/page/command", body, Content_Type="text/plain", **cookie)
    assert answer.status == 415


NUMBERS = [str(number) for number in range(1, 30)]
# What the page sends for each of its controls; control: whether it must have control.
COMMANDS = [
    (("joints", "unlock"), True),
    (("joints", "lock"), False),
    (("fci", "on"), True),
    (("fci", "off"), True),
    (("operating_mode", "programming"), True),
    (("user_stop", "on"), False),
    (("input", "x31", "on"), False),
    (("button", "circle", "off"), False),
    (("guiding", "on"), True),
    (("guiding_mode", "free"), True),
    (("guiding_mode", "user", *["on", "off"] * 3, "on"), True),
    (("navigation", "robot"), True),
    (("self_test",), True),
    (("acknowledge", "td2Timeout"), True),
    (("recover",), True),
    (("end_effector", *NUMBERS), True),
    (("end_effector_power", "off"), True),
    (("move", "pack"), True),
    (("move", "stop"), False),
    (("move", *NUMBERS[:7]), True),
    (("move", *NUMBERS[:8]), True),
    (("inject", "td2Timeout", "on"), False),
    (("inject", "jointLimitViolation", "7", "on"), False),
    (("push", "fr3_hand", "10", "-5.5", "0", "50"), False),
]


@pytest.mark.parametrize("words, needs_control", COMMANDS, ids=lambda each: str(each)[:40])
def test_commands_reach_the_robot_as_lines(desk, robot, cookie, words, needs_control):
    robot.lines.clear()
    without = command(desk, cookie, *words)
    assert without.status == (423 if needs_control else 200), without
    token = control(desk, cookie)["token"]
    assert command(desk, cookie, *words, token="wrong").status == without.status
    robot.lines.clear()
    assert command(desk, cookie, *words, token=token).status == 200
    (line,) = [line for line in robot.lines if line.split()[0] == words[0]]
    assert [meaning(word) for word in line.split()] == [meaning(word) for word in words]


def meaning(word):
    """Numbers are formatted again."""
    try:
        return float(word)
    except ValueError:
        return word


REFUSED = [
    ("quit",),
    ("reset",),
    ("state",),
    ("place", "stone", "0", "0", "0"),
    ("joints", "unlock", "now"),
    ("joints unlock",),
    ("fci", "maybe"),
    ("user_stop", "on\nquit"),
    ("push", "fr3_hand\nquit", "1", "1", "1", "50"),
    ("push", "fr3 hand", "1", "1", "1", "50"),
    ("push", "fr3_hand", "1", "1", "1e9", "50"),
    ("push", "fr3_hand", "1", "1", "nan", "50"),
    ("push", "fr3_hand", "1", "1", "1", "100000"),
    ("end_effector", "1", "2"),
    ("move", *["inf"] * 7),
    ("inject", "jointLimitViolation", "8", "on"),
    ("acknowledge", "td2Timeout quit"),
    ("button", "circle"),
    ("",),
]


@pytest.mark.parametrize("words", REFUSED, ids=lambda words: repr(" ".join(words))[:40])
def test_other_lines_do_not_reach_the_robot(desk, robot, cookie, words):
    token = control(desk, cookie)["token"]
    robot.lines.clear()
    answer = command(desk, cookie, *words, token=token)
    assert answer.status == 400 and answer.json()["message"].endswith(".")
    assert robot.lines == []


@pytest.mark.parametrize(
    "body",
    [
        b"",
        b"{",
        b"[]",
        b'"text"',
        b'{"action": 1}',
        b'{"action":"fci","words":"on"}',
        b'{"action":"fci","words":[1]}',
    ],
)
def test_malformed_commands_are_answered_with_a_sentence(desk, cookie, body):
    answer = post(desk, "/page/command", body, **cookie)
    assert answer.status == 400 and answer.json()["message"].endswith(".")


@pytest.mark.parametrize("number", [1, -1, "x", None, 1.5, "99999999999999999999"])
def test_unknown_robots_are_refused(desk, cookie, number):
    body = {"robot": number, "action": "user_stop", "words": ["on"]}
    assert post(desk, "/page/command", body, **cookie).status == 404


def test_refusal_of_the_robot_is_shown_with_its_message(desk, cookie):
    token = control(desk, cookie)["token"]
    answer = command(desk, cookie, "hand", "move", "0.04", "0.1", token=token)
    assert answer.status == 200
    assert answer.json() == {"refused": {"code": "NotHomed", "message": "The hand is not homed."}}


# ---- control ---------------------------------------------------------------------------------------------


def test_only_the_holder_answers_a_request(desk, cookie):
    control(desk, cookie)
    desk.take_control("anna", **cookie)
    answer = post(desk, "/page/control", {"what": "accept"}, X_Control_Token="wrong", **cookie)
    assert answer.status == 423


def test_a_forced_request_shows_the_time_left(desk, cookie):
    desk.take_control("anna", **cookie)
    request = control(desk, cookie, "force")["control"]["request"]
    assert request["force"] and request["owner"] == USER and 0 < request["left"] <= 30


def test_control_is_taken_and_released(desk, cookie):
    mine = control(desk, cookie)
    assert mine["control"]["owner"] == USER and mine["control"]["id"] == mine["id"]
    assert control(desk, cookie, "release", mine["token"])["control"]["owner"] is None


def test_page_that_has_been_closed_does_not_get_control(desk, cookie):
    holder = desk.take_control("anna", **cookie)

    async def request_on_open_page():
        async with aiohttp.ClientSession() as session:
            url = f"https://127.0.0.1:{desk.port}"
            options = {"headers": cookie, "ssl": unverified()}
            async with session.ws_connect(f"{url}/page/live", **options) as stream:
                await stream.receive_str(timeout=60)
                async with session.post(f"{url}/page/control", json={"what": "take"}, **options) as answer:
                    assert (await answer.json())["control"]["request"]

    asyncio.run(request_on_open_page())
    wait_for(lambda: desk.desk.gate.sockets.total == 0, "The end of the stream")
    after = control(desk, cookie, "release", holder["token"])
    assert after["control"]["owner"] is None and after["control"]["request"] is None


# ---- the stream ------------------------------------------------------------------------------------------


def first_frame(desk, cookie, origin="", condition=bool):
    """The first frame of the stream that fulfils the condition; raises aiohttp.WSServerHandshakeError if the
    stream is refused."""

    async def read():
        headers = {**cookie, **({"Origin": origin} if origin else {})}
        async with aiohttp.ClientSession() as session:
            url = f"https://127.0.0.1:{desk.port}/page/live"
            async with session.ws_connect(url, headers=headers, ssl=unverified()) as socket:
                while not condition(frame := json.loads(await socket.receive_str(timeout=60))):
                    pass
                return frame

    return asyncio.run(read())


def test_the_stream_has_reports_control_and_poses(desk, robot, cookie):
    seen = first_frame(desk, cookie, condition=lambda frame: frame["worlds"])
    assert seen["robots"][0]["report"] == robot.report
    assert seen["robots"][0]["control"] == {"tokens": True, "owner": None, "id": None, "request": None}
    (world,) = seen["worlds"]
    assert world["robots"] == [0] and world["poses"] == POSES


@pytest.mark.parametrize("with_login, origin", [(False, ""), (True, "https://evil.example")])
def test_the_stream_is_for_this_page_only(desk, cookie, with_login, origin):
    with pytest.raises(aiohttp.WSServerHandshakeError) as refused:
        first_frame(desk, cookie if with_login else {}, origin)
    assert refused.value.status == (403 if origin else 401)


def test_the_scene_and_its_meshes_are_passed_on(desk, cookie):
    answer = desk.send("GET", "/page/scene?robot=0", **cookie)
    assert answer.json()["scene"] == SCENE and answer.json()["robots"] == [0]
    answer = desk.send("GET", "/page/mesh?robot=0&name=a%20mesh", **cookie)
    assert answer.body == struct.pack("<II", 3, 1) + VERTICES + FACES
    assert desk.send("GET", "/page/mesh?robot=0&name=other", **cookie).status == 404
