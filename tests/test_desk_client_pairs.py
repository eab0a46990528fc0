# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Genuine clients of Desk one after the other and at once: another port, a token that two of them use."""

from desk_clients import AIOFRANKA, DESKAPI, LOGIN, PANDA, client_of, franka_desk, franky, rcs
from desk_session import beside, is_ready, move, robot_with_desk

BEGINNINGS = {
    "panda": (PANDA, "desk.release_control()"),
    "franky": (franky("Desk") + "    desk.take_control()", "desk.close()"),
    "franka_desk": (franka_desk() + "    desk.take_control_token()", "desk.release_control_token()"),
    "franka_deskapi": (DESKAPI + "    desk.take_control()", "desk.close()"),
    "rcs": (rcs("rcs_fr3") + "    desk.take_control()", "desk.release_control()"),
    "aiofranka": (
        AIOFRANKA + "    desk = _DeskClientV2(HOST, *names.values()); desk.take_token()",
        "desk.release_token()",
    ),
}


def test_clients_take_another_port(tmp_path):
    """As the host of a Desk that may not open port 443."""
    with robot_with_desk(tmp_path, "fr3-v1", port=8443) as desk:
        for name, (begin, end) in BEGINNINGS.items():
            with client_of(name, desk, tmp_path / name) as client:
                client.run(begin)
                assert desk.get("/admin/api/control-token")["activeToken"] is not None, name
                client.run(end)
                assert desk.get("/admin/api/control-token")["activeToken"] is None, name


def test_one_token_serves_clients_of_both_interfaces(desk_client, tmp_path):
    with desk_client("franky", "fr3-v1") as (desk, client):
        client.run(franky("DeskWebSession") + "    desk.take_control(); desk.unlock_brakes()")
        client.run(
            f"""
            import base64
            newer = franky.Desk(HOST, {LOGIN}); newer.open()
            newer._BaseDesk__control_token = desk.control_token
            newer._BaseDesk__control_token_id = desk.control_token_id
            newer.enable_fci()
            """
        )
        assert is_ready(desk.report())
        assert client.value("newer.has_control and desk.has_control")
        with beside(lambda: move(desk.robot)):
            assert client.value("newer.brake_state.value") == "Unlocked"
