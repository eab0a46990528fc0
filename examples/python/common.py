# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Common parts of the examples: their command line and the robot's address. They run as notebooks, too."""

import argparse
import sys
from pathlib import Path

import matplotlib
from pyfranka.sim import KINDS

BASE = (-0.5, 0.0, 0.0)  # of a robot at the table of stone.xml [m]
NOTEBOOK = "ipykernel" in sys.modules
if not NOTEBOOK:
    matplotlib.use("Agg")  # no display


def options(description):
    """The command line, and the class of the robot that it selects. A notebook has the defaults."""
    parser = argparse.ArgumentParser(description=description.partition("\n")[0])
    parser.add_argument("--robot", choices=KINDS, default="panda")
    parser.add_argument("--output", type=Path, default=Path(), metavar="FOLDER", help="of what is written")
    parser.add_argument("--episodes", type=int, default=100, help="of random_episodes.py")
    arguments = parser.parse_args([] if NOTEBOOK else None)
    arguments.output.mkdir(parents=True, exist_ok=True)
    return arguments, KINDS[arguments.robot]
