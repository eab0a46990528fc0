# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The genuine clients rcs_fr3 and rcs_panda 0.7.3 start a robot through Desk and lock it again."""

import pytest
from desk_clients import LOGIN, client_of, rcs
from desk_session import is_locked, is_ready, move


@pytest.mark.parametrize("profile", ["fr3-early", "fr3-v1"])
def test_rcs_fr3_starts_the_robot(desk_client, profile):
    with desk_client("rcs", profile) as (desk, client):
        client.run(rcs("rcs_fr3") + "    fci = rcs.FCI(desk, unlock=True)")
        client.run("fci.__enter__()")
        assert is_ready(desk.report())
        move(desk.robot)
        client.run("fci.__exit__()")
        report = desk.report()
        assert is_locked(report) and report["operating_mode"] == "programming"
        client.run("desk.take_control(force=True); desk.disable_guiding_mode(); desk.release_control()")
        client.run(f"with rcs.Desk.guiding_mode(HOST, {LOGIN}, unlock=True): pass")
        assert desk.report()["brakes"] == [False] * 7
        client.run("desk.release_control(); desk.logout()")  # without control, which only warns


def test_rcs_fr3_unlocks_by_its_command(desk_client):
    """Its command releases control at once, and expects that the FCI stays on."""
    with desk_client("rcs", "fr3-v1", options=["fci-after-release=on"]) as (desk, client):
        client.run(rcs("rcs_fr3"))
        client.run(f"rcs.unlock(HOST, {LOGIN})")
        client.run(f"with rcs.Desk(HOST, {LOGIN}) as other: other.activate_fci()")
        assert is_ready(desk.report())
        move(desk.robot)
        client.run(f"rcs.lock(HOST, {LOGIN})")
        desk.wait(is_locked)


def test_rcs_fr3_forces_control_and_listens(desk_client, tmp_path):
    with desk_client("rcs", "fr3-v1") as (desk, holder):
        holder.run(rcs("rcs_fr3") + "    desk.take_control()")
        with client_of("rcs", desk, tmp_path / "other") as other:
            other.run(rcs("rcs_fr3"))
            assert not other.value("desk.take_control()")
            with desk.pressing("circle", when_asked=True):
                assert other.value("desk.take_control(force=True)")
            assert other.value("desk.has_control()") and not holder.value("desk.has_control()")
            other.run("clicks = []; desk.listen(lambda host, buttons: clicks.append(buttons))")
            other.run("wait_for(lambda: desk._listening)")
            with desk.pressing("cross"):
                other.run("wait_for(lambda: ['cross'] in clicks)")
            other.run("desk.stop_listen()")


def test_rcs_panda_starts_the_robot(desk_client):
    with desk_client("rcs", "fer-spoc") as (desk, client):
        client.run(rcs("rcs_panda"))
        client.run("desk.take_control(force=True); desk.unlock(); desk.activate_fci()")
        assert is_ready(desk.report())
        move(desk.robot)
        client.run("desk.deactivate_fci(); desk.lock(); desk.release_control()")
        assert is_locked(desk.report())
