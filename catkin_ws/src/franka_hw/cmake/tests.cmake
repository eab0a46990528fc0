# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0

# A package that was copied out of the project has no tests.
include(${CMAKE_CURRENT_SOURCE_DIR}/../../../tests/source_file.cmake OPTIONAL RESULT_VARIABLE found)
if(NOT found)
  return()
endif()

catkin_add_gtest(franka_hw_test
  test/arm_connection_test.cpp
  test/arm_state_test.cpp
  test/handles_test.cpp
  test/main.cpp
  test/model_base_test.cpp
  test/resource_helpers_test.cpp
  test/response_times_test.cpp
  test/robot_mismatch_test.cpp
  test/setters_test.cpp
  test/trigger_rate_test.cpp
)
target_compile_options(franka_hw_test PRIVATE -Wall -Wextra)
target_link_libraries(franka_hw_test franka_hw franka_source_file)

# A separate executable, because the guard against allocations replaces malloc.
catkin_add_gtest(model_kdl_test test/model_kdl_test.cpp)
target_compile_options(model_kdl_test PRIVATE -Wall -Wextra)
target_link_libraries(model_kdl_test franka_hw franka_source_file Franka::Core ${CMAKE_DL_LIBS})

# FrankaHW and its environment, with the fake robot of the libfranka tests.
find_package(rostest REQUIRED)
find_package(controller_manager REQUIRED)
add_rostest_gtest(franka_hw_robot_test test/franka_hw_robot.test
  ${CMAKE_CURRENT_SOURCE_DIR}/../libfranka/test/fake_robot.cpp
  test/robot/combined_test.cpp
  test/robot/connection_test.cpp
  test/robot/cycle_test.cpp
  test/robot/goal_server_test.cpp
  test/robot/interfaces_test.cpp
  test/robot/main.cpp
  test/robot/modes_test.cpp
  test/robot/parameters_test.cpp
  test/robot/refusals_test.cpp
  test/robot/support.cpp
  test/robot/switching_test.cpp
)
# Unoptimized, because compilation takes most of the time of these tests.
target_compile_options(franka_hw_robot_test PRIVATE -Wall -Wextra -O0)
target_include_directories(franka_hw_robot_test PRIVATE
  ${CMAKE_CURRENT_SOURCE_DIR}/../libfranka/test)
target_include_directories(franka_hw_robot_test SYSTEM PRIVATE ${controller_manager_INCLUDE_DIRS})
target_link_libraries(franka_hw_robot_test
  franka_hw franka_source_file Franka::Core ${controller_manager_LIBRARIES} ${CMAKE_DL_LIBS})
