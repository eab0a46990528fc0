# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Topics, services, actions and parameters: the site's tables (docs/site/nodes) have those of each node's
sources, and no others."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

import pytest
import ros_names
from docsite.nodes import LISTS, Node, interface_file, nodes_of
from docsite.packages import packages
from docsite.paths import DOCS, SITE, WORKSPACE
from docsite.plugins import plugins_of
from ros_names import Found, is_same

# A few words; less does not describe anything.
MIN_LENGTH = 8
PACKAGES = {package.name: package for package in packages()}
DESCRIBED = sorted(path.stem for path in (SITE / "nodes").glob("*.yaml"))
ROBOTS = [
    name for name in PACKAGES if name.startswith("franka_") and name not in ("franka_sim", "franka_msgs")
]
# How sources read parameters with helpers of their own: the literal, or the beginning of a composed name.
READS = re.compile(
    r"(?:[pP]aram|getParamCached|get_param|read[A-Z]\w*|hasParam|searchParam|require|required|number)(?:<[^>]*>)?\("
    r'(?:\s*(?:k\w+|\w*nh\w*|node|node_handle|leader|follower|controller_nh|root_nh),)*\s*"([\w~/]+)"'
)
# Strings in calls with a node handle that do not name anything on the graph.
NO_NAMES = {
    "Robot",  # of a task in /diagnostics
    "Control loop",
    "franka_control",  # a namespace
    "controller_manager",
    "nominal",  # parts of names
    "acceleration",
    "name",  # of an entry of a list
}
# Files that no node has: the names are those of their callers.
OF_ALL = {
    "franka_hw/include/franka_hw/services.h",
    "franka_sim_mujoco/src/service_handlers.h",
    "franka_sim_mujoco/src/service_handlers.cpp",
    "franka_sim_mujoco/src/param_reader.cpp",
}
# Names that are composed: the expression of a call, and the names that it has.
COMPOSED = {
    "franka_control/src/state_publisher.cpp": {"topic": {"franka_states"}},
    "franka_control/src/franka_state_controller.cpp": {
        f"{name}_publisher_": {topic}
        for name, topic in (
            ("transforms", "/tf"),
            ("external_wrench", "F_ext"),
            ("joint_states", "joint_states"),
            ("joint_states_desired", "joint_states_desired"),
        )
    },
    "franka_hw/src/services.cpp": {"node_handle": {"set_load", "set_EE_frame"}},
    "franka_sim_mujoco/src/arm_services.cpp": {
        "name": {"franka_control/set_load", "franka_control/set_EE_frame"}
    },
    "franka_sim_mujoco/src/camera_publisher.cpp": {
        f'topic + "{name}"': {f"/CAMERA{name}"}
        for name in ("/image_raw", "/camera_info", "/depth/image_raw", "/depth/camera_info")
    },
    "franka_sim_mujoco/src/picture_service.cpp": {"options": {"render_picture"}},
}
HEADS = {"parameter": "parameters", "service": "services", "action": "actions", "topic": "publishes"}


def files_of(package: str, node: Node) -> list[Path]:
    """The sources that the table names."""
    folder = PACKAGES[package].folder
    found = [path.resolve() for pattern in node.sources for path in folder.glob(pattern)]
    lost = [pattern for pattern in node.sources if not list(folder.glob(pattern))]
    assert not lost, f"{node.name}: no {lost}"
    return found


def place(path: Path) -> str:
    return str(path.relative_to(WORKSPACE.resolve()))


def on_the_page(link: str) -> dict[str, set[str]]:
    """The names in the tables of a page's section, by kind."""
    page, _, anchor = link.partition("#")
    text = (DOCS / page).read_text()
    headings = re.findall(r"^## (.+)$", text, re.M)
    (heading,) = [each for each in headings if each.lower().replace(" ", "-") == anchor]
    section = re.search(rf"^## {re.escape(heading)}\n(.*?)(?=^## |\Z)", text, re.M | re.S)[1]
    names: dict[str, set[str]] = {}
    for table in re.findall(r"(?:^\|.*\n)+", section, re.M):
        head = table.split("|")[1].strip()
        for name, second in re.findall(r"^\| `([~/\w]+)` \| ([^|]*) \|", table, re.M):
            kind = HEADS.get(head) or HEADS.get(second.partition(",")[0], "")
            names.setdefault(kind, set()).add(name)
    return names


@cache
def table_of(package: str, name: str) -> dict[str, set[str]]:
    """The names that the reference has of a node, by kind."""
    (node,) = [each for each in nodes_of(package) if each.name == name]
    names = {kind: set(node.names[kind]) for kind in LISTS} | {"parameters": set(node.parameters)}
    if node.page:
        for kind, more in on_the_page(node.page).items():
            names.setdefault(kind, set()).update(more)
    return names


def is_described(found: Found, tables: list[dict[str, set[str]]]) -> bool:
    """Whether one of the tables has the name, in the list of its kind."""
    for table in tables:
        kinds = [found.kind] if found.kind else list(table)
        names = {name for kind in kinds for name in table.get(kind, set())}
        beginning = found.name.strip("~/")
        if any(is_same(found.name, name) for name in names):
            return True
        # Of a composed name the source has the beginning.
        if not found.kind and any(beginning and f"/{beginning}" in f"/{name.strip('~/')}" for name in names):
            return beginning.endswith(("_", "/"))
    return False


def names_in(path: Path) -> set[Found]:
    """What a source has on the graph and reads as parameters."""
    text = path.read_text(errors="replace")
    found = {each for each in ros_names.names_in(path) if each.name.strip("~/") not in NO_NAMES}
    if path.suffix in (".cpp", ".h"):
        reads = READS.findall(ros_names.without_comments(text))
        found |= {Found("", name) for name in reads if name.strip("~/") not in NO_NAMES | {""}}
        for expression in ros_names.composed_in_cpp(text):
            names = COMPOSED.get(place(path), {}).get(expression)
            if names is None and place(path) not in OF_ALL:
                raise AssertionError(f"{place(path)}: what are the names of {expression}? See COMPOSED.")
            found |= {Found("", name) for name in names or ()}
    return found


@cache
def tables_by_file() -> dict[Path, list[dict[str, set[str]]]]:
    """For each source the tables of the nodes that have it."""
    found: dict[Path, list[dict[str, set[str]]]] = {}
    for package in DESCRIBED:
        for node in nodes_of(package):
            for path in files_of(package, node):
                found.setdefault(path, []).append(table_of(package, node.name))
    return found


def sources_of(package: str) -> list[Path]:
    patterns = ("src/**/*.cpp", "src/**/*.py", "include/**/*.h", "scripts/*")
    files = {
        path.resolve() for pattern in patterns for path in PACKAGES[package].files(pattern) if path.is_file()
    }
    return sorted(path for path in files if path.suffix in (".cpp", ".h", ".py", ""))


def missing(path: Path, tables: list[dict[str, set[str]]]) -> list[str]:
    """Names of a source that none of the tables has."""
    return sorted({each.name for each in names_in(path) if not is_described(each, tables)})


@pytest.mark.parametrize("package", sorted({*DESCRIBED, *ROBOTS}))
def test_names_of_the_sources_are_in_the_table_of_their_node(package):
    wrong = {}
    for path in sources_of(package):
        if place(path) in OF_ALL or not names_in(path):
            continue
        tables = tables_by_file().get(path, [])
        absent = missing(path, tables) if tables else ["no node has this source"]
        if absent:
            wrong[place(path)] = absent
    assert not wrong


def source(package: str, name: str) -> Path:
    return (PACKAGES[package].folder / name).resolve()


@pytest.mark.parametrize(
    ("kind", "name", "file"),
    [
        ("publishes", "~markers", "src/marker_publisher.cpp"),
        ("services", "~step", "src/sim_services.cpp"),
    ],
)
def test_a_name_that_a_table_lacks_is_found(kind, name, file):
    whole, path = table_of("franka_sim_mujoco", "franka_sim_mujoco_node"), source("franka_sim_mujoco", file)
    assert [each.strip("~/") for each in missing(path, [whole | {kind: whole[kind] - {name}}])] == [
        name.strip("~/")
    ]


def test_a_name_of_another_node_or_of_another_kind_does_not_count():
    markers = source("franka_sim_mujoco", "src/marker_publisher.cpp")
    other = {"publishes": {"contacts"}, "services": {"markers"}}
    assert missing(markers, [other]) == ["markers"]
    gripper = source("franka_sim_mujoco", "src/gripper_actions.cpp")
    assert "grasp" in missing(gripper, [table_of("franka_sim_mujoco", "franka_sim_mujoco/FrankaHWSim")])


def test_a_name_that_is_composed_in_a_new_way_is_found():
    text = 'publisher_ = node.advertise<std_msgs::Bool>(prefix + "x", 1);  // node.advertise(other, 1)'
    assert ros_names.composed_in_cpp(text) == {'prefix + "x"'}
    assert not ros_names.composed_in_cpp("void advertise(const ros::NodeHandle& n);")


# ---- names of tables that no source has ------------------------------------------------------------------

LITERAL = re.compile(r"[\"']([\w~/ .{}]*)[\"']")
# Topics of libraries that sources use: robot_state_publisher's.
OF_LIBRARIES = {"robot of the simulation": {"/tf"}}
# Sources whose strings other nodes use, too.
SHARED = ("franka_hw", "control_toolbox", "rospy_connections")


def is_used(name: str, literals: set[str]) -> bool:
    """Whether the last fixed part of a name is a literal, or is composed of one."""
    last = [part for part in name.split("/") if part not in ros_names.VARIABLE][-1].lstrip("~")
    ends = {literal.strip("~/").rsplit("/", 1)[-1] for literal in literals}
    return last in ends or any(end.endswith("_") and last.startswith(end) for end in ends if len(end) > 3)


def gone(package: str, node: Node, names: set[str]) -> list[str]:
    """Names that neither the node's sources have nor the packages that it builds on."""
    files = {*files_of(package, node), *(path for each in SHARED for path in sources_of(each))}
    literals = {each for path in files for each in LITERAL.findall(path.read_text(errors="replace"))}
    literals |= {each.name for path in files for each in ros_names.names_in(path)}
    names = names - OF_LIBRARIES.get(node.name, set())
    return sorted(name for name in names if not is_used(name, literals))


def nodes_with_tables() -> list[tuple[str, Node]]:
    return [(package, node) for package in DESCRIBED for node in nodes_of(package) if node.sources]


@pytest.mark.parametrize(
    ("package", "node"), nodes_with_tables(), ids=lambda value: getattr(value, "name", value)
)
def test_names_of_the_reference_are_in_the_sources(package, node):
    names = {name for kind in LISTS for name in node.names[kind]} | set(node.parameters)
    assert not gone(package, node, names)


@pytest.mark.parametrize("page", sorted({node.page for _, node in nodes_with_tables() if node.page}))
def test_parameters_of_the_pages_are_in_the_sources(page):
    names = on_the_page(page).get("parameters", set())
    nodes = [(package, node) for package, node in nodes_with_tables() if node.page == page]
    assert not set.intersection(*(set(gone(package, node, names)) for package, node in nodes))


def test_a_name_that_no_source_has_is_found():
    (node,) = [
        each for each in nodes_of("franka_visualization") if each.name == "robot_joint_state_publisher"
    ]
    assert gone("franka_visualization", node, {"~publish_rate", "~robot_ip", "~publish_rat"}) == [
        "~publish_rat"
    ]


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
