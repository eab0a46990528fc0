# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""franka_control_node survives a robot that is silent for ten seconds, killed in a recovery, restarted."""

import json
import subprocess
from pathlib import Path

import pytest
from franka_sim_mujoco.session import Session

HERE = Path(__file__).resolve().parent
SOURCE = HERE.parent / "catkin_ws/src"

SUCCEEDED = 3
ADDRESS = "127.0.7.4"


CASES = {
    "told_to_connect": ("panda", "false"),
    "connects_by_itself": ("panda", "true"),
    "fr3 told_to_connect": ("fr3", "false"),
    "fr3 connects_by_itself": ("fr3", "true"),
}


@pytest.fixture(scope="module", params=CASES.values(), ids=CASES)
def report(request, tmp_path_factory, long_run):
    (kind, reconnect), folder = request.param, tmp_path_factory.mktemp("gone")
    if request.param != CASES["told_to_connect"] and not long_run:
        pytest.skip("the same once more, without being told, and with an FR3: ./franka test --long")
    parameters = folder / "controllers.yaml"
    config = SOURCE / "franka_example_controllers/config/franka_example_controllers.yaml"
    parameters.write_text(config.read_text().replace("$(arg arm_id)", kind))
    command = ["franka_sim", "--robot", kind, "--no-hand", "--ip", ADDRESS, "--pace", "patient"]
    launch = ["franka_control", "franka_control.launch", "load_gripper:=false", f"robot_ip:={ADDRESS}"]
    launch += [f"robot:={kind}"]
    launch += ["realtime_config:=ignore", "connect_timeout:=30", f"reconnect:={reconnect}"]
    robot = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    try:
        with Session(*launch, log=folder / "launch.log") as session:
            session.wait_for_master()
            session.run("rosparam", "load", str(parameters))
            load = ["rosrun", "controller_manager", "controller_manager", "load"]
            loaded = session.run(*load, "cartesian_impedance_example_controller", check=False, timeout=90)
            assert "Loaded" in loaded.stdout, f"{loaded}\n{session.tail(60)}"
            client = ["/usr/bin/python3", str(HERE / "robot_gone_client.py")]
            client += [kind, str(robot.pid), reconnect, *command]
            result = session.run(*client, check=False, timeout=240)
            print(result.stdout, session.tail(80), sep="\n")
            assert result.returncode == 0, f"{result}\n{session.tail(60)}"
            session.check()
            return dict(json.loads(result.stdout.strip().splitlines()[-1]), log=session.tail(400))
    finally:
        robot.kill()
        robot.wait()


def test_a_silent_robot_is_reported_and_comes_back(report):
    assert report["started"] and report["moves"]
    assert report["silence_noticed"] and report["alive_without_robot"]
    assert report["after_silence"]["recovery"] == [SUCCEEDED, ""], report
    assert report["after_silence"]["moves"] and report["after_silence"]["follows"]
    assert "the robot is lost" in report["log"]


def test_a_restarted_robot_is_connected_again(report):
    assert report["death_noticed"] and report["alive_after_death"]
    if "refused" in report:
        success, message = report["refused"]
        assert not success and "refused" in message
    assert report["after_restart"]["recovery"] == [SUCCEEDED, ""], report
    assert report["after_restart"]["moves"] and report["after_restart"]["follows"]


def test_disconnect_and_connect_still_work(report):
    assert report["stopped"] and report["idle"]
    assert report["disconnect"] == [True, ""] and report["connect_again"] == [True, ""]
    assert report["fresh"]
