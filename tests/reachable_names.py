#!/usr/bin/env python3
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Prints every name that a user can reach, one a line with its kind, sorted.

`diff` of the lists before and after a change shows which names the change has removed:

    ./franka shell .venv/bin/python3 tests/reachable_names.py > before.txt

The names come from the sources, from the tables of docs/site/nodes (tests/test_docs_names.py compares these
with the sources), from the build, and from the programs' own help.
"""

import dataclasses
import importlib
import inspect
import re
import sys
import tomllib
from collections.abc import Callable, Iterator
from pathlib import Path

TOP = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(TOP / folder) for folder in ("docs/site", "packaging", "tests/support")]

import make_source  # noqa: E402
from docsite import command_lines, cpp_api, cpp_comments, descriptions, dynamic_parameters, python_api  # noqa: E402
from docsite.interfaces import KINDS  # noqa: E402
from docsite.launch_files import read_launch_file  # noqa: E402
from docsite.nodes import LISTS, nodes_of  # noqa: E402
from docsite.packages import packages  # noqa: E402
from docsite.paths import DEVEL, DOCS, WORKSPACE, files_of_repository  # noqa: E402
from docsite.plugins import plugins_of  # noqa: E402
from names_of_package import signatures  # noqa: E402

# Folders whose files other packages name: $(find PACKAGE)/config/x.yaml, or a world by its name.
SHARED_FOLDERS = ("config", "launch", "models", "python", "robots", "templates", "world", "worlds")
OPTION = re.compile(r"(?<![\w-])--?[a-zA-Z][\w-]*")
TARGET = re.compile(r"^add_library\((\S+) \w+ IMPORTED\)", re.M)
LIBRARIES = re.compile(r'^set\(libraries "(.*)"\)', re.M)
VARIABLE = re.compile(
    r"""(?:getenv\(|environ(?:\.\w+\(|\[))["']([A-Z][A-Z_]+)["']|\b(FRANKA_[A-Z][A-Z_]+)\b"""
    r"""|^[A-Z]+ = "([A-Z_]+)"$""",
    re.M,
)


# ---- ROS -------------------------------------------------------------------------------------------------


def rows_of_page(link: str) -> Iterator[tuple[str, str, str]]:
    """What the tables in a page's section name: the head of the first column, the name and the type."""
    name, _, anchor = link.partition("#")
    sections = re.split(r"^## (.+)$", (DOCS / name).read_text(encoding="utf-8"), flags=re.M)
    for heading, text in zip(sections[1::2], sections[2::2]):
        if heading.lower().replace(" ", "-") != anchor:
            continue
        head = ""
        for line in text.splitlines():
            cells = [cell.strip() for cell in line.strip("|").split("|")]
            if re.match(r"\| \w+ \|", line):
                head = cells[0]
            elif head and re.match(r"\| `[~/\w]+` \|", line):
                # A table of several kinds has them in the second column: `service, std_srvs/Trigger`.
                kind, _, type_name = cells[1].partition(", ") if head == "name" else (head, "", cells[1])
                yield kind, cells[0].strip("`"), type_name


def names_of_nodes() -> Iterator[str]:
    """Topics, services, actions and parameters of nodes, controllers and robots' hardware."""
    for package in packages():
        for node in nodes_of(package.name):
            yield f"node {package.name} {node.name}"
            for name, entry in node.parameters.items():
                yield f"parameter {node.name} {name} {entry[0]} = {entry[1]}"
            for kind, head in LISTS.items():
                for name, (type_name, _) in node.names[kind].items():
                    yield f"{head.replace(' ', '-')} {node.name} {name} {type_name}"
            for head, name, type_name in rows_of_page(node.page) if node.page else ():
                yield f"{head} {node.name} {name} {type_name}"
        for path in package.files("cfg/*.cfg"):
            for each in dynamic_parameters.read_config(path).parameters:
                yield f"dynamic-parameter {path.stem} {each.name} {each.type}"


def names_of_launch_files() -> Iterator[str]:
    """Launch files, robot descriptions and their arguments, and the other files of shared folders."""
    for package in packages():
        for path in package.files("launch/**/*.launch"):
            place = f"{package.name} {path.relative_to(package.folder)}"
            yield f"launch-file {place}"
            for each in read_launch_file(path).arguments:
                defaults = "; ".join(sorted(str(value) for _, value in each.defaults))
                yield f"launch-argument {place} {each.name} = {' '.join(defaults.split())}"
        for path in package.files("robots/**/*.urdf.xacro"):
            for name, default, _ in descriptions.read_description(path).arguments:
                yield f"xacro-argument {package.name} {path.name} {name} = {default}"
        for folder in SHARED_FOLDERS:
            for path in package.files(f"{folder}/**/*"):
                if path.is_file() and "__pycache__" not in path.parts:
                    yield f"shared-file {package.name} {path.relative_to(package.folder)}"


def names_of_types() -> Iterator[str]:
    """Messages, services and actions, with their fields."""
    for package in packages():
        for path in (path for kind in KINDS for path in package.files(f"{kind}/*.{kind}")):
            type_name = f"{path.suffix[1:]}-file {package.name}/{path.stem}"
            yield type_name
            part = 0
            for line in path.read_text(encoding="utf-8").splitlines():
                field = " ".join(line.partition("#")[0].split())
                part += field == "---"
                if field and field != "---":
                    yield f"{type_name} {part} {field}"


def names_of_plugins() -> Iterator[str]:
    for package in packages():
        yield from (f"plugin {each.name} {each.base}" for each in plugins_of(package))


# ---- programs --------------------------------------------------------------------------------------------


def names_of_programs() -> Iterator[str]:
    """Programs, their words and their options, as their help lists them."""
    found = command_lines.programs()
    for (program, word), text in command_lines.all_help(found).items():
        called = " ".join([program.package, program.name, *word.split()])
        yield f"program {called}"
        yield from (f"option {called} {option}" for option in OPTION.findall(text))
    own = command_lines.help_of(str(TOP / "franka"))
    yield from (f"option ./franka {option}" for option in OPTION.findall(own))
    yield from (f"command ./franka {word}" for word in re.findall(r"^  (\w+)\b", own, re.M))
    plugin = command_lines.help_of(sys.executable, "-m", "pytest", "-p", "pyfranka.pytest_plugin")
    yield from (f"option pytest {name}" for name in re.findall(r"(?:--|\b)franka[_-][\w-]+", plugin))


def operator_lines() -> Iterator[str]:
    """The lines of the control interface, as a simulated arm lists them."""
    from pyfranka.franka_sim import FrankaSim
    from pyfranka.sim import KINDS as ROBOTS

    for kind, robot in ROBOTS.items():
        with FrankaSim(robot(), pace="lockstep") as server:
            usages = server.robot.remote.commands()
        yield from (f"operator-line {kind} {usage}" for usage in usages)


# ---- C++, CMake and Debian -------------------------------------------------------------------------------


def names_of_cpp() -> Iterator[str]:
    """Installed headers, and the public names that are in them."""
    headers = [path for each in packages() for path in each.files("include/**/*") if path.is_file()]
    for path in headers:
        yield f"header {str(path).rpartition('/include/')[2]}"
    cpp_api.run_doxygen()
    names = cpp_comments.names_in(cpp_api.XML, {str(path.resolve().relative_to(TOP)) for path in headers})
    yield from (f"c++ {each.name}" for each in names)


def names_of_cmake() -> Iterator[str]:
    """CMake packages, their exported targets, and the libraries that catkin's packages name."""
    for file in DEVEL.glob("lib/cmake/*/*Config.cmake"):
        yield f"cmake-package {file.parent.name}"
    for file in DEVEL.glob("lib/cmake/*/*Targets.cmake"):
        yield from (f"cmake-target {target}" for target in TARGET.findall(file.read_text(encoding="utf-8")))
    for file in DEVEL.glob("share/*/cmake/*Config.cmake"):
        yield f"cmake-package {file.parents[1].name}"
        for libraries in LIBRARIES.findall(file.read_text(encoding="utf-8")):
            for library in filter(None, libraries.split(";")):
                yield f"cmake-library {file.parents[1].name} {Path(library).name}"


def names_of_debian() -> Iterator[str]:
    ours = [each.deb for each in make_source.read_packages(WORKSPACE)]
    others = (make_source.SETUP, make_source.DEVELOPMENT, make_source.SWEEPS)
    yield from (f"debian-package {name}" for name in (*ours, *others))


def names_of_environment() -> Iterator[str]:
    """Environment variables that the sources read, and CMake's variables of the same prefix."""
    for path in files_of_repository():
        place = path.relative_to(TOP)
        if {"test", "tests", "bench", "docs", "genuine"} & set(place.parts):
            continue
        if (
            path.suffix in {".cpp", ".h", ".py", ".sh", ".bash", ".cmake", ""}
            or path.name == "CMakeLists.txt"
        ):
            text = path.read_text(encoding="utf-8", errors="replace")
            yield from (f"variable {name}" for match in VARIABLE.findall(text) for name in match if name)


# ---- Python ----------------------------------------------------------------------------------------------


def call_of(name: str, value: object) -> Iterator[str]:
    """The ways in which a function is called: one in Python, and in C++ one for each overload."""
    try:
        yield re.sub(r" at 0x\w+", "", str(inspect.signature(value)))
    except (TypeError, ValueError):
        for each in signatures(name.rpartition(".")[2], inspect.getdoc(value) or ""):
            yield f"({each})"


def names_of_class(path: str, cls: type) -> Iterator[str]:
    """Public methods, properties and fields, also inherited ones, and how it is constructed."""
    yield f"python-class {path}"
    yield from (f"python-call {path}{call}" for call in call_of("__init__", cls.__init__))
    if dataclasses.is_dataclass(cls):
        yield from (f"python-field {path}.{each.name}" for each in dataclasses.fields(cls))
    for name, value in inspect.getmembers(cls):
        if name.startswith("_"):
            continue
        yield f"python-member {path}.{name}"
        if inspect.isroutine(value):
            yield from (f"python-call {path}.{name}{call}" for call in call_of(name, value))


def names_of_python() -> Iterator[str]:
    """Modules, and what those with a page in the reference offer."""
    yield from (f"python-module {name}" for name in python_api.all_modules())
    for listed in python_api.MODULES:
        module = importlib.import_module(listed.name)
        for name in python_api.public_names(module):
            path, value = f"{listed.name}.{name}", getattr(module, name)
            if isinstance(value, type):
                yield from names_of_class(path, value)
            elif callable(value):
                yield f"python-function {path}"
                yield from (f"python-call {path}{call}" for call in call_of(name, value))
            else:
                yield f"python-value {path}"
    project = tomllib.loads((TOP / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    yield from (f"wheel-program {name}" for name in project["scripts"])
    yield from (f"wheel-extra {name}" for name in project["optional-dependencies"])
    yield from (f"wheel-entry {group}" for group in project.get("entry-points", {}))


def names_of_ros_packages() -> Iterator[str]:
    yield from (f"ros-package {package.name}" for package in packages())


SOURCES: tuple[Callable[[], Iterator[str]], ...] = (
    names_of_cmake,
    names_of_cpp,
    names_of_debian,
    names_of_environment,
    names_of_launch_files,
    names_of_nodes,
    names_of_plugins,
    names_of_programs,
    names_of_python,
    names_of_ros_packages,
    names_of_types,
    operator_lines,
)


def reachable_names() -> list[str]:
    return sorted({line for source in SOURCES for line in source()})


if __name__ == "__main__":
    print("\n".join(reachable_names()))
