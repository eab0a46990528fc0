# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""WebSockets and event streams of Desk, and the robot that goes away, reboots or answers nonsense."""

import asyncio
import base64
import contextlib
import dataclasses
import json

import aiohttp
import pytest
from desk_fixtures import desk_with_robot, fresh_desk, fresh_robot
from desk_robot import OPEN
from desk_server import LIMITS, PASSWORD, USER, SteppedLoop, basic, unverified
from pyfranka.desk import Limits
from pyfranka.desk.profiles import PROFILES
from pyfranka.desk.sockets import TOPICS, Topic, send_snapshots
from waiting import wait_for

LIMIT = 60.0  # [s] for a message
EVENTS, TOKEN = "/desk/api/navigation/events", "/admin/api/control-token"
SAFETY, CONFIGURATION = "/admin/api/safety/status", "/desk/api/robot/configuration"
BUTTONS = ("circle", "cross", "check", "up", "down", "left", "right")


@pytest.fixture(scope="module", params=list(PROFILES))
def place(request, tmp_path_factory):
    with desk_with_robot(tmp_path_factory.mktemp("certificates"), request.param) as (robot, desk):
        yield robot, desk


@pytest.fixture(scope="module")
def fr3_place(tmp_path_factory):
    with desk_with_robot(tmp_path_factory.mktemp("certificates")) as (robot, desk):
        yield robot, desk


@pytest.fixture
def fr3(fr3_place):
    yield fresh_robot(fr3_place), fresh_desk(fr3_place)


def login():
    return {"Authorization": basic()["Authorization"]}


def run(work):
    return asyncio.run(asyncio.wait_for(work, 3 * LIMIT))


@contextlib.asynccontextmanager
async def socket(desk, path, headers=None, **more):
    async with aiohttp.ClientSession() as session:
        url = f"https://127.0.0.1:{desk.port}{path}"
        async with session.ws_connect(url, headers=headers or login(), ssl=unverified(), **more) as opened:
            yield opened


def on_socket(desk, path, work, **options):
    """What `work` returns, which gets an open socket."""

    async def talk():
        async with socket(desk, path, **options) as opened:
            return await work(opened)

    return run(talk())


async def following(opened):
    return json.loads(await asyncio.wait_for(opened.receive_str(), LIMIT))


async def until(opened, condition):
    while not condition(value := await following(opened)):
        pass
    return value


# ---- what they send --------------------------------------------------------------------------------------


def test_every_socket_begins_with_the_answer_of_a_get(place):
    robot, desk = place
    topics = [topic for topic in TOPICS if topic.where(desk.desk.profile)]
    paths = [topic.path for topic in topics] + [EVENTS]

    for path in paths:
        first = on_socket(desk, path, following)
        answer = desk.send("GET", path, **basic()).json()
        for value in (first, answer):
            if isinstance(value, dict):
                value.pop("sequenceNumber", None)
                if "safety" in value:
                    value["safety"].pop("sequenceNumber")
        assert first == answer, path


def test_sockets_need_the_login_that_a_get_needs(fr3):
    _, desk = fr3

    async def status(path, headers):
        try:
            async with socket(desk, path, headers):
                return 101
        except aiohttp.WSServerHandshakeError as error:
            return error.status

    word = desk.log_in()["Cookie"].removeprefix("authorization=")
    for headers, expected in (
        ({"X-None": "1"}, 401),
        ({"Cookie": "authorization=None"}, 401),
        ({"authorization": word}, 101),
        ({"Cookie": f"authorization={word}"}, 101),
        (login(), 101),
    ):
        assert run(status(EVENTS, headers)) == expected
        assert run(status(SAFETY, headers)) == 101
    wrong = base64.b64encode(f"{USER}:not {PASSWORD}".encode()).decode()
    assert run(status(SAFETY, {"Authorization": f"Basic {wrong}"})) == 401


def test_button_events_are_reported_once_and_alone(fr3):
    robot, desk = fr3

    async def listen(opened):
        assert await following(opened) == dict.fromkeys(BUTTONS, False)
        robot.report["buttons"]["circle"] = True
        assert await following(opened) == {"circle": True}
        robot.report["buttons"].update(circle=False, cross=True)
        assert await following(opened) == {"circle": False, "cross": True}

    on_socket(desk, EVENTS, listen)


def test_control_is_granted_before_the_circle_button_is_reported(fr3):
    robot, desk = fr3
    cookie = desk.log_in()
    desk.take_control("me", **cookie)
    forced = desk.take_control("you", "?force", **cookie)

    async def listen(opened):
        await following(opened)
        robot.report["buttons"]["circle"] = True
        assert (await following(opened))["circle"]

    on_socket(desk, EVENTS, listen)
    assert desk.send("GET", TOKEN).json()["activeToken"]["id"] == forced["id"]


def test_states_are_sent_on_change_and_once_a_second(fr3):
    robot, desk = fr3

    async def listen(opened):
        first = await following(opened)
        assert first["brakeState"] == ["Locked"] * 7
        await asyncio.to_thread(desk.advance, 0.9)
        robot.report["brakes"] = OPEN
        await asyncio.to_thread(desk.refresh)
        changed = await following(opened)  # and no message before it
        assert changed["brakeState"] == ["Unlocked"] * 7 and changed["stoState"] == "SafeTorqueOn"
        await asyncio.to_thread(desk.advance, 1.2)
        again = await following(opened)
        assert again["sequenceNumber"] > changed["sequenceNumber"]
        assert again["brakeState"] == changed["brakeState"]

    with desk.stopped_clock():
        on_socket(desk, SAFETY, listen)


def test_control_is_sent_on_change(fr3):
    _, desk = fr3

    async def listen(opened):
        assert (await following(opened))["activeToken"] is None
        work = asyncio.get_running_loop().run_in_executor(None, lambda: desk.take_control("me"))
        value = await until(opened, lambda value: value["activeToken"])
        assert value["activeToken"]["ownedBy"] == "me"
        await work

    on_socket(desk, TOKEN, listen)


def test_the_configuration_comes_ten_times_a_second(fr3):
    robot, desk = fr3

    async def listen(opened):
        await following(opened)
        for q in (0.1, 0.2, 0.3, 0.4):
            robot.report["q"][0] = q
            await asyncio.to_thread(desk.refresh)
            await asyncio.to_thread(desk.advance, 0.11)
            assert (await following(opened))["jointAngles"][0] == q  # and no message before it

    with desk.stopped_clock():
        on_socket(desk, CONFIGURATION, listen)


def test_pings_are_answered_and_messages_ignored(fr3):
    _, desk = fr3

    async def talk(opened):
        await opened.send_str("{nonsense")
        await opened.send_bytes(b"\xff" * 100)
        await opened.ping(b"still there?")
        message = await asyncio.wait_for(opened.receive(), LIMIT)
        while message.type is not aiohttp.WSMsgType.PONG:
            assert message.type is aiohttp.WSMsgType.TEXT
            message = await asyncio.wait_for(opened.receive(), LIMIT)
        assert message.data == b"still there?"

    on_socket(desk, SAFETY, talk, autoping=False)


def test_a_long_message_ends_its_socket_only(fr3):
    _, desk = fr3

    async def talk(opened):
        await following(opened)
        await opened.send_str("x" * 10000)
        message = await asyncio.wait_for(opened.receive(), LIMIT)
        assert message.type in (aiohttp.WSMsgType.CLOSE, aiohttp.WSMsgType.CLOSED)

    on_socket(desk, EVENTS, talk)
    assert desk.send("GET", EVENTS, **basic()).status == 200


def test_sockets_of_an_address_are_limited(tmp_path):
    limits = Limits(sockets_of_address=3, rate=LIMITS.rate)
    with desk_with_robot(tmp_path, limits=limits) as (_, desk):

        async def talk():
            async with contextlib.AsyncExitStack() as stack:
                for _ in range(3):
                    await following(await stack.enter_async_context(socket(desk, SAFETY)))
                with pytest.raises(aiohttp.WSServerHandshakeError) as refused:
                    await stack.enter_async_context(socket(desk, SAFETY))
                assert refused.value.status == 429
            async with socket(desk, SAFETY) as opened:
                await following(opened)

        run(talk())


def test_sockets_without_a_login_do_not_take_the_places_of_users(tmp_path):
    limits = dataclasses.replace(LIMITS, sockets=2, sockets_without_login=3)
    with desk_with_robot(tmp_path, limits=limits) as (_, desk):

        async def talk():
            async with contextlib.AsyncExitStack() as stack:
                for headers, places in (({"X-None": "1"}, 3), (login(), 2)):
                    for _ in range(places):
                        await following(await stack.enter_async_context(socket(desk, SAFETY, headers)))
                    with pytest.raises(aiohttp.WSServerHandshakeError) as refused:
                        await stack.enter_async_context(socket(desk, SAFETY, headers))
                    assert refused.value.status == 429

        run(talk())


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


def test_events_of_the_newer_interface_are_a_stream(fr3):
    _, desk = fr3
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


def listens(desk):
    desk.close_connection()
    try:
        return desk.send("GET", "/admin/api/startup-phase").status == 200
    except OSError:
        return False
    finally:
        desk.close_connection()


REBOOTS = [("/admin/api/reboot", 200), ("/desk/api/reboot", 200), ("/api/system:reboot", 204)]


@pytest.mark.parametrize("path, status", REBOOTS)
def test_a_reboot_answers_and_goes_away_and_comes_back_without_logins(fr3, path, status):
    robot, desk = fr3
    cookie = desk.log_in()
    desk.take_control(**cookie)

    async def close_of_socket(opened):
        call = asyncio.get_running_loop().run_in_executor(None, reboot)
        async for _ in opened:
            pass
        return await call

    def reboot():
        assert desk.send("POST", path).status == 401
        return desk.send("POST", path, **basic())

    answer = on_socket(desk, SAFETY, close_of_socket)
    assert (answer.status, answer.body) == (status, b"")
    wait_for(lambda: not listens(desk))
    wait_for(lambda: robot.lines == ["power off"])
    desk.advance(desk.desk.profile.boot)
    wait_for(lambda: listens(desk))
    assert robot.lines == ["power off", "power on"]
    assert desk.send("GET", CONFIGURATION, **cookie).status == 401
    assert desk.send("GET", TOKEN).json()["activeToken"] is None
    assert desk.log_in()


def test_after_a_shutdown_the_robot_comes_back_with_its_power(fr3):
    robot, desk = fr3
    assert desk.send("POST", "/admin/api/shutdown", {"token": "x"}, **basic()).status == 200
    wait_for(lambda: not listens(desk) and robot.lines == ["power off"])
    desk.advance(2 * desk.desk.profile.boot)
    assert not listens(desk) and robot.lines == ["power off"]
    robot.report["power"] = True
    wait_for(lambda: listens(desk))


def test_desk_is_unreachable_while_the_robot_is_off(fr3):
    robot, desk = fr3
    robot.report["power"] = False
    wait_for(lambda: not listens(desk))
    robot.report["power"] = True
    wait_for(lambda: listens(desk))


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


@pytest.mark.parametrize("answer", BAD_REPORTS, ids=lambda answer: answer[:20])
def test_a_report_that_cannot_be_read_is_an_error_with_a_sentence(fr3, answer):
    robot, desk = fr3
    robot.raw_report = answer
    wait_for(lambda: desk.send("GET", TOKEN).status == 503)
    message = desk.send("GET", TOKEN).json()["message"]
    assert message.endswith(".") and "robot" in message or "control interface" in message
    robot.raw_report = None
    wait_for(lambda: desk.send("GET", TOKEN).status == 200)


def test_lost_robot_is_reported_and_found_again(fr3):
    robot, desk = fr3
    robot.stop()
    wait_for(lambda: desk.send("GET", TOKEN).status == 503)
    assert "127.0.0.1" in desk.send("GET", TOKEN).json()["message"]
    assert desk.send("POST", "/desk/api/joints/lock", **basic()).status == 503
    robot.start()
    wait_for(lambda: desk.send("GET", TOKEN).status == 200)
