# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""WebSockets and event streams of Desk, and the robot that goes away, reboots or answers nonsense."""

import asyncio
import contextlib
import dataclasses
import json

import aiohttp
import pytest
from desk_robot import OPEN
from desk_server import LIMITS, SteppedLoop, basic
from pyfranka.desk.profiles import PROFILES
from pyfranka.desk.sockets import TOPICS, Topic, send_snapshots
from scripted_desk import change, desk_with_robot
from waiting import wait_for

pytest_plugins = ["desk_fixtures"]

EVENTS, TOKEN = "/desk/api/navigation/events", "/admin/api/control-token"
SAFETY, CONFIGURATION = "/admin/api/safety/status", "/desk/api/robot/configuration"
BUTTONS = ("circle", "cross", "check", "up", "down", "left", "right")


# ---- what they send --------------------------------------------------------------------------------------


def without_numbers(value):
    """Without the numbers of reports, which another report may have changed."""
    if not isinstance(value, dict):
        return value
    return {name: without_numbers(part) for name, part in value.items() if name != "sequenceNumber"}


@pytest.mark.parametrize("profile", PROFILES)
def test_every_socket_begins_with_the_answer_of_a_get(profile, tmp_path):
    with desk_with_robot(tmp_path, profile) as (_, desk):
        for path in [topic.path for topic in TOPICS if topic.where(desk.desk.profile)] + [EVENTS]:
            with desk.socket(path) as socket:
                answer = desk.send("GET", path, **basic()).json()
                assert without_numbers(socket.next()) == without_numbers(answer), path


def status(desk, path, headers):
    """Of the handshake."""
    try:
        with desk.socket(path, headers):
            return 101
    except aiohttp.WSServerHandshakeError as error:
        return error.status


def test_sockets_need_the_login_that_a_get_needs(desk, cookie):
    right = {"authorization": cookie["Cookie"].removeprefix("authorization=")}
    wrong = {"Authorization": basic(password="other")["Authorization"]}
    statuses = [(right, 101, 101), (cookie, 101, 101), (None, 101, 101), ({}, 401, 101), (wrong, 401, 401)]
    for headers, of_events, of_safety in statuses:
        assert status(desk, EVENTS, headers) == of_events
        assert status(desk, SAFETY, headers) == of_safety


def test_button_events_are_reported_once_and_alone(desk, robot):
    with desk.socket(EVENTS) as socket:
        assert socket.next() == dict.fromkeys(BUTTONS, False)
        robot.report["buttons"]["circle"] = True
        assert socket.next() == {"circle": True}
        robot.report["buttons"].update(circle=False, cross=True)
        assert socket.next() == {"circle": False, "cross": True}


def test_control_is_granted_before_the_circle_button_is_reported(desk, robot, cookie):
    desk.take_control("me", **cookie)
    forced = desk.take_control("you", "?force", **cookie)
    with desk.socket(EVENTS) as socket:
        socket.next()
        robot.report["buttons"]["circle"] = True
        assert socket.next()["circle"]
    assert desk.send("GET", TOKEN).json()["activeToken"]["id"] == forced["id"]


def test_states_are_sent_on_change_and_once_a_second(desk, robot):
    with desk.stopped_clock(), desk.socket(SAFETY) as socket:
        assert socket.next()["brakeState"] == ["Locked"] * 7
        desk.advance(0.9)
        change(desk, robot, brakes=OPEN)
        changed = socket.next()  # and no message before it
        assert changed["brakeState"] == ["Unlocked"] * 7 and changed["stoState"] == "SafeTorqueOn"
        desk.advance(1.2)
        again = socket.next()
        assert again["sequenceNumber"] > changed["sequenceNumber"]
        assert again["brakeState"] == changed["brakeState"]


def test_control_is_sent_on_change(desk, cookie):
    with desk.stopped_clock(), desk.socket(TOKEN) as socket:
        assert socket.next()["activeToken"] is None
        desk.take_control("me", **cookie)
        assert socket.next()["activeToken"]["ownedBy"] == "me"


def test_the_configuration_comes_ten_times_a_second(desk, robot):
    with desk.stopped_clock(), desk.socket(CONFIGURATION) as socket:
        socket.next()
        for q in (0.1, 0.2, 0.3, 0.4):
            change(desk, robot, q=[q] * 7)
            desk.advance(0.11)
            assert socket.next()["jointAngles"] == [q] * 7  # and no message before it


def test_pings_are_answered_and_messages_ignored(desk):
    with desk.socket(SAFETY, autoping=False) as socket:
        socket.send("{nonsense")
        socket.send(b"\xff" * 100)
        desk.call(socket.opened.ping(b"still there?"))
        while (message := socket.receive()).type is not aiohttp.WSMsgType.PONG:
            assert message.type is aiohttp.WSMsgType.TEXT
        assert message.data == b"still there?"


def test_a_long_message_ends_its_socket_only(desk):
    with desk.socket(EVENTS) as socket:
        socket.next()
        socket.send("x" * 10000)
        assert socket.receive().type in (aiohttp.WSMsgType.CLOSE, aiohttp.WSMsgType.CLOSED)
    assert desk.send("GET", EVENTS, **basic()).status == 200


# Limits, and how many sockets they allow without a login ({}) and with one.
LIMITED = [
    ({"sockets_of_address": 3}, [(None, 3)]),
    ({"sockets_without_login_of_address": 3}, [({}, 3)]),
    ({"sockets": 2, "sockets_without_login": 3}, [({}, 3), (None, 2)]),
]


@pytest.mark.parametrize("limits, places", LIMITED, ids=str)
def test_sockets_are_limited_with_places_of_their_own_for_users(tmp_path, limits, places):
    with desk_with_robot(tmp_path, limits=dataclasses.replace(LIMITS, **limits)) as (_, desk):
        with contextlib.ExitStack() as stack:
            for headers, count in places:
                for _ in range(count):
                    stack.enter_context(desk.socket(SAFETY, headers)).next()
                assert status(desk, SAFETY, headers) == 429
        wait_for(lambda: status(desk, SAFETY, headers) == 101, "A place")


class FakeDesk:
    """A desk with a value that changes."""

    def __init__(self):
        self.robot, self.value, self.event = self, 0, asyncio.Event()
        self.report = True

    @contextlib.contextmanager
    def watch(self):
        yield self.event

    def set_value(self, value):
        self.value = value
        self.event.set()


def test_change_while_a_snapshot_is_sent_is_sent_next():
    async def listen():
        asyncio.get_running_loop().stop_clock()  # no period ends
        desk, sent = FakeDesk(), []

        async def send(value):
            sent.append(value)
            if value == 0:
                desk.set_value(1)

        work = asyncio.create_task(send_snapshots(desk, Topic("", lambda desk: desk.value), send))
        for _ in range(10):  # turns of the loop
            await asyncio.wait([work], timeout=0)
        assert sent == [0, 1]
        work.cancel()

    with contextlib.closing(SteppedLoop()) as loop:
        loop.run_until_complete(listen())


def test_events_of_the_newer_interface_are_a_stream(desk):
    connection = desk.connection()
    connection.request("GET", "/api/system/sse")
    response = connection.getresponse()
    assert response.status == 200 and response.getheader("Content-Type").startswith("text/event-stream")
    for _ in range(2):
        line = response.readline()
        assert json.loads(line.removeprefix(b"data: "))["system"]["status"] == "Started"
        assert response.readline() == b"\n"
    connection.close()


# ---- robots that go away ---------------------------------------------------------------------------------


REBOOTS = [("/admin/api/reboot", 200), ("/desk/api/reboot", 200), ("/api/system:reboot", 204)]


@pytest.mark.parametrize("path, expected", REBOOTS)
def test_a_reboot_answers_and_goes_away_and_comes_back_without_logins(desk, robot, control, path, expected):
    assert desk.send("POST", path).status == 401
    with desk.socket(EVENTS) as socket:
        socket.next()
        answer = desk.send("POST", path, **basic())
        assert (answer.status, answer.body) == (expected, b"")
        assert socket.receive().type is aiohttp.WSMsgType.CLOSE
    wait_for(lambda: not desk.listens())
    wait_for(lambda: robot.lines == ["power off"])
    desk.advance(desk.desk.profile.boot)
    wait_for(lambda: desk.listens())
    assert robot.lines == ["power off", "power on"]
    assert desk.send("GET", CONFIGURATION, Cookie=control["Cookie"]).status == 401
    assert desk.send("GET", TOKEN).json()["activeToken"] is None
    assert desk.log_in()


SHUTDOWNS = [("/admin/api/shutdown", 200), ("/api/system:shutdown", 204)]


@pytest.mark.parametrize("path, expected", SHUTDOWNS)
def test_after_a_shutdown_the_robot_comes_back_with_its_power(desk, robot, path, expected):
    assert desk.send("POST", path, {"token": "x"}, **basic()).status == expected
    wait_for(lambda: not desk.listens() and robot.lines == ["power off"])
    desk.advance(2 * desk.desk.profile.boot)
    assert not desk.listens() and robot.lines == ["power off"]
    robot.report["power"] = True
    wait_for(lambda: desk.listens())


def test_desk_is_unreachable_while_the_robot_is_off(desk, robot):
    robot.report["power"] = False
    wait_for(lambda: not desk.listens())
    robot.report["power"] = True
    wait_for(lambda: desk.listens())


def test_with_an_option_a_reboot_needs_no_login(tmp_path):
    with desk_with_robot(tmp_path, "fer-spoc", power_without_login=True, boot_time=0.1) as (robot, desk):
        assert desk.send("POST", "/admin/api/reboot").status == 200
        wait_for(lambda: robot.lines == ["power off", "power on"])


BAD_REPORTS = [
    "ok {",
    "ok []",
    "ok {}",
    "ok null",
    "ok " + "[" * 100000,
    "error: There is no line 'report'.",
    "nonsense",
    "",
    "ok " + json.dumps({"time": "now"}),
]


def test_a_report_that_cannot_be_read_is_an_error_with_a_sentence(desk, robot):
    for report in BAD_REPORTS:
        robot.raw_report = report
        wait_for(lambda: desk.send("GET", TOKEN).status == 503, report[:20])
        message = desk.send("GET", TOKEN).json()["message"]
        assert message.endswith(".") and "robot" in message or "control interface" in message
        robot.raw_report = None
        wait_for(lambda: desk.send("GET", TOKEN).status == 200)


def test_lost_robot_is_reported_and_found_again(desk, robot):
    robot.stop()
    wait_for(lambda: desk.send("GET", TOKEN).status == 503)
    assert "127.0.0.1" in desk.send("GET", TOKEN).json()["message"]
    assert desk.send("POST", "/desk/api/joints/lock", **basic()).status == 503
    robot.start()
    wait_for(lambda: desk.send("GET", TOKEN).status == 200)
