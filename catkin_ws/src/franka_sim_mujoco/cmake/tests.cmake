# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0

# A package that was copied out of the project has no tests.
include(${CMAKE_CURRENT_SOURCE_DIR}/../../../tests/source_file.cmake OPTIONAL RESULT_VARIABLE found)
if(NOT found)
  return()
endif()

catkin_add_gtest(${PROJECT_NAME}_parts_test
  test/command_shaper_test.cpp
  test/controller_check_test.cpp
  test/files_test.cpp
  test/gripper_mailbox_test.cpp
  test/pace_test.cpp
  test/request_queue_test.cpp
  test/robot_type_test.cpp
  test/sim_arm_test.cpp
  TIMEOUT 240)
if(TARGET ${PROJECT_NAME}_parts_test)
  # Test helpers and parts of franka_sim, which only the source space has.
  target_include_directories(${PROJECT_NAME}_parts_test PRIVATE
    src ${CMAKE_CURRENT_SOURCE_DIR}/../../../tests/include ${CMAKE_CURRENT_SOURCE_DIR}/../franka_sim/test
    ${CMAKE_CURRENT_SOURCE_DIR}/../franka_sim/src)
  target_link_libraries(${PROJECT_NAME}_parts_test
    franka_sim_ros gtest_main ${CMAKE_DL_LIBS} Threads::Threads)
endif()

find_package(rostest REQUIRED)
add_rostest_gtest(arm_parameters_test test/arm_parameters.test test/arm_parameters_test.cpp)
target_include_directories(arm_parameters_test PRIVATE src)
target_link_libraries(arm_parameters_test franka_sim_ros franka_source_file)
add_rostest_gtest(shutdown_request_test test/shutdown_request.test test/shutdown_request_test.cpp)
target_include_directories(shutdown_request_test PRIVATE
  src ${CMAKE_CURRENT_SOURCE_DIR}/../../../tests/include)
target_link_libraries(shutdown_request_test franka_sim_ros)
add_rostest(test/parameters.test DEPENDENCIES
  franka_sim_mujoco_node franka_hw_sim franka_gripper_sim)
