# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Names of topics, services, actions and parameters in the sources of nodes, in C++ and Python.

C++ is searched for calls with a string: on a node handle, with a node handle as argument, or of a function
that offers a topic or a service. Python is parsed. `*` in a name stands for a part that is composed at run
time.
"""

from __future__ import annotations

import ast
import fnmatch
import re
import typing
from pathlib import Path

# A node handle by the names that our sources give it.
HANDLE = r"[\w.>-]*(?:node|nh|handle|leader|follower)\w*"
TEMPLATE = r"(?:<[^;(){}]*>)?"
NAME = r'"([~\w/]+)"'
PATTERNS = [
    re.compile(rf"\b{HANDLE}(?:\.|->)(\w+){TEMPLATE}\(\s*{NAME}"),
    re.compile(rf"\b(\w+){TEMPLATE}\(\s*(?:\w+,\s*)?\*?(?:{HANDLE}|ros::NodeHandle\([^()]*\))\s*,\s*{NAME}"),
    re.compile(rf"\b(advertise|subscribe|offer\w*|create|Server){TEMPLATE}>?\(\s*{NAME}"),
    re.compile(rf"\b(Server){TEMPLATE}>\(\s*(?:ros::NodeHandle\((?:\w+,\s*)?){NAME}"),
]
# Calls that offer or use a name, whose name is not a string. (A declaration has & or ...)
COMPOSED = re.compile(
    rf"\b(advertise|advertiseService|subscribe){TEMPLATE}\(\s*(?!ros::)([^\")\s&.][^,)&.]*)[,)]"
)
# Parts of described names that are different for each robot.
VARIABLE = {"JOINT", "ARM", "CAMERA", "ROBOT", "CONTROLLER"}
# Calls with names that nothing on the graph has, or that only say a name.
OTHERS = {"resolveName", "append", "NodeHandle", "takeHandle", "getHandle", "initParamWithNodeHandle"}
KINDS = {
    "publishes": re.compile(r"advertise$|publisher|Publisher"),
    "subscribes": re.compile(r"subscribe$"),
    "services": re.compile(r"advertiseService$|offer|^create$"),
    "actions": re.compile(r"_$"),  # a member that is made with a node handle and a name
}
PYTHON = {
    "Publisher": "publishes",
    "Subscriber": "subscribes",
    "wait_for_message": "subscribes",
    "Service": "services",
    "SimpleActionServer": "actions",
    "ActionServer": "actions",
    "SimpleActionClient": "calls",
    "ActionClient": "calls",
    "ServiceProxy": "calls",
    "get_param": "parameters",
    "has_param": "parameters",
}
MARKERS = "InteractiveMarkerServer"


class Found(typing.NamedTuple):
    """A name. kind: a list of docs/site/nodes, parameters, or empty for any of them."""

    kind: str
    name: str


def without_comments(text: str) -> str:
    return re.sub(r"/\*\w+\*/", "", re.sub(r"(?m)(^|[;,({\s])//.*$", r"\1", text))


def kind_of(function: str) -> str:
    return next((kind for kind, pattern in KINDS.items() if pattern.search(function)), "")


def in_cpp(text: str) -> set[Found]:
    text = without_comments(text)
    found = set()
    for pattern in PATTERNS:
        for function, name in pattern.findall(text):
            if function not in OTHERS and name not in ("~", "/"):
                found.add(Found(kind_of(function), name))
    return found


def composed_in_cpp(text: str) -> set[str]:
    """The expressions of names that are not strings."""
    return {" ".join(name.split()) for _, name in COMPOSED.findall(without_comments(text))}


class _Python(ast.NodeVisitor):
    def __init__(self, constants: dict[str, str]):
        self.constants, self.found = constants, set()

    def visit_Call(self, call: ast.Call) -> None:
        self.generic_visit(call)
        function = getattr(call.func, "attr", getattr(call.func, "id", ""))
        if not call.args or function not in {*PYTHON, MARKERS}:
            return
        name = self.text(call.args[0])
        if function == MARKERS:
            self.found |= {Found("publishes", f"{name}/update"), Found("publishes", f"{name}/update_full")}
            self.found.add(Found("subscribes", f"{name}/feedback"))
        elif name.strip("~/*"):
            self.found.add(Found(PYTHON[function], name))

    def text(self, node: ast.expr) -> str:
        """The value of an expression; * for what is known at run time only."""
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            return node.value
        if isinstance(node, ast.Name):
            return self.constants.get(node.id, "*")
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
            return self.text(node.left) + self.text(node.right)
        if isinstance(node, ast.JoinedStr):
            return "".join(self.text(part) for part in node.values)
        return "*"


def in_python(text: str) -> set[Found]:
    tree = ast.parse(text)
    reader = _Python({})
    for node in ast.walk(tree):
        if isinstance(node, ast.Assign) and len(node.targets) == 1 and isinstance(node.targets[0], ast.Name):
            value = reader.text(node.value)
            if value != "*":
                reader.constants[node.targets[0].id] = value
    reader.visit(tree)
    return reader.found


def names_in(path: Path) -> set[Found]:
    text = path.read_text(errors="replace")
    if path.suffix in (".cpp", ".h"):
        return in_cpp(text)
    return in_python(text) if path.suffix == ".py" or "python" in text.partition("\n")[0] else set()


def is_same_part(found: str, described: str) -> bool:
    """`ARM_state_controller` is any name that ends so."""
    pattern = "|".join(VARIABLE)
    fixed = re.sub(pattern, "*", described)
    return fnmatch.fnmatchcase(fixed, found) or fnmatch.fnmatchcase(found, fixed)


def is_same(found: str, described: str) -> bool:
    """Whether a described name is the one that a source has, in whatever namespace."""
    parts, whole = found.strip("~/").split("/"), described.strip("~/").split("/")
    if len(parts) > len(whole):
        return False
    # A source may name the first part only: the namespace of what follows.
    for begin in {0, len(whole) - len(parts)}:
        here = whole[begin : begin + len(parts)]
        is_fixed = not all(there in VARIABLE for there in here)
        if is_fixed and all(is_same_part(part, there) for part, there in zip(parts, here)):
            return True
    return False
