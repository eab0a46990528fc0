# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Plots of a robot's states, commands, limits and errors; the program franka_plot uses it. Needs matplotlib.

import pyfranka
import pyfranka.plot

try:
    robot.control_joint_velocities(...)
except pyfranka.ControlException as error:
    pyfranka.plot.abort_figure(error, robot.server_version).savefig("abort.png")
"""

from __future__ import annotations

try:
    from matplotlib.figure import Figure
except ModuleNotFoundError as error:
    if not str(error.name).startswith("matplotlib"):
        raise
    from pyfranka.command_line import missing_package

    raise missing_package("pyfranka.plot", "matplotlib", "plot") from None

import pyfranka
from pyfranka.plot.figure import plot, plot_abort
from pyfranka.plot.recording import Abort, BadInput, Collector, Recording, of_log
from pyfranka.plot.signals import SIGNALS
from pyfranka.plot.sources import read_bag, read_log

__all__ = [
    "SIGNALS",
    "Abort",
    "BadInput",
    "Collector",
    "Recording",
    "abort_figure",
    "of_log",
    "plot",
    "plot_abort",
    "read_bag",
    "read_log",
]


def abort_figure(error: pyfranka.ControlException, version: int = 0) -> Figure:
    """A figure of an aborted motion. version: of the robot's protocol, for its limits.

    Raises TypeError for another error, BadInput if it has no log.

    >>> pyfranka.plot.abort_figure(error, robot.server_version).savefig(folder / "abort.png")
    """
    if not isinstance(error, pyfranka.ControlException):
        raise TypeError(f"error must be the ControlException of a motion, not {error!r}.")
    return plot_abort(of_log(error.log, version), Abort.of_text(str(error)))
