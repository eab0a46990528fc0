# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A client of the FCI moves a robot, and Desk ends the motion: in each way, and how the client goes on."""

import threading

import pyfranka
import pytest
from desk_server import DeskServer
from pyfranka.desk import Options
from pyfranka.desk.robot import PORT
from pyfranka.franka_sim import FrankaSim, SimRobot
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
    robot = SimRobot("fr3", realism="ideal")
    # Patient: a busy machine loses no command.
    with FrankaSim(robot, pace="patient", arguments=["--start", "locked"]) as sim:
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
    for path in ("joints/unlock", "operating-mode/execution", "system/fci"):
        assert desk.send("POST", f"/desk/api/{path}", **headers).status == 200
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


def test_desk_has_no_effect_on_lock_step(tmp_path):
    hashes = []
    for with_desk in (False, True):
        with FrankaSim(SimRobot("panda", realism="ideal"), pace="lockstep") as sim:
            if with_desk:
                with DeskServer(sim.robot.address, PORT, tmp_path) as desk:
                    move_briefly(sim.robot, desk.refresh)
                    assert desk.desk.robot.number >= 10
            else:
                move_briefly(sim.robot, lambda: None)
            hashes.append(sim.robot.remote.hash())
    assert hashes[0] == hashes[1]


def move_briefly(served, beside):
    """Half a second of its time; beside it something else happens every 50 ms."""
    ticks = 0

    def velocities(state, period):
        nonlocal ticks
        ticks += 1
        if ticks % 50 == 0:
            beside()
        speed = SPEED * min(1.0, ticks / 250, max(0.0, (500 - ticks) / 250))
        command = pyfranka.JointVelocities([0.0] * 6 + [speed])
        return pyfranka.motion_finished(command) if ticks >= 500 else command

    served.connect().control_joint_velocities(velocities)
