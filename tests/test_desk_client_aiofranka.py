# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The genuine client aiofranka 0.9.0 starts a robot through Desk, moves it and locks it again."""

import pytest
from desk_clients import AIOFRANKA
from desk_session import is_locked, is_ready, move

AIOFRANKA_MOTION = """
    robot = aiofranka.Robot(HOST)
    controller = aiofranka.Controller(robot)
    controller.start()
    goal = numpy.array(robot.state["qpos"])
    goal[3] += 0.05
    controller.move(goal)
    missed = abs(float(robot.state["qpos"][3]) - goal[3])
    controller.stop()
    robot.close()
"""
# Where it looks for the user when it reads the tool.
AIOFRANKA_FILE = """
    import json, pathlib
    file = pathlib.Path.home() / ".aiofranka" / "config.json"
    file.parent.mkdir(exist_ok=True)
    file.write_text(json.dumps(names))
"""


def test_aiofranka_unlocks_and_locks(desk_client):
    with desk_client("aiofranka", "fr3-v1") as (desk, client):
        client.run(AIOFRANKA + AIOFRANKA_FILE)
        client.run("aiofranka.unlock(HOST, **names)")
        assert is_ready(desk.report())
        client.run(AIOFRANKA_MOTION)
        assert client.value("missed") < 0.02
        assert client.value("robot.tool.name") == "Franka Hand"
        client.run("aiofranka.lock(HOST, **names)")  # with the token of before
        assert is_locked(desk.report())


@pytest.mark.long_form("starts a server of its own")
def test_aiofranka_starts_its_own_server(desk_client):
    with desk_client("aiofranka", "fr3-v1") as (desk, client):
        client.run(AIOFRANKA + "    aiofranka.start(HOST, **names)")
        assert desk.report()["mode"] == "Move"
        client.run("aiofranka.stop(HOST)")
        desk.wait(is_locked)


def test_aiofranka_runs_an_overdue_self_test(desk_client):
    with desk_client("aiofranka", "fr3-v1") as (desk, client):
        desk.send("timing self_test 1")
        desk.send("self_test due 0")
        desk.wait(lambda report: report["recoverable"] == ["td2Timeout"])
        client.run(AIOFRANKA + "    aiofranka.unlock(HOST, **names)")
        report = desk.report()
        assert is_ready(report) and report["self_test"]["due"] > 86000.0


def test_aiofranka_leaves_programming(desk_client):
    """Which only the older interface reaches, with the cookie of a login and the newer one's token."""
    with desk_client("aiofranka", "fr3-v1") as (desk, client):
        client.run(AIOFRANKA + "    desk = _DeskClientV2(HOST, *names.values()); desk.take_token()")
        client.run("desk.change_operating_mode('Programming'); desk.release_token()")
        desk.wait(lambda report: report["operating_mode"] == "programming")
        client.run("aiofranka.unlock(HOST, **names)")
        assert is_ready(desk.report())


def test_aiofranka_keeps_tools_in_desk(desk_client):
    with desk_client("aiofranka", "fr3-v1") as (desk, client):
        client.run(AIOFRANKA + "    aiofranka.save_tool('probe', 0.4, [0, 0, 0.05], ip=HOST, **names)")
        assert "probe" in client.value("list(aiofranka.list_tools(HOST, **names))")
        client.run("aiofranka.load_tool('probe', HOST, **names)")
        assert client.value("aiofranka.active_tool(HOST, **names).name") == "probe"
        assert desk.wait(lambda report: report["end_effector"]["mass"] == 0.4)
        client.run("aiofranka.set_configuration(HOST, mass=0.5, com=[0, 0, 0.02], **names)")
        assert desk.wait(lambda report: report["end_effector"]["mass"] == 0.5)
        client.run("aiofranka.unload_tool(HOST, **names); aiofranka.remove_tool('probe', HOST, **names)")
        assert desk.wait(lambda report: report["end_effector"]["mass"] == 0.0)


@pytest.mark.parametrize("profile, home", [("fr3-early", False), ("fr3-v1", False), ("fer-spoc", True)])
def test_aiofranka_lock_unlock_starts_the_robot(desk_client, profile, home):
    with desk_client("aiofranka", profile) as (desk, client):
        client.run(AIOFRANKA + "    from aiofranka.client import FrankaLockUnlock")
        client.run("desk = FrankaLockUnlock(HOST, *names.values())")
        client.run(f"desk.run(unlock=True, fci=True, persistent=True, home={home})")
        assert is_ready(desk.report()) and desk.report()["hand"]["homed"] == home
        move(desk.robot)
        client.run("desk.run(unlock=False)")
        assert is_locked(desk.report())


def test_aiofranka_old_client_starts_the_robot(desk_client):
    with desk_client("aiofranka", "fr3-v1") as (desk, client):
        client.run(AIOFRANKA + "    desk = _DeskClient(HOST, *names.values()); desk.login()")
        client.run("desk.take_token(); desk.recover_errors(); desk.unlock(); desk.activate_fci()")
        assert client.value("desk.is_fci_active() and desk.are_joints_unlocked()")
        assert client.value("desk.get_token_info()['fciActive']")
        client.run("desk.deactivate_fci(); desk.lock(); desk.release_token()")
        assert is_locked(desk.report())
