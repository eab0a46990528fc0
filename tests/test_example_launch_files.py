# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Every launch file of the single-arm examples, with a simulated robot: it starts the controller that it is
named after, without errors in the log.
"""

from pathlib import Path

import pytest
import yaml
from franka_sim_mujoco.session import Session
from pyfranka.remote import Remote
from waiting import wait_for

EXAMPLES = Path(__file__).resolve().parent.parent / "catkin_ws/src/franka_example_controllers/launch"
LAUNCH_FILES = sorted(path.name for path in EXAMPLES.glob("*_example_controller.launch"))
# These need two arms: test_two_arm_controllers.
TWO_ARMS = {
    "dual_arm_cartesian_impedance_example_controller.launch",
    "teleop_joint_pd_example_controller.launch",
}
ADDRESS = "127.0.52.1"
WAIT = 180.0  # [s] on a busy machine
LIST = ["rosservice", "call", "/controller_manager/list_controllers"]
ROBOTS = ["panda", "fr3"]


def launch(name: str, robot: str, folder: Path) -> Session:
    given = ["sim:=true", f"robot:={robot}", f"robot_ip:={ADDRESS}", "rviz:=false", "rqt:=false"]
    if name.startswith("python_"):  # a machine's stall is not an error of the script
        given += ["max_update_time:=30.0", "max_starting_time:=60.0"]
    return Session("franka_example_controllers", name, *given, log=folder / "launch.log")


def errors(session: Session) -> list[str]:
    marks = ("[ERROR]", "[FATAL]", "Traceback", "process has died")
    return [line for line in session.log.read_text().splitlines() if any(mark in line for mark in marks)]


def running(session: Session) -> set[str]:
    session.check()
    answer = session.run(*LIST, timeout=WAIT, check=False)
    listed = yaml.safe_load(answer.stdout)["controller"] if answer.returncode == 0 else []
    return {controller["name"] for controller in listed if controller["state"] == "running"}


def launches():
    """Each launch file with one of the robots; with the other one in the long form."""
    again = pytest.mark.long_form("the same with the other robot")
    for index, name in enumerate(sorted(set(LAUNCH_FILES) - TWO_ARMS)):
        yield name, ROBOTS[index % 2]
        yield pytest.param(name, ROBOTS[1 - index % 2], marks=again)


@pytest.mark.parametrize("name, robot", launches())
def test_a_launched_example_runs(name, robot, tmp_path):
    expected = {name.removesuffix(".launch"), "franka_state_controller"}
    with launch(name, robot, tmp_path) as session:
        session.wait_for_master(WAIT)
        wait_for(lambda: expected <= running(session), lambda: f"{session.tail(60)}\n{expected}", WAIT)
        robot = Remote(ADDRESS)
        end = robot.time() + 1.0
        wait_for(lambda: robot.time() > end, "A second of the robot", WAIT)
        assert expected <= running(session), session.tail(60)
        assert robot.state().errors == {}
    assert errors(session) == []


@pytest.mark.parametrize("robot", ROBOTS)
def test_the_arm_moves_to_its_start_pose(robot, tmp_path):
    with launch("move_to_start.launch", robot, tmp_path) as session:
        wait_for(lambda: not session.running(), lambda: f"{session.tail(60)}\nThe end", WAIT)
        assert session.returncode() == 0, session.tail(60)
    assert errors(session) == []
