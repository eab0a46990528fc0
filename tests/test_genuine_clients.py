# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Franka's own client libraries, from PyPI, against the simulated robot in lock-step.

panda-python bundles libfranka 0.9.2 (version 5), pylibfranka libfranka 0.21.3 (version 10). Each has its own
environment without Debian's packages (decision 33), which ./franka test fetches.
"""

import json
import subprocess
from pathlib import Path

import pytest
from genuine_clients import client_python
from pyfranka.franka_sim import FrankaSim

CLIENTS = Path(__file__).resolve().parent / "support" / "genuine"
FLOOR = """<mujoco><worldbody>
  <light pos="0 0 3"/>
  <geom name="block" type="box" size="0.3 0.3 0.05" pos="0.4 0 {height}"/>
</worldbody></mujoco>"""


def run_session(client: str, script: str, address: str) -> dict:
    result = subprocess.run(
        [client_python(client), CLIENTS / script, address], capture_output=True, text=True, timeout=600
    )
    assert result.returncode == 0, result.stdout + result.stderr
    return json.loads(result.stdout.splitlines()[-1])


@pytest.fixture(scope="module")
def world(tmp_path_factory) -> str:
    """A block below the hand."""
    world = tmp_path_factory.mktemp("world") / "block.xml"
    world.write_text(FLOOR.format(height=0.3))
    return str(world)


@pytest.fixture(scope="module")
def panda(world):
    with FrankaSim("panda", world=world) as sim:
        return run_session("panda", "panda_client.py", sim.robot.address)


@pytest.fixture(scope="module")
def fr3(world):
    with FrankaSim("fr3", world=world) as sim:
        return run_session("pylibfranka", "pylibfranka_client.py", sim.robot.address)


@pytest.fixture(scope="module")
def free_panda():
    """A Panda in an empty world."""
    with FrankaSim("panda") as sim:
        yield sim.robot


@pytest.fixture
def robot(free_panda):
    """That Panda at its start position."""
    free_panda.remote.reset()
    return free_panda


def run_panda(script: str, robot) -> str:
    """What a program with panda-python prints."""
    command = [client_python("panda"), "-c", script, robot.address]
    done = subprocess.run(command, capture_output=True, text=True, timeout=200)
    assert done.returncode == 0, done.stderr
    return done.stdout


def check_motions(seen, names):
    assert list(seen["motions"]) == names
    for name, motion in seen["motions"].items():
        assert motion["outcome"] == "ok", (name, motion)
        assert motion["mode"] in ("Idle", "kIdle"), (name, motion)
        assert motion["cycles"] >= 1000 * motion["robot seconds"] - 5, (name, motion)


def check_block(seen: dict, reflex: str):
    """Checks a collision at 0.1 m/s: the client's report, and the motion away from the block."""
    assert seen["thresholds"] == "ok"
    assert "motion aborted by reflex!" in seen["contact"], seen["contact"]
    assert '"cartesian_reflex"' in seen["contact"] or '"joint_reflex"' in seen["contact"], seen["contact"]
    assert seen["mode after contact"] == reflex
    assert seen["recovery after contact"] == "ok"
    assert seen["retreat"] == "ok"
    assert seen["height after retreat"] - seen["height"] == pytest.approx(0.05, abs=0.005)


def test_panda_connects(panda):
    assert panda["version"] == 5
    assert panda["mode"] == "kIdle"
    assert panda["m_ee"] == pytest.approx(0.76, abs=1e-6)
    # The served model library agrees with the robot's load.
    assert panda["gravity_error"] < 1e-6


def test_panda_setters(panda):
    setters = dict(panda["setters"])
    assert setters.pop("m_load") == 0.5
    assert setters.pop("F_T_EE") == pytest.approx(0.1034 + 0.05, abs=1e-9)
    assert "Set Joint Impedance command rejected: invalid argument!" in setters.pop("bad impedance")
    assert set(setters.values()) == {"ok"}, setters


def test_panda_moves(panda):
    check_motions(panda, ["torque", "joint position", "joint velocity", "pose", "limited"])
    assert panda["motions"]["joint position"]["q"][3] == pytest.approx(-2.35619 + 0.2, abs=1e-3)
    assert panda["motions"]["joint velocity"]["q"][4] == pytest.approx(0.1, abs=1e-3)
    assert panda["motions"]["limited"]["q"][3] == pytest.approx(-2.35619, abs=2e-3)


def test_panda_reflex_and_recovery(panda):
    assert "motion aborted by reflex!" in panda["leap"]
    assert '["joint_position_motion_generator_start_pose_invalid"]' in panda["leap"]
    assert panda["mode after leap"] == "kReflex"
    assert 'not possible in the current mode ("Reflex")' in panda["motion in reflex"]
    assert panda["recovery"] == "ok"
    assert panda["mode after recovery"] == "kIdle"
    assert "a mistake of the program" in panda["callback throws"]
    assert panda["second client"] != "ok"


def test_panda_hits_a_block(panda):
    check_block(panda, "kReflex")


def test_panda_gripper(panda):
    assert panda["gripper"] == {
        "version": 3,
        "homing": True,
        "move": True,
        "width": pytest.approx(0.02, abs=1e-3),
        "empty grasp": False,
        "stop": True,
    }


def test_fr3_connects(fr3):
    assert fr3["mode"] == "Idle"
    assert fr3["m_ee"] == pytest.approx(0.73, abs=1e-6)
    # The client's model is pinocchio on the URDF that the robot served; the state is single precision.
    assert fr3["gravity_error"] < 1e-4


def test_fr3_setters(fr3):
    setters = dict(fr3["setters"])
    assert setters.pop("m_load") == 0.5
    # Single precision.
    assert setters.pop("F_T_EE") == pytest.approx(0.1034 + 0.05, abs=1e-6)
    assert setters.pop("EE_T_K") == pytest.approx(0.05, abs=1e-6)
    assert "invalid argument!" in setters.pop("bad impedance")
    assert "invalid argument!" in setters.pop("bad cartesian impedance")
    assert set(setters.values()) == {"ok"}, setters


def test_fr3_moves(fr3):
    check_motions(fr3, ["torque", "joint position", "pose"])
    assert fr3["motions"]["joint position"]["q"][3] == pytest.approx(-2.35619 + 0.2, abs=1e-3)


def test_fr3_reflex_and_recovery(fr3):
    assert "motion aborted by reflex!" in fr3["leap"], fr3["leap"]
    assert '["joint_position_motion_generator_start_pose_invalid"]' in fr3["leap"], fr3["leap"]
    assert fr3["mode after leap"] == "Reflex"
    assert fr3["recovery"] == "ok"
    assert fr3["mode after recovery"] == "Idle"
    assert fr3["again"] == "ok"
    assert fr3["second client"] != "ok"


def test_fr3_hits_a_block(fr3):
    check_block(fr3, "Reflex")


def test_fr3_gripper(fr3):
    assert fr3["gripper"] == {
        "homing": True,
        "move": True,
        "width": pytest.approx(0.02, abs=1e-3),
        "empty grasp": False,
        "is grasped": False,
        "stop": True,
    }


def test_versions_are_distinguished(robot):
    command = [client_python("pylibfranka"), CLIENTS / "pylibfranka_client.py", robot.address]
    result = subprocess.run(command, capture_output=True, text=True, timeout=200)
    assert "server version: 5, library version: 10" in result.stderr


def test_user_stop_aborts_the_motion(robot):
    script = """
import sys
from panda_py import libfranka
robot = libfranka.Robot(sys.argv[1])
first = [True]
def callback(state, period):
    if first[0]:
        first[0] = False
        print("moving", flush=True)
    return libfranka.Torques([0.0] * 7)
try:
    robot.control(callback, False)
except Exception as error:
    print(error, flush=True)
print(robot.read_once().robot_mode, flush=True)
try:
    robot.control(callback, False)
except Exception as error:
    print(error, flush=True)
"""
    command = [client_python("panda"), "-c", script, robot.address]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as client:
        try:
            assert client.stdout.readline().strip() == "moving"
            robot.remote.set_user_stop(True)
            output, _ = client.communicate(timeout=200)
        finally:
            client.kill()
            robot.remote.set_user_stop(False)
    assert "libfranka: Move command aborted: User Stop pressed!" in output
    assert "kUserStopped" in output
    assert 'not possible in the current mode ("User stopped")' in output


def test_a_new_arm_makes_a_very_small_motion(robot):
    """Clients may divide by the remaining distance; a real arm never reaches its target bit for bit."""
    script = """
import sys
import panda_py
panda = panda_py.Panda(sys.argv[1])
print(panda.move_to_start(), panda.move_to_start())
"""
    for _ in range(3):
        robot.remote.reset()
        assert run_panda(script, robot).split()[-2:] == ["True", "True"]
