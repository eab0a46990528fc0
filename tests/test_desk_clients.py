# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Genuine clients of Desk, from PyPI, start a robot through Desk, move it over the FCI and lock it again."""

import threading
from contextlib import contextmanager

import pytest
from client_session import ClientError, client_session
from desk_session import PASSWORD, USER, move, robot_with_desk
from genuine_clients import client_python, positronic_sources

OPENED, CLOSED = [False] * 7, [True] * 7
LOGIN = f"{USER!r}, {PASSWORD!r}"


@contextmanager
def client_of(name: str, desk, home, **environment: str):
    """A genuine client that knows `HOST` and trusts the certificate of Desk."""
    environment["SSL_CERT_FILE"] = str(desk.certificate)
    with client_session(client_python(name), home, **environment) as session:
        session.run(f"HOST = {desk.host!r}")
        yield session


@pytest.fixture
def start(tmp_path):
    """Starts a robot with its Desk and one genuine client."""

    @contextmanager
    def started(name: str, profile: str, **settings):
        client_python(name)  # before the robot
        with robot_with_desk(tmp_path, profile, **settings) as desk:
            with client_of(name, desk, tmp_path / "client") as client:
                yield desk, client

    return started


def is_ready(report: dict) -> bool:
    return report["fci"] and report["brakes"] == OPENED


def is_locked(report: dict) -> bool:
    return not report["fci"] and report["brakes"] == CLOSED


def fails(client, statement: str, kind: str) -> str:
    """The text of the client's exception."""
    with pytest.raises(ClientError) as caught:
        client.run(statement)
    assert caught.value.kind == kind, caught.value
    return caught.value.text


# ---- panda-python 1.1.1 -----------------------------------------------------------------------------------

PANDA = f"""
    from panda_py import Desk, libfranka
    desk = Desk(HOST, {LOGIN})
"""
PANDA_MOTION = """
    from network_client import Motion, Panda
    motion = Motion(0.5, 0.01, 0.0, False, 0.0)
    Panda(HOST).move(motion, torque=False)
"""


@pytest.mark.parametrize("profile", ["fer-old", "fer-spoc", "fr3-early", "fr3-v1"])
def test_panda_python_starts_the_robot(start, profile):
    with start("panda", profile) as (desk, client):
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
        assert desk.report()["brakes"] == CLOSED
        client.run("desk.release_control(); desk.logout()")


def test_panda_python_listens_to_buttons(start):
    with start("panda", "fer-spoc") as (desk, client):
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
def test_panda_python_forces_control(start, profile, tmp_path):
    with start("panda", profile) as (desk, holder):
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


def test_panda_python_does_not_get_control_without_a_person(start, tmp_path):
    with start("panda", "fer-spoc", options=["force-timeout=1"]) as (desk, holder):
        holder.run(PANDA)
        with client_of("panda", desk, tmp_path / "other") as other:
            other.run(PANDA)
            fails(other, "desk.take_control(force=True)", "TimeoutError")
            assert holder.value("desk.has_control()")


def test_panda_python_takes_its_control_again(start, tmp_path):
    with start("panda", "fr3-v1") as (desk, client):
        client.run(PANDA + "    desk.unlock()")
        with client_of("panda", desk, tmp_path / "client") as next_run:
            next_run.run(PANDA + "    desk.activate_fci()")
            desk.wait(is_ready)
            next_run.run("desk.release_control()")
            next_run.run("desk.release_control()")  # which only warns
        assert not client.value("desk.has_control()")
        desk.wait(lambda report: not report["fci"])
        assert "does not have control" in fails(client, "desk.unlock()", "ConnectionError")


# ---- franky-control 2.0.0 ---------------------------------------------------------------------------------

FRANKY = f"""
    import franky
    desk = franky.{{}}(HOST, {LOGIN}{{}})
    desk.open()
"""
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
BUTTONS = "[(event.button.value, event.pressed) for event in desk.poll_buttons({})]"


def franky(kind: str, more: str = "") -> str:
    return FRANKY.format(kind, more)


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
    assert report["brakes"] == CLOSED


def test_franky_desk_starts_the_robot(start):
    with start("franky", "fr3-v1") as (desk, client):
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
def test_franky_desk_web_session_starts_the_robot(start, profile):
    with start("franky", profile) as (desk, client):
        client.run(franky("DeskWebSession"))
        check_franky(desk, client)
        client.run("desk.set_mode_programming()")
        assert client.value("desk.operating_mode.value") == "Programming"
        client.run("desk.set_mode_execution(); desk.start_task('pick')")
        check_franky_buttons(desk, client)
        check_franky_self_test(desk, client)
        client.run("desk.close()")


def test_franky_recovers_from_safety_errors(start):
    with start("franky", "fr3-v1") as (desk, client):
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
def test_franky_waits_for_control(start, kind, tmp_path):
    with start("franky", "fr3-v1") as (desk, holder):
        holder.run(franky(kind) + "    desk.take_control()")
        with client_of("franky", desk, tmp_path / "other") as other:
            other.run(franky(kind))
            fails(other, "desk.take_control(wait_timeout=1.0)", "TakeControlTimeoutError")
            other.begin("desk.take_control(wait_timeout=20.0)")
            desk_has_a_request(holder)
            holder.run("desk.release_control()")
            other.end()
            assert other.value("desk.has_control") and not holder.value("desk.has_control")


def desk_has_a_request(client) -> None:
    """Waits until another one asks for control."""
    client.run(
        """
        def asked():
            return desk.send_api_request("/admin/api/control-token", method="GET")["tokenRequest"]
        wait_for(asked)
        """
    )


def test_franky_forces_control(start, tmp_path):
    with start("franky", "fr3-early") as (desk, holder):
        holder.run(franky("DeskWebSession") + "    desk.take_control()")
        with client_of("franky", desk, tmp_path / "other") as other:
            other.run(franky("DeskWebSession"))
            with desk.pressing("circle", when_asked=True):
                other.run("desk.take_control(force=True)")
            assert other.value("desk.has_control") and not holder.value("desk.has_control")


@pytest.mark.parametrize("kind", ["Desk", "DeskWebSession"])
def test_franky_adopts_the_token_of_a_run_that_died(start, kind, tmp_path):
    with start("franky", "fr3-v1") as (desk, client):
        client.run(franky(kind, ", token_storage=True") + "    desk.take_control()")
        client.process.kill()
        client.process.wait()
        with client_of("franky", desk, tmp_path / "client") as next_run:
            next_run.run(franky(kind, ", token_storage=True"))
            assert next_run.value("desk.has_control")
            next_run.run("desk.unlock_brakes()")


def test_franky_knows_wrong_words(start):
    with start("franky", "fr3-v1") as (_, client):
        client.run("import franky")
        for kind in ("Desk", "DeskWebSession"):
            statement = f"franky.{kind}(HOST, {USER!r}, 'wrong').open()"
            assert "401" in fails(client, statement, "FrankaAPIError")


def test_franky_compares_owners_without_token_ids(start):
    with start("franky", "fr3-v1", options=["token-id=off"]) as (_, client):
        client.run(franky("Desk") + "    desk.take_control(); desk.unlock_brakes()")
        assert client.value("desk.has_control")
        client.run("desk.release_control()")


# ---- franka-desk 0.1.0 ------------------------------------------------------------------------------------

FRANKA_DESK = f"""
    import franka_desk
    desk = franka_desk.FrankaDeskClient(f"https://{{HOST}}", {LOGIN}{{}})
"""


def franka_desk(more: str = "") -> str:
    return FRANKA_DESK.replace("{HOST}", "@").format(more).replace("@", "{HOST}")


def test_franka_desk_brings_the_robot_up_and_down(start):
    with start("franka_desk", "fr3-v1") as (desk, client):
        client.run(franka_desk() + "    desk.bring_up()")
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


def test_franka_desk_waits_for_the_user_stop(start):
    with start("franka_desk", "fr3-v1") as (desk, client):
        with desk.held("input x31"):
            desk.wait(lambda report: report["inputs"]["x31"])
            client.run(franka_desk() + "    desk.take_control_token()")
            assert client.value("desk.is_user_stop_engaged()")
            assert "stop is pressed" in fails(client, "desk.unlock_joints()", "UserStopEngaged")
            fails(client, "desk.wait_until_user_stop_released(timeout=1.0)", "TimeoutError")
            client.begin("desk.activate_arm()")
        client.end()
        assert is_ready(desk.report())
        with desk.held("input x31"):
            desk.wait(is_locked)
        desk.wait(lambda report: not report["inputs"]["x31"])
        assert not client.value("desk.is_user_stop_engaged()")
        client.run("desk.activate_arm()")
        assert is_ready(desk.report())
        move(desk.robot)


def test_franka_desk_recovers_its_token(start, tmp_path):
    with start("franka_desk", "fr3-v1") as (desk, client):
        client.run(franka_desk() + "    desk.take_control_token()")
        with client_of("franka_desk", desk, tmp_path / "client") as next_run:
            next_run.run(franka_desk() + "    desk.bring_up()")
            assert is_ready(desk.report())
        with client_of("franka_desk", desk, tmp_path / "other") as other:
            other.run(franka_desk(", token_owner='someone'"))
            assert f"held by '{USER}'" in fails(other, "desk.take_control_token()", "TokenUnavailable")
            other.run(franka_desk())
            assert "no saved token" in fails(other, "desk.take_control_token()", "TokenUnavailable")


def test_franka_desk_reads_and_sets_the_rest(start):
    with start("franka_desk", "fr3-v1") as (desk, client):
        client.run(franka_desk() + "    desk.take_control_token(); desk.unlock_joints()")
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


def test_franka_desk_knows_a_wrong_password(start):
    with start("franka_desk", "fr3-v1") as (_, client):
        client.run("from franka_desk import FrankaDeskClient")
        wrong = f"FrankaDeskClient(HOST, {USER!r}, 'wrong').take_control_token()"
        assert "Authentication failed" in fails(client, wrong, "AuthenticationError")


def test_franka_desk_waits_for_a_reboot(start):
    with start("franka_desk", "fr3-v1", options=["boot-time=3"]) as (desk, client):
        client.run(franka_desk() + "    desk.bring_up(); desk.reboot()")
        desk.wait(lambda report: not report["power"])
        client.run("desk.wait_until_ready()")
        assert is_locked(desk.report())
        assert "423" in fails(client, "desk.unlock_joints()", "HTTPError")
        client.run("desk.bring_up()")
        assert is_ready(desk.report())
        move(desk.robot)


# ---- franka-deskapi 1.0.1 ---------------------------------------------------------------------------------

DESKAPI = f"""
    import json
    from deskapi import FrankDeskApi
    desk = FrankDeskApi(HOST, {LOGIN})
    desk.open()
"""


def test_franka_deskapi_starts_the_robot(start):
    with start("franka_deskapi", "fr3-v1") as (desk, client):
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
        client.run("desk.lock_brakes(); desk.close()")
        assert is_locked(desk.report())


def test_franka_deskapi_reads_and_sets_the_rest(start):
    with start("franka_deskapi", "fr3-v1") as (desk, client):
        client.run(DESKAPI + "    desk.take_control(force=True)")
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


# ---- rcs_fr3 and rcs_panda 0.7.3 --------------------------------------------------------------------------


def rcs(name: str) -> str:
    environment = "DefaultFR3HardwareEnv" if name == "rcs_fr3" else "DefaultPandaHardwareEnv"
    return f"""
    from bare_package import bare_package
    bare_package({name!r}, configs={{{environment!r}: None}})
    from {name} import desk as rcs
    desk = rcs.Desk(HOST, {LOGIN})
"""


@pytest.mark.parametrize("profile", ["fr3-early", "fr3-v1"])
def test_rcs_fr3_starts_the_robot(start, profile):
    with start("rcs", profile) as (desk, client):
        client.run(rcs("rcs_fr3") + "    fci = rcs.FCI(desk, unlock=True)")
        client.run("fci.__enter__()")
        assert is_ready(desk.report())
        move(desk.robot)
        client.run("fci.__exit__()")
        report = desk.report()
        assert is_locked(report) and report["operating_mode"] == "programming"
        client.run("desk.take_control(force=True); desk.disable_guiding_mode(); desk.release_control()")
        client.run(f"with rcs.Desk.guiding_mode(HOST, {LOGIN}, unlock=True): pass")
        assert desk.report()["brakes"] == OPENED
        client.run("desk.release_control(); desk.logout()")  # without control, which only warns


def test_rcs_fr3_unlocks_by_its_command(start):
    """Its command releases control at once, and expects that the FCI stays on."""
    with start("rcs", "fr3-v1", options=["fci-after-release=on"]) as (desk, client):
        client.run(rcs("rcs_fr3"))
        client.run(f"rcs.unlock(HOST, {LOGIN})")
        client.run(f"with rcs.Desk(HOST, {LOGIN}) as other: other.activate_fci()")
        assert is_ready(desk.report())
        move(desk.robot)
        client.run(f"rcs.lock(HOST, {LOGIN})")
        desk.wait(is_locked)


def test_rcs_fr3_forces_control_and_listens(start, tmp_path):
    with start("rcs", "fr3-v1") as (desk, holder):
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


def test_rcs_panda_starts_the_robot(start):
    with start("rcs", "fer-spoc") as (desk, client):
        client.run(rcs("rcs_panda"))
        client.run("desk.take_control(force=True); desk.unlock(); desk.activate_fci()")
        assert is_ready(desk.report())
        move(desk.robot)
        client.run("desk.deactivate_fci(); desk.lock(); desk.release_control()")
        assert is_locked(desk.report())


# ---- positronic_franka 0.12.0 -----------------------------------------------------------------------------


def positronic() -> str:
    return f"""
    import sys
    sys.path.insert(0, {str(positronic_sources())!r})
    from desk import Desk
    desk = Desk(HOST, {LOGIN})
"""


def test_positronic_starts_the_robot(start, tmp_path):
    with start("positronic", "fr3-v1") as (desk, client):
        client.run(positronic() + "    desk.__enter__(); desk.prepare()")
        assert is_ready(desk.report())
        move(desk.robot)
        with client_of("positronic", desk, tmp_path / "other") as other:
            other.run(positronic())
            assert f"Desk login '{USER}'" in fails(other, "desk.__enter__()", "ControlHeldElsewhere")
        client.run("desk.ensure_control(); desk.__exit__(None, None, None)")
        assert is_locked(desk.report())


def test_positronic_runs_a_due_self_test(start):
    with start("positronic", "fr3-v1") as (desk, client):
        desk.send("timing self_test 1")
        for due in (1000.0, 0.0):
            desk.send(f"self_test due {due}")
            desk.wait(lambda report, due=due: ("td2Timeout" in report["recoverable"]) == (due == 0.0))
            client.run(positronic() + "    desk.__enter__(); desk.prepare()")
            report = desk.report()
            assert is_ready(report) and report["self_test"]["due"] > 86000.0
            client.run("desk.__exit__(None, None, None)")


def test_positronic_knows_what_a_person_must_do(start):
    with start("positronic", "fr3-v1") as (desk, client):
        client.run(positronic() + "    desk.__enter__()")
        desk.send("operating_mode programming")
        desk.wait(lambda report: report["operating_mode"] == "programming")
        fails(client, "desk.prepare()", "ProgrammingModeError")
        desk.send("inject jointPositionErrorDemand 3 on")
        desk.wait(lambda report: report["joint_position_error"][2])
        assert "joint 3" in fails(client, "desk.prepare()", "JointRecoveryRequired")


def test_positronic_reboots(start, long_run):
    if not long_run:
        pytest.skip("takes 20 s; the long form has it")
    with start("positronic", "fr3-v1", options=["boot-time=6"]) as (desk, client):
        client.run(positronic() + "    desk.reboot(wait=True)")
        client.run("desk.__enter__(); desk.prepare()")
        assert is_ready(desk.report())


# ---- aiofranka 0.9.0 --------------------------------------------------------------------------------------

AIOFRANKA = f"""
    import aiofranka, numpy
    from aiofranka.server import _DeskClient, _DeskClientV2
    names = dict(username={USER!r}, password={PASSWORD!r})
"""
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


def test_aiofranka_unlocks_and_locks(start):
    with start("aiofranka", "fr3-v1") as (desk, client):
        client.run(AIOFRANKA + AIOFRANKA_FILE)
        client.run("aiofranka.unlock(HOST, **names)")
        assert is_ready(desk.report())
        client.run(AIOFRANKA_MOTION)
        assert client.value("missed") < 0.02
        assert client.value("robot.tool.name") == "Franka Hand"
        client.run("aiofranka.lock(HOST, **names)")  # with the token of before
        assert is_locked(desk.report())


def test_aiofranka_starts_its_own_server(start, long_run):
    if not long_run:
        pytest.skip("the long form has it")
    with start("aiofranka", "fr3-v1") as (desk, client):
        client.run(AIOFRANKA + "    aiofranka.start(HOST, **names)")
        assert desk.report()["mode"] == "Move"
        client.run("aiofranka.stop(HOST)")
        desk.wait(is_locked)


def test_aiofranka_runs_an_overdue_self_test(start):
    with start("aiofranka", "fr3-v1") as (desk, client):
        desk.send("timing self_test 1")
        desk.send("self_test due 0")
        desk.wait(lambda report: report["recoverable"] == ["td2Timeout"])
        client.run(AIOFRANKA + "    aiofranka.unlock(HOST, **names)")
        report = desk.report()
        assert is_ready(report) and report["self_test"]["due"] > 86000.0


def test_aiofranka_leaves_programming(start):
    """Which only the older interface reaches, with the cookie of a login and the newer one's token."""
    with start("aiofranka", "fr3-v1") as (desk, client):
        client.run(AIOFRANKA + "    desk = _DeskClientV2(HOST, *names.values()); desk.take_token()")
        client.run("desk.change_operating_mode('Programming'); desk.release_token()")
        desk.wait(lambda report: report["operating_mode"] == "programming")
        client.run("aiofranka.unlock(HOST, **names)")
        assert is_ready(desk.report())


def test_aiofranka_keeps_tools_in_desk(start):
    with start("aiofranka", "fr3-v1") as (desk, client):
        client.run(AIOFRANKA + "    aiofranka.save_tool('probe', 0.4, [0, 0, 0.05], ip=HOST, **names)")
        assert "probe" in client.value("list(aiofranka.list_tools(HOST, **names))")
        client.run("aiofranka.load_tool('probe', HOST, **names)")
        assert client.value("aiofranka.active_tool(HOST, **names).name") == "probe"
        assert desk.wait(lambda report: report["end_effector"]["mass"] == 0.4)
        client.run("aiofranka.set_configuration(HOST, mass=0.5, com=[0, 0, 0.02], **names)")
        assert desk.wait(lambda report: report["end_effector"]["mass"] == 0.5)
        client.run("aiofranka.unload_tool(HOST, **names); aiofranka.remove_tool('probe', HOST, **names)")
        assert desk.wait(lambda report: report["end_effector"]["mass"] == 0.0)


@pytest.mark.parametrize("profile, home", [("fr3-early", False), ("fr3-v1", False), ("fer-spoc", True)])
def test_aiofranka_lock_unlock_starts_the_robot(start, profile, home):
    with start("aiofranka", profile) as (desk, client):
        client.run(AIOFRANKA + "    from aiofranka.client import FrankaLockUnlock")
        client.run("desk = FrankaLockUnlock(HOST, *names.values())")
        client.run(f"desk.run(unlock=True, fci=True, persistent=True, home={home})")
        assert is_ready(desk.report()) and desk.report()["hand"]["homed"] == home
        move(desk.robot)
        client.run("desk.run(unlock=False)")
        assert is_locked(desk.report())


def test_aiofranka_old_client_starts_the_robot(start):
    with start("aiofranka", "fr3-v1") as (desk, client):
        client.run(AIOFRANKA + "    desk = _DeskClient(HOST, *names.values()); desk.login()")
        client.run("desk.take_token(); desk.recover_errors(); desk.unlock(); desk.activate_fci()")
        assert client.value("desk.is_fci_active() and desk.are_joints_unlocked()")
        assert client.value("desk.get_token_info()['fciActive']")
        client.run("desk.deactivate_fci(); desk.lock(); desk.release_token()")
        assert is_locked(desk.report())


# ---- all of them ------------------------------------------------------------------------------------------

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


# ---- several at once --------------------------------------------------------------------------------------


def test_one_token_serves_clients_of_both_interfaces(start, tmp_path):
    with start("franky", "fr3-v1") as (desk, client):
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
        threads = [threading.Thread(target=move, args=(desk.robot,))]
        threads[0].start()
        assert client.value("newer.brake_state.value") == "Unlocked"
        threads[0].join()
