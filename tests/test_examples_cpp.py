# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The programs in examples/cpp build against the workspace's libfranka, run and say what is true.

The short form runs each with one of the robots, the long form with both.
"""

import os
import re
import subprocess
from pathlib import Path

import numpy
import pytest
from overlay import compiler_cache
from pyfranka.franka_sim import FrankaSim
from pyfranka.sim import KINDS

TOP = Path(__file__).resolve().parents[1]
SOURCE = TOP / "examples" / "cpp"
PROGRAMS = {path.stem for path in SOURCE.glob("*.cpp")}
READY = [0, -0.7854, 0, -2.3562, 0, 1.5708, 0.7854]
LIMIT = 300  # [s] of one program
TABLE = """<mujoco><worldbody>
  <geom name="table" type="box" pos="0.4 0 0.15" size="0.2 0.2 0.15"/>
</worldbody></mujoco>"""
# A pillar below the hand of an arm in the start pose, and a cube of 40 mm to be put on it.
PILLAR = """<mujoco><worldbody>
  <geom name="pillar" type="box" pos="0.307 0 0.23" size="0.02 0.02 0.23"/>
  <body name="cube" pos="1 1 0.02"><freejoint/>
    <geom type="box" size="0.02 0.02 0.02" mass="0.1" friction="1 0.005 0.0001" condim="4"/></body>
</worldbody></mujoco>"""


@pytest.fixture(scope="module")
def programs(tmp_path_factory):
    """The folder of the built programs."""
    build = tmp_path_factory.mktemp("cpp")
    for command in (["cmake", "-S", SOURCE, "-B", build], ["make", "-C", build, "-j2"]):
        environment = {**os.environ, **compiler_cache(build)}
        done = subprocess.run(command, capture_output=True, text=True, env=environment)
        assert done.returncode == 0, done.stdout + done.stderr
        assert "warning" not in done.stderr, done.stderr
    return build


AGAIN = pytest.mark.long_form("the same with the other robot")
with_panda = pytest.mark.parametrize("kind", ["panda", pytest.param("fr3", marks=AGAIN)])
with_fr3 = pytest.mark.parametrize("kind", ["fr3", pytest.param("panda", marks=AGAIN)])


class Program:
    """A running example. Iterates over its lines."""

    def __init__(self, path, address):
        self._process = subprocess.Popen(
            [path, address],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            # They print with printf and choose no locale: a decimal comma comes from the long form only.
            env={**os.environ, "FRANKA_REALTIME": "ignore", "LC_NUMERIC": "C"},
        )

    def line(self):
        return self._process.stdout.readline().strip()

    def end(self):
        """The lines that are left. The program has succeeded."""
        output, errors = self._process.communicate(timeout=LIMIT)
        assert self._process.returncode == 0, output + errors
        return output.splitlines()


@pytest.fixture
def run(programs, kind):
    def example(name):
        with FrankaSim(kind) as sim:
            return Program(programs / name, sim.robot.address).end()

    return example


def numbers(lines):
    return [float(word) for line in lines for word in re.findall(r"-?\d+\.?\d*", line)]


@with_panda
def test_print_state(run):
    protocol, states, joints, _ = run("print_state")
    assert numbers([protocol])[0] in (5, 10)
    assert states == "states 1000"
    assert numbers([joints]) == pytest.approx(READY, abs=1e-3)


@with_fr3
def test_joint_positions(run):
    pairs = numpy.reshape(numbers(run("joint_positions")), (7, 2))
    assert pairs[:, 0] == pytest.approx(range(1, 8))
    assert pairs[:, 1] == pytest.approx(numpy.array(READY) + 0.2, abs=2e-3)


@with_panda
def test_joint_velocities(run):
    fastest, moved = numbers(run("joint_velocities"))
    assert fastest == pytest.approx(0.4, rel=0.02)
    assert moved == pytest.approx(0.0, abs=1e-3)


@with_fr3
def test_cartesian_pose(run):
    assert numbers(run("cartesian_pose")) == pytest.approx([2 * 0.08], rel=0.01)


@with_panda
def test_cartesian_velocities(run):
    down, back = numbers(run("cartesian_velocities"))
    assert down == pytest.approx(0.1, rel=0.01)
    assert back == pytest.approx(0.0, abs=1e-3)


@with_fr3
def test_elbow(run):
    elbow, hand = numbers(run("elbow"))
    assert elbow == pytest.approx(0.25, rel=0.02)
    assert hand < 2e-3


@with_panda
def test_joint_impedance(run):
    error, left = numbers(run("joint_impedance"))
    assert 0.0 < error < 0.08
    assert abs(left) < 5e-3


@with_fr3
def test_torque_with_motion(run):
    (error,) = numbers(run("torque_with_motion"))
    assert error < 5e-3


@with_panda
def test_own_loop(run):
    assert numbers(run("own_loop")) == pytest.approx([1, 0.3], abs=1e-3)


@with_fr3
def test_print_model(run):
    lines = run("print_model")
    frames = numpy.reshape(numbers(lines[:10]), (10, 4))
    assert frames[0] == pytest.approx([0, 0, 0, 0.333])
    assert frames[9][1:] == pytest.approx(frames[8][1:]), "without a stiffness frame of its own"
    gravity = numbers(lines[11:])
    assert gravity[0] == pytest.approx(0.0, abs=1e-3)
    assert 10 < max(map(abs, gravity)) < 40


@with_panda
def test_error_recovery(run):
    text = "\n".join(run("error_recovery"))
    assert "joint_motion_generator_velocity_discontinuity" in text
    assert "reflex: 1\nidle: 1\nmoves again" in text


def test_asynchronous_targets(programs):
    with FrankaSim("fr3") as sim:
        lines = Program(programs / "asynchronous_targets", sim.robot.address).end()
    assert [line.split()[-1] for line in lines] == ["reached"] * 3


@with_fr3
def test_cartesian_impedance(programs, kind):
    with FrankaSim(KINDS[kind](realism="ideal")) as sim:
        sim.robot.remote.push(f"{kind}_hand", [0, 10, 0], ticks=1000000)  # longer than the program takes
        program = Program(programs / "cartesian_impedance", sim.robot.address)
        assert "push the hand" in program.line()
        (yielded,) = numbers(program.end())
    assert yielded == pytest.approx(10 / 200, rel=0.05), "of the spring, and a small overshoot"


@with_panda
def test_force_control(programs, kind, tmp_path):
    (tmp_path / "table.xml").write_text(TABLE)
    with FrankaSim(kind, world=tmp_path / "table.xml") as sim:
        (pressed,) = numbers(Program(programs / "force_control", sim.robot.address).end())
        touching = sim.robot.remote.body_position(f"{kind}_hand")
    assert pressed == pytest.approx(10, rel=0.03)
    assert 0.3 < touching[2] < 0.5, "the hand is above the table"


@pytest.mark.parametrize("kind, something", [("panda", True), ("fr3", False)])
def test_grasp(programs, kind, tmp_path, something):
    (tmp_path / "pillar.xml").write_text(PILLAR)
    with FrankaSim(KINDS[kind](), world=tmp_path / "pillar.xml", pace="realtime") as sim:
        program = Program(programs / "grasp", sim.robot.address)
        assert numbers([program.line()])[0] == pytest.approx(0.08, abs=1e-3)
        if something:
            sim.robot.remote.place_body("cube", [0.307, 0, 0.48])
        held, released = program.end()
    assert held.split()[0] == ("holds" if something else "empty")
    assert numbers([held])[0] == pytest.approx(0.04 if something else 0.0, abs=2e-3)
    assert numbers([released])[0] == pytest.approx(0.08, abs=1e-3)


def test_each_program_has_help(programs):
    for name in PROGRAMS:
        done = subprocess.run([programs / name, "--help"], capture_output=True, text=True, timeout=30)
        assert (done.returncode, done.stderr) == (0, "")
        assert f"{name} ADDRESS" in done.stdout


@pytest.mark.parametrize("arguments", [[], ["127.0.0.1", "more"], ["--ip"]])
def test_wrong_arguments_are_reported(programs, arguments):
    done = subprocess.run([programs / "grasp", *arguments], capture_output=True, text=True)
    assert done.returncode == 2
    assert done.stderr.startswith("usage: ")


def test_missing_robot_is_reported(programs):
    done = subprocess.run(
        [programs / "print_state", "127.99.0.1"], capture_output=True, text=True, timeout=LIMIT
    )
    assert done.returncode == 1
    assert "libfranka: Connection to FCI refused" in done.stderr
