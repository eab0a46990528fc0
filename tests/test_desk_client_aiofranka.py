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


def test_aiofranka_lock_unlock_starts_the_robot(desk_client):
    with desk_client("aiofranka", "fer-spoc") as (desk, client):
        client.run(AIOFRANKA + "    from aiofranka.client import FrankaLockUnlock")
        client.run("desk = FrankaLockUnlock(HOST, *names.values())")
        client.run("desk.run(unlock=True, fci=True, persistent=True, home=True)")
        assert is_ready(desk.report()) and desk.report()["hand"]["homed"]
        move(desk.robot)
        client.run("desk.run(unlock=False)")
        assert is_locked(desk.report())
