# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Robot descriptions: the arguments of xacro files, and their meanings from comments.

A comment says what arguments mean in lines of the form `NAME, NAME  meaning`, in the file itself or in a file
that it includes.
"""

import re
import typing
import xml.etree.ElementTree as ET
from pathlib import Path

from docsite.markdown import code, table, with_links
from docsite.packages import packages

XACRO = "{http://www.ros.org/wiki/xacro}"
LICENSE = ("Copyright (c)", "SPDX-License-Identifier")
MEANING = re.compile(r"^(\s+)(\w+(?:, \w+)*)\s{2,}(\S.*)$")
FIND = re.compile(r"\$\(find (\w+)\)/(.*)")


class Description(typing.NamedTuple):
    """A xacro file that makes a robot. arguments: name, default and meaning."""

    path: Path
    comment: str
    arguments: list[tuple[str, str | None, str]]


def parsed(path: Path) -> ET.Element:
    """The root, with comments as elements; those before the root come first."""
    builder = ET.TreeBuilder(insert_comments=True)
    root = ET.fromstring(path.read_text(), ET.XMLParser(target=builder))
    before = re.findall(r"<!--(.*?)-->", path.read_text().partition("<robot")[0], re.S)
    for text in reversed(before):
        root.insert(0, ET.Comment(text))
    return root


def comments_of(root: ET.Element) -> list[str]:
    # Comments have a function in the place of a tag.
    texts = [element.text or "" for element in root.iter(typing.cast(str, ET.Comment))]
    return [text for text in texts if not text.strip().startswith(LICENSE)]


def meanings_in(comment: str) -> dict[str, str]:
    """The meanings of arguments that a comment lists; deeper lines continue a meaning."""
    found: dict[str, str] = {}
    names: list[str] = []
    depth = 0
    for line in comment.splitlines():
        entry = MEANING.match(line)
        indent = len(line) - len(line.lstrip())
        if entry and (not names or indent <= depth):
            depth, names = indent, entry[2].split(", ")
            found |= dict.fromkeys(names, entry[3])
        elif names and line.strip() and indent > depth:
            for name in names:
                found[name] += f" {line.strip()}"
        else:
            names = []
    return found


def included(root: ET.Element) -> list[Path]:
    """The files of our packages that a file includes."""
    folders = {package.name: package.folder for package in packages()}
    found = []
    for element in root.iter(f"{XACRO}include"):
        place = FIND.fullmatch(element.get("filename", ""))
        if place and place[1] in folders and (folders[place[1]] / place[2]).is_file():
            found.append(folders[place[1]] / place[2])
    return found


def read_description(path: Path) -> Description:
    root = parsed(path)
    comments = comments_of(root)
    meanings: dict[str, str] = {}
    for other in included(root):
        for comment in comments_of(parsed(other)):
            meanings |= meanings_in(comment)
    for comment in comments:
        meanings |= meanings_in(comment)
    arguments = [
        (each.get("name", ""), each.get("default"), meanings.get(each.get("name", ""), ""))
        for each in root.iter(f"{XACRO}arg")
    ]
    first = re.split(r"\n\s+\w+(?:, \w+)*\s{2,}\S", comments[0])[0] if comments else ""
    return Description(path, " ".join(first.split()), arguments)


def describe(description: Description, package: str) -> str:
    """A section about the file."""
    place = str(description.path).partition(f"/{package}/")[2]
    rows = [
        (code(name), "required" if default is None else code(default) or "empty", with_links(meaning))
        for name, default, meaning in description.arguments
    ]
    parts = [
        f"### {description.path.name}",
        f"`rosrun xacro xacro $(rospack find {package})/{place} NAME:=VALUE`",
        with_links(description.comment),
        table(("argument", "default", "meaning"), rows) if rows else "It takes no arguments.",
    ]
    return "\n\n".join(parts)
