# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Control of a robot: requests, take-over and release, as rules and in both interfaces of Desk."""

import asyncio
import base64
import contextlib
import urllib.parse

import pytest
from desk_robot import OPEN
from desk_server import SteppedLoop, basic
from pyfranka.desk.fci import ATTEMPT
from pyfranka.desk.tokens import Tokens
from scripted_desk import desk_with_robot
from waiting import wait_for

pytest_plugins = ["desk_fixtures"]

TOKEN = "/admin/api/control-token"
TAKE, RELEASE = "/api/system/control-token:take", "/api/system/control-token:release"
DEADLINE = 60.0  # [s]


@pytest.fixture
def robot(robot):
    robot.report["brakes"] = OPEN
    return robot


def state(desk):
    return desk.send("GET", TOKEN).json()


def active_id(desk):
    active = state(desk)["activeToken"]
    return active and active["id"]


def release(desk, request, cookie):
    return desk.send("DELETE", TOKEN, {"token": request["token"]}, **cookie)


def take(desk, owner="other", **more):
    return desk.send("POST", TAKE, {"owner": owner, **more}, **basic())


# ---- the rules -------------------------------------------------------------------------------------------

FORCE_TIME = 30.0  # [s]
# Steps; who then has control, who waits for it, and the answers to requests that did not get it.
STEPS = [
    ("request a", "a", None, {}),
    ("force a", "a", None, {}),
    ("request a, release a, unknown a", None, None, {}),
    ("request a, request b", "a", "b", {}),
    ("request a, request b, release a, unknown a", "b", None, {}),
    ("request a, request b, release b, unknown b", "a", None, {"b": "withdrawn"}),
    ("request a, request b, request c, unknown b", "a", "c", {"b": "replaced"}),
    ("request a, request b, deny", "a", None, {"b": "denied"}),
    ("request a, request b, accept", "b", None, {}),
    ("request a, request b, circle", "a", "b", {}),
    ("request a, force b, circle", "b", None, {}),
    ("request a, force b, time 29.9", "a", "b", {}),
    ("request a, force b, time 30.1", "a", None, {"b": "denied"}),
    ("request a, force b, request c, time 30.1", "a", "c", {"b": "replaced"}),
    ("request a, request b, gone b, release a", None, None, {"b": "withdrawn"}),
    ("request a, request b, gone b, accept", "a", None, {"b": "withdrawn"}),
    ("request a, force b, gone b, circle", "a", None, {"b": "withdrawn"}),
    ("request a, request b, clear, unknown a", None, None, {"b": "withdrawn"}),
]


@pytest.mark.parametrize("steps, active, pending, answers", STEPS, ids=str)
def test_one_user_has_control_and_one_may_wait_for_it(steps, active, pending, answers):
    async def follow():
        loop, requests, gone = asyncio.get_running_loop(), {}, set()
        loop.stop_clock()
        tokens = Tokens(FORCE_TIME, lambda: None, lambda: None)
        calls = {"accept": tokens.accept, "deny": tokens.deny, "clear": tokens.clear}
        calls["circle"] = tokens.confirm_at_robot
        for step in steps.split(", "):
            what, _, word = step.partition(" ")
            if what in ("request", "force"):
                requests[word] = tokens.request(word, what == "force", lambda word=word: word not in gone)
            elif what in ("release", "unknown"):
                assert tokens.release(requests[word].token) == (what == "release")
            elif what == "gone":
                gone.add(word)
            elif what == "time":
                loop.ahead += float(word)
                turn = loop.create_future()
                loop.call_later(0.0, turn.set_result, None)  # behind the timers that are due
                await turn
            else:
                calls[what]()
        assert tokens.active is requests.get(active) and tokens.pending is requests.get(pending)
        decided = {name: each.answer.result() for name, each in requests.items() if each.answer.done()}
        assert {name: answer for name, answer in decided.items() if answer != "granted"} == answers
        assert active is None or decided[active] == "granted"

    with contextlib.closing(SteppedLoop()) as loop:
        loop.run_until_complete(follow())


# ---- the older interface ---------------------------------------------------------------------------------


def test_states_show_the_holder_and_the_pending_request(desk, cookie):
    assert state(desk) == {"activeToken": None, "fciActive": False, "tokenRequest": None}
    first = desk.take_control("me", **cookie)
    assert type(first["id"]) is int and type(first["token"]) is str
    second = desk.take_control("you", **cookie)
    assert state(desk)["activeToken"] == {"id": first["id"], "ownedBy": "me"}
    assert state(desk)["tokenRequest"] == {"id": second["id"], "requestedBy": "you", "force": False}
    assert release(desk, first, cookie).status == 200
    assert state(desk)["activeToken"] == {"id": second["id"], "ownedBy": "you"}
    assert state(desk)["tokenRequest"] is None


def test_pending_request_can_be_withdrawn_in_two_ways(desk, cookie):
    first = desk.take_control("me", **cookie)
    pending = desk.take_control("you", **cookie)
    assert release(desk, pending, cookie).status == 200
    pending = desk.take_control("you", **cookie)
    path = f"{TOKEN}/request/{pending['id']}"
    assert desk.send("DELETE", path, {"token": first["token"]}, **cookie).status == 404
    assert desk.send("DELETE", path, {"token": pending["token"]}, **cookie).status == 200
    assert state(desk)["tokenRequest"] is None and active_id(desk) == first["id"]


def test_a_pending_token_may_not_act(desk, cookie, robot):
    desk.take_control("me", **cookie)
    pending = desk.take_control("you", **cookie)
    assert desk.send("POST", f"{TOKEN}/fci", {"token": pending["token"]}, **cookie).status == 423
    unlock = desk.send("POST", "/desk/api/joints/unlock", **cookie, X_Control_Token=pending["token"])
    assert unlock.status == 423
    assert robot.lines == []


def test_logging_out_keeps_control(desk, cookie):
    request = desk.take_control(**cookie)
    assert desk.send("POST", "/admin/api/logout", **cookie).status == 200
    assert desk.send("POST", "/admin/api/logout", **cookie).status == 401
    assert active_id(desk) == request["id"]


@pytest.mark.parametrize("form", ["raw", "base64", "header"])
def test_the_fci_takes_its_token_in_each_form_that_clients_send(desk, cookie, robot, form):
    token = desk.take_control(**cookie)["token"]
    field = token if form == "raw" else base64.b64encode(token.encode()).decode()
    body = b"" if form == "header" else b"token=" + urllib.parse.quote(field).encode()
    headers = {"X_Control_Token": token} if form == "header" else {}
    headers["Content_Type"] = "application/x-www-form-urlencoded"
    assert desk.send("POST", "/desk/api/system/fci", body, **cookie, **headers).status == 200
    assert robot.lines == ["fci on"]


@pytest.mark.parametrize("query", ["?force", "?force=", "?force=true"])
def test_the_circle_button_confirms_a_forced_request(desk, cookie, robot, query):
    first = desk.take_control("me", **cookie)
    assert desk.send("POST", f"{TOKEN}/fci", {"token": first["token"]}, **cookie).status == 200
    second = desk.take_control("you", query, **cookie)
    assert active_id(desk) == first["id"]
    robot.report["buttons"]["circle"] = True
    wait_for(lambda: active_id(desk) == second["id"])
    wait_for(lambda: not state(desk)["fciActive"])
    answer = release(desk, first, cookie)
    assert answer.status == 404 and answer.json()["error"] == "ControlTokenUnknown"


# ---- the newer interface ---------------------------------------------------------------------------------


def begin_to_take(desk, owner="you", **more):
    """A request that waits; what its answer will be."""
    answer = desk.begin("POST", TAKE, {"owner": owner, **more}, **basic())
    wait_for(lambda: state(desk)["tokenRequest"], "The request")
    return answer


def code_of(answer):
    """Status and code of what has been answered."""
    answer = answer.result(DEADLINE)
    return answer.status, answer.json().get("code")


def test_both_interfaces_share_one_token(desk, cookie):
    taken = take(desk, "me").json()
    assert active_id(desk) == taken["tokenId"]
    shown = {"owner": "me", "requester": None, "tokenId": taken["tokenId"]}
    assert desk.send("GET", "/api/system/control-token").json() == shown
    assert desk.send("DELETE", TOKEN, {"token": taken["token"]}, **cookie).status == 200
    request = desk.take_control("me", **cookie)
    answer = desk.send("POST", RELEASE, **basic(), X_Control_Token=request["token"])
    assert (answer.status, answer.body) == (204, b"")
    assert desk.send("GET", "/api/system/control-token").json()["owner"] is None


@pytest.mark.parametrize("timeout, answered", [(4.0, 4.0), (60.0, 59.5)])
def test_taking_waits_for_its_time_and_a_long_one_ends_before_the_clients_own_limit(desk, timeout, answered):
    take(desk, "me")
    with desk.stopped_clock():
        later = begin_to_take(desk, "me", timeout=timeout)  # also for the same owner
        desk.advance(answered - 0.1)
        assert state(desk)["tokenRequest"]
        desk.advance(0.2)
    assert code_of(later) == (424, "Timeout")
    assert state(desk)["tokenRequest"] is None


def test_taking_ends_when_a_newer_request_replaces_it(desk, cookie):
    desk.take_control("me", **cookie)
    later = begin_to_take(desk)
    assert take(desk, "her", timeout=0.01).status == 424
    assert code_of(later) == (424, "RequestOverride")


def test_a_client_that_goes_away_withdraws_its_request(desk, cookie):
    desk.take_control("me", **cookie)
    begin_to_take(desk).cancel()
    wait_for(lambda: state(desk)["tokenRequest"] is None)


def test_client_that_has_just_gone_does_not_get_control(desk, cookie):
    first = desk.take_control("me", **cookie)
    with desk.stopped_clock():  # so that no time passes in which Desk could look for it
        later = begin_to_take(desk)
        connections = len(desk.desk.gate._guards)
        later.cancel()
        wait_for(lambda: len(desk.desk.gate._guards) < connections)
        assert release(desk, first, cookie).status == 200
        assert active_id(desk) is None


def test_client_that_goes_while_control_is_granted_releases_it(desk, cookie):
    first = desk.take_control("me", **cookie)
    later = begin_to_take(desk)

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
    assert later.exception(DEADLINE)
    wait_for(lambda: active_id(desk) is None)


def test_the_holder_denies_or_accepts_a_request_on_the_page(desk, cookie):
    token = desk.take_control("me", **cookie)["token"]
    headers = {**cookie, "X_Control_Token": token, "Content_Type": "application/json"}
    for what, expected in (("deny", (424, "Timeout")), ("accept", (200, None))):
        later = begin_to_take(desk)
        answer = desk.send("POST", "/page/control", {"what": what}, **headers)
        assert answer.status == 200 and answer.json()["control"]["request"] is None
        assert code_of(later) == expected
    assert active_id(desk) == later.result().json()["tokenId"]
    assert answer.json()["control"]["owner"] == "you"


# ---- options and generations -----------------------------------------------------------------------------


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
        headers = {**desk.log_in(), "X_Control_Token": ""}
        assert desk.send("POST", "/desk/api/robot/open-brakes", **headers).status == 200
        wait_for(lambda: robot.lines == ["joints unlock", "fci on"])
        desk.advance(2 * ATTEMPT)
        assert desk.send("POST", "/desk/api/robot/close-brakes", **headers).status == 200
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
