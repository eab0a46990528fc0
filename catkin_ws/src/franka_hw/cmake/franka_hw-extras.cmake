# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0

# The headers of franka_hw include those of libfranka. A target name such as Franka::Franka cannot be
# written into catkin's list of libraries (the consumer does not know it yet), so it is looked up here.
if(NOT Franka_FOUND)
  find_package(Franka 0.8.0 QUIET)
endif()
if(NOT Franka_FOUND)
  message(FATAL_ERROR "franka_hw needs libfranka (0.8.0 or newer), which CMake did not find. Build the "
    "package libfranka of this workspace, or point -DFranka_DIR= at the folder of FrankaConfig.cmake.")
endif()
list(APPEND franka_hw_INCLUDE_DIRS ${Franka_INCLUDE_DIRS})
list(APPEND franka_hw_LIBRARIES ${Franka_LIBRARIES})
