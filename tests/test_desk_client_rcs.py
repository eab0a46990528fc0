# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The genuine clients rcs_fr3 and rcs_panda 0.7.3 start a robot through Desk and lock it again."""

from desk_clients import LOGIN, rcs
from desk_session import is_locked, is_ready, move


def test_rcs_fr3_starts_the_robot(desk_client):
    with desk_client("rcs", "fr3-early", port=8443) as (desk, client):
        client.run(rcs("rcs_fr3") + "    fci = rcs.FCI(desk, unlock=True)")
        client.run("fci.__enter__()")
        assert is_ready(desk.report())
        move(desk.robot)
        client.run("clicks = []; desk.listen(lambda host, buttons: clicks.append(buttons))")
        client.run("wait_for(lambda: desk._listening, 60)")
        with desk.held("button cross"):
            client.run("wait_for(lambda: desk._button_states['cross'], 60)")
        client.run("wait_for(lambda: ['cross'] in clicks, 60); desk.stop_listen()")
        client.run("fci.__exit__()")
        report = desk.report()
        assert is_locked(report) and report["operating_mode"] == "programming"
        client.run("desk.take_control(force=True); desk.disable_guiding_mode(); desk.release_control()")
        client.run(f"with rcs.Desk.guiding_mode(HOST, {LOGIN}, unlock=True): pass")
        assert desk.report()["brakes"] == [False] * 7
        client.run("desk.release_control(); desk.logout()")  # without control, which only warns


def test_rcs_panda_starts_the_robot(desk_client):
    with desk_client("rcs", "fer-spoc") as (desk, client):
        client.run(rcs("rcs_panda"))
        client.run("desk.take_control(force=True); desk.unlock(); desk.activate_fci()")
        assert is_ready(desk.report())
        move(desk.robot)
        client.run("desk.deactivate_fci(); desk.lock(); desk.release_control()")
        assert is_locked(desk.report())
