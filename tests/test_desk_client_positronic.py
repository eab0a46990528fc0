# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The genuine client positronic_franka 0.12.0 starts a robot through Desk and locks it again."""

import pytest
from desk_clients import LOGIN, client_of, fails
from desk_session import USER, is_locked, is_ready, move
from genuine_clients import positronic_sources


def positronic() -> str:
    return f"""
    import sys
    sys.path.insert(0, {str(positronic_sources())!r})
    from desk import Desk
    desk = Desk(HOST, {LOGIN})
"""


def test_positronic_starts_the_robot(desk_client, tmp_path):
    with desk_client("positronic", "fr3-v1") as (desk, client):
        client.run(positronic() + "    desk.__enter__(); desk.prepare()")
        assert is_ready(desk.report())
        move(desk.robot)
        with client_of("positronic", desk, tmp_path / "other") as other:
            other.run(positronic())
            assert f"Desk login '{USER}'" in fails(other, "desk.__enter__()", "ControlHeldElsewhere")
        client.run("desk.ensure_control(); desk.__exit__(None, None, None)")
        assert is_locked(desk.report())


def test_positronic_runs_a_due_self_test(desk_client):
    with desk_client("positronic", "fr3-v1") as (desk, client):
        desk.send("timing self_test 1")
        for due in (1000.0, 0.0):
            desk.send(f"self_test due {due}")
            desk.wait(lambda report, due=due: ("td2Timeout" in report["recoverable"]) == (due == 0.0))
            client.run(positronic() + "    desk.__enter__(); desk.prepare()")
            report = desk.report()
            assert is_ready(report) and report["self_test"]["due"] > 86000.0
            client.run("desk.__exit__(None, None, None)")


def test_positronic_reports_what_the_operator_must_do(desk_client):
    with desk_client("positronic", "fr3-v1") as (desk, client):
        client.run(positronic() + "    desk.__enter__()")
        desk.send("operating_mode programming")
        desk.wait(lambda report: report["operating_mode"] == "programming")
        fails(client, "desk.prepare()", "ProgrammingModeError")
        desk.send("inject jointPositionErrorDemand 3 on")
        desk.wait(lambda report: report["joint_position_error"][2])
        assert "joint 3" in fails(client, "desk.prepare()", "JointRecoveryRequired")


@pytest.mark.long_form("takes 20 s")
def test_positronic_reboots(desk_client):
    with desk_client("positronic", "fr3-v1", options=["boot-time=6"]) as (desk, client):
        client.run(positronic() + "    desk.reboot(wait=True)")
        client.run("desk.__enter__(); desk.prepare()")
        assert is_ready(desk.report())
