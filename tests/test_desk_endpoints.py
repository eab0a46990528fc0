# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Every endpoint of Desk, with every kind of login and control token, for robots of every generation.

The table below says what is expected; another test compares it with the endpoints that exist.
"""

from __future__ import annotations

import enum
import re
import typing
from dataclasses import dataclass, field

import pytest
from desk_bodies import PROFILE as TOOL_PROFILE
from desk_bodies import SETTINGS
from desk_robot import ScriptedRobot
from desk_server import DeskServer, basic
from pyfranka.desk.profiles import PROFILES
from pyfranka.desk.server import ROUTES
from scripted_desk import change

pytest_plugins = ["desk_fixtures"]

ALL = tuple(PROFILES)
PROTOCOLS = {"fer-old": 4, "fer-spoc": 5, "fr3-early": 7, "fr3-v1": 10}
FER = ("fer-old", "fer-spoc")
FR3 = ("fr3-early", "fr3-v1")
TOKENS = ("fer-spoc", "fr3-early", "fr3-v1")
V1 = ("fr3-v1",)
EMPTY = ""  # a body that is empty
FORMS = "application/x-www-form-urlencoded"


class Needs(enum.Enum):
    NOTHING = "no login"
    LOGIN = "a login"
    CONTROL = "the token as header"
    CONTROL_OR_FORM = "the token as header or in the form"
    CONTROL_LOCKED = "the token as header; 423 without"
    BODY_TOKEN = "the token in the body"


@dataclass(frozen=True)
class Case:
    """ok: the status of success. has: members of the answer, or an answer. lines: that reach the robot.
    report: of the robot, for success. Variable parts of the path have brackets. A body of bytes is a form."""

    method: str
    template: str
    where: tuple[str, ...] = ALL
    needs: Needs = Needs.LOGIN
    has: typing.Any = None
    ok: int = 200
    body: typing.Any = None
    lines: str = ""
    report: dict[str, typing.Any] = field(default_factory=dict)

    @property
    def path(self) -> str:
        return re.sub("[<>]", "", self.template)

    def __str__(self) -> str:
        return f"{self.method} {self.path}"


def get(path, where=ALL, needs=Needs.LOGIN, has=None):
    return Case("GET", path, where, needs, has)


def do(method, path, where=ALL, needs=Needs.LOGIN, lines="", **more):
    """An action, whose answer has no body."""
    ok = 204 if path.startswith("/api/") else 200
    return Case(method, path, where, needs, EMPTY, ok, lines=lines, **more)


LOGIN_BODY = {"login": "franka", "password": "bm90IHRoaXM="}
SAFETY = set(
    "sequenceNumber safetyControllerStatus brakeState stoState timeToTd2 activeWarnings demandedRecoveries "
    "recoverableErrors activeRecovery safeInputState powerState safetyControllerStatusReason "
    "safetyConfigurationIndex fsoeConnectionStatus".split()
)
SYSTEM = {"execution", "safety", "robot", "processes", "startup", "controlToken", "derived", "firstStart"}
BUTTONS = {"circle", "cross", "check", "up", "down", "left", "right"}
ARM = {"jointAngles", "cartesianPose", "estimatedTorques", "estimatedForces"}
CONFIGURATION = {"endEffectorConfiguration", "networkConfiguration", "userConfiguration"}
ACTIVE_PROFILE = {"id", "name", "deviceId", "active", "inertial", "tcp"}
ROBOT_STATUS = {"robotErrors", "recoveryMode", "endEffectorConfiguration"}
MOUNTING = {"orientation": {"roll": 0, "pitch": 0, "yaw": 1.5}}
CONNECTED, TESTED = {"connectionStatus": "connected"}, {"code": "SuccessResponse"}
IDENTITY = "1.0 0.0 0.0 0.0 0.0 1.0 0.0 0.0 0.0 0.0 1.0 0.0 0.0 0.0"
NO_TOOL = f"end_effector {'0.0 ' * 13}{IDENTITY} 0.0 1.0"
TOOL = f"end_effector 0.5 0.0 0.0 0.05 0.001 0.0 0.0 0.0 0.001 0.0 0.0 0.0 0.001 {IDENTITY} 0.1 1.0"
LOCK = "fci off; joints lock"
CONTROL, PROFILE = "/admin/api/control-token", "/admin/api/end-effector/profiles"
SELECTION, LOAD = "/admin/api/end-effectors/selection", "/admin/api/end-effector-configuration"
ACKNOWLEDGE = "/admin/api/safety/recoverable-safety-errors/acknowledge?error_id=GenericJointError"
MODE = "/api/system/operating-mode:change"
POSITION_ERRORS = ["/desk/api/robot/shutdown-position-error", "/admin/api/robot/shutdown-position-error"]
ACTIVE = {"fci": True}
ERROR = {"recoverable": ["genericJointError"], "errors": ["joint_reflex"]}
LOST_JOINT = {"joint_position_error": [False] * 3 + [True] + [False] * 3}
N, L, C, BODY, FORM = Needs.NOTHING, Needs.LOGIN, Needs.CONTROL, Needs.BODY_TOKEN, Needs.CONTROL_OR_FORM
LOCKED = Needs.CONTROL_LOCKED

CASES = [
    # ---- the older interface: login ----
    Case("POST", "/admin/api/login", ALL, N, {"error"}, 401, LOGIN_BODY),
    get("/admin/login", ALL, N),
    get("/admin/api/first-start", ALL, N, False),
    get("/admin/api/startup-phase", ALL, N, {"tag"}),
    do("POST", "/admin/api/logout"),
    # ---- control ----
    get(CONTROL, TOKENS, N, {"activeToken", "fciActive", "tokenRequest"}),
    Case("POST", f"{CONTROL}/request", TOKENS, L, {"id", "token"}, body={"requestedBy": "me"}),
    Case("DELETE", f"{CONTROL}/request/<7>", TOKENS, L, {"error"}, 404, {"token": "none"}),
    do("POST", f"{CONTROL}/fci", TOKENS, BODY, "fci on"),
    do("DELETE", f"{CONTROL}/fci", TOKENS, BODY, "fci off"),
    do("DELETE", CONTROL, TOKENS, BODY, "fci off", report=ACTIVE),
    get("/admin/api/safety", TOKENS, L, {"tokenForceTimeout": 30}),
    # ---- brakes, FCI, modes ----
    do("POST", "/desk/api/robot/open-brakes", FER, C, "joints unlock"),
    do("POST", "/desk/api/robot/close-brakes", FER, L, LOCK),
    do("POST", "/desk/api/joints/unlock", FR3, C, "joints unlock"),
    do("POST", "/desk/api/system/fci", FR3, FORM, "fci on"),
    do("DELETE", "/desk/api/system/fci", FR3, FORM, "fci off"),
    do("POST", "/desk/api/operating-mode/programming", FR3, C, "operating_mode programming"),
    do("POST", "/desk/api/operating-mode/execution", FR3, C, "operating_mode execution"),
    do("POST", "/desk/api/joints/lock", FR3, L, LOCK),
    do("PUT", "/desk/api/robot/guiding/mode", ALL, C, "guiding_mode rotation", body=b'mode="rotation"'),
    do("PUT", "/desk/api/navigation/mode", ALL, C, "navigation desk", body=b'mode="one"'),
    do("POST", "/desk/api/gripper/homing", ALL, C, "hand homing"),
    do("POST", "/desk/api/execution", body=b"id=task"),
    do("DELETE", "/desk/api/execution", body=b"id=task"),
    get("/desk/api/execution", has={"lastActivePath", "running"}),
    do("POST", "/desk/api/robot/reset-errors", ALL, C, "recover", report=ERROR),
    do("POST", "/desk/api/robot/fold", ALL, C, "move pack"),
    do("POST", "/desk/api/robot/restart", FER, L, LOCK),
    *(get(path, FER, L, [False] * 7) for path in POSITION_ERRORS),
    *(
        do("DELETE", f"{path}/<3>", FER, C, "inject jointPositionErrorDemand 4 off", report=LOST_JOINT)
        for path in POSITION_ERRORS
    ),
    # ---- system ----
    get("/admin/api/system-version", ALL, N),
    get("/admin/api/robot/nameplate", has={"serialNumber"}),
    get("/admin/api/features", has={"fci"}),
    get("/admin/api/safety/status", FR3, N, SAFETY),
    get("/admin/api/system-status", FR3, N, SYSTEM),
    do("POST", ACKNOWLEDGE, FR3, C, "acknowledge genericJointError", report=ERROR),
    Case("POST", "/admin/api/safety/td2-tests/execute", FR3, C, TESTED, lines="self_test"),
    # ---- end effectors ----
    get(SELECTION, FER, L, "ee-gripper"),
    do("PUT", SELECTION, FER, C, body="ee-no-gripper"),
    do("PUT", SELECTION, FER, C, body="ee-gripper"),
    get(LOAD, FER, L, set(SETTINGS)),
    do("POST", LOAD, FER, C, TOOL, body=SETTINGS),
    get(PROFILE, FR3),
    Case("POST", PROFILE, FR3, L, {"id"}, body=TOOL_PROFILE),
    get(f"{PROFILE}/active", FR3, L, ACTIVE_PROFILE),
    do("PUT", f"{PROFILE}/active", FR3, LOCKED, NO_TOOL, body="ee-no-profile"),
    do("PUT", f"{PROFILE}/<ee-profile-1>", FR3, body=TOOL_PROFILE),
    Case("DELETE", f"{PROFILE}/<nobody>", FR3, ok=404),
    # ---- what WebSockets send too ----
    get("/admin/api/processes", has="Up"),
    get("/admin/api/end-effector", has={"id"}),
    get("/desk/api/navigation/events", has=BUTTONS),
    get("/desk/api/robot/configuration", has=ARM),
    get("/desk/api/system/status", FER, L, {"brakesOpen", "operationalMode", "x4Enabled"}),
    get("/desk/api/system/status", FR3, L, {"jointStatus", "lifetimeConfirmationNeeded"}),
    get("/desk/api/robot/status", has=ROBOT_STATUS),
    get("/desk/api/robot/gripper_state", has={"width", "maxWidth"}),
    get("/desk/api/events/gripper/hardware", has={"connection_status"}),
    get("/desk/api/pilot/hardware", has=CONNECTED),
    get("/desk/api/base-leds/hardware", has=CONNECTED),
    get("/desk/api/robot/guiding/mode"),
    get("/desk/api/robot/guiding/configuration", has={"translation_x", "rotation_z", "elbow"}),
    get("/desk/api/navigation/mode"),
    *(get(f"/desk/api/{name}", has=[]) for name in ("notification", "timelines", "skills", "groups")),
    # ---- the newer interface ----
    get("/api/system", V1, N, {"status", "operatingMode", "controlSerialNumber", "cloud"}),
    get("/api/system/operating-mode", V1, N, {"status"}),
    get("/api/system/control-token", V1, N, {"owner", "tokenId", "requester"}),
    get("/api/fci", V1, N, {"status"}),
    get("/api/arm", V1, N, {"status": "Connected", "armType": "FR3"}),
    get("/api/arm/joints", V1, N),
    get("/api/arm/warnings", V1, N, {"closeToSingularity"}),
    get("/api/end-effector/power", V1, N, {"status"}),
    get("/api/safety/self-tests", V1, L, {"status", "remaining"}),
    get("/api/safety/recovery", V1, L, {}),
    get("/api/configuration", V1, L, CONFIGURATION),
    get("/api/configuration/arm-mounting", V1, L, {"orientation"}),
    get("/api/system/log", V1),
    get("/api/system/log/public/cyclic", V1),
    get("/api/system/log/public/events", V1),
    get("/api/system/software", V1),
    get("/api/system/software/status-token", V1),
    get("/api/system/software/update", V1),
    Case("POST", "/api/system/control-token:take", V1, L, {"code"}, 424, {"owner": "me", "timeout": 0.01}),
    do("POST", "/api/arm/joints:unlock", V1, C, "joints unlock"),
    do("POST", MODE, V1, C, "operating_mode execution", body={"desiredOperatingMode": "Execution"}),
    do("POST", "/api/fci:activate", V1, C, "fci on"),
    do("POST", "/api/fci:deactivate", V1, C, "fci off"),
    do("POST", "/api/arm/motion:start", V1, C, "move pack", body={"type": "MoveToPackPose"}),
    do("POST", "/api/arm/motion:stop", V1, C, "move stop"),
    do("POST", "/api/arm/joints:lock", V1, L, LOCK),
    do("POST", "/api/end-effector/power:off", V1, C, "end_effector_power off"),
    do("POST", "/api/end-effector/power:on", V1, C, "end_effector_power on"),
    do("POST", "/api/safety/self-tests:execute", V1, C, "self_test"),
    do("POST", "/api/safety/recovery:confirm", V1, L, "acknowledge genericJointError", report=ERROR),
    do("POST", "/api/safety/recovery:start", V1, L, "acknowledge genericJointError", report=ERROR),
    do("PATCH", "/api/configuration", V1, body={}),
    do("PUT", "/api/configuration/arm-mounting", V1, C, body=MOUNTING),
    do("PUT", "/api/configuration/initial", V1, body={}),
    Case("POST", "/api/system/software/update:prepare-online", V1, L, {"code"}, 424),
    Case("POST", "/api/system/software/update:prepare-offline", V1, L, {"code"}, 424),
    Case("POST", "/api/system/software/update:apply", V1, L, {"code"}, 424),
    Case("DELETE", "/api/system/software/update", V1, L, {}),
    do("POST", "/api/system/control-token:release", V1, C, "fci off", report=ACTIVE),
]
# Tests of their own: a stream without an end, and what takes the robot away.
ELSEWHERE = {
    ("GET", "/api/system/sse"),
    ("POST", "/admin/api/reboot"),
    ("POST", "/desk/api/reboot"),
    ("POST", "/admin/api/shutdown"),
    ("POST", "/api/system:reboot"),
    ("POST", "/api/system:shutdown"),
}


@pytest.fixture(scope="module", params=ALL)
def profile(request):
    return PROFILES[request.param]


@pytest.fixture(scope="module")
def place(profile, tmp_path_factory):
    """A robot and its Desk, which knows the generation by the robot's newest protocol."""
    kind = "fr3" if profile.fr3 else "panda"
    with ScriptedRobot(type=kind, arm_id=kind, protocol=[3, PROTOCOLS[profile.name]]) as robot:
        with DeskServer("127.0.0.1", robot.port, tmp_path_factory.mktemp("certificates")) as desk:
            assert desk.desk.profile is profile
            yield robot, desk


def send(desk, case, token, **headers):
    body = case.body
    if case.needs is BODY:
        body = {} if token is None else {"token": token}
    elif token is not None:
        headers["X_Control_Token"] = token
    headers["Content_Type"] = FORMS if isinstance(body, bytes) else "application/json"  # also without a body
    return desk.send(case.method, case.path, body, **headers)


def of(profile):
    return [case for case in CASES if profile.name in case.where]


def controlled(profile):
    """The cases that need control, on robots that have it."""
    return [case for case in of(profile) if profile.tokens and case.needs not in (N, L)]


def is_sentence(answer):
    """Errors are sentences."""
    text = answer.json()["message"]
    return text[0].isupper() and text.endswith(".") and len(text) > 10


def test_the_table_has_every_endpoint():
    def named(method, path):
        return method, re.sub("<.*?>", "<>", path.partition("?")[0])

    expected = {named(case.method, case.template) for case in CASES} | ELSEWHERE
    assert {named(route.method, route.path) for route in ROUTES.routes} == expected


WRONG_LOGINS = {
    "none": {},
    "cookie": {"Cookie": "authorization=None"},
    "header": {"authorization": "none"},
    "password": basic(password="other"),
    "user": basic(user="other"),
    "nonsense": {"Authorization": "Basic x"},
}


@pytest.mark.parametrize("wrong", WRONG_LOGINS)
def test_without_a_login_only_public_endpoints_answer(desk, profile, wrong):
    for case in of(profile):
        answer = send(desk, case, None if case.needs is N else "any", **WRONG_LOGINS[wrong])
        # A wrong password is refused everywhere.
        public = case.needs is N and "Authorization" not in WRONG_LOGINS[wrong]
        assert answer.status == (case.ok if public else 401), case
        assert public or is_sentence(answer), case


@pytest.mark.parametrize("login", ["cookie", "header", "basic"])
def test_action_without_a_token_is_refused(desk, robot, cookie, profile, login):
    word = cookie["Cookie"].removeprefix("authorization=")
    headers = {"cookie": cookie, "header": {"authorization": word}, "basic": basic()}[login]
    for case in controlled(profile):
        answer = send(desk, case, None, **headers)
        assert answer.status == (423 if case.needs is LOCKED else 400), case
        assert is_sentence(answer)
        assert case.needs is LOCKED or "Control-Token" in answer.json()["message"]
    assert robot.lines == []


@pytest.mark.parametrize("is_taken", [False, True])
def test_a_wrong_token_is_locked(desk, robot, cookie, profile, is_taken):
    if is_taken and profile.tokens:
        desk.take_control("another", **cookie)
    for case in controlled(profile):
        answer = send(desk, case, "x" * 32, **cookie)
        assert answer.status == (404 if case.needs is BODY else 423), case
        assert case.needs is not BODY or answer.json()["error"] == "ControlTokenUnknown"
    assert robot.lines == []


def test_every_endpoint_works_with_login_and_control(place, desk, profile):
    robot, _ = place
    assert not profile.fr3 or desk.send("POST", PROFILE, TOOL_PROFILE, **basic()).status == 200
    for case in of(profile):
        robot.reset()
        change(desk, robot, **case.report)
        desk.clear()
        robot.lines.clear()
        headers = desk.log_in()
        token = desk.take_control(**headers)["token"] if profile.tokens else None
        answer = send(desk, case, token if case.needs not in (N, L) else None, **headers)
        assert answer.status == case.ok, (case, answer)
        check_fields(case, answer)
        if answer.status >= 400:
            assert is_sentence(answer)
        sent = [line for line in robot.lines if profile.tokens or line != "fci on"]  # it is always on there
        assert sent == [line for line in case.lines.split("; ") if line], case


def check_fields(case, answer):
    if case.has is None:
        return
    if case.has == EMPTY:
        assert answer.body == b"", case
        assert "json" not in answer.headers.get("Content-Type", ""), case
    elif isinstance(case.has, set):
        assert case.has <= set(answer.json()), case
    else:
        assert answer.json() == case.has and type(answer.json()) is type(case.has), case
    if case.has != EMPTY:
        assert answer.headers["Content-Type"].startswith("application/json"), case


def test_endpoints_of_the_other_generation_are_not_found(desk, profile):
    headers = {**desk.log_in(), "X_Control_Token": "x"}
    there = {case.path for case in of(profile)}
    for case in CASES:
        if case.path in there:
            continue
        answer = send(desk, case, "x", **headers)
        assert answer.status == 404, case
        if case.path.startswith("/admin/"):
            assert answer.text == "File not found"
        elif case.path.startswith("/desk/"):
            path = case.path.removeprefix("/desk").partition("?")[0]
            assert f'No handler accepted "{path}"' in answer.text
            assert answer.headers["Content-Type"].startswith("text/html")


def test_head_answers_as_get_without_a_body(desk, cookie, profile):
    for case in of(profile):
        if case.method == "GET":
            answer = desk.send("HEAD", case.path, **cookie)
            assert answer.status == 200 and answer.body == b"", case


def test_other_methods_are_refused_with_a_list_of_methods(desk):
    answer = desk.send("PATCH", "/admin/api/login")
    assert answer.status == 405 and answer.headers["Allow"] == "POST" and is_sentence(answer)
