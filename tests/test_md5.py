# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The generated types have the MD5 sums that existing programs expect."""

import importlib
from pathlib import Path

import pytest

# Packages that also have types of our own: only types in the table are checked.
TABLE = dict(
    line.split()
    for line in (Path(__file__).parent / "data" / "md5.txt").read_text().splitlines()
    if line and not line.startswith("#")
)
PACKAGES = sorted({name.split("/")[0] for name in TABLE})


def generated(package: str) -> dict[str, str]:
    """MD5 sums of all messages and services that the package's Python modules hold, by name."""
    found = {}
    for kind in ("msg", "srv"):
        try:
            module = importlib.import_module(f"{package}.{kind}")
        except ImportError:
            continue
        types = {name: getattr(module, name) for name in dir(module)}
        found.update({name: cls._md5sum for name, cls in types.items() if hasattr(cls, "_md5sum")})
    return found


@pytest.mark.parametrize("package", PACKAGES)
def test_types_match_the_originals(package):
    found = generated(package)
    expected = {name.split("/")[1]: md5 for name, md5 in TABLE.items() if name.startswith(f"{package}/")}
    assert {name: found.get(name) for name in expected} == expected


@pytest.mark.parametrize(
    "package",
    ["control_msgs", "controller_manager_msgs", "franka_gripper", "franka_msgs", "gazebo_msgs"],
)
def test_the_table_is_complete(package):
    assert {name for name in generated(package) if f"{package}/{name}" not in TABLE} == set()
