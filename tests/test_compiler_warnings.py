# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Lines of a build's output that count as warnings."""

import pytest
from compiler_warnings import TOP, warnings

NAME = "catkin_ws/src/franka_hw/src/franka_hw.cpp"
SOURCE = TOP / NAME
LOG = """[ 12%] Building CXX object franka_hw.cpp.o
../../src/franka_hw/src/franka_hw.cpp:7:5: warning: case value '3' not in enumerated type [-Wswitch]
/usr/include/c++/14/bits/new_allocator.h:151:55: warning: argument 1 range exceeds [-Walloc-size]
../../src/my_robot/src/mine.cpp:1:1: warning: unused variable [-Wunused-variable]
CMake Warning at /usr/share/catkin/cmake/test/gtest.cmake:86 (message):
"""


def test_warnings_about_the_repository_count_once():
    found = warnings(LOG + LOG, {SOURCE})
    assert found == [LOG.splitlines()[1]]


@pytest.mark.parametrize("clone", [TOP, "/another/clone"])
def test_absolute_paths_count_also_those_of_the_clone_that_filled_the_cache(clone):
    assert warnings(f"{clone}/{NAME}:7: warning: something\n", {SOURCE})


def test_a_clean_log_has_none():
    assert warnings("[100%] Built target franka_hw\n", {SOURCE}) == []
