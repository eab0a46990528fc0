# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""franka_sim builds and passes its tests by CMake alone, on a bare Debian with the packages that
docs/franka_sim.md names: nothing of ROS or catkin is there."""

import re

import pytest
from bare_debian import TOP, BareDebian, bare_debian, copy_project
from tutorial import read

PAGE = TOP / "docs" / "franka_sim.md"
NEEDED_BY_TESTS = re.compile(r"The tests .* also need (.*?)\.", re.DOTALL)
OF_ROS = re.compile(r"^(catkin|ros-|librosc|libroslib|python3-ros|librostest)")
HOUR = 3600.0  # [s]

pytestmark = [
    pytest.mark.long_form("builds franka_sim on a bare Debian"),
    pytest.mark.timeout(3 * HOUR),
]


def install_packages(bare: BareDebian) -> None:
    names = re.findall(r"lib[\w-]+", NEEDED_BY_TESTS.search(PAGE.read_text(encoding="utf-8"))[1])
    assert len(names) >= 3
    install = "apt-get install -y --no-install-recommends"
    command = read(PAGE).block_with("apt-get install").replace("apt-get install", install).rstrip()
    bare.must("sh", "-c", f"apt-get update && {command} {' '.join(names)}", timeout=HOUR)


def test_franka_sim_builds_and_passes_its_tests_by_cmake_alone(tmp_path):
    with bare_debian(tmp_path) as bare:
        install_packages(bare)
        installed = bare.must("dpkg-query", "--show", "--showformat", "${Package}\\n").split()
        assert "cmake" in installed and not [name for name in installed if OF_ROS.match(name)]
        copy_project(bare.root / "project")
        build = read(PAGE).block_with("cmake -S catkin_ws/src/franka_sim")
        assert " -B ~/franka_sim\n" in build
        build = build.replace(" -B ~/franka_sim\n", " -B ~/franka_sim -DFRANKA_BUILD_TESTS=ON\n")
        said = bare.must("sh", "-ec", f"cd /project\n{build}", timeout=2 * HOUR)
        assert "--robot" in said
        tested = bare.must("sh", "-c", "cd ~/franka_sim && ctest --output-on-failure", timeout=HOUR)
        assert "100% tests passed, 0 tests failed" in tested, tested[-3000:]
