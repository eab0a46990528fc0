# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Launch files: their comments, and their arguments with defaults and docs."""

import re
import typing
import xml.etree.ElementTree as ET
from pathlib import Path

from docsite.markdown import code, table, with_links


class Argument(typing.NamedTuple):
    """An argument that a caller may set.

    defaults: pairs of a condition (empty: always) and a value (None: the argument is required).
    """

    name: str
    defaults: list[tuple[str, str | None]]
    doc: str

    def shown_default(self) -> str:
        shown = []
        for condition, value in self.defaults:
            text = "required" if value is None else code(" ".join(value.split())) or "empty"
            shown.append(f"{text} {condition}".strip())
        return "; ".join(shown)


class LaunchFile(typing.NamedTuple):
    """A launch file: its first comment, and its arguments in their order."""

    path: Path
    comment: str
    arguments: list[Argument]


def condition_of(element: ET.Element) -> str:
    """The condition of an argument's default, in words."""
    for name in ("if", "unless"):
        value = element.get(name)
        if value:
            simple = re.fullmatch(r"\$\(arg (\w+)\)", value)
            what = code(f"{simple.group(1)}:=true") if simple else code(value)
            return f"{name} {what}"
    return ""


def first_comment(root: ET.Element) -> str:
    """The comment at the start of the launch element, before other elements; empty if there is none."""
    for element in root:
        is_comment = typing.cast(typing.Any, element.tag) is ET.Comment
        return " ".join((element.text or "").split()) if is_comment else ""
    return ""


def read_launch_file(path: Path) -> LaunchFile:
    parser = ET.XMLParser(target=ET.TreeBuilder(insert_comments=True))
    root = ET.parse(path, parser).getroot()
    found: dict[str, Argument] = {}
    for element in root.iter("arg"):
        # An argument with a value is for the file itself, or for an included file.
        if element not in list(root) or element.get("value") is not None:
            continue
        name, doc = element.get("name", ""), element.get("doc", "")
        entry = found.setdefault(name, Argument(name, [], ""))
        entry.defaults.append((condition_of(element), element.get("default")))
        if doc:
            found[name] = entry._replace(doc=" ".join(doc.split()))
    return LaunchFile(path, first_comment(root), list(found.values()))


def describe(launch: LaunchFile, package: str) -> str:
    """A section about the launch file."""
    rows = [(code(each.name), each.shown_default(), with_links(each.doc)) for each in launch.arguments]
    parts = [f"### {launch.path.name}", f"`roslaunch {package} {launch.path.name}`"]
    if launch.comment:
        parts.append(with_links(launch.comment))
    parts.append(table(("argument", "default", "meaning"), rows) if rows else "It takes no arguments.")
    return "\n\n".join(parts)
