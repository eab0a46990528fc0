# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The tree of links and joints, and the poses of flange, hand and tool center point."""

import math

import numpy as np
import pytest
from description_robot import ARM_LINKS, expand, expand_text, modified_dh, transform
from hypothesis import given, settings
from hypothesis import strategies as st

ROBOTS = ["panda", "fr3"]
READY = [0, -math.pi / 4, 0, -3 * math.pi / 4, 0, math.pi / 2, math.pi / 4]


def positions(arm_id, q):
    return {f"{arm_id}_joint{i}": v for i, v in enumerate(q, start=1)}


@pytest.mark.parametrize(
    "name, hand, gazebo",
    [("panda", False, False), ("fr3", True, False), ("fr3", False, True), ("panda", True, True)],
)
def test_tree(name, hand, gazebo):
    robot = expand(f"{name}/{name}", hand=str(hand).lower(), gazebo=str(gazebo).lower())
    links = {f"{name}_{link}{sc}" for link in ARM_LINKS for sc in ("", "_sc")} | {f"{name}_link8"}
    joints = {f"{name}_joint{i}" for i in range(1, 9)}
    joints |= {f"{name}_{link}_sc_joint" for link in ARM_LINKS}
    if hand:
        links |= {f"{name}_{n}" for n in ("hand", "hand_sc", "hand_tcp", "leftfinger", "rightfinger")}
        joints |= {f"{name}_{n}_joint" for n in ("hand", "hand_sc", "hand_tcp")}
        joints |= {f"{name}_finger_joint1", f"{name}_finger_joint2"}
    if gazebo:
        links.add("world")
        joints.add("world_joint")
    assert set(robot.links) == links
    assert set(robot.joints) == joints
    assert robot.root() == ("world" if gazebo else f"{name}_link0")
    assert robot.xml.get("name") == name


def test_joint_types_axes_and_dynamics():
    name = "panda"
    robot = expand(f"{name}/{name}", hand="true")
    dynamics = dict(D="1", K="7000", damping="0.003", friction="0.0", mu_coulomb="0", mu_viscous="16")
    for i in range(1, 8):
        joint = robot.joints[f"{name}_joint{i}"]
        assert joint.get("type") == "revolute"
        assert joint.find("axis").get("xyz") == "0 0 1"
        assert joint.find("dynamics").attrib == dynamics
        assert joint.find("parent").get("link") == f"{name}_link{i - 1}"
        assert joint.find("child").get("link") == f"{name}_link{i}"
    for i, (finger, axis) in enumerate([("left", "0 1 0"), ("right", "0 -1 0")], start=1):
        joint = robot.joints[f"{name}_finger_joint{i}"]
        assert joint.get("type") == "prismatic"
        assert joint.find("axis").get("xyz") == axis
        assert joint.find("dynamics").attrib == {"damping": "0.3"}
        assert joint.find("child").get("link") == f"{name}_{finger}finger"
        assert joint.find("origin").get("xyz") == "0 0 0.0584"
    assert robot.joints[f"{name}_finger_joint1"].find("mimic") is None
    mimic = robot.joints[f"{name}_finger_joint2"].find("mimic")
    assert mimic.attrib == {"joint": f"{name}_finger_joint1"}


@settings(max_examples=50, deadline=None)
@given(st.lists(st.floats(-math.pi, math.pi), min_size=7, max_size=7))
def test_flange_matches_the_dh_table(q):
    for name in ROBOTS:
        pose = expand(f"{name}/{name}").pose(f"{name}_link8", positions(name, q))
        np.testing.assert_allclose(pose, modified_dh(q), atol=1e-13)


def test_hand_is_rotated_at_the_flange_and_fingers_open():
    name = "panda"
    robot = expand(f"{name}/{name}", hand="true")
    hand = robot.joints[f"{name}_hand_joint"]
    assert hand.find("parent").get("link") == f"{name}_link8"
    np.testing.assert_allclose(
        transform(hand.find("origin")),
        [[0.5**0.5, 0.5**0.5, 0, 0], [-(0.5**0.5), 0.5**0.5, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]],
        atol=1e-15,
    )
    q = {f"{name}_finger_joint1": 0.03, f"{name}_finger_joint2": 0.03}
    to_hand = np.linalg.inv(robot.pose(f"{name}_hand"))
    left, right = (to_hand @ robot.pose(f"{name}_{s}finger", q) for s in ("left", "right"))
    np.testing.assert_allclose(left[:3, 3], [0, 0.03, 0.0584], atol=1e-15)
    np.testing.assert_allclose(right[:3, 3], [0, -0.03, 0.0584], atol=1e-15)


def test_arm_on_something_else():
    robot = expand_text(
        """<link name="table"/>
        <xacro:franka_arm arm_id="left" connected_to="table" xyz="1 2 3" rpy="0 0 1.5"
          joint_limits="${panda_limits}"/>"""
    )
    joint = robot.joints["left_joint_table"]
    assert joint.get("type") == "fixed"
    assert joint.find("origin").attrib == {"xyz": "1 2 3", "rpy": "0 0 1.5"}
    assert robot.root() == "table"


def test_dual_panda():
    robot = expand("dual_panda/dual_panda_example")
    assert robot.xml.get("name") == "panda"
    assert robot.root() == "base"
    box = robot.links["base"].find("collision")
    assert box.find("geometry/box").get("size") == "1 2 1"
    assert box.find("origin").get("xyz") == "0 0 0.5"
    for arm, y in (("panda_1", -0.5), ("panda_2", 0.5)):
        np.testing.assert_allclose(robot.pose(f"{arm}_link0")[:3, 3], [0, y, 1])
        expected = np.eye(4)
        expected[:3, 3] = [0, y, 1]
        np.testing.assert_allclose(
            robot.pose(f"{arm}_link8", positions(arm, READY)),
            expected @ modified_dh(READY),
            atol=1e-13,
        )
        assert robot.joints[f"{arm}_hand_joint"].find("parent").get("link") == f"{arm}_link8"
    assert robot.xml.find("transmission") is None


def test_hand_alone():
    robot = expand("common/hand")
    assert robot.xml.get("name") == "panda"
    assert robot.root() == "panda_hand"
    parts = ("hand", "hand_sc", "hand_tcp", "leftfinger", "rightfinger")
    assert set(robot.links) == {f"panda_{part}" for part in parts}
