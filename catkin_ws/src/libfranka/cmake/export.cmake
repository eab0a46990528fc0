# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
#
# Writes the CMake packages `FrankaCore` (always ours) and `Franka` (the public interface, which the
# vendor's may replace) twice: beside the built libraries (devel space) and for installation.
include(CMakePackageConfigHelpers)

# Config and version are the same in both places; beside the built libraries the targets carry absolute
# paths. LIBRARY is in export set <package>Targets.
function(franka_export package library)
  set(build_dir ${franka_build_cmake_dir}/${package})
  set(destination ${franka_lib_destination}/cmake/${package})
  install(TARGETS ${library} EXPORT ${package}Targets
          LIBRARY DESTINATION ${franka_lib_destination}
          ARCHIVE DESTINATION ${franka_lib_destination}
          RUNTIME DESTINATION ${franka_bin_destination})
  install(EXPORT ${package}Targets NAMESPACE Franka:: DESTINATION ${destination})
  write_basic_package_version_file(${build_dir}/${package}ConfigVersion.cmake
                                   VERSION ${PROJECT_VERSION} COMPATIBILITY AnyNewerVersion)
  configure_package_config_file(
    ${PROJECT_SOURCE_DIR}/cmake/${package}Config.cmake.in ${build_dir}/${package}Config.cmake
    INSTALL_DESTINATION ${destination} NO_SET_AND_CHECK_MACRO NO_CHECK_REQUIRED_COMPONENTS_MACRO)
  install(FILES ${build_dir}/${package}Config.cmake ${build_dir}/${package}ConfigVersion.cmake
          DESTINATION ${destination})
  export(EXPORT ${package}Targets NAMESPACE Franka:: FILE ${build_dir}/${package}Targets.cmake)
endfunction()

franka_export(FrankaCore franka_core)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/franka_core
        DESTINATION ${franka_include_destination} FILES_MATCHING PATTERN "*.h")
if(TARGET franka)
  franka_export(Franka franka)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/franka
                    ${PROJECT_SOURCE_DIR}/include/research_interface
          DESTINATION ${franka_include_destination} FILES_MATCHING PATTERN "*.h" PATTERN "*.hpp")
endif()
