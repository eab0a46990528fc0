# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
#
# Included by CMAKE_PROJECT_INCLUDE after every project(), also of packages that a user adds to the workspace. For all of them:
# what a build that changes little need not do (below). For those of this repository, which are listed: libraries, programs and
# tests are compiled several sources at a time (CMake's unity build), which takes less than half the time of a build from
# nothing: no name may stand in the anonymous namespaces of two sources of a target. Of tests fewer are compiled at a time,
# because they are edited more often one by one, and with less optimization.
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

# Called at the end of a project's CMakeLists.txt, for its folder and those below.
function(franka_compile_several_sources_at_once folder)
  get_property(folders DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
  foreach(below ${folders})
    franka_compile_several_sources_at_once(${below})
  endforeach()
  get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  foreach(target ${targets})
    get_target_property(type ${target} TYPE)
    if(type MATCHES "^(SHARED_LIBRARY|MODULE_LIBRARY|EXECUTABLE)$" AND NOT target MATCHES "_bench")
      set(batch_size 12)
      if(target MATCHES "_test")
        set(batch_size 3)
        # The compiler takes sources that are included for headers, and warns of tests whose fixture has no linkage.
        target_compile_options(${target} PRIVATE -O1 -Wno-subobject-linkage)
      endif()
      if(target MATCHES "^(franka_sim_ros|franka_gripper(_sim)?|franka_control_services|_pyfranka)$|_node$|_loader(_plugins)?$")
        # Services, topics, loaders and bindings: optimizing their templates takes longer than everything that they save.
        target_compile_options(${target} PRIVATE -O1)
      endif()
      set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${batch_size})
      # CMake includes the sources by absolute paths. As __FILE__ they would reach the binaries, and a clone in another
      # folder would find nothing in the compiler's cache.
      target_compile_options(${target} PRIVATE "-fmacro-prefix-map=${CMAKE_SOURCE_DIR}/=")
    endif()
  endforeach()
endfunction()

# genmsg's check of each message is a program in every build, of one that changes nothing the largest part. It ends the build
# if a message has got another type since CMake ran; here CMake runs again by itself.
if(NOT COMMAND _add_custom_target)  # what CMake calls the original once it is defined again
  function(add_custom_target name)
    if(name MATCHES "_generate_messages_check_deps_")
      set(file "${ARGV6}")  # of COMMAND, environment, Python, its script, package, file, types
      if(NOT EXISTS "${file}")
        message(FATAL_ERROR "genmsg's check of messages has other arguments than expected: ${ARGV}")
      endif()
      set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${file}")
      _add_custom_target(${name})
      return()
    endif()
    set(arguments "")
    foreach(i RANGE 0 ${ARGC})
      if(i LESS ARGC)
        string(APPEND arguments " [==[${ARGV${i}}]==]")
      endif()
    endforeach()
    cmake_language(EVAL CODE "_add_custom_target(${arguments})")
  endfunction()
endif()

# A program is not linked again because a shared library that it uses has changed; that one lacks a symbol shows at its start.
set(CMAKE_LINK_DEPENDS_NO_SHARED ON)

cmake_policy(SET CMP0057 NEW)  # IN_LIST; the workspace itself asks for an old CMake
if(PROJECT_NAME IN_LIST franka_unity_projects)
  cmake_language(DEFER CALL franka_compile_several_sources_at_once ${CMAKE_CURRENT_SOURCE_DIR})
endif()
