# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0

# rt_guard.h: proves that loops neither allocate nor lock.
set(FRANKA_TEST_INCLUDE_DIR ${CMAKE_CURRENT_SOURCE_DIR}/../../../tests/include)

function(sim_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES" ${ARGN})
  catkin_add_gtest(${PROJECT_NAME}_${name} ${ARG_SOURCES} TIMEOUT 240)
  if(TARGET ${PROJECT_NAME}_${name})
    target_include_directories(${PROJECT_NAME}_${name} PRIVATE
      ${FRANKA_TEST_INCLUDE_DIR} src ${MUJOCO_INCLUDE_DIR})
    target_link_libraries(${PROJECT_NAME}_${name} ${ARG_LIBRARIES} gtest_main ${CMAKE_DL_LIBS} Threads::Threads)
    target_compile_definitions(${PROJECT_NAME}_${name} PRIVATE
      FRANKA_SIM_TEST_DATA="${CMAKE_CURRENT_SOURCE_DIR}/test/physics/data"
      FRANKA_SIM_WORLDS="${CMAKE_CURRENT_SOURCE_DIR}/worlds")
  endif()
endfunction()

# Each in a program of its own: rt_guard.h is made for one translation unit of a program.
foreach(name control_unit external_force gripper_unit modes_and_requests parts repeatability)
  sim_test(robot_${name}_test SOURCES test/robot/${name}_test.cpp LIBRARIES franka_sim_robot)
endforeach()

sim_test(robot_unit_test
  SOURCES
    test/robot/error_flags_test.cpp
    test/robot/laws_test.cpp
    test/robot/transform_entrances_test.cpp
    test/robot/unit_limits_test.cpp
    test/robot/unit_motion_test.cpp
    test/robot/unit_restart_test.cpp
  LIBRARIES franka_sim_robot)

sim_test(robot_motion_test
  SOURCES
    test/robot/motion/cartesian_limits_test.cpp
    test/robot/motion/inverse_kinematics_test.cpp
    test/robot/motion/joint_limits_test.cpp
    test/robot/motion/motion_generator_test.cpp
    test/robot/motion/motion_parts_test.cpp
    test/robot/motion/rate_limited_client_test.cpp
  LIBRARIES franka_sim_robot Franka::Franka)

sim_test(unit_in_world_test SOURCES test/robot/unit_in_world_test.cpp
  LIBRARIES franka_sim_physics franka_sim_robot ${MUJOCO_LIBRARY})
sim_test(arm_in_world_test SOURCES test/world/arm_in_world_test.cpp
  LIBRARIES franka_sim_physics franka_sim_robot ${MUJOCO_LIBRARY})

sim_test(physics_test
  SOURCES
    test/physics/arm_plant_test.cpp
    test/physics/determinism_test.cpp
    test/physics/grasp_test.cpp
    test/physics/joint_drive_test.cpp
    test/physics/mjcf_world_test.cpp
    test/physics/model_agreement_test.cpp
    test/physics/renderer_test.cpp
    test/physics/sdf_meshes_test.cpp
    test/physics/sdf_text_test.cpp
    test/physics/sdf_world_test.cpp
    test/physics/urdf_robot_test.cpp
    test/physics/world_limits_test.cpp
    test/physics/world_objects_test.cpp
    test/physics/world_test.cpp
  LIBRARIES franka_sim_physics ${MUJOCO_LIBRARY} PkgConfig::TINYXML2 Franka::Core)

sim_test(ros_parts_test SOURCES test/ros/parts_test.cpp
  LIBRARIES franka_sim_ros)

find_package(rostest REQUIRED)
foreach(name devices parameters simulation worlds)
  add_rostest(test/ros/${name}.test DEPENDENCIES
    franka_sim_mujoco_node franka_hw_sim franka_gripper_sim)
endforeach()
# Panda and FR3, and names that say nothing of the robot.
foreach(robot panda fr3)
  add_rostest(test/ros/interfaces.test ARGS robot:=${robot} arm_id:=my_${robot}
    DEPENDENCIES franka_sim_mujoco_node franka_hw_sim)
endforeach()
