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


def __getattr__(name: str) -> object:
    """Loads what is in C++, and pyfranka.sweep with Dask, when a name of it is used: programs and pytest
    import pyfranka without."""
    if name == "sweep":
        from pyfranka.sweeps import sweep

        return sweep
    if name == "__all__":
        from pyfranka._native import STARRED

        return STARRED
    if not name.startswith("_"):
        from pyfranka._native import NAMES

        if name in NAMES:
            globals()[name] = NAMES[name]
            return NAMES[name]
    raise AttributeError(f"module 'pyfranka' has no attribute '{name}'")


def __dir__() -> list[str]:
    from pyfranka._native import NAMES

    return sorted({*globals(), *NAMES, "sweep"})
