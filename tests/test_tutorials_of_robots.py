# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""docs/tutorials/real_robot.md and porting_from_noetic.md: commands and files exist; rehearsals and the
ported package run in simulation."""

import re
from pathlib import Path

import page_commands
import pyfranka
import pytest
from bare_debian import bare_debian
from fci_session import simulated
from overlay import Overlay
from tutorial import read
from waiting import wait_for

TOP = Path(__file__).resolve().parent.parent
TUTORIALS = TOP / "docs/tutorials"
DEVEL = TOP / "catkin_ws/devel"
PACKAGE = TOP / "tests/out_of_tree/from_noetic"


@pytest.mark.long_form("makes a bare Debian")
def test_a_bare_debian_takes_the_settings_of_the_page(tmp_path):
    """The programs that read the settings find them."""
    settings = read(TOP / "docs/tutorials/real_robot.md")
    with bare_debian(tmp_path, "adduser", "ifupdown", "sudo", "systemd") as bare:
        bare.must("adduser", "--disabled-password", "--gecos", "", "reader")
        for text in ("addgroup realtime", "interfaces.d/robot", "performance.service"):
            bare.must("sh", "-ec", f"export USER=reader\n{settings.block_with(text)}")
        assert "realtime" in bare.must("groups", "reader").split()
        assert "address: 172.16.0.1\n" in bare.must("ifquery", "enp3s0")
        assert bare.must("systemctl", "is-enabled", "performance.service") == "enabled\n"


def test_commands_of_the_rehearsal_are_accepted():
    """Each line of step 1 is sent to a robot in a motion, which survives all but the user stop."""
    sent = [
        command[1]
        for command in page_commands.commands_of(TUTORIALS / "real_robot.md")
        if command[0] == "echo" and not page_commands.check_line(command)
    ]
    disturbances = [line for line in sent if not line.startswith(("user_stop", "load"))]
    assert len(disturbances) == 4
    with simulated("panda", "lockstep") as robot:
        client, pending, ticks = robot.connect(), list(disturbances), 0

        def hold(state, period):
            nonlocal ticks
            ticks += 1
            if pending and ticks % 200 == 0:
                robot.remote.send(pending.pop(0))
            torques = pyfranka.Torques([0.0] * 7)
            return pyfranka.motion_finished(torques) if ticks > 1200 else torques

        client.control_torques(hold)
        assert not pending
        for line in (line for line in sent if line.startswith(("user_stop", "load"))):
            robot.remote.send(line)
        wait_for(lambda: robot.remote.state().mode == "Idle", "The end of the user stop")


@pytest.mark.long_form("builds one more package of a user")
def test_the_ported_package_builds_and_runs(tmp_path):
    overlay = Overlay(DEVEL, PACKAGE, tmp_path)
    overlay.build()
    launch = " ".join((PACKAGE / "launch/from_noetic.launch").read_text().split())
    for block in read(TOP / "docs/tutorials/porting_from_noetic.md").of("bash"):
        if block.language == "xml":
            assert " ".join(block.text.split()) in launch
        if block.language == "cmake":
            for line in block.text.splitlines():
                assert line.split("#")[0].strip() in (PACKAGE / "CMakeLists.txt").read_text()
    log = tmp_path / "launch.log"
    port = overlay.environment["ROS_MASTER_URI"].rsplit(":", 1)[1]
    launch = overlay.start(f"roslaunch -p {port} from_noetic from_noetic.launch", log)
    try:
        # rostopic fails until the master answers, and may miss a publisher that starts at the same time.
        command = (
            "until timeout 20 rostopic echo -n 1 /from_noetic_controller/height 2> /dev/null; do true; done;"
            "rosservice call /gazebo/get_body_pose 'body: block'"
        )
        printed = overlay.run(command, timeout=600)
    finally:
        launch.terminate()
        launch.wait(60)
    assert 0.3 < float(re.search(r"data: (\S+)", printed)[1]) < 0.8
    assert "success: True" in printed, printed + log.read_text()
    assert "plugin 'gazebo_ros_state'" in log.read_text()  # named in the warning about what is not simulated
