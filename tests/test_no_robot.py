# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""roslaunch with an unreachable robot reports how to start a simulated one, and fails."""

import os
import signal
import subprocess
from concurrent.futures import ThreadPoolExecutor

import pytest
from franka_sim_mujoco.session import free_port

NOBODY = "127.0.32.20"
IPS = f"{{panda_1/robot_ip: {NOBODY}, panda_2/robot_ip: {NOBODY}}}"
LAUNCHES = {
    "franka_control/franka_control.launch": [f"robot_ip:={NOBODY}"],
    "franka_control/franka_combined_control.launch": [f"robot_ips:={IPS}"],
    "franka_visualization/franka_visualization.launch": [f"robot_ip:={NOBODY}", "rviz:=false"],
}


def launched(name: str) -> tuple[int | None, str]:
    """Status and output of roslaunch, which ends by itself."""
    port = str(free_port())
    environment = dict(os.environ, ROS_MASTER_URI=f"http://localhost:{port}")
    environment.setdefault("ROS_HOSTNAME", "localhost")
    process = subprocess.Popen(
        ["roslaunch", "-p", port, *name.split("/"), *LAUNCHES[name]],
        env=environment,
        text=True,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    )
    try:
        output, _ = process.communicate(timeout=120)
    except subprocess.TimeoutExpired:
        process.send_signal(signal.SIGINT)  # it ends its nodes
        output, _ = process.communicate()
        return None, output
    return process.returncode, output


@pytest.fixture(scope="module")
def results():
    with ThreadPoolExecutor(2) as pool:
        return dict(zip(LAUNCHES, pool.map(launched, LAUNCHES)))


@pytest.mark.parametrize("name", LAUNCHES)
def test_missing_robot_is_reported_with_the_command_to_start(results, name):
    status, output = results[name]
    assert status == 1, output
    assert NOBODY in output
    assert "franka_sim --robot" in output
    assert name.startswith("franka_visualization/") or "sim:=true" in output
