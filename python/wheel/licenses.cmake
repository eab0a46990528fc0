# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
#
# Run when the wheel's files are installed: copies Debian's copyright files of the libraries that auditwheel bundles
# later. LIBRARIES: those that link them. DESTINATION: a folder.
file(GET_RUNTIME_DEPENDENCIES LIBRARIES ${LIBRARIES}
  RESOLVED_DEPENDENCIES_VAR libraries UNRESOLVED_DEPENDENCIES_VAR unresolved
  # Of this build, and those that every Debian has.
  PRE_EXCLUDE_REGEXES "^libfranka" "^ld-linux" "^lib(c|m|dl|pthread|rt|stdc\\+\\+|gcc_s|z)\\.so")
if(unresolved)
  message(FATAL_ERROR "The wheel cannot be built: these libraries are missing: ${unresolved}")
endif()
foreach(library ${libraries})
  file(REAL_PATH ${library} file)
  execute_process(COMMAND dpkg-query --search ${file} OUTPUT_VARIABLE printed RESULT_VARIABLE status)
  string(REGEX MATCH "^[^:]+" package "${printed}")
  set(copyright /usr/share/doc/${package}/copyright)
  if(NOT status EQUAL 0 OR NOT EXISTS ${copyright})
    message(FATAL_ERROR "The wheel cannot be built: the license of ${file} is unknown; it is of no Debian package.")
  endif()
  file(MAKE_DIRECTORY ${DESTINATION}/${package})
  file(COPY_FILE ${copyright} ${DESTINATION}/${package}/copyright)
endforeach()
