# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Desk and the safety controller of a simulated robot agree on errors, self-tests, lights and modes."""

import pytest
from desk_server import DeskServer, basic
from pyfranka.desk.robot import PORT
from pyfranka.desk.status import RECOVERABLE
from pyfranka.franka_sim import FrankaSim, SimRobot
from waiting import wait_for

SAFETY, SYSTEM = "/admin/api/safety/status", "/admin/api/system-status"
ACKNOWLEDGE = "/admin/api/safety/recoverable-safety-errors/acknowledge?error_id="
CONFIRM = "/api/safety/recovery:confirm"
# Names of errors in the older interface, beside their own.
ERROR_IDS = {
    "td2Timeout": "TD2Timeout",
    "genericJointError": "GenericJointError",
    "jointPositionError": "JointPosition",
}


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    with FrankaSim(SimRobot("fr3", realism="ideal"), arguments=["--start", "locked"]) as sim:
        for line in ("timing brakes 0.1", "timing self_test 0.2"):
            sim.robot.remote.send(line)
        with DeskServer(sim.robot.address, PORT, tmp_path_factory.mktemp("certificates")) as desk:
            yield sim.robot, desk


@pytest.fixture
def fr3(place):
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


def test_each_error_is_shown_and_acknowledged(fr3):
    served, desk, control = fr3
    for name in RECOVERABLE:
        send_lines(served, desk, f"inject {name} on")
        safety = get(desk, SAFETY)
        assert safety["safetyControllerStatus"] == "Recovery" and safety["recoverableErrors"][name], name
        assert get(desk, "/api/safety/recovery")["recovery"]["type"]
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


def test_the_newer_interface_waits_for_the_self_test(fr3):
    served, desk, control = fr3
    send_lines(served, desk, "self_test due 1000")
    assert get(desk, SAFETY)["timeToTd2"] <= 1000.0
    assert desk.send("POST", "/api/safety/self-tests:execute", **control).status == 204
    assert get(desk, SAFETY)["timeToTd2"] > 80000.0
    assert get(desk, "/api/safety/self-tests")["status"] == "OK"
    assert desk.send("POST", "/api/arm/joints:unlock", **control).status == 204


# ---- modes, lights ---------------------------------------------------------------------------------------


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
