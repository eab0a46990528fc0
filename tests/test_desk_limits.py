# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""What Desk does with requests that are malformed, too large, too many, or made by another site's page."""

import asyncio
import contextlib
import dataclasses
import http.client
import json
import re
import socket
import ssl
from random import Random

import pytest
from desk_fixtures import desk_with_robot
from desk_server import LIMITS as ANY_NUMBER
from desk_server import PASSWORD, USER, SteppedLoop, basic, unverified
from pyfranka.desk import Limits, Options, Settings
from pyfranka.desk.addresses import network_of, place_of, url_of
from pyfranka.desk.errors import DeskError
from pyfranka.desk.login_throttle import LOGIN_RATE, LoginThrottle
from pyfranka.desk.server import LINGER, ROUTES
from pyfranka.desk.sessions import User, digest_of
from pyfranka.desk.throttle import Throttle
from pyfranka.desk.v1 import ROUTES as V1_ROUTES
from waiting import wait_for

CONFIGURATION = "/api/configuration"
LIMITS = dataclasses.replace(ANY_NUMBER, connections_of_address=8)
DEADLINE = 60.0  # [s]


@pytest.fixture(scope="module")
def desk(tmp_path_factory):
    with desk_with_robot(tmp_path_factory.mktemp("certificates"), limits=LIMITS) as (_, desk):
        yield desk


@pytest.fixture
def control(desk):
    desk.clear()
    headers = desk.log_in()
    return {**headers, "X_Control_Token": desk.take_control(**headers)["token"]}


def is_refused(answer, *statuses):
    message = answer.json()["message"]
    return answer.status in statuses and message[0].isupper() and message.endswith(".")


def raw(desk, data, silence=LIMITS.request_time):
    """Sends bytes as they are, then nothing for some time [s]. @returns all bytes of the answer."""
    with socket.create_connection(("127.0.0.1", desk.port), timeout=DEADLINE) as plain:
        plain.setsockopt(
            socket.IPPROTO_TCP, socket.TCP_NODELAY, 1
        )  # the data go at once, as the clock is fast
        with unverified().wrap_socket(plain) as secure:
            secure.sendall(data)
            desk.advance(silence)
            received = b""
            with contextlib.suppress(ConnectionError, ssl.SSLError):
                while part := secure.recv(65536):
                    received += part
            return received


def alive(desk):
    return desk.send("GET", "/api/system").status == 200


# ---- bodies ----------------------------------------------------------------------------------------------

WITH_BODIES = [
    ("POST", "/admin/api/login"),
    ("POST", "/admin/api/control-token/request"),
    ("DELETE", "/admin/api/control-token"),
    ("POST", "/admin/api/control-token/fci"),
    ("POST", "/admin/api/end-effector/profiles"),
    ("PUT", "/admin/api/end-effector/profiles/active"),
    ("POST", "/api/system/control-token:take"),
    ("POST", "/api/system/operating-mode:change"),
    ("POST", "/api/arm/motion:start"),
    ("POST", "/api/safety/recovery:confirm"),
    ("PATCH", CONFIGURATION),
    ("PUT", "/api/configuration/arm-mounting"),
]
BROKEN = [
    b"{",
    b'{"login": ',
    b"\xff\xfe",
    b"[1,",
    b"NaN",
    b'{"owner": NaN}',
    b"[" * 20000,
    b'{"a":' * 5000,
    b"1" * 9000,
    b'"\\ud800"',
    b"null",
    b"[]",
    b"7",
    b'{"token": 7, "owner": 7, "requestedBy": [], "type": {}, "login": {}, "password": 1}',
]


@pytest.mark.parametrize("body", BROKEN, ids=lambda body: body[:20].decode(errors="replace"))
def test_broken_bodies_are_refused_with_a_sentence(desk, control, body):
    for method, path in WITH_BODIES:
        answer = desk.send(method, path, body, **control)
        assert is_refused(answer, 400, 404), (method, path, answer)
    assert alive(desk)


INERTIA = {"x11": 0.01, "x12": 0, "x13": 0, "x22": 0.01, "x23": 0, "x33": 0.01}
PLACE, ANGLES = {"x": 0, "y": 0, "z": 0}, {"roll": 0, "pitch": 0, "yaw": 0}
TCP = {"translation": PLACE, "rotation": ANGLES}
INERTIAL = {"mass": 1.0, "centerOfMass": PLACE, "inertia": INERTIA}
BODIES = [
    {"name": "tool", "deviceId": "ee-no-gripper", "modelUri": None, "inertial": INERTIAL, "tcp": TCP},
    {"endEffectorConfiguration": {"endEffector": {"name": "Other", "params": {**INERTIAL, "tcp": TCP}}}},
    {"networkConfiguration": {"robot": {"network": {}}, "shopFloor": {"type": "Static"}}},
    {"userConfiguration": {"users": [{"name": "a", "password": "b", "role": "Operator"}]}},
    {"owner": "me", "timeout": 0.001, "type": "SafetyError", "requestedBy": "me", "token": "x"},
]
VALUES = [None, True, 0, -1, 1e308, 10**400, "", "x", "\ud800", "a" * 300, "\x00", [], {}, [{}], {"a": 1}]


def changed(value, random):
    """Some of its parts are others, or missing."""
    if random.random() < 0.2:
        return random.choice(VALUES)
    if isinstance(value, dict):
        kept = [name for name in value if random.random() > 0.05]
        return {name: changed(value[name], random) for name in kept}
    return [changed(each, random) for each in value] if isinstance(value, list) else value


def test_random_bodies_never_cause_an_internal_error(desk, control):
    random = Random(1)
    routes = [route for route in ROUTES.routes if route.method != "GET" and route.where(desk.desk.profile)]
    routes = [route for route in routes if not re.search(r"reboot|shutdown|logout|:take", route.path)]
    for k in range(600):
        route, body = routes[k % len(routes)], changed(random.choice(BODIES), random)
        path = re.sub(r"<\w+>", random.choice(["1", "ee-franka-hand", "%00", "%C2%B2"]), route.path)
        data = json.dumps(body).encode() if k % 5 else b"mode=" + json.dumps(body).encode()
        token = desk.desk.tokens.active
        headers = {**basic(), "X_Control_Token": token.token if token else "x"}
        answer = desk.send(route.method, path, data, **headers)
        assert answer.status < 500, (route.method, path, body, answer)
        assert answer.status < 400 or is_refused(answer, answer.status), answer
        if token is None:
            desk.take_control(**basic())


@pytest.mark.parametrize(
    "change",
    [
        {"endEffectorConfiguration": 1},
        {"endEffectorConfiguration": {"endEffector": {"name": "Hammer"}}},
        {"endEffectorConfiguration": {"endEffector": {"name": "Other", "params": {"mass": 1}}}},
        {"networkConfiguration": {"shopFloor": {"type": "Token ring"}}},
        {"networkConfiguration": {"robot": 1}},
        {"userConfiguration": {"users": []}},
        {"userConfiguration": {"users": [{"name": "a:b", "password": "x", "role": "Admin"}]}},
        {"userConfiguration": {"users": [{"name": "a", "password": "x", "role": "SafetyOperator"}]}},
        {"userConfiguration": {"users": [{"name": "a", "password": "", "role": "Admin"}]}},
        {"userConfiguration": {"users": [{"name": "a", "password": "x", "role": "Admin"}] * 2}},
        {"somethingElse": {}},
    ],
)
def test_invalid_configuration_changes_nothing(desk, change):
    before = desk.send("GET", CONFIGURATION, **basic()).json()
    assert is_refused(desk.send("PATCH", CONFIGURATION, change, **basic()), 400)
    assert desk.send("GET", CONFIGURATION, **basic()).json() == before


@pytest.mark.parametrize(
    "change",
    [
        {"mass": -1.0},
        {"mass": 3.1},
        {"mass": "heavy"},
        {"mass": True},
        {"centerOfMass": {"x": 0.31, "y": 0.0, "z": 0.0}},
        {"centerOfMass": {"x": 0.0, "y": 0.0}},
        {"inertia": dict.fromkeys(("x11", "x12", "x13", "x22", "x23", "x33"), 0.0)},
        {"inertia": {"x11": 1.1, "x12": 0, "x13": 0, "x22": 1, "x23": 0, "x33": 1}},
    ],
)
def test_impossible_end_effectors_are_refused(desk, change):
    body = {"name": "tool", "inertial": {**INERTIAL, **change}, "tcp": TCP}
    assert is_refused(desk.send("POST", "/admin/api/end-effector/profiles", body, **basic()), 400)


def test_an_empty_body_with_a_type_is_no_error(desk, control):
    for kind in ("application/json", "application/x-www-form-urlencoded"):
        for path in ("/desk/api/joints/lock", "/api/arm/joints:lock", "/api/safety/self-tests:execute"):
            answer = desk.send("POST", path, b"", **control, Content_Type=kind)
            assert answer.status in (200, 204), answer


def test_large_bodies_are_refused_whether_their_length_is_given_or_not(desk):
    large = b'{"login": "' + b"x" * LIMITS.body + b'"}'
    assert is_refused(desk.send("POST", "/admin/api/login", large), 413)
    desk.close_connection()
    head = b"POST /admin/api/login HTTP/1.1\r\nHost: a\r\nConnection: close\r\n"
    head += b"Transfer-Encoding: chunked\r\n\r\n"
    chunks = b"".join(b"8000\r\n" + b"x" * 0x8000 + b"\r\n" for _ in range(3)) + b"0\r\n\r\n"
    assert b" 413 " in raw(desk, head + chunks, silence=0.0).partition(b"\r\n")[0]
    assert alive(desk)


def test_truncated_bodies_end_their_connection_only(desk):
    head = b"POST /admin/api/login HTTP/1.1\r\nHost: a\r\nContent-Length: 500\r\n\r\n{"
    assert b" 408 " in raw(desk, head, silence=LIMITS.body_time + 2 * LINGER).partition(b"\r\n")[0]
    with socket.create_connection(("127.0.0.1", desk.port)) as plain:
        with unverified().wrap_socket(plain) as secure:
            secure.sendall(head)
    assert alive(desk)


@pytest.mark.parametrize(
    "data",
    [
        b"\r\n\r\n",
        b"GARBAGE\r\n\r\n",
        b"GET / HTTP/x\r\n\r\n",
        b"GET /" + b"a" * 20000 + b" HTTP/1.1\r\n\r\n",
        b"GET / HTTP/1.1\r\nA: " + b"a" * 20000 + b"\r\n\r\n",
        b"POST /admin/api/login HTTP/1.1\r\nHost: a\r\nContent-Length: -1\r\n\r\n",
        b"POST /admin/api/login HTTP/1.1\r\nHost: a\r\nContent-Length: x\r\n\r\n",
        b"GET /%ff%00%0d%0a HTTP/1.1\r\nHost: a\r\nConnection: close\r\n\r\n",
        b"GET /desk/api/../../etc/passwd HTTP/1.1\r\nHost: a\r\nConnection: close\r\n\r\n",
        b"GET /robots/999/api/system HTTP/1.1\r\nHost: a\r\nConnection: close\r\n\r\n",
        b"\x00" * 1000,
    ],
)
def test_garbage_does_not_end_desk(desk, data):
    first = raw(desk, data).partition(b"\r\n")[0]
    assert not first or re.match(rb"HTTP/1.[01] 4\d\d ", first)
    assert alive(desk)


def test_html_of_errors_is_escaped(desk):
    answer = desk.send("GET", "/desk/api/%3Cscript%3Ealert(1)%3C/script%3E")
    assert answer.status == 404 and "<script>" not in answer.text and "&lt;script&gt;" in answer.text
    assert answer.headers["X-Content-Type-Options"] == "nosniff"


# ---- many of them ----------------------------------------------------------------------------------------


def test_uses_above_the_rate_wait_for_their_turn():
    async def crowd():
        loop, throttle = asyncio.get_running_loop(), Throttle(rate=2.0, burst=2.0, waiting=3)
        loop.stop_clock()
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

    with contextlib.closing(SteppedLoop()) as loop:
        loop.run_until_complete(crowd())


NO_WAITING = Limits(waiting=0, wrong_logins=3, wrong_logins_of_user=5, wrong_logins_of_all=8)
ANNA = User("anna", "")


def answered(statuses):
    """How many of these logins were compared at once."""
    return sum(status != 429 for status in statuses)


def throttled(work):
    """Runs the coroutine function with a throttle and a function that logs in, on a stopped clock."""

    async def run():
        loop, throttle = asyncio.get_running_loop(), LoginThrottle(NO_WAITING)
        loop.stop_clock()

        async def log_in(address, name, user=None):
            try:
                return 401 if await throttle.compare(address, name, lambda: user) is None else 200
            except DeskError as error:
                return error.status

        await work(loop, log_in)

    with contextlib.closing(SteppedLoop()) as loop:
        loop.run_until_complete(run())


def test_wrong_passwords_are_limited_for_one_address():
    async def guess(loop, log_in):
        assert answered([await log_in("a", f"user {k}") for k in range(10)]) == 3
        assert await log_in("b", "anna", ANNA) == 200
        loop.ahead += 1.0 / LOGIN_RATE
        assert answered([await log_in("a", f"user {k}") for k in range(10)]) == 1

    throttled(guess)


def test_wrong_passwords_are_limited_for_one_user():
    async def guess(loop, log_in):
        assert answered([await log_in(f"address {k}", "anna") for k in range(7)]) == 5
        assert await log_in("another address", "anna", ANNA) == 429  # the right one waits too
        assert await log_in("another address", "bert") == 401

    throttled(guess)


def test_wrong_passwords_are_limited_in_all():
    async def guess(loop, log_in):
        assert answered([await log_in(f"address {k}", f"user {k}") for k in range(20)]) == 8

    throttled(guess)


def test_wrong_passwords_of_others_do_not_lock_out_a_user_at_a_known_address():
    async def guess(loop, log_in):
        assert await log_in("home", "anna", ANNA) == 200
        for k in range(20):
            await log_in(f"address {k}", "anna")
        assert await log_in("home", "anna", ANNA) == 200
        assert answered([await log_in("home", "anna") for _ in range(10)]) == 3  # its own count

    throttled(guess)


@pytest.mark.parametrize(
    "peers, same",
    [
        (["127.0.0.1", "127.0.0.2"], False),
        (["2001:db8:1:2::1", "2001:db8:1:2:ffff::2"], True),
        (["2001:db8:1:2::1", "2001:db8:1:3::1"], False),
        (["::ffff:127.0.0.1", "127.0.0.1"], True),
        (["::ffff:127.0.0.1", "::ffff:127.0.0.2"], False),
        (["fe80::1%eth0", "fe80::2"], True),
        (["no address", "127.0.0.1"], False),
    ],
)
def test_addresses_of_one_ipv6_network_count_as_one(peers, same):
    one, other = (network_of((peer, 1234)) for peer in peers)
    assert (one == other) == same


PLACES = [
    ("127.0.0.1", ("127.0.0.1", 99)),
    ("127.0.0.1:8443", ("127.0.0.1", 8443)),
    ("robot.local:0", ("robot.local", 0)),
    ("::1", ("::1", 99)),
    ("[::1]", ("::1", 99)),
    ("[::1]:8443", ("::1", 8443)),
    ("[fe80::1%eth0]:8443", ("fe80::1%eth0", 8443)),
    *((word, None) for word in ("", ":1", "a:", "a:b", "a:65536", "a:" + "1" * 5000, "a:\u0663")),
    *((word, None) for word in ("[::1", "[::1]8443", "[::1]:", "[]:1", "[a]:1", "[::1]:x")),
]


@pytest.mark.parametrize("word, place", PLACES, ids=lambda each: str(each)[:20])
def test_place_is_an_address_with_a_port(word, place):
    if place is None:
        with pytest.raises(ValueError, match=r"\.$"):
            place_of(word, 99)
    else:
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


def test_requests_that_read_never_reach_the_robot(tmp_path):
    with desk_with_robot(tmp_path) as (robot, desk):
        headers = desk.log_in()
        with desk.stopped_clock():  # the robot is asked for the report that is due, if any, and for no other
            reports = robot.reports
            paths = ("/admin/api/control-token", "/api/arm/joints", "/desk/api/robot/configuration")
            for k in range(300):
                assert desk.send("GET", paths[k % len(paths)], **headers).status == 200
            assert robot.lines == [] and robot.reports <= reports + 1


def test_equal_simultaneous_lines_are_sent_once_and_the_last_one_decides(tmp_path):
    words, answered = ["unlock", "lock", "unlock"], asyncio.Event()

    async def answer(*words):
        await answered.wait()
        return "ok"

    with desk_with_robot(tmp_path) as (robot, desk):
        robot.answers["joints"] = answer
        sent, send = [], desk.desk.robot.send
        for count, word in enumerate(words, start=1):
            tasks = [send(f"joints {word}") for _ in range(4)]
            sent += [asyncio.run_coroutine_threadsafe(task, desk.loop) for task in tasks]
            wait_for(lambda count=count: len(robot.lines) >= count, word)
        robot.call(answered.set)
        for each in sent:
            each.result(DEADLINE)
        assert robot.lines == [f"joints {word}" for word in words]


def test_urgent_line_does_not_wait_with_an_equal_one(tmp_path):
    answered = asyncio.Event()

    async def answer(*words):
        await answered.wait()
        return "ok"

    with desk_with_robot(tmp_path) as (robot, desk):
        robot.answers |= {"move": answer, "hand": answer, "recover": answer}
        sent, send = [], desk.desk.robot.send

        def begin(line, urgent=False):
            sent.append(asyncio.run_coroutine_threadsafe(send(line, urgent), desk.loop))

        for line in ("move pack", "hand homing", "recover"):  # as many as may run at a time
            begin(line)
        wait_for(lambda: len(robot.lines) == 3)
        begin("fci off")
        begin("fci off", urgent=True)
        wait_for(lambda: "fci off" in robot.lines, "The urgent line")
        assert not answered.is_set()
        robot.call(answered.set)
        for each in sent:
            each.result(DEADLINE)


def connections(desk, count):
    """So many connections; none if one is refused, as while the end of an earlier one is on its way."""
    kept, context = [], unverified()
    try:
        for _ in range(count):
            plain = socket.create_connection(("127.0.0.1", desk.port), timeout=DEADLINE)
            kept.append(context.wrap_socket(plain))
        return kept
    except OSError:
        for each in kept:
            each.close()
        return []


def test_connections_of_an_address_are_limited_and_silent_ones_end(desk):
    desk.close_connection()
    kept = wait_for(lambda: connections(desk, LIMITS.connections_of_address), "All connections")
    with pytest.raises((OSError, http.client.HTTPException)):
        desk.send("GET", "/api/system")
    desk.advance(LIMITS.request_time)
    for each in kept:  # they have sent nothing
        with contextlib.suppress(ConnectionError, ssl.SSLError):
            assert each.recv(1) == b""
        each.close()

    def answers():
        desk.close_connection()
        with contextlib.suppress(OSError, http.client.HTTPException):
            return alive(desk)

    wait_for(answers, "An answer")


# ---- other sites -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "header",
    [
        {"Origin": "https://evil.example"},
        {"Origin": "null"},
        {"Sec_Fetch_Site": "cross-site"},
        {"Sec_Fetch_Site": "same-site"},
    ],
)
def test_requests_of_another_origin_are_refused(desk, control, header):
    for method, path in (
        ("POST", "/desk/api/joints/lock"),
        ("POST", "/admin/api/reboot"),
        ("POST", "/admin/api/login"),
        ("POST", "/admin/api/control-token/request"),
        ("PATCH", CONFIGURATION),
        ("POST", "/page/command"),
        ("POST", "/page/control"),
        ("POST", "/page/login"),
        ("POST", "/page/logout"),
    ):
        assert is_refused(desk.send(method, path, {}, **control, **header), 403), path
    upgrade = {"Connection": "Upgrade", "Upgrade": "websocket", "Sec_WebSocket_Version": "13"}
    answer = desk.send(
        "GET", "/admin/api/control-token", **upgrade, Sec_WebSocket_Key="MDEyMzQ1Njc4OWFiY2RlZg==", **header
    )
    assert is_refused(answer, 403)


def test_requests_of_the_same_origin_are_accepted(desk, control):
    own = {"Origin": f"https://127.0.0.1:{desk.port}", "Sec_Fetch_Site": "same-origin"}
    assert desk.send("POST", "/desk/api/joints/lock", **control, **own).status == 200


# ---- logins ----------------------------------------------------------------------------------------------


def test_digests_are_those_of_the_clients():
    expected = (
        "NDksMTE1LDY2LDEyOSwxODksNDcsMTE2LDE0NiwxMTgsMjMxLDI0OCwxMDgsMTIzLDExNiwxNDksMjE5LDE3MiwxNCwxMzUs"
        "ODQsOTQsMjEzLDIzMSwyMDIsMjU1LDYsMjE2LDE1MCwxNTgsMzgsNiwyMTU="
    )
    assert digest_of("admin", "secret") == expected


def test_a_digest_may_have_line_breaks_and_its_token_is_bare(desk):
    digest = digest_of(USER, PASSWORD)
    broken = "\n".join(digest[k : k + 76] for k in range(0, len(digest), 76)) + "\n"
    answer = desk.send("POST", "/admin/api/login", {"login": USER, "password": broken})
    assert answer.status == 200 and re.fullmatch(r"[\w.-]+", answer.text)
    assert "Set-Cookie" not in answer.headers
    wrong = desk.send("POST", "/admin/api/login", {"login": USER, "password": digest_of(USER, "x")})
    assert wrong.status == 401 and wrong.json()["error"] == "WrongCredentials"


def test_roles_limit_permissions(tmp_path):
    with desk_with_robot(tmp_path) as (_, desk):
        users = [
            {"name": USER, "role": "Admin"},
            {"name": "operator", "password": "o", "role": "Operator"},
            {"name": "safety", "password": "s", "role": "SafetyOperator"},
        ]
        change = {"userConfiguration": {"users": users}}
        assert desk.send("PATCH", CONFIGURATION, change, **basic()).status == 204
        shown = desk.send("GET", CONFIGURATION, **basic()).json()["userConfiguration"]["users"]
        assert [set(user) for user in shown] == [{"name", "role"}] * 3
        for name, word, statuses in (("operator", "o", (403, 403)), ("safety", "s", (403, 424))):
            user = basic(name, word)
            assert desk.send("GET", CONFIGURATION, **user).status == 200
            answers = (
                desk.send("PATCH", CONFIGURATION, {}, **user),
                desk.send("POST", "/api/safety/recovery:confirm", **user),
            )
            assert tuple(answer.status for answer in answers) == statuses
        assert any(route.path == CONFIGURATION for route in V1_ROUTES)


def test_a_new_password_ends_the_logins_of_its_user(tmp_path):
    with desk_with_robot(tmp_path) as (_, desk):
        cookie = desk.log_in()
        users = [{"name": USER, "password": "another one", "role": "Admin"}]
        change = {"userConfiguration": {"users": users}}
        assert desk.send("PATCH", CONFIGURATION, change, **basic()).status == 204
        assert desk.send("GET", CONFIGURATION, **cookie).status == 401
        assert desk.send("GET", CONFIGURATION, **basic()).status == 401
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
