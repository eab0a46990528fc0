# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Four arms in one simulation as fast as possible: they start, and leave processor time for others."""

import json
from pathlib import Path

import pytest
from franka_sim_mujoco.session import Session

HERE = Path(__file__).resolve().parent
ARMS = [f"arm_{i}" for i in range(4)]


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    log = tmp_path_factory.mktemp("several_arms") / "launch.log"
    with Session(str(HERE / "data" / "several_arms.launch"), log=log) as session:
        session.wait_for_master()
        command = ["/usr/bin/python3", str(HERE / "several_arms_client.py")]
        client = session.run(*command, check=False, timeout=400)
        session.check()
        assert client.returncode == 0, f"{client.stdout}\n{client.stderr}\n{session.tail(60)}"
        return json.loads(client.stdout.strip().splitlines()[-1])


def test_all_controllers_run(report):
    usual = {"franka_state_controller", "cartesian_impedance_example_controller"}
    assert set(report["running"]["arm_0"]) == usual | {"franka_gripper"}
    assert all(set(report["running"][arm]) == usual for arm in ARMS[1:])


def test_an_arm_adds_no_processes_but_its_spawners(report):
    spawners = ("_model_spawner", "_controller_spawner", "_gripper_spawner")
    own = [node for node in report["nodes"] if node.startswith("/arm_")]
    assert own
    assert all(node.endswith(spawners) for node in own), own


def test_clock_messages_wake_few_nodes(report):
    # Spawners run as long as their controllers: each message would wake them up needlessly.
    assert not [node for node in report["follow_clock"] if "spawner" in node]
    # Up to ten messages were queued for the subscriber.
    assert report["clock_rate"] < 200 + 20


def test_joint_states_hold_arm_and_hand_in_kinematic_order(report):
    for arm, names in report["joints"].items():
        fingers = [f"{arm}_finger_joint{i}" for i in (1, 2)] if arm == "arm_0" else []
        assert names == [f"{arm}_joint{i}" for i in range(1, 8)] + fingers


def test_joint_states_arrive_at_30_hz_of_simulated_time(report):
    periods = [later - earlier for earlier, later in zip(report["stamps"], report["stamps"][1:])]
    for period in periods:
        messages = max(1, round(period * 30 / 1e9))  # a message still being sent dropped the next
        assert abs(period - messages * 1e9 / 30) <= 1e6  # the tick


def test_late_subscribers_get_the_transforms_of_every_arm(report):
    for arm, (seen, measured) in report["places"].items():
        assert seen == pytest.approx(measured, abs=0.01), arm


def test_time_is_real_time_while_a_robot_starts(report):
    # The host catches up at most 50 ms of delay, here within half a second.
    assert report["pace_while_one_starts"] <= 1.11
