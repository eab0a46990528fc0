# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The lines of the safety controller: a locked robot is made ready, stopped, tested and switched off."""

import json
import re
import socket
import threading

import numpy
import pyfranka
import pytest
from pyfranka.franka_sim import FrankaSim
from pyfranka.remote import LineRefused, Remote
from waiting import wait_for

KINDS = ("panda", "fr3")


both = pytest.mark.parametrize("robot", KINDS, indirect=True)
fr3 = pytest.mark.parametrize("robot", ["fr3"], indirect=True)


@pytest.fixture
def robot(request):
    """A locked robot: a Panda, unless a mark says otherwise."""
    with FrankaSim(getattr(request, "param", "panda"), start="locked") as sim:
        yield sim.robot


def report(robot) -> dict:
    return json.loads(robot.remote.send("report"))


def refusal(robot, line: str) -> str:
    with pytest.raises(LineRefused) as refused:
        robot.remote.send(line)
    return refused.value.code


def make_ready(robot) -> None:
    robot.remote.send("joints unlock")
    robot.remote.send("fci on")


def accepts(robot, port: int) -> bool:
    with socket.socket() as connection:
        connection.settimeout(60)
        return connection.connect_ex((robot.address, port)) == 0


@fr3
def test_ports_refuse_until_the_robot_is_ready(robot):
    assert not accepts(robot, 1337)
    assert not accepts(robot, 1338)
    with pytest.raises(pyfranka.Exception, match="FCI"):
        robot.connect()
    assert refusal(robot, "fci on") == "BrakesClosed"
    make_ready(robot)
    assert report(robot)["brakes"] == [False] * 7
    assert robot.connect().read_once().robot_mode == pyfranka.RobotMode.Idle
    robot.gripper().read_once()
    robot.remote.send("fci off")
    assert not accepts(robot, 1337)
    assert not accepts(robot, 1338)


def test_the_hand_is_homed_once_after_each_start(robot):
    remote = robot.remote
    assert not remote.report().hand.homed
    assert refusal(robot, "hand move 0.02 0.1") == refusal(robot, "hand grasp 0.02 0.1 10") == "NotHomed"
    remote.hand_homing()
    assert remote.report().hand.homed
    remote.hand_move(0.02, 0.1)
    assert remote.report().hand.width == pytest.approx(0.02, abs=1e-3)
    remote.set_end_effector_power(False)
    assert refusal(robot, "hand move 0.03 0.1") == "NotReady"
    remote.set_end_effector_power(True)
    remote.hand_move(0.03, 0.1)
    remote.set_power(False)
    assert refusal(robot, "hand homing") == "NotReady"
    remote.set_power(True)
    assert not remote.report().hand.homed
    assert refusal(robot, "hand move 0.02 0.1") == "NotHomed"


@both
def test_the_report_is_complete(robot):
    state = report(robot)
    assert state["type"] == robot.kind
    assert state["arm_id"] == robot.name
    assert state["protocol"] == ([3, 5] if robot.kind == "panda" else [6, 10])
    assert (state["rules"], state["mode"], state["client"], state["fault"]) == ("desk", "Other", 0, "")
    assert (len(state["q"]), len(state["O_T_EE"]), len(state["O_F_ext"])) == (7, 16, 6)
    assert state["brakes"] == [True] * 7
    assert state["light"] == {"color": "yellow", "blinking": False}
    assert state["hand"]["kind"] == "gripper"
    assert state["self_test"]["due"] > 86000


@pytest.mark.parametrize(
    ("robot", "line"),
    [("panda", "joints lock"), ("fr3", "fci off"), ("panda", "power off"), ("fr3", "power off")],
    indirect=["robot"],
)
def test_the_end_of_the_fci_ends_a_motion(robot, line):
    make_ready(robot)
    client = robot.connect()
    q = client.read_once().q_d
    moving = threading.Event()

    def hold(state, period):
        moving.set()
        return pyfranka.JointPositions(q)

    sender = threading.Thread(target=lambda: (moving.wait(60), robot.remote.send(line)))
    with pytest.raises(pyfranka.Exception, match="aborted"):
        sender.start()
        client.control_joint_positions(hold)
    sender.join()
    assert not accepts(robot, 1337)
    if line == "power off":
        assert refusal(robot, "joints unlock") == "NotReady"
        robot.remote.send("power on")
    make_ready(robot)
    assert robot.connect().read_once().robot_mode == pyfranka.RobotMode.Idle


@fr3
def test_clients_receive_the_end_effector(robot):
    make_ready(robot)
    transform = numpy.eye(4)
    transform[2, 3] = 0.2
    words = [0.5, 0.01, 0.02, 0.03, *(1e-3 * numpy.eye(3)).ravel(), *transform.T.ravel()]
    robot.remote.send("end_effector " + " ".join(map(str, words)))
    state = robot.connect().read_once()
    assert state.m_ee == pytest.approx(0.5)
    assert state.F_x_Cee == pytest.approx([0.01, 0.02, 0.03])
    assert state.F_T_NE[2, 3] == pytest.approx(0.2)
    words[0] = 50.0
    with pytest.raises(LineRefused, match="kg"):
        robot.remote.send("end_effector " + " ".join(map(str, words)))


def test_moves_to_the_pack_pose_without_fci(robot):
    assert refusal(robot, "move pack") == "BrakesClosed"
    robot.remote.send("joints unlock")
    robot.remote.send("move pack")
    state = report(robot)
    assert not state["errors"]
    assert state["motion"] is False
    assert state["q"][3] == pytest.approx(-2.95, abs=0.02)
    with pytest.raises(LineRefused, match=r"joint 1 can be between -2\.\d+ and 2\.\d+ rad, not at 9\."):
        robot.remote.send("move 9 0 0 -1.5 0 1.5 0")
    with pytest.raises(LineRefused, match="the speed must be above 0 and at most 1"):
        robot.remote.send("move 0 0 0 -1.5 0 1.5 0 2")


@both
def test_moves_to_the_printed_end_of_its_reach(robot):
    """Within an FR3's limits, but out of its reach: there the joint's velocity limit is 0."""
    robot.remote.send("joints unlock")
    target = [0, -0.3, 0, -1.6, 0, 2.4, 0.785]
    limits = {"panda": (2.8973, -2.8973), "fr3": (2.9007, -3.0508)}[robot.kind]
    for joint, limit in zip((0, 6), limits):
        words = list(target)
        words[joint] = limit
        if robot.kind == "fr3":
            with pytest.raises(LineRefused, match="can be between") as refused:
                robot.remote.send("move " + " ".join(map(str, words)))
            ends = re.search(r"between (\S+) and (\S+) rad", str(refused.value)).groups()
            words[joint] = float(ends[joint == 0])
        robot.remote.send("move " + " ".join(map(str, words)) + " 1")
        assert report(robot)["q"][joint] == pytest.approx(words[joint], abs=5e-3)
        assert not report(robot)["errors"]


def call_in_motion(robot, call):
    """Calls with a connection of its own, in another thread, once joint 1 has moved."""
    begin = report(robot)["q"][0]

    def work():
        remote = Remote(robot.address)
        wait_for(lambda: json.loads(remote.send("report"))["q"][0] > begin + 0.01, "A motion")
        call(remote)

    threading.Thread(target=work).start()


def test_stopped_motion_is_reported():
    with FrankaSim("panda", pace="10") as sim:
        sim.robot.remote.deactivate_fci()
        call_in_motion(sim.robot, lambda remote: remote.move("stop"))
        with pytest.raises(LineRefused, match="ended before"):
            sim.robot.remote.move([1, -0.8, 0, -2.4, 0, 1.6, 0.8], speed=0.002)
        sim.robot.remote.wait()
        assert 0 < report(sim.robot)["q"][0] < 0.9


@fr3
def test_errors_are_acknowledged(robot):
    make_ready(robot)
    robot.remote.send("inject genericJointError on")
    robot.remote.wait()
    assert report(robot)["recoverable"] == ["genericJointError"]
    assert report(robot)["light"]["color"] == "red"
    assert refusal(robot, "joints unlock") == "RecoverableErrorActive"
    robot.remote.send("acknowledge genericJointError")
    assert refusal(robot, "acknowledge genericJointError") == "NoAckRequired"
    robot.remote.send("self_test")
    assert refusal(robot, "joints unlock") == "SelfTestRunning"
    robot.remote.wait()
    make_ready(robot)
