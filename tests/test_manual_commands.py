# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The command lines of the manual's simulation chapter in a shell, with rviz on a screen."""

import json
import re
import subprocess
import time
from pathlib import Path

import pytest
from franka_sim_mujoco.session import ShellSession
from screen import colours, move_window, virtual_screen, window_of

HERE = Path(__file__).resolve().parent

LAUNCH = """roslaunch franka_gazebo panda.launch x:=-0.5 \\
  world:=$(rospack find franka_gazebo)/world/stone.sdf \\
  controller:=cartesian_impedance_example_controller \\
  rviz:=true
"""
SUCCEEDED = 3
PATIENCE = 120  # wall seconds
WINDOW_WIDTH = 1200  # of the simulation and of rviz
STONE_WIDTH = 0.032  # [m] between the fingers

# Allowed warnings: about the stop; by Debian's joint_state_publisher, which after a stall of the machine
# publishes twice at the same simulated time; by Debian's rviz, which searches for an optional package.
LAWFUL = ["panda: user stop (pressed|released)", "TF_REPEATED_DATA", "no such package media_export"]


def rviz_is_drawn(session, picture: Path) -> bool:
    """Waits until rviz shows more than an empty scene."""
    deadline = time.monotonic() + PATIENCE
    while time.monotonic() < deadline:
        session.check()
        window = window_of("- RViz")
        if window:
            move_window(window, WINDOW_WIDTH, 0)  # beside the simulation's
            if colours(picture, window) > 500:
                return True
        time.sleep(0.5)
    return False


@pytest.fixture(scope="module")
def seen(tmp_path_factory, long_run):
    folder = tmp_path_factory.mktemp("manual")
    with virtual_screen("2400x900x24"), ShellSession(LAUNCH, log=folder / "launch.log") as session:
        session.wait_for_master()
        client = ["/usr/bin/python3", str(HERE / "manual_commands_client.py"), "1" if long_run else "4"]
        result = session.run(*client, check=False, timeout=400)
        print(result.stdout, result.stderr, session.tail(80), sep="\n")
        assert result.returncode == 0, f"{result.stderr}\n{session.tail(60)}"
        outcome = json.loads(result.stdout.strip().splitlines()[-1])
        outcome["rviz_drawn"] = rviz_is_drawn(session, folder / "rviz.png")
        outcome["rviz"] = session.run("rosnode", "info", "/rviz").stdout
        session.check()
        outcome["log"] = session.log.read_text(errors="replace")
    return outcome


def test_the_fingers_open(seen):
    assert seen["open"]["gap"] == pytest.approx(0.08, abs=2e-3)


def test_the_stone_is_held_and_lifted(seen):
    lifted = seen["lifted"]
    assert lifted["gap"] == pytest.approx(STONE_WIDTH, abs=1e-3)
    assert lifted["force"] > 5.0  # 2.5 N from each side, and friction
    assert lifted["stone"][2] - seen["begin"]["stone"][2] > 0.1
    assert seen["above the red tray"]["stone"][1] > 0.15


def test_the_stone_stands_on_the_red_pad(seen):
    assert seen["let go"]["force"] == 0.0
    assert seen["placed"]["in_tray"] and seen["placed"]["distance"] < 0.02


def test_the_user_stop_disconnects_until_recovery(seen):
    assert all("success: True" in said for said in seen["stops"]["said"].values())
    assert seen["stops"]["recovery"] == SUCCEEDED


def test_rviz_shows_the_robot_without_errors(seen):
    assert seen["rviz_drawn"]
    assert "/equilibrium_pose_marker/update" in seen["rviz"] and " * /tf [" in seen["rviz"]
    unexpected = [
        line
        for line in seen["log"].splitlines()
        if re.search(r"\[ ?(WARN|ERROR|FATAL)\]|\[rospack\] Error|Traceback", line)
        and not any(re.search(lawful, line) for lawful in LAWFUL)
    ]
    assert not unexpected


def test_the_launch_file_lists_its_arguments():
    line = "roslaunch franka_gazebo panda.launch --ros-args"
    result = subprocess.run(["bash", "-c", line], text=True, capture_output=True, timeout=60)
    assert result.returncode == 0, result.stderr
    for name in ("arm_id", "controller", "initial_joint_positions", "use_gripper", "world", "x", "yaw"):
        assert re.search(rf"^ +{name} \(default", result.stdout, re.M), f"{name} in {result.stdout}"
