# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
#
# Writes the CMake package `FrankaSim` twice: beside the built libraries (devel space) and for installation.
include(CMakePackageConfigHelpers)

set(build_dir ${franka_sim_build_cmake_dir}/FrankaSim)
set(destination ${franka_sim_lib_destination}/cmake/FrankaSim)
install(TARGETS franka_sim_robot franka_sim_physics franka_sim_fci franka_sim_simulation
        EXPORT FrankaSimTargets
        LIBRARY DESTINATION ${franka_sim_lib_destination}
        ARCHIVE DESTINATION ${franka_sim_lib_destination}
        RUNTIME DESTINATION ${franka_sim_bin_destination})
install(EXPORT FrankaSimTargets NAMESPACE FrankaSim:: DESTINATION ${destination})
install(DIRECTORY include/franka_sim DESTINATION ${franka_sim_include_destination}
        FILES_MATCHING PATTERN "*.h")
write_basic_package_version_file(${build_dir}/FrankaSimConfigVersion.cmake
                                 VERSION ${PROJECT_VERSION} COMPATIBILITY AnyNewerVersion)
configure_package_config_file(cmake/FrankaSimConfig.cmake.in ${build_dir}/FrankaSimConfig.cmake
  INSTALL_DESTINATION ${destination} NO_SET_AND_CHECK_MACRO NO_CHECK_REQUIRED_COMPONENTS_MACRO)
install(FILES ${build_dir}/FrankaSimConfig.cmake ${build_dir}/FrankaSimConfigVersion.cmake
        DESTINATION ${destination})
export(EXPORT FrankaSimTargets NAMESPACE FrankaSim:: FILE ${build_dir}/FrankaSimTargets.cmake)
