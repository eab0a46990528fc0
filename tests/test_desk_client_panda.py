# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The genuine client panda-python 1.1.1 starts a robot through Desk, moves it and locks it again."""

import pytest
from desk_clients import PANDA
from desk_session import is_ready, move

PANDA_MOTION = """
    from network_client import Motion, Panda
    motion = Motion(0.5, 0.01, 0.0, False, 0.0)
    Panda(HOST).move(motion, torque=False)
"""


@pytest.mark.parametrize("profile", ["fer-old", "fer-spoc", "fr3-early", "fr3-v1"])
def test_panda_python_starts_the_robot(desk_client, profile):
    with desk_client("panda", profile) as (desk, client):
        client.run(PANDA)
        assert client.value("desk.has_control()")
        client.run("desk.unlock(); desk.activate_fci()")
        desk.wait(is_ready)
        client.run("events = []; desk.listen(events.append); wait_for(lambda: events, 60)")
        with desk.held("button check"):
            client.run("wait_for(lambda: {'check': True} in events, 60)")
        client.run("desk.stop_listen()")
        if profile.startswith("fer"):
            client.run(PANDA_MOTION)
            assert client.value("motion.time") >= 0.5
        else:  # whose protocol its libfranka does not speak
            move(desk.robot)
        client.run("desk.lock(); desk.deactivate_fci()")
        assert desk.report()["brakes"] == [True] * 7
        client.run("desk.release_control(); desk.logout()")
