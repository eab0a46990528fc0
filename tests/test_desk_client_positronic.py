# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The genuine client positronic_franka 0.12.0 starts a robot through Desk and locks it again."""

from desk_clients import LOGIN
from desk_session import is_locked, is_ready, move
from genuine_clients import positronic_sources


def positronic() -> str:
    return f"""
    import sys
    sys.path.insert(0, {str(positronic_sources())!r})
    from desk import Desk
    desk = Desk(HOST, {LOGIN})
"""


def test_positronic_starts_the_robot(desk_client):
    with desk_client("positronic", "fr3-v1") as (desk, client):
        client.run(positronic() + "    desk.__enter__(); desk.prepare()")
        assert is_ready(desk.report())
        move(desk.robot)
        client.run("desk.ensure_control(); desk.__exit__(None, None, None)")
        assert is_locked(desk.report())
