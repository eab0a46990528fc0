# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters, topics, services and actions of nodes and controllers, from docs/site/nodes.

They are written by hand, since sources do not say what a name means; tests/test_docs_names.py compares
them with the names that the sources use.
"""

import typing
from pathlib import Path

import yaml

from docsite.interfaces import read_interface
from docsite.markdown import code, plain, table, with_links
from docsite.packages import packages
from docsite.paths import SITE

LISTS = {
    "publishes": "published topic",
    "subscribes": "subscribed topic",
    "services": "service",
    "actions": "action",
    "calls": "action or service that it calls",
}


class Node(typing.NamedTuple):
    """A node or a controller. page: a page that describes it, relative to docs/.

    sources: the files that have its names.
    """

    name: str
    meaning: str
    page: str
    parameters: dict[str, list[str]]
    names: dict[str, dict[str, list[str]]]
    sources: list[str]


def nodes_of(package: str) -> list[Node]:
    file = SITE / "nodes" / f"{package}.yaml"
    if not file.is_file():
        return []
    found = []
    for entry in yaml.safe_load(file.read_text()):
        names = {kind: entry.get(kind, {}) for kind in LISTS}
        page, parameters = entry.get("page", ""), entry.get("parameters", {})
        found.append(Node(entry["name"], entry["meaning"], page, parameters, names, entry.get("sources", [])))
    return found


def interface_file(type_name: str) -> Path | None:
    """The definition of a type of ours such as franka_msgs/SetLoad, or None."""
    package, _, name = type_name.partition("/")
    for each in packages():
        if each.name == package:
            for kind in ("srv", "action", "msg"):
                file = each.folder / kind / f"{name}.{kind}"
                if file.is_file():
                    return file
    return None


def linked_type(type_name: str) -> str:
    """The type, with a link to its definition if it is ours."""
    file = interface_file(type_name)
    if file is None:
        return type_name
    package = type_name.partition("/")[0]
    return f"[{type_name}](#{file.suffix[1:]}-{package}-{file.stem.lower()})"


def meaning_of(type_name: str, meaning: str) -> str:
    """The meaning; where none is written, the description of the type."""
    file = interface_file(type_name)
    if not meaning and file is not None:
        return plain(read_interface(file).description)
    return plain(meaning)


def describe(node: Node) -> str:
    """A section about a node."""
    parts = [f"### {node.name}", with_links(node.meaning)]
    if node.page:
        parts.append(f"Its parameters, topics, services and actions: [{node.page}](../../{node.page}).")
    if node.parameters:
        rows = [(code(name), *map(plain, entry)) for name, entry in node.parameters.items()]
        parts.append(table(("parameter", "type", "default", "meaning"), rows))
    for kind, head in LISTS.items():
        entries = node.names[kind]
        if entries:
            rows = [
                (code(name), linked_type(type_name), meaning_of(type_name, meaning))
                for name, (type_name, meaning) in entries.items()
            ]
            parts.append(table((head, "type", "meaning"), rows))
    return "\n\n".join(parts)
