# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""franka_combined_control.launch as a user starts it: torques for all arms, one of which hits something."""

import json
from pathlib import Path

import pytest
from franka_sim_mujoco.session import Session

HERE = Path(__file__).resolve().parent

SUCCEEDED, IDLE = 3, 1
ARMS = {"panda_1": "127.0.7.5", "panda_2": "127.0.7.6"}


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    log = tmp_path_factory.mktemp("combined") / "launch.log"
    addresses = ", ".join(f"{arm}/robot_ip: {address}" for arm, address in ARMS.items())
    launch = ["franka_control", "franka_combined_control.launch", "sim:=true", f"robot_ips:={{{addresses}}}"]
    with Session(*launch, log=log) as session:
        session.wait_for_master()
        load = ["rosrun", "controller_manager", "controller_manager", "load"]
        session.environment["ROS_NAMESPACE"] = "combined_panda"
        loaded = session.run(*load, "effort_joint_trajectory_controller", check=False, timeout=90)
        assert "Loaded" in loaded.stdout, f"{loaded}\n{session.tail(60)}"
        arms = [f"{arm}={address}" for arm, address in ARMS.items()]
        client = session.run(
            "/usr/bin/python3", str(HERE / "combined_client.py"), *arms, check=False, timeout=240
        )
        print(client.stdout, session.tail(80), sep="\n")
        assert client.returncode == 0, f"{client}\n{session.tail(60)}"
        session.check()
        return json.loads(client.stdout.strip().splitlines()[-1])


def test_one_controller_moves_all_arms(report):
    assert report["states"] and report["started"] and report["moves"]
    assert report["error"] < 0.01


def test_one_arm_recovers_and_the_others_keep_their_state(report):
    assert report["hit"]["reflex"]
    assert report["hit"]["others"] == [[IDLE, True]]  # one controller moves all: they wait
    assert report["recovered"] == SUCCEEDED
    assert report["moves_again"]
    for before, after in zip(report["hit"]["others_at"], report["others_at"]):
        assert after == pytest.approx(before, abs=0.005)
    assert report["error_again"] < 0.01


def test_all_recover_at_once(report):
    assert report["all_hit"]
    assert report["all_recovered"] == SUCCEEDED
    assert report["all_move"]
    assert report["error_at_last"] < 0.01


def test_they_stop(report):
    assert report["stopped"] and report["idle"]
