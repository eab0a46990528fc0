# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The genuine clients franka-desk 0.1.0 and franka-deskapi 1.0.1 start a robot through Desk."""

from desk_clients import DESKAPI, FRANKA_DESK, fails
from desk_session import PASSWORD, USER, is_locked, is_ready, move


def test_franka_desk_brings_the_robot_up_and_down(desk_client):
    with desk_client("franka_desk", "fr3-v1", port=8443) as (desk, client):
        client.run(FRANKA_DESK + "    desk.take_control_token(); desk.unlock_joints()")
        assert client.value("desk.get_arm_info()") == {"status": "Connected", "armType": "FR3"}
        client.run("desk.end_effector_power_off()")
        assert client.value("desk.get_end_effector_power()")["status"] == "Off"
        client.run("desk.end_effector_power_on()")
        assert client.value("desk.get_safety_recovery()") == {}
        assert client.value("desk.get_self_tests_state()")["status"] == "OK"
        client.run("desk.get_arm_warnings(); desk.get_configuration()")
        client.run("desk.set_arm_mounting(desk.get_arm_mounting())")
        client.run("desk.start_arm_motion(); desk.stop_arm_motion()")
        assert "BrakesClosed" in fails(client, "desk.lock_joints(); desk.activate_fci()", "OperationError")
        client.run("desk.bring_up()")
        assert is_ready(desk.report())
        assert client.value("desk.get_fci_state()") == "Active"
        move(desk.robot)
        client.run("desk.bring_up()")  # of a robot that is up, with control already
        assert client.value("desk.get_control_token_info()['owner']") == USER
        assert client.value("desk.get_system_state().operating_mode") == "Execution"
        assert client.value("[joint['brakeStatus'] for joint in desk.get_joints()]") == ["Unlocked"] * 7
        client.run("desk.tear_down()")
        assert is_locked(desk.report())
        assert client.value("desk.get_control_token_info()['owner']") is None


# ---- franka-deskapi 1.0.1 ---------------------------------------------------------------------------------


def test_franka_deskapi_starts_the_robot(desk_client):
    with desk_client("franka_deskapi", "fr3-v1", port=8443) as (desk, client):
        client.run(DESKAPI)
        client.run("desk.take_control(force=True); desk.unlock_brakes(); desk.set_mode_execution()")
        client.run("desk.activate_fci()")
        assert is_ready(desk.report())
        move(desk.robot)
        client.run("desk.deactivate_fci(); desk.move_to_pack_pose()")
        client.run("import builtins; builtins.input = print; desk.enable_fci()")  # which waits for a key
        desk.wait(is_ready)
        client.run("desk.set_mode_programming()")
        assert client.value("desk.get_operating_mode()")["status"] == "Programming"
        client.run("desk.lock_brakes()")
        assert is_locked(desk.report())
        for name in ("operating_mode", "system_status", "system_state", "joint_state", "joint_warnings"):
            assert client.value(f"desk.get_{name}()"), name
        for name in ("joint_info", "ee_power", "control_token", "token", "fci_status"):
            assert client.value(f"desk.get_{name}()"), name
        for name in ("configuration", "software_update", "software", "arm_mounting"):
            client.run(f"desk.get_{name}()")
        client.run("import os, tempfile; os.chdir(tempfile.mkdtemp())")
        for name in ("log", "public_cyclic", "public_events", "software_status_token"):
            client.run(f"desk.get_{name}()")
        client.run("desk.ee_poweroff(); desk.ee_poweron(); desk.delete_software_update()")
        for name in ("initial_configuration", "patch_ee_configuration", "change_arm_mounting"):
            client.run(f"desk.call_api({name!r}, config_data={configuration_of(name)!r})")
        client.run("desk.close()")


def configuration_of(name: str) -> dict:
    """As in the client's own examples."""
    inertia = {"x11": 0.001, "x12": 0, "x13": 0, "x22": 0.0025, "x23": 0, "x33": 0.0017}
    rotation, centre = {"roll": 0.7071, "pitch": 0, "yaw": 0}, {"x": -0.01, "y": 0, "z": 0.03}
    transformation = {"rotation": rotation, "translation": {"x": 0, "y": 0, "z": 0.1034}}
    parameters = {"mass": 0.73, "centerOfMass": centre, "inertia": inertia, "transformation": transformation}
    hand = {"endEffectorConfiguration": {"endEffector": {"name": "FrankaHand", "params": parameters}}}
    users = [{"name": USER, "password": PASSWORD, "role": "Admin"}]
    users.append({"name": "safety", "password": "another word", "role": "SafetyOperator"})
    shop_floor = {"address": "172.16.0.2", "netmask": "255.255.255.0", "type": "Static"}
    network = {"robot": {"network": "192.168.0.0"}, "shopFloor": shop_floor}
    return {
        "initial_configuration": {
            **hand,
            "networkConfiguration": network,
            "userConfiguration": {"users": users},
        },
        "patch_ee_configuration": hand,
        "change_arm_mounting": {"orientation": {"pitch": 0.0, "roll": 0.0, "yaw": 0.0}},
    }[name]
