# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Desk of a simulated robot ends the motions of FCI clients, and shows the safety controller's errors."""

import contextlib
import threading

import pyfranka
import pytest
from desk_server import DeskServer, basic
from fci_session import client_process, simulated
from genuine_clients import client_python
from lock_step import begin_motion, moved
from pyfranka.desk import Options
from pyfranka.desk.robot import PORT
from pyfranka.desk.status import RECOVERABLE
from pyfranka.franka_sim import FrankaSim
from pyfranka.sim import FR3
from waiting import wait_for

DEADLINE = 60.0  # [s]
TICKS = 100  # of a motion before it is ended
SPEED = 0.02  # [rad/s]

ENDS = {
    "lock": "/desk/api/joints/lock",
    "deactivate": "/api/fci:deactivate",
    "programming": "/desk/api/operating-mode/programming",
    "release": "/api/system/control-token:release",
    "reboot": "/api/system:reboot",
}


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    robot = FR3(realism="ideal")
    # Patient: a busy machine loses no command.
    with FrankaSim(robot, pace="patient", start="locked") as sim:
        sim.robot.remote.send("timing brakes 0.2")
        folder = tmp_path_factory.mktemp("certificates")
        with DeskServer(sim.robot.address, PORT, folder, options=Options(boot_time=0.1)) as desk:
            yield sim.robot, desk


class Motion(threading.Thread):
    """A motion without an end, of the last joint."""

    def __init__(self, served):
        super().__init__(daemon=True)
        self._robot = served.connect()
        self.ticks, self.error = 0, None
        self.start()

    def run(self):
        try:
            self._robot.control_joint_velocities(self._velocities)
        except pyfranka.Exception as error:
            self.error = error

    def _velocities(self, state, period):
        self.ticks += 1
        return pyfranka.JointVelocities([0.0] * 6 + [min(SPEED, self.ticks * 1e-4)])


def make_ready(desk):
    """Desk's sequence of a new client. @returns headers that have control."""
    desk.clear()
    cookie = desk.log_in()
    token = desk.take_control(**cookie)["token"]
    headers = {**cookie, "X_Control_Token": token}
    fr3 = desk.desk.profile.fr3
    for path in ("joints/unlock", "operating-mode/execution") if fr3 else ("robot/open-brakes",):
        assert desk.send("POST", f"/desk/api/{path}", **headers).status == 200
    assert desk.send("POST", "/admin/api/control-token/fci", {"token": token}, **cookie).status == 200
    return headers


def motion_of(served):
    motion = Motion(served)
    wait_for(lambda: motion.ticks > TICKS or not motion.is_alive())
    assert motion.is_alive(), motion.error
    return motion


@pytest.mark.parametrize("how", ENDS)
def test_desk_ends_a_motion_and_its_sequence_makes_the_next_one_possible(place, how):
    served, desk = place
    headers = make_ready(desk)
    motion = motion_of(served)
    answer = desk.send("POST", ENDS[how], **headers)
    assert answer.status in (200, 204), answer
    motion.join(DEADLINE)
    assert isinstance(motion.error, pyfranka.ControlException) and "aborted" in str(motion.error)
    if how == "reboot":
        desk.close_connection()
        wait_for(lambda: is_back(desk))
    else:
        assert not desk.send("GET", "/admin/api/control-token").json()["fciActive"]
    with pytest.raises(pyfranka.NetworkException):
        served.connect()
    make_ready(desk)
    motion_of(served)  # which the next test, or the end, aborts
    assert desk.send("POST", "/desk/api/joints/lock", **desk.log_in()).status == 200


def is_back(desk):
    try:
        return "power on" in desk.lines and desk.send("GET", "/api/system").status == 200
    except OSError:
        desk.close_connection()
        return False


def test_forced_take_over_ends_the_motion_of_the_holder(place):
    served, desk = place
    make_ready(desk)
    motion = motion_of(served)
    forced = desk.take_control("another", "?force", **desk.log_in())
    served.remote.send("button circle on")
    motion.join(DEADLINE)
    served.remote.send("button circle off")
    assert isinstance(motion.error, pyfranka.ControlException)
    state = desk.send("GET", "/admin/api/control-token").json()
    assert state["activeToken"]["id"] == forced["id"]


def test_a_stop_of_an_fr3_locks_it_until_desks_sequence(place):
    served, desk = place
    headers = make_ready(desk)
    motion = motion_of(served)
    served.remote.send("input x31 on")
    motion.join(DEADLINE)
    assert isinstance(motion.error, pyfranka.ControlException)
    wait_for(lambda: desk.send("GET", "/admin/api/safety/status").json()["brakeState"] == ["Locked"] * 7)
    assert desk.send("GET", "/api/system/operating-mode").json() == {"status": "SafetyRecovery"}
    for path in ("/api/arm/joints:unlock", "/api/fci:activate"):
        answer = desk.send("POST", path, **headers)
        assert answer.status == 424 and answer.json()["details"] == ["EmergencyStopPressed"]
    served.remote.send("input x31 off")
    make_ready(desk)
    motion_of(served)
    assert desk.send("POST", "/desk/api/joints/lock", **desk.log_in()).status == 200


@pytest.mark.parametrize("library, kind", [("pylibfranka", "fr3"), ("panda", "panda")])
def test_a_genuine_client_reports_the_end_of_its_motion(library, kind, tmp_path):
    python = client_python(library)
    with simulated(kind, "patient", start="locked") as robot, client_process(library, python) as client:
        robot.remote.send("timing brakes 0.2")

        def connect():
            return client.run_task("connect", address=robot.address)["outcome"]

        with DeskServer(robot.address, PORT, tmp_path) as desk:
            headers = make_ready(desk)
            assert connect() == "ok"
            begin_motion(client, seconds=600.0, amplitude=0.2)
            lock = "joints/lock" if kind == "fr3" else "robot/close-brakes"
            assert desk.send("POST", f"/desk/api/{lock}", **headers).status == 200
            outcome = client.result()["outcome"]
            assert "Exception" in outcome or "Error" in outcome
            assert connect() != "ok"
            make_ready(desk)
            assert connect() == "ok"
            assert client.run_task("move", seconds=0.3)["outcome"] == "ok"


@contextlib.contextmanager
def requests_to(desk):
    """Another thread sends requests, and makes Desk poll the robot, without a pause."""
    ended = threading.Event()

    def send():
        while not ended.is_set():
            desk.refresh()
            desk.send("GET", "/admin/api/control-token")

    sender = threading.Thread(target=send)
    sender.start()
    try:
        yield
        assert sender.is_alive(), "The requests have ended."
    finally:
        ended.set()
        sender.join(DEADLINE)


def test_desk_has_no_effect_on_lock_step(tmp_path):
    with simulated("panda", "lockstep") as robot, client_process("pyfranka") as client:
        assert client.run_task("connect", address=robot.address)["outcome"] == "ok"
        hashes = [moved(robot, client)]
        with DeskServer(robot.address, PORT, tmp_path) as desk, requests_to(desk):
            first = desk.desk.robot.number
            hashes.append(moved(robot, client))
            assert desk.desk.robot.number >= first + 10
    assert hashes[0] == hashes[1]


# ---- errors of the safety controller ---------------------------------------------------------------------

SAFETY, CONFIRM = "/admin/api/safety/status", "/api/safety/recovery:confirm"
ACKNOWLEDGE = "/admin/api/safety/recoverable-safety-errors/acknowledge?error_id="
# Names of errors in the older interface, in addition to their own.
ERROR_IDS = {
    "td2Timeout": "TD2Timeout",
    "genericJointError": "GenericJointError",
    "jointPositionError": "JointPosition",
}


@pytest.fixture
def control(place):
    """Headers that have control of the robot, which is locked."""
    _, desk = place
    desk.close_connection()  # Desk may have ended it while no request came
    desk.clear()
    cookie = desk.log_in()
    headers = {**cookie, "X_Control_Token": desk.take_control(**cookie)["token"]}
    assert desk.send("POST", "/desk/api/joints/lock", **headers).status == 200
    return headers


def send_lines(served, desk, *lines):
    for line in lines:
        served.remote.send(line)
    desk.refresh()


def get(desk, path):
    return desk.send("GET", path, **basic()).json()


def test_each_error_is_shown_and_acknowledged(place, control):
    served, desk = place
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
def test_joint_recovery_is_not_cleared_by_an_acknowledgement(place, control, name, part):
    served, desk = place
    send_lines(served, desk, f"inject {name} 3 on")
    assert get(desk, SAFETY)["demandedRecoveries"][part] == [False, False, True] + [False] * 4
    for path in ("/desk/api/joints/unlock", CONFIRM):
        answer = desk.send("POST", path, **control)
        assert answer.status == 424 and answer.json()["details"] == ["JointRecoveryRequired"]
    assert desk.send("POST", ACKNOWLEDGE + "GenericJointError", **control).status == 424
    assert any(get(desk, SAFETY)["demandedRecoveries"][part])
    send_lines(served, desk, "input x4 on")  # the operator beside the robot
    kind = get(desk, "/api/safety/recovery")["recovery"]
    assert desk.send("POST", CONFIRM, kind, **basic()).status == 204
    assert not any(get(desk, SAFETY)["demandedRecoveries"][part])
    send_lines(served, desk, "input x4 off")
    assert desk.send("POST", "/desk/api/joints/unlock", **control).status == 200
