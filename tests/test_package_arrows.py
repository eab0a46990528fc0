# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Arrows between parts are found in includes and imports, and those upwards are refused."""

from pathlib import Path

import package_arrows
import pytest
from package_arrows import Part

PARTS = (
    Part("above", "", ("catkin_ws/src/above/*",)),
    Part("middle", "", ("python/*",)),
    Part("below", "Eigen", ("catkin_ws/src/below/*",)),
)


@pytest.fixture
def write(tmp_path, monkeypatch):
    """Writes a file of a small project."""
    files = []
    for name, value in {
        "TOP": tmp_path,
        "WORKSPACE": tmp_path / "catkin_ws" / "src",
        "PAGE": tmp_path / "architecture.md",
        "PARTS": PARTS,
        "RANK": {part.name: rank for rank, part in enumerate(PARTS)},
        "UPWARD": set(),
        "TOO_LARGE": set(),
        "MAX_LINES": 3,
        "files_of_product": lambda: files,
    }.items():
        monkeypatch.setattr(package_arrows, name, value)
    package_arrows.part_of.cache_clear()

    def write_file(name: str, text: str) -> None:
        files.append(Path(name))
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)

    (tmp_path / "architecture.md").write_text(package_arrows.BEGIN + package_arrows.END)
    yield write_file
    package_arrows.part_of.cache_clear()


def test_wrong_arrows_and_large_packages_are_found(write):
    write("catkin_ws/src/below/include/below/arm.h", "")
    write("catkin_ws/src/above/src/node.cpp", "#include <below/arm.h>\n#include <vector>\n")
    write("python/src/middle/__init__.py", "import math\n")
    write("catkin_ws/src/above/src/above/node.py", "from middle import arm\n")
    package_arrows.write_page()
    assert package_arrows.findings() == []
    assert "| above | middle, below |  |" in package_arrows.PAGE.read_text()
    write("catkin_ws/src/below/src/arm.cpp", '#include "arm_tables.h"\n#include <above/node.h>\n\n')
    write("catkin_ws/src/below/src/arm_tables.h", "")
    write("catkin_ws/src/above/include/above/node.h", "\n\n")
    upward, size, page = package_arrows.findings()
    assert upward.startswith("catkin_ws/src/below/src/arm.cpp:1: below must not use above")
    assert "above has 5 lines" in size
    assert page.startswith("docs/architecture.md:1:")
