# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Every launch file of the single-arm examples starts the controller that it is named after.

They are launched with a simulated robot and leave no errors in the log; the short form
launches some of them.
"""

import re
from pathlib import Path
from xml.etree import ElementTree

import pytest
from franka_sim_mujoco.session import Session
from pyfranka.remote import Remote
from ros_client import Controllers, in_session
from tutorial import read
from waiting import wait_for

TOP = Path(__file__).resolve().parent.parent
EXAMPLES = TOP / "catkin_ws/src/franka_example_controllers/launch"
PAGE = read(TOP / "docs/how_to/example_controllers.md")
# The page's commands by their launch files, as words after roslaunch.
COMMANDS = {
    words[2]: words[1:]
    for words in map(str.split, PAGE.block_with("teleop_joint_pd_example_controller.launch").splitlines())
}
# These need two arms: test_two_arm_controllers.
TWO_ARMS = {
    "dual_arm_cartesian_impedance_example_controller.launch",
    "teleop_joint_pd_example_controller.launch",
}
ONE_ARM = sorted({path.name for path in EXAMPLES.glob("*_example_controller.launch")} - TWO_ARMS)
# The other ones differ from these in the controller's name: test_example_controllers.py runs each controller.
IN_SHORT = ("cartesian_impedance", "python_joint_impedance")
ADDRESS = "127.0.52.1"
WAIT = 180.0  # [s] on a busy machine
ROBOTS = ["panda", "fr3"]
AGAIN = pytest.mark.long_form("the same with other controllers or robots")


def launch(command: list[str], robot: str, folder: Path) -> Session:
    given = [f"robot:={robot}", f"robot_ip:={ADDRESS}", "rviz:=false", "rqt:=false"]
    if command[1].startswith("python_"):  # a machine's stall is not an error of the script
        given += ["max_update_time:=30.0", "max_starting_time:=60.0"]
    return Session(*command, *given, log=folder / "launch.log")


def errors(session: Session) -> list[str]:
    marks = ("[ERROR]", "[FATAL]", "Traceback", "process has died")
    return [line for line in session.log.read_text().splitlines() if any(mark in line for mark in marks)]


def launches():
    """Some of the launch files, each with one of the robots; in the long form all with both."""
    for index, name in enumerate(ONE_ARM):
        marks = () if name.removesuffix("_example_controller.launch") in IN_SHORT else AGAIN
        yield pytest.param(name, ROBOTS[index % 2], marks=marks)
        yield pytest.param(name, ROBOTS[1 - index % 2], marks=AGAIN)


def test_the_page_launches_every_example():
    assert set(COMMANDS) == {*ONE_ARM, *TWO_ARMS}


@pytest.mark.parametrize("name", ONE_ARM)
def test_a_launch_file_loads_and_spawns_its_controller(name):
    tree, controller = ElementTree.parse(EXAMPLES / name), name.removesuffix(".launch")
    spawned = [node.get("args") for node in tree.iter("node") if node.get("type") == "spawner"]
    assert spawned == [controller]
    loaded = [each.get("file") for each in tree.iter("rosparam") if each.get("file")]
    files = [EXAMPLES.parent / file.removeprefix("$(find franka_example_controllers)/") for file in loaded]
    assert any(re.search(rf"^{controller}:", file.read_text(), re.M) for file in files)


@pytest.mark.own_process
@pytest.mark.parametrize("name, robot", list(launches()))
def test_a_launched_example_runs(name, robot, tmp_path):
    expected = {name.removesuffix(".launch"), "franka_state_controller"}
    with in_session(launch(COMMANDS[name], robot, tmp_path)) as session:
        controllers, robot = Controllers(), Remote(ADDRESS)
        controllers.wait_for(*expected)
        end = robot.time + 1.0
        wait_for(lambda: robot.time > end, "A second of the robot", WAIT)
        assert expected <= set(controllers.running())
        assert robot.state().errors == {}
    assert errors(session) == []


@pytest.mark.parametrize("robot", ["panda", pytest.param("fr3", marks=AGAIN)])
def test_the_arm_moves_to_its_start_pose(robot, tmp_path):
    command = PAGE.block_with("move_to_start.launch sim:=true").split()[1:]
    with launch(command, robot, tmp_path) as session:
        wait_for(lambda: not session.running(), lambda: f"{session.tail(60)}\nThe end", WAIT)
        assert session.returncode() == 0, session.tail(60)
    assert errors(session) == []
