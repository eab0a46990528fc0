# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Every launch file of the tree, read by roslaunch as for a real robot; nothing is started.

It can be read, also with each of its switches inverted; the programs that it starts exist; rviz shows the
right arm; and no name of another arm is left.
"""

import functools
import re
import shlex
from pathlib import Path
from xml.etree import ElementTree

import pytest
import yaml
from rosgraph.names import ns_join, resolve_name
from roslaunch.config import ROSLaunchConfig, load_config_default
from roslaunch.core import RLException
from roslaunch.xmlloader import XmlLoader
from roslib.packages import find_node

TOP = Path(__file__).resolve().parent.parent
SOURCE = TOP / "catkin_ws" / "src"
FILES = {f"{path.parent.parent.name}/{path.name}": path for path in SOURCE.glob("**/launch/**/*.launch")}

# Required arguments of launch files, with values: add those of new launch files here.
REQUIRED = {
    "robot": "panda",
    "robot_ip": "10.0.0.1",
    "robot_ips": "{panda_1/robot_ip: 10.0.0.1, panda_2/robot_ip: 10.0.0.2}",
    "leader_ip": "10.0.0.1",
    "follower_ip": "10.0.0.2",
}
KINDS = ("robot", "robot_type")  # arguments that may be panda or fr3
# Nodes that end without their robot, and with them the launch.
CONTROL_NODES = {"franka_control_node", "franka_combined_control_node", "robot_joint_state_publisher"}
CALLS = ["plain", "other"]  # of a Panda; of an FR3 with another name in a namespace
MARKERS = {  # nodes, and the names of the markers that they serve
    "interactive_marker.py": "equilibrium_pose_marker",
    "dual_arm_interactive_marker.py": "target_pose_marker",
}


class Reader(XmlLoader):
    """Calls xacro once per command line, or leaves robot descriptions empty."""

    answers: dict[str, str] = {}

    def __init__(self, with_descriptions: bool = True):
        super().__init__(resolve_anon=False)
        self._with_descriptions = with_descriptions

    def param_value(self, verbose, name, ptype, value, textfile, binfile, command):
        ask = super().param_value
        if command is None:
            return ask(verbose, name, ptype, value, textfile, binfile, command)
        if not self._with_descriptions:
            return "<robot/>"
        line = " ".join(command.split())
        if line not in self.answers:
            self.answers[line] = ask(verbose, name, ptype, value, textfile, binfile, command)
        return self.answers[line]


def read(path: Path, given: list[str], loader: XmlLoader) -> ROSLaunchConfig:
    return load_config_default([(str(path), given)], None, loader=loader, assign_machines=False)


@functools.cache
def needed(path: Path) -> tuple[str, ...]:
    """The required arguments of a launch file and of the files that it includes."""
    given = []
    while True:
        try:
            read(path, given, Reader(with_descriptions=False))
            return tuple(given)
        except RLException as error:
            missing = re.search(r"(?:requires the|arg) '(\w+)' (?:arg to be set|is not defined)", str(error))
            argument = f"{missing[1]}:={REQUIRED.get(missing[1])}" if missing else ""
            if not missing or missing[1] not in REQUIRED or argument in given:
                raise
            given.append(argument)


@functools.cache
def declared(path: Path) -> dict[str, str | None]:
    """A launch file's own arguments and their defaults; None for a required one."""
    loader = XmlLoader(resolve_anon=False, args_only=True)
    read(path, list(needed(path)), loader)
    values = loader.root_context.resolve_dict.get("arg_doc", {})
    return {name: default for name, (_, default) in values.items()}


@functools.cache
def is_there(package: str, node: str) -> bool:
    return bool(find_node(package, node))


def check_nodes(config: ROSLaunchConfig) -> None:
    assert not config.config_errors
    for node in config.nodes:
        assert is_there(node.package, node.type), f"{node.package} has no node {node.type}"
        assert node.required or node.type not in CONTROL_NODES, f"{node.type} is not required"


def name_for(node, name: str) -> str:
    """A node's name resolved with its namespace and its remappings."""
    place = ns_join(node.namespace, node.name)
    remaps = {resolve_name(a, place): resolve_name(b, place) for a, b in node.remap_args}
    name = resolve_name(name, place)
    return remaps.get(name, name)


def check_rviz(config: ROSLaunchConfig) -> int:
    """Rviz's configuration exists: the frame in its robot, markers in the namespace of their node."""
    found = [node for node in config.nodes if node.type == "rviz"]
    for node in found:
        words = shlex.split(node.args)
        options = dict(zip(words[::2], words[1::2]))
        assert "-f" in options, "rviz gets no fixed frame: it would use the file's for any arm."
        description = config.params[name_for(node, "robot_description")].value
        assert options["-f"] in {
            link.get("name") for link in ElementTree.fromstring(description).iter("link")
        }
        displays = yaml.safe_load(Path(options["-d"]).read_text())["Visualization Manager"]["Displays"]
        shown = {name_for(node, display["Update Topic"]) for display in displays if "Update Topic" in display}
        for other in config.nodes:
            if other.type in MARKERS:
                assert ns_join(other.namespace, f"{MARKERS[other.type]}/update") in shown
    return len(found)


def check_names(config: ROSLaunchConfig) -> None:
    """With another arm's name nothing is called panda, except the pair of two arms."""
    values = {name: param.value for name, param in config.params.items()}
    values.update({f"node {node.name}": node.args for node in config.nodes})
    of_others = re.compile("description|/dual_arm_|/robot_type$")
    offending = {key: value for key, value in values.items() if re.search(r"\bpanda", f"{key} {value}")}
    assert not [key for key in offending if not of_others.search(key)]


@pytest.mark.parametrize("call", CALLS)
@pytest.mark.parametrize("name", sorted(FILES))
def test_launch_file_is_valid_for_a_real_robot(name, call):
    path = FILES[name]
    arguments = declared(path)
    given = [*needed(path), "rviz:=true", "interactive_marker:=true"]
    if call == "other":
        given += [f"{kind}:=fr3" for kind in KINDS if arguments.get(kind, "") in ("panda", None)]
        given += ["__ns:=left", *(["arm_id:=other"] if "arm_id" in arguments else [])]
    config = read(path, given, Reader())
    check_nodes(config)
    if "rviz" in arguments:
        assert check_rviz(config) == 1
    if "arm_id:=other" in given:
        check_names(config)


@pytest.mark.parametrize("name", sorted(FILES))
def test_launch_file_is_valid_with_every_switch_inverted(name):
    path = FILES[name]
    switches = {argument: str(default).lower() for argument, default in declared(path).items()}
    turned = {"true": "false", "false": "true"}
    calls = [f"{switch}:={turned[now]}" for switch, now in switches.items() if now in turned]
    for given in [*calls, "sim:=true"]:  # a switch of nearly all, often of an included file
        check_nodes(read(path, [*needed(path), given], Reader(with_descriptions=False)))


@pytest.mark.parametrize("robot, reflexes", [("panda", True), ("fr3", False)])
def test_robot_type_and_reflexes_are_passed_to_the_simulation(robot, reflexes):
    for name, own in (("robot", [f"robot:={robot}", "arm_id:=other"]), (robot, [])):
        given = [f"reflexes:={str(reflexes).lower()}", *own]
        config = read(FILES[f"franka_gazebo/{name}.launch"], given, Reader(with_descriptions=False))
        assert config.params["/robot_type"].value == robot
        assert config.params["/reflexes"].value is reflexes


@pytest.mark.parametrize("name", ["franka_control.launch", "franka_combined_control.launch"])
def test_a_simulated_robot_gets_patience_and_wait_if_they_are_given(name):
    def options(*given: str) -> str:
        loader = Reader(with_descriptions=False)
        config = read(FILES[f"franka_control/{name}"], ["sim:=true", *given], loader)
        (robot,) = [node for node in config.nodes if node.name.startswith("simulated_robot")]
        return robot.args

    assert "--patience" not in options() and "--wait" not in options()
    both = options("patience:=forever", "wait:=block")
    assert "--patience forever" in both and "--wait block" in both
    assert "--patience 0.5" in options("patience:=0.5")


def test_the_rate_of_states_can_be_set(tmp_path):
    """By the line of docs/how_to/recording.md, behind the line that includes a robot."""
    line = (TOP / "docs/how_to/recording.md").read_text().split("```xml\n")[1].split("```")[0]
    for package, name in (("franka_control", "franka_control"), ("franka_gazebo", "panda")):
        include = f'<include file="$(find {package})/launch/{name}.launch" pass_all_args="true"/>'
        arg = '<arg name="robot_ip" value="10.0.0.1"/>'
        launch = tmp_path / f"{name}.launch"
        launch.write_text(f"<launch>{arg}{include}{line}</launch>")
        config = read(launch, [], Reader(with_descriptions=False))
        assert config.params["/franka_state_controller/publish_rate"].value == 1000


def test_an_arm_without_its_hand_keeps_running():
    name = "franka_control/franka_control.launch"
    config = read(FILES[name], ["robot_ip:=10.0.0.1"], Reader(with_descriptions=False))
    (hand,) = [node for node in config.nodes if node.type == "franka_gripper_node"]
    assert not hand.required


def test_paths_may_contain_spaces():
    bare = {
        name
        for name, path in FILES.items()
        for element in ElementTree.parse(path).iter()
        for words in (element.get("args", ""), element.get("command", ""))
        if re.search(r"(?<!')\$\(find ", words)
    }
    assert not bare
    given = ["robot_ip:=10.0.0.1", "sim:=true", "world:=/a b/stone.sdf"]
    config = read(FILES["franka_control/franka_control.launch"], given, Reader(with_descriptions=False))
    (simulation,) = [shlex.split(node.args) for node in config.nodes if node.type == "franka_sim"]
    assert simulation[simulation.index("--world") + 1] == "/a b/stone.sdf"
