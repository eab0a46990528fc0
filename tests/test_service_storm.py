# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Clients call franka_control_node as fast as possible while its robot moves; a subscriber never reads."""

import json
from pathlib import Path

import pytest
import ros_nodes
from fci_session import simulated
from test_node_start import configured

HERE = Path(__file__).resolve().parent

CONTROLLERS = ["franka_state_controller", "effort_joint_trajectory_controller"]
STATES = 300.0  # of franka_states [Hz]: soon more than the buffer of an unread connection
WITHIN = 10.0  # [s] for any answer: calls queue for four threads, on a busy machine
SETTERS = 7
IN_TIME = 2.0  # [s]


@pytest.fixture(scope="module")
def report(tmp_path_factory, long_run):
    folder = tmp_path_factory.mktemp("storm")
    with simulated("panda", "lockstep", "--no-hand") as robot, ros_nodes.master(folder) as master:
        master.set("/robot_description", ros_nodes.robot_description("panda"))
        node_parameters = configured("franka_control_node.yaml", arm_id="panda")
        connection = {"robot_ip": robot.address, "realtime_config": "ignore"}
        master.set("/franka_control", dict(node_parameters, **connection))
        for name, values in configured("default_controllers.yaml", arm_id="panda").items():
            master.set(f"/{name}", values)
        master.set("/franka_state_controller/publish_rate", STATES)
        with master.node("franka_control", "franka_control_node", "franka_control") as node:
            assert node.prints("is ready"), node.output
            spawn = ["rosrun", "controller_manager", "controller_manager", "spawn", *CONTROLLERS]
            spawned = master.run(*spawn)
            assert "Started" in spawned.stdout, f"{spawned}\n{node.output}"
            client = ["/usr/bin/python3", str(HERE / "storm_client.py")]
            client += [str(node.process.pid), "60" if long_run else "8"]
            result = master.run(*client, timeout=200)
            print(result.stdout, result.stderr, node.output[-3000:], sep="\n")
            assert result.returncode == 0, result.stderr
            outcome = json.loads(result.stdout.strip().splitlines()[-1])
            outcome["robot"] = robot.remote.state().mode
            outcome["end"] = node.interrupt()
            return outcome


def test_every_call_is_answered_in_time(report):
    storm = report["storm"]
    print({name: [seen["calls"], round(seen["longest"], 3)] for name, seen in storm.items()})
    assert len(storm) == SETTERS + 8
    for name, seen in storm.items():
        assert seen["calls"] >= 3, name
        assert seen["failed"] == [], name
        assert seen["longest"] < WITHIN, name


def test_each_call_gets_the_right_answer(report):
    for name, seen in report["storm"].items():
        assert seen["wrong"] == [], name


def test_the_motion_continues(report):
    assert report["moves"] and report["aborts"] == [] and report["errors"] == [False]
    assert report["modes"] == [2], "The robot did not move all the time."
    assert report["robot_time"] > 0.5


def test_a_client_that_never_reads_blocks_no_other(report):
    reader = report["reader"]
    # The next message replaces one that is not fetched in time, on a busy machine also for a normal reader.
    assert reader["received"] > 0.5 * reader["published"] > 50
    assert report["never_read"]["held_up"], "All was still sent: nothing was tested."
    assert report["never_read"]["connected"]


def test_memory_is_flat(report):
    settled, end = report["memory"]
    assert end - settled < 3.0, f"{settled:.1f} MB have grown to {end:.1f} MB."
    assert end < 60.0


def test_the_node_keeps_serving_and_exits(report):
    assert report["stopped"] and report["set_afterwards"] == [True, ""]
    assert report["robot"] == "Idle"
    assert report["end"] < IN_TIME
