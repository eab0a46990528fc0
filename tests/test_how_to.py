# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The pages of docs/how_to: their programs without ROS work in simulation."""

import re
import subprocess
import sys
import xml.etree.ElementTree as ET
from pathlib import Path

import page_commands
import page_output
import pytest
import yaml
from fci_session import simulated
from tutorial import read

TOP = Path(__file__).resolve().parent.parent
HOW_TO = TOP / "docs/how_to"


def page(name: str) -> str:
    return (HOW_TO / f"{name}.md").read_text(encoding="utf-8")


def blocks(name: str, language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", page(name), re.S | re.M)


def test_every_service_type_has_a_call():
    """All types of franka_sim_mujoco and franka_msgs; SpawnRobot by the program that calls it."""
    text = page("services")
    types = [
        file.stem
        for package in ("franka_sim_mujoco", "franka_msgs")
        for file in (TOP / "catkin_ws/src" / package / "srv").glob("*.srv")
    ]
    assert len(types) >= 30
    assert not [kind for kind in types if not re.search(rf"\b{kind}\b", text)]
    called = {words[2].rsplit("/", 1)[-1] for words in service_calls()}
    tables = set(re.findall(r"`([a-zA-Z_/]+)`", "\n".join(re.findall(r"^\| (`.+?) \|", text, re.M))))
    missing = {name.rsplit("/", 1)[-1] for name in tables} - called
    assert missing == {"spawn_robot"}


def service_calls() -> list[list[str]]:
    return [
        words
        for words in page_commands.commands_of(HOW_TO / "services.md")
        if words[:2] == ["rosservice", "call"]
    ]


def test_recovery_without_ros_runs():
    (program,) = [text for text in blocks("recovery", "python") if "rospy" not in text]
    with simulated("panda", "lockstep") as robot:
        robot.remote.push("panda_link4", (0, 400, 0), ticks=50)
        state = robot.remote.wait(lambda now: now.mode == "Reflex")
        run(program.replace("127.0.0.1", robot.address), Path.cwd())
        assert state.mode == "Reflex" and robot.remote.state().mode == "Idle"


def run(program: str, folder: Path) -> str:
    result = subprocess.run(
        [sys.executable, "-c", program], cwd=folder, text=True, capture_output=True, timeout=120, check=False
    )
    assert result.returncode == 0, result.stderr
    return result.stdout


@pytest.mark.parametrize("name", ["two_arms", "recording"])
def test_simulations_run(name, tmp_path):
    (program,) = blocks(name, "python")
    run(program, tmp_path)
    if name == "recording":
        table = (tmp_path / "run.csv").read_text().splitlines()
        assert len(table) == 800 and len(table[0].split(",")) == 15


def test_control_unit_uses_the_own_tool(tmp_path):
    description = tmp_path / "panda_with_rod.urdf.xacro"
    description.write_text(blocks("own_tool", "xml")[0])
    commands = page_commands.commands_of(HOW_TO / "own_tool.md")
    (command,) = [words for words in commands if words[:3] == ["rosrun", "xacro", "xacro"]]
    subprocess.run(command, cwd=tmp_path, check=True, timeout=60)
    (example,) = page_output.examples("how_to/own_tool.md")
    example.check(run(example.code, tmp_path))


def test_the_rate_of_states_can_be_set(tmp_path):
    """The line of the page, behind the line that includes a robot."""
    launch, line = tmp_path / "faster.launch", read(TOP / "docs/how_to/recording.md").block_with("<param")
    for package, name in (("franka_control", "franka_control"), ("franka_gazebo", "panda")):
        include = f'<include file="$(find {package})/launch/{name}.launch" pass_all_args="true"/>'
        arg = '<arg name="robot_ip" value="127.0.0.1"/>'
        text = f"<launch>{arg}{include}{line}</launch>"
        launch.write_text(text)
        result = subprocess.run(
            ["roslaunch", "--dump-params", str(launch)], text=True, capture_output=True, timeout=60
        )
        assert yaml.safe_load(result.stdout)["/franka_state_controller/publish_rate"] == 1000, result.stderr


def test_launch_file_for_two_arms_gives_known_arguments():
    tree = ET.fromstring(blocks("two_arms", "xml")[0])
    includes = list(tree.iter("include"))
    assert len(includes) == 2
    for include in includes:
        package, rest = re.fullmatch(r"\$\(find (\w+)\)/(.+)", include.get("file")).groups()
        known = page_commands.launch_arguments(page_commands.folder_of(package) / rest)
        assert {arg.get("name") for arg in include.iter("arg")} <= known
