# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Every endpoint of Desk, with every kind of login and control token, on robots of every generation.

The table below says what is expected; another test compares it with the endpoints that exist.
"""

from __future__ import annotations

import enum
import typing
from dataclasses import dataclass

import pytest
from desk_server import DeskServer, basic
from pyfranka.desk.profiles import PROFILES
from pyfranka.desk.robot import PORT
from pyfranka.desk.server import ROUTES
from pyfranka.franka_sim import FrankaSim
from pyfranka.sim import KINDS

ALL = tuple(PROFILES)
PROTOCOLS = {"fer-old": 4, "fer-spoc": 5, "fr3-early": 7, "fr3-v1": 10}
FER = ("fer-old", "fer-spoc")
FR3 = ("fr3-early", "fr3-v1")
TOKENS = ("fer-spoc", "fr3-early", "fr3-v1")
V1 = ("fr3-v1",)
TOKEN = "<the active token>"
EMPTY = ""  # a body that is empty


class Needs(enum.Enum):
    NOTHING = "no login"
    LOGIN = "a login"
    CONTROL = "the token as header"
    CONTROL_OR_FORM = "the token as header or in the form"
    CONTROL_LOCKED = "the token as header; 423 without"
    BODY_TOKEN = "the token in the body"


@dataclass(frozen=True)
class Case:
    """ok: the status of success. has: members of the answer, or an answer. pattern: the path of the route, if
    it has variable parts. before: lines to the robot, for success."""

    method: str
    path: str
    where: tuple[str, ...] = ALL
    needs: Needs = Needs.LOGIN
    ok: int = 200
    body: typing.Any = None
    has: typing.Any = None
    form: str = ""
    pattern: str = ""
    before: tuple[str, ...] = ()

    def __str__(self) -> str:
        return f"{self.method} {self.path}"


LOGIN_BODY = {"login": "franka", "password": "bm90IHRoaXM="}
INERTIA = {"x11": 0.01, "x12": 0.0, "x13": 0.0, "x22": 0.01, "x23": 0.0, "x33": 0.01}
INERTIAL = {"mass": 1.0, "centerOfMass": {"x": 0.0, "y": 0.01, "z": 0.05}, "inertia": INERTIA}
TCP = {
    "translation": {"x": 0.0, "y": 0.0, "z": 0.1},
    "rotation": {"roll": 0.0, "pitch": 0.0, "yaw": -0.785},
}
NEW_PROFILE = {"name": "Screwdriver", "deviceId": "ee-no-gripper", "inertial": INERTIAL, "tcp": TCP}
SETTINGS = {
    "mass": 0.5,
    "centerOfMass": [0.0, 0.0, 0.05],
    "inertia": [0.001, 0, 0, 0, 0.001, 0, 0, 0, 0.001],
    "transformation": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0.1, 1],
}
SAFETY = {
    "sequenceNumber",
    "safetyControllerStatus",
    "brakeState",
    "stoState",
    "timeToTd2",
    "activeWarnings",
    "demandedRecoveries",
    "recoverableErrors",
    "activeRecovery",
    "safeInputState",
    "powerState",
    "safetyControllerStatusReason",
    "safetyConfigurationIndex",
    "fsoeConnectionStatus",
}
SYSTEM = {"execution", "safety", "robot", "processes", "startup", "controlToken", "derived", "firstStart"}
BUTTONS = {"circle", "cross", "check", "up", "down", "left", "right"}
ACKNOWLEDGE = "/admin/api/safety/recoverable-safety-errors/acknowledge"
PROFILE = "/admin/api/end-effector/profiles"
OPEN = ("joints unlock",)
ERROR = ("inject genericJointError off", "inject genericJointError on")
N, L, C = Needs.NOTHING, Needs.LOGIN, Needs.CONTROL

CASES = [
    # ---- the older interface: login ----
    Case("POST", "/admin/api/login", needs=N, ok=401, body=LOGIN_BODY, has={"error"}),
    Case("GET", "/admin/login", needs=N),
    Case("GET", "/admin/api/first-start", needs=N, has=False),
    Case("GET", "/admin/api/startup-phase", needs=N, has={"tag"}),
    Case("POST", "/admin/api/logout", has=EMPTY),
    # ---- control ----
    Case("GET", "/admin/api/control-token", TOKENS, N, has={"activeToken", "fciActive", "tokenRequest"}),
    Case("POST", "/admin/api/control-token/request", TOKENS, body={"requestedBy": "me"}, has={"id", "token"}),
    Case(
        "DELETE",
        "/admin/api/control-token/request/7",
        TOKENS,
        ok=404,
        body={"token": "none"},
        has={"error"},
        pattern="/admin/api/control-token/request/<id>",
    ),
    Case(
        "POST",
        "/admin/api/control-token/fci",
        TOKENS,
        Needs.BODY_TOKEN,
        body={"token": TOKEN},
        has=EMPTY,
        before=OPEN,
    ),
    Case(
        "DELETE", "/admin/api/control-token/fci", TOKENS, Needs.BODY_TOKEN, body={"token": TOKEN}, has=EMPTY
    ),
    Case("DELETE", "/admin/api/control-token", TOKENS, Needs.BODY_TOKEN, body={"token": TOKEN}, has=EMPTY),
    Case("GET", "/admin/api/safety", TOKENS, has={"tokenForceTimeout"}),
    # ---- brakes, FCI, modes ----
    Case("POST", "/desk/api/robot/open-brakes", FER, C, has=EMPTY),
    Case("POST", "/desk/api/robot/close-brakes", FER, has=EMPTY),
    Case("POST", "/desk/api/joints/unlock", FR3, C, has=EMPTY),
    Case("POST", "/desk/api/system/fci", FR3, Needs.CONTROL_OR_FORM, has=EMPTY, before=OPEN),
    Case("DELETE", "/desk/api/system/fci", FR3, Needs.CONTROL_OR_FORM, has=EMPTY),
    Case("POST", "/desk/api/operating-mode/programming", FR3, C, has=EMPTY),
    Case("POST", "/desk/api/operating-mode/execution", FR3, C, has=EMPTY),
    Case("POST", "/desk/api/joints/lock", FR3, has=EMPTY),
    Case("PUT", "/desk/api/robot/guiding/mode", needs=C, form='mode="translation"', has=EMPTY),
    Case("PUT", "/desk/api/navigation/mode", needs=C, form='mode="one"', has=EMPTY),
    Case("POST", "/desk/api/gripper/homing", needs=C, has=EMPTY, before=OPEN),
    Case("POST", "/desk/api/execution", form="id=task", has=EMPTY),
    Case("DELETE", "/desk/api/execution", form="id=task", has=EMPTY),
    Case("GET", "/desk/api/execution", has={"lastActivePath", "running"}),
    Case("POST", "/desk/api/robot/reset-errors", needs=C, has=EMPTY),
    Case("POST", "/desk/api/robot/fold", needs=C, has=EMPTY, before=OPEN),
    Case("POST", "/desk/api/robot/restart", FER, has=EMPTY),
    *(
        case
        for prefix in ("/desk", "/admin")
        for case in (
            Case("GET", f"{prefix}/api/robot/shutdown-position-error", FER, has=[False] * 7),
            Case(
                "DELETE",
                f"{prefix}/api/robot/shutdown-position-error/3",
                FER,
                C,
                has=EMPTY,
                pattern=f"{prefix}/api/robot/shutdown-position-error/<joint>",
            ),
        )
    ),
    # ---- system ----
    Case("GET", "/admin/api/system-version", needs=N),
    Case("GET", "/admin/api/robot/nameplate", has={"serialNumber"}),
    Case("GET", "/admin/api/features", has={"fci"}),
    Case("GET", "/admin/api/safety/status", FR3, N, has=SAFETY),
    Case("GET", "/admin/api/system-status", FR3, N, has=SYSTEM),
    Case(
        "POST",
        ACKNOWLEDGE + "?error_id=GenericJointError",
        FR3,
        C,
        has=EMPTY,
        pattern=ACKNOWLEDGE,
        before=ERROR,
    ),
    Case("POST", "/admin/api/safety/td2-tests/execute", FR3, C, has={"code": "SuccessResponse"}),
    # ---- end effectors ----
    Case("GET", "/admin/api/end-effectors/selection", FER, has="ee-gripper"),
    Case("PUT", "/admin/api/end-effectors/selection", FER, C, body="ee-no-gripper", has=EMPTY),
    Case("PUT", "/admin/api/end-effectors/selection", FER, C, body="ee-gripper", has=EMPTY),
    Case("GET", "/admin/api/end-effector-configuration", FER, has=set(SETTINGS)),
    Case("POST", "/admin/api/end-effector-configuration", FER, C, body=SETTINGS, has=EMPTY),
    Case("GET", PROFILE, FR3),
    Case("POST", PROFILE, FR3, body=NEW_PROFILE, has={"id"}),
    Case("GET", f"{PROFILE}/active", FR3, has={"id", "name", "deviceId", "active", "inertial", "tcp"}),
    Case("PUT", f"{PROFILE}/active", FR3, Needs.CONTROL_LOCKED, body="ee-no-profile", has=EMPTY),
    Case("PUT", f"{PROFILE}/ee-profile-1", FR3, body=NEW_PROFILE, has=EMPTY, pattern=f"{PROFILE}/<id>"),
    Case("DELETE", f"{PROFILE}/nobody", FR3, ok=404, pattern=f"{PROFILE}/<id>"),
    # ---- what WebSockets send too ----
    Case("GET", "/admin/api/processes", has="Up"),
    Case("GET", "/admin/api/end-effector", has={"id"}),
    Case("GET", "/desk/api/navigation/events", has=BUTTONS),
    Case(
        "GET",
        "/desk/api/robot/configuration",
        has={"jointAngles", "cartesianPose", "estimatedTorques", "estimatedForces"},
    ),
    Case("GET", "/desk/api/system/status", FER, has={"brakesOpen", "operationalMode", "x4Enabled"}),
    Case("GET", "/desk/api/system/status", FR3, has={"jointStatus", "lifetimeConfirmationNeeded"}),
    Case("GET", "/desk/api/robot/status", has={"robotErrors", "recoveryMode", "endEffectorConfiguration"}),
    Case("GET", "/desk/api/robot/gripper_state", has={"width", "maxWidth"}),
    Case("GET", "/desk/api/events/gripper/hardware", has={"connection_status"}),
    Case("GET", "/desk/api/pilot/hardware", has={"connectionStatus": "connected"}),
    Case("GET", "/desk/api/base-leds/hardware", has={"connectionStatus": "connected"}),
    Case("GET", "/desk/api/robot/guiding/mode"),
    Case("GET", "/desk/api/robot/guiding/configuration", has={"translation_x", "rotation_z", "elbow"}),
    Case("GET", "/desk/api/navigation/mode"),
    *(Case("GET", f"/desk/api/{name}", has=[]) for name in ("notification", "timelines", "skills", "groups")),
    # ---- the newer interface ----
    Case("GET", "/api/system", V1, N, has={"status", "operatingMode", "controlSerialNumber", "cloud"}),
    Case("GET", "/api/system/operating-mode", V1, N, has={"status"}),
    Case("GET", "/api/system/control-token", V1, N, has={"owner", "tokenId", "requester"}),
    Case("GET", "/api/fci", V1, N, has={"status"}),
    Case("GET", "/api/arm", V1, N, has={"status": "Connected", "armType": "FR3"}),
    Case("GET", "/api/arm/joints", V1, N),
    Case("GET", "/api/arm/warnings", V1, N, has={"closeToSingularity"}),
    Case("GET", "/api/end-effector/power", V1, N, has={"status"}),
    Case("GET", "/api/safety/self-tests", V1, has={"status", "remaining"}),
    Case("GET", "/api/safety/recovery", V1, has={}),
    Case(
        "GET",
        "/api/configuration",
        V1,
        has={"endEffectorConfiguration", "networkConfiguration", "userConfiguration"},
    ),
    Case("GET", "/api/configuration/arm-mounting", V1, has={"orientation"}),
    *(
        Case("GET", f"/api/system/{name}", V1)
        for name in (
            "log",
            "log/public/cyclic",
            "log/public/events",
            "software",
            "software/status-token",
            "software/update",
        )
    ),
    Case(
        "POST",
        "/api/system/control-token:take",
        V1,
        ok=424,
        body={"owner": "me", "timeout": 0.01},
        has={"code"},
    ),
    Case("POST", "/api/arm/joints:unlock", V1, C, 204, has=EMPTY, before=("joints lock",)),
    Case(
        "POST",
        "/api/system/operating-mode:change",
        V1,
        C,
        204,
        body={"desiredOperatingMode": "Execution"},
        has=EMPTY,
    ),
    Case("POST", "/api/fci:activate", V1, C, 204, has=EMPTY),
    Case("POST", "/api/fci:deactivate", V1, C, 204, has=EMPTY),
    Case("POST", "/api/arm/motion:start", V1, C, 204, body={"type": "MoveToPackPose"}, has=EMPTY),
    Case("POST", "/api/arm/motion:stop", V1, C, 204, has=EMPTY),
    Case("POST", "/api/arm/joints:lock", V1, L, 204, has=EMPTY),
    Case("POST", "/api/end-effector/power:off", V1, C, 204, has=EMPTY),
    Case("POST", "/api/end-effector/power:on", V1, C, 204, has=EMPTY),
    Case("POST", "/api/safety/self-tests:execute", V1, C, 204, has=EMPTY),
    *(
        Case(
            "POST",
            f"/api/safety/recovery:{verb}",
            V1,
            L,
            204,
            has=EMPTY,
            before=ERROR,
        )
        for verb in ("confirm", "start")
    ),
    Case("PATCH", "/api/configuration", V1, L, 204, body={}, has=EMPTY),
    Case(
        "PUT",
        "/api/configuration/arm-mounting",
        V1,
        C,
        204,
        body={"orientation": {"roll": 0, "pitch": 0, "yaw": 1.5}},
        has=EMPTY,
    ),
    Case("PUT", "/api/configuration/initial", V1, L, 204, body={}, has=EMPTY),
    *(
        Case("POST", f"/api/system/software/update:{verb}", V1, ok=424, has={"code"})
        for verb in ("prepare-online", "prepare-offline", "apply")
    ),
    Case("DELETE", "/api/system/software/update", V1, has={}),
    Case("POST", "/api/system/control-token:release", V1, C, 204, has=EMPTY),
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
def desk(profile, tmp_path_factory):
    """Desk of a robot that has just been switched on. It knows the generation by the robot's protocol."""
    kind = "fr3" if profile.fr3 else "panda"
    robot = KINDS[kind](protocol=PROTOCOLS[profile.name])
    folder = tmp_path_factory.mktemp("certificates")
    with FrankaSim(robot, start="locked") as sim:
        for line in ("timing brakes 0.1", "timing self_test 0.1"):
            sim.robot.remote.send(line)
        with DeskServer(sim.robot.address, PORT, folder) as desk:
            assert desk.desk.profile is profile
            yield desk


@pytest.fixture(autouse=True)
def fresh(desk):
    desk.clear()


def send(desk, case, token, **headers):
    body = case.body
    if isinstance(body, dict) and body.get("token") == TOKEN:
        body = {} if token is None else {"token": token}
    elif token is not None:
        headers["X_Control_Token"] = token
    if case.form:
        body = case.form.encode()
        headers["Content_Type"] = "application/x-www-form-urlencoded"
    return desk.send(case.method, case.path, body, **headers)


def of(profile):
    return [case for case in CASES if profile.name in case.where]


def control_of(desk, profile, headers):
    return desk.take_control(**headers)["token"] if profile.tokens else None


def is_sentence(answer):
    """Errors are sentences."""
    text = answer.json()["message"]
    return text[0].isupper() and text.endswith(".") and len(text) > 10


def test_the_table_has_every_endpoint():
    expected = {(case.method, case.pattern or case.path) for case in CASES} | ELSEWHERE
    assert {(route.method, route.path) for route in ROUTES.routes} == expected


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
def test_action_without_a_token_is_refused(desk, profile, login):
    statuses = {C: 400, Needs.CONTROL_OR_FORM: 400, Needs.BODY_TOKEN: 400, Needs.CONTROL_LOCKED: 423}
    cookie = desk.log_in()
    word = cookie["Cookie"].removeprefix("authorization=")
    headers = {"cookie": cookie, "header": {"authorization": word}, "basic": basic()}[login]
    sent = len(desk.lines)
    for case in of(profile):
        if case.needs in statuses and profile.tokens:
            answer = send(desk, case, None, **headers)
            assert answer.status == statuses[case.needs], case
            assert is_sentence(answer)
            if answer.status == 400:
                assert "Control-Token" in answer.json()["message"]
    assert desk.lines[sent:] == []


def test_a_wrong_token_is_locked(desk, profile):
    headers, sent = desk.log_in(), len(desk.lines)
    for case in of(profile):
        if not profile.tokens or case.needs in (N, L):
            continue
        for taken in (False, True):
            if taken:
                desk.take_control("another", **headers)
            answer = send(desk, case, "x" * 32, **headers)
            if case.needs is Needs.BODY_TOKEN:
                assert answer.status == 404 and answer.json()["error"] == "ControlTokenUnknown", case
            else:
                assert answer.status == 423, case
    assert desk.lines[sent:] == []


def test_every_endpoint_works_with_login_and_control(desk, profile):
    headers = desk.log_in()
    token = control_of(desk, profile, headers)
    if profile.fr3:  # the case that changes a profile comes before the one that adds it has an effect
        assert desk.send("POST", PROFILE, NEW_PROFILE, **headers).status == 200
    for case in of(profile):
        desk.prepare(case.before)
        answer = send(desk, case, token if case.needs not in (N, L) else None, **headers)
        assert answer.status == case.ok, (case, answer)
        check_fields(case, answer)
        if answer.status >= 400:
            assert is_sentence(answer)
        if case.path.endswith(("logout", "control-token", "request", ":release")):
            desk.clear()
            headers = desk.log_in()
            token = control_of(desk, profile, headers)


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
    there = {(case.method, case.path) for case in of(profile)}
    for case in CASES:
        others = {each.path for each in of(profile)}
        if (case.method, case.path) in there or case.path in others:
            continue
        answer = send(desk, case, "x", **headers)
        assert answer.status == 404, case
        if case.path.startswith("/admin/"):
            assert answer.text == "File not found"
        elif case.path.startswith("/desk/"):
            path = case.path.removeprefix("/desk").partition("?")[0]
            assert f'No handler accepted "{path}"' in answer.text
            assert answer.headers["Content-Type"].startswith("text/html")


def test_head_answers_as_get_without_a_body(desk, profile):
    headers = desk.log_in()
    for case in of(profile):
        if case.method == "GET":
            answer = desk.send("HEAD", case.path, **headers)
            assert answer.status == 200 and answer.body == b"", case


def test_other_methods_are_refused_with_a_list_of_methods(desk, profile):
    answer = desk.send("PATCH", "/admin/api/login")
    assert answer.status == 405 and answer.headers["Allow"] == "POST" and is_sentence(answer)


def test_leading_slashes_may_be_repeated(desk, profile):
    headers = desk.log_in()
    for slashes in ("/", "//", "///"):
        answer = desk.send("GET", slashes + "desk/api/robot/configuration", **headers)
        assert answer.status == 200 and len(answer.json()["jointAngles"]) == 7
