# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Launch files with desk:=true: Desk answers at the robots' addresses, and robots in a ROS world have the
control interface that it needs."""

import json
import re
import socket
import urllib.error
import urllib.request
from contextlib import suppress

import pytest
from desk_server import unverified
from franka_sim_mujoco.session import Session
from gazebo_msgs.srv import DeleteModel
from pyfranka.remote import LineRefused, Remote
from ros_client import call, in_session, launched
from std_srvs.srv import Empty, SetBool
from waiting import wait_for

WORLD_ROBOT = "127.0.31.21"
LAUNCHED_ROBOT = "127.0.31.22"
VERSION = re.compile(r"\d+\.\d+\.\d+")
START_LIMIT = 120.0  # [s] of a launch on a busy machine

pytestmark = pytest.mark.own_process


def system_version(address: str) -> str:
    """What Desk answers without login; it listens at port 8443 where it may not open 443."""
    for port in (443, 8443):
        try:
            url = f"https://{address}:{port}/admin/api/system-version"
            with urllib.request.urlopen(url, timeout=60, context=unverified()) as answer:
                return json.load(answer)
        except urllib.error.URLError as error:
            if not isinstance(error.reason, ConnectionRefusedError):
                raise
    raise ConnectionRefusedError(f"Desk does not listen at {address}.")


def awaited(session: Session, attempt, errors=(OSError,)):
    """What the attempt returns, as soon as it raises none of these."""

    def result():
        session.check()
        with suppress(*errors):
            return [attempt()]

    return wait_for(result, lambda: f"{session.tail(60)}\nThe launch's answer", START_LIMIT, pause=0.2)[0]


@pytest.fixture(scope="module")
def world(tmp_path_factory):
    """A robot of a ROS world with Desk."""
    launch = ["franka_gazebo", "panda.launch", "headless:=true", "desk:=true", f"fci_ip:={WORLD_ROBOT}"]
    with launched(*launch, log=tmp_path_factory.mktemp("desk") / "launch.log") as session:
        yield session


@pytest.fixture
def remote(world):
    remote = Remote(WORLD_ROBOT)
    awaited(world, remote.state)
    return remote


def test_desk_serves_a_robot_of_a_ros_world(world):
    assert VERSION.match(awaited(world, lambda: system_version(WORLD_ROBOT)))


def test_a_robot_of_a_ros_world_has_a_control_interface(remote):
    report = remote.report()
    assert (report.type, report.arm_id, report.mode, report.rules) == ("panda", "panda", "Idle", "open")
    remote.set_user_stop(True)
    assert remote.report().mode == "User stopped"
    remote.set_user_stop(False)
    scene = remote.scene()
    assert scene.robots == {"panda": "panda"}
    assert remote.poses().shape == (len(scene.bodies), 7)
    before = remote.time
    remote.step(100)
    assert remote.time >= before + 0.1
    remote.hand_move(0.05, 0.1)
    assert remote.report().hand.width == pytest.approx(0.05, abs=2e-3)
    remote.reset()
    assert remote.report().mode == "Idle"


def test_the_control_interface_answers_while_the_world_is_paused(world, remote):
    call("/gazebo/pause_physics", Empty)
    assert remote.report(timeout=60).mode == "Idle"
    assert remote.scene(timeout=60).robots == {"panda": "panda"}
    call("/gazebo/unpause_physics", Empty)


def test_the_address_is_free_once_the_robot_has_been_deleted(world, remote):
    call("/gazebo/delete_model", DeleteModel, "panda")
    with pytest.raises(ConnectionError):
        remote.state()


@pytest.mark.own_process
def test_a_robot_of_a_ros_world_can_start_locked(tmp_path):
    launch = ["franka_sim_mujoco", "fr3.launch", "headless:=true", f"fci_ip:={WORLD_ROBOT}"]
    started = Session(*launch, "start:=locked", "control_port:=1341", log=tmp_path / "launch.log")
    with in_session(started) as session:
        remote = Remote(WORLD_ROBOT, 1341)
        report = awaited(session, remote.report)
        assert (report.type, report.rules, report.fci) == ("fr3", "desk", False)
        with socket.socket() as client:
            assert client.connect_ex((WORLD_ROBOT, 1337)) != 0
        with pytest.raises(LineRefused) as refused:
            remote.activate_fci()
        assert refused.value.code == "BrakesClosed"
        answer = call("/franka_sim/set_fci", SetBool, True)
        assert not answer.success and "BrakesClosed: " in answer.message, answer
        remote.unlock_joints()
        remote.activate_fci()
        with socket.socket() as client:
            assert client.connect_ex((WORLD_ROBOT, 1337)) == 0


def test_desk_serves_the_simulated_robot_of_franka_control(tmp_path):
    launch = ["franka_control", "franka_control.launch", "sim:=true", "desk:=true"]
    with Session(*launch, f"robot_ip:={LAUNCHED_ROBOT}", log=tmp_path / "launch.log") as session:
        assert VERSION.match(awaited(session, lambda: system_version(LAUNCHED_ROBOT)))
        remote = Remote(LAUNCHED_ROBOT)
        awaited(session, lambda: connected(remote), (AssertionError, OSError))
        assert remote.report().rules == "open"


def connected(remote: Remote) -> None:
    assert remote.report().client == 5
