# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The capsules of the control unit match the robot's description."""

import math
import re
import sys
import types
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest
import xacro
from scipy.spatial.transform import Rotation

PACKAGE = Path(__file__).resolve().parents[1]
SOURCES = PACKAGE.parent
SAFETY_DISTANCE = 0.03  # [m] around each volume, from the robots' files


@pytest.fixture(autouse=True)
def packages(monkeypatch):
    """Lets xacro find the packages beside this one, without a ROS environment."""
    module = types.ModuleType("ament_index_python.packages")
    module.PackageNotFoundError = KeyError
    module.get_package_share_directory = lambda name: str(SOURCES / name)
    monkeypatch.setitem(sys.modules, "ament_index_python", types.ModuleType("ament_index_python"))
    monkeypatch.setitem(sys.modules, "ament_index_python.packages", module)


def table():
    """(link, from, to, radius) as written in the source."""
    text = (PACKAGE / "src/robot/safety/capsules.cpp").read_text(encoding="utf-8")
    text = text[text.index("kCapsules{{") : text.index("}};")]
    text = text.replace("kHandLink", "8").replace("kHalfRoot", repr(math.sqrt(0.5)))
    number = r"[-0-9.* ]+"
    vector = r"\{\{" + ",".join([f"({number})"] * 3) + r"\}\}"
    row = r"\{(\d),\s*" + vector + r",\s*" + vector + r",\s*([0-9.]+)\}"
    capsules = []
    for match in re.finditer(row, text):
        values = [math.prod(float(f) for f in v.split("*")) for v in match.groups()]
        capsules.append((int(values[0]), values[1:4], values[4:7], values[7]))
    return capsules


def rotated(rpy, point):
    """Rotations about the fixed axes x, y, z, in this order."""
    return list(Rotation.from_euler("xyz", rpy).apply(point))


def numbers(text):
    return [float(v) for v in text.split()]


def described(robot):
    """The same from the URDF: every cylinder of a link `_sc` is the middle of a capsule."""
    file = SOURCES / f"franka_description/robots/{robot}/{robot}.urdf.xacro"
    mappings = {"hand": "true", "mesh_index": "/nonexistent/available.xacro"}
    urdf = ElementTree.fromstring(xacro.process_file(str(file), mappings=mappings).toxml())
    turns = {
        joint.find("child").get("link"): numbers(joint.find("origin").get("rpy"))
        for joint in urdf.iter("joint")
        if joint.find("origin") is not None
    }
    capsules = []
    for link in urdf.iter("link"):
        match = re.fullmatch(robot + r"_(?:link(\d)|hand)_sc", link.get("name"))
        if not match:
            continue
        for collision in link.iter("collision"):
            cylinder = collision.find("geometry/cylinder")
            if cylinder is None:
                continue
            origin = collision.find("origin")
            half = [0, 0, 0.5 * float(cylinder.get("length"))]
            axis = rotated(numbers(origin.get("rpy")), half)
            center = numbers(origin.get("xyz"))
            turn = turns.get(link.get("name"), [0, 0, 0])
            ends = [rotated(turn, [c + sign * a for c, a in zip(center, axis)]) for sign in (-1, 1)]
            capsules.append(
                (int(match.group(1) or 8), *ends, float(cylinder.get("radius")) - SAFETY_DISTANCE)
            )
    return capsules


@pytest.mark.parametrize("robot", ["panda", "fr3"])
def test_the_table_matches_the_description(robot):
    ours = table()
    theirs = described(robot)
    assert len(ours) == len(theirs) == 12
    for link, start, end, radius in theirs:
        matches = [
            c
            for c in ours
            if c[0] == link
            and c[3] == pytest.approx(radius)
            and (
                (c[1] == pytest.approx(start, abs=1e-9) and c[2] == pytest.approx(end, abs=1e-9))
                or (c[2] == pytest.approx(start, abs=1e-9) and c[1] == pytest.approx(end, abs=1e-9))
            )
        ]
        assert len(matches) == 1, f"link {link}: {start} to {end}, radius {radius}"
