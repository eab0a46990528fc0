# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""roslaunch of `./franka shell` ends, and ends all that it has started."""

import os
import signal
import socket
import subprocess
from pathlib import Path

from franka_sim_mujoco.session import free_port

# The process monitor looks for ended processes every 0.1 s: unless it is late, some are started after that.
NODES = 60
SLEEPER = """<node name="sleeper_{}" pkg="rosout" type="rosout" launch-prefix="bash -c 'exec sleep 300'"/>"""


def commands_with(word: str) -> list[str]:
    """Command lines of all processes that contain a word."""
    found = []
    for file in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            command = file.read_bytes().replace(b"\0", b" ").decode(errors="replace")
        except OSError:  # it has ended
            continue
        if word in command:
            found.append(command)
    return found


def launch_until_it_ends(tmp_path: Path, *words: str) -> str:
    """The output of a launch that fails and leaves no process."""
    port = str(free_port())
    environment = {
        **os.environ,
        "ROS_MASTER_URI": f"http://localhost:{port}",
        "ROS_LOG_DIR": str(tmp_path / "log"),
    }
    with open(tmp_path / "output", "w") as output:  # a pipe would wait for processes that are left
        done = subprocess.run(
            ["roslaunch", "-p", port, *words],
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=output,
            timeout=120,
        )
    text = (tmp_path / "output").read_text()
    assert done.returncode == 1, text
    left = commands_with(str(tmp_path)) + commands_with(f"rosmaster --core -p {port}")
    assert not left
    return text


def test_all_nodes_end_if_a_required_one_fails_during_the_launch(tmp_path):
    sleepers = "".join(SLEEPER.format(number) for number in range(NODES))
    failing = '<node name="failing" pkg="rosout" type="rosout" required="true" launch-prefix="false"/>'
    launch = tmp_path / "failing.launch"
    launch.write_text(f"<launch>{failing}{sleepers}</launch>")
    assert "REQUIRED process [failing-2] has died" in launch_until_it_ends(tmp_path, str(launch))


def test_a_launch_ends_with_the_reason_if_its_robot_is_not_spawned(tmp_path):
    words = ["franka_sim_mujoco", "robot.launch", "robot:=fr3", "gazebo:=false"]
    text = launch_until_it_ends(tmp_path, *words, "initial_joint_positions:=-J fr3_joint1 far")
    assert "'far' of fr3_joint1 is not a number" in text


def test_ctrl_c_ends_it_while_it_looks_for_the_master(tmp_path):
    with socket.create_server(("127.0.0.1", 0)) as silent_master:
        environment = {
            **os.environ,
            "ROS_MASTER_URI": f"http://127.0.0.1:{silent_master.getsockname()[1]}",
            "ROS_LOG_DIR": str(tmp_path / "log"),
        }
        launch = tmp_path / "empty.launch"
        launch.write_text("<launch/>")
        process = subprocess.Popen(["roslaunch", str(launch)], env=environment, stdout=subprocess.DEVNULL)
        try:
            silent_master.settimeout(60)
            connection, _ = silent_master.accept()
            with connection:
                connection.recv(1)  # it waits for the answer now
                process.send_signal(signal.SIGINT)
                assert process.wait(30) == 128 + signal.SIGINT
        finally:
            process.kill()
            process.wait()
