# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Elements for controllers and the simulation that only gazebo:=true adds."""

from xml.etree import ElementTree

import pytest
from description_robot import expand, expand_text

JOINT_INTERFACES = ["Position", "Velocity", "Effort"]


def transmissions(robot):
    return [(t.get("name"), t.find("type").text, t) for t in robot.xml.findall("transmission")]


@pytest.mark.parametrize("name, hand", [("panda", "true"), ("fr3", "false")])
def test_no_transmissions_on_the_real_robot(name, hand):
    robot = expand(f"{name}/{name}", hand=hand)
    assert transmissions(robot) == []
    assert robot.xml.find("gazebo") is None


def test_joint_transmissions():
    robot = expand("panda/panda", gazebo="true", arm_id="a")
    simple = [t for n, kind, t in transmissions(robot) if kind.endswith("SimpleTransmission")]
    expected = [(f"a_joint{i}", kind) for i in range(1, 8) for kind in JOINT_INTERFACES]
    assert len(simple) == len(expected)
    for transmission, (joint, kind) in zip(simple, expected, strict=True):
        interface = f"hardware_interface/{kind}JointInterface"
        assert transmission.get("name") == f"{joint}_transmission"
        assert transmission.find("type").text == "transmission_interface/SimpleTransmission"
        assert transmission.find("joint").get("name") == joint
        assert transmission.find("joint/hardwareInterface").text == interface
        assert transmission.find("actuator").get("name") == f"{joint}_motor"
        assert transmission.find("actuator/hardwareInterface").text == interface
    feedback = [g for g in robot.xml.findall("gazebo") if g.find("provideFeedback") is not None]
    assert {g.get("reference") for g in feedback} == {f"a_joint{i}" for i in range(1, 8)}
    assert {g.find("provideFeedback").text for g in feedback} == {"true"}


def test_franka_state():
    robot = expand("fr3/fr3", gazebo="true", arm_id="a")
    (state,) = [t for n, _, t in transmissions(robot) if n == "a_franka_state"]
    interface = "franka_hw/FrankaStateInterface"
    assert state.find("type").text == interface
    assert [j.get("name") for j in state.findall("joint")] == [f"a_joint{i}" for i in range(1, 8)]
    assert [m.get("name") for m in state.findall("actuator")] == [f"a_motor{i}" for i in range(1, 8)]
    assert {h.text for h in state.iter("hardwareInterface")} == {interface}
    assert len(list(state.iter("hardwareInterface"))) == 14


def test_franka_model():
    robot = expand("panda/panda", gazebo="true", arm_id="a")
    (model,) = [t for n, _, t in transmissions(robot) if n == "a_franka_model"]
    interface = "franka_hw/FrankaModelInterface"
    assert model.find("type").text == interface
    roles = [(j.get("name"), j.find("role").text) for j in model.findall("joint")]
    assert roles == [("a_joint1", "root"), ("a_joint8", "tip")]
    motors = [m.get("name") for m in model.findall("actuator")]
    assert motors == ["a_joint1_motor_root", "a_joint8_motor_tip"]
    assert {h.text for h in model.iter("hardwareInterface")} == {interface}
    assert {"a_joint1", "a_joint8"} <= set(robot.joints)


def test_macro_defaults():
    robot = expand_text("<xacro:transmission-franka-state/><xacro:transmission-franka-model/>")
    state, model = robot.xml.findall("transmission")
    assert state.get("name") == "panda_franka_state"
    assert [j.get("name") for j in model.findall("joint")] == ["panda_joint1", "panda_joint7"]


def test_joint_macro_default_is_effort():
    robot = expand_text('<xacro:gazebo-joint joint="j"/>')
    interface = robot.xml.find("transmission/joint/hardwareInterface").text
    assert interface == "hardware_interface/EffortJointInterface"


def test_hand():
    robot = expand("fr3/fr3", gazebo="true", hand="true", arm_id="a")
    for number in (1, 2):
        joint = f"a_finger_joint{number}"
        (found,) = [t for n, _, t in transmissions(robot) if n == f"{joint}_transmission"]
        assert found.find("joint").get("name") == joint
        assert {h.text for h in found.iter("hardwareInterface")} == {
            "hardware_interface/EffortJointInterface"
        }
    for side in ("left", "right"):
        (friction,) = robot.xml.findall(f"gazebo[@reference='a_{side}finger']")
        assert friction.find("collision/max_contacts").text == "10"
        surface = friction.find("collision/surface")
        assert surface.find("contact/ode/max_vel").text == "0"
        assert surface.find("contact/ode/min_depth").text == "0.001"
        assert surface.find("friction/ode/mu").text == "1.13"
        assert surface.find("friction/ode/mu2").text == "1.13"
        assert len(surface.find("bounce")) == 0


def test_plugin():
    robot = expand("fr3/fr3", gazebo="true")
    (block,) = [g for g in robot.xml.findall("gazebo") if not g.get("reference")]
    plugin = block.find("plugin")
    assert plugin.attrib == {"name": "gazebo_ros_control", "filename": "libgazebo_ros_control.so"}
    assert {e.tag: e.text for e in plugin} == {
        "controlPeriod": "0.001",
        "robotSimType": "franka_gazebo/FrankaHWSim",
    }
    assert block.find("self_collide").text == "true"


@pytest.mark.parametrize("name", ["panda", "fr3"])
def test_gazebo_changes_nothing_else(name):
    """Kinematics, limits and visuals match the real robot's description."""
    real = expand(f"{name}/{name}", hand="true")
    simulated = expand(f"{name}/{name}", hand="true", gazebo="true")
    assert set(simulated.joints) - set(real.joints) == {"world_joint"}
    for joint, element in real.joints.items():
        assert text(element) == text(simulated.joints[joint])
    for link, element in real.links.items():
        looks = [text(visual) for visual in element.findall("visual")]
        assert looks == [text(visual) for visual in simulated.links[link].findall("visual")]


def text(element):
    return ElementTree.tostring(element).strip()
