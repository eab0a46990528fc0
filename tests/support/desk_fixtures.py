# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A scripted robot with its Desk, for tests that need one generation only."""

import contextlib
import copy

from desk_robot import REPORT, ScriptedRobot
from desk_server import LIMITS, DeskServer
from pyfranka.desk import Options
from pyfranka.desk.profiles import PROFILES


@contextlib.contextmanager
def desk_with_robot(folder, profile="fr3-v1", limits=LIMITS, report=None, **options):
    """A robot and its Desk. report: what the robot reports first, beside the usual; options: of Desk."""
    kind = "fr3" if PROFILES[profile].fr3 else "panda"
    with ScriptedRobot(type=kind, arm_id=kind, **(report or {})) as robot:
        with DeskServer("127.0.0.1", robot.port, folder, profile, Options(**options), limits) as desk:
            yield robot, desk


def fresh_robot(place, **report):
    """The robot of a module's place, as at first. report: what it reports beside the usual."""
    robot, _ = place
    robot.report.update(copy.deepcopy(REPORT), **report)
    robot.answers.clear()
    robot.raw_report = None
    return robot


def fresh_desk(place):
    """The Desk of a module's place without logins, after its robot is as at first."""
    robot, desk = place
    desk.clear()
    desk.refresh()
    robot.lines.clear()
    return desk
