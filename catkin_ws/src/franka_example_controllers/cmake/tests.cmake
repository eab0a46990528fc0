# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0

# A package that was copied out of the project has no tests.
include(${CMAKE_CURRENT_SOURCE_DIR}/../../../tests/source_file.cmake OPTIONAL RESULT_VARIABLE found)
if(NOT found)
  return()
endif()

catkin_add_gtest(cartesian_impedance_test
  test/cartesian_impedance_test.cpp
  test/command_claims_test.cpp
  test/pseudo_inversion_test.cpp
)
target_compile_options(cartesian_impedance_test PRIVATE -Wall -Wextra)
target_link_libraries(cartesian_impedance_test franka_example_controllers franka_source_file
  ${GTEST_MAIN_LIBRARIES} ${CMAKE_DL_LIBS})

find_package(rostest REQUIRED)
add_rostest_gtest(cartesian_impedance_example_controller_test
  test/cartesian_impedance_example_controller.test
  test/cartesian_impedance_example_controller_test.cpp
)
target_compile_options(cartesian_impedance_example_controller_test PRIVATE -Wall -Wextra)
target_include_directories(cartesian_impedance_example_controller_test PRIVATE
  ${CMAKE_CURRENT_SOURCE_DIR}/../../../tests/include)
target_link_libraries(cartesian_impedance_example_controller_test franka_example_controllers
  ${CMAKE_DL_LIBS})

add_rostest(test/interactive_marker.test)

add_rostest_gtest(python_controller_test test/python_controller.test
  test/python_controller_test.cpp)
target_compile_options(python_controller_test PRIVATE -Wall -Wextra)
target_include_directories(python_controller_test PRIVATE
  ${CMAKE_CURRENT_SOURCE_DIR}/../../../tests/include)
target_link_libraries(python_controller_test franka_python_controller ${CMAKE_DL_LIBS})
