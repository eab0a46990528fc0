# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0

catkin_add_gtest(franka_hw_test
  test/control_mode_test.cpp
  test/handles_test.cpp
  test/main.cpp
  test/model_base_test.cpp
  test/resource_helpers_test.cpp
  test/trigger_rate_test.cpp
)
target_compile_options(franka_hw_test PRIVATE -Wall -Wextra)
target_link_libraries(franka_hw_test franka_hw)

# Alone in its executable, because the guard against allocations replaces malloc.
catkin_add_gtest(model_kdl_test test/model_kdl_test.cpp)
target_compile_options(model_kdl_test PRIVATE -Wall -Wextra)
target_compile_definitions(model_kdl_test PRIVATE
  FRANKA_HW_TEST_DATA="${CMAKE_CURRENT_SOURCE_DIR}/test/data")
target_include_directories(model_kdl_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/../../../tests/include)
target_link_libraries(model_kdl_test franka_hw Franka::Core ${CMAKE_DL_LIBS})
