# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The hand's latency over ROS: by the simulation's own controller, and by a hand's node on the network."""

import json
from pathlib import Path

import pytest
from franka_sim_mujoco.session import Session
from stalls import in_time

CLIENT = Path(__file__).resolve().parent / "hand_latency_client.py"
START, SHORTEST = 0.2, 1.0  # [s], franka_description's physics.yaml


def moves_of(launch, log):
    """Times of a small and a large move."""
    with Session(*launch, log=log) as session:
        session.wait_for_master()
        result = session.run("/usr/bin/python3", str(CLIENT), check=False, timeout=200)
        assert result.returncode == 0, f"{result.stderr}\n{session.tail(40)}"
        session.check()
    return json.loads(result.stdout.strip().splitlines()[-1])


@pytest.mark.parametrize(
    "launch",
    [
        ["franka_gazebo", "panda.launch", "headless:=true", "realism:=real"],
        ["franka_control", "franka_control.launch", "sim:=true", "robot:=fr3", "robot_ip:=127.0.62.1"],
    ],
    ids=["in-simulation", "over-the-network-by-default"],
)
def test_moves_of_a_real_hand_take_a_second(launch, tmp_path):
    moves = moves_of(launch, tmp_path / "launch.log")
    assert all(move["took"] >= SHORTEST for move in moves.values()), moves
    assert moves["large"]["first"] >= START, moves


def test_an_ideal_hand_moves_at_once(tmp_path):
    launch = ["franka_gazebo", "fr3.launch", "headless:=true"]
    moves = in_time(
        lambda: moves_of(launch, tmp_path / "launch.log"), lambda moves: moves["small"]["took"] < SHORTEST / 2
    )
    assert moves["small"]["took"] < SHORTEST / 2 and moves["large"]["first"] < START, moves
