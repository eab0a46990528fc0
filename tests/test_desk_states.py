# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""What Desk reports of a robot's states, refusals and errors, in the words of both interfaces."""

import pytest
from desk_bodies import CONFIGURATION, INERTIAL, PROFILE, TCP
from desk_robot import CLOSED, OPEN
from desk_server import basic
from pyfranka.desk.status import RECOVERABLE
from scripted_desk import change, desk_with_robot
from waiting import wait_for

pytest_plugins = ["desk_fixtures"]

SAFETY, SYSTEM = "/admin/api/safety/status", "/admin/api/system-status"
JOINTS, WARNINGS, SELF_TESTS = "/api/arm/joints", "/api/arm/warnings", "/api/safety/self-tests"
HAND, BUTTONS = "/desk/api/events/gripper/hardware", "/desk/api/navigation/events"
ACKNOWLEDGE = "/admin/api/safety/recoverable-safety-errors/acknowledge?error_id="
CONFIRM, RECOVERY = "/api/safety/recovery:confirm", "/api/safety/recovery"
PROFILES = "/admin/api/end-effector/profiles"


def get(desk, path):
    return desk.send("GET", path, **basic()).json()


def flags(*joints):
    """One for each joint; those with these numbers are set."""
    return [joint in joints for joint in range(1, 8)]


# ---- states ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "parts, controller, mode",
    [
        ({}, "Work", "Execution"),
        ({"operating_mode": "programming"}, "Work", "Programming"),
        ({"inputs": {"x31": True}}, "Idle", "SafetyRecovery"),
        ({"self_test": {"running": True, "left": 3.0}}, "SelfTest", "SelfTest"),
        ({"recoverable": ["td2Timeout"]}, "Recovery", "SafetyRecovery"),
        ({"joint_limit_violation": flags(1)}, "Recovery", "SafetyRecovery"),
        ({"joint_position_error": flags(7)}, "Recovery", "SafetyRecovery"),
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


def joints(word):
    return [{"joint": number, "brakeStatus": word} for number in range(1, 8)]


INPUTS = {"guidingEnableButton": "Active", "x31": "Inactive", "x32": "Active", "x33": "Inactive"}
# What the robot reports, a path, the members that lead to a part of its answer, and that part.
SHOWN = [
    ({"brakes": CLOSED}, JOINTS, "", joints("Locked")),
    ({"brakes": OPEN}, JOINTS, "", joints("Unlocked")),
    ({"brakes": CLOSED}, SAFETY, "brakeState", ["Locked"] * 7),
    ({"brakes": CLOSED}, SAFETY, "stoState", "SafeTorqueOff"),
    ({"brakes": OPEN}, SAFETY, "brakeState", ["Unlocked"] * 7),
    ({"brakes": OPEN}, SAFETY, "stoState", "SafeTorqueOn"),
    ({"inputs": {"x32": True, "guiding": True}}, SAFETY, "safeInputState", {**INPUTS, "x4": "Inactive"}),
    *(
        ({"recoverable": [name]}, SAFETY, "recoverableErrors", {each: each == name for each in RECOVERABLE})
        for name in RECOVERABLE
    ),
    ({"joint_limit_violation": flags(2)}, SAFETY, "demandedRecoveries jointLimitViolation", flags(2)),
    ({"joint_position_error": flags(3)}, SAFETY, "demandedRecoveries jointPositionError", flags(3)),
    ({}, SAFETY, "powerState", {"endEffector": "On", "robot": "On"}),
    ({"self_test": {"running": True}}, SAFETY, "powerState", {"endEffector": "On", "robot": "Off"}),
    ({"end_effector": {"power": False}}, SAFETY, "powerState", {"endEffector": "Off", "robot": "On"}),
    ({}, SAFETY, "safetyControllerStatusReason conflictingInputs", False),
    ({"light": {"color": "pink"}}, SAFETY, "safetyControllerStatusReason conflictingInputs", True),
    ({"self_test": {"due": 3600.0}}, SELF_TESTS, "", {"status": "OK", "remaining": 3600.0}),
    ({"self_test": {"due": 3599.0}}, SELF_TESTS, "", {"status": "Warning", "remaining": 3599.0}),
    ({"self_test": {"due": 0.0}}, SELF_TESTS, "", {"status": "Elapsed", "remaining": 0.0}),
    ({"self_test": {"running": True, "left": 2.5}}, SELF_TESTS, "", {"status": "Running", "remaining": 2.5}),
    ({"self_test": {"due": 0.0}}, SYSTEM, "derived td2Tests status", "Elapsed"),
    ({"light": {"blinking": True}}, SYSTEM, "derived desiredColor", {"color": "Yellow", "mode": "Blinking"}),
    ({"light": {"color": "blue"}}, SYSTEM, "derived desiredColor", {"color": "Blue", "mode": "Constant"}),
    # A stretched elbow or wrist is a warning.
    ({"q": [0.0, 0.0, 0.0, -0.16, 0.0, 0.11, 0.0]}, WARNINGS, "closeToSingularity", False),
    ({"q": [0.0, 0.0, 0.0, -0.14, 0.0, 1.0, 0.0]}, WARNINGS, "closeToSingularity", True),
    ({"q": [0.0, 0.0, 0.0, -1.0, 0.0, 0.09, 0.0]}, WARNINGS, "closeToSingularity", True),
    ({"q": [0.0, 0.0, 0.0, -1.0, 0.0, -0.09, 0.0]}, WARNINGS, "closeToSingularity", True),
    ({"q": [0.0, 0.0, 0.0, -1.0, 0.0, -0.09, 0.0]}, SYSTEM, "robot closeToSingularity", True),
    ({}, HAND, "connection_status", "uninitialized"),
    ({"hand": {"homed": True}}, HAND, "connection_status", "initialized"),
    ({"hand": {"kind": "vacuum"}}, HAND, "connection_status", "initialized"),
    ({"hand": {"kind": "none"}}, HAND, "connection_status", "disconnected"),
    # Errors are booleans by name, or a list; those without a name of the table are added.
    ({"errors": ["cartesian_reflex"]}, SYSTEM, "robot robotErrors", ["cartesian_reflex"]),
    ({"errors": ["cartesian_reflex"]}, "/desk/api/robot/status", "robotErrors cartesianReflex", True),
    ({"errors": ["cartesian_reflex"]}, "/desk/api/robot/status", "robotErrors jointReflex", False),
    ({"errors": ["base_fault"]}, "/desk/api/robot/status", "robotErrors baseFault", True),
    # Arrow keys control the hand, or nothing while the FCI is active.
    ({"buttons": {"up": True}}, BUTTONS, "up", True),
    ({"buttons": {"up": True}, "navigation": "robot"}, BUTTONS, "up", False),
    ({"buttons": {"up": True}, "fci": True}, BUTTONS, "up", False),
    ({"buttons": {"cross": True}, "fci": True}, BUTTONS, "cross", True),
]


@pytest.mark.parametrize("parts, path, members, expected", SHOWN, ids=lambda each: str(each)[:40])
def test_what_the_robot_reports_is_shown(desk, robot, parts, path, members, expected):
    change(desk, robot, **parts)
    shown = get(desk, path)
    for member in members.split():
        shown = shown[member]
    assert shown == expected


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


def test_a_panda_shows_its_brakes_and_switches(tmp_path):
    with desk_with_robot(tmp_path, "fer-spoc") as (robot, desk):
        change(desk, robot, brakes=OPEN)
        assert get(desk, "/desk/api/system/status")["operationalMode"] == "Operational"
        change(desk, robot, inputs={"x4": True})
        status = get(desk, "/desk/api/system/status")
        assert status["brakesOpen"] == [True] * 7 and status["operationalMode"] == "SS1"
        assert status["x3Enabled"] and not status["x4Enabled"]


# ---- refusals --------------------------------------------------------------------------------------------


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
        ("", 424),
    ],
)
def test_refusals_of_the_robot_have_its_code_and_sentence(desk, robot, control, code, status):
    robot.answers["joints"] = f"error: {code}: This is why." if code else "error: This is why."
    newer = {"code": "ActionUnavailable", "message": "This is why.", "details": [code] if code else []}
    answer = desk.send("POST", "/api/arm/joints:unlock", **control)
    assert (answer.status, answer.json()) == (status, newer)
    answer = desk.send("POST", "/desk/api/joints/unlock", **control)
    older = {"error": "ActionUnavailable", "reason": code or "ActionUnavailable"}
    assert (answer.status, answer.json()) == (status, {**newer, **older})


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
    "part, kind, name",
    [
        ("joint_limit_violation", "JointLimitViolation", "jointLimitViolation"),
        ("joint_position_error", "JointPositionError", "jointPositionErrorDemand"),
    ],
)
def test_a_refused_recovery_of_a_joint_acknowledges_nothing(desk, robot, part, kind, name):
    change(desk, robot, **{part: flags(1)})
    assert get(desk, RECOVERY) == {"recovery": {"type": kind}}
    change(desk, robot, recoverable=["jointPositionError"])
    robot.answers["acknowledge"] = "error: JointRecoveryRequired: A joint needs manual recovery."
    answer = desk.send("POST", CONFIRM, {"type": kind}, **basic())
    assert answer.status == 424 and answer.json()["details"] == ["JointRecoveryRequired"]
    assert robot.lines == [f"acknowledge {name}"]


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
    answer = desk.begin("POST", "/api/safety/self-tests:execute", **control)
    wait_for(lambda: robot.lines.count("self_test") == 2)
    desk.refresh()
    assert not answer.done()
    robot.report["self_test"].update(running=False, due=86400.0)
    assert answer.result(60.0).status == 204
    assert get(desk, SELF_TESTS)["status"] == "OK"


# ---- end effectors ---------------------------------------------------------------------------------------


def numbers_of(line):
    word, *numbers = line.split()
    assert word == "end_effector" and len(numbers) == 29
    return [float(number) for number in numbers]


def test_a_profile_is_added_activated_changed_and_deleted(desk, robot, control):
    id = desk.send("POST", PROFILES, PROFILE, **control).json()["id"]
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

    heavier = {**PROFILE, "inertial": {**INERTIAL, "mass": 0.6}}
    assert desk.send("PUT", f"{PROFILES}/{id}", heavier, **basic()).status == 423
    assert desk.send("PUT", f"{PROFILES}/{id}", heavier, **control).status == 200
    assert numbers_of(robot.lines[-1])[0] == 0.6
    assert desk.send("DELETE", f"{PROFILES}/{id}", **control).status == 409
    assert desk.send("PUT", f"{PROFILES}/active", "ee-no-profile", **control).status == 200
    assert numbers_of(robot.lines[-1])[:13] == [0.0] * 13
    assert desk.send("DELETE", f"{PROFILES}/{id}", **control).status == 200
    for method in ("PUT", "DELETE"):
        assert desk.send(method, f"{PROFILES}/ee-no-profile", PROFILE, **control).status == 409


def test_a_profile_that_the_robot_refuses_is_not_active(desk, robot, control):
    id = desk.send("POST", PROFILES, PROFILE, **control).json()["id"]
    before = get(desk, f"{PROFILES}/active")["id"]
    robot.answers["end_effector"] = "error: MotionActive: Stop the motion first."
    assert desk.send("PUT", f"{PROFILES}/active", id, **control).status == 424
    assert get(desk, f"{PROFILES}/active")["id"] == before


def test_the_configuration_sets_the_end_effector(desk, robot):
    assert desk.send("PATCH", "/api/configuration", CONFIGURATION, **basic()).status == 204
    assert numbers_of(robot.lines[-1])[0] == 0.5
    assert CONFIGURATION.items() <= get(desk, "/api/configuration").items()


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
    report = {"fci": True, "brakes": OPEN}
    with desk_with_robot(tmp_path, fci_after_stop=True, report=report) as (robot, desk):
        change(desk, robot, inputs={"x31": True}, fci=False, brakes=CLOSED)
        change(desk, robot, inputs={"x31": False})
        assert robot.lines == []
        change(desk, robot, brakes=OPEN)
        wait_for(lambda: robot.lines == ["fci on"])
