# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Functions that tests use on an expanded description."""

import functools
import math
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import xacro
from scipy.spatial.transform import Rotation

ROBOTS = Path(__file__).resolve().parents[1] / "robots"
NO_MESHES = "/nonexistent/available.xacro"
ARM_LINKS = [f"link{i}" for i in range(8)]


@functools.cache  # tests do not change the result
def expand(name, mesh_index=NO_MESHES, **arguments):
    """The Robot from robots/<name>.urdf.xacro."""
    mappings = {"mesh_index": mesh_index, **arguments}
    document = xacro.process_file(str(ROBOTS / f"{name}.urdf.xacro"), mappings=mappings)
    return Robot(document.toxml())


def expand_text(body, **arguments):
    """The Robot from xacro text that has the macros, and panda_limits for joint_limits."""
    path = ROBOTS / "panda" / "joint_limits.yaml"
    limits = f'<xacro:property name="panda_limits" value="${{xacro.load_yaml(\'{path}\')}}"/>'
    include = '<xacro:include filename="$(find franka_description)/robots/common/franka_robot.xacro"/>'
    start = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="r">'
    text = f"{start}{include}{limits}{body}</robot>"
    document = xacro.parse(text)
    xacro.process_doc(document, mappings={"mesh_index": NO_MESHES, **arguments})
    return Robot(document.toxml())


def numbers(text):
    return [float(v) for v in text.split()]


def rotation(rpy):
    """URDF's fixed-axis roll, pitch, yaw as a matrix."""
    return Rotation.from_euler("xyz", rpy).as_matrix()


def transform(origin):
    pose = np.eye(4)
    pose[:3, :3] = rotation(numbers(origin.get("rpy", "0 0 0")))
    pose[:3, 3] = numbers(origin.get("xyz", "0 0 0"))
    return pose


class Robot:
    def __init__(self, text):
        self.text = text
        self.xml = ElementTree.fromstring(text)
        self.links = {link.get("name"): link for link in self.xml.findall("link")}
        self.joints = {joint.get("name"): joint for joint in self.xml.findall("joint")}
        assert len(self.links) == len(self.xml.findall("link")), "a link is there twice"
        assert len(self.joints) == len(self.xml.findall("joint")), "a joint is there twice"

    def parents(self):
        """Child link -> joint."""
        found = {joint.find("child").get("link"): joint for joint in self.joints.values()}
        assert len(found) == len(self.joints), "a link has two parents"
        return found

    def root(self):
        roots = set(self.links) - set(self.parents())
        assert len(roots) == 1, f"not one root but {roots}"
        return roots.pop()

    def pose(self, link, q=None):
        """4x4 pose of a link in the root, with joint positions by joint name."""
        pose = np.eye(4)
        parents = self.parents()
        while link in parents:
            joint = parents[link]
            motion = np.eye(4)
            value = (q or {}).get(joint.get("name"), 0.0)
            axis = joint.find("axis")
            if joint.get("type") == "revolute":
                assert axis.get("xyz") == "0 0 1"
                motion[:3, :3] = rotation([0, 0, value])
            elif joint.get("type") == "prismatic":
                motion[:3, 3] = value * np.array(numbers(axis.get("xyz")))
            pose = transform(joint.find("origin")) @ motion @ pose
            link = joint.find("parent").get("link")
        return pose


def shapes(link, kind="collision"):
    """(tag, attributes as numbers, pose) of each geometry of a link."""
    found = []
    for element in link.findall(kind):
        shape = element.find("geometry")[0]
        data = {k: v if k == "filename" else numbers(v) for k, v in shape.attrib.items()}
        found.append((shape.tag, data, transform(element.find("origin"))))
    return found


def modified_dh(q):
    """The arm's flange pose from the table of modified Denavit-Hartenberg parameters."""
    a = [0, 0, 0, 0.0825, -0.0825, 0, 0.088]
    d = [0.333, 0, 0.316, 0, 0.384, 0, 0]
    alpha = [0, -math.pi / 2, math.pi / 2, math.pi / 2, -math.pi / 2, math.pi / 2, math.pi / 2]
    pose = np.eye(4)
    for i, angle in enumerate(q):
        ct, st, ca, sa = math.cos(angle), math.sin(angle), math.cos(alpha[i]), math.sin(alpha[i])
        pose = pose @ np.array(
            [
                [ct, -st, 0, a[i]],
                [st * ca, ct * ca, -sa, -d[i] * sa],
                [st * sa, ct * sa, ca, d[i] * ca],
                [0, 0, 0, 1],
            ]
        )
    flange = np.eye(4)
    flange[2, 3] = 0.107
    return pose @ flange
