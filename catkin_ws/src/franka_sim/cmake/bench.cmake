# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0

find_package(benchmark REQUIRED)

add_executable(control_unit_bench test/robot/control_unit_bench.cpp)
target_link_libraries(control_unit_bench franka_sim_robot benchmark::benchmark)

add_executable(motion_bench test/robot/motion/motion_bench.cpp)
target_include_directories(motion_bench PRIVATE src)
target_link_libraries(motion_bench franka_sim_robot benchmark::benchmark)

include(${CMAKE_CURRENT_SOURCE_DIR}/../../../tests/source_file.cmake)
add_executable(physics_bench test/physics/physics_bench.cpp)
target_include_directories(physics_bench PRIVATE src ${MUJOCO_INCLUDE_DIR})
target_link_libraries(physics_bench
  franka_sim_physics franka_sim_robot ${MUJOCO_LIBRARY} benchmark::benchmark
  franka_source_file)

# A client of a running franka_sim; bench/run.py starts both.
add_executable(client_of_franka_sim_bench bench/client_of_franka_sim_bench.cpp)
target_include_directories(client_of_franka_sim_bench PRIVATE ../libfranka/test)  # a socket
target_link_libraries(client_of_franka_sim_bench Franka::Franka)
