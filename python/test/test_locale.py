# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A program that calls setlocale(), as those of Qt do, has the robots of every other program."""

import os
import subprocess
import sys
from pathlib import Path

import decimal_comma
import pytest

PROGRAM = """
import locale, sys, threading
import numpy, pyfranka
from pyfranka.sim import FR3, Panda, Simulation

locale.setlocale(locale.LC_ALL, "")
assert locale.localeconv()["decimal_point"] == sys.argv[1]

def ask(address):
    robot = pyfranka.Robot(address, pyfranka.RealtimeConfig.Ignore)
    state = robot.read_once()
    print(robot.get_upper_joint_velocity_limits(state.q), robot.load_model().mass(state))
    robot.set_load(0.25, [0.01, 0.02, 0.03], numpy.diag([0.001, 0.002, 0.003]).ravel())
    for mass in (-0.5, 0.5):
        try:
            robot.set_load(mass, [0.5, 0.0, 0.0], [0.0] * 9)
        except pyfranka.CommandException as error:
            print(error)

with Simulation(robots=[Panda(base=(0.0, 0.5, 0.0)), FR3(base=(0.0, -0.5, 0.0))]) as sim:
    for robot, address in zip(list(sim), ("127.0.33.31", "127.0.33.32")):
        sim.serve(address, robot)
        client = threading.Thread(target=ask, args=(address,))
        client.start()
        while client.is_alive():
            sim.step()
with Simulation(robots=[FR3(realism="recorded")]) as sim:
    sim.step(500)
    print(sim.state_hash())
"""


def run(*arguments: str, **environment: str) -> str:
    return subprocess.check_output(
        [sys.executable, "-c", PROGRAM, *arguments], env={**os.environ, **environment}, text=True, timeout=120
    )


NEEDS_LOCALES = pytest.mark.skipif(
    not Path("/usr/share/i18n/locales/de_DE").exists(), reason="locales is not installed"
)


@pytest.fixture(scope="module")
def with_point():
    printed = run(".", LC_ALL="C")
    assert len(printed.splitlines()) > 20
    return printed


@NEEDS_LOCALES
def test_a_decimal_comma_from_the_beginning_changes_nothing(with_point, tmp_path):
    assert with_point == run(",", **decimal_comma.environment(tmp_path))


@NEEDS_LOCALES
@pytest.mark.parametrize(
    ("language", "characters", "point"),
    [("tr_TR", "ISO-8859-9", ","), ("ja_JP", "EUC-JP", "."), ("ps_AF", "UTF-8", "\u066b")],
)
def test_a_locale_with_other_letters_or_characters_changes_nothing(
    language, characters, point, with_point, tmp_path
):
    """Turkish has another capital of i; the others write in several bytes, or no point that C knows."""
    name = f"{language}.{characters}"
    subprocess.run(["localedef", "-i", language, "-f", characters, tmp_path / name], check=True)
    assert with_point == run(point, LC_ALL=name, LOCPATH=str(tmp_path))
