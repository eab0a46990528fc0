# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""roslaunch with an unreachable robot reports how to start a simulated one, and fails."""

import os
import re
import signal
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from fci_session import simulated
from franka_msgs.msg import FrankaState
from franka_sim_mujoco.session import Session, free_port
from ros_client import in_session, latest
from waiting import wait_for

SOURCE = Path(__file__).resolve().parents[1] / "catkin_ws/src"
NOBODY, WITHOUT_HAND = "127.0.32.20", "127.0.32.21"
START = 120.0  # [s] on a busy machine
PACKAGES = ["franka_control", "franka_gripper", "franka_visualization", "franka_example_controllers"]
# They start simulated robots.
OTHERS = {"simulated_robot.launch", "python_controllers_simulation.launch"}
ALL = [
    f"{package}/{path.name}"
    for package in PACKAGES
    for path in sorted((SOURCE / package / "launch").glob("*.launch"))
    if path.name not in OTHERS
]
# One of each node that needs a robot; all that start these nodes are in test_launch_files.
ONE_OF_EACH = {"franka_control.launch", "franka_gripper.launch", "franka_visualization.launch"}
LAUNCHES = [
    name
    if name.split("/")[1] in ONE_OF_EACH
    else pytest.param(name, marks=pytest.mark.long_form("launch files with the same nodes"))
    for name in ALL
]
# They have no argument that starts simulated robots.
WITHOUT_SIM = {"franka_visualization.launch", "franka_gripper.launch", "teleop_gripper.launch"}


def addresses(file: str) -> list[str]:
    """The launch file's arguments for addresses at which there is no robot."""
    if file.startswith("teleop_"):
        return [f"leader_ip:={NOBODY}", f"follower_ip:={NOBODY}", "load_gripper:=true"]
    if file.startswith(("dual_arm_", "franka_combined_")):
        return [f"robot_ips:={{panda_1/robot_ip: {NOBODY}, panda_2/robot_ip: {NOBODY}}}"]
    return [f"robot_ip:={NOBODY}"]


def launched(name: str) -> tuple[int | None, str]:
    """Status and output of roslaunch, which ends by itself."""
    port, (package, file) = str(free_port()), name.split("/")
    environment = dict(os.environ, ROS_MASTER_URI=f"http://localhost:{port}")
    environment.setdefault("ROS_HOSTNAME", "localhost")
    process = subprocess.Popen(
        ["roslaunch", "-p", port, package, file, *addresses(file), "rviz:=false", "rqt:=false"],
        env=environment,
        text=True,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    )
    try:
        output, _ = process.communicate(timeout=300)
    except subprocess.TimeoutExpired:
        process.send_signal(signal.SIGINT)  # it ends its nodes
        output, _ = process.communicate(timeout=60)
        return None, output
    return process.returncode, output


@pytest.fixture(scope="module")
def results(long_run):
    names = [name for name in ALL if long_run or name.split("/")[1] in ONE_OF_EACH]
    with ThreadPoolExecutor(2) as pool:
        return dict(zip(names, pool.map(launched, names)))


@pytest.mark.parametrize("name", LAUNCHES)
def test_missing_robot_is_reported_with_the_command_to_start(results, name):
    status, output = results[name]
    assert status == 1, output
    assert NOBODY in output
    assert "franka_sim --robot" in output
    assert name.split("/")[1] in WITHOUT_SIM or "sim:=true" in output


@pytest.mark.own_process
def test_an_arm_without_its_hand_keeps_running(tmp_path):
    arguments = [f"robot_ip:={WITHOUT_HAND}", "realtime_config:=ignore"]
    launch = ["franka_control", "franka_control.launch", *arguments]
    with (
        simulated("panda", "patient", hand=False, address=WITHOUT_HAND),
        in_session(Session(*launch, log=tmp_path / "launch.log")) as session,
    ):
        died = re.compile(r"\[franka_gripper-\d+\] process has died")
        wait_for(lambda: died.search(session.log.read_text()), "The end of the hand's node", START)
        assert f"no gripper at {WITHOUT_HAND}" in session.log.read_text()
        latest("/franka_state_controller/franka_states", FrankaState, START)
