# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The Python interface: pages on which Sphinx writes the docstrings of modules."""

import importlib
import re
import sys
import types
import typing
from pathlib import Path

from docsite.docstrings import to_rest
from docsite.markdown import page
from docsite.packages import packages
from docsite.tree import Tree


class Module(typing.NamedTuple):
    """A module and its purpose."""

    name: str
    title: str


MODULES = (
    Module("pyfranka", "pyfranka: robots, hands and models"),
    Module("pyfranka.sim", "pyfranka.sim: simulated robots in this process"),
    Module("pyfranka.franka_sim", "pyfranka.franka_sim: the program franka_sim"),
    Module("pyfranka.pytest_plugin", "pyfranka.pytest_plugin: simulated robots in tests"),
    Module("pyfranka.gym", "pyfranka.gym: tasks for learning programs"),
    Module("pyfranka.sweeps", "pyfranka.sweep: many cases on many cores"),
    Module("pyfranka.desk", "pyfranka.desk: the robot's web interface"),
    Module("pyfranka.libfranka", "pyfranka.libfranka: under the names of pylibfranka"),
    Module("pyfranka.plot", "pyfranka.plot: plots of robots"),
    Module("pyfranka.remote", "pyfranka.remote: the operator's lines"),
    Module("pyfranka.robot_report", "pyfranka.robot_report: what the line report says"),
    Module("pyfranka.meshes", "pyfranka.meshes: how robots look"),
    Module(
        "controller_manager.controller_manager_interface",
        "controller_manager: load and start controllers",
    ),
    Module("controller_manager_msgs.utils", "controller_manager_msgs: find controllers"),
)
MAX_VALUE = 80  # characters of a constant's value that is shown (chosen here)
PROGRAM = "a program; what it answers to --help is among the command lines"
INSIDE = "a part of this project's nodes, not for others"
# Modules without a page, and why. Modules of a package with a page have none: the package offers their names.
# A module of a package that is left out may have one.
LEFT_OUT = {
    "pyfranka.franka_plot": PROGRAM,
    "pyfranka.run": PROGRAM,
    "pyfranka.command_line": INSIDE,
    "pyfranka.refusals": INSIDE,
    "controller_manager": INSIDE,
    "controller_manager_msgs": "an empty package",
    "franka_gripper": INSIDE,
    "franka_sim_mujoco": INSIDE,
    "rospy_connections": INSIDE,
}


def modules_of(folder: Path) -> list[str]:
    """The names of the modules and packages in a folder, without those that begin with _."""
    names = []
    for path in sorted(folder.rglob("*.py")):
        parts = list(path.relative_to(folder).with_suffix("").parts)
        parts = parts[:-1] if parts[-1] == "__init__" else parts
        if not any(part.startswith("_") for part in parts):
            names.append(".".join(parts))
    return names


def all_modules() -> list[str]:
    """All modules that the packages install for other programs."""
    return [
        name
        for package in packages()
        if (package.folder / "setup.py").is_file()
        for name in modules_of(package.folder / "src")
    ]


def without_page(names: list[str]) -> list[str]:
    """Those that have no page, whose package has none, and that nobody has left out with a reason."""
    listed = {each.name for each in MODULES} - {"pyfranka"}
    known = listed | set(LEFT_OUT)
    return [
        name
        for name in names
        if name != "pyfranka" and not any(name == each or name.startswith(each + ".") for each in known)
    ]


def public_names(module: types.ModuleType) -> list[str]:
    """The module's public names: __all__, or the names that it or its part in C++ defines."""
    if hasattr(module, "__all__"):
        return sorted(module.__all__)
    # pytest calls its hooks by name.
    found = []
    for name in dir(module):
        value = getattr(module, name)
        home = getattr(value, "__module__", "") or ""
        own = home == module.__name__ or (module.__name__ == "pyfranka" and home.startswith("_pyfranka"))
        if own and not name.startswith(("_", "pytest_")):
            found.append(name)
    return found


def comment_of_constant(module: types.ModuleType, name: str) -> str:
    """The comment above a constant, in this module or in the one from which it comes; or ""."""
    above = re.compile(rf"^((?:# .*\n)+){name}\b *[:=]", re.M)
    package = module.__name__.partition(".")[0]
    others = [each for key, each in sorted(sys.modules.items()) if key.partition(".")[0] == package]
    for each in (module, *others):
        file = getattr(each, "__file__", None)
        if file and vars(each).get(name) is getattr(module, name):
            # catkin's package in devel has a file that only leads to that of the sources.
            stubs = [Path(folder) / "__init__.pyi" for folder in getattr(each, "__path__", [])]
            for path in (Path(file), *stubs):
                found = above.search(path.read_text(encoding="utf-8")) if path.is_file() else None
                if found:
                    return re.sub(r"^# ", "", found[1], flags=re.M).replace("\n", " ").strip()
    return ""


def write_pages(tree: Tree) -> None:
    for each in MODULES:
        module = importlib.import_module(each.name)
        names = public_names(module)
        intro = f"```{{eval-rst}}\n.. automodule:: {each.name}\n   :no-members:\n```"
        parts = [f"```{{eval-rst}}\n{directive(each.name, module, name)}\n```" for name in names]
        body = [f"## {name}\n\n{part}" for name, part in zip(names, parts)]
        tree.write(f"reference/python/{each.name}.md", page(each.title, intro, *body))
    pages = "\n".join(each.name for each in MODULES)
    intro = "The modules with all that they offer."
    tree.write(
        "reference/python/index.md",
        page("Python interface", intro, f"```{{toctree}}\n:maxdepth: 1\n\n{pages}\n```"),
    )


def directive(module_name: str, module: types.ModuleType, name: str) -> str:
    """The directive by which Sphinx writes a name's docstring."""
    value = getattr(module, name)
    full = f"{module_name}.{name}"
    if isinstance(value, type):
        lines = [f".. autoclass:: {full}", "   :members:", "   :undoc-members:"]
        return "\n".join(lines)
    if callable(value):
        return f".. autofunction:: {full}"
    # autodata would show the docstring of the value's class.
    shown = [f"   :value: {value!r}"] if len(repr(value)) <= MAX_VALUE else []
    text = [f"   {line}" for line in to_rest([comment_of_constant(module, name)])]
    return "\n".join([f".. py:data:: {full}", *shown, "", *text])
