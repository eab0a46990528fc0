# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Desk of a simulated robot: its actions reach the robot, and end the motions of genuine FCI clients.

The rules of the robot itself are tested in franka_sim; the lines that actions send in test_desk_endpoints.
"""

import contextlib
import threading

import pytest
from desk_bodies import SETTINGS
from desk_server import DeskServer
from fci_session import client_process, simulated
from genuine_clients import client_python
from lock_step import begin_motion, moved
from pyfranka.desk.robot import PORT
from pyfranka.desk.status import RECOVERABLE
from waiting import wait_for

DEADLINE = 60.0  # [s]
ACKNOWLEDGE = "/admin/api/safety/recoverable-safety-errors/acknowledge?error_id="
CONFIRM, PROFILES = "/api/safety/recovery:confirm", "/admin/api/end-effector/profiles"


def ready_for(kind):
    """The requests that open the brakes and activate the FCI."""
    unlock = "joints/unlock" if kind == "fr3" else "robot/open-brakes"
    return f"POST /desk/api/{unlock}", "POST /admin/api/control-token/fci"


def is_ready(report):
    return report.brakes_open and report.fci


def is_locked(report):
    return all(report.brakes) and not report.fci


def needs_recovery(report):
    return any((*report.joint_limit_violation, *report.joint_position_error))


RECOVERIES = [
    ("jointLimitViolation", "JointLimitViolation"),
    ("jointPositionErrorDemand", "JointPositionError"),
]
# Requests, commands of the page and lines of the operator; a body; and what the robot then reports.
FIRST = [
    ("POST /desk/api/gripper/homing", None, lambda now: now.hand.homed),
    ("POST /desk/api/robot/fold", None, lambda now: now.q[3] < -2.9 and not now.motion),
    ("PUT /desk/api/robot/guiding/mode", b"mode=translation", lambda now: now.guiding.mode == "translation"),
    ("PUT /desk/api/navigation/mode", b"mode=robot", lambda now: now.navigation == "robot"),
]
STOP = [
    ("page user_stop on", None, lambda now: now.user_stop == ("user_stop",) and now.mode != "Idle"),
    ("page user_stop off", None, lambda now: not now.user_stop),
]
FR3 = [
    ("POST /desk/api/joints/unlock", None, lambda now: now.brakes_open and not now.fci),
    *FIRST,
    ("POST /desk/api/operating-mode/programming", None, lambda now: now.operating_mode == "programming"),
    ("page guiding on", None, lambda now: now.mode == "Guiding"),
    ("page guiding off", None, lambda now: not now.guiding.active),
    ("POST /desk/api/operating-mode/execution", None, lambda now: now.operating_mode == "execution"),
    ("POST /api/end-effector/power:off", None, lambda now: not now.end_effector.power),
    ("POST /api/end-effector/power:on", None, lambda now: now.end_effector.power),
    (f"PUT {PROFILES}/active", "ee-no-profile", lambda now: now.end_effector.mass == 0.0),
    ("POST /admin/api/control-token/fci", None, is_ready),
    *STOP,
    ("self_test due 3000", None, lambda now: now.self_test.due <= 3000.0),
    ("POST /api/safety/self-tests:execute", None, lambda now: now.self_test.due > 3000.0),
    *(
        step
        for name in RECOVERABLE
        for step in (
            (f"inject {name} on", None, lambda now, name=name: name in now.recoverable),
            ("input x4 on", None, lambda now: now.inputs.x4),  # the operator beside the robot
            (f"POST {ACKNOWLEDGE}{name}", None, lambda now: not now.recoverable),
            ("input x4 off", None, lambda now: not now.inputs.x4),
        )
    ),
    *(
        step
        for name, kind in RECOVERIES
        for step in (
            (f"inject {name} 3 on", None, needs_recovery),
            ("input x4 on", None, needs_recovery),
            (f"POST {CONFIRM}", {"type": kind}, lambda now: not needs_recovery(now)),
            ("input x4 off", None, lambda now: not now.inputs.x4),
        )
    ),
    ("POST /desk/api/joints/unlock", None, lambda now: now.brakes_open),
    ("POST /desk/api/joints/lock", None, is_locked),
    ("POST /api/system:reboot", None, lambda now: not now.power),
    ("power on", None, lambda now: now.power and is_locked(now)),
]
PANDA = [
    ("POST /desk/api/robot/open-brakes", None, lambda now: now.brakes_open and not now.fci),
    *FIRST,
    ("POST /admin/api/end-effector-configuration", SETTINGS, lambda now: now.end_effector.mass == 0.5),
    ("page input x4 on", None, lambda now: now.inputs.x4),
    ("page guiding on", None, lambda now: now.mode == "Guiding"),
    ("page guiding off", None, lambda now: not now.guiding.active),
    ("page input x4 off", None, lambda now: not now.inputs.x4),
    ("POST /admin/api/control-token/fci", None, is_ready),
    *STOP,
    ("POST /desk/api/robot/close-brakes", None, is_locked),
    ("inject jointPositionErrorDemand 4 on", None, needs_recovery),
    ("DELETE /desk/api/robot/shutdown-position-error/3", None, lambda now: not needs_recovery(now)),
]


class Operator:
    """A user who has control of a robot through its Desk."""

    def __init__(self, robot, desk):
        self.robot, self.desk = robot, desk
        cookie = desk.log_in()
        self.token = desk.take_control(**cookie)["token"]
        self.headers = {**cookie, "X_Control_Token": self.token}

    def do(self, step, body=None):
        """A request, a command of the page, or a line of the robot."""
        method, _, rest = step.partition(" ")
        if method == "page":
            action, *words = rest.split()
            answer = self.post("/page/command", {"action": action, "words": words})
            assert answer.status == 200 and answer.json() == {"value": ""}, (step, answer)
        elif rest.startswith("/"):
            body = {"token": self.token} if rest.endswith("control-token/fci") else body
            answer = self.desk.send(method, rest, body, **self.headers)
            assert answer.status in (200, 204), (step, answer)
        else:
            self.robot.remote.send(step)
            self.desk.refresh()

    def post(self, path, body):
        return self.desk.send("POST", path, body, **self.headers, Content_Type="application/json")


@pytest.mark.parametrize("kind, steps", [("fr3", FR3), ("panda", PANDA)], ids=["fr3", "panda"])
def test_each_action_has_its_effect_on_the_robot(kind, steps, tmp_path):
    with simulated(kind, "10", start="locked") as robot:
        for line in ("timing brakes 0.1", "timing self_test 0.1"):
            robot.remote.send(line)
        with DeskServer(robot.address, PORT, tmp_path) as desk:
            operator = Operator(robot, desk)
            for step, body, condition in steps:
                operator.do(step, body)
                wait_for(
                    lambda condition=condition: condition(robot.remote.report()),
                    lambda step=step: f"{robot.remote.report()}, so the effect of '{step}'",
                )


@pytest.mark.parametrize("library, kind", [("pylibfranka", "fr3"), ("panda", "panda")])
def test_a_genuine_client_reports_the_end_of_its_motion(library, kind, tmp_path):
    python = client_python(library)
    with simulated(kind, "patient", start="locked") as robot, client_process(library, python) as client:
        robot.remote.send("timing brakes 0.2")

        def connect():
            return client.run_task("connect", address=robot.address)["outcome"]

        with DeskServer(robot.address, PORT, tmp_path) as desk:
            operator = Operator(robot, desk)
            for request in ready_for(kind):
                operator.do(request)
            assert connect() == "ok"
            begin_motion(client, seconds=600.0, amplitude=0.2)
            operator.do(
                "POST /desk/api/joints/lock" if kind == "fr3" else "POST /desk/api/robot/close-brakes"
            )
            outcome = client.result()["outcome"]
            assert "Exception" in outcome or "Error" in outcome
            assert connect() != "ok"
            for request in ready_for(kind):
                operator.do(request)
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
