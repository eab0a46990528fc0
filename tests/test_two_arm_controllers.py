# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The two-arm examples by their launch files, each on two simulated robots."""

import json
from pathlib import Path

import pytest
from franka_sim_mujoco.session import Session
from stalls import in_time

HERE = Path(__file__).resolve().parent


@pytest.fixture(params=["panda", "fr3"])
def robot(request, long_run):
    if request.param == "fr3" and not long_run:
        pytest.skip("FR3s follow the same launch files; they take part in the long form.")
    return request.param


def outcome_of(log, robot, launch, arguments, client):
    launch = ["franka_example_controllers", launch, "sim:=true", "rviz:=false", "rqt:=false", *arguments]
    # Under friction, soft arms rest millimetres off their target.
    with Session(*launch, f"robot_type:={robot}", "realism:=ideal", log=log) as session:
        session.wait_for_master()
        command = ["/usr/bin/python3", str(HERE / "two_arm_controllers_client.py"), robot, *client]
        result = session.run(*command, check=False, timeout=200)
        print(result.stdout, result.stderr, session.tail(60), sep="\n")
        assert result.returncode == 0, f"{result}\n{session.tail(60)}"
        session.check()
        return json.loads(result.stdout.strip().splitlines()[-1])


def test_two_arms_hold_their_relative_pose_while_the_marker_is_dragged(robot, tmp_path):
    addresses = [f"robot_ips:={{{robot}_1/robot_ip: 127.0.7.11, {robot}_2/robot_ip: 127.0.7.12}}"]
    launch = "dual_arm_cartesian_impedance_example_controller.launch"
    outcome = outcome_of(tmp_path / "launch.log", robot, launch, addresses, ["dual"])
    assert outcome["pairs"] > 20
    assert outcome["worst"] < 1e-3  # [m]
    assert outcome["still_moving_under_control"]


def test_the_follower_follows_a_pushed_leader(robot, tmp_path):
    """The follower's stiff law tolerates no stalls: its torques stay constant while the loop stalls.

    On slow robots a stall of the machine lasts fewer ticks.
    """
    addresses = ["leader_ip:=127.0.7.13", "follower_ip:=127.0.7.14", "pace:=0.25"]
    launch = "teleop_joint_pd_example_controller.launch"

    def attempt():
        try:
            return outcome_of(tmp_path / "launch.log", robot, launch, addresses, ["teleop", "127.0.7.13"])
        except AssertionError as error:
            return error

    outcome = in_time(attempt, lambda outcome: not isinstance(outcome, AssertionError))
    if isinstance(outcome, AssertionError):
        raise outcome
    assert outcome["leader"] > 0.05 and outcome["follower"] > 0.05  # [rad]
    assert outcome["error"] < 2e-3  # [rad]
    assert outcome["still_moving_under_control"]
