# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The genuine client franky-control 2.0.0 starts a robot through Desk, moves it and locks it again."""

import pytest
from desk_clients import franky
from desk_session import is_ready

FRANKY_MOTION = """
    robot = franky.Robot(HOST, realtime_config=franky.RealtimeConfig.Ignore)
    robot.relative_dynamics_factor = 0.2
    robot.recover_from_errors()
    before = robot.current_joint_state.position
    target = franky.JointState([0, 0, 0, 0.05, 0, 0, 0])
    robot.move(franky.JointMotion(target, franky.ReferenceType.Relative))
    moved = float(robot.current_joint_state.position[3] - before[3])
    del robot
"""
BUTTONS = "[(event.button.value, event.pressed) for event in desk.poll_buttons(60.0)]"


def check_franky(desk, client):
    """Control, unlock, FCI and motion, by either of its classes."""
    client.run("desk.take_control(); desk.unlock_brakes()")
    assert client.value("desk.brake_state.value") == "Unlocked"
    assert client.value("desk.operating_mode.value") == "Execution"
    client.run("desk.enable_fci()")
    desk.wait(is_ready)
    client.run(FRANKY_MOTION)
    assert client.value("moved") == pytest.approx(0.05, abs=2e-3)
    client.run("desk.lock_brakes()")
    assert client.value("desk.brake_state.value") == "Locked"


def check_franky_buttons(desk, client):
    assert len(client.value(BUTTONS)) == 7  # the first message has all of them
    with desk.held("button circle"):
        assert client.value(BUTTONS) == [["circle", True]]
    assert client.value(BUTTONS) == [["circle", False]]


def test_franky_desk_starts_the_robot(desk_client):
    with desk_client("franky", "fr3-v1") as (desk, client):
        client.run(franky("Desk"))
        check_franky(desk, client)
        assert client.value("desk.get_fci_status()") == "Inactive"
        client.run("desk.unlock_brakes(); desk.enable_fci()")
        assert client.value("desk.get_fci_status()") == "Active"
        client.run("desk.disable_fci(); desk.set_mode_execution()")
        check_franky_buttons(desk, client)
        assert client.value("desk.has_control")
        client.run("desk.close()")
        assert desk.report()["fci"] is False


def test_franky_desk_web_session_starts_the_robot(desk_client):
    with desk_client("franky", "fr3-early") as (desk, client):
        client.run(franky("DeskWebSession"))
        check_franky(desk, client)
        client.run("desk.set_mode_programming()")
        assert client.value("desk.operating_mode.value") == "Programming"
        client.run("desk.set_mode_execution(); desk.start_task('pick')")
        check_franky_buttons(desk, client)
        client.run("desk.close()")
