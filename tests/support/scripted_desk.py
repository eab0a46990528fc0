# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Desk of a scripted robot, in this process."""

import contextlib
import copy

from desk_robot import ScriptedRobot
from desk_server import LIMITS, DeskServer
from pyfranka.desk import Options
from pyfranka.desk.profiles import PROFILES


@contextlib.contextmanager
def desk_with_robot(folder, profile="fr3-v1", limits=LIMITS, report=None, **options):
    """A robot and its Desk. report: what the robot reports first, added to the usual; options: of Desk."""
    kind = "fr3" if PROFILES[profile].fr3 else "panda"
    with ScriptedRobot(type=kind, arm_id=kind, **(report or {})) as robot:
        with DeskServer("127.0.0.1", robot.port, folder, profile, Options(**options), limits) as desk:
            yield robot, desk


def change(desk, robot, **parts):
    """The robot reports something else, which Desk has read. Members of a dict that are not given stay."""
    for name, value in copy.deepcopy(parts).items():
        robot.report[name] = {**robot.report[name], **value} if isinstance(value, dict) else value
    desk.refresh()
