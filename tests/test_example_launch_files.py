# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Every launch file of the single-arm examples, with a simulated robot: it starts the controller that it is
named after, without warnings or errors in the log.
"""

import time
from pathlib import Path

import pytest
import yaml
from franka_sim_mujoco.session import Session

EXAMPLES = Path(__file__).resolve().parent.parent / "catkin_ws/src/franka_example_controllers/launch"
LAUNCH_FILES = sorted(path.name for path in EXAMPLES.glob("*_example_controller.launch"))
# These need two arms: test_two_arm_controllers.
TWO_ARMS = {
    "dual_arm_cartesian_impedance_example_controller.launch",
    "teleop_joint_pd_example_controller.launch",
}
WAIT = 60.0  # [s] on a busy machine
LIST = ["rosservice", "call", "/controller_manager/list_controllers"]
ROBOTS = ["panda", "fr3"]


def launch(name: str, robot: str, folder: Path) -> Session:
    given = ["sim:=true", f"robot:={robot}", "robot_ip:=127.0.52.1", "rviz:=false", "rqt:=false"]
    if name.startswith("python_"):  # a machine's stall is not an error of the script
        given += ["max_update_time:=1.0", "max_starting_time:=10.0"]
    return Session("franka_example_controllers", name, *given, log=folder / "launch.log")


def log_problems(session: Session) -> list[str]:
    """Warnings and errors in the log."""
    marks = ("[ERROR]", "[WARN]", "[FATAL]", "[ WARN]", "Traceback", "process has died")
    lines = [line for line in session.log.read_text().splitlines() if any(mark in line for mark in marks)]
    return [line for line in lines if "rests on something horizontal" not in line]  # for force


def running(session: Session) -> set[str]:
    answer = session.run(*LIST, check=False)
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
        session.wait_for_master()
        begin = time.monotonic()
        while not expected <= running(session):
            session.check()
            assert time.monotonic() - begin < WAIT, f"{running(session)}\n{session.tail(60)}"
        time.sleep(1.0)  # the controller runs
        assert expected <= running(session), session.tail(60)
    assert log_problems(session) == []


@pytest.mark.parametrize("robot", ROBOTS)
def test_the_arm_moves_to_its_start_pose(robot, tmp_path):
    with launch("move_to_start.launch", robot, tmp_path) as session:
        begin = time.monotonic()
        while session.running():
            assert time.monotonic() - begin < WAIT, session.tail(60)
            time.sleep(0.1)
        assert session.returncode() == 0, session.tail(60)
    assert log_problems(session) == []
