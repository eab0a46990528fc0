# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Controllers and errors on both nodes of franka_control, and in the simulation.

A controller that throws, in starting() or in update(), ends none of them; and with
restart_controllers_after_recovery false no arm moves by itself after a recovery.
"""

import json
from pathlib import Path

import pytest
from franka_sim_mujoco.session import Session

HERE = Path(__file__).resolve().parent
SUCCEEDED = 3

PACKAGE = """<package format="2">
  <name>throwing_controllers</name> <version>0.0.0</version> <description>For a test.</description>
  <maintainer email="nobody@example.org">nobody</maintainer> <license>Apache-2.0</license>
  <depend>controller_interface</depend>
  <export><controller_interface plugin="${prefix}/plugins.xml"/></export>
</package>"""
PLUGINS = """<library path="lib/libfranka_control_throwing_controller">
  <class name="test/Throwing" type="franka_control_test::ThrowingController"
         base_class_type="controller_interface::ControllerBase"/>
</library>"""

# A node, and its arms with their addresses.
ONE = ("/franka_control", {"fr3": "127.0.7.31"})
TWO = ("/combined_panda", {"panda_1": "127.0.7.32", "panda_2": "127.0.7.33"})
SIMULATED = ("/franka_control", {"panda": "nowhere"})  # the controllers run in the simulation's process
LAUNCH = """<launch>
  <param name="{node}/restart_controllers_after_recovery" value="{restart}"/>
  <include file="$(find franka_control)/launch/{file}"> {arguments} <arg name="sim" value="true"/> </include>
</launch>"""


def launch(node, arms, restart):
    if arms == SIMULATED[1]:
        return """<launch> <include file="$(find franka_sim_mujoco)/launch/panda.launch">
          <arg name="headless" value="true"/> </include> </launch>"""
    if node == ONE[0]:
        file = "franka_control.launch"
        given = {"robot": "fr3", "load_gripper": "false", "robot_ip": arms["fr3"]}
    else:
        file = "franka_combined_control.launch"
        addresses = ", ".join(f"{arm}/robot_ip: {address}" for arm, address in arms.items())
        given = {"robot_ips": f"{{{addresses}}}"}
    arguments = " ".join(f'<arg name="{name}" value="{value}"/>' for name, value in given.items())
    return LAUNCH.format(node=node, restart=restart, file=file, arguments=arguments)


def report_of(what, node, arms, restart, folder):
    """The client's report, and the log."""
    (folder / "package.xml").write_text(PACKAGE)
    (folder / "plugins.xml").write_text(PLUGINS)
    (folder / "robot.launch").write_text(launch(node, arms, restart))
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ROS_PACKAGE_PATH", str(folder), prepend=":")
        with Session(str(folder / "robot.launch"), log=folder / "log") as session:
            session.wait_for_master()
            client = ["/usr/bin/python3", str(HERE / "controllers_and_errors_client.py"), what, node]
            client += [f"{arm}={address}" for arm, address in arms.items()]
            result = session.run(*client, check=False, timeout=180)
            print(result.stdout, session.tail(60), sep="\n")
            assert result.returncode == 0, f"{result}\n{session.tail(60)}"
            session.check()
            return json.loads(result.stdout.strip().splitlines()[-1]) | {"log": session.tail(200)}


@pytest.fixture(scope="module", params=[ONE, TWO], ids=["one arm", "two arms"])
def report(request, tmp_path_factory):
    return report_of("throw", *request.param, "true", tmp_path_factory.mktemp("throwing"))


@pytest.fixture(scope="module")
def simulated(tmp_path_factory):
    return report_of("simulate", *SIMULATED, "true", tmp_path_factory.mktemp("simulated"))


@pytest.fixture(scope="module", params=[ONE, TWO], ids=["one arm", "two arms"])
def without_restart(request, tmp_path_factory):
    return report_of("stop", *request.param, "false", tmp_path_factory.mktemp("stopping"))


WORDS = {"starting": "I do not want to start", "update": "I have had enough"}


@pytest.mark.parametrize("where", WORDS)
def test_the_node_survives_and_reports_the_exception(report, where):
    outcome = report[where]
    assert outcome["has_error"], outcome
    assert outcome["states_go_on"], outcome
    assert WORDS[where] in report["log"]


@pytest.mark.parametrize("where", WORDS)
def test_another_controller_moves_the_recovered_robot(report, where):
    outcome = report[where]
    assert outcome["stopped"], outcome
    assert outcome["recovered"] == SUCCEEDED, outcome
    assert outcome["moves"], outcome
    assert outcome["error_gone"], outcome


@pytest.mark.parametrize("where", WORDS)
def test_the_simulation_continues_with_the_robot_at_rest(simulated, where):
    assert all(simulated[where].values()), simulated[where]
    assert WORDS[where] in simulated["log"]


def test_controllers_that_must_not_restart_are_stopped_before_a_recovery(without_restart):
    assert without_restart["moves"] and without_restart["hit"]
    assert without_restart["recovered"] == SUCCEEDED
    outcome = without_restart["after_reflex"]
    assert outcome == {"error_gone": True, "running": False, "rests": True, "moves_when_told": True}


# Several arms wait for a recovery instead.
@pytest.mark.parametrize("without_restart", [ONE], ids=["one arm"], indirect=True)
def test_they_are_stopped_when_the_user_stop_is_released(without_restart):
    assert without_restart["stopped"]
    outcome = without_restart["after_user_stop"]
    assert outcome == {"error_gone": True, "running": False, "rests": True, "moves_when_told": True}
