# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The page's own interface, without a browser: who may do what, and what reaches the robot."""

import json
import struct
from base64 import b64encode

import aiohttp
import pytest
from desk_server import PASSWORD, USER
from waiting import wait_for

pytest_plugins = ["desk_fixtures"]

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
    next_part, data = (36, VERTICES) if words[-1] == "0" else (None, FACES)
    part = {"vertices": 3, "faces": 1, "next": next_part, "data": b64encode(data).decode()}
    return "ok " + json.dumps(part)


@pytest.fixture
def robot(robot):
    robot.answers |= {"scene": "ok " + json.dumps(SCENE), "poses": "ok " + json.dumps(POSES), "mesh": mesh}
    robot.answers["hand"] = "error: NotHomed: The hand is not homed."
    return robot


@pytest.fixture
def login(desk):
    """The answer to a login through the page."""
    return post(desk, "/page/login", {"user": USER, "password": PASSWORD})


@pytest.fixture
def cookie(login):
    return {"Cookie": login.headers["Set-Cookie"].partition(";")[0]}


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


def test_the_scene_and_its_meshes_are_passed_on(desk, cookie):
    answer = desk.send("GET", "/page/scene?robot=0", **cookie)
    assert answer.json()["scene"] == SCENE and answer.json()["robots"] == [0]
    answer = desk.send("GET", "/page/mesh?robot=0&name=a%20mesh", **cookie)
    assert answer.body == struct.pack("<II", 3, 1) + VERTICES + FACES
    assert desk.send("GET", "/page/mesh?robot=0&name=other", **cookie).status == 404


# ---- logins ----------------------------------------------------------------------------------------------


def test_the_cookie_is_out_of_reach_of_scripts_and_other_sites(login):
    assert login.status == 200 and login.json() == {"user": USER}
    attributes = {part.strip().lower() for part in login.headers["Set-Cookie"].split(";")[1:]}
    assert {"httponly", "secure", "samesite=strict", "path=/"} <= attributes


def test_a_wrong_password_opens_nothing(desk):
    answer = post(desk, "/page/login", {"user": USER, "password": "wrong"})
    assert answer.status == 401 and "Set-Cookie" not in answer.headers


def test_logging_out_ends_the_session(desk, cookie):
    assert desk.send("GET", "/page/session", **cookie).json() == {"user": USER}
    assert post(desk, "/page/logout", {}, **cookie).status == 200
    assert desk.send("GET", "/page/session", **cookie).json() == {"user": None}


NEED_LOGIN = ["robots", "scene", "mesh?name=x", "robot-mesh/fr3/link0", "command", "control"]


@pytest.mark.parametrize("path", NEED_LOGIN)
def test_data_and_commands_require_a_login(desk, robot, path):
    body = {"action": "user_stop", "words": ["on"], "what": "take"} if path.startswith("co") else None
    answer = desk.send("POST" if body else "GET", f"/page/{path}", body, Content_Type=JSON)
    assert answer.status == 401 and robot.lines == [] and desk.desk.tokens.active is None


# ---- commands --------------------------------------------------------------------------------------------

NUMBERS = [str(float(number)) for number in range(1, 30)]
# What the page sends for each of its controls: without control, and with control only.
FREE = [
    ("joints", "lock"),
    ("user_stop", "on"),
    ("input", "x31", "on"),
    ("button", "circle", "off"),
    ("move", "stop"),
    ("inject", "td2Timeout", "on"),
    ("inject", "jointLimitViolation", "7", "on"),
    ("push", "fr3_hand", "10.0", "-5.5", "0.0", "50"),
]
CONTROLLED = [
    ("joints", "unlock"),
    ("fci", "on"),
    ("fci", "off"),
    ("operating_mode", "programming"),
    ("guiding", "on"),
    ("guiding_mode", "free"),
    ("guiding_mode", "user", *["on", "off"] * 3, "on"),
    ("navigation", "robot"),
    ("self_test",),
    ("acknowledge", "td2Timeout"),
    ("recover",),
    ("end_effector", *NUMBERS),
    ("end_effector_power", "off"),
    ("move", "pack"),
    ("move", *NUMBERS[:7]),
    ("move", *NUMBERS[:8]),
]


@pytest.mark.parametrize("words", FREE + CONTROLLED, ids=lambda words: " ".join(words)[:40])
def test_commands_reach_the_robot_as_lines(desk, robot, cookie, words):
    def send(token):
        robot.lines.clear()
        status = command(desk, cookie, *words, token=token).status
        return status, [line for line in robot.lines if line.split()[0] == words[0]]

    sent = (200, [" ".join(words)])
    without = sent if words in FREE else (423, [])
    token = control(desk, cookie)["token"]
    assert (send(""), send("wrong"), send(token)) == (without, without, sent)


def test_reboot_requires_control(desk, robot, cookie):
    token = control(desk, cookie)["token"]
    assert command(desk, cookie, "reboot", token="wrong").status == 423
    assert not desk.desk.power.down
    assert command(desk, cookie, "reboot", token=token).status == 200
    wait_for(lambda: robot.lines[-1:] == ["power off"])
    desk.advance(desk.desk.profile.boot)
    wait_for(desk.listens)


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
    answer = command(desk, cookie, *words, token=token)
    assert answer.status == 400 and answer.json()["message"].endswith(".")
    assert robot.lines == []


def test_form_of_another_site_is_refused(desk, cookie):
    body = json.dumps({"action": "user_stop", "words": ["on"]}).encode()
    answer = desk.send("POST", "/page/command", body, Content_Type="text/plain", **cookie)
    assert answer.status == 415


def test_refusal_of_the_robot_is_shown_with_its_message(desk, cookie):
    token = control(desk, cookie)["token"]
    answer = command(desk, cookie, "hand", "move", "0.04", "0.1", token=token)
    assert answer.status == 200
    assert answer.json() == {"refused": {"code": "NotHomed", "message": "The hand is not homed."}}


# ---- control ---------------------------------------------------------------------------------------------


def test_control_is_taken_and_released_by_its_holder(desk, cookie):
    mine = control(desk, cookie)
    assert mine["control"]["owner"] == USER and mine["control"]["id"] == mine["id"]
    desk.take_control("anna", **cookie)
    answer = post(desk, "/page/control", {"what": "accept"}, X_Control_Token="wrong", **cookie)
    assert answer.status == 423
    assert control(desk, cookie, "release", mine["token"])["control"]["owner"] == "anna"


def test_a_forced_request_shows_the_time_left(desk, cookie):
    desk.take_control("anna", **cookie)
    request = control(desk, cookie, "force")["control"]["request"]
    assert request["force"] and request["owner"] == USER and 0 < request["left"] <= 30


# ---- the stream ------------------------------------------------------------------------------------------


def test_the_stream_has_reports_control_and_poses(desk, robot, cookie):
    with desk.socket("/page/live", cookie), desk.socket("/page/live", cookie) as stream:
        while not (seen := stream.next())["worlds"]:
            pass
    assert seen["robots"][0]["report"] == robot.report
    assert seen["robots"][0]["control"] == {"tokens": True, "owner": None, "id": None, "request": None}
    (world,) = seen["worlds"]
    assert world["robots"] == [0] and world["poses"] == POSES


@pytest.mark.parametrize("origin, status", [({}, 401), ({"Origin": "https://evil.example"}, 403)])
def test_the_stream_is_for_this_page_only(desk, cookie, origin, status):
    with pytest.raises(aiohttp.WSServerHandshakeError) as refused:
        with desk.socket("/page/live", {**cookie, **origin} if origin else {}):
            pass
    assert refused.value.status == status


def test_page_that_has_been_closed_does_not_get_control(desk, cookie):
    holder = desk.take_control("anna", **cookie)
    with desk.socket("/page/live", cookie) as stream:
        stream.next()
        assert control(desk, cookie)["control"]["request"]
    wait_for(lambda: desk.desk.gate.sockets.total == 0, "The end of the stream")
    after = control(desk, cookie, "release", holder["token"])
    assert after["control"]["owner"] is None and after["control"]["request"] is None
