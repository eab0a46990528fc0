# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Desk: the web interface of a Franka robot's control unit, for robots that franka_sim serves.

    franka_desk --robot 127.0.0.1

For programs that log in to a robot before they use the FCI, and for browsers, it behaves like a real one
(docs/desk.md). It needs aiohttp and cryptography: the wheel's extra `desk`, or Debian's packages. Desk
talks to the robot over its control interface only (docs/franka_sim.md).

The order of its modules, of which each imports only what is below it, is in .importlinter.
"""

from __future__ import annotations

import importlib
import typing

if typing.TYPE_CHECKING:
    from pyfranka.desk.desk import Desk
    from pyfranka.desk.errors import Refused, RobotGone
    from pyfranka.desk.robot import DeskRobot
    from pyfranka.desk.server import make_app
    from pyfranka.desk.settings import Limits, Options, Settings

__all__ = ["Desk", "DeskRobot", "Limits", "Options", "Refused", "RobotGone", "Settings", "make_app"]
_MODULES = {
    "Desk": "desk",
    "DeskRobot": "robot",
    "Limits": "settings",
    "Options": "settings",
    "Refused": "errors",
    "RobotGone": "errors",
    "Settings": "settings",
    "make_app": "server",
}


def __getattr__(name: str) -> typing.Any:
    """Imports a name when it is used: the program's --help does not need aiohttp."""
    if name in _MODULES:
        return getattr(importlib.import_module(f"pyfranka.desk.{_MODULES[name]}"), name)
    raise AttributeError(f"module 'pyfranka.desk' has no attribute '{name}'")
