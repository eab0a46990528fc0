# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The examples in examples/python run as they stand, say what is true and draw their pictures.

sweep_stiffness.py: python/test/test_sweep.py.
"""

import re
import subprocess
import sys
from pathlib import Path

import pytest
from PIL import Image, ImageStat

TOP = Path(__file__).resolve().parents[1]
EXAMPLES = TOP / "examples" / "python"
NO_PROGRAMS = {"common", "sweep_stiffness"}


@pytest.fixture(params=["panda", "fr3"])
def run(request, tmp_path):
    """Runs an example with a robot; returns what it printed. Its picture has something on it."""

    def example(name, *options):
        command = [sys.executable, EXAMPLES / f"{name}.py", "--robot", request.param, "--output", tmp_path]
        done = subprocess.run([*command, *options], capture_output=True, text=True, timeout=200)
        assert done.returncode == 0, done.stdout + done.stderr
        with Image.open(tmp_path / f"{name}.png") as picture:
            assert min(picture.size) >= 300
            assert max(ImageStat.Stat(picture.convert("L")).stddev) > 10.0
        return done.stdout

    return example


def numbers(text):
    return [float(number) for number in re.findall(r"-?\d+\.?\d*", text)]


def test_first_steps(run):
    *_, last = run("first_steps").splitlines()
    assert last.endswith("RobotMode.Idle GripperOutcome.Succeeded")


def test_impedance_in_python(run):
    yielded, spring = numbers(run("impedance_in_python"))
    assert spring == 10.0
    assert yielded == pytest.approx(spring, rel=0.05)


def test_pick_and_place(run):
    assert run("pick_and_place").startswith("placed ")


def test_random_episodes(run):
    chance, written = run("random_episodes", "--episodes", "4").splitlines()
    assert written.endswith("100% reached")
    assert numbers(chance)[0] > numbers(written)[0]


def test_record_and_plot(run, tmp_path):
    samples, force = numbers(run("record_and_plot"))
    assert samples == 1200
    assert force == pytest.approx(-400 * (0.42 - 0.37), rel=0.1), "of the spring, on the table"
    assert (tmp_path / "recording.npz").stat().st_size > 10000


def test_each_example_has_a_test_and_each_picture_stands_in_the_documentation():
    programs = {path.stem for path in EXAMPLES.glob("*.py")} - NO_PROGRAMS
    tested = {name.removeprefix("test_") for name in globals() if name.startswith("test_")}
    assert programs <= tested, programs - tested
    pages = "".join(page.read_text() for page in (TOP / "docs").glob("*.md"))
    for name in (*programs, "sweep_stiffness"):
        assert f"(pictures/{name}.png)" in pages and f"examples/python/{name}.py" in pages, name
        assert (TOP / "docs" / "pictures" / f"{name}.png").exists()
