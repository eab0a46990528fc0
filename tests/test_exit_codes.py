# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The table of exit statuses in docs/how_to/shell.md is true."""

import math
import re
import shutil
import subprocess
from pathlib import Path

import pytest
from controller_manager import spawner
from franka_sim_mujoco import spawn
from pyfranka import franka_plot, run

TOP = Path(__file__).resolve().parent.parent
PAGE = TOP / "docs" / "how_to" / "shell.md"
# Which statuses mean, without a robot: the program, its words, and the column of the table.
CASES = [
    ("franka_sim", ["--no-such-option"], 2),
    ("franka_sim", ["--ip", "192.0.2.1"], 1),
    ("franka_info", ["--no-such-option"], 3),
    ("franka_info", ["127.0.99.7"], 2),
    ("franka_plot", ["log", "FILE", "-o", "a.png"], 1),
    ("franka_plot", ["robot"], 2),
    ("franka_desk", ["--no-such-option"], 2),
    ("franka_desk", ["--listen", "192.0.2.1:9443"], 1),
    ("new_controller", ["my_package", "MyLaw", "--interfaces", "thought"], 2),
    ("new_controller", ["my_package", "MyLaw", "--interfaces", "effort"], 0),
    ("spawn_robot", ["-param", "robot_description"], 2),
    ("fit_robot", ["FILE", "a.yaml"], 1),
    ("pick_and_place", ["--no-such-option"], 2),
    ("pyfranka-run", ["--", "sh", "-c", "exit 7"], 7),
    ("pyfranka-sweep", ["--no-such-option"], 2),
]


def rows() -> dict[str, list[str]]:
    """Names of the table, and the texts of their columns."""
    found = {}
    for line in PAGE.read_text().splitlines():
        if line.startswith("| `"):
            head, *columns = (cell.strip() for cell in line.strip("|").split("|"))
            for name in re.findall(r"`([^`]+)`", head):
                words = name.removeprefix("./franka ").removeprefix("controller_manager ").split()
                found[words[0]] = columns
    return found


def test_programs_take_every_number_after_an_option(capsys):
    pose = "-x -1e-05 -y -1. -z -.5 -R -2E+3 -P -inf -Y -2 -J joint1 -1e-3".split()
    options = spawn.parse("spawn_robot", ["-param", "p", "-model", "m", *pose])
    assert [options.x, options.y, options.z, options.R] == [-1e-5, -1.0, -0.5, -2000.0]
    assert (options.P, options.Y, options.J) == (-math.inf, -2.0, [["joint1", "-1e-3"]])
    assert spawner.parse_arguments(["--timeout", "-1e-05", "controller"]).timeout == -1e-5
    # These refuse the number, not its form.
    for main, words in (
        (franka_plot.main, ["robot", "127.0.0.1", "--seconds", "-1e-05"]),
        (run.main, ["--timeout", "-1e-05", "--", "true"]),
    ):
        with pytest.raises(SystemExit):
            main(words)
        assert "-1e-05" in capsys.readouterr().err


NEGATIVE = ("-1e-05", "-1.", "-.5", "-2E+3", "-inf")
REFUSED = {
    "--protocol": "give a number from 3 to 10",
    "--control-port": "give a number from 0 to 65535",
    "--pace": "give realtime, patient, lockstep, or a factor",
    "--pace=lockstep --patience": "give a number of seconds from 0.01",
    "--linger": "give a number of seconds from 0 to 60",
}


def test_franka_sim_takes_every_number_after_an_option():
    """It refuses the number, not its form."""

    def refusal(*words):
        return subprocess.run(["franka_sim", *words], text=True, capture_output=True, timeout=120).stderr

    elsewhere = ("--ip", "192.0.2.1")  # so that it ends
    assert "does not have that address" in refusal("--base", "-1e-05,-1.,-.5,-2E+3", *elsewhere)
    assert "--base: give three numbers" in refusal("--base", "-inf,0,0")
    for options, advice in REFUSED.items():
        for number in NEGATIVE:
            error = refusal(*options.split(), number)
            assert f"{options.split()[-1]}: {advice}" in error and number in error


@pytest.mark.parametrize(("program", "words", "status"), CASES)
def test_the_statuses_are_those_of_the_table(program, words, status, tmp_path):
    (tmp_path / "FILE").write_text("nothing\n")
    path = shutil.which(program)
    command = [path] if path else ["rosrun", "controller_manager", program]
    done = subprocess.run(
        [*command, *words],
        cwd=tmp_path,
        text=True,
        capture_output=True,
        timeout=120,
        stdin=subprocess.DEVNULL,
    )
    assert done.returncode == status, done.stderr
    columns = rows()[program]
    told = columns[status] if status < 3 else columns[3]
    assert told, f"the table says nothing about status {status} of {program}"
    if status and status != 7:
        assert len(done.stderr.strip()) > 10, "an error is a sentence"
