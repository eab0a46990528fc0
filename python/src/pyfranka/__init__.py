# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""libfranka and ModelKDL for Python; pyfranka.sim has simulations, pyfranka.sweep runs many of them.

    import pyfranka

    robot = pyfranka.Robot("172.16.0.2", pyfranka.RealtimeConfig.Ignore)
    print(robot.read_once().q)
    robot.control_torques(lambda state, period: pyfranka.Torques([0.0] * 7))

Arrays of a RobotState are numpy views of it; matrices have two dimensions and are stored column-major, as
    on the robot. For frames and units see the attributes' docstrings. Calls that wait for the robot let other
    Python threads run; errors are pyfranka.Exception and derived classes.
"""

import builtins as _builtins

from _pyfranka import *  # noqa: F401, F403

from pyfranka import _public_names

_public_names.publish()

# `from pyfranka import *` does not hide Python's own Exception; FrankaException is another name of ours.
__all__ = [name for name in globals() if not name.startswith("_") and not hasattr(_builtins, name)]


def __getattr__(name: str) -> object:
    """Imports pyfranka.sweep when it is used: robots and simulations do not need Dask."""
    if name == "sweep":
        from pyfranka.sweeps import sweep

        return sweep
    raise AttributeError(f"module 'pyfranka' has no attribute '{name}'")


def __dir__() -> list[str]:
    return sorted({*globals(), "sweep"})
