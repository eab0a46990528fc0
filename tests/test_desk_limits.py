# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""How many requests, connections and logins Desk serves, whose, and what reaches the robot."""

import asyncio
import contextlib
import dataclasses
import http.client
import socket
import ssl
from functools import partial

import pytest
from desk_server import LIMITS as ANY_NUMBER
from desk_server import USER, SteppedLoop, basic, unverified
from pyfranka.desk import Limits, Options, Settings
from pyfranka.desk.addresses import network_of, place_of, url_of
from pyfranka.desk.errors import DeskError
from pyfranka.desk.login_throttle import LOGIN_RATE, LoginThrottle
from pyfranka.desk.sessions import User
from pyfranka.desk.throttle import Throttle
from scripted_desk import desk_with_robot
from waiting import wait_for

pytest_plugins = ["desk_fixtures"]

CONFIGURATION = "/api/configuration"
DEADLINE = 60.0  # [s]


# ---- rates and passwords ---------------------------------------------------------------------------------


def on_stopped_clock(work):
    """Runs the coroutine function with a loop whose clock is stopped."""
    with contextlib.closing(SteppedLoop()) as loop:
        loop.stop_clock()
        loop.run_until_complete(work(loop))


def test_uses_above_the_rate_wait_for_their_turn():
    async def crowd(loop):
        throttle = Throttle(rate=2.0, burst=2.0, waiting=3)
        delays = [throttle.use("a") for _ in range(5)]
        assert delays == [0.0, 0.0, 0.5, 1.0, 1.5]
        waits = [loop.create_task(throttle.wait("a", delay)) for delay in delays[2:]]
        await asyncio.wait(waits, timeout=0)  # all of them have begun
        with pytest.raises(DeskError) as refused:
            await throttle.wait("a", throttle.use("a"))
        assert refused.value.status == 429
        assert throttle.use("b") == 0.0  # others are not concerned
        loop.ahead += 1.0
        await asyncio.gather(*waits[:2])
        assert not waits[2].done()
        loop.ahead += 0.5
        await waits[2]
        assert throttle.delay("a") == pytest.approx(0.5)  # the refused use has not been counted

    on_stopped_clock(crowd)


# Logins one after the other: how many, address, name, whether with the right password, and how many of them
# are compared at once. Three wrong ones of an address are free, five of a user and eight in all.
LOGINS = {
    "one address": [(10, "a", "user {}", False, 3), (1, "b", "anna", True, 1)],
    "one address, later": [(10, "a", "user {}", False, 3), None, (10, "a", "user {}", False, 1)],
    "one user": [
        (7, "address {}", "anna", False, 5),
        (1, "another address", "anna", True, 0),  # the right one waits too
        (1, "another address", "bert", False, 1),
    ],
    "in all": [(20, "address {}", "user {}", False, 8)],
    "user at a known address": [
        (1, "home", "anna", True, 1),
        (20, "address {}", "anna", False, 5),
        (1, "home", "anna", True, 1),
        (10, "home", "anna", False, 3),
    ],
}


@pytest.mark.parametrize("steps", LOGINS.values(), ids=LOGINS)
def test_wrong_passwords_are_limited(steps):
    limits = Limits(waiting=0, wrong_logins=3, wrong_logins_of_user=5, wrong_logins_of_all=8)

    async def guess(loop):
        throttle = LoginThrottle(limits)
        for step in steps:
            if step is None:
                loop.ahead += 1.0 / LOGIN_RATE
                continue
            count, address, name, is_right, expected = step
            users, compared = {name: User(name, "")} if is_right else {}, 0
            for k in range(count):
                with contextlib.suppress(DeskError):
                    await throttle.compare(address.format(k), name.format(k), partial(users.get, name))
                    compared += 1
            assert compared == expected, step

    on_stopped_clock(guess)


def test_too_many_requests_and_wrong_passwords_have_to_wait(tmp_path):
    limits = Limits(rate=10.0, waiting=0, wrong_logins=3)
    with desk_with_robot(tmp_path, limits=limits) as (_, desk):
        with desk.stopped_clock():
            statuses = [desk.send("GET", "/api/system").status for _ in range(11)]
            assert statuses == [200] * 10 + [429]
            desk.advance(1.0)
            wrong = {"login": USER, "password": "eA=="}
            statuses = [desk.send("POST", "/admin/api/login", wrong).status for _ in range(4)]
            assert statuses == [401] * 3 + [429]
            # The right password waits too.
            assert desk.send("GET", CONFIGURATION, **basic()).status == 429
            desk.advance(1.0 / LOGIN_RATE)
            assert desk.send("GET", CONFIGURATION, **basic()).status == 200


# ---- addresses and connections ---------------------------------------------------------------------------


@pytest.mark.parametrize(
    "one, other, same",
    [
        ("127.0.0.1", "127.0.0.2", False),
        ("2001:db8:1:2::1", "2001:db8:1:2:ffff::2", True),
        ("2001:db8:1:2::1", "2001:db8:1:3::1", False),
        ("::ffff:127.0.0.1", "127.0.0.1", True),
        ("::ffff:127.0.0.1", "::ffff:127.0.0.2", False),
        ("fe80::1%eth0", "fe80::2", True),
        ("no address", "127.0.0.1", False),
    ],
)
def test_addresses_of_one_ipv6_network_count_as_one(one, other, same):
    assert (network_of((one, 1234)) == network_of((other, 1234))) == same


PLACES = [
    ("127.0.0.1", ("127.0.0.1", 99)),
    ("127.0.0.1:8443", ("127.0.0.1", 8443)),
    ("robot.local:0", ("robot.local", 0)),
    ("::1", ("::1", 99)),
    ("[::1]", ("::1", 99)),
    ("[::1]:8443", ("::1", 8443)),
    ("[fe80::1%eth0]:8443", ("fe80::1%eth0", 8443)),
]
NO_PLACES = ["", ":1", "a:", "a:b", "a:65536", "a:" + "1" * 5000, "a:\u0663"]
NO_PLACES += ["[::1", "[::1]8443", "[::1]:", "[]:1", "[a]:1", "[::1]:x"]


@pytest.mark.parametrize("word, place", PLACES + [(word, None) for word in NO_PLACES])
def test_place_is_an_address_with_a_port(word, place):
    with contextlib.nullcontext() if place else pytest.raises(ValueError, match=r"\.$"):
        assert place_of(word, 99) == place


@pytest.mark.parametrize(
    "address, url",
    [
        ("127.0.0.1", "https://127.0.0.1:8443"),
        ("::1", "https://[::1]:8443"),
        ("fe80::1%eth0", "https://[fe80::1%25eth0]:8443"),
    ],
)
def test_url_has_ipv6_addresses_in_brackets(address, url):
    assert url_of(address, 8443) == url


def test_connections_of_an_address_are_limited_and_silent_ones_end(tmp_path):
    limits = dataclasses.replace(ANY_NUMBER, connections_of_address=8)
    with desk_with_robot(tmp_path, limits=limits) as (_, desk), contextlib.ExitStack() as stack:
        kept = []
        for _ in range(limits.connections_of_address):
            plain = socket.create_connection(("127.0.0.1", desk.port), timeout=DEADLINE)
            kept.append(stack.enter_context(unverified().wrap_socket(plain)))
        with pytest.raises((OSError, http.client.HTTPException)):
            desk.send("GET", "/api/system")
        desk.advance(limits.request_time)
        for each in kept:  # they have sent nothing
            with contextlib.suppress(ConnectionError, ssl.SSLError):
                assert each.recv(1) == b""
            each.close()

        def answers():
            desk.close_connection()
            with contextlib.suppress(OSError, http.client.HTTPException):
                return desk.send("GET", "/api/system").status == 200

        wait_for(answers, "An answer")


# ---- what reaches the robot ------------------------------------------------------------------------------


def test_requests_that_read_never_reach_the_robot(desk, robot, cookie):
    with desk.stopped_clock():  # the robot is asked for the report that is due, if any, and for no other
        reports = robot.reports
        paths = ("/admin/api/control-token", "/api/arm/joints", "/desk/api/robot/configuration")
        for k in range(300):
            assert desk.send("GET", paths[k % len(paths)], **cookie).status == 200
        assert robot.lines == [] and robot.reports <= reports + 1


@contextlib.contextmanager
def unanswered(desk, robot, *words):
    """Within it, the robot does not answer lines that begin with these words. Yields a function that sends a
    line; in the end, all lines have been answered."""
    answered, sent = asyncio.Event(), []

    async def answer(*words):
        await answered.wait()
        return "ok"

    def send(line, urgent=False):
        sent.append(asyncio.run_coroutine_threadsafe(desk.desk.robot.send(line, urgent), desk.loop))

    robot.answers |= dict.fromkeys(words, answer)
    try:
        yield send
    finally:
        robot.call(answered.set)
    for each in sent:
        each.result(DEADLINE)


def test_equal_simultaneous_lines_are_sent_once_and_the_last_one_decides(desk, robot):
    words = ["unlock", "lock", "unlock"]
    with unanswered(desk, robot, "joints") as send:
        for count, word in enumerate(words, start=1):
            for _ in range(4):
                send(f"joints {word}")
            wait_for(lambda count=count: len(robot.lines) >= count, word)
    assert robot.lines == [f"joints {word}" for word in words]


def test_urgent_line_does_not_wait_with_an_equal_one(desk, robot):
    with unanswered(desk, robot, "move", "hand", "recover") as send:
        for line in ("move pack", "hand homing", "recover"):  # as many as may run at a time
            send(line)
        wait_for(lambda: len(robot.lines) == 3)
        send("fci off")
        send("fci off", urgent=True)
        wait_for(lambda: "fci off" in robot.lines, "The urgent line")


# ---- other sites -----------------------------------------------------------------------------------------

OTHER_ORIGINS = [
    {"Origin": "https://evil.example"},
    {"Origin": "null"},
    {"Sec_Fetch_Site": "cross-site"},
    {"Sec_Fetch_Site": "same-site"},
]
CHANGES = [
    ("POST", "/desk/api/joints/lock"),
    ("POST", "/admin/api/reboot"),
    ("POST", "/admin/api/login"),
    ("POST", "/admin/api/control-token/request"),
    ("PATCH", CONFIGURATION),
    ("POST", "/page/command"),
    ("POST", "/page/control"),
    ("POST", "/page/login"),
    ("POST", "/page/logout"),
]


@pytest.mark.parametrize("header", OTHER_ORIGINS, ids=str)
def test_requests_of_another_origin_are_refused(desk, robot, control, header):
    upgrade = {"Connection": "Upgrade", "Upgrade": "websocket", "Sec_WebSocket_Version": "13"}
    upgrade["Sec_WebSocket_Key"] = "MDEyMzQ1Njc4OWFiY2RlZg=="
    answers = [desk.send(method, path, {}, **control, **header) for method, path in CHANGES]
    answers.append(desk.send("GET", "/admin/api/control-token", **upgrade, **header))
    assert [answer.status for answer in answers] == [403] * len(answers)
    assert robot.lines == []


def test_requests_of_the_same_origin_are_accepted(desk, control):
    own = {"Origin": f"https://127.0.0.1:{desk.port}", "Sec_Fetch_Site": "same-origin"}
    assert desk.send("POST", "/desk/api/joints/lock", **control, **own).status == 200


# ---- users -----------------------------------------------------------------------------------------------


def test_roles_limit_permissions_and_a_new_password_ends_the_logins_of_its_user(tmp_path):
    with desk_with_robot(tmp_path) as (_, desk):
        cookie = desk.log_in()
        users = [
            {"name": USER, "role": "Admin"},
            {"name": "operator", "password": "o", "role": "Operator"},
            {"name": "safety", "password": "s", "role": "SafetyOperator"},
        ]
        change = {"userConfiguration": {"users": users}}
        assert desk.send("PATCH", CONFIGURATION, change, **basic()).status == 204
        shown = desk.send("GET", CONFIGURATION, **cookie).json()["userConfiguration"]["users"]
        assert [set(user) for user in shown] == [{"name", "role"}] * 3
        for name, word, confirming in (("operator", "o", 403), ("safety", "s", 424)):
            user = basic(name, word)
            assert desk.send("GET", CONFIGURATION, **user).status == 200
            assert desk.send("PATCH", CONFIGURATION, {}, **user).status == 403
            assert desk.send("POST", "/api/safety/recovery:confirm", **user).status == confirming

        users[0]["password"] = "another one"
        assert desk.send("PATCH", CONFIGURATION, change, **basic()).status == 204
        for headers in (cookie, basic()):
            assert desk.send("GET", CONFIGURATION, **headers).status == 401
        assert desk.send("GET", CONFIGURATION, **basic(password="another one")).status == 200


def test_there_is_no_desk_without_a_password():
    with pytest.raises(ValueError, match="password"):
        Settings("")


@pytest.mark.parametrize(
    "word",
    ["release-status=300", "nothing=1", "token-id", "token-id=maybe", "boot-time=nan", "force-timeout=0"],
)
def test_invalid_options_are_refused_with_a_message(word):
    with pytest.raises(ValueError, match=r"\.$"):
        Options.of([word])
