# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""franka_control.launch as a user starts it, against simulated robots over the control interface."""

import json
from pathlib import Path

import pytest
from franka_sim_mujoco.session import Session

HERE = Path(__file__).resolve().parent

SUCCEEDED, ABORTED = 3, 4
IDLE, MOVE = 1, 2
CONTROLLERS = ["effort_joint_trajectory_controller", "position_joint_trajectory_controller"]


LAUNCHES = {
    "panda": ["franka_control", "franka_control.launch", "sim:=true", "robot:=panda"],
    "fr3": ["franka_control", "franka_control.launch", "sim:=true", "robot:=fr3"],
    "panda in a ROS world": [str(HERE / "data/hardware_in_a_world.launch"), "robot:=panda"],
}


@pytest.fixture(scope="module", params=LAUNCHES)
def report(request, tmp_path_factory):
    robot = request.param.split()[0]
    log = tmp_path_factory.mktemp("hardware") / "launch.log"
    launch = [*LAUNCHES[request.param], "robot_ip:=127.0.7.1"]
    with Session(*launch, log=log) as session:
        session.wait_for_master()
        load = ["rosrun", "controller_manager", "controller_manager", "load", *CONTROLLERS]
        loaded = session.run(*load, check=False, timeout=90)
        assert loaded.stdout.count("Loaded") == 2, f"{loaded}\n{session.tail(60)}"
        client = session.run(
            "/usr/bin/python3", str(HERE / "hardware_client.py"), robot, check=False, timeout=180
        )
        assert client.returncode == 0, f"{client}\n{session.tail(60)}"
        session.check()
        print(session.tail(60))
        return json.loads(client.stdout.strip().splitlines()[-1])


def test_the_robot_is_connected(report):
    assert report["state_controller"]
    assert report["mode_idle"] == IDLE


def test_setters_return_the_robots_answer(report):
    assert report["set_load"] == [True, ""]
    assert report["m_load"] == 0.5
    assert report["bad_load"][0] is False
    assert "invalid argument" in report["bad_load"][1]


@pytest.mark.parametrize("controller", CONTROLLERS)
def test_trajectories_are_followed(report, controller):
    outcome = report[controller]
    assert outcome["running"]
    assert outcome["mode"] == MOVE
    assert outcome["ended"][0] == SUCCEEDED, outcome
    assert outcome["error"] < 0.01


@pytest.mark.parametrize("controller", CONTROLLERS)
def test_a_moving_robot_refuses_setters_with_a_reason(report, controller):
    success, error = report[controller]["setter"]
    assert not success
    assert "Stop that controller" in error
    assert "Cannot disconnect" in report[controller]["disconnect"]
    assert report[controller]["stopped"]


def test_recovery_without_error_succeeds(report):
    assert report["recovery"][0] == SUCCEEDED


def test_the_hand_moves_and_refuses_invalid_goals(report):
    assert report["gripper_move"][0] == SUCCEEDED, report["gripper_move"]
    assert sum(report["fingers"]) == pytest.approx(0.05, abs=0.002)
    assert report["gripper_bad"][0] == ABORTED
    assert "must lie between" in report["gripper_bad"][1]


def test_the_robot_can_be_disconnected_and_connected_again(report):
    assert report["disconnect"] and report["connect"]
    assert report["twice"] == "Already connected to robot. Cannot connect twice."
    assert report["after"] == IDLE
