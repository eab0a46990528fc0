# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Robots with the meshes that ./franka install has brought, against those that xacro makes."""

import subprocess
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy
import pytest
from pyfranka import meshes
from pyfranka.sim import FR3, Panda, Simulation

DESCRIPTION = Path(__file__).resolve().parents[2] / "catkin_ws" / "src" / "franka_description"
KINDS = {"panda": Panda, "fr3": FR3}


def visuals(urdf, name):
    """Mesh and pose of each link that is seen, by the name without prefix."""
    found = {}
    for link in ElementTree.fromstring(urdf).iter("link"):
        for visual in link.iter("visual"):
            origin = visual.find("origin")
            numbers = {key: [float(x) for x in origin.get(key, "0 0 0").split()] for key in ("xyz", "rpy")}
            assert link.get("name").startswith(f"{name}_")
            mesh = visual.find("geometry/mesh")
            found[link.get("name").removeprefix(f"{name}_")] = (mesh.get("filename"), numbers)
    return found


def test_appearance_is_that_of_the_description(name):
    file = DESCRIPTION / "robots" / name / f"{name}.urdf.xacro"
    expanded = subprocess.check_output(["xacro", file, "hand:=true"], text=True)
    ours, theirs = visuals(meshes.urdf(name, "left"), "left"), visuals(expanded, name)
    assert list(ours) == list(theirs) and len(ours) == 11
    for part, (file, pose) in ours.items():
        assert file == theirs[part][0]
        for key, numbers in pose.items():
            numpy.testing.assert_allclose(numbers, theirs[part][1][key], atol=1e-6)


def test_meshes_change_pictures_and_no_motion(name, tmp_path):
    file = tmp_path / "robot.urdf"
    file.write_text(meshes.urdf(name))
    pictures, hashes = [], []
    for urdf in ("", file):
        with Simulation("stone.xml", [KINDS[name](base=(-0.5, 0, 0), urdf=urdf)]) as sim:
            sim[name].joint_impedance(sim[name].state.q + 0.1, duration=0.1)
            sim.step(200)
            hashes.append(sim.state_hash())
            pictures.append(sim.render(width=160, height=120).rgb)
    assert hashes[0] == hashes[1]
    assert (pictures[0] != pictures[1]).any(axis=2).mean() > 0.01


def test_an_unknown_robot_is_refused():
    with pytest.raises(ValueError, match="There is no robot 'ur5' with meshes; there are panda, fr3."):
        meshes.urdf("ur5")
