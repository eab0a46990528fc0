# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0

# Where the sources are is compiled into this library alone: the compiler's cache finds the tests of
# a clone in any folder.
if(NOT TARGET franka_source_file)
  add_library(franka_source_file STATIC EXCLUDE_FROM_ALL ${CMAKE_CURRENT_LIST_DIR}/source_file.cpp)
  target_include_directories(franka_source_file PUBLIC ${CMAKE_CURRENT_LIST_DIR}/include)
  get_filename_component(FRANKA_SOURCES ${CMAKE_CURRENT_LIST_DIR}/../catkin_ws/src ABSOLUTE)
  target_compile_definitions(franka_source_file PRIVATE FRANKA_SOURCES="${FRANKA_SOURCES}")
endif()
