# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A user's package builds against the devel and the install space, and runs."""

import os
import re
import signal
import subprocess
from pathlib import Path

import pytest
from overlay import Overlay
from waiting import wait_for

TOP = Path(__file__).resolve().parent.parent
PACKAGES = TOP / "tests" / "out_of_tree"
AWAY = 0.1  # [rad], as in the launch file
LONG = 300.0  # [s] on a busy machine
BEGIN = -2.356194490192345  # of the fourth joint [rad]
SPACES = ["devel", pytest.param("install", marks=pytest.mark.long_form("the same on the install space"))]


def end(process: subprocess.Popen) -> None:
    """Interrupts a process as Ctrl-C does."""
    process.send_signal(signal.SIGINT)
    try:
        process.wait(30)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()


def where(overlay: Overlay, launch: subprocess.Popen, log: Path) -> tuple[str, int]:
    """Answer of the node's own service once the arm has arrived."""
    found = None

    def answer():
        nonlocal found
        assert launch.poll() is None, log.read_text()
        result = overlay.shell("rosservice call /my_arm/where", overlay.folder / "devel", LONG)
        found = re.search(r'message: "(\w+) (\d+) (\S+)"', result.stdout)
        return found and abs(float(found[3]) - (BEGIN + AWAY)) < 0.01

    wait_for(answer, lambda: f"{log.read_text()[-4000:]}\n{found}, but the end", LONG, 0.3)
    return found[1], int(found[2])


@pytest.mark.parametrize("space", SPACES)
def test_package_builds_and_runs(space, tmp_path, request):
    underlay = TOP / "catkin_ws" / "devel" if space == "devel" else request.getfixturevalue("installed")
    overlay = Overlay(underlay, PACKAGES / "my_arm", tmp_path)
    overlay.build()
    address = "127.0.41.1" if space == "devel" else "127.0.41.2"
    simulator = f"franka_sim --ip {address}"
    log = tmp_path / "launch.log"
    robot = overlay.start(f"{simulator} --pace lockstep --control-port 0", tmp_path / "robot.log")
    try:

        def joints():
            result = overlay.shell(f"rosrun my_arm where_is_it {address}", tmp_path / "devel", LONG)
            return result.stdout.split() if result.returncode == 0 else []

        assert float(wait_for(joints, "The robot's joints", LONG)[3]) == pytest.approx(BEGIN, abs=0.01)
        master = overlay.environment["ROS_MASTER_URI"].rsplit(":", 1)[1]
        launch = overlay.start(f"roslaunch -p {master} my_arm my_arm.launch robot_ip:={address}", log)
        try:
            arm_id, commands = where(overlay, launch, log)
        finally:
            end(launch)
        assert arm_id == "panda"
        assert commands > 500
    finally:
        end(robot)


@pytest.mark.parametrize("space", SPACES)
def test_callbacks_with_boost_bind_compile(space, tmp_path, request):
    """boost::bind with _1 from the global namespace, beside std::bind: not ambiguous, and no warning."""
    underlay = TOP / "catkin_ws" / "devel" if space == "devel" else request.getfixturevalue("installed")
    overlay = Overlay(underlay, PACKAGES / "bound_callbacks", tmp_path)
    log = overlay.build("all" if space == "devel" else "call_bound")
    assert "deprecated" not in log, log
    assert overlay.run("rosrun bound_callbacks call_bound") == "21 43 57\n"
