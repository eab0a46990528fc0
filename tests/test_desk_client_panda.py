# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The genuine client panda-python 1.1.1 starts a robot through Desk, moves it and locks it again."""

import pytest
from desk_clients import PANDA, client_of, fails
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
        if profile.startswith("fer"):
            client.run(PANDA_MOTION)
            assert client.value("motion.time") >= 0.5
        else:  # whose protocol its libfranka does not speak
            move(desk.robot)
        client.run("desk.lock(); desk.deactivate_fci()")
        assert desk.report()["brakes"] == [True] * 7
        client.run("desk.release_control(); desk.logout()")


def test_panda_python_listens_to_buttons(desk_client):
    with desk_client("panda", "fer-spoc") as (desk, client):
        client.run(PANDA + "    events = []; desk.listen(events.append)")
        assert client.value("wait_for(lambda: events)[0]") == dict.fromkeys(
            ("circle", "cross", "check", "up", "down", "left", "right"), False
        )
        desk.send("button check on")
        assert client.value("wait_for(lambda: events[1:])") == [{"check": True}]
        desk.send("button check off")
        assert client.value("wait_for(lambda: events[2:])") == [{"check": False}]
        client.run("desk.stop_listen()")


@pytest.mark.parametrize("profile", ["fer-spoc", "fr3-v1"])
def test_panda_python_forces_control(desk_client, profile, tmp_path):
    with desk_client("panda", profile) as (desk, holder):
        holder.run(PANDA + "    desk.unlock(); desk.activate_fci()")
        desk.wait(is_ready)
        with client_of("panda", desk, tmp_path / "other") as other:
            other.run(PANDA)
            assert not other.value("desk.has_control()")
            assert not other.value("desk.take_control()")
            with desk.pressing("circle", when_asked=True):
                assert other.value("desk.take_control(force=True)")
            assert other.value("desk.has_control()")
            assert not holder.value("desk.has_control()")
            desk.wait(lambda report: not report["fci"])
            other.run("desk.activate_fci()")
            desk.wait(is_ready)


def test_panda_python_does_not_get_control_without_the_operator(desk_client, tmp_path):
    with desk_client("panda", "fer-spoc", options=["force-timeout=1"]) as (desk, holder):
        holder.run(PANDA)
        with client_of("panda", desk, tmp_path / "other") as other:
            other.run(PANDA)
            fails(other, "desk.take_control(force=True)", "TimeoutError")
            assert holder.value("desk.has_control()")


def test_panda_python_takes_its_control_again(desk_client, tmp_path):
    with desk_client("panda", "fr3-v1") as (desk, client):
        client.run(PANDA + "    desk.unlock()")
        with client_of("panda", desk, tmp_path / "client") as next_run:
            next_run.run(PANDA + "    desk.activate_fci()")
            desk.wait(is_ready)
            next_run.run("desk.release_control()")
            next_run.run("desk.release_control()")  # which only warns
        assert not client.value("desk.has_control()")
        desk.wait(lambda report: not report["fci"])
        assert "does not have control" in fails(client, "desk.unlock()", "ConnectionError")
