# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0

# A package that was copied out of the project has no tests.
include(${CMAKE_CURRENT_SOURCE_DIR}/../../../tests/source_file.cmake OPTIONAL RESULT_VARIABLE found)
if(NOT found)
  return()
endif()

# Under catkin the tests use the workspace's gtest; a plain build uses the system's gtest and ctest.
function(sim_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES" ${ARGN})
  set(test ${PROJECT_NAME}_${name})
  if(catkin_FOUND)
    catkin_add_gtest(${test} ${ARG_SOURCES} TIMEOUT 240)
    target_link_libraries(${test} gtest_main)
  else()
    add_executable(${test} ${ARG_SOURCES})
    target_link_libraries(${test} GTest::gtest GTest::gtest_main)
    add_test(NAME ${test} COMMAND ${test})
    set_tests_properties(${test} PROPERTIES TIMEOUT 240)
  endif()
  target_include_directories(${test} PRIVATE src ${MUJOCO_INCLUDE_DIR})
  target_link_libraries(${test} ${ARG_LIBRARIES} franka_source_file ${CMAKE_DL_LIBS}
                        Threads::Threads)
endfunction()

if(NOT catkin_FOUND)
  enable_testing()
  find_package(GTest REQUIRED)
  if(NOT TARGET GTest::gmock)
    message(FATAL_ERROR "The tests of franka_sim need GoogleMock: install libgmock-dev.")
  endif()
endif()

# One program each: rt_guard.h works in one translation unit of a program.
foreach(name control_unit external_force gripper_unit modes_and_requests)
  sim_test(robot_${name}_test SOURCES test/robot/${name}_test.cpp LIBRARIES franka_sim_robot)
endforeach()

sim_test(robot_unit_test
  SOURCES
    test/robot/command_filter_test.cpp
    test/robot/command_link_test.cpp
    test/robot/control_laws_test.cpp
    test/robot/error_flags_test.cpp
    test/robot/estimator_test.cpp
    test/robot/finger_motion_test.cpp
    test/robot/operator_motion_test.cpp
    test/robot/safety_controller_test.cpp
    test/robot/self_collision_test.cpp
    test/robot/supervisor_parts_test.cpp
    test/robot/transform_entrances_test.cpp
    test/robot/unit_motion_test.cpp
  LIBRARIES franka_sim_robot)

find_package(rapidcheck REQUIRED)
sim_test(robot_properties_test
  SOURCES
    test/robot/control_unit_properties_test.cpp
    test/robot/properties/invariants.cpp
    test/robot/properties/observation.cpp
    test/robot/properties/stepped_robot.cpp
  LIBRARIES franka_sim_robot rapidcheck_gtest)
target_include_directories(franka_sim_robot_properties_test PRIVATE test/robot)

sim_test(robot_motion_test
  SOURCES
    test/robot/motion/async_joint_generator_test.cpp
    test/robot/motion/brake_trajectory_test.cpp
    test/robot/motion/elbow_test.cpp
    test/robot/motion/inverse_kinematics_test.cpp
    test/robot/motion/joint_limits_test.cpp
    test/robot/motion/motion_generator_test.cpp
    test/robot/motion/motion_limits_test.cpp
    test/robot/motion/motion_start_test.cpp
    test/robot/motion/rate_limited_client_test.cpp
  LIBRARIES franka_sim_robot Franka::Franka)

sim_test(unit_in_world_test SOURCES test/robot/unit_in_world_test.cpp
  LIBRARIES franka_sim_physics franka_sim_robot ${MUJOCO_LIBRARY})
sim_test(realism_test SOURCES test/world/realism_test.cpp
  LIBRARIES franka_sim_physics franka_sim_robot ${MUJOCO_LIBRARY})

sim_test(steps_test
  SOURCES test/physics/robot_clearance_test.cpp test/physics/adaptive_steps_test.cpp
    test/physics/object_rest_test.cpp test/physics/equality_solver_test.cpp
    test/physics/preparation_thread_test.cpp test/physics/world_sequences_test.cpp
  LIBRARIES franka_sim_physics ${MUJOCO_LIBRARY})

sim_test(physics_test
  SOURCES
    test/physics/arm_plant_test.cpp
    test/physics/determinism_test.cpp
    test/physics/drawn_meshes_test.cpp
    test/physics/grasp_test.cpp
    test/physics/joint_drive_test.cpp
    test/physics/mjcf_world_test.cpp
    test/physics/model_agreement_test.cpp
    test/physics/renderer_test.cpp
    test/physics/sdf_meshes_test.cpp
    test/physics/links_without_gravity_test.cpp
    test/physics/sdf_text_test.cpp
    test/physics/sdf_world_test.cpp
    test/physics/shapes_test.cpp
    test/physics/urdf_robot_test.cpp
    test/physics/world_limits_test.cpp
    test/physics/world_objects_test.cpp
    test/physics/world_snapshot_test.cpp
    test/physics/world_test.cpp
  LIBRARIES franka_sim_physics ${MUJOCO_LIBRARY} PkgConfig::TINYXML2 Franka::Core)

sim_test(fci_test
  SOURCES
    test/fci/cpu_latency_request_test.cpp
    test/fci/hostile_clients_test.cpp
    test/fci/host_rules_test.cpp
    test/fci/host_test.cpp
    test/fci/json_test.cpp
    test/fci/command_table_test.cpp
    test/fci/line_server_test.cpp
    test/fci/lock_step_turn_test.cpp
    test/fci/own_client_test.cpp
    test/fci/robot_server_test.cpp
    test/fci/served_models_test.cpp
    test/fci/sim_robot_test.cpp
    test/fci/vacuum_gripper_test.cpp
  LIBRARIES franka_sim_fci franka_sim_physics Franka::Franka PkgConfig::TINYXML2)

sim_test(simulation_test
  SOURCES
    test/simulation/batch_test.cpp
    test/simulation/simulation_test.cpp
    test/simulation/snapshot_test.cpp
  LIBRARIES franka_sim_simulation)

# A program of python/test/test_equal_hashes.py. Python does not fuse multiplications with additions.
add_executable(franka_sim_contact_scenario_test test/simulation/contact_scenario.cpp)
target_compile_options(franka_sim_contact_scenario_test PRIVATE -ffp-contract=off)
target_link_libraries(franka_sim_contact_scenario_test franka_sim_simulation)
if(catkin_FOUND)
  set_target_properties(franka_sim_contact_scenario_test PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY ${CATKIN_DEVEL_PREFIX}/lib/${PROJECT_NAME})
endif()
