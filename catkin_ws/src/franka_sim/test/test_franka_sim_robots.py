# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The URDFs in franka_sim match franka_description."""

import importlib.util
import sys
import types
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[1]
DESCRIPTION = PACKAGE.parent / "franka_description" / "test"


def load(name):
    spec = importlib.util.spec_from_file_location(f"description_{name}", DESCRIPTION / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def canonical(element):
    """An element without irrelevant white space and order of attributes."""
    attributes = tuple(sorted((key, " ".join(value.split())) for key, value in element.attrib.items()))
    return element.tag, attributes, (element.text or "").strip(), tuple(canonical(child) for child in element)


def parts(robot):
    return sorted(
        canonical(element)
        for element in robot
        if element.tag in ("link", "joint") and element.get("name") not in ("world", "world_joint")
    )


@pytest.mark.parametrize("name", ["panda", "fr3"])
def test_kept_urdf_matches_the_description(name, monkeypatch):
    packages = load("conftest").resolver()
    monkeypatch.setitem(sys.modules, "ament_index_python", types.ModuleType("ament_index_python"))
    monkeypatch.setitem(sys.modules, "ament_index_python.packages", packages)
    expanded = load("description_robot").expand(f"{name}/{name}", hand="true", gazebo="true")
    kept = ElementTree.parse(PACKAGE / "robots" / f"{name}.urdf").getroot()
    described = parts(ElementTree.fromstring(expanded.text))
    assert [part[1] for part in parts(kept)] == [part[1] for part in described]
    for ours, expected in zip(parts(kept), described):
        assert ours == expected
