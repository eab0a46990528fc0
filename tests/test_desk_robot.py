# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Desk and the safety controller of simulated robots: errors, stops, self-tests, lights, end effectors."""

import pytest
from desk_server import DeskServer, basic
from pyfranka.desk.robot import PORT
from pyfranka.desk.status import RECOVERABLE
from pyfranka.franka_sim import FrankaSim, SimRobot
from waiting import wait_for

SAFETY, SYSTEM = "/admin/api/safety/status", "/admin/api/system-status"
ACKNOWLEDGE = "/admin/api/safety/recoverable-safety-errors/acknowledge?error_id="
CONFIRM = "/api/safety/recovery:confirm"
PROFILES = "/admin/api/end-effector/profiles"
DEADLINE = 30.0  # [s]
# Names of errors in the older interface, beside their own.
ERROR_IDS = {
    "td2Timeout": "TD2Timeout",
    "genericJointError": "GenericJointError",
    "jointPositionError": "JointPosition",
}


def place_of(kind, folder):
    with FrankaSim(SimRobot(kind, realism="ideal"), arguments=["--start", "locked"]) as sim:
        for line in ("timing brakes 0.1", "timing self_test 0.2"):
            sim.robot.remote.send(line)
        with DeskServer(sim.robot.address, PORT, folder) as desk:
            yield sim.robot, desk


@pytest.fixture(scope="module")
def fr3_place(tmp_path_factory):
    yield from place_of("fr3", tmp_path_factory.mktemp("certificates"))


@pytest.fixture(scope="module")
def panda_place(tmp_path_factory):
    yield from place_of("panda", tmp_path_factory.mktemp("certificates"))


@pytest.fixture
def fr3(fr3_place):
    yield from fresh(fr3_place)


@pytest.fixture
def panda(panda_place):
    yield from fresh(panda_place)


def fresh(place):
    """The robot, its Desk, and headers that have control. The robot has just been switched on."""
    served, desk = place
    for line in ("power off", "power on"):
        served.remote.send(line)
    wait_for(lambda: listens(desk))
    desk.clear()
    cookie = desk.log_in()
    yield served, desk, {**cookie, "X_Control_Token": desk.take_control(**cookie)["token"]}
    for name in ("x31", "x32", "x33", "x4", "guiding"):
        served.remote.send(f"input {name} off")


def listens(desk):
    desk.close_connection()
    try:
        desk.refresh()
        return not desk.desk.power.down and desk.send("GET", "/admin/api/startup-phase").status == 200
    except OSError:
        return False


def send_lines(served, desk, *lines):
    for line in lines:
        served.remote.send(line)
    desk.refresh()


def get(desk, path):
    return desk.send("GET", path, **basic()).json()


def refusal(answer):
    return answer.status, answer.json()["details"]


def light(desk):
    return tuple(get(desk, SYSTEM)["derived"]["desiredColor"].values())


# ---- errors ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", RECOVERABLE)
def test_an_error_locks_the_robot_until_it_is_acknowledged(fr3, name):
    served, desk, control = fr3
    assert desk.send("POST", "/desk/api/joints/unlock", **control).status == 200
    send_lines(served, desk, f"inject {name} on")
    safety = get(desk, SAFETY)
    assert safety["safetyControllerStatus"] == "Recovery" and safety["recoverableErrors"][name]
    for path in ("/desk/api/joints/unlock", "/desk/api/system/fci", "/api/fci:activate"):
        assert refusal(desk.send("POST", path, **control)) == (424, ["RecoverableErrorActive"])
    assert get(desk, "/api/safety/recovery")["recovery"]["type"]
    assert get(desk, "/api/system/operating-mode") == {"status": "SafetyRecovery"}
    if name == "jointPositionError":
        send_lines(served, desk, "input x4 on")  # the operator beside the robot confirms it
    answer = desk.send("POST", ACKNOWLEDGE + ERROR_IDS.get(name, name), **control)
    assert answer.status == 200, answer
    assert not get(desk, SAFETY)["recoverableErrors"][name]
    send_lines(served, desk, "input x4 off")
    assert desk.send("POST", "/desk/api/joints/unlock", **control).status == 200


@pytest.mark.parametrize(
    "name, part",
    [("jointLimitViolation", "jointLimitViolation"), ("jointPositionErrorDemand", "jointPositionError")],
)
def test_joint_recovery_is_not_cleared_by_an_acknowledgement(fr3, name, part):
    served, desk, control = fr3
    send_lines(served, desk, f"inject {name} 3 on")
    assert get(desk, SAFETY)["demandedRecoveries"][part] == [False, False, True] + [False] * 4
    assert refusal(desk.send("POST", "/desk/api/joints/unlock", **control)) == (
        424,
        ["JointRecoveryRequired"],
    )
    assert desk.send("POST", ACKNOWLEDGE + "GenericJointError", **control).status == 424
    confirmed = desk.send("POST", CONFIRM, **basic())
    assert refusal(confirmed) == (424, ["JointRecoveryRequired"])
    assert any(get(desk, SAFETY)["demandedRecoveries"][part])
    send_lines(served, desk, "input x4 on")  # the operator beside the robot
    kind = get(desk, "/api/safety/recovery")["recovery"]
    assert desk.send("POST", CONFIRM, kind, **basic()).status == 204
    assert not any(get(desk, SAFETY)["demandedRecoveries"][part])
    send_lines(served, desk, "input x4 off")
    assert desk.send("POST", "/desk/api/joints/unlock", **control).status == 200


# ---- self-tests ------------------------------------------------------------------------------------------


def test_a_self_test_locks_refuses_and_sets_its_clock(fr3):
    served, desk, control = fr3
    assert desk.send("POST", "/desk/api/joints/unlock", **control).status == 200
    send_lines(served, desk, "step 500")
    before = get(desk, SAFETY)["timeToTd2"]
    assert before < 86400.0
    send_lines(served, desk, "timing self_test 60")
    answer = desk.send("POST", "/admin/api/safety/td2-tests/execute", **control)
    assert answer.json() == {"code": "SuccessResponse"}
    wait_for(lambda: get(desk, SAFETY)["safetyControllerStatus"] == "SelfTest")
    assert get(desk, "/api/safety/self-tests")["status"] == "Running"
    assert refusal(desk.send("POST", "/desk/api/joints/unlock", **control)) == (503, ["SelfTestRunning"])
    send_lines(served, desk, "power off", "power on", "timing self_test 0.2")


def test_the_newer_interface_waits_for_the_self_test(fr3):
    served, desk, control = fr3
    send_lines(served, desk, "timing self_test 0.2", "step 500")
    before = get(desk, SAFETY)["timeToTd2"]
    assert desk.send("POST", "/api/safety/self-tests:execute", **control).status == 204
    assert get(desk, SAFETY)["timeToTd2"] > before
    assert get(desk, "/api/safety/self-tests")["status"] == "OK"
    assert desk.send("POST", "/api/arm/joints:unlock", **control).status == 204


def test_an_overdue_self_test_is_an_error(fr3):
    served, desk, control = fr3
    send_lines(served, desk, "self_test due 0.1", "step 300")
    wait_for(lambda: get(desk, SAFETY)["recoverableErrors"]["td2Timeout"])
    assert get(desk, "/api/safety/recovery") == {"recovery": {"type": "SelfTestsElapsed"}}
    answer = desk.send("POST", CONFIRM, {"type": "SelfTestsElapsed"}, **basic())
    assert answer.status == 204
    assert get(desk, "/api/safety/recovery") == {}


# ---- modes, stops, lights --------------------------------------------------------------------------------


def test_lights_and_modes_of_an_fr3(fr3):
    served, desk, control = fr3
    assert light(desk) == ("Yellow", "Constant")
    assert get(desk, "/desk/api/events/gripper/hardware") == {"connection_status": "uninitialized"}
    assert desk.send("POST", "/desk/api/joints/unlock", **control).status == 200
    assert light(desk) == ("Blue", "Constant")
    assert desk.send("POST", "/desk/api/gripper/homing", **control).status == 200
    assert get(desk, "/desk/api/events/gripper/hardware") == {"connection_status": "initialized"}
    assert desk.send("POST", "/desk/api/system/fci", **control).status == 200
    assert light(desk) == ("Green", "Constant")
    assert desk.send("POST", "/desk/api/operating-mode/programming", **control).status == 200
    assert light(desk) == ("White", "Constant") and get(desk, "/api/fci") == {"status": "Inactive"}
    assert refusal(desk.send("POST", "/api/fci:activate", **control)) == (424, ["WrongOperatingMode"])
    answer = desk.send("PUT", "/desk/api/robot/guiding/mode", b'mode="rotation"', **control)
    assert answer.status == 200 and get(desk, "/desk/api/robot/guiding/mode") == "rotation"
    axes = get(desk, "/desk/api/robot/guiding/configuration")
    assert axes["rotation_x"] and not axes["translation_x"]


@pytest.mark.parametrize("name", ["x32", "x33"])
def test_other_stops_of_an_fr3_are_shown_and_keep_the_brakes_open(fr3, name):
    served, desk, control = fr3
    assert desk.send("POST", "/desk/api/joints/unlock", **control).status == 200
    send_lines(served, desk, f"input {name} on")
    safety = get(desk, SAFETY)
    assert safety["safeInputState"][name] == "Active" and safety["brakeState"] == ["Unlocked"] * 7


def test_the_activation_device_of_a_panda(panda):
    served, desk, control = panda
    assert desk.send("POST", "/desk/api/robot/open-brakes", **control).status == 200
    status = get(desk, "/desk/api/system/status")
    assert status["brakesOpen"] == [True] * 7 and status["x4Enabled"]
    send_lines(served, desk, "input x4 on")
    status = get(desk, "/desk/api/system/status")
    assert status["operationalMode"] == "SS1" and not status["x4Enabled"]
    assert desk.desk.report.light.color == "white"


def test_the_pack_pose_needs_open_brakes_and_no_fci(fr3):
    served, desk, control = fr3
    start = {"type": "MoveToPackPose"}
    assert refusal(desk.send("POST", "/api/arm/motion:start", start, **control)) == (424, ["BrakesClosed"])
    assert desk.send("POST", "/desk/api/joints/unlock", **control).status == 200
    assert desk.send("POST", "/api/fci:activate", **control).status == 204
    assert refusal(desk.send("POST", "/api/arm/motion:start", start, **control)) == (424, ["MotionActive"])
    assert desk.send("POST", "/api/fci:deactivate", **control).status == 204
    before = get(desk, "/desk/api/robot/configuration")["jointAngles"]
    assert desk.send("POST", "/api/arm/motion:start", start, **control).status == 204
    after = get(desk, "/desk/api/robot/configuration")["jointAngles"]
    assert max(abs(a - b) for a, b in zip(before, after)) > 0.5


# ---- the FCI's state shows it ----------------------------------------------------------------------------


def test_fci_clients_receive_the_end_effector(fr3):
    served, desk, control = fr3
    inertia = {"x11": 0.01, "x12": 0.001, "x13": 0.0, "x22": 0.02, "x23": 0.0, "x33": 0.03}
    tool = {
        "name": "tool",
        "deviceId": "ee-no-gripper",
        "inertial": {"mass": 0.5, "centerOfMass": {"x": 0.0, "y": 0.01, "z": 0.05}, "inertia": inertia},
        "tcp": {
            "translation": {"x": 0.0, "y": 0.0, "z": 0.15},
            "rotation": {"roll": 0.0, "pitch": 0.0, "yaw": 0.0},
        },
    }
    id = desk.send("POST", PROFILES, tool, **control).json()["id"]
    assert desk.send("PUT", f"{PROFILES}/active", id, **control).status == 200
    for path in ("joints/unlock", "system/fci"):
        assert desk.send("POST", f"/desk/api/{path}", **control).status == 200
    state = served.connect().read_once()
    assert state.m_ee == 0.5 and list(state.F_x_Cee) == pytest.approx([0.0, 0.01, 0.05])
    assert state.F_T_EE[2][3] == pytest.approx(0.15)
    assert state.I_ee[0][1] == pytest.approx(0.001)
    assert desk.send("PUT", f"{PROFILES}/active", "ee-franka-hand", **control).status == 200
    assert served.connect().read_once().m_ee == pytest.approx(0.73)
