# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Definitions of messages, services and actions, with their comments."""

import typing
from pathlib import Path

from docsite.markdown import block, with_links

LICENSE = ("# Copyright (c)", "# SPDX-License-Identifier")
KINDS = {"msg": "Messages", "srv": "Services", "action": "Actions"}


class Interface(typing.NamedTuple):
    """A definition: its first comment, and its text without the license."""

    path: Path
    description: str
    text: str

    @property
    def name(self) -> str:
        return self.path.stem


def read_interface(path: Path) -> Interface:
    lines = [line for line in path.read_text().splitlines() if not line.startswith(LICENSE)]
    text = "\n".join(lines).strip()
    comment: list[str] = []
    for line in text.splitlines():
        if not line.startswith("#"):
            break
        comment.append(line.lstrip("# ").rstrip())
    return Interface(path, " ".join(comment), text)


def describe(interface: Interface, package: str) -> str:
    """A section about the definition; its name has its own anchor."""
    kind = interface.path.suffix[1:]
    title = f"({kind}-{package}-{interface.name.lower()})=\n### {package}/{interface.name}"
    return "\n\n".join([title, with_links(interface.description), block("text", interface.text)])
