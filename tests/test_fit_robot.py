# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""franka_info record and fit_robot find the figures of simulated robots of the profile recorded."""

import os
import subprocess
import sys
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader

import numpy as np
import pyfranka
import pyfranka.sim
import pytest
import yaml
from fci_session import simulated
from tutorial import TOP, read
from waiting import wait_for

PAGE = read(TOP / "docs/sim_to_real.md")
HIDDEN = {
    "friction": {
        "amplitude": [0.8, 1.1, 0.5, 0.9, 0.7, 0.5, 0.4],
        "slope": [20, 25, 30, 20, 30, 25, 30],
        "offset": [0, 0, 0, 0, 0, 0, 0],
        "viscous": [0.3, 0.2, 0.25, 0.3, 0.2, 0.15, 0.1],
        "coulomb": [0.5, 0.6, 0.7, 0.8, 0.4, 0.2, 0.15],
        "damping": [0.3, 0.1, 0.2, 0.4, 0.25, 0.2, 0.1],
    },
    "torque_offset": [0.2, -0.3, 0.1, 0.25, -0.1, 0.05, -0.04],
    "payload": {"mass": 0.35, "centre": [0.02, -0.01, 0.08]},
}


def call(*command, **options):
    return subprocess.run(list(map(str, command)), text=True, capture_output=True, timeout=600, **options)


def type_in(folder, block, address=""):
    """Types a block of the page, with another robot's address."""
    command = PAGE.block_with(block).replace("172.16.0.2", address)
    result = call("bash", "-ec", command, cwd=folder)
    assert result.returncode == 0, result.stderr


def fit(recording, robot):
    return call("rosrun", "franka_description", "fit_robot", recording, robot)


def friction_at(robot, speed):
    """Of the link side, joints 1 to 7 [Nm]."""
    amplitude, slope, viscous = (
        np.array(robot["friction"][key]) for key in ("amplitude", "slope", "viscous")
    )
    return amplitude * (1 / (1 + np.exp(-slope * speed)) - 0.5) + viscous * speed


def motor_friction_at(robot, speed):
    """Of the motor side, joints 1 to 7 [Nm]."""
    coulomb, damping = (np.array(robot["friction"][key]) for key in ("coulomb", "damping"))
    return coulomb * np.sign(speed) + damping * speed


def fit_module():
    """The script, for its functions."""
    found = call("rospack", "find", "franka_description").stdout.strip()
    loader = SourceFileLoader("fit_robot", f"{found}/scripts/fit_robot")
    module = module_from_spec(spec_from_loader("fit_robot", loader))
    sys.modules["fit_robot"] = module  # for its dataclasses
    loader.exec_module(module)
    return module


LONG = [(robot, seed) for robot in ("panda", "fr3") for seed in range(1, 7)]


@pytest.mark.parametrize("robot, seed", LONG if os.environ.get("FRANKA_TEST_LONG") else [("fr3", 5)])
def test_the_fit_finds_hidden_friction_and_payload(robot, seed, tmp_path):
    hidden, fitted = tmp_path / "hidden.yaml", tmp_path / "my_panda.yaml"
    hidden.write_text(yaml.safe_dump(HIDDEN))
    realism = f"recorded,seed={seed},file={hidden}"
    with simulated(robot, "lockstep", realism=realism) as sim:
        type_in(tmp_path, "franka_info record", sim.address)
    type_in(tmp_path, "fit_robot")
    found, shown = yaml.safe_load(fitted.read_text()), yaml.safe_load(PAGE.block_with("payload:"))
    print(found)
    assert found.keys() == shown.keys() and found["friction"].keys() >= shown["friction"].keys()
    for speed in (0.1, 0.3, -0.3):
        assert friction_at(found, speed) == pytest.approx(friction_at(HIDDEN, speed), rel=0.1)
        assert motor_friction_at(found, speed) == pytest.approx(motor_friction_at(HIDDEN, speed), rel=0.1)
    assert found["friction"]["coulomb"] == pytest.approx(HIDDEN["friction"]["coulomb"], rel=0.1)
    assert found["payload"]["mass"] == pytest.approx(HIDDEN["payload"]["mass"], abs=0.02)
    assert found["payload"]["centre"] == pytest.approx(HIDDEN["payload"]["centre"], abs=0.02)
    # What the links' errors cannot explain appears as offsets.
    assert found["torque_offset"] == pytest.approx(HIDDEN["torque_offset"], abs=0.1)
    # The simulation reads the result.
    with simulated(robot, "lockstep", realism=f"real,file={fitted}") as sim:
        assert sim.remote.state().mode == "Idle"


@pytest.mark.parametrize("robot", ["panda", "fr3"])
def test_the_kinematics_of_the_fit_are_those_of_the_robots_model(robot):
    kind = pyfranka.sim.KINDS[robot]
    with pyfranka.sim.Simulation(robots=[kind()], seed=3) as sim:
        sim.reset(q="random")
        arm = sim[robot]
        for k, pose in enumerate(fit_module().frames_of(arm.state.q[None])):
            frame = list(pyfranka.Frame.__members__.values())[k]
            assert pose[0] == pytest.approx(arm.model.pose(frame, arm.state), abs=1e-9), frame


def test_recordings_that_cannot_be_used_are_refused(tmp_path):
    recording = tmp_path / "recording.csv"
    missing = fit(recording, tmp_path / "robot.yaml")
    assert missing.returncode == 1 and str(recording) in missing.stderr
    recording.write_text("time,q1\n0,1\n20,1\n")
    wrong = fit(recording, tmp_path / "robot.yaml")
    assert wrong.returncode == 1 and "is not a recording" in wrong.stderr
    assert not (tmp_path / "robot.yaml").exists()


def test_without_scipy_it_says_what_to_install(tmp_path):
    """An image without plots has no SciPy."""
    (tmp_path / "scipy").mkdir()
    (tmp_path / "scipy" / "__init__.py").write_text("raise ImportError('no scipy')\n")
    program = subprocess.check_output(["rospack", "find", "franka_description"], text=True).strip()
    command = [f"{program}/scripts/fit_robot", "none.csv", tmp_path / "none.yaml"]
    environment = os.environ | {"PYTHONPATH": f"{tmp_path}:{os.environ.get('PYTHONPATH', '')}"}
    done = subprocess.run(command, text=True, capture_output=True, env=environment, timeout=60)
    assert (done.returncode, done.stderr) == (
        1,
        "fit_robot: it needs the Python package scipy. Install python3-scipy.\n",
    )


def test_a_recording_at_rest_is_refused(tmp_path):
    recording = tmp_path / "recording.csv"
    with simulated("panda", "5") as sim:  # time passes five times as fast; states may be lost
        assert call("franka_info", "record", sim.address, recording, 10).returncode == 0
    result = fit(recording, tmp_path / "robot.yaml")
    assert result.returncode == 1 and "hardly move" in result.stderr
    samples = recording.read_text().splitlines(keepends=True)
    recording.write_text("".join([samples[0], *samples[1::10]]))
    result = fit(recording, tmp_path / "robot.yaml")
    assert result.returncode == 1 and "s after the one before it" in result.stderr


def test_a_recording_that_the_user_stop_ends_is_kept(tmp_path):
    recording = tmp_path / "recording.csv"
    with simulated("panda", "patient") as sim:
        command = ["franka_info", "record", sim.address, str(recording), "30", "--move"]
        process = subprocess.Popen(command, text=True, stderr=subprocess.PIPE)
        wait_for(lambda: sim.remote.state().mode == "Move" or process.poll() is not None, "The motion")
        end = sim.remote.time + 0.5
        wait_for(lambda: sim.remote.time > end, "Half a second of it")
        sim.remote.set_user_stop(True)
        _, printed = process.communicate(timeout=60)
    assert process.returncode != 0 and str(recording) in printed and "User" in printed
    rows = recording.read_text().splitlines()
    assert len(rows) > 10 and len({row.count(",") for row in rows}) == 1


def test_a_file_that_cannot_be_written_is_refused_before_the_robot_moves():
    with simulated("panda", "lockstep") as sim:
        before = sim.remote.state_hash()
        result = call("franka_info", "record", sim.address, "/nowhere/recording.csv", 10, "--move")
        assert result.returncode == 1 and "/nowhere/recording.csv cannot be written" in result.stderr
        assert sim.remote.state_hash() == before


@pytest.mark.parametrize(
    "arguments, status, sentence",
    [
        (["record", "127.0.60.4"], 3, "FILE is required"),
        (["record", "127.0.60.4", "x.csv", "5"], 3, "the time must be 10 to 600 s"),
        (["record", "127.0.60.4", "x.csv"], 2, "cannot be used"),
        (["record", "--help"], 0, "Records the robot's signals"),
    ],
)
def test_franka_info_record_checks_its_arguments(arguments, status, sentence):
    result = call("franka_info", *arguments)
    assert result.returncode == status
    assert sentence in result.stdout + result.stderr
