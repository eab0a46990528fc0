# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The arguments of the robot files: the effect of each, and errors of wrong ones."""

import re

import pytest
import xacro
import yaml
from description_robot import ROBOTS, expand, expand_text, numbers

NAMES = ["panda", "fr3"]


@pytest.mark.parametrize("name", NAMES)
def test_defaults(name):
    plain = expand(f"{name}/{name}")
    explicit = expand(
        f"{name}/{name}",
        arm_id=name,
        hand="false",
        tcp_xyz="0 0 0.1034",
        tcp_rpy="0 0 0",
        gazebo="false",
        parent="world",
        xyz="0 0 0",
        rpy="0 0 0",
    )
    assert plain.text == explicit.text


@pytest.mark.parametrize("name, arm_id", [("panda", "left"), ("fr3", "my_panda_2"), ("fr3", "7")])
def test_arm_id_begins_every_name(name, arm_id):
    robot = expand(f"{name}/{name}", hand="true", gazebo="true", arm_id=arm_id)
    names = [e.get("name") for e in robot.xml.iter() if e.tag in ("link", "joint", "transmission")]
    names += [e.get("name") for e in robot.xml.iter("actuator")]
    names += [e.get("reference") for e in robot.xml.findall("gazebo") if e.get("reference")]
    names += [e.get("joint") for e in robot.xml.iter("mimic")]
    names += [e.get("link") for e in robot.xml.iter() if e.get("link")]
    strangers = {n for n in names if not n.startswith(f"{arm_id}_")}
    assert strangers == {"world", "world_joint"}
    # nothing keeps the default name
    assert re.search(rf"\b{name}_", robot.text) is None


def test_same_robot_under_another_name():
    robot = expand("panda/panda", hand="true", gazebo="true", arm_id="left")
    default = expand("panda/panda", hand="true", gazebo="true")
    assert robot.text.replace("left_", "panda_") == default.text


@pytest.mark.parametrize("name", NAMES)
def test_tool_center_point(name):
    robot = expand(f"{name}/{name}", hand="true", tcp_xyz="0.1 -0.2 1e-2", tcp_rpy="0 0.5 -1")
    origin = robot.joints[f"{name}_hand_tcp_joint"].find("origin")
    assert numbers(origin.get("xyz")) == [0.1, -0.2, 0.01]
    assert numbers(origin.get("rpy")) == [0, 0.5, -1]
    default = expand(f"{name}/{name}", hand="true").joints[f"{name}_hand_tcp_joint"].find("origin")
    assert numbers(default.get("xyz")) == [0, 0, 0.1034]
    assert numbers(default.get("rpy")) == [0, 0, 0]


def test_base_pose_only_counts_in_simulation():
    where = dict(xyz="1 2 3", rpy="0.1 0.2 0.3")
    joint = expand("panda/panda", gazebo="true", **where).joints["world_joint"]
    assert joint.get("type") == "fixed"
    assert joint.find("parent").get("link") == "world"
    assert joint.find("child").get("link") == "panda_link0"
    assert joint.find("origin").attrib == where
    assert expand("panda/panda", **where).text == expand("panda/panda").text


def test_parent():
    other = expand("panda/panda", gazebo="true", parent="table", xyz="0 0 1")
    assert "world" not in other.links and "table" not in other.links
    assert other.joints["table_joint"].find("parent").get("link") == "table"
    body = """<xacro:franka_robot arm_id="p" parent="" gazebo="true"
        joint_limits="${panda_limits}"/>"""
    assert expand_text(body).root() == "p_link0"


ROBOT = '<xacro:franka_robot arm_id="p" joint_limits="${panda_limits}" %s/>'


def test_macro_without_arguments_takes_those_of_the_description():
    where = dict(xyz="1 2 3", rpy="0.1 0.2 0.3")
    robot = expand_text(ROBOT % "", hand="true", gazebo="true", tcp_xyz="0 0 0.2", tcp_rpy="0 0 1", **where)
    assert robot.xml.find("transmission") is not None
    assert robot.links["p_link1"].find("inertial") is not None
    assert robot.joints["world_joint"].find("origin").attrib == where
    tcp = robot.joints["p_hand_tcp_joint"].find("origin").attrib
    assert tcp == dict(xyz="0 0 0.2", rpy="0 0 1")


def test_macro_with_arguments_ignores_those_of_the_description():
    robot = expand_text(ROBOT % 'hand="false"', hand="true", gazebo="true", xyz="1 2 3")
    assert robot.text == expand_text(ROBOT % "").text
    assert "p_hand" not in robot.links and robot.root() == "p_link0"


@pytest.mark.parametrize("gazebo", ["true", "false"])
def test_macro_mounts_the_arm_on_its_parent(gazebo):
    body = '<link name="stand"/>' + ROBOT % f'parent="stand" xyz="0 0 0.95" rpy="0 0 1" gazebo="{gazebo}"'
    robot = expand_text(body)
    assert robot.root() == "stand"
    assert robot.joints["stand_joint"].find("origin").attrib == dict(xyz="0 0 0.95", rpy="0 0 1")
    assert expand_text(ROBOT % f'xyz="0 0 0.95" gazebo="{gazebo}"').root() == "world"


@pytest.mark.parametrize("left_y", [0.5, 0])
@pytest.mark.parametrize("gazebo", ["true", "false"])
@pytest.mark.parametrize("parent", ["world", "stand"])
def test_two_arms_share_a_parent(parent, gazebo, left_y):
    arms = [
        f'<xacro:franka_robot arm_id="{arm}" parent="{parent}" xyz="0 {y} 0" gazebo="{gazebo}"'
        ' joint_limits="${panda_limits}"/>'
        for arm, y in (("left", left_y), ("right", -0.5))
    ]
    robot = expand_text("".join(arms) + ('<link name="stand"/>' if parent == "stand" else ""))
    assert robot.root() == parent
    assert robot.pose("left_link0")[1, 3] == left_y and robot.pose("right_link0")[1, 3] == -0.5


@pytest.mark.parametrize("name", [*(f"{robot}/{robot}" for robot in NAMES), "dual_panda/dual_panda_example"])
def test_descriptions_are_plain_text_of_yaml(name):
    """So that `rosparam set robot_description "$(xacro ...)"` stores them."""
    arguments = dict(hand="true", gazebo="true") if name.split("/")[0] in NAMES else {}
    assert isinstance(yaml.safe_load(expand(name, **arguments).text), str)


@pytest.mark.parametrize("name, true, false", [("panda", "True", "False"), ("fr3", "1", "0")])
def test_both_spellings_of_truth_values_mean_the_same(name, true, false):
    with_hand = expand(f"{name}/{name}", hand=true, gazebo=false)
    assert with_hand.text == expand(f"{name}/{name}", hand="true").text
    simulated = expand(f"{name}/{name}", hand=false, gazebo=true)
    assert simulated.text == expand(f"{name}/{name}", gazebo="true").text


@pytest.mark.parametrize(
    "name, arguments, words",
    [
        ("panda", dict(hand="franka_hand"), ["'hand'", "'franka_hand'", "true or false"]),
        ("fr3", dict(gazebo="yes"), ["'gazebo'", "'yes'", "true or false"]),
        ("panda", dict(arm_id="my panda"), ["'arm_id'", "'my panda'", "without spaces"]),
        ("fr3", dict(hand="true", tcp_xyz="0 0"), ["'tcp_xyz'", "'0 0'", "three numbers"]),
        ("panda", dict(hand="true", tcp_xyz="0 0 up"), ["'tcp_xyz'", "'0 0 up'", "three numbers"]),
        ("fr3", dict(hand="true", tcp_rpy="0,0,0"), ["'tcp_rpy'", "'0,0,0'", "three numbers"]),
        ("panda", dict(hand="true", tcp_rpy="0 0 --1"), ["'tcp_rpy'", "three numbers"]),
        ("fr3", dict(hand="true", tcp_rpy="0 0 nan"), ["'tcp_rpy'", "three numbers"]),
        ("panda", dict(gazebo="true", xyz="1 2 3 4"), ["'xyz'", "'1 2 3 4'", "three numbers"]),
        ("fr3", dict(gazebo="true", rpy="1"), ["'rpy'", "'1'", "three numbers"]),
    ],
)
def test_wrong_arguments_are_reported(name, arguments, words):
    with pytest.raises(xacro.XacroException) as error:
        expand(f"{name}/{name}", **arguments)
    text = str(error.value)
    assert text.startswith("franka_description: ")
    for word in words:
        assert word in text


def test_every_number_format_is_accepted():
    robot = expand("panda/panda", hand="true", tcp_xyz="0 -1 +.5", tcp_rpy="1. 1e-3 -1.5E+2")
    origin = robot.joints["panda_hand_tcp_joint"].find("origin")
    assert numbers(origin.get("xyz")) == [0, -1, 0.5]
    assert numbers(origin.get("rpy")) == [1, 0.001, -150]


def test_two_arms_with_the_same_name_are_refused():
    with pytest.raises(xacro.XacroException, match="'arm_id_1' and 'arm_id_2' are both 'a'"):
        expand("dual_panda/dual_panda_example", arm_id_1="a", arm_id_2="a")


def test_two_arms_of_unknown_type_are_refused():
    with pytest.raises(xacro.XacroException, match="'robot' is 'ur5'; it must be panda or fr3"):
        expand("dual_panda/dual_panda_example", robot="ur5")


@pytest.mark.parametrize("broken", ["joint3", "upper"])
def test_incomplete_limits(tmp_path, broken):
    lines = (ROBOTS / "panda" / "joint_limits.yaml").read_text()
    if broken == "joint3":
        lines = lines.replace("joint3:", "joint9:")
    else:
        lines = lines.replace("    upper: -0.0698\n", "")
    (tmp_path / "limits.yaml").write_text(lines)
    limits = f"${{xacro.load_yaml('{tmp_path}/limits.yaml')}}"
    body = f'<xacro:franka_arm arm_id="p" joint_limits="{limits}"/>'
    sentence = "no entry 'joint3'" if broken == "joint3" else "'joint4' lacks limit.upper"
    with pytest.raises(xacro.XacroException, match=sentence):
        expand_text(body)


def test_unknown_capsule_direction():
    body = '<link name="l"><xacro:collision_capsule radius="1" length="1" direction="w"/></link>'
    with pytest.raises(xacro.XacroException, match="direction 'w'"):
        expand_text(body)


def test_dual_panda_arguments():
    robot = expand("dual_panda/dual_panda_example", arm_id_1="l", arm_id_2="r")
    assert {"l_link0", "l_hand", "r_link0", "r_hand", "base"} <= set(robot.links)
    assert not any(n.startswith("panda") for n in robot.links)
