# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""What Desk reports of a robot's states, refusals and errors, in the words of both interfaces."""

from concurrent.futures import ThreadPoolExecutor

import pytest
from desk_fixtures import desk_with_robot, fresh_desk, fresh_robot
from desk_robot import CLOSED, OPEN, REPORT
from desk_server import basic
from waiting import wait_for

SAFETY, SYSTEM = "/admin/api/safety/status", "/admin/api/system-status"
ACKNOWLEDGE = "/admin/api/safety/recoverable-safety-errors/acknowledge?error_id="
CONFIRM, RECOVERY = "/api/safety/recovery:confirm", "/api/safety/recovery"
PROFILES = "/admin/api/end-effector/profiles"
NO_INPUT = REPORT["inputs"]


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    with desk_with_robot(tmp_path_factory.mktemp("certificates")) as (robot, desk):
        yield robot, desk


@pytest.fixture
def robot(place):
    return fresh_robot(place)


@pytest.fixture
def desk(place, robot):
    return fresh_desk(place)


@pytest.fixture
def control(desk):
    headers = desk.log_in()
    return {**headers, "X_Control_Token": desk.take_control(**headers)["token"]}


def change(desk, robot, **parts):
    for name, value in parts.items():
        if isinstance(value, dict):
            robot.report[name] = {**robot.report[name], **value}
        else:
            robot.report[name] = value
    desk.refresh()


def get(desk, path):
    return desk.send("GET", path, **basic()).json()


# ---- states ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "parts, controller, mode",
    [
        ({}, "Work", "Execution"),
        ({"operating_mode": "programming"}, "Work", "Programming"),
        ({"inputs": {"x31": True}}, "Idle", "SafetyRecovery"),
        ({"self_test": {"running": True, "left": 3.0}}, "SelfTest", "SelfTest"),
        ({"recoverable": ["td2Timeout"]}, "Recovery", "SafetyRecovery"),
        ({"joint_limit_violation": [True] + [False] * 6}, "Recovery", "SafetyRecovery"),
        ({"joint_position_error": [False] * 6 + [True]}, "Recovery", "SafetyRecovery"),
    ],
)
def test_modes_in_both_interfaces(desk, robot, parts, controller, mode):
    change(desk, robot, **parts)
    assert get(desk, SAFETY)["safetyControllerStatus"] == controller
    system = get(desk, SYSTEM)
    assert system["safety"]["safetyControllerStatus"] == controller
    assert system["derived"]["operatingMode"] == mode
    assert get(desk, "/api/system/operating-mode") == {"status": mode}
    assert get(desk, "/api/system")["operatingMode"] == {"status": mode}


def test_brakes_in_both_interfaces(desk, robot):
    for closed, word, torque in ((CLOSED, "Locked", "SafeTorqueOff"), (OPEN, "Unlocked", "SafeTorqueOn")):
        change(desk, robot, brakes=closed)
        safety = get(desk, SAFETY)
        assert safety["brakeState"] == [word] * 7 and safety["stoState"] == torque
        joints = [{"joint": number, "brakeStatus": word} for number in range(1, 8)]
        assert get(desk, "/api/arm/joints") == joints


def test_inputs_errors_and_demands(desk, robot):
    change(
        desk,
        robot,
        inputs={"x32": True, "guiding": True},
        recoverable=["safeInputErrorX32"],
        joint_limit_violation=[False, True] + [False] * 5,
    )
    safety = get(desk, SAFETY)
    assert safety["safeInputState"] == {
        "guidingEnableButton": "Active",
        "x31": "Inactive",
        "x32": "Active",
        "x33": "Inactive",
        "x4": "Inactive",
    }
    errors = safety["recoverableErrors"]
    assert errors["safeInputErrorX32"] and sum(errors.values()) == 1 and len(errors) == 10
    assert safety["demandedRecoveries"]["jointLimitViolation"] == [False, True] + [False] * 5


@pytest.mark.parametrize(
    "self_test, word",
    [
        ({"due": 3600.0}, "OK"),
        ({"due": 3599.0}, "Warning"),
        ({"due": 0.0}, "Elapsed"),
        ({"running": True, "left": 2.5}, "Running"),
    ],
)
def test_self_tests(desk, robot, self_test, word):
    change(desk, robot, self_test=self_test)
    answer = get(desk, "/api/safety/self-tests")
    assert answer == {"status": word, "remaining": self_test.get("left", self_test.get("due"))}
    assert get(desk, SYSTEM)["derived"]["td2Tests"]["status"] == word


def test_lights(desk, robot):
    for color, blinking in (("yellow", True), ("white", False), ("blue", False), ("green", False)):
        change(desk, robot, light={"color": color, "blinking": blinking})
        shown = get(desk, SYSTEM)["derived"]["desiredColor"]
        assert shown == {"color": color.capitalize(), "mode": "Blinking" if blinking else "Constant"}


def test_values_of_the_robot(desk, robot):
    numbers = [float(number) for number in range(1, 17)]
    arm = {"q": numbers[:7], "tau_ext": numbers[1:8], "O_F_ext": numbers[2:8], "O_T_EE": numbers}
    axes = [True, False, False, False, True, True, False]
    change(desk, robot, **arm, hand={"width": 0.03, "max_width": 0.07}, guiding={"axes": axes})
    assert get(desk, "/desk/api/robot/configuration") == {
        "jointAngles": arm["q"],
        "estimatedTorques": arm["tau_ext"],
        "estimatedForces": arm["O_F_ext"],
        "cartesianPose": arm["O_T_EE"],
    }
    assert get(desk, "/desk/api/robot/gripper_state") == {"width": 0.03, "maxWidth": 0.07}
    names = [f"{kind}_{axis}" for kind in ("translation", "rotation") for axis in "xyz"]
    assert get(desk, "/desk/api/robot/guiding/configuration") == dict(zip([*names, "elbow"], axes))


@pytest.mark.parametrize(
    "elbow, wrist, close", [(-0.16, 0.11, False), (-0.14, 1.0, True), (-1.0, 0.09, True), (-1.0, -0.09, True)]
)
def test_a_stretched_elbow_or_wrist_is_a_warning(desk, robot, elbow, wrist, close):
    change(desk, robot, q=[0.0, 0.0, 0.0, elbow, 0.0, wrist, 0.0])
    assert get(desk, "/api/arm/warnings")["closeToSingularity"] is close
    assert get(desk, SYSTEM)["robot"]["closeToSingularity"] is close


@pytest.mark.parametrize(
    "hand, word",
    [
        ({}, "uninitialized"),
        ({"homed": True}, "initialized"),
        ({"kind": "vacuum"}, "initialized"),
        ({"kind": "none"}, "disconnected"),
    ],
)
def test_connection_of_the_hand(desk, robot, hand, word):
    change(desk, robot, hand=hand)
    assert get(desk, "/desk/api/events/gripper/hardware") == {"connection_status": word}


def test_power_and_conflicting_inputs(desk, robot):
    safety = get(desk, SAFETY)
    assert safety["powerState"] == {"endEffector": "On", "robot": "On"}
    assert not safety["safetyControllerStatusReason"]["conflictingInputs"]
    change(desk, robot, end_effector={"power": False}, light={"color": "pink"})
    safety = get(desk, SAFETY)
    assert safety["powerState"] == {"endEffector": "Off", "robot": "On"}
    assert safety["safetyControllerStatusReason"]["conflictingInputs"]


def test_errors_are_booleans_by_name_or_a_list(desk, robot):
    change(desk, robot, errors=["cartesian_reflex", "base_acceleration_invalid_reading"])
    errors = get(desk, "/desk/api/robot/status")["robotErrors"]
    assert errors["cartesianReflex"] is True and errors["jointReflex"] is False
    assert errors["baseAccelerationInvalidReading"] is True
    assert get(desk, SYSTEM)["robot"]["robotErrors"] == robot.report["errors"]


def test_a_panda_shows_its_brakes_and_switches(tmp_path):
    with desk_with_robot(tmp_path, "fer-spoc") as (robot, desk):
        change(desk, robot, brakes=OPEN)
        assert get(desk, "/desk/api/system/status")["operationalMode"] == "Operational"
        change(desk, robot, inputs={"x4": True})
        status = get(desk, "/desk/api/system/status")
        assert status["brakesOpen"] == [True] * 7 and status["operationalMode"] == "SS1"
        assert status["x3Enabled"] and not status["x4Enabled"]


def test_arrow_keys_control_the_hand_or_nothing_while_the_fci_is_active(desk, robot):
    change(desk, robot, buttons={"up": True, "cross": True})
    assert get(desk, "/desk/api/navigation/events")["up"]
    for parts in ({"navigation": "robot"}, {"navigation": "desk", "fci": True}):
        change(desk, robot, **parts)
        shown = get(desk, "/desk/api/navigation/events")
        assert shown["cross"] and not shown["up"]


# ---- refusals --------------------------------------------------------------------------------------------

ACTIONS = [
    ("POST", "/desk/api/joints/unlock", "joints", "/api/arm/joints:unlock"),
    ("POST", "/desk/api/system/fci", "fci", "/api/fci:activate"),
]


@pytest.mark.parametrize(
    "code, status",
    [
        ("BrakesClosed", 424),
        ("EmergencyStopPressed", 424),
        ("RecoverableErrorActive", 424),
        ("JointRecoveryRequired", 424),
        ("WrongOperatingMode", 424),
        ("MotionActive", 424),
        ("SelfTestRunning", 503),
        ("NotReady", 503),
    ],
)
def test_refusals_of_the_robot_have_its_code_and_sentence(desk, robot, control, code, status):
    for method, older, line, newer in ACTIONS:
        robot.answers[line] = f"error: {code}: This is why."
        answer = desk.send(method, older, **control)
        assert answer.status == status
        assert answer.json() == {
            "error": "ActionUnavailable",
            "reason": code,
            "code": "ActionUnavailable",
            "message": "This is why.",
            "details": [code],
        }
        answer = desk.send(method, newer, **control)
        assert answer.status == status
        assert answer.json() == {"code": "ActionUnavailable", "message": "This is why.", "details": [code]}


def test_the_token_in_the_body_obeys_the_same_rules(desk, robot, control):
    robot.answers["fci"] = "error: BrakesClosed: Open the brakes first."
    body = {"token": control["X_Control_Token"]}
    answer = desk.send("POST", "/admin/api/control-token/fci", body, Cookie=control["Cookie"])
    assert answer.status == 424 and answer.json()["details"] == ["BrakesClosed"]


def test_other_refusals_have_their_sentence_only(desk, robot, control):
    robot.answers["hand"] = "error: The hand has found no object."
    answer = desk.send("POST", "/desk/api/gripper/homing", **control)
    assert answer.status == 424 and answer.json()["message"] == "The hand has found no object."
    assert answer.json()["details"] == []


# ---- errors that are acknowledged ------------------------------------------------------------------------


@pytest.mark.parametrize(
    "word, name",
    [
        ("TD2Timeout", "td2Timeout"),
        ("GenericJointError", "genericJointError"),
        ("JointPosition", "jointPositionError"),
    ],
)
def test_acknowledging(desk, robot, control, word, name):
    nothing = desk.send("POST", ACKNOWLEDGE + word, **control)
    assert nothing.status == 424 and nothing.json()["reason"] == "NoAckRequired"
    change(desk, robot, recoverable=[name])
    assert get(desk, SAFETY)["recoverableErrors"][name]
    assert desk.send("POST", ACKNOWLEDGE + word, **control).status == 200
    assert not get(desk, SAFETY)["recoverableErrors"][name]
    assert desk.send("POST", ACKNOWLEDGE + "Other", **control).status == 400


@pytest.mark.parametrize(
    "recoverable, expected",
    [
        (["td2Timeout"], {"type": "SelfTestsElapsed"}),
        (["genericJointError", "td2Timeout"], {"type": "GenericJointError"}),
        (["safeInputErrorX31"], {"type": "SafeInputUnacknowledged", "safeInputs": ["x31"]}),
        (["fsoeConnectionError"], {"type": "SafetyError", "safetyErrors": ["fsoeConnectionError"]}),
    ],
)
@pytest.mark.parametrize("with_body", [True, False])
def test_recoveries_are_confirmed(desk, robot, recoverable, expected, with_body):
    assert get(desk, RECOVERY) == {}
    assert desk.send("POST", CONFIRM, **basic()).status == 424
    change(desk, robot, recoverable=list(recoverable))
    assert get(desk, RECOVERY) == {"recovery": expected}
    wrong = desk.send("POST", CONFIRM, {"type": "SafetyRuleViolation"}, **basic())
    assert wrong.status == 424 and wrong.json()["details"] == ["NoAckRequired"]
    answer = desk.send("POST", CONFIRM, expected if with_body else None, **basic())
    assert (answer.status, answer.body) == (204, b"")
    assert robot.lines == [f"acknowledge {recoverable[0]}"]


@pytest.mark.parametrize(
    "part, kind",
    [("joint_limit_violation", "JointLimitViolation"), ("joint_position_error", "JointPositionError")],
)
def test_joints_are_recovered_by_the_operator_only(desk, robot, part, kind):
    change(desk, robot, **{part: [True] + [False] * 6})
    assert get(desk, RECOVERY) == {"recovery": {"type": kind}}
    robot.answers["acknowledge"] = "error: JointRecoveryRequired: A joint needs manual recovery."
    answer = desk.send("POST", CONFIRM, {"type": kind}, **basic())
    assert answer.status == 424 and answer.json()["details"] == ["JointRecoveryRequired"]


def test_a_refused_recovery_acknowledges_nothing(desk, robot):
    change(desk, robot, recoverable=["jointPositionError"], joint_position_error=[True] + [False] * 6)
    refusal = "error: JointRecoveryRequired: A joint needs manual recovery."
    robot.answers["acknowledge jointPositionErrorDemand"] = refusal
    assert desk.send("POST", CONFIRM, {"type": "JointPositionError"}, **basic()).status == 424
    assert robot.report["recoverable"] == ["jointPositionError"]


# ---- self-tests ------------------------------------------------------------------------------------------


def test_a_refused_self_test_stays_overdue(desk, robot, control):
    change(desk, robot, recoverable=["td2Timeout"])
    robot.answers["self_test"] = "error: EmergencyStopPressed: A stop is pressed; release it."
    answer = desk.send("POST", "/api/safety/self-tests:execute", **control)
    assert answer.status == 424 and answer.json()["details"] == ["EmergencyStopPressed"]
    assert robot.lines[-1] == "inject td2Timeout on"


def test_a_self_test_is_started_or_waited_for(desk, robot, control):
    def start(*words):
        robot.report["self_test"]["running"] = True
        return "ok"

    robot.answers["self_test"] = start
    answer = desk.send("POST", "/admin/api/safety/td2-tests/execute", **control)
    assert answer.json() == {"code": "SuccessResponse"}
    assert get(desk, SAFETY)["safetyControllerStatus"] == "SelfTest"

    # The newer interface answers at the end.
    with ThreadPoolExecutor(1) as executor:
        answer = executor.submit(desk.send, "POST", "/api/safety/self-tests:execute", **control)
        wait_for(lambda: robot.lines.count("self_test") == 2)
        desk.refresh()
        assert not answer.done()
        robot.report["self_test"].update(running=False, due=86400.0)
        assert answer.result(60.0).status == 204
    assert get(desk, "/api/safety/self-tests")["status"] == "OK"


# ---- end effectors ---------------------------------------------------------------------------------------

INERTIAL = {
    "mass": 0.5,
    "centerOfMass": {"x": 0.0, "y": 0.01, "z": 0.05},
    "inertia": {"x11": 0.01, "x12": 0.001, "x13": 0.0, "x22": 0.02, "x23": 0.0, "x33": 0.03},
}
TCP = {"translation": {"x": 0.0, "y": 0.0, "z": 0.1}, "rotation": {"roll": 0.1, "pitch": 0.2, "yaw": 0.3}}
TOOL = {"name": "tool", "deviceId": "ee-no-gripper", "inertial": INERTIAL, "tcp": TCP}


def numbers_of(line):
    word, *numbers = line.split()
    assert word == "end_effector" and len(numbers) == 29
    return [float(number) for number in numbers]


def test_a_profile_is_added_activated_changed_and_deleted(desk, robot, control):
    id = desk.send("POST", PROFILES, TOOL, **control).json()["id"]
    assert desk.send("PUT", f"{PROFILES}/active", id, **basic()).status == 423
    assert desk.send("PUT", f"{PROFILES}/active", id, **control).status == 200
    numbers = numbers_of(robot.lines[-1])
    assert numbers[:4] == [0.5, 0.0, 0.01, 0.05]
    assert numbers[4:13] == [0.01, 0.001, 0.0, 0.001, 0.02, 0.0, 0.0, 0.0, 0.03]
    from scipy.spatial.transform import Rotation

    turn = Rotation.from_euler("xyz", [0.1, 0.2, 0.3]).as_matrix().T.reshape(-1)
    pose = numbers[13:]
    assert [*pose[0:3], *pose[4:7], *pose[8:11]] == pytest.approx(list(turn))
    assert pose[12:] == [0.0, 0.0, 0.1, 1.0]
    active = get(desk, f"{PROFILES}/active")
    assert active["id"] == id and active["inertial"] == INERTIAL
    assert active["tcp"]["translation"] == TCP["translation"]
    assert active["tcp"]["rotation"] == pytest.approx(TCP["rotation"])
    assert [each["active"] for each in get(desk, PROFILES)].count(True) == 1

    heavier = {**TOOL, "inertial": {**INERTIAL, "mass": 0.6}}
    assert desk.send("PUT", f"{PROFILES}/{id}", heavier, **basic()).status == 423
    assert desk.send("PUT", f"{PROFILES}/{id}", heavier, **control).status == 200
    assert numbers_of(robot.lines[-1])[0] == 0.6
    assert desk.send("DELETE", f"{PROFILES}/{id}", **control).status == 409
    assert desk.send("PUT", f"{PROFILES}/active", "ee-no-profile", **control).status == 200
    assert numbers_of(robot.lines[-1])[:13] == [0.0] * 13
    assert desk.send("DELETE", f"{PROFILES}/{id}", **control).status == 200
    for method in ("PUT", "DELETE"):
        assert desk.send(method, f"{PROFILES}/ee-no-profile", TOOL, **control).status == 409


def test_a_profile_that_the_robot_refuses_is_not_active(desk, robot, control):
    id = desk.send("POST", PROFILES, TOOL, **control).json()["id"]
    before = get(desk, f"{PROFILES}/active")["id"]
    robot.answers["end_effector"] = "error: MotionActive: Stop the motion first."
    assert desk.send("PUT", f"{PROFILES}/active", id, **control).status == 424
    assert get(desk, f"{PROFILES}/active")["id"] == before


def test_the_configuration_sets_the_end_effector(desk, robot):
    params = {**INERTIAL, "transformation": TCP}
    change_it = {"endEffectorConfiguration": {"endEffector": {"name": "Other", "params": params}}}
    assert desk.send("PATCH", "/api/configuration", change_it, **basic()).status == 204
    assert numbers_of(robot.lines[-1])[0] == 0.5
    shown = get(desk, "/api/configuration")["endEffectorConfiguration"]
    assert shown == change_it["endEffectorConfiguration"]


# ---- options ---------------------------------------------------------------------------------------------


def test_options_of_errors_and_of_the_system(tmp_path):
    options = {
        "no_acknowledge_status": 404,
        "recovery_type_on_top": True,
        "time_to_td2_in_system": True,
        "version": "5.3.1",
        "serial_number": "123456-7654321",
    }
    with desk_with_robot(tmp_path, report={"recoverable": ["td2Timeout"]}, **options) as (_, desk):
        kind = "SelfTestsElapsed"
        assert get(desk, RECOVERY) == {"type": kind, "recovery": {"type": kind}}
        system = get(desk, "/api/system")
        assert system["safety"] == {"timeToTd2": 86400.0}
        assert system["controlSerialNumber"] == "123456-7654321"
        lines = get(desk, "/admin/api/system-version").split("\n")
        assert lines[0] == "5.3.1" and [len(line) for line in lines[1:]] == [40, 40]
        token = desk.take_control(**desk.log_in())["token"]
        headers = {**basic(), "X_Control_Token": token}
        assert desk.send("POST", ACKNOWLEDGE + "GenericJointError", **headers).status == 404


def test_with_an_option_the_fci_may_be_activated_before_the_brakes_open(tmp_path):
    with desk_with_robot(tmp_path, fci_before_unlock=True) as (robot, desk):
        headers = {**basic(), "X_Control_Token": desk.take_control(**desk.log_in())["token"]}
        assert desk.send("POST", "/api/fci:activate", **headers).status == 204
        assert get(desk, "/api/fci") == {"status": "Inactive"} and robot.lines == []
        assert desk.send("POST", "/api/arm/joints:unlock", **headers).status == 204
        wait_for(lambda: get(desk, "/api/fci") == {"status": "Active"})


def test_with_an_option_the_fci_comes_back_after_a_stop(tmp_path):
    with desk_with_robot(tmp_path, fci_after_stop=True, report={"fci": True, "brakes": OPEN}) as (
        robot,
        desk,
    ):
        change(desk, robot, inputs={"x31": True}, fci=False, brakes=CLOSED)
        change(desk, robot, inputs={"x31": False})
        assert robot.lines == []
        change(desk, robot, brakes=OPEN)
        wait_for(lambda: robot.lines == ["fci on"])
