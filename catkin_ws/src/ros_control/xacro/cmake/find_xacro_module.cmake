# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0

# find_xacro_module(<module> <metadata>)
#
# Sets the two variables to the directories of the PyPI module xacro, version 2, and of its metadata
# and license. Looks in the environment FRANKA_VENV (a CMake variable), in the project's own .venv,
# and among the modules of the build's Python; fails with a sentence when it is in none of them.
function(find_xacro_module module_variable metadata_variable)
  get_filename_component(project_venv ${CMAKE_CURRENT_SOURCE_DIR}/../../../../.venv ABSOLUTE)
  set(places)
  set(venvs ${FRANKA_VENV} ${project_venv})
  foreach(venv ${venvs})
    file(GLOB site_packages ${venv}/lib/python3*/site-packages)
    list(APPEND places ${site_packages})
  endforeach()
  # -E: PYTHONPATH may lead to the copy of an earlier build.
  execute_process(
    COMMAND ${PYTHON_EXECUTABLE} -E -c
            "import os, xacro; print(os.path.dirname(os.path.dirname(xacro.__file__)))"
    OUTPUT_VARIABLE python_place OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  list(APPEND places ${python_place})

  foreach(place ${places})
    file(GLOB metadata ${place}/xacro-2.*.dist-info)
    if(metadata AND EXISTS ${place}/xacro/__init__.py)
      set(${module_variable} ${place}/xacro PARENT_SCOPE)
      set(${metadata_variable} ${metadata} PARENT_SCOPE)
      return()
    endif()
  endforeach()
  string(REPLACE ";" ", " venvs "${venvs}")
  message(
    FATAL_ERROR
      "The Python module xacro (version 2) is neither in ${venvs} nor among the modules of "
      "${PYTHON_EXECUTABLE}. Debian does not package it: run `./franka install`, which fetches it "
      "into .venv, or name an environment that has it with -DFRANKA_VENV=<directory>.")
endfunction()
