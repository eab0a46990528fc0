# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Requests that are not valid, at all paths of Desk: each is refused with a sentence and changes nothing."""

import base64
import contextlib
import json
import re
import socket
import ssl

import pytest
from desk_bodies import CONFIGURATION, INERTIA, INERTIAL, PROFILE, SETTINGS, TCP
from desk_robot import OPEN
from desk_server import LIMITS, basic, unverified
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from operator_table import operator_table
from pyfranka.desk import checks
from pyfranka.desk.errors import DeskError
from pyfranka.desk.page_lines import MAX_PUSH_TIME, line_of
from pyfranka.desk.profiles import PROFILES
from pyfranka.desk.server import LINGER, ROUTES
from pyfranka.desk.sessions import Users
from scripted_desk import desk_with_robot

DEADLINE = 60.0  # [s]
DIGITS = "9" * 5000
HUGE = 10**400
SURROGATE = "\ud800"
UPGRADE = {"Connection": "Upgrade", "Upgrade": "websocket", "Sec_WebSocket_Version": "13"}
JSON = {"Content_Type": "application/json"}
HEADERS = {
    "unknown charset": {"Content_Type": "application/json; charset=foo"},
    "charset that is not text": {"Content_Type": "application/json; charset=hex"},
    "charset in parts": {"Content_Type": f"application/json; charset*0*=x; charset*{DIGITS}*=y"},
    "charset with a language": {"Content_Type": "application/json; charset*=utf-8'en'foo"},
    "content type without words": {"Content_Type": ";;=;"},
    "cookie of another program": {"Cookie": "a/b=1; c,d=2"},
    "cookie of bytes": {"Cookie": "authorization=\xff"},
    "origin that is not a URL": {"Origin": "https://["},
    "login that is not base64": {"Authorization": "Basic !"},
    "login of bytes": {"Authorization": "Basic " + base64.b64encode(b"\xff:\xff").decode()},
    "token of bytes": {"Authorization": "\xff", "X_Control_Token": "\xff"},
    "date beyond all years": {"If_Modified_Since": f"Mon, 01 Jan {DIGITS[:20]} 00:00:00 GMT"},
    "date of many digits": {"If_Modified_Since": f"Mon, 01 Jan {DIGITS} 00:00:00 GMT"},
    "range beyond all files": {"Range": f"bytes={DIGITS}-"},
    "key of a socket": {**UPGRADE, "Sec_WebSocket_Key": "\xe9"},
    "short key of a socket": {**UPGRADE, "Sec_WebSocket_Key": "x"},
    "socket without a key": UPGRADE,
    "unknown expectation": {"Expect": "x"},
}
ROBOTS = ["0000009", DIGITS, "0" * 5000, "%C2%B2", "%D9%A3", "%ff", "", "-1", "1e0"]
QUERIES = [*(f"robot={robot}" for robot in ROBOTS), "name=%00&robot=0", "force=%ff&error_id=%ff"]
NOT_JSON = [b"{", b'{"login": ', b"\xff\xfe", b"NaN", b'{"owner": NaN}', b"[" * 20000, b'{"a":' * 5000]
NO_OBJECTS = [b"1" * 9000, b'"\\ud800"', b"null", b"[]", b"7"]
# Valid bodies, by the paths that read them.
BODIES = {
    "/page/c": {"robot": 0, "what": "take", "action": "push", "words": ["fr3_hand", "1", "1", "1", "50"]},
    "control-token|recovery|motion": {
        "owner": "me",
        "timeout": 1e-3,
        "type": "SafetyError",
        "requestedBy": "me",
        "token": "x",
    },
    "login|mode": {"login": "franka", "user": "franka", "password": "x", "desiredOperatingMode": "Execution"},
    "profiles": PROFILE,
    "/end-effector-c": SETTINGS,
    "configuration$": {
        **CONFIGURATION,
        "networkConfiguration": {"robot": {"network": {}}, "shopFloor": {"type": "Static"}},
        "userConfiguration": {"users": [{"name": "a", "password": "b", "role": "Operator"}]},
    },
    "mounting": {"orientation": TCP["rotation"]},
}
WRONG = [None, True, -1, HUGE, 1e308, DIGITS, SURROGATE, "", "\x00", [], {}, [{}]]


@pytest.fixture(scope="module", params=["fr3-v1", "fer-spoc"])
def desk(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp("certificates")
    with desk_with_robot(folder, request.param, report={"brakes": OPEN}) as (robot, desk):
        robot.answers |= {"scene": 'ok {"bodies": [], "shapes": []}', "poses": "ok []"}
        yield desk


def page_paths(desk):
    """Method and path of all requests of the page."""
    words = {"name": "js/main.js", "type": "fr3", "part": "link0", "path": ""}
    found = {(route.method, route.resource.canonical) for route in desk.site._app.router.routes()}
    found -= {("HEAD", path) for _, path in found} | {("*", "/{path}")}
    return [(method, path.format(**words)) for method, path in sorted(found)]


def paths(desk):
    """Method and path of all requests that end by themselves and leave the robot on. Those of both types of
    robots are in one list only."""
    v1 = desk.desk.profile.v1
    routes = [route for route in ROUTES.routes if route.where(desk.desk.profile)]
    routes = [route for route in routes if v1 or not route.where(PROFILES["fr3-v1"])]
    found = [(route.method, re.sub(r"<\w+>", "1", route.path)) for route in routes]
    found = [each for each in found if not re.search("reboot|shutdown|logout|sse", each[1])]
    return [*page_paths(desk), *found] if v1 else found


def actions(desk):
    return [(method, path) for method, path in paths(desk) if method != "GET"]


def check_answer(desk, caplog, method, path, body=b"", **headers):
    """Desk answers without an error of its own, and an error with a sentence."""
    active = desk.desk.tokens.active
    token = active.token if active else desk.take_control(**basic())["token"]
    if path.endswith(":take"):
        desk.clear()  # so that it does not wait for control
    try:
        answer = desk.send(method, path, body, **{**JSON, "X_Control_Token": token, **headers})
    except OSError as error:
        desk.close_connection()
        raise AssertionError(f"{method} {path} is not answered.") from error
    case = method, path[:60], body[:80], answer
    assert answer.status < 500 or answer.json()["error"] == "ServiceUnavailable", case
    if answer.status >= 400 and answer.status != 417:  # aiohttp answers with the latter by itself
        assert re.fullmatch(r"[^a-z].*\.", answer.json()["message"], re.DOTALL), case
    assert [record for record in caplog.records if record.exc_info] == []
    return answer


@pytest.mark.parametrize("headers", HEADERS.values(), ids=HEADERS)
def test_no_header_causes_an_internal_error(desk, caplog, headers):
    for method, path in paths(desk):
        check_answer(desk, caplog, method, path, b"{}", **headers)
    for method, path in page_paths(desk):
        check_answer(desk, caplog, method, path, b"{}", **{**basic(), **headers})


@pytest.mark.parametrize("query", QUERIES, ids=lambda query: query[:20])
def test_no_query_causes_an_internal_error(desk, caplog, query):
    for method, path in paths(desk):
        check_answer(desk, caplog, method, f"{path}?{query}", **basic())


def changed(value):
    """Copies of a value, in each of which one part is another one or missing."""
    yield from WRONG
    if isinstance(value, dict):
        for name, part in value.items():
            others = {each: kept for each, kept in value.items() if each != name}
            yield others
            yield from ({**others, name: wrong} for wrong in changed(part))
    elif isinstance(value, list):
        for k, part in enumerate(value):
            yield from ([*value[:k], wrong, *value[k + 1 :]] for wrong in changed(part))


@pytest.mark.parametrize("where", BODIES)
def test_no_body_causes_an_internal_error(desk, caplog, where):
    for method, path in actions(desk):
        login = {} if path.endswith("/login") else basic()
        for body in changed(BODIES[where]) if re.search(where, path) else [BODIES[where]]:
            check_answer(desk, caplog, method, path, json.dumps(body).encode(), **login)


# The ends of paths whose requests need a JSON object, or have one.
READ_BODIES = (
    "login|control-token(/request|/fci)?|profiles|:take|:change|motion:start|:confirm|/configuration"
)
READ_BODIES = re.compile(f".*({READ_BODIES}|arm-mounting|/page/command)")


@pytest.mark.parametrize("body", NOT_JSON + NO_OBJECTS, ids=lambda body: repr(body[:20]))
def test_bodies_that_are_not_json_objects_are_refused(desk, caplog, body):
    for method, path in actions(desk):
        login = {} if path.endswith("/login") else basic()
        answer = check_answer(desk, caplog, method, path, body, **login)
        assert answer.status == 400 or not READ_BODIES.fullmatch(path), (path, answer)


# ---- properties of the checks ----------------------------------------------------------------------------

WORDS = st.one_of(
    st.text(), st.text("0123456789", min_size=1, max_size=10), st.sampled_from([DIGITS, SURROGATE])
)
VALUES = st.recursive(
    st.one_of(st.none(), st.booleans(), st.integers(), st.just(HUGE), st.floats(), WORDS),
    lambda inner: st.one_of(st.lists(inner), st.dictionaries(WORDS, inner)),
    max_leaves=5,
)
OFTEN = settings(max_examples=300, derandomize=True, deadline=None, suppress_health_check=list(HealthCheck))


@OFTEN
@given(VALUES, st.sampled_from([0.3, 3.0, float("inf")]))
def test_number_is_a_finite_number_or_a_bad_request(value, limit):
    with contextlib.suppress(DeskError):
        number = checks.number(value, "mass", limit)
        assert isinstance(number, float) and abs(number) <= limit and abs(number) < float("inf")


@OFTEN
@given(st.one_of(st.sampled_from(["push", "move", "inject", "fci"]), VALUES), st.lists(WORDS) | VALUES)
def test_line_of_the_page_can_be_sent_or_is_a_bad_request(action, words):
    with contextlib.suppress(DeskError):
        line_of(operator_table(), action, words)[1].encode()


@OFTEN
@given(WORDS)
def test_push_of_the_page_ends_within_its_longest_time(time):
    with contextlib.suppress(DeskError):
        line = line_of(operator_table(), "push", ["fr3_hand", "1", "1", "1", time])[1]
        assert int(line.split()[-1]) <= MAX_PUSH_TIME


@OFTEN
@given(WORDS, WORDS)
def test_any_name_and_password_can_be_compared(name, password):
    users = Users("franka", "open-sesame")
    assert users.by_password(name, password) is None and users.by_digest(name, password) is None


# ---- statuses --------------------------------------------------------------------------------------------


def command(words, **more):
    return {"action": "push", "words": words, **more}


PUSH = ["fr3_hand", "1", "1", "1", "50"]
REFUSED = [
    *(("GET", f"/page/scene?robot={robot}", None, {}, 404) for robot in ROBOTS),
    *(
        ("POST", "/page/command", command(PUSH, robot=robot), JSON, 404)
        for robot in ("0000009", DIGITS, HUGE, True, None, 1, -1, 1.5, "x")
    ),
    ("POST", "/page/command", command([SURROGATE, *PUSH[1:]]), JSON, 400),
    ("POST", "/page/command", command([*PUSH[:4], "0001000000"]), JSON, 400),
    ("POST", "/page/command", b"", JSON, 400),
    ("POST", "/page/command", command("on"), JSON, 400),
    ("POST", "/page/command", command([1]), JSON, 400),
    ("POST", "/page/command", {"action": 1}, JSON, 400),
    *(
        ("POST", "/api/system/control-token:take", {"owner": "me", "timeout": timeout}, {}, 400)
        for timeout in (0, -1, "1", True, [], 1e999)
    ),
    ("POST", "/page/login", {}, HEADERS["unknown charset"], 415),
    ("POST", "/page/login", {"user": SURROGATE, "password": "x"}, JSON, 401),
    ("POST", "/page/login", {"user": "franka", "password": SURROGATE}, JSON, 401),
    ("POST", "/admin/api/login", {"login": SURROGATE, "password": "x"}, {}, 401),
    ("POST", "/page/login", {}, {**JSON, **HEADERS["origin that is not a URL"]}, 403),
    ("GET", "/page/files/js/main.js", None, HEADERS["date beyond all years"], 400),
]


@pytest.mark.parametrize("desk", ["fr3-v1"], indirect=True)
@pytest.mark.parametrize("method, path, body, headers, status", REFUSED, ids=lambda each: str(each)[:40])
def test_invalid_input_is_refused_with_its_status(desk, method, path, body, headers, status):
    answer = desk.send(method, path, body, **{"Authorization": basic()["Authorization"], **headers})
    assert answer.status == status and answer.json()["message"].endswith("."), answer


def tool(**changes):
    return {**PROFILE, "inertial": {**INERTIAL, **changes}}


def user(**changes):
    return {"userConfiguration": {"users": [{"name": "a", "password": "x", "role": "Admin", **changes}]}}


PATCH, ADD = ("PATCH", "/api/configuration"), ("POST", "/admin/api/end-effector/profiles")
UNCHANGED = [
    (PATCH, {"endEffectorConfiguration": 1}),
    (PATCH, {"endEffectorConfiguration": {"endEffector": {"name": "Hammer"}}}),
    (PATCH, {"endEffectorConfiguration": {"endEffector": {"name": "Other", "params": {"mass": 1}}}}),
    (PATCH, {"networkConfiguration": {"shopFloor": {"type": "Token ring"}}}),
    (PATCH, {"networkConfiguration": {"robot": 1}}),
    (PATCH, {"userConfiguration": {"users": []}}),
    (PATCH, user(name="a:b")),
    (PATCH, user(role="SafetyOperator")),
    (PATCH, user(password="")),
    (PATCH, user(password=SURROGATE)),
    (PATCH, {"userConfiguration": {"users": user()["userConfiguration"]["users"] * 2}}),
    (PATCH, {"somethingElse": {}}),
    (ADD, tool(mass=-1.0)),
    (ADD, tool(mass=3.1)),
    (ADD, tool(mass="heavy")),
    (ADD, tool(mass=True)),
    (ADD, tool(centerOfMass={"x": 0.31, "y": 0.0, "z": 0.0})),
    (ADD, tool(centerOfMass={"x": 0.0, "y": 0.0})),
    (ADD, tool(inertia=dict.fromkeys(INERTIA, 0.0))),
    (ADD, tool(inertia={**INERTIA, "x11": 1.1, "x22": 1, "x33": 1})),
]


@pytest.mark.parametrize("desk", ["fr3-v1"], indirect=True)
@pytest.mark.parametrize("request_line, body", UNCHANGED, ids=lambda each: str(each)[-60:])
def test_invalid_configuration_changes_nothing(desk, request_line, body):
    def kept():
        return [desk.send("GET", path, **basic()).json() for _, path in (PATCH, ADD)]

    before = kept()
    answer = desk.send(*request_line, body, **basic())
    assert answer.status == 400 and answer.json()["message"].endswith("."), answer
    assert kept() == before


@pytest.mark.parametrize("cookies", ["a/b=1; {}", "c,d=2; {}; e=3", "authorization=old; {}"])
def test_cookies_of_other_programs_do_not_hide_a_login(desk, cookies):
    cookie = cookies.format(desk.log_in()["Cookie"])
    assert desk.send("GET", "/page/session", Cookie=cookie).json() == {"user": "franka"}


def test_html_of_errors_is_escaped(desk):
    answer = desk.send("GET", "/desk/api/%3Cscript%3Ealert(1)%3C/script%3E")
    assert answer.status == 404 and "<script>" not in answer.text and "&lt;script&gt;" in answer.text
    assert answer.headers["X-Content-Type-Options"] == "nosniff"


# ---- bytes -----------------------------------------------------------------------------------------------

CLOSE = b" HTTP/1.1\r\nHost: a\r\nConnection: close\r\n"
LOGIN = b"POST /admin/api/login HTTP/1.1\r\nHost: a\r\n"
CHUNKS = b"".join(b"8000\r\n" + b"x" * 0x8000 + b"\r\n" for _ in range(3)) + b"0\r\n\r\n"
# What a connection sends, and a status of its answer; without one, Desk may also end the connection.
GARBAGE = [
    (b"\r\n\r\n", b""),
    (b"GARBAGE\r\n\r\n", b""),
    (b"GET / HTTP/x\r\n\r\n", b""),
    (b"GET /" + b"a" * 20000 + b" HTTP/1.1\r\n\r\n", b""),
    (b"GET / HTTP/1.1\r\nA: " + b"a" * 20000 + b"\r\n\r\n", b""),
    (LOGIN + b"Content-Length: -1\r\n\r\n", b""),
    (LOGIN + b"Content-Length: x\r\n\r\n", b""),
    (LOGIN + b"Content-Length: 500\r\n\r\n{", b" 408 "),  # the body does not come
    (LOGIN + b"Connection: close\r\nContent-Length: 70000\r\n\r\n" + b"x" * 70000, b" 413 "),
    (LOGIN + b"Connection: close\r\nTransfer-Encoding: chunked\r\n\r\n" + CHUNKS, b" 413 "),
    (b"GET /%ff%00%0d%0a" + CLOSE + b"\r\n", b" 404 "),
    (b"GET /desk/api/../../etc/passwd" + CLOSE + b"\r\n", b" 404 "),
    (b"GET /robots/999/api/system" + CLOSE + b"\r\n", b" 404 "),
    (b"\x00" * 1000, b""),
]


@pytest.mark.parametrize("desk", ["fr3-v1"], indirect=True)
@pytest.mark.parametrize("data, status", GARBAGE, ids=lambda each: repr(each[:60]))
def test_garbage_does_not_end_desk(desk, data, status):
    received = b""
    with socket.create_connection(("127.0.0.1", desk.port), timeout=DEADLINE) as plain:
        plain.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)  # data go at once, as the clock is fast
        with unverified().wrap_socket(plain) as secure:
            secure.sendall(data)
            desk.advance(LIMITS.body_time + 2 * LINGER)
            with contextlib.suppress(ConnectionError, ssl.SSLError):
                while part := secure.recv(65536):
                    received += part
    with socket.create_connection(("127.0.0.1", desk.port)) as plain:
        with unverified().wrap_socket(plain) as secure:
            secure.sendall(data)  # of a client that does not wait for the answer
    first = received.partition(b"\r\n")[0]
    assert status in first and (not first or re.match(rb"HTTP/1.[01] 4\d\d ", first))
    assert desk.send("GET", "/admin/api/startup-phase").status == 200
