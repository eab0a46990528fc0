# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Classes that pluginlib loads, read from the plugin descriptions that package.xml exports."""

import typing
import xml.etree.ElementTree as ET

from docsite.markdown import code, plain, table
from docsite.packages import Package


class Plugin(typing.NamedTuple):
    """A class: its name for pluginlib, the class that loads it, and its description."""

    name: str
    base: str
    description: str


def exported_files(package: Package) -> list[str]:
    """The plugin descriptions that package.xml names."""
    export = ET.parse(package.folder / "package.xml").getroot().find("export")
    named = [each.get("plugin", "") for each in (export if export is not None else [])]
    return [name for name in named if name]


def plugins_of(package: Package) -> list[Plugin]:
    found = []
    for exported in exported_files(package):
        file = package.folder / exported.replace("${prefix}/", "")
        for element in ET.parse(file).getroot().iter("class"):
            description = " ".join((element.findtext("description") or "").split())
            name = element.get("name", element.get("type", ""))
            found.append(Plugin(name, element.get("base_class_type", ""), description))
    return found


def describe(plugins: list[Plugin]) -> str:
    rows = [(code(each.name), code(each.base), plain(each.description)) for each in plugins]
    return table(("class", "interface", "meaning"), rows)
