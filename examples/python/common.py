# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Common parts of the examples: their command line and the robot's address. They run as notebooks, too."""

import argparse
import importlib.util
import sys
from pathlib import Path

import matplotlib
from pyfranka.sim import KINDS

BASE = (-0.5, 0.0, 0.0)  # of a robot at the table of stone.xml [m]
NOTEBOOK = "ipykernel" in sys.modules
if not NOTEBOOK:
    matplotlib.use("Agg")  # no display


def options(description, needs=(), episodes=100):
    """The command line, and the class of the robot that it selects. A notebook has the defaults. needs: names
    of packages that are not with pyfranka; if one is missing, a sentence ends the program."""
    parser = argparse.ArgumentParser(description=(description or "").partition("\n")[0])
    parser.add_argument("--robot", choices=KINDS, default="panda", help="which arm (panda)")
    parser.add_argument("--output", type=Path, default=Path(), metavar="FOLDER", help="of what is written")
    parser.add_argument("--episodes", type=int, default=episodes, help="if the example has any")
    arguments = parser.parse_args([] if NOTEBOOK else None)
    for name in needs:
        if importlib.util.find_spec(name) is None:
            parser.exit(
                1,
                f"{parser.prog} needs the Python package {name}: run ./franka install extras, and use "
                f".venv/bin/python3; elsewhere pip install {name}\n",
            )
    arguments.output.mkdir(parents=True, exist_ok=True)
    return arguments, KINDS[arguments.robot]


def progress(done, total, what):
    """Shows how far a program is, in one line of standard error."""
    print(f"\r{what}: {done} of {total}", end="\n" if done == total else "", file=sys.stderr, flush=True)
