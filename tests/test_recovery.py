# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A controller on franka_control_node survives reflexes and the user stop, ten times in a row and more."""

import json
from pathlib import Path

import pytest
from franka_sim_mujoco.session import Session

HERE = Path(__file__).resolve().parent
SOURCE = HERE.parent / "catkin_ws/src"

PREEMPTED, SUCCEEDED, ABORTED, RECALLED = 2, 3, 4, 8
ADDRESS = "127.0.7.3"


@pytest.fixture(scope="module", params=["panda", "fr3"])
def report(request, tmp_path_factory, long_run):
    robot, folder = request.param, tmp_path_factory.mktemp("recovery")
    parameters = folder / "controllers.yaml"
    config = SOURCE / "franka_example_controllers/config/franka_example_controllers.yaml"
    parameters.write_text(config.read_text().replace("$(arg arm_id)", robot))
    launch = ["franka_control", "franka_control.launch", "sim:=true", f"robot:={robot}"]
    launch += ["load_gripper:=false", f"robot_ip:={ADDRESS}"]
    with Session(*launch, log=folder / "launch.log") as session:
        session.wait_for_master()
        session.run("rosparam", "load", str(parameters))
        load = ["rosrun", "controller_manager", "controller_manager", "load"]
        loaded = session.run(*load, "cartesian_impedance_example_controller", check=False, timeout=90)
        assert "Loaded" in loaded.stdout, f"{loaded}\n{session.tail(60)}"
        count = "100" if long_run else {"panda": "10", "fr3": "3"}[robot]
        client = ["/usr/bin/python3", str(HERE / "recovery_client.py"), robot, ADDRESS, count]
        result = session.run(*client, check=False, timeout=1800 if long_run else 300)
        print(result.stdout, session.tail(80), sep="\n")
        assert result.returncode == 0, f"{result}\n{session.tail(60)}"
        session.check()
        return json.loads(result.stdout.strip().splitlines()[-1])


def test_a_controller_survives_reflexes(report):
    assert report["started"] and report["moves"]
    for outcome in report["reflexes"]:
        text = outcome.pop("reported")
        assert "reflex" in text, text
        assert outcome == {
            "reflex": True,
            "has_error": True,
            "recovery": [SUCCEEDED, ""],
            "moves": True,
            "error_gone": True,
            "controller": "running",
            "follows": True,
        }


def test_an_early_recovery_changes_nothing(report):
    assert report["early"][0] == SUCCEEDED
    assert report["goes_on"]


def test_two_simultaneous_recoveries_are_both_answered(report):
    # actionlib's simple server replaces a goal by a later one: it preempts an active goal and recalls
    # a pending one.
    (first, _), (second, _) = report["twice"]
    assert first in (SUCCEEDED, PREEMPTED, RECALLED), report["twice"]
    assert second == SUCCEEDED, report["twice"]
    assert report["follows_after_both"]


def test_the_user_has_to_release_the_user_stop(report):
    outcome = report["user_stop"]
    assert outcome["stopped"] and outcome["has_error"] and outcome["still_stopped"]
    assert outcome["recovery_while_pressed"][0] == ABORTED
    assert "user stop" in outcome["recovery_while_pressed"][1].lower(), outcome
    assert outcome["moves"] and outcome["follows"]


def test_the_node_stops_normally(report):
    assert report["stopped"] and report["idle"]


def test_a_robot_hit_at_rest_recovers(report):
    assert report["hit_at_rest"]
    assert report["recovered_at_rest"] == [SUCCEEDED, True]
