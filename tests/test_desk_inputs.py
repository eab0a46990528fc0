# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Headers, queries and bodies that are not valid, at all paths of Desk: each is refused with a sentence."""

import base64
import contextlib
import json
import re

import pytest
from desk_fixtures import desk_with_robot
from desk_robot import OPEN
from desk_server import basic
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from pyfranka.desk import checks
from pyfranka.desk.errors import DeskError
from pyfranka.desk.page_lines import MAX_PUSH_TIME, line_of
from pyfranka.desk.profiles import PROFILES
from pyfranka.desk.server import ROUTES
from pyfranka.desk.sessions import Users

DIGITS = "9" * 5000
HUGE = 10**400
SURROGATE = "\ud800"
PAGE_PATHS = [
    ("GET", "/"),
    ("GET", "/page/files/js/main.js"),
    ("POST", "/page/login"),
    ("POST", "/page/logout"),
    ("GET", "/page/session"),
    ("GET", "/page/robots"),
    ("GET", "/page/scene"),
    ("GET", "/page/mesh"),
    ("GET", "/page/robot-mesh/fr3/link0"),
    ("GET", "/page/live"),
    ("POST", "/page/command"),
    ("POST", "/page/control"),
]
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
QUERIES = [
    "robot=0000009",
    f"robot={DIGITS}",
    f"robot={'0' * 5000}",
    "robot=%C2%B2",
    "robot=%D9%A3",
    "robot=%ff",
    "robot=",
    "robot=-1",
    "robot=1e0",
    "name=%00&robot=0",
    "force=%ff&error_id=%ff",
]
BODIES = [
    {"robot": "0000009", "what": "take", "action": "fci", "words": ["on"]},
    {"robot": DIGITS, "what": "take"},
    {"robot": HUGE, "what": "take"},
    {"robot": True, "what": "take"},
    {"robot": 0, "what": SURROGATE, "action": SURROGATE, "words": [SURROGATE]},
    {"action": "push", "words": [SURROGATE, "1", "1", "1", "50"]},
    {"action": "push", "words": ["fr3_hand", "1", "1", "1", "0001000000"]},
    {"action": "move", "words": [DIGITS] * 7},
    {"owner": "me", "timeout": HUGE, "type": HUGE, "requestedBy": HUGE, "token": HUGE},
    {"owner": "me", "timeout": 1e-3, "requestedBy": SURROGATE, "token": SURROGATE, "type": SURROGATE},
    {"login": SURROGATE, "password": "x", "user": SURROGATE},
    {"login": "franka", "user": "franka", "password": SURROGATE},
    {"desiredOperatingMode": HUGE, "orientation": {"roll": HUGE, "pitch": 0, "yaw": 0}},
    {
        "mass": 1,
        "centerOfMass": [0, 0, 0],
        "inertia": [1, 0, 0, 0, 1, 0, 0, 0, 1],
        "transformation": [HUGE] * 16,
    },
    {"userConfiguration": {"users": [{"name": "a", "password": SURROGATE, "role": "Admin"}]}},
    HUGE,
    [HUGE],
]


@pytest.fixture(scope="module", params=["fr3-v1", "fer-spoc"])
def desk(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp("certificates")
    with desk_with_robot(folder, request.param, report={"brakes": OPEN}) as (robot, desk):
        robot.answers |= {"scene": 'ok {"bodies": [], "shapes": []}', "poses": "ok []"}
        yield desk


def paths(desk):
    """Method and path of all requests that end by themselves and leave the robot on. Those of both types of
    robots are in one list only."""
    v1 = desk.desk.profile.v1
    routes = [route for route in ROUTES.routes if route.where(desk.desk.profile)]
    routes = [route for route in routes if v1 or not route.where(PROFILES["fr3-v1"])]
    found = [(route.method, re.sub(r"<\w+>", "1", route.path)) for route in routes]
    found = [each for each in found if not re.search("reboot|shutdown|logout|sse", each[1])]
    return [*PAGE_PATHS, *found] if v1 else found


def check_answer(desk, caplog, method, path, body=b"", **headers):
    """Desk answers without an error of its own, and an error with a sentence."""
    active = desk.desk.tokens.active
    token = active.token if active else desk.take_control(**basic())["token"]
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


@pytest.mark.parametrize("headers", HEADERS.values(), ids=HEADERS)
def test_no_header_causes_an_internal_error(desk, caplog, headers):
    for method, path in paths(desk):
        check_answer(desk, caplog, method, path, b"{}", **headers)
    for method, path in PAGE_PATHS:
        check_answer(desk, caplog, method, path, b"{}", **{**basic(), **headers})


@pytest.mark.parametrize("query", QUERIES, ids=lambda query: query[:20])
def test_no_query_causes_an_internal_error(desk, caplog, query):
    for method, path in paths(desk):
        check_answer(desk, caplog, method, f"{path}?{query}", **basic())


@pytest.mark.parametrize("body", BODIES, ids=lambda body: json.dumps(body)[:40])
def test_no_body_causes_an_internal_error(desk, caplog, body):
    for method, path in paths(desk):
        if method != "GET":
            login = {} if path.endswith("/login") else basic()
            check_answer(desk, caplog, method, path, json.dumps(body).encode(), **login)


REFUSED = [
    ("GET", "/page/scene?robot=0000009", None, {}, 404),
    ("GET", f"/page/scene?robot={DIGITS}", None, {}, 404),
    ("GET", f"/page/scene?robot={'0' * 5000}", None, {}, 404),
    ("POST", "/page/command", {"robot": "0000009", "action": "self_test", "words": []}, JSON, 404),
    ("POST", "/page/command", BODIES[5], JSON, 400),
    ("POST", "/page/command", BODIES[6], JSON, 400),
    ("POST", "/page/login", {}, HEADERS["unknown charset"], 415),
    ("POST", "/page/login", BODIES[10], JSON, 401),
    ("POST", "/page/login", BODIES[11], JSON, 401),
    ("POST", "/admin/api/login", BODIES[10], {}, 401),
    ("POST", "/page/login", {}, {**JSON, **HEADERS["origin that is not a URL"]}, 403),
    ("GET", "/page/files/js/main.js", None, HEADERS["date beyond all years"], 400),
]


@pytest.mark.parametrize("method, path, body, headers, status", REFUSED, ids=lambda each: str(each)[:40])
def test_invalid_input_is_refused_with_its_status(desk, method, path, body, headers, status):
    answer = desk.send(method, path, body, **{"Authorization": basic()["Authorization"], **headers})
    assert answer.status == status and answer.json()["message"].endswith("."), answer


@pytest.mark.parametrize("cookies", ["a/b=1; {}", "c,d=2; {}; e=3", "authorization=old; {}"])
def test_cookies_of_other_programs_do_not_hide_a_login(desk, cookies):
    cookie = cookies.format(desk.log_in()["Cookie"])
    assert desk.send("GET", "/page/session", Cookie=cookie).json() == {"user": "franka"}


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
        line_of(action, words)[1].encode()


@OFTEN
@given(WORDS)
def test_push_of_the_page_ends_within_its_longest_time(time):
    with contextlib.suppress(DeskError):
        line = line_of("push", ["fr3_hand", "1", "1", "1", time])[1]
        assert int(line.split()[-1]) <= MAX_PUSH_TIME


@OFTEN
@given(WORDS, WORDS)
def test_any_name_and_password_can_be_compared(name, password):
    users = Users("franka", "open-sesame")
    assert users.by_password(name, password) is None and users.by_digest(name, password) is None
