# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The genuine client franky-control 2.0.0 starts a robot through Desk, moves it and locks it again."""

import pytest
from desk_clients import client_of, fails, franky
from desk_session import USER, is_ready

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
REQUEST = "desk.send_api_request('/admin/api/control-token', method='GET')['tokenRequest']"
BUTTONS = "[(event.button.value, event.pressed) for event in desk.poll_buttons({})]"


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
    assert len(client.value(BUTTONS.format(5.0))) == 7  # the first message has all of them
    desk.send("button circle on")
    assert client.value(BUTTONS.format(5.0)) == [["circle", True]]
    assert client.value(BUTTONS.format(0.0)) == []
    desk.send("button circle off")
    assert client.value(BUTTONS.format(5.0)) == [["circle", False]]


def check_franky_self_test(desk, client):
    desk.send("timing self_test 1")
    desk.send("self_test due 0")
    desk.wait(lambda report: "td2Timeout" in report["recoverable"])
    client.run("desk.execute_self_test()")
    report = desk.report()
    assert not report["self_test"]["running"]
    assert report["self_test"]["due"] > 86000.0
    assert report["brakes"] == [True] * 7


def test_franky_desk_starts_the_robot(desk_client):
    with desk_client("franky", "fr3-v1") as (desk, client):
        client.run(franky("Desk"))
        check_franky(desk, client)
        assert client.value("desk.get_fci_status()") == "Inactive"
        client.run("desk.unlock_brakes(); desk.enable_fci()")
        assert client.value("desk.get_fci_status()") == "Active"
        client.run("desk.disable_fci(); desk.set_mode_execution()")
        check_franky_buttons(desk, client)
        check_franky_self_test(desk, client)
        assert client.value("desk.has_control")
        client.run("desk.close()")
        assert desk.report()["fci"] is False


@pytest.mark.parametrize("profile", ["fr3-early", "fr3-v1"])
def test_franky_desk_web_session_starts_the_robot(desk_client, profile):
    with desk_client("franky", profile) as (desk, client):
        client.run(franky("DeskWebSession"))
        check_franky(desk, client)
        client.run("desk.set_mode_programming()")
        assert client.value("desk.operating_mode.value") == "Programming"
        client.run("desk.set_mode_execution(); desk.start_task('pick')")
        check_franky_buttons(desk, client)
        check_franky_self_test(desk, client)
        client.run("desk.close()")


def test_franky_recovers_from_safety_errors(desk_client):
    with desk_client("franky", "fr3-v1") as (desk, client):
        client.run(franky("Desk") + "    desk.take_control()")
        assert client.value("desk.get_recovery_status()") is None
        client.run("desk.recover()")
        desk.send("inject genericJointError on")
        desk.wait(lambda report: report["recoverable"] == ["genericJointError"])
        assert "424" in fails(client, "desk.unlock_brakes()", "FrankaAPIError")
        assert client.value("desk.get_recovery_status()['type']") == "GenericJointError"
        client.run("desk.recover(); desk.unlock_brakes()")
        desk.send("inject jointPositionErrorDemand 3 on")
        desk.wait(lambda report: report["joint_position_error"][2])
        assert "physical" in fails(client, "desk.recover()", "DeskError")


@pytest.mark.parametrize("kind", ["Desk", "DeskWebSession"])
def test_franky_waits_for_control(desk_client, kind, tmp_path):
    with desk_client("franky", "fr3-v1") as (desk, holder):
        holder.run(franky(kind) + "    desk.take_control()")
        with client_of("franky", desk, tmp_path / "other") as other:
            other.run(franky(kind))
            fails(other, "desk.take_control(wait_timeout=1.0)", "TakeControlTimeoutError")
            left = holder.value(REQUEST)  # DeskWebSession gives up and leaves its request in Desk
            other.begin("desk.take_control(wait_timeout=20.0)")
            desk_has_another_request(holder, left)
            holder.run("desk.release_control()")
            other.end()
            assert other.value("desk.has_control") and not holder.value("desk.has_control")


def desk_has_another_request(client, left: dict | None) -> None:
    """Waits until control is requested by another request than the one that is left."""
    client.run(f"wait_for(lambda: {REQUEST} not in (None, {left!r}))")


def test_franky_forces_control(desk_client, tmp_path):
    with desk_client("franky", "fr3-early") as (desk, holder):
        holder.run(franky("DeskWebSession") + "    desk.take_control()")
        with client_of("franky", desk, tmp_path / "other") as other:
            other.run(franky("DeskWebSession"))
            with desk.pressing("circle", when_asked=True):
                other.run("desk.take_control(force=True)")
            assert other.value("desk.has_control") and not holder.value("desk.has_control")


@pytest.mark.parametrize("kind", ["Desk", "DeskWebSession"])
def test_franky_adopts_the_token_of_a_run_that_died(desk_client, kind, tmp_path):
    with desk_client("franky", "fr3-v1") as (desk, client):
        client.run(franky(kind, ", token_storage=True") + "    desk.take_control()")
        client.process.kill()
        client.process.wait()
        with client_of("franky", desk, tmp_path / "client") as next_run:
            next_run.run(franky(kind, ", token_storage=True"))
            assert next_run.value("desk.has_control")
            next_run.run("desk.unlock_brakes()")


def test_franky_reports_wrong_arguments(desk_client):
    with desk_client("franky", "fr3-v1") as (_, client):
        client.run("import franky")
        for kind in ("Desk", "DeskWebSession"):
            statement = f"franky.{kind}(HOST, {USER!r}, 'wrong').open()"
            assert "401" in fails(client, statement, "FrankaAPIError")


def test_franky_compares_owners_without_token_ids(desk_client):
    with desk_client("franky", "fr3-v1", options=["token-id=off"]) as (_, client):
        client.run(franky("Desk") + "    desk.take_control(); desk.unlock_brakes()")
        assert client.value("desk.has_control")
        client.run("desk.release_control()")
