# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""franka_visualization.launch on a virtual screen, against a simulated robot; and its nodes without one."""

import os
import re
import subprocess
from pathlib import Path

import pytest
import yaml
from fci_session import simulated
from franka_sim_mujoco.session import Session
from PIL import Image
from screen import virtual_screen, with_rviz
from waiting import wait_for

ADDRESS = "127.0.33.1"
# Start pose of the simulated robot (the ready pose), and of its hand.
READY = [0.0, -0.785398, 0.0, -2.356194, 0.0, 1.570796, 0.785398]


@pytest.fixture(scope="module")
def screen():
    with virtual_screen():
        yield


def shows_robot(path) -> bool:
    """Takes a picture of the screen: is there something bright, as the arm is, in rviz's dark view?"""
    subprocess.run(["import", "-window", "root", str(path)], check=True, timeout=60)
    with Image.open(path) as picture:
        view = picture.convert("L").crop((400, 80, 1150, 850))
        return sum(view.histogram()[150:]) > 10000


def launch(log, name, *arguments) -> Session:
    names = [f"robot_ip:={ADDRESS}", f"robot:={name}", *arguments]
    return Session("franka_visualization", "franka_visualization.launch", *names, log=log)


def joint_states(session) -> dict:
    """The merged joint states, once both arm and hand have published."""

    def of_both():
        session.check()
        echo = session.run("rostopic", "echo", "-n1", "/joint_states", timeout=120).stdout
        message = yaml.safe_load(echo.partition("---")[0])
        names = message["name"]
        states = dict(zip(names, message["position"]))
        # Before its source publishes, a joint is in the middle of its range.
        return abs(states.get(names[3], 0.0) - READY[3]) < 0.01 and states

    return wait_for(of_both, "The arm's joint states", 180)


@pytest.mark.parametrize("name", ["panda", "fr3"] if os.environ.get("FRANKA_TEST_LONG") else ["panda"])
def test_joint_states_hold_arm_and_hand(screen, tmp_path, name):
    with_rviz(lambda: see_joint_states(name, tmp_path), tmp_path / "launch.log")
    log = (tmp_path / "launch.log").read_text(errors="replace")
    assert not re.findall(r"^.*\[(?:ERROR|FATAL)\].*$", log, re.M)


def see_joint_states(name, tmp_path):
    rviz = name == "panda"
    robot = simulated(name, "realtime", address=ADDRESS)
    with robot, launch(tmp_path / "launch.log", name, f"rviz:={str(rviz).lower()}") as session:
        session.wait_for_master()
        states = joint_states(session)
        assert list(states)[:7] == [f"{name}_joint{i}" for i in range(1, 8)]
        assert list(states)[7:] == [f"{name}_finger_joint1", f"{name}_finger_joint2"]
        assert list(states.values())[:7] == pytest.approx(READY, abs=0.01)
        fingers = list(states.values())[7:]
        assert fingers[0] == fingers[1] and 0.0 <= fingers[0] <= 0.04
        if rviz:
            picture = Path(os.environ.get("FRANKA_TEST_PICTURES", tmp_path)) / "rviz.png"
            wait_for(lambda: session.check() or shows_robot(picture), "The robot in rviz", 180, 0.5)
        session.check()


@pytest.mark.parametrize(
    "address, sentence",
    [("no.such.host.invalid", "no.such.host.invalid"), ("127.0.33.9", "Please install FCI feature")],
)
def test_without_a_robot_the_launch_file_reports_an_error_and_exits(tmp_path, address, sentence):
    log = tmp_path / "launch.log"
    arguments = [f"robot_ip:={address}", "rviz:=false"]
    with Session("franka_visualization", "franka_visualization.launch", *arguments, log=log) as session:
        session.wait_for_master()
        wait_for(
            lambda: "exit code 255" in log.read_text(errors="replace"), lambda: session.tail(40), 180, 0.2
        )
    text = log.read_text(errors="replace")
    # The arm's node is required: its exit may end the launch before the hand's node exits.
    errors = re.findall(r"^.*\[ERROR\].*robot_joint_state_publisher: .*$", text, re.M)
    assert len(errors) == 1, text
    assert sentence in errors[0]
