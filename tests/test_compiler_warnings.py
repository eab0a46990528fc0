# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Lines of a build's output that count as warnings."""

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
    """Also by the path of the clone that has filled the compiler's cache."""
    other = f"/another/clone/{NAME}:7: warning: something"
    assert warnings(f"{LOG}{LOG}{other}\n", {SOURCE}) == [LOG.splitlines()[1], other]
