# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Who has control of a robot: requests, take-over and release, in both interfaces of Desk."""

import asyncio
import http.client
import json
import socket
import threading

import pytest
from desk_fixtures import desk_with_robot, fresh_desk, fresh_robot
from desk_robot import OPEN
from desk_server import basic
from pyfranka.desk.fci import ATTEMPT
from pyfranka.desk.tokens import Tokens
from waiting import wait_for

TOKEN = "/admin/api/control-token"
TAKE, RELEASE = "/api/system/control-token:take", "/api/system/control-token:release"
DEADLINE = 60.0  # [s]


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    with desk_with_robot(tmp_path_factory.mktemp("certificates")) as (robot, desk):
        yield robot, desk


@pytest.fixture
def robot(place):
    return fresh_robot(place, brakes=OPEN)


@pytest.fixture
def desk(place, robot):
    return fresh_desk(place)


@pytest.fixture
def cookie(desk):
    return desk.log_in()


def state(desk):
    return desk.send("GET", TOKEN).json()


def active_id(desk):
    active = state(desk)["activeToken"]
    return active and active["id"]


def release(desk, request, cookie):
    return desk.send("DELETE", TOKEN, {"token": request["token"]}, **cookie)


def take(desk, owner="other", **more):
    return desk.send("POST", TAKE, {"owner": owner, **more}, **basic())


class Later(threading.Thread):
    """A request on a connection of its own, which waits for its answer."""

    def __init__(self, desk, body):
        super().__init__(daemon=True)
        self._connection, self._body = desk.connection(), body
        self.answer = None
        self.start()

    def run(self):
        try:
            self._connection.request("POST", TAKE, json.dumps(self._body), basic())
            response = self._connection.getresponse()
            self.answer = response.status, json.loads(response.read())
        except (OSError, http.client.HTTPException):
            pass

    def go_away(self):
        self._connection.sock.shutdown(socket.SHUT_RDWR)

    def result(self):
        self.join(DEADLINE)
        return self.answer


# ---- the older interface ---------------------------------------------------------------------------------


def test_request_is_granted_at_once_while_no_user_has_control(desk, cookie):
    assert state(desk) == {"activeToken": None, "fciActive": False, "tokenRequest": None}
    request = desk.take_control("me", **cookie)
    assert type(request["id"]) is int and type(request["token"]) is str
    assert state(desk)["activeToken"] == {"id": request["id"], "ownedBy": "me"}


def test_request_is_pending_until_the_holder_releases_control(desk, cookie):
    first, second = desk.take_control("me", **cookie), desk.take_control("you", **cookie)
    assert active_id(desk) == first["id"]
    assert state(desk)["tokenRequest"]["id"] == second["id"]
    assert release(desk, first, cookie).status == 200
    assert active_id(desk) == second["id"] and state(desk)["tokenRequest"] is None


def test_a_newer_request_replaces_a_pending_one(desk, cookie):
    first = desk.take_control("me", **cookie)
    replaced, newest = desk.take_control("you", **cookie), desk.take_control("her", **cookie)
    assert release(desk, replaced, cookie).json()["error"] == "ControlTokenUnknown"
    release(desk, first, cookie)
    assert active_id(desk) == newest["id"]


def test_pending_request_can_be_withdrawn_in_two_ways(desk, cookie):
    first = desk.take_control("me", **cookie)
    pending = desk.take_control("you", **cookie)
    assert release(desk, pending, cookie).status == 200
    pending = desk.take_control("you", **cookie)
    path = f"{TOKEN}/request/{pending['id']}"
    assert desk.send("DELETE", path, {"token": first["token"]}, **cookie).status == 404
    assert desk.send("DELETE", path, {"token": pending["token"]}, **cookie).status == 200
    assert state(desk)["tokenRequest"] is None and active_id(desk) == first["id"]


def test_a_released_token_is_unknown(desk, cookie):
    request = desk.take_control(**cookie)
    assert release(desk, request, cookie).status == 200
    assert release(desk, request, cookie).status == 404
    fci = desk.send("POST", f"{TOKEN}/fci", {"token": request["token"]}, **cookie)
    assert fci.status == 404 and fci.json()["error"] == "ControlTokenUnknown"


def test_a_pending_token_may_not_act(desk, cookie, robot):
    desk.take_control("me", **cookie)
    pending = desk.take_control("you", **cookie)
    assert desk.send("POST", f"{TOKEN}/fci", {"token": pending["token"]}, **cookie).status == 423
    unlock = desk.send("POST", "/desk/api/joints/unlock", **cookie, X_Control_Token=pending["token"])
    assert unlock.status == 423
    assert robot.lines == []


def test_release_switches_the_fci_off(desk, cookie, robot):
    request = desk.take_control(**cookie)
    assert desk.send("POST", f"{TOKEN}/fci", {"token": request["token"]}, **cookie).status == 200
    assert state(desk)["fciActive"]
    release(desk, request, cookie)
    assert not state(desk)["fciActive"] and robot.lines == ["fci on", "fci off"]


def test_logging_out_keeps_control(desk, cookie):
    request = desk.take_control(**cookie)
    assert desk.send("POST", "/admin/api/logout", **cookie).status == 200
    assert desk.send("POST", "/admin/api/logout", **cookie).status == 401
    assert active_id(desk) == request["id"]


@pytest.mark.parametrize("form", ["raw", "base64", "header"])
def test_the_fci_takes_its_token_in_each_form_that_clients_send(desk, cookie, robot, form):
    import base64
    import urllib.parse

    token = desk.take_control(**cookie)["token"]
    field = token if form == "raw" else base64.b64encode(token.encode()).decode()
    body = b"" if form == "header" else b"token=" + urllib.parse.quote(field).encode()
    headers = {"X_Control_Token": token} if form == "header" else {}
    headers["Content_Type"] = "application/x-www-form-urlencoded"
    assert desk.send("POST", "/desk/api/system/fci", body, **cookie, **headers).status == 200
    assert robot.lines == ["fci on"]


# ---- forced take-over ------------------------------------------------------------------------------------


@pytest.mark.parametrize("query", ["?force", "?force=", "?force=true"])
def test_the_circle_button_confirms_a_forced_request(desk, cookie, robot, query):
    first = desk.take_control("me", **cookie)
    assert desk.send("POST", f"{TOKEN}/fci", {"token": first["token"]}, **cookie).status == 200
    second = desk.take_control("you", query, **cookie)
    assert active_id(desk) == first["id"]
    robot.report["buttons"]["circle"] = True
    wait_for(lambda: active_id(desk) == second["id"])
    wait_for(lambda: not state(desk)["fciActive"])
    assert release(desk, first, cookie).status == 404


def test_the_circle_button_does_not_grant_other_requests(desk, cookie, robot):
    first = desk.take_control("me", **cookie)
    desk.take_control("you", **cookie)
    robot.report["buttons"]["circle"] = True
    desk.refresh()
    assert active_id(desk) == first["id"]


def test_forced_request_is_granted_at_once_while_no_user_has_control(desk, cookie):
    request = desk.take_control("me", "?force", **cookie)
    assert active_id(desk) == request["id"]


def test_forced_request_expires(desk, cookie):
    limit = desk.send("GET", "/admin/api/safety", **cookie).json()["tokenForceTimeout"]
    assert limit == 30
    first = desk.take_control("me", **cookie)
    with desk.stopped_clock():
        second = desk.take_control("you", "?force", **cookie)
        desk.advance(limit - 0.1)
        assert state(desk)["tokenRequest"]["id"] == second["id"]
        desk.advance(0.2)
    wait_for(lambda: state(desk)["tokenRequest"] is None)
    assert active_id(desk) == first["id"]
    assert release(desk, second, cookie).json()["error"] == "ControlTokenUnknown"


# ---- the newer interface ---------------------------------------------------------------------------------


def test_both_interfaces_share_one_token(desk, cookie):
    taken = take(desk, "me").json()
    assert active_id(desk) == taken["tokenId"]
    assert desk.send("GET", "/api/system/control-token").json() == {
        "owner": "me",
        "requester": None,
        "tokenId": taken["tokenId"],
    }
    assert desk.send("DELETE", TOKEN, {"token": taken["token"]}, **cookie).status == 200
    request = desk.take_control("me", **cookie)
    answer = desk.send("POST", RELEASE, **basic(), X_Control_Token=request["token"])
    assert (answer.status, answer.body) == (204, b"")
    assert desk.send("GET", "/api/system/control-token").json()["owner"] is None


@pytest.mark.parametrize("timeout, answered", [(4.0, 4.0), (60.0, 59.5)])
def test_taking_waits_for_its_time_and_a_long_one_ends_before_the_clients_own_limit(desk, timeout, answered):
    take(desk, "me")
    with desk.stopped_clock():
        later = Later(desk, {"owner": "me", "timeout": timeout})  # also for the same owner
        wait_for(lambda: state(desk)["tokenRequest"])
        desk.advance(answered - 0.1)
        assert state(desk)["tokenRequest"]
        desk.advance(0.2)
    status, body = later.result()
    assert status == 424 and body["code"] == "Timeout"
    assert state(desk)["tokenRequest"] is None


def test_taking_is_answered_when_the_holder_releases(desk, cookie):
    first = desk.take_control("me", **cookie)
    later = Later(desk, {"owner": "you", "timeout": 2 * DEADLINE})
    wait_for(lambda: state(desk)["tokenRequest"])
    release(desk, first, cookie)
    status, body = later.result()
    assert status == 200 and active_id(desk) == body["tokenId"]


def test_taking_ends_when_a_newer_request_replaces_it(desk, cookie):
    desk.take_control("me", **cookie)
    later = Later(desk, {"owner": "you"})
    wait_for(lambda: state(desk)["tokenRequest"])
    assert take(desk, "her", timeout=0.01).status == 424
    status, body = later.result()
    assert status == 424 and body["code"] == "RequestOverride"


def test_a_client_that_goes_away_withdraws_its_request(desk, cookie):
    desk.take_control("me", **cookie)
    later = Later(desk, {"owner": "you"})
    wait_for(lambda: state(desk)["tokenRequest"])
    later.go_away()
    wait_for(lambda: state(desk)["tokenRequest"] is None)


WAYS_TO_CONTROL = {
    "release": lambda tokens: tokens.release(tokens.active.token),
    "accept": lambda tokens: tokens.accept(),
    "circle button": lambda tokens: tokens.confirm_at_robot(),
}


@pytest.mark.parametrize("is_waiting", [True, False])
@pytest.mark.parametrize("way", WAYS_TO_CONTROL.values(), ids=WAYS_TO_CONTROL)
def test_pending_request_gets_control_only_if_its_client_is_waiting(way, is_waiting):
    async def decide():
        tokens = Tokens(30.0, lambda: None, lambda: None)
        holder = tokens.request("me")
        pending = tokens.request("you", force=True, is_waiting=lambda: is_waiting)
        way(tokens)
        if is_waiting:
            expected = pending
        else:  # the holder keeps control, or has released it
            expected = None if way is WAYS_TO_CONTROL["release"] else holder
        assert tokens.active is expected and tokens.pending is None
        assert await pending.answer == ("granted" if is_waiting else "withdrawn")

    asyncio.run(decide())


def test_client_that_has_just_gone_does_not_get_control(desk, cookie):
    first = desk.take_control("me", **cookie)
    with desk.stopped_clock():  # so that no time passes in which Desk could look for it
        later = Later(desk, {"owner": "you"})
        wait_for(lambda: state(desk)["tokenRequest"])
        connections = len(desk.desk.gate._guards)
        later.go_away()
        wait_for(lambda: len(desk.desk.gate._guards) < connections)
        assert release(desk, first, cookie).status == 200
        assert active_id(desk) is None


def test_client_that_goes_while_control_is_granted_releases_it(desk, cookie):
    first = desk.take_control("me", **cookie)
    later = Later(desk, {"owner": "you"})
    wait_for(lambda: state(desk)["tokenRequest"])

    async def grant_and_disconnect():
        tokens = desk.desk.tokens
        waiting = tokens.pending
        tokens.release(first["token"])
        assert tokens.active is waiting
        for handler in list(desk.desk.gate._guards):
            if handler.transport is not None:
                handler.transport.abort()

    desk.call(grant_and_disconnect())
    desk.close_connection()
    wait_for(lambda: active_id(desk) is None)
    later.result()


@pytest.mark.parametrize("timeout", [0, -1, "1", True, [], 1e999])
def test_a_timeout_is_a_positive_number(desk, timeout):
    answer = take(desk, timeout=timeout)
    assert answer.status == 400 and answer.json()["message"].endswith(".")


def test_the_holder_denies_or_accepts_a_request_on_the_page(desk, cookie):
    token = desk.take_control("me", **cookie)["token"]
    headers = {**cookie, "X_Control_Token": token, "Content_Type": "application/json"}
    for what, expected in (("deny", 424), ("accept", 200)):
        later = Later(desk, {"owner": "you"})
        wait_for(lambda: state(desk)["tokenRequest"])
        answer = desk.send("POST", "/page/control", {"what": what}, **headers)
        assert answer.status == 200 and answer.json()["control"]["request"] is None
        status, body = later.result()
        assert status == expected
        assert what == "accept" or body["code"] == "Timeout"
    assert active_id(desk) == body["tokenId"]
    assert answer.json()["control"]["owner"] == "you"


# ---- options ---------------------------------------------------------------------------------------------


def test_options_select_behavior_on_which_sources_disagree(tmp_path):
    options = {"release_status": 204, "token_id": False, "fci_after_release": True}
    with desk_with_robot(tmp_path, report={"brakes": OPEN}, **options) as (robot, desk):
        taken = take(desk, "me").json()
        assert set(taken) == {"token"}
        assert set(desk.send("GET", "/api/system/control-token").json()) == {"owner", "requester"}
        headers = {**basic(), "X_Control_Token": taken["token"]}
        assert desk.send("POST", "/api/fci:activate", **headers).status == 204
        assert desk.send("DELETE", TOKEN, {"token": taken["token"]}, **basic()).status == 204
        assert state(desk)["fciActive"] and robot.lines == ["fci on"]


def test_the_older_generation_of_the_panda_has_no_tokens_and_its_fci_is_always_on(tmp_path):
    with desk_with_robot(tmp_path, "fer-old") as (robot, desk):
        answer = desk.send("GET", TOKEN)
        assert (answer.status, answer.text) == (404, "File not found")
        cookie = desk.log_in()
        headers = {**cookie, "X_Control_Token": ""}
        body = (
            b'--x\r\nContent-Disposition: form-data; name="force"; filename="force"\r\n\r\nfalse\r\n--x--\r\n'
        )
        multipart = {"Content_Type": "multipart/form-data; boundary=x"}
        assert desk.send("POST", "/desk/api/robot/open-brakes", body, **headers, **multipart).status == 200
        wait_for(lambda: robot.lines == ["joints unlock", "fci on"])
        desk.advance(2 * ATTEMPT)
        assert desk.send("POST", "/desk/api/robot/close-brakes", b"force=false", **headers).status == 200
        assert robot.lines[2:] == ["fci off", "joints lock"]


def test_only_a_motion_that_the_fci_prevents_pauses_an_fci_that_is_always_on(tmp_path):
    ready = {"brakes": OPEN, "fci": True, "mode": "Idle"}
    with desk_with_robot(tmp_path, "fer-old", report=ready) as (robot, desk):
        cookie = desk.log_in()
        robot.answers["move"] = "error: EmergencyStopPressed: A stop is pressed; release it."
        assert desk.send("POST", "/desk/api/robot/fold", **cookie).status == 424
        assert robot.lines == ["move pack"]
        robot.answers["move"] = lambda *words: (
            "error: MotionActive: The FCI." if robot.report["fci"] else "ok"
        )
        assert desk.send("POST", "/desk/api/robot/fold", **cookie).status == 200
        assert robot.lines[1:4] == ["move pack", "fci off", "move pack"]
