# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Topics, services, actions and parameters: the site's tables (docs/site/nodes) have those of each node's
sources, and no others. Names are compared by their last parts, as namespaces are known at run time only."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

import pytest
from docsite.nodes import LISTS, Node, interface_file, nodes_of
from docsite.packages import packages
from docsite.paths import DOCS, SITE
from docsite.plugins import plugins_of

# A few words; less does not describe anything.
MIN_LENGTH = 8
PACKAGES = {package.name: package for package in packages()}
DESCRIBED = sorted(path.stem for path in (SITE / "nodes").glob("*.yaml"))
ROBOTS = [
    name for name in PACKAGES if name.startswith("franka_") and name not in ("franka_sim", "franka_msgs")
]
HANDLE = r"\*?[\w.>-]*(?:node|nh|handle|leader|follower)\w*"
TEMPLATE = r'(?:<[^;(){}"]*>)?>?'
NAME = r'f?"([~\w/]+)"'
# Calls, in C++ and Python, with a string that is a name on the graph or of a parameter.
CALLS = [
    re.compile(
        r"\b(?:advertise(?:Service)?|subscribe|param|getParam(?:Cached)?|get_param|has_param|hasParam|create"
        r"|searchParam|read[A-Z]\w*|require|required|offer\w*|Publisher|Subscriber|wait_for_message|Service"
        rf"|ServiceProxy|(?:Simple)?Action(?:Server|Client)|Server){TEMPLATE}\(\s*(?:{HANDLE},\s*|k\w+,\s*)*{NAME}"
    ),
    # With a node handle.
    re.compile(
        rf"\b(?!NodeHandle|takeHandle|getHandle)\w+{TEMPLATE}\(\s*(?:\w+,\s*)?"
        rf"(?:{HANDLE}|ros::NodeHandle\([^()]*\))\s*,\s*{NAME}"
    ),
]
LITERAL = re.compile(r"[\"']([\w~/ .{}]*)[\"']")
# Parts of described names that are different for each robot.
VARIABLE = re.compile("JOINT|ARM|CAMERA|ROBOT|CONTROLLER")
# Sources whose strings other nodes use, too.
SHARED = ("franka_hw", "control_toolbox", "rospy_connections")
# Topics of libraries that sources use: robot_state_publisher's, and those of an interactive marker's server.
OF_LIBRARIES = {"tf", "feedback", "update", "update_full"}
# Strings in such calls that are parts of names, or tasks of diagnostics.
NO_NAMES = {"acceleration", "nominal", "Robot"}


def parts_of(name: str) -> list[str]:
    """Those that are the same for each robot."""
    parts = [VARIABLE.sub("", part).strip("~_") for part in name.strip("~/").split("/")]
    return [part for part in parts if part]


def last_part(name: str) -> str:
    return (parts_of(name) or [""])[-1]


def files_of(package: str, node: Node) -> list[Path]:
    """The sources that the table names."""
    folder = PACKAGES[package].folder
    lost = [pattern for pattern in node.sources if not list(folder.glob(pattern))]
    assert not lost, f"{node.name}: no {lost}"
    return [path.resolve() for pattern in node.sources for path in folder.glob(pattern)]


def on_the_page(link: str) -> set[str]:
    """The names in the tables of a page's section."""
    page, _, anchor = link.partition("#")
    sections = re.split(r"^## (.+)$", (DOCS / page).read_text(encoding="utf-8"), flags=re.M)
    (text,) = [
        text
        for heading, text in zip(sections[1::2], sections[2::2], strict=True)
        if heading.lower().replace(" ", "-") == anchor
    ]
    return set(re.findall(r"^\| `([~/\w]+)` \|", text, re.M))


@cache
def table_of(package: str, name: str) -> frozenset[str]:
    """The parts of all names that the reference has of a node."""
    (node,) = [each for each in nodes_of(package) if each.name == name]
    names = {*node.parameters, *(name for kind in LISTS for name in node.names[kind])}
    names |= on_the_page(node.page) if node.page else set()
    return frozenset(part for name in names for part in parts_of(name))


def sources_of(package: str) -> list[Path]:
    patterns = ("src/**/*.cpp", "src/**/*.py", "include/**/*.h", "scripts/*")
    files = {
        path.resolve() for pattern in patterns for path in PACKAGES[package].files(pattern) if path.is_file()
    }
    return sorted(path for path in files if path.suffix in (".cpp", ".h", ".py", ""))


def names_in(path: Path) -> set[str]:
    """What a source has on the graph and reads as parameters."""
    text = re.sub(r"(?m)(^|\s)//.*$", "", path.read_text(encoding="utf-8", errors="replace"))
    return {last_part(name) for call in CALLS for name in call.findall(text)} - NO_NAMES - {""}


@cache
def names_by_file() -> dict[Path, set[str]]:
    """For each source the names in the tables of the nodes that have it."""
    found: dict[Path, set[str]] = {}
    for package in DESCRIBED:
        for node in nodes_of(package):
            for path in files_of(package, node):
                found.setdefault(path, set()).update(table_of(package, node.name))
    return found


def missing(path: Path, described: set[str]) -> set[str]:
    """Names of a source that are not described, nor the beginning of one that is."""
    return {name for name in names_in(path) if not any(each.startswith(name) for each in described)}


@pytest.mark.parametrize("package", sorted({*DESCRIBED, *ROBOTS}))
def test_names_of_the_sources_are_in_the_table_of_their_node(package):
    described = names_by_file()
    wrong = {path.name: missing(path, described.get(path, set())) for path in sources_of(package)}
    assert not {name: absent for name, absent in wrong.items() if absent}


def test_a_name_that_a_table_lacks_is_found():
    source = (PACKAGES["franka_sim_mujoco"].folder / "src/sim_services.cpp").resolve()
    assert missing(source, names_by_file()[source] - {"step"}) == {"step"}


# ---- names of tables that no source has ------------------------------------------------------------------


def gone(package: str, node: Node, names: set[str]) -> list[str]:
    """Names that neither the node's sources have nor the packages that it builds on."""
    files = {*files_of(package, node), *(path for each in SHARED for path in sources_of(each))}
    literals = {
        last_part(each)
        for path in files
        for each in LITERAL.findall(path.read_text(encoding="utf-8", errors="replace"))
    }
    names = {last_part(name) for name in names} - OF_LIBRARIES
    return sorted(
        name
        for name in names - literals
        if not any(len(each) > 3 and name.startswith(f"{each}_") for each in literals)
    )


NODES = [(package, node) for package in DESCRIBED for node in nodes_of(package) if node.sources]


@pytest.mark.parametrize(("package", "node"), NODES, ids=lambda value: getattr(value, "name", value))
def test_names_of_the_reference_are_in_the_sources(package, node):
    names = {name for kind in LISTS for name in node.names[kind]} | set(node.parameters)
    assert not gone(package, node, names)


def test_a_name_that_no_source_has_is_found():
    (node,) = [
        each for each in nodes_of("franka_visualization") if each.name == "robot_joint_state_publisher"
    ]
    assert gone("franka_visualization", node, {"~publish_rate", "~publish_rat"}) == ["publish_rat"]


# ---- the tables ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("package", DESCRIBED)
def test_types_of_the_reference_exist(package):
    wrong = []
    for node in nodes_of(package):
        for kind in LISTS:
            for type_name, meaning in node.names[kind].values():
                own = type_name.partition("/")[0] in PACKAGES
                if own and interface_file(type_name) is None:
                    wrong.append(type_name)
                if not own and len(meaning) < MIN_LENGTH:
                    wrong.append(f"{type_name}: no meaning")
        wrong += [
            name for name, entry in node.parameters.items() if len(entry) != 3 or len(entry[2]) < MIN_LENGTH
        ]
    assert not wrong


def test_every_controller_and_node_of_the_robots_is_in_the_reference():
    described = {node.name for name in DESCRIBED for node in nodes_of(name)}
    plugins = {each.name for name in ROBOTS if name != "franka_gazebo" for each in plugins_of(PACKAGES[name])}
    assert not plugins - described
    starts_a_node = re.compile(r"ros::init\(|init_node\(|from franka_sim_mujoco.spawn import")
    programs = {"franka_sim", "franka_desk"}
    for name in ROBOTS:
        for path in [*PACKAGES[name].files("src/*.cpp"), *PACKAGES[name].files("scripts/*")]:
            if path.is_file() and starts_a_node.search(path.read_text(errors="replace")):
                programs.add(path.name.removesuffix(".cpp"))
    assert {"pick_and_place", "spawn_robot", "franka_control_node", "interactive_marker.py"} <= programs
    assert not programs - described
