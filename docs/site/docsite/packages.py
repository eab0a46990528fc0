# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The ROS packages of the workspace."""

import typing
import xml.etree.ElementTree as ET
from functools import lru_cache
from pathlib import Path

from docsite.paths import TOP, WORKSPACE


class Package(typing.NamedTuple):
    """A package: its name, its folder, and the description in package.xml."""

    name: str
    folder: Path
    description: str

    def files(self, pattern: str) -> list[Path]:
        """Its files, without those of its tests."""
        found = self.folder.glob(pattern)
        return sorted(path for path in found if "test" not in path.relative_to(self.folder).parts)

    @property
    def place(self) -> str:
        """Its folder in the repository."""
        return str(self.folder.resolve().relative_to(TOP))


def read_package(file: Path) -> Package:
    root = ET.parse(file).getroot()
    name, description = root.findtext("name", "").strip(), root.findtext("description", "")
    return Package(name, file.parent, " ".join(description.split()))


@lru_cache(maxsize=1)
def packages() -> tuple[Package, ...]:
    """The packages of the workspace in alphabetical order, without those of tests."""
    files = [*WORKSPACE.glob("*/package.xml"), *WORKSPACE.glob("ros_control/*/package.xml")]
    return tuple(sorted(map(read_package, files)))
