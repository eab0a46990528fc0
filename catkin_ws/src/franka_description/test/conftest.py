# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Expands the package's xacro files in process, without a ROS environment."""

import sys
import types
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[1]
ROBOTS = PACKAGE / "robots"
sys.path.insert(0, str(Path(__file__).parent))
sys.path.insert(0, str(PACKAGE / "scripts"))
sys.dont_write_bytecode = True


def resolver():
    """A module like ament_index_python.packages that knows the package under test."""
    packages = types.ModuleType("ament_index_python.packages")

    class PackageNotFoundError(KeyError):
        pass

    def get_package_share_directory(name):
        if name != "franka_description":
            raise PackageNotFoundError(name)
        return str(PACKAGE)

    packages.PackageNotFoundError = PackageNotFoundError
    packages.get_package_share_directory = get_package_share_directory
    return packages


@pytest.fixture(autouse=True)
def package_paths(monkeypatch):
    monkeypatch.setitem(sys.modules, "ament_index_python", types.ModuleType("ament_index_python"))
    monkeypatch.setitem(sys.modules, "ament_index_python.packages", resolver())


@pytest.fixture
def mesh_index(tmp_path):
    """Writes an available.xacro with the given folders, as install_meshes does; returns its path."""

    def write(**folders):
        lines = [f"{folder}: [{', '.join(names)}]" for folder, names in folders.items()]
        (tmp_path / "available.yaml").write_text("\n".join(["format: 1", *lines]) + "\n")
        import description_install  # found through the path set above

        (tmp_path / "available.xacro").write_text(description_install.load().XACRO)
        return str(tmp_path / "available.xacro")

    return write
