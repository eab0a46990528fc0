# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Every single-arm example controller on franka_control_node and a simulated robot, Panda and FR3."""

import json
from pathlib import Path

import numpy as np
import pytest
from franka_sim_mujoco.session import Session

HERE = Path(__file__).resolve().parent
SOURCE = HERE.parent / "catkin_ws/src"

IDLE, MOVE = 1, 2
FIRST_POSITION = (0.3069, 0.0, 0.4869)  # [m] of a simulated arm's hand
# Minimum motion of the arm while it runs [rad]; None: it only reads, or holds the arm.
CONTROLLERS = {
    "joint_velocity": 0.03,
    "joint_position": 0.02,
    "cartesian_pose": 0.1,
    "cartesian_velocity": 0.05,
    "elbow": 0.1,
    "joint_impedance": 0.05,
    "model": None,
    "force": None,
    "cartesian_impedance": None,
}


@pytest.fixture(scope="module", params=["panda", "fr3"])
def report(request, tmp_path_factory):
    robot, folder = request.param, tmp_path_factory.mktemp("examples")
    parameters = folder / "controllers.yaml"
    config = SOURCE / "franka_example_controllers/config/franka_example_controllers.yaml"
    parameters.write_text(config.read_text().replace("$(arg arm_id)", robot))
    launch = ["franka_control", "franka_control.launch", "sim:=true", f"robot:={robot}"]
    with Session(*launch, "robot_ip:=127.0.7.2", log=folder / "launch.log") as session:
        session.wait_for_master()
        session.run("rosparam", "load", str(parameters))
        load = ["rosrun", "controller_manager", "controller_manager", "load"]
        loaded = session.run(*load, "effort_joint_trajectory_controller", check=False, timeout=90)
        assert "Loaded" in loaded.stdout, f"{loaded}\n{session.tail(60)}"
        command = ["/usr/bin/python3", str(HERE / "example_controllers_client.py"), robot, *CONTROLLERS]
        client = session.run(*command, check=False, timeout=240)
        print(client.stdout, session.tail(80), sep="\n")
        assert client.returncode == 0, f"{client}\n{session.tail(60)}"
        session.check()
        return json.loads(client.stdout.strip().splitlines()[-1])


@pytest.mark.parametrize("name", CONTROLLERS)
def test_runs_and_stops_without_warnings(report, name):
    outcome = report[name]
    assert outcome["loaded"] and outcome["started"] and outcome["stopped"], outcome
    assert outcome["aborts"] == []
    assert outcome["mode_after"] == IDLE
    assert outcome["mode"] == (IDLE if name == "model" else MOVE)
    if CONTROLLERS[name] is None:
        assert outcome["lifted"] < 0.005
    else:
        assert outcome["moved"] > CONTROLLERS[name]


def test_the_launch_file_of_a_python_example_moves_the_robot(tmp_path):
    launch = ["franka_example_controllers", "python_cartesian_circle_example_controller.launch", "sim:=true"]
    launch += ["robot_ip:=127.0.7.3", "rviz:=false", "max_update_time:=1.0", "max_starting_time:=10.0"]
    with Session(*launch, log=tmp_path / "launch.log") as session:
        session.wait_for_master()
        command = ["/usr/bin/python3", str(HERE / "python_example_client.py"), "4.0"]
        client = session.run(*command, check=False, timeout=120)
        assert client.returncode == 0, f"{client}\n{session.tail(60)}"
        session.check()
    positions = np.array(json.loads(client.stdout))
    radius = 0.05  # [m] python_controllers.yaml
    x, y, z = positions.T
    # The circle through the points, by least squares: the first states of the motion may have been missed.
    coefficients, *_ = np.linalg.lstsq(np.c_[2 * y, 2 * z, np.ones_like(y)], y**2 + z**2, rcond=None)
    centre_y, centre_z = coefficients[:2]
    np.testing.assert_allclose(np.hypot(y - centre_y, z - centre_z), radius, atol=1e-4)
    np.testing.assert_allclose(x, x[0], atol=1e-4)
    # It starts at the arm's first position, and moves around a point beside it.
    np.testing.assert_allclose([x[0], centre_y - radius, centre_z], FIRST_POSITION, atol=2e-3)
    assert np.ptp(np.unwrap(np.arctan2(z - centre_z, y - centre_y))) > 0.85 * np.pi
