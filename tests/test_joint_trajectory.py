# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Trajectories on the simulated Panda with torques, positions and velocities, as MoveIt sends them."""

import json
from pathlib import Path

import pytest
from franka_sim_mujoco.session import Session

HERE = Path(__file__).resolve().parent

CONTROLLER = "effort_joint_trajectory_controller"
OTHERS = ["position_joint_trajectory_controller", "velocity_joint_trajectory_controller"]


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    launch = ["franka_sim_mujoco", "panda.launch", "headless:=true", "real_time_factor:=1"]
    with Session(*launch, log=tmp_path_factory.mktemp("trajectory") / "launch.log") as session:
        session.wait_for_master()
        session.run("rosparam", "load", str(HERE / "joint_trajectory.yaml"))
        started = session.run(
            "rosrun", "controller_manager", "controller_manager", "spawn", CONTROLLER, check=False, timeout=60
        )
        assert started.returncode == 0, f"{started}\n{session.tail(60)}"
        load = ["rosrun", "controller_manager", "controller_manager", "load", *OTHERS]
        loaded = session.run(*load, check=False, timeout=60)
        assert loaded.stdout.count("Loaded") == len(OTHERS), f"{loaded}\n{session.tail(60)}"
        client = session.run(
            "/usr/bin/python3", str(HERE / "joint_trajectory_client.py"), check=False, timeout=120
        )
        session.check()
        assert client.returncode == 0, f"{client}\n{session.tail(60)}"
        print(client.stdout)
        return json.loads(client.stdout.strip().splitlines()[-1])


def test_goal_of_hundred_points_is_reached(report):
    assert report["reached"]["status"] == "SUCCEEDED", report
    assert report["reached"]["code"] == 0
    assert report["reached"]["error"] < 0.05


@pytest.mark.parametrize("interface", ["position", "velocity"])
def test_goal_is_reached_with_other_interfaces(report, interface):
    assert report[interface]["started"], report
    assert report[interface]["status"] == "SUCCEEDED", report[interface]
    assert report[interface]["code"] == 0
    assert report[interface]["error"] < 0.05


def test_violated_path_tolerance_is_reported(report):
    assert report["strict"]["status"] == "ABORTED", report
    assert report["strict"]["code"] == -4
    assert " path error " in report["strict"]["text"]


def test_cancelled_goal_ends(report):
    assert report["cancelled"]["status"] == "PREEMPTED", report
    assert report["cancelled"]["text"]


def test_unknown_joint_is_refused(report):
    assert report["unknown"]["status"] == "REJECTED", report
    assert report["unknown"]["code"] == -2
    assert "panda_joint1" in report["unknown"]["text"]
