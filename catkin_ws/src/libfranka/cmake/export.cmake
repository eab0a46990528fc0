# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
#
# Writes the CMake package `Franka` twice: beside the built libraries (devel space) and for installation.
include(CMakePackageConfigHelpers)

install(TARGETS franka franka_core EXPORT FrankaTargets
        LIBRARY DESTINATION ${franka_lib_destination}
        ARCHIVE DESTINATION ${franka_lib_destination}
        RUNTIME DESTINATION ${franka_bin_destination})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/franka ${PROJECT_SOURCE_DIR}/include/franka_core
                  ${PROJECT_SOURCE_DIR}/include/research_interface
        DESTINATION ${franka_include_destination} FILES_MATCHING PATTERN "*.h" PATTERN "*.hpp")
install(EXPORT FrankaTargets NAMESPACE Franka:: DESTINATION ${franka_config_destination})

# Config and version are the same in both places; beside the built libraries the targets carry absolute
# paths.
write_basic_package_version_file(${franka_build_config_dir}/FrankaConfigVersion.cmake
                                 VERSION ${PROJECT_VERSION} COMPATIBILITY AnyNewerVersion)
configure_package_config_file(
  ${PROJECT_SOURCE_DIR}/cmake/FrankaConfig.cmake.in ${franka_build_config_dir}/FrankaConfig.cmake
  INSTALL_DESTINATION ${franka_config_destination} NO_SET_AND_CHECK_MACRO
  NO_CHECK_REQUIRED_COMPONENTS_MACRO)
install(FILES ${franka_build_config_dir}/FrankaConfig.cmake
              ${franka_build_config_dir}/FrankaConfigVersion.cmake
        DESTINATION ${franka_config_destination})
export(EXPORT FrankaTargets NAMESPACE Franka:: FILE ${franka_build_config_dir}/FrankaTargets.cmake)
