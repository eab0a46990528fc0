# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0

@[if DEVELSPACE]@
set(xacro_EXECUTABLE "@(CATKIN_DEVEL_PREFIX)/@(CATKIN_PACKAGE_BIN_DESTINATION)/xacro")
@[else]@
set(xacro_EXECUTABLE "${xacro_DIR}/../../../@(CATKIN_PACKAGE_BIN_DESTINATION)/xacro")
@[end if]@

# xacro_add_xacro_file(<input> [<output>] [REMAP <name>:=<value>...] [DEPENDS <file>...])
#
# Adds a rule that makes <output> from a xacro file. Without <output> it is the input's name less
# `.xacro`, in the current binary directory. Sets XACRO_OUTPUT_FILE to the absolute output; a target
# that depends on it has it made.
function(xacro_add_xacro_file input)
  cmake_parse_arguments(arg "INORDER" "" "REMAP;DEPENDS" ${ARGN})
  get_filename_component(input ${input} ABSOLUTE)
  set(output ${arg_UNPARSED_ARGUMENTS})
  if(NOT output)
    get_filename_component(output ${input} NAME)
    string(REGEX REPLACE "[.]xacro$" "" output ${output})
  endif()
  get_filename_component(output ${output} ABSOLUTE BASE_DIR ${CMAKE_CURRENT_BINARY_DIR})
  if(output STREQUAL input)
    message(FATAL_ERROR "xacro_add_xacro_file: name an output for ${input}; it does not end in "
                        "`.xacro` and would be overwritten.")
  endif()

  set(command ${CATKIN_ENV} ${xacro_EXECUTABLE} ${input} ${arg_REMAP})
  # What the file includes. It may not be known before other packages are configured.
  execute_process(
    COMMAND ${command} --deps
    OUTPUT_VARIABLE included OUTPUT_STRIP_TRAILING_WHITESPACE
    RESULT_VARIABLE failed ERROR_QUIET)
  if(failed)
    set(included)
  endif()
  separate_arguments(included UNIX_COMMAND "${included}")

  get_filename_component(directory ${output} DIRECTORY)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${directory}
    COMMAND ${command} -o ${output}
    DEPENDS ${input} ${included} ${arg_DEPENDS}
    COMMENT "xacro: making ${output}"
    VERBATIM)
  set(XACRO_OUTPUT_FILE ${output} PARENT_SCOPE)
endfunction()

# xacro_add_files(<input>... [TARGET <name>] [INSTALL [DESTINATION <directory>]]
#                 [REMAP <name>:=<value>...] [DEPENDS <file>...])
#
# Makes all outputs with one target (made if it is not there yet, part of `all`); with INSTALL they
# go to <directory>, by default the package's share directory.
function(xacro_add_files)
  cmake_parse_arguments(arg "INORDER;INSTALL" "TARGET;DESTINATION" "REMAP;DEPENDS" ${ARGN})
  set(outputs)
  foreach(input ${arg_UNPARSED_ARGUMENTS})
    xacro_add_xacro_file(${input} REMAP ${arg_REMAP} DEPENDS ${arg_DEPENDS})
    list(APPEND outputs ${XACRO_OUTPUT_FILE})
  endforeach()
  if(NOT arg_TARGET)
    set(arg_TARGET ${PROJECT_NAME}_xacro_generated)
  endif()
  if(TARGET ${arg_TARGET})
    string(MD5 suffix "${outputs}")
    add_custom_target(${arg_TARGET}_${suffix} DEPENDS ${outputs})
    add_dependencies(${arg_TARGET} ${arg_TARGET}_${suffix})
  else()
    add_custom_target(${arg_TARGET} ALL DEPENDS ${outputs})
  endif()
  if(arg_INSTALL)
    if(NOT arg_DESTINATION)
      set(arg_DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
    endif()
    install(FILES ${outputs} DESTINATION ${arg_DESTINATION})
  endif()
endfunction()
