# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
#
# Included by CMAKE_PROJECT_INCLUDE after every project(). The libraries and programs of this repository are compiled
# several sources at a time (CMake's unity build), which takes less than half the time of a build from nothing. Tests, and
# packages that a user adds to the workspace, are compiled as always: the same name may stand in several of their sources.
set(franka_unity_projects
  combined_robot_hw
  control_toolbox
  controller_manager
  effort_controllers
  franka_control
  franka_example_controllers
  franka_gripper
  franka_hw
  franka_sim
  franka_sim_mujoco
  gripper_action_controller
  joint_state_controller
  joint_trajectory_controller
  libfranka
  position_controllers
  pyfranka
  realtime_tools
  transmission_interface
  velocity_controllers
)

# Called at the end of a project's CMakeLists.txt.
function(franka_compile_several_sources_at_once)
  get_property(targets DIRECTORY PROPERTY BUILDSYSTEM_TARGETS)
  foreach(target ${targets})
    get_target_property(type ${target} TYPE)
    if(type MATCHES "^(SHARED_LIBRARY|MODULE_LIBRARY|EXECUTABLE)$" AND NOT target MATCHES "_(test|bench)")
      set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 12)
      # CMake includes the sources by absolute paths. As __FILE__ they would reach the binaries, and a clone in another
      # folder would find nothing in the compiler's cache.
      target_compile_options(${target} PRIVATE "-fmacro-prefix-map=${CMAKE_SOURCE_DIR}/=")
    endif()
  endforeach()
endfunction()

cmake_policy(SET CMP0057 NEW)  # IN_LIST; the workspace itself asks for an old CMake
if(PROJECT_NAME IN_LIST franka_unity_projects)
  cmake_language(DEFER CALL franka_compile_several_sources_at_once)
endif()
